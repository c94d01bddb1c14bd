# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Failed Islands."""

import bpy
import numpy as np

from tests.blender.inside import scenes


def selected_faces(edited):
    return [face.index for face in scenes.edit_mesh(edited).faces if face.select]


def test_faces_of_closed_islands_are_selected_and_nothing_written(reports):
    both, cube = scenes.grid_and_cube(), scenes.cube(name="Cube", offset=(0.0, 9.0, 0.0))
    scenes.edit(both, cube)
    before = scenes.read_uv(both)
    reports()
    assert bpy.ops.uv.spectral_select_failed() == {"FINISHED"}
    assert reports() == [("Info", "Selected 12 faces of 2 failed islands")]
    assert selected_faces(both) == list(range(6, 12))
    assert selected_faces(cube) == list(range(6))
    np.testing.assert_array_equal(scenes.read_uv(both), before)


def test_all_visible_faces_count_where_none_is_selected():
    both = scenes.grid_and_cube()
    scenes.edit(both, select=False)
    assert bpy.ops.uv.spectral_select_failed() == {"FINISHED"}
    assert selected_faces(both) == list(range(6, 12))


def test_hidden_faces_do_not_count(reports):
    both = scenes.grid_and_cube()
    scenes.edit(both)
    scenes.select_faces(both, range(6, 12))
    bpy.ops.mesh.hide()
    reports()
    assert bpy.ops.uv.spectral_select_failed() == {"CANCELLED"}
    assert reports() == [("Info", "No islands failed, selection unchanged")]
    assert selected_faces(both) == []


def test_without_failures_the_selection_stays(reports):
    grid = scenes.grid(3, 3)
    scenes.edit(grid)
    scenes.select_faces(grid, [0, 4])
    state = scenes.state(grid)
    assert bpy.ops.uv.spectral_select_failed() == {"CANCELLED"}
    assert scenes.state(grid) == state


def test_vertex_selection_becomes_face_selection():
    both = scenes.grid_and_cube()
    scenes.edit(both)
    bpy.ops.mesh.select_mode(type="VERT")
    assert bpy.ops.uv.spectral_select_failed() == {"FINISHED"}
    assert selected_faces(both) == list(range(6, 12))
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)


def test_uvs_are_selected_too_without_sync_selection():
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    both = scenes.grid_and_cube()
    scenes.edit(both)
    scenes.set_uv_flags(both, np.ones(48, dtype=bool))
    assert bpy.ops.uv.spectral_select_failed() == {"FINISHED"}
    flags = scenes.uv_flags(both)
    corners = flags[0] if isinstance(flags, tuple) else flags
    np.testing.assert_array_equal(np.array(corners).all(axis=1), scenes.corners_of(both, range(6, 12)))


def test_needs_edit_mode():
    grid = scenes.grid(1, 1)
    bpy.context.view_layer.objects.active = grid
    assert not bpy.ops.uv.spectral_select_failed.poll()
