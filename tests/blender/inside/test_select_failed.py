# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Failed Islands."""

import importlib

import bpy
import numpy as np

from tests.blender.inside import scenes

island_list = importlib.import_module("spectral_unwrap.unwrapping.island_list")


def unwrapped(*objects, select=True, **options):
    """Put objects into edit mode and unwrap what is selected there."""
    scenes.edit(*objects, select=select)
    if select:
        assert bpy.ops.uv.spectral_unwrap(**options) <= {"FINISHED", "CANCELLED"}


def test_faces_of_closed_islands_are_selected_and_nothing_written(reports):
    both, cube = scenes.grid_and_cube(), scenes.cube(name="Cube", offset=(0.0, 9.0, 0.0))
    unwrapped(both, cube)
    before = scenes.read_uv(both)
    reports()
    assert island_list.selecting() == ("FAILED",)
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert reports() == [("Info", "Selected 12 faces of 2 failed islands")]
    assert scenes.selected_faces(both) == list(range(6, 12))
    assert scenes.selected_faces(cube) == list(range(6))
    np.testing.assert_array_equal(scenes.read_uv(both), before)


def test_the_last_result_counts_whatever_would_fail_now():
    both = scenes.grid_and_cube()
    unwrapped(both)
    # The cube opened, it would not fail any more.
    for edge in scenes.edit_mesh(both).edges:
        edge.seam = True
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert scenes.selected_faces(both) == list(range(6, 12))
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"CANCELLED"}


def test_islands_that_are_not_unwrapped_again_stay_failed(reports):
    vertices, faces = scenes.cube_parts()
    pair = scenes.new_object(np.vstack([vertices, vertices + 5.0]), [*faces, *(faces + len(vertices))])
    unwrapped(pair)
    for edge in scenes.edit_mesh(pair).edges:
        edge.seam = True
    scenes.select_faces(pair, range(6))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    reports()
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert reports() == [("Info", "Selected 6 faces of 1 failed island")]
    assert scenes.selected_faces(pair) == list(range(6, 12))


def test_without_a_remembered_result_it_says_so(reports):
    both = scenes.grid_and_cube()
    scenes.edit(both)
    state = scenes.state(both)
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"CANCELLED"}
    ((level, text),) = reports()
    assert level == "Warning"
    assert "unwrap first" in text
    assert scenes.state(both) == state


def test_changed_faces_are_noticed_and_undone_ones_known_again(reports):
    both = scenes.grid_and_cube()
    unwrapped(both)
    bpy.ops.ed.undo_push(message="Unwrapped")
    scenes.select_faces(both, [0])
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.ed.undo_push(message="Deleted")
    state = scenes.state(both)
    reports()
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"CANCELLED"}
    assert reports() == [("Warning", "The faces of Grid and cube have changed since the last unwrap; unwrap again")]
    assert scenes.state(both) == state
    bpy.ops.ed.undo()
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert scenes.selected_faces(bpy.context.edit_object) == list(range(6, 12))


def test_moved_vertices_change_nothing_of_the_result():
    both = scenes.grid_and_cube()
    unwrapped(both)
    scenes.edit_mesh(both).verts[0].co.z += 1.0
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert scenes.selected_faces(both) == list(range(6, 12))


def test_hidden_faces_do_not_count(reports):
    both = scenes.grid_and_cube()
    unwrapped(both)
    scenes.select_faces(both, range(6, 12))
    bpy.ops.mesh.hide()
    reports()
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"CANCELLED"}
    assert reports() == [("Info", "No islands failed, selection unchanged")]
    assert scenes.selected_faces(both) == []


def test_a_mesh_refused_as_a_whole_is_one_island(reports):
    bad = scenes.grid(2, 2)
    bad.data.vertices[0].co.x = float("nan")
    unwrapped(bad)
    reports()
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert reports() == [("Info", "Selected 4 faces of 1 failed island")]


def test_without_failures_the_selection_stays(reports):
    grid = scenes.grid(3, 3)
    unwrapped(grid)
    scenes.select_faces(grid, [0, 4])
    state = scenes.state(grid)
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"CANCELLED"}
    assert scenes.state(grid) == state
