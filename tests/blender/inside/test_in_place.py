# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of an island is solved where it lies, while the UVs that it shares with the rest stay to the bit."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes
from tests.blender.inside.test_control import add_extender

# Of a grid of 8 x 6 faces: the four in the middle of each of the three middle rows, and these with the border faces
# at their left end.
BLOCK = [8 * row + column for row in (2, 3, 4) for column in (2, 3, 4, 5)]
STRIP = [8 * row + column for row in (2, 3) for column in (0, 1, 2)]


def mapped_grid(faces, mirrored=False, jitter=0.02):
    """A bumpy grid in edit mode with its map, jittered inside the `faces`, which are selected; and its UVs."""
    grid = scenes.bumpy_grid(8, 6)
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    uv = scenes.read_uv(grid)
    if mirrored:
        uv[:, 0] = 1.0 - uv[:, 0]
    vertices, free = scenes.corner_vertices(grid), ~shared_with_others(grid, faces)
    moved = np.random.default_rng(5).normal(size=(len(grid.data.vertices), 2)) * jitter
    inside = scenes.corners_of(grid, faces) & free
    uv[inside] += moved[vertices[inside]]
    scenes.write_uv(grid, uv)
    scenes.select_faces(grid, faces)
    return grid, scenes.read_uv(grid)


def shared_with_others(edited, faces):
    """Return the corners of the faces at vertices of other faces, (C,) bool."""
    vertices, inside = scenes.corner_vertices(edited), scenes.corners_of(edited, faces)
    return inside & np.isin(vertices, vertices[~inside])


def assert_solved_in_place(grid, before, faces):
    """Assert that only UVs of the faces have changed that no other face shares."""
    after = scenes.read_uv(grid)
    free = scenes.corners_of(grid, faces) & ~shared_with_others(grid, faces)
    np.testing.assert_array_equal(after[~free], before[~free])
    assert (after[free] != before[free]).any(axis=1).all()
    # The UVs of a vertex stay together.
    vertices = scenes.corner_vertices(grid)
    for vertex in set(vertices[free].tolist()):
        assert len(np.unique(after[vertices == vertex], axis=0)) == 1
    return after


@pytest.mark.parametrize("faces", [BLOCK, STRIP], ids=["inside", "at the border"])
@pytest.mark.parametrize("keep_in_place", [False, True])
@pytest.mark.parametrize("mirrored", [False, True])
def test_the_rest_stays_to_the_bit_and_the_part_is_good(reports, faces, keep_in_place, mirrored):
    grid, before = mapped_grid(faces, mirrored)
    reports()
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    after = assert_solved_in_place(grid, before, faces)
    held = len(set(scenes.corner_vertices(grid)[shared_with_others(grid, faces)].tolist()))
    assert ("Info", f"1 part of an island solved in place; {held} UVs shared with the rest stayed") in reports()
    # The jitter is gone: no face is distorted much.
    qc, _ = scenes.quasi_conformal(grid)
    assert qc.reshape(-1, 2)[faces].max() < 1.5
    scenes.write_uv(grid, before)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), after)


@pytest.mark.parametrize("mirrored", [False, True])
def test_extenders_act_in_a_part_also_while_they_are_adjusted(mirrored):
    grid, before = mapped_grid(BLOCK, mirrored)
    vertices = scenes.corner_vertices(grid)
    # Ends of a row of the vertices that are free.
    first, last = (np.flatnonzero(vertices == vertex)[0] for vertex in (9 * 3 + 3, 9 * 3 + 5))
    # An extender that does nothing yet, but leaves the map unpolished.
    add_extender(grid, vertices[first], vertices[last], 1e-9)
    scenes.select_faces(grid, BLOCK)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    plain = scenes.read_uv(grid)
    extender = grid.data.spectral_shapes[0]
    extender.amount = 100.0 / 3.0

    def assert_pushed(factor):
        after = assert_solved_in_place(grid, before, BLOCK)
        np.testing.assert_allclose(after[last] - after[first], factor * (plain[last] - plain[first]), atol=1e-6)
        return after

    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    after = assert_pushed(1.5)
    assert bpy.ops.uv.spectral_extender(amount=20.0) == {"FINISHED"}
    assert_pushed(1.25)
    # With nothing selected, the part that was solved last counts.
    bpy.ops.mesh.select_all(action="DESELECT")
    assert bpy.ops.uv.spectral_extender(amount=100.0 / 3.0) == {"FINISHED"}
    np.testing.assert_allclose(assert_pushed(1.5), after, atol=1e-6)
    # One that is off shows what it would do, too.
    extender.use = False
    assert bpy.ops.uv.spectral_extender(amount=20.0) == {"FINISHED"}
    assert_pushed(1.25)


