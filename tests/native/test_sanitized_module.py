# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module with AddressSanitizer and UndefinedBehaviorSanitizer."""

import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.native import flavors
from tools import solver_libraries


def runtime(name):
    printed = subprocess.check_output(["clang++", f"-print-file-name={name}"], text=True)
    return Path(printed.strip()).resolve(strict=True)


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """The folder with a package whose native module has the flavor "sanitized"."""
    folder = tmp_path_factory.mktemp("sanitized")
    package = shutil.copytree(flavors.ROOT / "native/python/spectral_conformal", folder / "spectral_conformal")
    (compiled,) = flavors.build("sanitized", "_native").glob("_native*.so")
    beside = [path for path in (solver_libraries.OPENBLAS, solver_libraries.CHOLMOD) if path.is_file()]
    for path in (compiled, *beside):
        shutil.copy(path, package)
    return folder


def test_arguments_that_change_meanwhile(package, monkeypatch):
    """Invalid reads and writes are found here, while without a sanitizer a crash takes luck."""
    # What a program begins with: Python itself is not instrumented, nor has it a C++ library, whose exceptions are
    # listened to.
    preloaded = (runtime(f"libclang_rt.asan-{platform.machine()}.so"), runtime("libstdc++.so.6"))
    monkeypatch.setenv("LD_PRELOAD", " ".join(map(str, preloaded)))
    monkeypatch.setenv("PYTHONPATH", f"{package}{os.pathsep}{flavors.ROOT}")
    # NumPy and Python keep to the end what they made once.
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")
    monkeypatch.setenv("UBSAN_OPTIONS", "print_stacktrace=1")
    flavors.run(sys.executable, "-m", "pytest", "-q", "tests/module/test_changed_arguments.py")
