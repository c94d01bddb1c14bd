# SPDX-License-Identifier: GPL-3.0-or-later
"""Pins: hard, soft, single, conflicting, and unselected UVs as pins; compared with Blender's own Unwrap."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def positions_as_uv(edited, scale=0.1):
    """Give a map in the plane of the first two axes; return it as Blender stores it."""
    scenes.write_uv(edited, scenes.corner_positions(edited)[:, :2] * scale)
    return scenes.read_uv(edited)


def at_vertex(edited, vertex):
    """Return the corners at a vertex, (C,) bool."""
    return scenes.corner_vertices(edited) == vertex


def pinned_by(edited, vertices):
    """Pin the corners at these vertices; return them, (C,) bool."""
    corners = np.any([at_vertex(edited, vertex) for vertex in vertices], axis=0)
    scenes.pin(edited, corners)
    return corners


def area(uv):
    """Return the area of all quads of `uv` (C, 2)."""
    a, b, c, d = uv.reshape(-1, 4, 2).transpose(1, 0, 2)
    p, q = c - a, d - b
    return np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() / 2.0


def grid_with_moved_pin(offset):
    """A bumpy grid in edit mode with three pins, one of them moved by `offset`; its UVs and the pinned corners."""
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    uv = positions_as_uv(grid)
    uv[at_vertex(grid, 34)] += offset
    scenes.write_uv(grid, uv)
    return grid, scenes.read_uv(grid), pinned_by(grid, [0, 6, 34])


@pytest.mark.parametrize("keep_in_place", [False, True])
def test_pins_hold_exactly_and_the_rest_is_blenders_lscm(reports, keep_in_place):
    grid, before, corners = grid_with_moved_pin((0.05, 0.02))
    state = scenes.state(grid)
    reports()
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    assert ("Info", "1 island with pins: solved by pinned least squares (LSCM)") in reports()
    ours = scenes.read_uv(grid)
    np.testing.assert_array_equal(ours[corners], before[corners])
    assert scenes.state(grid) == state
    scenes.write_uv(grid, before)
    assert bpy.ops.uv.unwrap(method="CONFORMAL") == {"FINISHED"}
    theirs = scenes.read_uv(grid)
    np.testing.assert_allclose(theirs[corners], before[corners], atol=1e-6)
    # Blender splits quads by other diagonals.
    assert np.abs(ours - theirs).max() < 0.03 * np.ptp(theirs, axis=0).max()


def test_soft_pins_attract(reports):
    grid, before, corners = grid_with_moved_pin((0.1, 0.1))
    reports()
    offsets = []
    for strength in (0.01, 100.0):
        scenes.write_uv(grid, before)
        assert bpy.ops.uv.spectral_unwrap(soft_pins=strength) == {"FINISHED"}
        offsets.append(np.abs(scenes.read_uv(grid)[corners] - before[corners]).max())
    assert ("Info", "1 island with pins: solved by the spectral method with soft pins") in reports()
    assert offsets[1] < offsets[0]
    assert offsets[0] > 1e-3


def test_single_pin_holds_and_keeps_the_area_as_blender_does():
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    before = positions_as_uv(grid, 0.05)
    corners = pinned_by(grid, [8])
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    ours = scenes.read_uv(grid)
    scenes.write_uv(grid, before)
    assert bpy.ops.uv.unwrap(method="CONFORMAL") == {"FINISHED"}
    theirs = scenes.read_uv(grid)
    for uv in (ours, theirs):
        np.testing.assert_allclose(uv[corners], before[corners], atol=1e-6)
        assert area(uv) == pytest.approx(area(before), rel=1e-4)
    assert not np.allclose(ours, before, atol=1e-3)


def test_pinned_islands_stay_while_others_are_packed():
    both = scenes.cube(all_seams=True)
    scenes.edit(both)
    before = scenes.read_uv(both)
    quad = np.array([(0.2, 0.2), (0.3, 0.2), (0.3, 0.3), (0.2, 0.3)])
    before[:4] = quad
    scenes.write_uv(both, before)
    before = scenes.read_uv(both)
    scenes.pin(both, [0, 1])
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    after = scenes.read_uv(both)
    np.testing.assert_array_equal(after[:2], before[:2])
    np.testing.assert_allclose(after[:4], quad, atol=1e-5)
    assert after[4:].max() == pytest.approx(1.0, abs=0.02)


def test_pins_of_unselected_faces_do_not_count():
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    scenes.pin(grid, np.arange(4 * 12, 4 * 24))
    scenes.select_faces(grid, range(12))
    # The faces on the border of the selection share pinned vertices, not pinned corners.
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    # None holds: all lie apart from the rest, which they shared vertices with.
    assert not scenes.overlapping_faces(grid)[:12].any()


def test_unselected_uvs_of_affected_faces_are_pins_in_the_uv_editor(uv_editor):
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    before = positions_as_uv(grid)
    fixed = at_vertex(grid, 0) | at_vertex(grid, 6) | at_vertex(grid, 30)
    scenes.set_uv_flags(grid, ~fixed)
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        ours = scenes.read_uv(grid)
        scenes.write_uv(grid, before)
        assert bpy.ops.uv.unwrap(method="CONFORMAL") == {"FINISHED"}
    theirs = scenes.read_uv(grid)
    np.testing.assert_array_equal(ours[fixed], before[fixed])
    np.testing.assert_allclose(theirs[fixed], before[fixed], atol=1e-6)
    assert np.abs(ours - theirs).max() < 0.03 * np.ptp(theirs, axis=0).max()


def test_pins_are_held_on_an_image_that_is_not_square():
    grid = scenes.bumpy_grid()
    scenes.show_image(grid, 1024, 256)
    scenes.edit(grid)
    before = positions_as_uv(grid) * (0.25, 1.0)
    scenes.write_uv(grid, before)
    before = scenes.read_uv(grid)
    corners = pinned_by(grid, [0, 6, 34])
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    ours = scenes.read_uv(grid)
    np.testing.assert_array_equal(ours[corners], before[corners])
    scenes.write_uv(grid, before)
    assert bpy.ops.uv.unwrap(method="CONFORMAL") == {"FINISHED"}
    theirs = scenes.read_uv(grid)
    assert (np.abs(ours - theirs).max(axis=0) < 0.03 * np.ptp(theirs, axis=0)).all()
