# SPDX-License-Identifier: GPL-3.0-or-later
"""How instructions grow if one quantity is huge: n log n, whatever the machine and its load."""

import re
import shutil
import subprocess

import pytest

from tests.native import flavors

pytestmark = [
    pytest.mark.all,
    pytest.mark.slow,
    pytest.mark.skipif(not shutil.which("valgrind"), reason="no valgrind"),
]

SIZE, TIMES = 1000, 4
# n log n gives 4.8 at these sizes, n to the power of 1.5 gives 8.
LIMIT = 5.5
# Constant: a find among many.
CONSTANT = {"kept maps that are much alike"}


@pytest.fixture(scope="module")
def executable():
    return flavors.build("release", "spectral_conformal_growth") / "tests" / "native" / "spectral_conformal_growth"


def instructions(executable, case, size):
    """Return those of the work itself."""
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=counted_work"]
    result = subprocess.run([*valgrind, executable, case, str(size)], capture_output=True, text=True, check=False)
    counted = re.search(r"Collected : (\d+)", result.stderr)
    assert result.returncode == 0, result.stderr[-2000:]
    return int(counted[1])


def growth(executable, case):
    small, large = (instructions(executable, case, size) for size in (SIZE, TIMES * SIZE))
    assert small > SIZE, "nothing was counted"
    return large / small


def test_growth(executable):
    cases = subprocess.run([executable], capture_output=True, text=True, check=True).stdout.splitlines()
    assert set(cases) > CONSTANT
    grown = {case: growth(executable, case) for case in cases}
    too_much = {case: factor for case, factor in grown.items() if factor > (1.5 if case in CONSTANT else LIMIT)}
    assert not too_much, f"at {TIMES} times the size: {too_much}"
