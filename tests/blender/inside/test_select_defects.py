# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectral Select: flipped and overlapping faces."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def selected_uv_faces(edited):
    """The faces all of whose UVs are selected in the UV editor without sync selection."""
    flags = scenes.uv_flags(edited)
    corners = np.array(flags[0] if isinstance(flags, tuple) else flags).all(axis=1)
    return np.flatnonzero(corners.reshape(-1, 4).all(axis=1)).tolist()


def folded_grid(fold=3.0, columns=5, name="Grid", offset=0.0):
    """A row of quads, in edit mode, mapped as it lies but folded over at u = `fold`, and moved along v."""
    edited = scenes.grid(columns, 1, name=name)
    scenes.edit(edited, select=False)
    fold_over(edited, fold, offset)
    return edited


def fold_over(edited, fold, offset=0.0):
    u, v, _ = scenes.corner_positions(edited).T
    scenes.write_uv(edited, np.stack([fold - np.abs(u - fold), v + offset], axis=1))


def test_flipped_and_overlapping_faces_are_selected_and_counted(reports):
    edited = folded_grid()
    before = scenes.read_uv(edited)
    bpy.ops.mesh.select_mode(type="VERT")
    reports()
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert reports() == [("Info", "Selected 4 faces: 2 flipped, 4 overlapping")]
    assert scenes.selected_faces(edited) == [1, 2, 3, 4]
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)
    np.testing.assert_array_equal(scenes.read_uv(edited), before)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"kind": "FLIPPED"}, [3, 4]),
        ({"kind": "OVERLAPPING"}, [1, 2, 3, 4]),
        ({"kind": "FLIPPED", "extend": True}, [0, 3, 4]),
    ],
)
def test_options(options, expected):
    edited = folded_grid()
    scenes.select_faces(edited, [0])
    assert bpy.ops.uv.spectral_select(**options) == {"FINISHED"}
    assert scenes.selected_faces(edited) == expected


def test_without_defects_the_selection_stays(reports):
    edited = folded_grid(fold=9.0)
    scenes.select_faces(edited, [0, 4])
    state = scenes.state(edited)
    reports()
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert reports() == [("Info", "No flipped or overlapping faces, selection unchanged")]
    assert scenes.state(edited) == state


def test_hidden_faces_neither_count_nor_change():
    edited = folded_grid()
    scenes.select_faces(edited, [3, 4])
    bpy.ops.mesh.hide()
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert scenes.selected_faces(edited) == []
    bpy.ops.mesh.reveal(select=False)
    scenes.select_faces(edited, [3])
    bpy.ops.mesh.hide()
    # The hidden face divides the island.
    assert bpy.ops.uv.spectral_select(kind="DEFECTS", between_islands=True) == {"FINISHED"}
    assert scenes.selected_faces(edited) == [1, 4]
    assert [face.hide for face in scenes.edit_mesh(edited).faces] == [False, False, False, True, False]


def test_all_meshes_are_looked_at_and_each_other_when_asked():
    first, second = scenes.grid(5, 1, name="First"), scenes.grid(3, 1, name="Second")
    bare = scenes.grid(2, 1, name="Bare", uv_map=False)
    scenes.edit(first, second, bare)
    fold_over(first, 3.0)
    fold_over(second, 9.0, offset=0.5)
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert [scenes.selected_faces(each) for each in (first, second, bare)] == [[1, 2, 3, 4], [], []]
    assert bpy.ops.uv.spectral_select(kind="DEFECTS", between_islands=True) == {"FINISHED"}
    assert (scenes.selected_faces(first), scenes.selected_faces(second)) == ([0, 1, 2, 3, 4], [0, 1, 2])
    assert not bare.data.uv_layers


def test_only_the_active_uv_map_counts():
    edited = folded_grid()
    edited.data.uv_layers.new(name="Second")
    edited.data.uv_layers.active_index = 1
    fold_over(edited, 9.0)
    scenes.select_faces(edited, [0])
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert scenes.selected_faces(edited) == [0]
    edited.data.uv_layers.active_index = 0
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert scenes.selected_faces(edited) == [1, 2, 3, 4]


def test_faces_whose_uvs_are_not_finite_are_selected(reports):
    edited = folded_grid()
    uv = scenes.read_uv(edited)
    uv[0] = np.nan
    scenes.write_uv(edited, uv)
    reports()
    assert bpy.ops.uv.spectral_select(kind="FLIPPED") == {"FINISHED"}
    assert reports() == [("Info", "Selected 3 faces: 2 flipped, 1 with invalid UVs")]
    assert scenes.selected_faces(edited) == [0, 3, 4]


