# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the module's batch command from a checkout."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence

from tools import environment


def run(arguments: Sequence[str]) -> int:
    """Run `python -m spectral_conformal batch` in build/venv, from the caller's folder; return its exit code."""
    command = [environment.PYTHON, "-m", "spectral_conformal", "batch", *arguments]
    return subprocess.run(command, check=False).returncode
