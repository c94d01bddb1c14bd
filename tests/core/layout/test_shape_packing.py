# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of several meshes packed by their shapes, around the faces that stay."""

from dataclasses import replace

import numpy as np
import pytest
from spectral_unwrap.core.layout.placement import place
from spectral_unwrap.core.layout.shape_packing import (
    IGNORED,
    STAYS,
    ShapePacking,
    covered,
    free_tile,
    obstacles,
    tile_of,
)
from spectral_unwrap.core.solve.options import Options, Settings
from spectral_unwrap.core.solve.solution import solve

from tests.core.polygon_meshes import polygon_mesh


def squares(*boxes, aspect=1.0):
    """A mesh of separate rectangles, each given as low u, low v, high u, high v."""
    uv = np.array([[(a, b), (c, b), (c, d), (a, d)] for a, b, c, d in boxes], dtype=float).reshape(-1, 2)
    return polygon_mesh(uv, uv=uv, aspect=aspect)


def raster(uv, low=(0.0, 0.0)):
    """Return how many of the rectangles and diamonds, (n, 4, 2), cover each of 512 x 512 points of the tile."""
    x, y = np.meshgrid(*(np.arange(512) / 512 + 1 / 1024 + start for start in low))
    found = np.zeros((512, 512), dtype=int)
    for corners in uv.reshape(-1, 4, 2):
        sides = [
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) for a, b in zip(corners, np.roll(corners, -1, 0))
        ]
        found += np.min(sides, axis=0) > 1e-7
    return found


def test_islands_of_two_meshes_are_packed_around_what_stays():
    one, two = squares((0, 0, 1, 3), (0, 0, 2, 1), (0.0, 0.0, 0.4, 0.4)), squares((0, 0, 1, 1), (5, 5, 6, 6))
    islands = [np.array([0, 1, STAYS]), np.array([2, IGNORED])]
    packed = ShapePacking([one, two], [one.uv, two.uv], islands, 1024.0, 8.0).now()
    np.testing.assert_array_equal(packed.maps[0][8:], one.uv[8:])
    np.testing.assert_array_equal(packed.maps[1][4:], two.uv[4:])
    together = np.concatenate([packed.maps[0], packed.maps[1][:4]])
    assert raster(together).max() == 1
    assert together.min() >= 0.0 and together.max() <= 1.0
    # The area of three of 6 units, without the margin's band.
    assert raster(together[[*range(8), *range(12, 16)]]).mean() == pytest.approx(packed.fill, abs=0.01)
    assert (packed.islands, packed.without_room) == (3, 0)


def test_an_image_that_is_no_square_keeps_shapes():
    mesh = squares((0, 0, 0.5, 1), (0, 0, 0.25, 0.5), (0, 0, 0.5, 0.25), aspect=2.0)
    found = ShapePacking([mesh], [mesh.uv], [np.arange(3)], 1024.0, 4.0).now().maps[0]
    sides = np.linalg.norm(np.diff(found.reshape(3, 4, 2) * (2.0, 1.0), axis=1), axis=2)
    former = np.linalg.norm(np.diff(mesh.uv.reshape(3, 4, 2) * (2.0, 1.0), axis=1), axis=2)
    np.testing.assert_allclose(sides / former, (sides / former)[0, 0], rtol=1e-9)
    assert found.min() >= 0.0 and found.max() <= 1.0


def test_images_of_two_shapes_turn_no_island():
    meshes = [squares((0, 0, 0.2, 1.5), aspect=2.0), squares((0, 0, 0.2, 1.5))]
    packed = ShapePacking(meshes, [mesh.uv for mesh in meshes], [np.array([0]), np.array([1])], 1024.0, 4.0).now()
    for uv in packed.maps:
        np.testing.assert_allclose(np.abs(np.diff(uv, axis=0)).min(axis=1), 0.0, atol=1e-12)


def test_seams_within_an_island_and_steps_that_repeat():
    # Both faces share two vertices, of which one has two UVs.
    mesh = replace(squares((0, 0, 1, 1), (1, 0, 2, 1)), corner_vertices=np.array([0, 1, 2, 3, 1, 4, 5, 2]))
    mesh.uv[7] += 0.01
    one, other = (ShapePacking([mesh], [mesh.uv], [np.zeros(2, int)], 1024.0, 4.0) for _ in range(2))
    one.step(3)
    other.step(3)
    np.testing.assert_array_equal(one.now().maps[0], other.now().maps[0])
    assert np.linalg.norm(np.diff(one.now().maps[0][[2, 7]], axis=0)) > 0.0


def test_tiles():
    points = np.array([(0.5, 0.5), (2.5, 1.5), (2.1, 1.0), (np.nan, 0.0)])
    assert tile_of(points, np.array([3, 2, 2, 9])) == (2, 1)
    assert tile_of(points, np.array([5, 2, 2, 9])) == (0, 0)
    assert tile_of(np.array([(np.inf, 0.5)]), np.ones(1)) == tile_of(np.empty((0, 2)), np.empty(0)) == (0, 0)
    boxes = np.array([[(0.2, 0.2), (0.8, 0.8)], [(1.5, -0.5), (1.6, 0.5)]])
    assert free_tile((0, 0), boxes) == (2, 0)
    assert free_tile((0, 1), boxes) == (1, 1)
    np.testing.assert_allclose(covered(boxes, (0, 0)), [0.36, 0.0])
    np.testing.assert_allclose(covered(boxes, (1, 0)), [0.0, 0.05])


def test_faces_of_a_map_that_nobody_has_made_are_no_obstacles():
    mesh = squares((0, 0, 1, 1), (0, 0, 0.5, 1), (0, 0, np.nan, 1))
    assert obstacles(mesh, mesh.uv, np.ones(3, bool)).tolist() == [False, True, False]


def unwrapped(stays, margin=0.001, aspect=1.0):
    """Three unwrapped rectangles, placed beside the faces at `stays`."""
    mesh = squares((0, 0, 1, 3), (0, 4, 2, 5), (4, 0, 5, 1), *stays)
    mesh = replace(mesh, selected_faces=np.arange(3 + len(stays)) < 3, aspect=aspect)
    mesh.uv[:12] = 0.0
    placement = place([mesh], [solve(mesh, Options())], Settings(margin=margin))
    return placement, np.concatenate([placement.uv[0][:12], mesh.uv[12:]])


def test_unwrapped_islands_lie_beside_those_that_stay():
    placement, together = unwrapped([(0.0, 0.0, 0.5, 0.5)], margin=0.01)
    assert raster(together).max() == 1
    assert not placement.left_tile
    assert raster(placement.uv[0][:12]).mean() == pytest.approx(placement.fill, abs=0.01)


def test_where_little_room_is_left_they_get_a_tile_of_their_own():
    placement, together = unwrapped([(0.05, 0.0, 0.95, 1.0), (1.5, 0.5, 1.6, 0.6)])
    assert placement.left_tile
    assert raster(together, (2.0, 0.0)).max() == 1
    assert placement.uv[0][:12, 0].min() >= 2.0


def test_a_margin_wider_than_the_image_is_high_leaves_room_for_boxes():
    placement, _ = unwrapped([], margin=0.3, aspect=16.0)
    assert np.isfinite(placement.uv[0]).all()


@pytest.mark.parametrize("margin", [0.2, 50.0])
def test_margins_that_leave_no_room_for_shapes_have_some_for_boxes(margin):
    placement, _ = unwrapped([], margin)
    assert np.isfinite(placement.uv[0]).all()
    assert raster(placement.uv[0][:12]).max() <= 1
