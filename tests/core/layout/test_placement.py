# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts side by side, and back into their former bounding boxes."""

import numpy as np
import pytest
from spectral_unwrap.core.errors import ReadableError
from spectral_unwrap.core.layout.placement import into_former_bounds, side_by_side

RECTANGLE = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)])


def random_charts(sizes, seed=0):
    """Charts of 5 points each, chart k of about `sizes[k]`; return uv (C, 2) and chart (C,), corners shuffled."""
    rng = np.random.default_rng(seed)
    uv = np.concatenate([rng.normal(size=(5, 2)) * size for size in sizes])
    chart = np.repeat(np.arange(len(sizes)), 5)
    order = rng.permutation(len(uv))
    return uv[order], chart[order]


def in_former_bounds(uv, former, chart):
    """Fit charts that may turn into their former bounds."""
    return into_former_bounds(uv, former, chart, np.zeros(len(chart), dtype=bool))


def box(points):
    return points.min(axis=0), points.max(axis=0)


def signed_area(polygon):
    x, y = polygon.T
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2.0


def distances(points):
    return np.linalg.norm(points[:, None] - points[None], axis=2)


@pytest.mark.parametrize("sizes", [[1.0], [1.0] * 30, [1e-3, 1.0, 50.0, 2.0], [1e-15] * 3, [1e15, 3e15]])
def test_side_by_side_keeps_shapes_and_relative_sizes_without_overlap(sizes):
    uv, chart = random_charts(sizes)
    placed = side_by_side(uv, chart)
    assert placed.min() >= 0.0
    assert 0.9 < placed.max() <= 1.0
    charts = [chart == k for k in range(len(sizes))]
    factor = distances(placed[charts[0]]).max() / distances(uv[charts[0]]).max()
    for corners in charts:
        scale = distances(uv).max() * factor
        np.testing.assert_allclose(distances(placed[corners]), distances(uv[corners]) * factor, atol=1e-12 * scale)
    for i in range(len(sizes)):
        for j in range(i):
            (low_i, high_i), (low_j, high_j) = box(placed[charts[i]]), box(placed[charts[j]])
            assert (np.minimum(high_i, high_j) < np.maximum(low_i, low_j)).any()


def test_side_by_side_turns_no_chart():
    upright = RECTANGLE[[0, 3, 2, 1]][:, ::-1]
    both = np.vstack([upright, RECTANGLE * 2.0])
    chart = np.repeat([0, 1], 4)
    for rectangle, original in zip(side_by_side(both, chart).reshape(2, 4, 2), both.reshape(2, 4, 2)):
        size, former = (np.ptp(points, axis=0) for points in (rectangle, original))
        np.testing.assert_allclose(rectangle - rectangle[0], (original - original[0]) * (size / former)[0], atol=1e-15)


@pytest.mark.parametrize("margin", [0.5, 50.0])
def test_a_margin_that_leaves_no_room_shrinks_the_charts(margin):
    uv = np.concatenate([RECTANGLE, RECTANGLE])
    placed = side_by_side(uv, np.repeat([0, 1], 4), margin)
    assert ((placed >= 0.0) & (placed <= 1.0)).all()
    assert 0.0 < np.ptp(placed[:4], axis=0).max() < 0.1


@pytest.mark.parametrize("margin", [np.nan, np.inf])
def test_a_margin_must_be_a_number(margin):
    with pytest.raises(ReadableError, match="The margin must be a number"):
        side_by_side(np.zeros((4, 2)), np.zeros(4, dtype=int), margin)


def test_side_by_side_leaves_corners_without_a_chart():
    uv, chart = random_charts([1.0, 2.0])
    chart[[0, 3]] = -1
    np.testing.assert_array_equal(side_by_side(uv, chart)[[0, 3]], uv[[0, 3]])
    np.testing.assert_array_equal(side_by_side(uv, np.full(len(uv), -1)), uv)


def test_charts_without_extent_are_placed_apart():
    placed = side_by_side(np.zeros((3, 2)), np.arange(3))
    assert np.isfinite(placed).all()
    assert len(np.unique(placed, axis=0)) == 3


@pytest.mark.parametrize("magnitude", [1e-12, 1.0, 1e12])
def test_former_bounds_are_filled_as_far_as_the_shape_allows(magnitude):
    former = np.array([(3.0, 5.0), (7.0, 5.0), (7.0, 6.0), (3.0, 6.0)])
    uv, placed = in_former_bounds(RECTANGLE * magnitude, former, np.zeros(4, dtype=int))
    assert placed.all()
    low, high = box(uv)
    np.testing.assert_allclose(high - low, (2.0, 1.0))
    np.testing.assert_allclose((low + high) / 2.0, (5.0, 5.5))


def test_chart_of_another_shape_is_turned_when_it_fits_larger_that_way():
    former = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)])
    uv, _ = in_former_bounds(RECTANGLE, former, np.zeros(4, dtype=int))
    np.testing.assert_allclose(box(uv), [(0.0, 0.0), (1.0, 2.0)], atol=1e-15)
    # Turned, not mirrored: the winding stays.
    assert signed_area(uv) > 0.0


@pytest.mark.parametrize("quarters", range(4))
@pytest.mark.parametrize("shape", [RECTANGLE, RECTANGLE * (0.5, 1.0)], ids=["rectangle", "square"])
def test_chart_in_place_lies_as_it_did(shape, quarters):
    turned = shape
    for _ in range(quarters):
        turned = turned[:, ::-1] * (-1.0, 1.0)
    # As after another way of unwrapping: turned and distorted somewhat.
    rotation = np.array([(np.cos(0.3), np.sin(0.3)), (-np.sin(0.3), np.cos(0.3))])
    former = (turned * 3.0) @ rotation * (1.2, 1.0) + (5.0, 7.0)
    uv, placed = in_former_bounds(shape, former, np.zeros(4, dtype=int))
    assert placed.all()
    side, expected = uv[1] - uv[0], turned[1] - turned[0]
    np.testing.assert_allclose(side / np.linalg.norm(side), expected / np.linalg.norm(expected), atol=1e-12)
    again, _ = in_former_bounds(shape, uv, np.zeros(4, dtype=int))
    np.testing.assert_allclose(again, uv, atol=1e-12)


def test_chart_in_place_stays_upright_where_nothing_tells_how_it_lay():
    rng = np.random.default_rng(3)
    # Many points of a square, so that noise correlates with nothing.
    shape = rng.random((200, 2))
    uv, _ = in_former_bounds(shape, rng.random((200, 2)), np.zeros(200, dtype=int))
    assert np.corrcoef(uv[:, 0], shape[:, 0])[0, 1] == pytest.approx(1.0)


@pytest.mark.parametrize(
    "former",
    [np.zeros((4, 2)), RECTANGLE * (1.0, 0.0), np.full((4, 2), np.nan), np.where(RECTANGLE > 0.0, np.inf, 0.0)],
    ids=["zero", "no height", "not a number", "infinite"],
)
def test_chart_without_former_extent_is_left_and_named(former):
    chart = np.array([0, 0, 0, 0, 2, 2, 2, 2, -1])
    start = np.vstack([RECTANGLE, RECTANGLE, [(9.0, 9.0)]])
    uv, placed = in_former_bounds(start, np.vstack([former, RECTANGLE * 3.0, [(0.0, 0.0)]]), chart)
    assert placed.tolist() == [False] * 4 + [True] * 4 + [False]
    np.testing.assert_array_equal(uv[~placed], start[~placed])
    np.testing.assert_allclose(uv[placed], RECTANGLE * 3.0)
