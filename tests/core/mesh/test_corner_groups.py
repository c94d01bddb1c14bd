# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners grouped by chart."""

import numpy as np
import pytest
from spectral_unwrap.core.mesh.corner_groups import CornerGroups

POINTS = np.array([(0.0, 5.0), (2.0, 4.0), (1.0, 9.0), (3.0, 3.0), (7.0, 1.0)])


@pytest.mark.parametrize("chart", [[0, 0, 2, 2, 2], [2, 0, 2, 0, 2], [-1, 4, 4, -1, 1], [3] * 5])
def test_bounds_and_flags_are_those_of_each_chart(chart):
    chart = np.array(chart)
    groups = CornerGroups.of(chart)
    assert groups.numbers.tolist() == sorted(set(chart[chart >= 0].tolist()))
    is_low = POINTS[:, 0] < 2.5
    for k, number in enumerate(groups.numbers):
        own = POINTS[chart == number]
        np.testing.assert_array_equal(groups.bounds(POINTS)[k], [own.min(axis=0), own.max(axis=0)])
        assert groups.any(is_low)[k] == is_low[chart == number].any()
        assert groups.all(is_low)[k] == is_low[chart == number].all()


@pytest.mark.parametrize("chart", [[0, 0, 2, 2, 2], [2, 0, 2, 0, 2], [-1, 4, 4, -1, 1], [3] * 5])
def test_rows_go_back_to_their_corners(chart):
    chart = np.array(chart)
    groups = CornerGroups.of(chart)
    moved = groups.of_corners(POINTS) + groups.spread(groups.numbers[:, None] * 10.0)
    expected = POINTS + np.maximum(chart, 0)[:, None] * 10.0
    np.testing.assert_array_equal(groups.with_rows(POINTS, moved), expected)


def test_without_charts_there_is_nothing():
    for chart in (np.full(5, -1), np.empty(0, dtype=int)):
        groups = CornerGroups.of(chart)
        assert len(groups) == 0
        assert groups.bounds(POINTS[: len(chart)]).shape == (0, 2, 2)
