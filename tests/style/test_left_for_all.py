# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests marked `all` run by --all, or where their file is named, and the report says that they were left out."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
THREAD = "test_ctest[thread]"


@pytest.mark.parametrize(
    ("arguments", "are_taken"),
    [(["-k", "test_ctest"], False), (["-k", "test_ctest", "--all"], True), (["tests/native/test_native.py"], True)],
)
def test_they_are_left_out_unless_asked_for(arguments, are_taken):
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", *arguments]
    # Where pytest looks if nothing is named: to collect all tests takes long.
    command += ["-o", "testpaths=tests/native"]
    printed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert "test_ctest[release]" in printed
    assert (THREAD in printed, "left for --all" in printed) == (are_taken, not are_taken)
