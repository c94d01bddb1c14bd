# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's command for many files, run from a checkout."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence

from tools import environment
from tools.steps import BUILD, ROOT

# In it the add-on's folder has the name of its package.
PACKAGES = BUILD / "importable"


def run(arguments: Sequence[str]) -> int:
    """Run `python -m spectral_unwrap` of build/venv, in the folder that this was called in; return its exit code."""
    link = PACKAGES / "spectral_unwrap"
    PACKAGES.mkdir(parents=True, exist_ok=True)
    if not link.is_dir():
        link.unlink(missing_ok=True)
        link.symlink_to(ROOT / "addon", target_is_directory=True)
    paths = os.pathsep.join(filter(None, [str(PACKAGES), os.environ.get("PYTHONPATH")]))
    command = [environment.PYTHON, "-m", "spectral_unwrap", *arguments]
    return subprocess.run(command, env={**os.environ, "PYTHONPATH": paths}, check=False).returncode