def test_without_the_switch_the_part_is_cut_off(reports):
    grid, before = mapped_grid(BLOCK)
    assert bpy.ops.uv.spectral_unwrap(hold_rest=False) == {"FINISHED"}
    after = scenes.read_uv(grid)
    inside = scenes.corners_of(grid, BLOCK)
    assert (after[inside] != before[inside]).any(axis=1).all()
    np.testing.assert_array_equal(after[~inside], before[~inside])
    # A seam around it cuts it off, too.
    bpy.ops.object.mode_set(mode="OBJECT")
    grid, before = mapped_grid(BLOCK)
    for edge in scenes.edit_mesh(grid).edges:
        edge.seam = len({face.index in BLOCK for face in edge.link_faces}) == 2
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert not any("in place" in text for _, text in reports())


@pytest.mark.parametrize("sync", [True, False])
@pytest.mark.parametrize("mode", ["VERTEX", "FACE"])
def test_in_the_uv_editor_the_selection_shown_there_counts(sync, mode):
    tool_settings = bpy.context.scene.tool_settings
    # First: in Blender 4.5, a change of the mode may select more faces.
    tool_settings.use_uv_select_sync, tool_settings.uv_select_mode = sync, mode
    grid, before = mapped_grid(BLOCK)
    window = bpy.context.window_manager.windows[0]
    window.screen.areas[0].ui_type = "UV"
    if not sync:
        scenes.select_faces(grid, range(48))
        # Sticky selection: the UVs of the block at all faces.
        vertices = scenes.corner_vertices(grid)
        scenes.set_uv_flags(grid, np.isin(vertices, vertices[scenes.corners_of(grid, BLOCK)]))
    with bpy.context.temp_override(window=window, area=window.screen.areas[0]):
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    if sync or mode == "FACE":
        assert_solved_in_place(grid, before, BLOCK)
    else:
        # Selected UVs move, the others are held.
        after = scenes.read_uv(grid)
        flags = np.isin(vertices, vertices[scenes.corners_of(grid, BLOCK)])
        np.testing.assert_array_equal(after[~flags], before[~flags])
        assert (after[flags] != before[flags]).any(axis=1).all()


@pytest.mark.parametrize("mirrored, levels", [(False, 0), (True, 0), (False, 1), (True, 2)])
def test_one_coordinate_of_a_whole_island_has_the_least_energy_with_the_other_as_it_is(mirrored, levels):
    grid, conformal = mapped_grid(range(48), mirrored, jitter=0.0)
    if levels:
        grid.modifiers.new("Subdivision", "SUBSURF").levels = levels
        assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
        conformal = scenes.read_uv(grid) * ((-1.0, 1.0) if mirrored else (1.0, 1.0))
    before = conformal * (0.3, 1.0)
    scenes.write_uv(grid, before)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True, blend=(1.0, 0.0), use_subsurf_data=levels > 0) == {"FINISHED"}
    after = scenes.read_uv(grid)
    np.testing.assert_array_equal(after[:, 1], before[:, 1])
    middles = [(each[:, 0].min() + each[:, 0].max()) / 2 for each in (after, before)]
    assert middles[0] == pytest.approx(middles[1], abs=1e-6)
    # As wide again as the map that is conformal, and on its own side; two thirds of its energy are polished away.
    np.testing.assert_allclose(after[:, 0] - middles[0], conformal[:, 0] - middles[0] / 0.3, atol=0.02)


