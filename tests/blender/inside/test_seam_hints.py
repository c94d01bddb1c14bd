# SPDX-License-Identifier: GPL-3.0-or-later
"""Seam hints: set on edges, saved, obeyed; seams by angle; settings of a running preview."""

import importlib
import math

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import jobs, scenes

names = importlib.import_module("spectral_unwrap.names")
edge_marks = importlib.import_module("spectral_unwrap.edit_mesh.edge_marks")
seam_hints = importlib.import_module("spectral_unwrap.edit_mesh.seam_hints")


def sphere():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    return bpy.context.object


def select_edges(edited, chosen):
    """Select the edges for which `chosen` holds, given the middle, and return their vertices."""
    bpy.ops.mesh.select_mode(type="EDGE")
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = scenes.edit_mesh(edited)
    found = set()
    for edge in bm.edges:
        if chosen((edge.verts[0].co + edge.verts[1].co) / 2.0):
            edge.select_set(True)
            found.add(frozenset(vertex.index for vertex in edge.verts))
    bm.select_flush_mode()
    bmesh.update_edit_mesh(edited.data)
    return found


def hint(edited, value, chosen):
    """Set a hint for edges, and leave nothing selected."""
    found = select_edges(edited, chosen)
    assert bpy.ops.mesh.spectral_seam_hint(hint=value) == {"FINISHED"}
    bpy.ops.mesh.select_all(action="DESELECT")
    return found


def hinted(edited):
    edges, values = seam_hints.of_edges(edited.data)
    return {frozenset(edge): value for edge, value in zip(edges.tolist(), values.tolist())}


def on_equator(middle):
    return abs(middle.z) < 1e-4


def test_hints_are_set_changed_cleared_and_counted(reports):
    ball = sphere()
    scenes.edit(ball)
    reports()
    equator = hint(ball, "CUT", on_equator)
    assert len(equator) == 16
    assert hinted(ball) == dict.fromkeys(equator, seam_hints.CUT)
    hint(ball, "NEVER", on_equator)
    assert hinted(ball) == dict.fromkeys(equator, seam_hints.NEVER)
    hint(ball, "CLEAR", on_equator)
    assert hinted(ball) == {}
    assert reports() == [("Info", f"{label}: 16 edges") for label in ("Cut Here", "Never Here", "Clear Hints")]
    assert bpy.ops.mesh.spectral_seam_hint(hint="CUT") == {"CANCELLED"}
    assert reports() == [("Warning", "No edges selected")]


def test_marks_of_the_modeler_are_read():
    ball = sphere()
    scenes.edit(ball)
    equator = select_edges(ball, on_equator)
    bpy.ops.transform.edge_crease(value=0.5)
    tropic = select_edges(ball, lambda middle: abs(middle.z - 0.7071) < 1e-2)
    bpy.ops.transform.edge_bevelweight(value=0.25)
    bpy.ops.mesh.mark_sharp()
    bm = scenes.edit_mesh(ball)
    for face in bm.faces:
        face.material_index = int(face.calc_center_median().x > 0.0)
    bmesh.update_edit_mesh(ball.data)
    edges, strengths = edge_marks.of_edges(ball.data)
    found = dict.fromkeys(equator | tropic, 0.0)
    for edge, strength in zip(map(frozenset, edges.tolist()), strengths.tolist()):
        found[edge] = max(found.get(edge, 0.0), strength)
    expected = {**dict.fromkeys(equator, 0.5), **dict.fromkeys(tropic, 1.0)}
    for edge in bm.edges:
        if len({face.material_index for face in edge.link_faces}) > 1:
            expected[frozenset(vertex.index for vertex in edge.verts)] = 1.0
    assert len(expected) > 40
    assert found == pytest.approx(expected, abs=0.01)


