# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an island fails, the others are packed off it."""

import bpy
import numpy as np

from tests.blender.inside import scenes

GRID, CUBE = range(6), range(6, 12)


def prepare(low, high):
    """A flat grid, which is solved, and a closed cube, which fails; the cube's UVs fill a box."""
    both = scenes.grid_and_cube()
    scenes.edit(both)
    uv = scenes.read_uv(both)
    (x0, y0), (x1, y1) = low, high
    # A cross would do; six cells in two rows fill the box as well.
    cells = [(i % 3, i // 3) for i in range(6)]
    corners = [(c + dx, r + dy) for c, r in cells for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1))]
    uv[scenes.corners_of(both, CUBE)] = np.array(corners) / (3, 2) * (x1 - x0, y1 - y0) + (x0, y0)
    scenes.write_uv(both, uv)
    return both


def unwrapped(both, **options):
    """Unwrap; return the UVs of the grid and of the cube, which must be what they were."""
    before = scenes.read_uv(both)
    assert bpy.ops.uv.spectral_unwrap(**options) == {"FINISHED"}
    after = scenes.read_uv(both)
    grid, cube = (scenes.corners_of(both, faces) for faces in (GRID, CUBE))
    np.testing.assert_array_equal(after[cube], before[cube])
    # Squares, as the grid has.
    assert np.ptp(scenes.stretches(both, GRID)) < 1e-3 * scenes.stretches(both, GRID).max()
    return after[grid], after[cube]


def test_without_room_they_get_a_tile_of_their_own(reports):
    both = prepare((0.1, 0.1), (0.9, 0.9))
    reports()
    grid, cube = unwrapped(both)
    assert not scenes.overlap(grid, cube)
    assert grid[:, 0].min() >= 1.0
    assert grid[:, 0].max() <= 2.0
    assert [text for level, text in reports() if level == "Warning"][0].startswith("Islands that stay leave")


def test_objects_without_a_selection_stay_and_count_too():
    one, other = scenes.grid(3, 2), scenes.cube(name="Cube")
    scenes.edit(one, other)
    scenes.write_uv(other, np.tile([(0.0, 0.0), (0.3, 0.0), (0.3, 0.3), (0.0, 0.3)], (6, 1)))
    scenes.select_faces(other, [])
    before = scenes.read_uv(other)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(other), before)
    assert not scenes.overlap(scenes.read_uv(one), before)
    assert 0.5 < np.ptp(scenes.read_uv(one), axis=0).max() <= 1.0


def test_kept_in_place_nothing_moves():
    both = prepare((0.0, 0.0), (0.5, 0.5))
    former = scenes.bounds(scenes.read_uv(both)[scenes.corners_of(both, GRID)])
    new = scenes.bounds(unwrapped(both, keep_in_place=True)[0])
    np.testing.assert_allclose(np.add(*new) / 2.0, np.add(*former) / 2.0, atol=1e-5)
