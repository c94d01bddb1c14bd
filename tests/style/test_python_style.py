# SPDX-License-Identifier: GPL-3.0-or-later
"""Ruff has nothing to say about the Python code that git tracks."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def tracked_files():
    """Return the paths of the Python files that git tracks, relative to the project's folder."""
    tracked = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return [name for name in tracked.stdout.splitlines() if (ROOT / name).is_file()]


@pytest.mark.parametrize("arguments", [["check"], ["format", "--check"]], ids=" ".join)
def test_ruff(arguments):
    files = tracked_files()
    assert files
    result = subprocess.run(
        [sys.executable, "-m", "ruff", *arguments, *files],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    hint = "\nInstall it with: pip install ruff" if "No module named ruff" in result.stdout else ""
    assert result.returncode == 0, result.stdout + hint
