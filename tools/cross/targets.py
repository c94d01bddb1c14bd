# SPDX-License-Identifier: GPL-3.0-or-later
"""The target systems of the packages: compiler, tags, BLAS, and the tests that were run on each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tools.steps import BUILD, StepError
from tools.wheels import python_tag

CROSS = BUILD / "cross"
WHEELS = CROSS / "wheels"
PACKAGES = CROSS / "packages"
MACOS_MINIMUM = "11.0"
ALL = "all"
# Blender 3.4 to 4.0 have Python 3.10; 4.1 to 5.0 have 3.11; from 5.1 on it is 3.13.
PYTHONS = ("3.10", "3.11", "3.13")
# OpenBLAS has our own name in the wheel, because a process on Windows loads one library per name.
BLAS = "spectral_conformal_openblas"


@dataclass(frozen=True)
class Target:
    """A system and processor."""

    name: str  # Blender's, such as windows-x64
    system: str  # CMake's name
    processor: str  # CMake's name
    triple: str  # the compiler's name
    tag: str  # of a wheel's platform
    python_suffix: str  # of an extension module, behind the Python's version
    blas_name: str  # of the library in the wheel
    blas_platform: str  # of the wheel of scipy-openblas32
    blas_hash: str  # of that wheel, SHA-256
    was_run: str  # what the packages were tested with, for the notes in the zips

    @property
    def folder(self) -> Path:
        """The build folder of this target."""
        return CROSS / self.name

    @property
    def blas_prefix(self) -> str:
        """The prefix of the BLAS's function names; Windows' library has the plain names as well."""
        return "" if self.system == "Windows" else "scipy_"

    def module_name(self, python: str) -> str:
        """Return the file name of the native module for a Python."""
        return f"_native{self.module_suffix(python)}"

    def module_suffix(self, python: str) -> str:
        """Return a Python's suffix for extension modules."""
        tag = python_tag(python)
        name = tag if self.system == "Windows" else tag.replace("cp", "cpython-")
        return f".{name}-{self.python_suffix}"


NOT_RUN = (
    "Made on Linux and checked without running it (file format, tags, libraries, minimum system). Nobody has run it "
    "yet: please report whether it works."
)
TARGETS = (
    Target(
        name="windows-x64",
        system="Windows",
        processor="AMD64",
        triple="x86_64-w64-mingw32",
        tag="win_amd64",
        python_suffix="win_amd64.pyd",
        blas_name=f"{BLAS}.dll",
        blas_platform="win_amd64",
        blas_hash="963e311354df08856c22aad17d77209448d2d8fc3bc4b3b1d87912828797cf13",
        was_run="Made on Linux. Run under Wine 8, which stands in for Windows: the module in Windows' Python 3.11 and "
        "3.13, the extension in Blender 5.0.1 and 5.2.3 for Windows. Nobody has run it on Windows itself yet: please "
        "report whether it works.",
    ),
    Target(
        name="linux-x64",
        system="Linux",
        processor="x86_64",
        triple="x86_64-linux-gnu.2.28",
        tag="manylinux_2_28_x86_64",
        python_suffix="x86_64-linux-gnu.so",
        blas_name=f"lib{BLAS}.so",
        blas_platform="manylinux_2_28_x86_64",
        blas_hash="0595f94cd58c1f8a0d90c975621f4587337a003916b1979e834ebdf2cb5d9504",
        was_run="Run on Debian 12: the module in Python 3.11, with the results of the one built there; the extension "
        "in Blender 5.0.1. Nobody has run it on older systems yet: please report whether it works.",
    ),
    Target(
        name="macos-arm64",
        system="Darwin",
        processor="arm64",
        triple=f"aarch64-macos.{MACOS_MINIMUM}",
        tag="macosx_11_0_arm64",
        python_suffix="darwin.so",
        blas_name=f"lib{BLAS}.dylib",
        blas_platform="macosx_11_0_arm64",
        blas_hash="813bb8101da2f64555c4a5e71c3714539d92b0b4f1841ec12b80d50e56cde46c",
        was_run=NOT_RUN,
    ),
    Target(
        name="linux-arm64",
        system="Linux",
        processor="aarch64",
        triple="aarch64-linux-gnu.2.28",
        tag="manylinux_2_28_aarch64",
        python_suffix="aarch64-linux-gnu.so",
        blas_name=f"lib{BLAS}.so",
        blas_platform="manylinux_2_28_aarch64",
        blas_hash="e085dddbc5b9aa130f83def515d31c440e69f387a90c7e63b154a5575b4466bc",
        was_run="Made on Linux. The module was run in Python 3.11 under qemu 7.2, which stands in for ARM, with "
        "the results of the one built on x86-64. Nobody has run the extension, or anything of it on an ARM "
        "processor: please report whether it works.",
    ),
    Target(
        name="macos-x64",
        system="Darwin",
        processor="x86_64",
        triple=f"x86_64-macos.{MACOS_MINIMUM}",
        tag="macosx_11_0_x86_64",
        python_suffix="darwin.so",
        blas_name=f"lib{BLAS}.dylib",
        blas_platform="macosx_10_13_x86_64",
        blas_hash="85d42ee10fd207ed6014273dcb9236ab1a65d21357f278b3aa0a78e8189665a8",
        was_run=NOT_RUN,
    ),
)


def named(names: Sequence[str]) -> list[Target]:
    """Return the targets of these names, in the order of the table; `all` names every one."""
    known = [target.name for target in TARGETS]
    unknown = [name for name in names if name not in {*known, ALL}]
    if unknown:
        raise StepError(f"No platform is called {', '.join(unknown)}: give {ALL} or some of {', '.join(known)}.")
    return [target for target in TARGETS if ALL in names or target.name in names]
