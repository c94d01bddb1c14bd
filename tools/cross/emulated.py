# SPDX-License-Identifier: GPL-3.0-or-later
"""Run programs of another system or processor under an emulator; for the tests only."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

# Environment variables of this machine's Python and Blender.
INHERITED = ("PYTHON", "BLENDER_", "VIRTUAL_ENV")


def environment(more: Mapping[str, str]) -> dict[str, str]:
    """Return this process's environment without the variables of Python and Blender, and with `more`."""
    return {**{name: value for name, value in os.environ.items() if not name.startswith(INHERITED)}, **more}


def run(
    words: Sequence[object], *, environ: Mapping[str, str], folder: Path, timeout: float
) -> subprocess.CompletedProcess[str]:
    """Run a program to its end in that environment; a pipe collects all its output in `stdout`."""
    return subprocess.run(
        list(map(str, words)),
        cwd=folder,
        env=environ,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        check=False,
        timeout=timeout,
    )