def test_undo_gives_the_selection_back():
    edited = folded_grid()
    scenes.select_faces(edited, [0])
    bpy.ops.ed.undo_push(message="Before")
    assert bpy.ops.uv.spectral_select("EXEC_DEFAULT", True, kind="DEFECTS") == {"FINISHED"}
    assert scenes.selected_faces(edited) == [1, 2, 3, 4]
    bpy.ops.ed.undo()
    assert scenes.selected_faces(bpy.context.edit_object) == [0]


def test_what_unwrap_counts_is_selected(reports):
    """A ramp that climbs around an axis once and a quarter covers itself in any conformal map."""
    angle = np.linspace(0.0, 2.5 * np.pi, 41)
    vertices = [(r * np.cos(a), r * np.sin(a), 0.05 * a) for a in angle for r in (2.0, 2.5, 3.0)]
    edited = scenes.new_object(vertices, [(a, a + 1, a + 4, a + 3) for i in range(40) for a in (3 * i, 3 * i + 1)])
    scenes.edit(edited)
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    ((_, text),) = reports()
    counted = int(text.partition(" overlapping faces (see Select Flipped and Overlapping)")[0].rpartition(" ")[2])
    assert 16 <= counted < 80
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert reports() == [("Info", f"Selected {counted} faces: {counted} overlapping")]
    assert len(scenes.selected_faces(edited)) == counted


def test_in_the_viewport_uvs_are_selected_too_without_sync_selection():
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = folded_grid()
    scenes.set_uv_flags(edited, np.ones(20, dtype=bool))
    assert bpy.ops.uv.spectral_select(kind="FLIPPED") == {"FINISHED"}
    assert scenes.selected_faces(edited) == [3, 4]
    assert selected_uv_faces(edited) == [3, 4]


def test_in_the_uv_editor_only_uvs_are_selected_of_what_it_shows(uv_editor):
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = folded_grid()
    scenes.select_faces(edited, [0, 1, 2, 3])
    scenes.set_uv_flags(edited, scenes.corners_of(edited, [0]))
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_select(kind="FLIPPED", extend=True) == {"FINISHED"}
    assert scenes.selected_faces(edited) == [0, 1, 2, 3]
    assert selected_uv_faces(edited) == [0, 3]
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert selected_uv_faces(edited) == [2, 3]


@pytest.mark.parametrize("from_uv_editor", [False, True])
def test_uvs_that_are_not_shown_keep_their_selection(uv_editor, from_uv_editor):
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = folded_grid(fold=4.0, columns=6)
    scenes.select_faces(edited, [0])
    bpy.ops.mesh.hide()
    scenes.select_faces(edited, [2, 3, 4, 5])
    scenes.set_uv_flags(edited, scenes.corners_of(edited, [0, 1, 2]))
    with bpy.context.temp_override(**(uv_editor if from_uv_editor else {})):
        assert bpy.ops.uv.spectral_select(kind="FLIPPED") == {"FINISHED"}
    # The viewport shows all but face 0, the UV editor those that were selected.
    assert selected_uv_faces(edited) == ([0, 1, 4, 5] if from_uv_editor else [0, 4, 5])
    assert scenes.edit_mesh(edited).faces[0].hide


def test_sync_selection_follows_the_mesh():
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    edited = folded_grid()
    bm = scenes.edit_mesh(edited)
    if hasattr(bm, "uv_select_sync_valid"):  # from 5.0: a UV selection beside the mesh's, which would go on to be shown
        bm.uv_select_sync_valid = True
    assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert not getattr(scenes.edit_mesh(edited), "uv_select_sync_valid", False)


def test_in_the_uv_editor_uvs_at_one_place_are_selected_together(uv_editor):
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = folded_grid(fold=4.0)
    bpy.ops.mesh.select_all(action="SELECT")
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_select(kind="FLIPPED") == {"FINISHED"}
    flags = scenes.uv_flags(edited)
    corners = np.array(flags[0] if isinstance(flags, tuple) else flags)[:, 0]
    # The last face, and the two corners of the one before it on their common edge.
    np.testing.assert_array_equal(corners, scenes.corner_positions(edited)[:, 0] >= 4.0)


def test_in_the_uv_editor_with_sync_selection_all_visible_faces_count(uv_editor):
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    edited = folded_grid()
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_select(kind="DEFECTS") == {"FINISHED"}
    assert scenes.selected_faces(edited) == [1, 2, 3, 4]
