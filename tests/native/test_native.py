# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the C++ library and its own tests in every flavour and run them."""

import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.module import changing
from tests.native import flavours


@pytest.fixture(scope="module", params=flavours.FLAVOURS)
def build(request):
    return flavours.build(request.param)


def test_ctest(build, monkeypatch):
    monkeypatch.setenv("UBSAN_OPTIONS", "print_stacktrace=1")
    suppressions = Path(__file__).with_name("thread_sanitizer_suppressions.txt")
    monkeypatch.setenv("TSAN_OPTIONS", f"suppressions='{suppressions}' halt_on_error=1")
    _, only = flavours.ONLY.get(build.name, (None, ".*"))
    summary = flavours.run(
        flavours.TOOLS / "ctest",
        *("--test-dir", build, "--output-on-failure", "--no-tests=error", "-j", os.cpu_count(), "-R", f"^{only}$"),
    )
    assert "100% tests passed" in summary


def test_cholmod_is_linked_unless_left_out(build):
    cache = (build / "CMakeCache.txt").read_text()
    assert ("CHOLMOD_LIBRARY:FILEPATH=" in cache) == (build.name != "eigen_only")
    assert "CHOLMOD_LIBRARY-NOTFOUND" not in cache


def runtime(name):
    return Path(subprocess.check_output(["clang++", f"-print-file-name={name}"], text=True).strip()).resolve(strict=True)


def test_the_module_whose_arguments_change_meanwhile(tmp_path, monkeypatch):
    """`tests/module/changing.py` with AddressSanitizer, which sees what a crash without it would depend on luck for."""
    package = shutil.copytree(flavours.ROOT / "native/python/spectral_conformal", tmp_path / "spectral_conformal")
    (compiled,) = flavours.build("sanitized", "_native").glob("_native*.so")
    shutil.copy(compiled, package)
    # What a program begins with: Python itself is not instrumented, nor has it a C++ library, whose exceptions are
    # listened to.
    preloaded = (runtime(f"libclang_rt.asan-{platform.machine()}.so"), runtime("libstdc++.so.6"))
    monkeypatch.setenv("LD_PRELOAD", " ".join(map(str, preloaded)))
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{flavours.ROOT}")
    # NumPy and Python keep to the end what they made once.
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")
    called = flavours.run(sys.executable, "-m", "tests.module.changing", "3")
    assert called.splitlines() == list(changing.CALLS)