def test_one_coordinate_a_blend_pins_and_hidden_faces():
    grid, before = mapped_grid(BLOCK)
    inside = scenes.corners_of(grid, BLOCK)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    whole = scenes.read_uv(grid)
    for moved, stays in ((0, 1), (1, 0)):
        scenes.write_uv(grid, before)
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=True, blend=(stays, moved)) == {"FINISHED"}
        after = scenes.read_uv(grid)
        np.testing.assert_array_equal(after[:, stays], before[:, stays])
        changed = (after[:, moved] != before[:, moved]) & inside
        # The least energy with the other coordinate as it is, not that of the whole map.
        assert changed.any()
        assert (np.abs(after[:, moved] - whole[:, moved])[changed] > 1e-6).any()
    for blend in ((0.25, 0.25), (0.25, 0.75), (0.0, 0.0)):
        expected = before + np.array(blend) * (whole - before)
        scenes.write_uv(grid, before)
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=True, blend=blend) == {"FINISHED"}
        np.testing.assert_allclose(scenes.read_uv(grid), expected, atol=1e-6)
    scenes.write_uv(grid, before)
    pinned = scenes.corner_vertices(grid) == scenes.corner_vertices(grid)[4 * 27 + 2]
    assert pinned[inside].any()
    scenes.pin(grid, pinned)
    for face in scenes.edit_mesh(grid).faces:
        face.hide_set(face.index == BLOCK[0])
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    after = scenes.read_uv(grid)
    stays = ~inside | pinned | scenes.corners_of(grid, BLOCK[:1])
    np.testing.assert_array_equal(after[stays], before[stays])
    assert (after != before).any()


def test_parts_without_a_free_uv_and_maps_without_extent_are_said(reports):
    grid, before = mapped_grid([27])
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert any("unselected faces share all UVs" in text for level, text in reports() if level == "Warning")
    # All UVs at one point are no map: the selected faces are unwrapped by themselves.
    scenes.write_uv(grid, np.full_like(before, 0.5))
    scenes.select_faces(grid, BLOCK)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    inside = scenes.corners_of(grid, BLOCK)
    after = scenes.read_uv(grid)
    np.testing.assert_array_equal(after[~inside], 0.5)
    assert np.ptp(after[inside]) > 0.5


def test_parts_of_several_objects():
    grid, before = mapped_grid(BLOCK)
    bpy.ops.object.mode_set(mode="OBJECT")
    other, other_before = mapped_grid(STRIP)
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.edit(grid, other, select=False)
    scenes.select_faces(grid, BLOCK)
    scenes.select_faces(other, STRIP)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert_solved_in_place(grid, before, BLOCK)
    assert_solved_in_place(other, other_before, STRIP)


@pytest.mark.parametrize("offset, counted", [(0.0, True), (9.0, False)])
def test_faces_that_come_to_lie_on_another_island_are_said(reports, offset, counted):
    """An island squeezed to a strip gets its width back, over its neighbor."""
    tall, beside = scenes.grid(4, 4, name="Tall"), scenes.grid(4, 4, name="Beside")
    scenes.edit(tall, beside)
    # Inside the bounding box of the other, of which it leaves three quarters free: a leaning strip.
    u, v, _ = scenes.corner_positions(tall).T
    scenes.write_uv(tall, np.stack([v + 0.05 * u, v - 0.05 * u], axis=1) / 4.0)
    u, v, _ = scenes.corner_positions(beside).T
    scenes.write_uv(beside, np.stack([0.7 + u / 20.0 + offset, 0.1 + v / 20.0], axis=1))
    scenes.select_faces(beside, [])
    bpy.ops.mesh.select_all(action="DESELECT")
    scenes.select_faces(tall, range(16))
    reports()
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    said = [text for level, text in reports() if level == "Warning" and "now; Spectral Pack separates them" in text]
    assert bool(said) == counted
    # Packed islands lie apart.
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert not any("separates them" in text for _, text in reports())
