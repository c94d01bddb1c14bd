# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrows of extenders: their directions, their sizes, and when there is none."""

import numpy as np
import pytest
from spectral_unwrap.core.drawing import arrow_shapes

HEAD = 12.0


def tips_and_bases(lines):
    """The tip and the middle of the base of each of the two heads, whose lines come first."""
    for head in (lines[:2], lines[2:4]):
        np.testing.assert_allclose(head[0, 0], head[1, 0])
    return [(head[0, 0], head[:, 1].mean(axis=0)) for head in (lines[:2], lines[2:4])]


@pytest.mark.parametrize("end", [(200.0, 0.0), (0.0, -90.0), (30.0, 40.0)])
def test_outward_heads_end_at_the_vertices_and_inward_ones_meet_in_the_middle(end):
    start, end = np.array([5.0, -3.0]), np.array([5.0, -3.0]) + end
    for outward in (True, False):
        lines = arrow_shapes.arrow(start, end, outward)
        heads = tips_and_bases(lines)
        if outward:
            np.testing.assert_allclose([tip for tip, _ in heads], [start, end])
        else:
            np.testing.assert_allclose(np.mean([tip for tip, _ in heads], axis=0), (start + end) / 2.0)
        toward_end = [(tip - base) @ (end - start) for tip, base in heads]
        assert np.sign(toward_end).tolist() == ([-1, 1] if outward else [1, -1])
        # The shaft goes from one vertex to the other, where two tips meet in two parts.
        shaft = lines[4:].reshape(-1, 2)
        np.testing.assert_allclose(shaft[[0, -1]], [start, end])
        assert len(lines) == (5 if outward else 6)


@pytest.mark.parametrize("outward", [True, False])
def test_arrow_keeps_its_size_in_pixels_and_shrinks_only_without_room(outward):
    def width(length, scale=1.0):
        lines = arrow_shapes.arrow(np.zeros(2), np.array([length, 0.0]), outward, scale)
        assert lines[:, :, 0].min() >= -1e-9
        assert lines[:, :, 0].max() <= length + 1e-9
        return np.ptp(lines[:, :, 1])

    assert width(100.0) == pytest.approx(width(1000.0)) == pytest.approx(2.0 * 0.45 * HEAD)
    assert width(1000.0, scale=2.0) == pytest.approx(2.0 * width(1000.0))
    assert width(10.0) < width(100.0)


def test_points_in_one_place_or_nowhere_make_no_arrow():
    assert arrow_shapes.arrow(np.ones(2), np.ones(2), True).shape == (0, 2, 2)
    assert arrow_shapes.arrow(np.ones(2), np.array([np.nan, 0.0]), True).shape == (0, 2, 2)


def test_nearest_copies():
    first, second = np.array([(0.0, 0.0), (5.0, 5.0)]), np.array([(9.0, 9.0), (5.0, 6.0)])
    np.testing.assert_array_equal(arrow_shapes.nearest_pair(first, second), [(5.0, 5.0), (5.0, 6.0)])
