# SPDX-License-Identifier: GPL-3.0-or-later
"""Run a Python for Linux on ARM with qemu, with packages; for the tests only."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from tools import steps
from tools.cross import emulated
from tools.environment import PYTHON
from tools.steps import BUILD
from tools.systems import mirror

FOLDER = BUILD / "qemu"
LOG = "qemu"
EMULATOR = "qemu-aarch64-static"
# Without SVE: OpenBLAS 0.3.34's kernels for qemu's default processor cannot factorize more than 16 vertices.
PROCESSOR = "cortex-a76"
# The Debian release with this Python, which Blender 4.2 to 5.0 have.
SUITE, VERSION = "bookworm", "3.11"
# NumPy and libigl need the system's C++ library.
DEBIAN_PACKAGES = (f"python{VERSION}", "libstdc++6")
PACKAGES = ("libigl", "pytest", "scipy")
# By the oldest glibc that their wheels require.
PLATFORMS = ("manylinux_2_28_aarch64", "manylinux_2_17_aarch64", "manylinux2014_aarch64")


def obstacle() -> str | None:
    """Return why no Python for ARM can run here, None if it can."""
    if missing := [name for name in (EMULATOR, "mmdebstrap") if not shutil.which(name)]:
        return f"no {' and no '.join(missing)} (apt-get install --no-install-recommends qemu-user-static mmdebstrap)"
    return None


def run(
    words: Sequence[object], *, environ: Mapping[str, str] | None = None, folder: Path = BUILD, timeout: float = 300
) -> subprocess.CompletedProcess[str]:
    """Run Python for ARM with these arguments; it sees its own system's files before those of this machine."""
    return emulated.run([python(), *words], environ=emulated.environment(environ or {}), folder=folder, timeout=timeout)


def python() -> Path:
    """Make the system of a Python for ARM, install its packages, and return the program that runs it."""
    root = FOLDER / "root"
    program = FOLDER / "python"
    state = steps.digest([SUITE, VERSION, *DEBIAN_PACKAGES, *PACKAGES, PROCESSOR])
    if steps.is_done("qemu", state) and program.is_file():
        return program
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    # Only unpacked: configuring would run programs for the other processor.
    options = ['--aptopt=Acquire::Check-Valid-Until "false"', "--variant=extract", "--architectures=arm64"]
    steps.run(
        f"unpacking Python {VERSION} of Debian for ARM",
        ["mmdebstrap", *options, f"--include={','.join(DEBIAN_PACKAGES)}", SUITE, root, mirror()],
        log=LOG,
    )
    site = root / "usr" / "local" / "lib" / f"python{VERSION}" / "dist-packages"
    platforms = [word for name in PLATFORMS for word in ("--platform", name)]
    steps.run(
        f"pip install {' '.join(PACKAGES)} (for Linux on ARM, Python {VERSION})",
        [PYTHON, "-m", "pip", "install", "--upgrade", "--target", site, *platforms, "--implementation", "cp",
         "--python-version", VERSION, "--only-binary=:all:", *PACKAGES],
        log=LOG,
    )  # fmt: skip
    # A program that restarts itself would start one that this machine cannot run.
    start = f"import sys; sys.executable = {str(program)!r}"
    (site / "this_python.pth").write_text(f"{start}\n")
    interpreter = root / "usr" / "bin" / f"python{VERSION}"
    words = f"'{shutil.which(EMULATOR)}' -cpu {PROCESSOR} -L '{root}' '{interpreter}'"
    program.write_text(f'#!/bin/sh\nexec {words} "$@"\n')
    program.chmod(0o755)
    steps.mark_done("qemu", state)
    return program
