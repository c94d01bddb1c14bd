# SPDX-License-Identifier: GPL-3.0-or-later
"""Where one thing is huge, instructions grow with it as n log n, however busy the machine."""

import shutil

import pytest

from tests.fuzz import growth

# n log n gives 4.8 at four times the size; a factorisation of a grid, n to the power of 1.5, gives 8 of its part.
LIMIT = 6.0

pytestmark = pytest.mark.skipif(not shutil.which("valgrind"), reason="no valgrind")


@pytest.mark.slow
def test_nothing_grows_faster_than_n_log_n():
    counts = growth.in_parallel(seed=1, cases=growth.CASES)
    assert counts.keys() == set(growth.CASES)
    faster = {case: each for case, each in counts.items() if each[-1] > LIMIT * each[0]}
    assert not faster
