# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed islands keep off the faces that stay where they are."""

import numpy as np
import pytest
from spectral_unwrap.core.layout.obstacles import face_boxes, place_beside
from spectral_unwrap.core.mesh.polygon_mesh import PolygonMesh

WHOLE = np.array([[(0.0, 0.0), (1.0, 1.0)]])


def box(x0, y0, x1, y1):
    return np.array([[(x0, y0), (x1, y1)]], dtype=float)


def overlap(one, other):
    """Return whether two arrays of boxes overlap in an area."""
    low = np.maximum(one[:, None, 0], other[None, :, 0])
    high = np.minimum(one[:, None, 1], other[None, :, 1])
    return bool((high - low > 1e-12).all(axis=2).any())


def placed(packed, *staying):
    scale, offset = place_beside(packed, staying)
    return packed * scale + offset, scale, offset


def test_nothing_in_the_way_moves_nothing():
    for staying in ([], [box(1.0, 0.0, 2.0, 0.5)], [box(-3.0, -3.0, -2.0, -2.0)], [np.empty((0, 2, 2))]):
        assert place_beside(WHOLE, staying) == (1.0, pytest.approx([0.0, 0.0]))
    # In the same tile, and yet apart.
    assert place_beside(box(0.0, 0.0, 0.5, 1.0), [box(0.6, 0.0, 0.8, 0.8)]) == (1.0, pytest.approx([0.0, 0.0]))


def test_the_largest_free_square_is_taken():
    new, scale, offset = placed(WHOLE, box(0.0, 0.0, 0.25, 0.3))
    assert (scale, offset.tolist()) == (0.75, [0.25, 0.0])
    assert not overlap(new, box(0.0, 0.0, 0.25, 0.3))
    new, scale, offset = placed(WHOLE, box(0.0, 0.75, 1.0, 1.0), box(0.7, 0.0, 0.71, 0.1))
    assert scale == pytest.approx(0.6875, abs=0.02)
    assert not overlap(new, box(0.7, 0.0, 0.71, 0.1))


def test_without_room_the_next_free_tile_is_taken():
    staying = [box(0.2, 0.2, 0.8, 0.8), box(1.5, -0.5, 1.6, 0.5)]
    new, scale, offset = placed(WHOLE, *staying)
    assert (scale, offset.tolist()) == (1.0, [2.0, 0.0])
    assert not any(overlap(new, other) for other in staying)


def test_a_map_that_nobody_has_made_is_no_obstacle():
    assert place_beside(WHOLE, [WHOLE]) == (1.0, pytest.approx([0.0, 0.0]))


@pytest.mark.parametrize("seed", range(20))
def test_random_obstacles_are_never_covered(seed):
    rng = np.random.default_rng(seed)
    low = rng.uniform(-0.5, 1.5, (rng.integers(1, 30), 2))
    staying = np.stack([low, low + rng.uniform(0.0, 0.3, low.shape)], axis=1)
    assert not overlap(placed(WHOLE, staying)[0], staying)


def test_boxes_of_faces():
    mesh = PolygonMesh(np.zeros((7, 3)), np.array([0, 4, 7]), np.arange(7), np.empty((0, 2)), np.ones(2, bool))
    uv = np.array([(0, 0), (1, 0), (1, 2), (0, 2), (3, 3), (4, 3), (4, 5)], dtype=float)
    assert face_boxes(mesh, uv, np.array([False, True])).tolist() == [[[3.0, 3.0], [4.0, 5.0]]]
    assert face_boxes(mesh, uv, np.array([False, False])).shape == (0, 2, 2)
    uv[5] = np.nan
    assert face_boxes(mesh, uv, np.array([True, True])).tolist() == [[[0.0, 0.0], [1.0, 2.0]]]