def test_hints_are_saved_with_the_mesh(tmp_path):
    ball = sphere()
    scenes.edit(ball)
    equator = hint(ball, "NEVER", on_equator)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert ball.data.attributes[names.SEAM_HINT_ATTRIBUTE].domain == "EDGE"
    name, path = ball.name, str(tmp_path / "hints.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    ball = bpy.data.objects[name]
    bpy.context.view_layer.objects.active = ball
    bpy.ops.object.mode_set(mode="EDIT")
    assert hinted(ball) == dict.fromkeys(equator, seam_hints.NEVER)


def test_hints_that_cannot_be_met_are_told(reports):
    ball = sphere()
    scenes.edit(ball)
    hint(ball, "NEVER", lambda _: True)
    reports()
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    cut = len(scenes.seams(ball))
    level, text = next((level, text) for level, text in reports() if "despite Never Here" in text)
    assert level == "Warning"
    assert text.startswith(f"{cut} edge")


def test_seams_by_angle(reports):
    cube = scenes.cube()
    scenes.edit(cube)
    reports()
    by_angle = {"style": "ANGLE", "sharp_angle": math.radians(89.0)}
    assert bpy.ops.uv.spectral_suggest_seams(**by_angle) == {"FINISHED"}
    assert len(scenes.seams(cube)) == 12
    assert reports()[0][1].startswith("Marked 12 edges, length ")
    scenes.clear_seams(cube)
    assert bpy.ops.uv.spectral_suggest_seams(style="ANGLE", sharp_angle=math.radians(91.0)) == {"CANCELLED"}
    assert "no edge is that sharp" in reports()[0][1]
    assert not scenes.seams(cube)


@pytest.fixture
def previewed(monkeypatch):
    def preview(make, **properties):
        edited = make()
        scenes.edit(edited)
        if not edited.data.uv_layers:
            edited.data.uv_layers.new(name="UVMap")
        operator = importlib.import_module("spectral_unwrap.operators.suggest_seams").UV_OT_spectral_suggest_seams
        values = {**jobs.defaults(bpy.ops.uv.spectral_suggest_seams), **properties}
        return edited, jobs.Invoked(monkeypatch, operator, **values)

    return preview


def sidebar():
    return bpy.context.window_manager.operator_properties_last(names.SUGGEST_SEAMS_OPERATOR)


def settle(preview):
    preview.send("TIMER", "NOTHING")
    preview.wait()


def finish(preview):
    preview.send("RET")
    preview.wait()
    return preview.result


def test_settings_in_the_sidebar_change_the_running_preview(previewed):
    ball, preview = previewed(sphere, angle_distortion=2.0)
    assert sidebar().angle_distortion == pytest.approx(2.0)
    before = preview.choice.answer[0].length
    sidebar().angle_distortion = 100.0
    sidebar().scale_limit = 8.0
    settle(preview)
    assert preview.choice.answer[0].length < before
    assert "evenly sized" in preview.status[-1]
    length = preview.choice.answer[0].length
    assert finish(preview) == {"FINISHED"}
    # Adjust Last Operation begins with what was searched for.
    assert preview.operator.angle_distortion == 100.0
    marked = sum(edge.calc_length() for edge in scenes.edit_mesh(ball).edges if edge.seam)
    assert marked == pytest.approx(length, rel=1e-5)


def test_nothing_is_applied_while_a_search_runs(previewed, monkeypatch):
    ball, preview = previewed(sphere)
    worker = importlib.import_module("spectral_unwrap.core.solve.worker").Worker
    sidebar().angle_distortion = 50.0
    with monkeypatch.context() as patch:
        patch.setattr(worker, "wait", lambda _self, _seconds: False)
        preview.send("TIMER", "NOTHING")
        assert "Searching ..." in preview.status[-1]
        assert preview.send("RET") == {"RUNNING_MODAL"}
    assert not scenes.seams(ball)
    preview.send("ESC")
    assert preview.left_nothing()


def test_a_hint_changes_the_running_preview(previewed):
    ball, preview = previewed(sphere)
    equator = hint(ball, "CUT", on_equator)
    settle(preview)
    edges = {frozenset(edge) for edge in preview.choice.answer[0].edges(0).tolist()}
    assert equator <= edges
    preview.send("ESC")


def test_the_preview_by_angle_counts_islands_while_the_wheel_turns_the_angle(previewed):
    cube, preview = previewed(scenes.cube, style="ANGLE", sharp_angle=math.radians(89.0))
    assert "12 edges of 89° or more" in preview.status[-1]
    assert "; 6 islands, " in preview.status[-1]
    for _ in range(2):
        preview.send("WHEELDOWNMOUSE")
    preview.wait()
    assert "0 edges of 91° or more" in preview.status[-1]
    assert "; 1 island; " in preview.status[-1] or "; 1 island, " in preview.status[-1]
    assert math.degrees(sidebar().sharp_angle) == pytest.approx(91.0)
    preview.send("PAGE_UP")
    preview.wait()
    assert "12 edges of 81° or more" in preview.status[-1]
    assert finish(preview) == {"FINISHED"}
    assert len(scenes.seams(cube)) == 12


def test_the_layout_that_is_shown_is_the_one_that_is_written(previewed):
    ball, preview = previewed(sphere)
    preview.send("WHEELDOWNMOUSE")
    preview.wait()
    (shown,) = preview.choice._layout._lines
    # Two points per corner: its own and the next one of its face.
    corners = shown.reshape(-1, 2, 3)[:, 0, :2]
    assert finish(preview) == {"FINISHED"}
    np.testing.assert_allclose(corners, scenes.read_uv(ball), atol=1e-5)


def test_lines_of_hints_lie_on_their_visible_edges():
    lines = importlib.import_module("spectral_unwrap.overlay.edge_lines").HintLines()
    ball = sphere()
    scenes.edit(ball)
    assert lines.segments(ball.data) == {}
    hint(ball, "CUT", on_equator)
    hint(ball, "NEVER", lambda middle: middle.z > 0.8)
    found = lines.segments(ball.data)
    assert set(found) == {seam_hints.CUT, seam_hints.NEVER}
    assert found[seam_hints.CUT].shape == (32, 3)
    np.testing.assert_allclose(found[seam_hints.CUT][:, 2], 0.0, atol=1e-6)
    select_edges(ball, lambda middle: middle.z > 0.5)
    bpy.ops.mesh.hide()
    assert set(lines.segments(ball.data)) == {seam_hints.CUT}
