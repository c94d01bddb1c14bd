# SPDX-License-Identifier: GPL-3.0-or-later
"""The module's command for many files, run from a checkout."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence

from tools import environment


def run(arguments: Sequence[str]) -> int:
    """Run `python -m spectral_conformal batch` of build/venv, in the folder of the caller; return its exit code."""
    command = [environment.PYTHON, "-m", "spectral_conformal", "batch", *arguments]
    return subprocess.run(command, check=False).returncode
