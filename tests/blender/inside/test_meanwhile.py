# SPDX-License-Identifier: GPL-3.0-or-later
"""What else an artist does, in another window or by a script, while a job works on the map."""

import importlib

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import jobs, scenes
from tests.blender.inside.test_relax import edit_hill


def rename_map(edited):
    edited.data.uv_layers[0].name = "Renamed"


def show_another_map(edited):
    # Made before the job, so that its bits are the same.
    edited.data.uv_layers.active = edited.data.uv_layers[1]


def rename_object(edited):
    edited.name = edited.data.name = "Renamed"


def select_another_face(edited):
    scenes.select_faces(edited, [3])


def select_an_edge(edited):
    bm = scenes.edit_mesh(edited)
    bm.edges.ensure_lookup_table()
    bm.select_history.clear()
    bm.select_history.add(bm.edges[7])
    bmesh.update_edit_mesh(edited.data)


def scale_object(edited):
    edited.scale = (1.0, 2.0, 1.0)
    bpy.context.view_layer.update()


HARMLESS = [rename_map, show_another_map, rename_object, select_another_face, select_an_edge, scale_object]


def first_map(edited):
    """The UVs of the first map of a mesh in edit mode, (C, 2)."""
    bm = scenes.edit_mesh(edited)
    layer = bm.loops.layers.uv[0]
    return np.array([tuple(loop[layer].uv) for face in bm.faces for loop in face.loops])


def marked(edited):
    return {tuple(vertex.index for vertex in edge.verts) for edge in scenes.edit_mesh(edited).edges if edge.seam}


def edit_with_two_maps():
    edited, before = edit_hill()
    edited.data.uv_layers.new(name="Other")
    edited.data.uv_layers.active = edited.data.uv_layers[0]
    return edited, before


@pytest.fixture
def relaxation(monkeypatch):
    """A function that begins to relax in a window, with the thread's first map still to be drawn."""
    operator_class = importlib.import_module("spectral_unwrap.operators.relax").UV_OT_spectral_relax

    def begin():
        values = {**jobs.defaults(bpy.ops.uv.spectral_relax), "steps": 5}
        running = jobs.Invoked(monkeypatch, operator_class, is_waiting=False, **values)
        assert running.choice._worker.wait(60.0)
        return running

    return begin


def draw(running, monkeypatch):
    """Let the view draw a map as if its thread, which has ended, worked on."""
    with monkeypatch.context() as patch:
        patch.setattr(running.choice._worker, "wait", lambda _seconds: False)
        running.send("TIMER", "NOTHING")


@pytest.mark.parametrize("change", HARMLESS, ids=lambda change: change.__name__)
def test_an_unwrap_goes_to_the_faces_and_the_map_of_the_click(monkeypatch, change):
    edited, before = edit_with_two_maps()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    expected = first_map(edited)
    scenes.write_uv(edited, before.tolist())
    waiting = jobs.unwrap(monkeypatch)
    change(edited)
    waiting.wait()
    assert waiting.result == {"FINISHED"}
    np.testing.assert_array_equal(first_map(edited), expected)


@pytest.mark.parametrize("change", HARMLESS, ids=lambda change: change.__name__)
def test_esc_restores_the_map_that_was_relaxed(monkeypatch, relaxation, change):
    edited, before = edit_with_two_maps()
    running = relaxation()
    draw(running, monkeypatch)
    assert (first_map(edited) != before).any()
    change(edited)
    assert running.send("ESC") == {"CANCELLED"}
    np.testing.assert_array_equal(first_map(edited), before)
    assert running.left_nothing()


@pytest.mark.parametrize("mode", ["EDIT", "OBJECT"])
def test_a_relaxation_that_loses_edit_mode_leaves_the_former_map(monkeypatch, relaxation, mode):
    edited, before = edit_with_two_maps()
    running = relaxation()
    draw(running, monkeypatch)
    bpy.ops.object.mode_set(mode=mode)
    running.context.mode = "EDIT_MESH" if mode == "EDIT" else "OBJECT"
    running.send("ESC")
    bpy.ops.object.mode_set(mode="EDIT")
    np.testing.assert_array_equal(first_map(edited), before)


def move_an_uv(edited):
    scenes.write_uv(edited, (scenes.read_uv(edited) + (0.25, 0.0)).tolist())


def turn_a_face(edited):
    scenes.select_faces(edited, [3])
    bpy.ops.mesh.flip_normals()


@pytest.mark.parametrize("edit", [move_an_uv, turn_a_face], ids=lambda edit: edit.__name__)
@pytest.mark.parametrize("is_drawn", [False, True], ids=["before the first map", "after"])
def test_an_edit_is_not_overwritten(monkeypatch, relaxation, edit, is_drawn):
    edited, _ = edit_with_two_maps()
    running = relaxation()
    if is_drawn:
        draw(running, monkeypatch)
    edit(edited)
    after = first_map(edited)
    running.choice._next_drawing = 0.0
    assert running.send("TIMER", "NOTHING") == {"CANCELLED"}
    np.testing.assert_array_equal(first_map(edited), after)
    assert running.reported[-1][0] in {"WARNING", "ERROR"}
    assert running.left_nothing()


@pytest.mark.parametrize("change", HARMLESS, ids=lambda change: change.__name__)
def test_previewed_seams_are_those_of_the_click(monkeypatch, change):
    bpy.ops.mesh.primitive_cylinder_add(vertices=24)
    edited = bpy.context.object
    scenes.edit(edited)
    edited.data.uv_layers.new(name="Other")
    edited.data.uv_layers.active = edited.data.uv_layers[0]
    before = scenes.read_uv(edited)
    assert bpy.ops.uv.spectral_suggest_seams(style="ANGLE") == {"FINISHED"}
    expected, seams = first_map(edited), marked(edited)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.mark_seam(clear=True)
    scenes.write_uv(edited, before.tolist())
    preview = jobs.suggest_seams(monkeypatch, style="ANGLE")
    preview.wait()
    change(edited)
    preview.send("RET")
    preview.wait()
    assert preview.result == {"FINISHED"}
    assert len(seams) == 48
    assert marked(edited) == seams
    np.testing.assert_array_equal(first_map(edited), expected)
