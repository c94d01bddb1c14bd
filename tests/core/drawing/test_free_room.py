# SPDX-License-Identifier: GPL-3.0-or-later
"""Free room in a region of the screen beside whatever covers it."""

import itertools
import random

import pytest
from spectral_unwrap.core.drawing.free_room import free_boxes, lower_right

SIZE = (800.0, 600.0)
SIDEBAR = (600.0, 0.0, 800.0, 600.0)
PANEL = (0.0, 0.0, 500.0, 300.0)


def meet(one, other):
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def test_without_covers_everything_is_free():
    assert list(free_boxes(SIZE, ())) == [(0.0, 0.0, *SIZE)]
    assert lower_right(SIZE, (), 280.0, 160.0) == (520.0, 0.0, 800.0, 160.0)


def test_beside_the_sidebar_and_above_the_panel():
    assert lower_right(SIZE, (SIDEBAR,), 280.0, 160.0) == (320.0, 0.0, 600.0, 160.0)
    assert lower_right(SIZE, (PANEL,), 280.0, 160.0) == (520.0, 0.0, 800.0, 160.0)
    assert lower_right(SIZE, (SIDEBAR, PANEL), 280.0, 160.0) == (320.0, 300.0, 600.0, 460.0)


def test_scaled_down_where_there_is_less_room():
    box = lower_right(SIZE, (SIDEBAR,), 1200.0, 600.0)
    assert box == pytest.approx((0.0, 0.0, 600.0, 300.0))


def test_nothing_where_everything_is_covered():
    covers = ((0.0, 0.0, 500.0, 600.0), (500.0, 0.0, 800.0, 600.0))
    assert lower_right(SIZE, covers, 10.0, 10.0) is None
    assert lower_right((0.0, 5.0), (), 10.0, 10.0) is None


@pytest.mark.parametrize("seed", range(20))
def test_free_boxes_are_free_and_as_large_as_can_be(seed):
    # On a grid of few lines, on which every box can be looked at.
    chosen = random.Random(seed)
    lines = range(7)
    covers = []
    for _ in range(chosen.randrange(6)):
        (left, right), (bottom, top) = (sorted(chosen.sample(lines, 2)) for _ in range(2))
        covers.append((float(left), float(bottom), float(right), float(top)))
    found = set(free_boxes((6.0, 6.0), tuple(covers)))
    pairs = list(itertools.combinations(map(float, lines), 2))
    free = [(x[0], y[0], x[1], y[1]) for x in pairs for y in pairs]
    free = [box for box in free if not any(meet(box, cover) for cover in covers)]
    holds = lambda a, b: a != b and a[0] <= b[0] and a[1] <= b[1] and a[2] >= b[2] and a[3] >= b[3]  # noqa: E731
    assert found == {box for box in free if not any(holds(other, box) for other in free)}
