# SPDX-License-Identifier: GPL-3.0-or-later
"""If one quantity is huge, instructions grow with it as n log n, however busy the machine."""

import shutil

import pytest

from tests.fuzz import growth

# n log n gives 4.8 at four times the size; a factorization of a grid, n to the power of 1.5, gives 8 of its part.
LIMIT = 6.0
# From some thousand faces on, the search for seams works on coarse copies too, which the smaller size does not have. It
# factorizes each map that it tries, which is most of its work on duplicate corners: 6.5 at 2,000 and 8,000, too. Among
# boxes of the fan four times as many widths are different, and a box is looked for among wider ones: n (log n)^2. Rigid
# unfolding tests each facet of a fan against others whose boxes all meet at the hub: 8.7, n^2 in the end, for which
# pieces of more than 8,000 facets are not unfolded. A pipe seen from above lies on itself, and up to a fixed number of
# pairs of each triangle are tested for overlaps, of which the smaller size has fewer; teeth that fold need more rounds.
# Of spikes whose feet are anywhere along them, a vertex meets the slabs of more of them where there are more. The boxes
# of 500 islands fill the first square that is tried; from 1,000 on, shelves are tried, too.
LIMITS = {
    "border/suggest_seams": 10.0,
    "border/suggest_cuts": 10.0,
    "alternating/suggest_seams": 8.0,
    "alternating/suggest_cuts": 8.0,
    "duplicate_corners/suggest_seams": 8.0,
    "duplicate_corners/suggest_cuts": 8.0,
    "islands/pack_boxes": 10.0,
    "valence/pack_boxes": 8.0,
    "valence/suggest_cuts": 9.0,
    "pipe/relax": 8.0,
    "jagged_corners/fold_free": 9.0,
    "spiked_corners/relax": 8.0,
}


def is_tested(case):
    """Leave out what is of no use."""
    family, function = case.split("/")
    # Of pages on one edge, every extender acts on every island.
    if case == "pages/extended":
        return False
    # These still grow faster. A ribbon takes more iterations; of a polygon that crosses itself, the fan lies on itself,
    # which only the test for overlaps of one face alone leaves out.
    if family == "crossing_corners" and function not in ("unwrap", "relax"):
        return False
    if family in ("ribbon", "zigzag") and function not in ("relax", "fold_free"):
        return False
    # With pins everywhere nearly all faces are islands.
    return function != "pinned" or family == "valence"


TESTED = [case for case in growth.CASES if is_tested(case)]

pytestmark = pytest.mark.skipif(not shutil.which("valgrind"), reason="no valgrind")


@pytest.mark.all
@pytest.mark.slow
@pytest.mark.ahead
def test_nothing_grows_faster_than_n_log_n():
    counts = growth.in_parallel(seed=1, cases=TESTED)
    assert list(counts) == TESTED
    limits = {case: LIMITS.get(case, LIMIT) for case in TESTED}
    faster = {case: each for case, each in counts.items() if each[-1] > limits[case] * each[0]}
    assert not faster
