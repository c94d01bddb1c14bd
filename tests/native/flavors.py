# SPDX-License-Identifier: GPL-3.0-or-later
"""Configurations of the C++ library and its tests, each in a build folder of its own."""

import contextlib
import fcntl
import os
import subprocess
import sys
from pathlib import Path

import pybind11

from tools import environment, solver_libraries

ROOT = Path(__file__).resolve().parents[2]
TOOLS = Path(sys.executable).parent  # pip installs cmake and ninja here

COMMON = {
    "SPECTRAL_CONFORMAL_PYTHON": "OFF",
    "SPECTRAL_CONFORMAL_TESTS": "ON",
    "SPECTRAL_CONFORMAL_WARNINGS_AS_ERRORS": "ON",
    "CMAKE_MAKE_PROGRAM": TOOLS / "ninja",
}
# Several files as one unit, as in the wheel, since most of the time goes into Eigen's headers. The static analyzer
# (tests/style/test_cpp_style.py) takes them one by one and sees whether one lacks an include.
UNITY = {"CMAKE_UNITY_BUILD": "ON", "CMAKE_UNITY_BUILD_BATCH_SIZE": 24}
FLAVORS = {
    # The libraries that are in the wheel, and once more without CHOLMOD, as where SuiteSparse is absent.
    "release": {**UNITY, "CMAKE_BUILD_TYPE": "Release", "SPECTRAL_CONFORMAL_BUILT": environment.NATIVE_BUILD},
    # With clang, for libFuzzer's targets, which share the library with the tests.
    "sanitized": {
        **UNITY,
        "CMAKE_BUILD_TYPE": "Debug",
        "CMAKE_CXX_COMPILER": "clang++",
        "CMAKE_CXX_FLAGS_DEBUG": "-O1 -g1",
        "SPECTRAL_CONFORMAL_FUZZERS": "ON",
        "SPECTRAL_CONFORMAL_PYTHON": "ON",
        "Python_EXECUTABLE": sys.executable,
        "pybind11_DIR": pybind11.get_cmake_dir(),
        "SPECTRAL_CONFORMAL_SANITIZE": "address,undefined",
    },
    # Runs one executable only; the others have no threads. OpenBLAS, CHOLMOD and METIS are not instrumented.
    "thread": {
        **UNITY,
        "CMAKE_BUILD_TYPE": "Debug",
        "CMAKE_CXX_FLAGS_DEBUG": "-O1 -g1",
        "SPECTRAL_CONFORMAL_SANITIZE": "thread",
    },
}
# What a flavor builds and tests, if not everything: (target, test).
ONLY = {"thread": ("spectral_conformal_thread_tests", "threads")}


def run(*command, **environ):
    """Run a command; if it fails, raise AssertionError with its output."""
    result = subprocess.run(
        [str(word) for word in command],
        env={**os.environ, **environ},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    assert result.returncode == 0, f"{' '.join(map(str, command))}\n{result.stdout[-20000:]}"
    return result.stdout


def folder_of(flavor):
    """Return the build folder of a flavor."""
    return ROOT / "build" / "tests-native" / flavor


@contextlib.contextmanager
def exclusive(flavor):
    """Let one process at a time work in the folder of a flavor."""
    folder_of(flavor).mkdir(parents=True, exist_ok=True)
    with (folder_of(flavor) / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def configure(flavor):
    """Configure a flavor and return its build folder."""
    if "SPECTRAL_CONFORMAL_BUILT" in FLAVORS[flavor]:
        assert environment.is_native_module_built(), "the built library is older than its sources: run build_addon.py"
    settings = {**COMMON, **solver_libraries.settings(), **FLAVORS[flavor]}
    definitions = [f"-D{name}={value}" for name, value in settings.items()]
    run(TOOLS / "cmake", "-S", ROOT, "-B", folder_of(flavor), "-G", "Ninja", *definitions)
    return folder_of(flavor)


def build(flavor, *targets):
    """Configure a flavor and build these targets, by default those of its tests; return its build folder."""
    targets = targets or ONLY.get(flavor, ("all",))[:1]
    with exclusive(flavor):
        folder = configure(flavor)
        run(TOOLS / "cmake", "--build", folder, "--parallel", environment.compile_jobs(), "--target", *targets)
    return folder
