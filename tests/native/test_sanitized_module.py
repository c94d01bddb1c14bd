# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module with AddressSanitizer and UndefinedBehaviorSanitizer."""

import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

from tests.module import changing
from tests.native import flavours


def runtime(name):
    printed = subprocess.check_output(["clang++", f"-print-file-name={name}"], text=True)
    return Path(printed.strip()).resolve(strict=True)


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
