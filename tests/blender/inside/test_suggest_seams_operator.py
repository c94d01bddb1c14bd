# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator Suggest Seams: what it marks, what it leaves alone, and its preview."""

import importlib
import re
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Vector

from tests.blender.inside import jobs, scenes

names = importlib.import_module("spectral_unwrap.names")


def primitive(add, **options):
    """Add one of Blender's primitives, without a UV map."""
    add(**options)
    new = bpy.context.object
    while new.data.uv_layers:
        new.data.uv_layers.remove(new.data.uv_layers[0])
    return new


def suzanne():
    return primitive(bpy.ops.mesh.primitive_monkey_add)


def state_apart_from_seams(edited):
    state = scenes.state(edited)
    state["edges"] = [(select, hide, smooth) for select, hide, _, smooth in state["edges"]]
    return state


def texts(reports, level):
    return [text for reported, text in reports() if reported == level]


def cuts_found(reports):
    """Return how many cuts were marked, by the operator's report."""
    (text,) = [text for text in texts(reports, "Info") if text.startswith("Marked ")]
    return int(text.split()[1])


def test_a_closed_mesh_is_cut_and_unwrapped_from_nothing(reports):
    solid = suzanne()
    scenes.edit(solid)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert scenes.seams(solid)
    uv = scenes.read_uv(solid)
    assert np.isfinite(uv).all()
    assert (np.ptp(uv, axis=0) > 0.3).any()
    qc, area = scenes.quasi_conformal(solid)
    assert np.average(qc, weights=area) < 1.3
    reported = reports()
    about_quality = "stretched to more than twice"
    assert [text for level, text in reported if level != "Info" and about_quality not in text] == []
    assert any(text.startswith("Unwrapped ") for _, text in reported)


@pytest.fixture
def searched(monkeypatch):
    """The options of every search, in their order."""
    core, found = scenes.module("core.seams.suggestion"), []
    suggest = core.suggest

    def recorded(meshes, options, *rest):
        found.append(options)
        return suggest(meshes, options, *rest)

    scenes.module("session").drop(scenes.module("operators.suggest_seams").Searched)
    monkeypatch.setattr(core, "suggest", recorded)
    return found


def test_only_properties_of_the_search_search_anew_and_reach_it(searched):
    cube = scenes.cube()
    scenes.edit(cube)
    changed = ({"scale_limit": 3.0}, {"angle_distortion": 20.0}, {"max_length": 3.0}, {"keep_front": 1.0})
    changed += ({"style": "ORGANIC"}, {"longest_side": 9.0})
    for properties in ({}, {"cuts": 1}, {"unwrap": False}, *changed):
        scenes.clear_seams(cube)
        assert bpy.ops.uv.spectral_suggest_seams(**properties) == {"FINISHED"}
    found = [
        (each.scale_limit, each.qc_limit, each.max_length, each.front[1], each.style, each.longest_side)
        for each in searched
    ]
    begun = (1.25, pytest.approx(1.1), None, -3.0, "auto", 1.75)
    assert found == [
        begun,
        (3.0, *begun[1:]),
        (1.25, pytest.approx(1.2), *begun[2:]),
        (*begun[:2], 3.0, *begun[3:]),
        (*begun[:3], -6.0, *begun[4:]),
        (*begun[:4], "organic", 1.75),
        (*begun[:5], 9.0),
    ]


def test_weights_of_a_vertex_group_reach_the_search(searched):
    cubes = [scenes.cube(name=name) for name in ("Painted", "Bare")]
    cubes[0].vertex_groups.new(name="Other").add([1], 1.0, "REPLACE")
    group = cubes[0].vertex_groups.new(name="Seams")
    group.add([2, 3], 1.0, "REPLACE")
    group.add([5], 0.25, "REPLACE")
    scenes.edit(*cubes)
    for use in ("PREFER", "AVOID"):
        options = {"seam_group": "Seams", "seam_group_use": use, "unwrap": False}
        assert bpy.ops.uv.spectral_suggest_seams(**options) == {"FINISHED"}
        for cube in cubes:
            scenes.clear_seams(cube)
    for options, sign in zip(searched, (1.0, -1.0)):
        by_mesh = {each.preference is None: each.preference for each in options.wishes}
        np.testing.assert_array_equal(by_mesh[False], sign * np.array([0, 0, 1, 1, 0, 0.25, 0, 0]))
        assert by_mesh[True] is None and len(options.wishes) == 2
    assert len(searched) == 2


def test_nothing_but_seams_and_the_map_changes():
    head = suzanne()
    head.data.uv_layers.new(name="Other")
    head.data.uv_layers.new(name="UVMap")
    head.data.uv_layers.active_index = 1
    scenes.edit(head)
    hidden = [face.index for face in scenes.edit_mesh(head).faces if face.calc_center_median().x > 0.6]
    scenes.select_faces(head, hidden)
    bpy.ops.mesh.hide()
    bpy.ops.mesh.select_all(action="SELECT")
    scenes.set_uv_flags(head, np.arange(len(scenes.read_uv(head))) % 3 == 0)
    before, uv = state_apart_from_seams(head), scenes.read_uv(head)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert state_apart_from_seams(head) == before
    left = scenes.corners_of(head, hidden)
    np.testing.assert_array_equal(scenes.read_uv(head)[left], uv[left])
    assert not np.array_equal(scenes.read_uv(head), uv)
    assert all(not edge.seam for edge in scenes.edit_mesh(head).edges if edge.hide)


def test_only_selected_faces_are_cut_and_unwrapped():
    double = scenes.new_object(*two_cubes(), name="Two cubes")
    scenes.edit(double)
    scenes.select_faces(double, range(6))
    uv = scenes.read_uv(double)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert scenes.seams(double)
    assert all(max(edge) < 8 for edge in scenes.seams(double))
    np.testing.assert_array_equal(scenes.read_uv(double)[24:], uv[24:])
    assert not np.array_equal(scenes.read_uv(double)[:24], uv[:24])


def two_cubes():
    parts = [scenes.cube_parts(), scenes.cube_parts(offset=(3.0, 0.0, 0.0))]
    return np.vstack([vertices for vertices, _ in parts]), np.vstack([parts[0][1], parts[1][1] + 8])


def test_without_selection_all_visible_faces_are_meant():
    double = scenes.new_object(*two_cubes(), name="Two cubes")
    scenes.edit(double)
    scenes.select_faces(double, range(6))
    bpy.ops.mesh.hide()
    before, uv = state_apart_from_seams(double), scenes.read_uv(double)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert scenes.seams(double)
    assert all(min(edge) >= 8 for edge in scenes.seams(double))
    assert state_apart_from_seams(double) == before
    np.testing.assert_array_equal(scenes.read_uv(double)[:24], uv[:24])
    low, high = scenes.bounds(scenes.read_uv(double)[24:])
    assert low.min() >= 0.0
    assert high.max() == pytest.approx(1.0, abs=0.01)


def test_several_meshes_are_cut_and_packed_together(reports):
    solids = [scenes.cube(), scenes.cube(size=2.0, offset=(5.0, 0.0, 0.0), name="Larger")]
    scenes.edit(*solids)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert cuts_found(reports) % 2 == 0
    assert all(scenes.seams(solid) for solid in solids)
    assert not scenes.overlapping_faces(*solids).any()
    # One cut of each, then another of the first.
    for solid in solids:
        scenes.clear_seams(solid)
    assert bpy.ops.uv.spectral_suggest_seams(cuts=3) == {"FINISHED"}
    assert len(scenes.seams(solids[0])) > len(scenes.seams(solids[1])) > 0


def test_without_unwrap_seams_are_all():
    cube = scenes.cube()
    scenes.edit(cube)
    before, uv = state_apart_from_seams(cube), scenes.read_uv(cube)
    assert bpy.ops.uv.spectral_suggest_seams(unwrap=False) == {"FINISHED"}
    assert scenes.seams(cube)
    assert state_apart_from_seams(cube) == before
    np.testing.assert_array_equal(scenes.read_uv(cube), uv)


def test_unwraps_as_spectral_unwrap_was_used_last(monkeypatch):
    cube = scenes.cube()
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    packed = scenes.read_uv(cube)
    scenes.clear_seams(cube)
    scenes.write_uv(cube, 0.5 + 0.1 * packed)
    settings = scenes.module("core.solve.options").Settings(keep_in_place=True)
    monkeypatch.setattr(scenes.module("operators.suggest_seams"), "settings_for", lambda _operator: settings)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    low, high = scenes.bounds(scenes.read_uv(cube))
    assert low.min() >= 0.5 - 1e-5
    assert high.max() <= 0.6 + 1e-5


def test_settings_of_the_window_do_not_reach_scripts():
    maps = []
    for area_blend in (0.0, 1.0):
        last = bpy.context.window_manager.operator_properties_last("uv.spectral_unwrap")
        last.area_blend, last.keep_in_place = area_blend, bool(area_blend)
        last.polish = "OFF" if area_blend else "ANGLES"
        head = suzanne()
        scenes.edit(head)
        try:
            assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
        finally:
            for name in ("area_blend", "polish", "keep_in_place"):
                last.property_unset(name)
        maps.append((scenes.seams(head), scenes.read_uv(head)))
        bpy.ops.object.mode_set(mode="OBJECT")
    assert maps[0][0] == maps[1][0]
    assert np.array_equal(maps[0][1], maps[1][1])


def test_edges_of_the_mesh_are_cut_where_the_subdivided_mesh_is_unwrapped(monkeypatch, reports):
    cube = primitive(bpy.ops.mesh.primitive_cube_add)
    cube.modifiers.new("Subdivision", "SUBSURF").levels = 2
    scenes.edit(cube)
    settings = scenes.module("core.solve.options").Settings(use_subsurf=True)
    monkeypatch.setattr(scenes.module("operators.suggest_seams"), "settings_for", lambda _operator: settings)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert scenes.seams(cube)
    assert texts(reports, "Warning") == []


def test_nothing_to_suggest_changes_nothing(reports):
    grid = scenes.grid(4, 3)
    scenes.edit(grid)
    before, uv = scenes.state(grid), scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_suggest_seams() == {"CANCELLED"}
    assert scenes.state(grid) == before
    np.testing.assert_array_equal(scenes.read_uv(grid), uv)
    assert [text for text in texts(reports, "Info") if text.startswith("No seams to suggest")]


def test_no_visible_faces(reports):
    grid = scenes.grid(4, 3)
    scenes.edit(grid)
    bpy.ops.mesh.hide()
    assert bpy.ops.uv.spectral_suggest_seams() == {"CANCELLED"}
    assert texts(reports, "Warning") == ["No visible faces to cut"]


def test_islands_that_no_seam_helps_are_told_and_the_others_served(reports):
    solid = scenes.new_object(*two_cubes(), name="Two cubes")
    solid.data.vertices[0].co.x = float("nan")
    scenes.edit(solid)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert scenes.seams(solid)
    assert all(min(edge) >= 8 for edge in scenes.seams(solid))
    (failed,) = texts(reports, "Warning")
    assert failed.startswith("1 of ")
    assert "not finite" in failed
    assert np.isfinite(scenes.read_uv(solid)).all()
    # Alone, it is told as well.
    scenes.select_faces(solid, range(6))
    assert bpy.ops.uv.spectral_suggest_seams() == {"CANCELLED"}
    assert [text for text in texts(reports, "Warning") if "1 of 1 island failed" in text]


@pytest.mark.parametrize("is_ours", [True, False])
def test_live_unwrap_follows_other_seams_only(monkeypatch, is_ours):
    """Seams that Suggest Seams marks come with their map; those that Mark Seam marks get a new one."""
    ours = scenes.module("operators.suggest_seams").UV_OT_spectral_suggest_seams.__name__
    # Background mode keeps no list of the operators that ended.
    ended = SimpleNamespace(bl_idname=ours if is_ours else "MESH_OT_mark_seam", as_pointer=lambda: 1)
    last_operator = scenes.module("live.last_operator")
    monkeypatch.setattr(last_operator, "_last", lambda: None)
    cylinder = scenes.cylinder(closed_seam=False)
    scenes.edit(cylinder)
    bpy.context.scene.spectral_unwrap_live = True
    before = scenes.read_uv(cylinder)
    bm = scenes.edit_mesh(cylinder)
    for row in range(6):
        bm.edges.get([bm.verts[24 * row], bm.verts[24 * (row + 1)]]).seam = True
    monkeypatch.setattr(last_operator, "_last", lambda: ended)
    bmesh.update_edit_mesh(cylinder.data)
    bpy.context.view_layer.update()
    scenes.module("live.following").look()
    assert np.array_equal(scenes.read_uv(cylinder), before) == is_ours


def test_live_unwrap_goes_on_when_blender_has_forgotten_what_ended(monkeypatch):
    """As Blender does when another add-on is disabled."""
    last_operator = scenes.module("live.last_operator")
    monkeypatch.setattr(last_operator, "_last", lambda: None)
    assert last_operator.moves_pins(1)
    assert last_operator.changes_seams(1)


def invoked(monkeypatch, is_waiting=True, **changed):
    defaults = jobs.defaults(bpy.ops.uv.spectral_suggest_seams)
    operator = scenes.module("operators.suggest_seams").UV_OT_spectral_suggest_seams
    return jobs.Invoked(monkeypatch, operator, is_waiting, **{**defaults, **changed})


@pytest.mark.parametrize(("style", "found"), [("AUTO", True), ("HARD", False), ("ORGANIC", False)])
def test_the_report_says_which_style_was_found(reports, style, found):
    scenes.edit(scenes.cube())
    assert bpy.ops.uv.spectral_suggest_seams(style=style) == {"FINISHED"}
    assert ("Hard Surface (found)" in texts(reports, "Info")) == found


@pytest.fixture
def previewed(monkeypatch):
    head = suzanne()
    head.data.uv_layers.new(name="UVMap")
    scenes.edit(head)
    return head, scenes.state(head), scenes.read_uv(head), invoked(monkeypatch)


def apply(preview):
    preview.send("RET")
    preview.wait()
    return preview.result


def test_preview_changes_nothing_and_tells_what_to_expect(previewed):
    head, before, uv, preview = previewed
    assert preview.result <= {"RUNNING_MODAL", "PASS_THROUGH"}
    assert scenes.state(head) == before
    np.testing.assert_array_equal(scenes.read_uv(head), uv)
    total = preview.choice.count
    assert f"Suggest Seams: {total} cuts, length " in preview.status[-1]
    assert " % evenly sized (now " in preview.status[-1]
    assert " %), angles off by " in preview.status[-1]
    assert re.search(r"; \d+ islands?, \d+ % of the tile filled; ", preview.status[-1])
    assert "; Hard Surface (found)   " in preview.status[-1]
    # Blender would redraw for the same text again.
    shown = len(preview.status)
    preview.send("TIMER", "NOTHING")
    assert len(preview.status) == shown


@pytest.mark.parametrize(
    ("more", "fewer"), [("WHEELUPMOUSE", "WHEELDOWNMOUSE"), ("UP_ARROW", "DOWN_ARROW"), ("+", "-")]
)
def test_fewer_and_more_cuts_are_shown(previewed, more, fewer):
    _, _, _, preview = previewed

    def press(key):
        return preview.send("A", ascii=key) if len(key) == 1 else preview.send(key)

    total = preview.choice.count
    assert press(more) == {"RUNNING_MODAL"}
    assert preview.choice.count == total
    press(fewer)
    assert preview.choice.count == total - 1
    assert f"{total - 1} of {total} cuts" in preview.status[-1]
    for _ in range(total + 2):
        press(fewer)
    assert preview.choice.count == 1
    press(more)
    assert preview.choice.count == 2


def test_page_keys_leap_by_a_tenth(previewed):
    _, _, _, preview = previewed
    total = preview.choice.count
    assert total >= 15  # a tenth is more than what the wheel takes
    preview.send("PAGE_DOWN")
    assert preview.choice.count == total - round(0.1 * total)
    preview.send("PAGE_UP")
    assert preview.choice.count == total


def test_applying_marks_what_is_shown(previewed):
    head, _, uv, preview = previewed
    preview.send("WHEELDOWNMOUSE")
    count = preview.choice.count
    assert apply(preview) == {"FINISHED"}
    assert preview.operator.cuts == count
    shown, mapped = scenes.seams(head), scenes.read_uv(head)
    assert not np.array_equal(mapped, uv)
    assert preview.status[-1] is None
    assert preview.timers == []
    assert preview.reported[0][1].startswith(f"Marked {count} cuts, length ")
    # The same as without a window.
    scenes.clear_seams(head)
    scenes.write_uv(head, uv)
    assert bpy.ops.uv.spectral_suggest_seams(cuts=count) == {"FINISHED"}
    assert scenes.seams(head) == shown
    np.testing.assert_array_equal(scenes.read_uv(head), mapped)


def test_applying_all_leaves_the_number_open(previewed):
    _, _, _, preview = previewed
    assert apply(preview) == {"FINISHED"}
    assert preview.operator.cuts == 0


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_escape_leaves_everything(previewed, key):
    head, before, uv, preview = previewed
    preview.send("WHEELDOWNMOUSE")
    assert preview.send(key) == {"CANCELLED"}
    assert scenes.state(head) == before
    np.testing.assert_array_equal(scenes.read_uv(head), uv)
    assert preview.status[-1] is None
    assert preview.timers == []


def test_escape_during_the_unwrap_leaves_everything(previewed, monkeypatch):
    head, before, uv, preview = previewed
    monkeypatch.setattr(scenes.module("operators.job_operator"), "_SECONDS_BEFORE_MODAL", -1.0)
    worker = scenes.module("core.solve.worker").Worker
    # A solve that has not ended when the event comes.
    monkeypatch.setattr(worker, "wait", lambda _self, _seconds: False)
    assert preview.send("RET") == {"RUNNING_MODAL"}
    assert preview.send("ESC") == {"CANCELLED"}
    monkeypatch.undo()
    assert scenes.state(head) == before
    np.testing.assert_array_equal(scenes.read_uv(head), uv)
    assert preview.timers == []
    assert bpy.ops.uv.spectral_suggest_seams.poll()


def test_escape_during_the_search_leaves_everything(monkeypatch):
    head = suzanne()
    head.data.uv_layers.new(name="UVMap")
    scenes.edit(head)
    before = scenes.state(head)
    worker = scenes.module("core.solve.worker").Worker
    # A search that has not ended when the events come.
    with monkeypatch.context() as patch:
        patch.setattr(worker, "wait", lambda _self, _seconds: False)
        preview = invoked(monkeypatch, is_waiting=False)
        assert preview.result == {"RUNNING_MODAL"}
        assert preview.send("TIMER", "NOTHING") == {"PASS_THROUGH"}
        assert preview.status[-1].startswith("Suggest Seams: ")
        assert "Esc: Cancel" in preview.status[-1]
        assert preview.send("ESC") == {"CANCELLED"}
    assert scenes.state(head) == before
    assert preview.status[-1] is None
    assert preview.timers == []


def test_meshes_that_changed_meanwhile_are_left_alone(previewed):
    head, _, _, preview = previewed
    bm = scenes.edit_mesh(head)
    bm.verts[0].co.x += 0.5
    bmesh.update_edit_mesh(head.data)
    assert apply(preview) == {"CANCELLED"}
    assert not scenes.seams(head)
    assert preview.reported[-1][0] == "WARNING"


def test_view_navigation_goes_on(previewed):
    _, _, _, preview = previewed
    assert preview.send("MIDDLEMOUSE") == {"PASS_THROUGH"}
    assert preview.send("WHEELUPMOUSE", ctrl=True, mouse_x=900) == {"PASS_THROUGH"}
    assert preview.send("X", ascii="x") == {"RUNNING_MODAL"}


def test_panels_other_editors_and_view_keys_work_during_the_preview(previewed):
    _, _, _, preview = previewed
    total = preview.choice.count
    for event in ("LEFTMOUSE", "RIGHTMOUSE", "WHEELDOWNMOUSE", "X"):
        assert preview.send(event, mouse_x=900) == {"PASS_THROUGH"}
    for key in ("NUMPAD_1", "NUMPAD_PERIOD", "ACCENT_GRAVE", "N", "T"):
        assert preview.send(key) == {"PASS_THROUGH"}
    view = preview.context.screen.areas[0]
    view.spaces.active.show_gizmo = view.spaces.active.show_gizmo_navigate = True
    assert preview.send("LEFTMOUSE", mouse_x=790, mouse_y=590) == {"PASS_THROUGH"}
    view.regions.append(SimpleNamespace(type="UI", x=600, y=0, width=200, height=600))
    assert preview.send("LEFTMOUSE", mouse_x=590, mouse_y=590) == {"PASS_THROUGH"}
    assert preview.send("WHEELDOWNMOUSE", mouse_x=650) == {"PASS_THROUGH"}
    assert preview.is_running
    assert preview.choice.count == total
    assert preview.send("WHEELDOWNMOUSE", mouse_x=100) == {"RUNNING_MODAL"}
    assert preview.choice.count == total - 1
    # Enter and Esc are for the preview wherever the mouse is.
    assert preview.send("ESC", mouse_x=900) == {"CANCELLED"}


@pytest.mark.parametrize("is_on_mesh", [False, True])
def test_a_click_applies_on_the_mesh_only(previewed, monkeypatch, is_on_mesh):
    head, _, _, preview = previewed
    under_mouse = scenes.module("overlay.under_mouse")
    center = head.matrix_world.translation
    target = center if is_on_mesh else center + Vector((0.0, 0.0, 100.0))
    away = Vector((0.0, -50.0, 0.0))
    monkeypatch.setattr(under_mouse, "ray", lambda *_: (target + away, target))
    preview.send("LEFTMOUSE")
    preview.wait()
    assert preview.result == ({"FINISHED"} if is_on_mesh else {"RUNNING_MODAL"})
    preview.send("ESC")


def test_leaving_edit_mode_ends_the_preview(previewed):
    head, _, _, preview = previewed
    preview.context.mode = "OBJECT"
    assert preview.send("TIMER", "NOTHING") == {"CANCELLED"}
    assert preview.timers == []
    assert not scenes.seams(head)


def test_lines_lie_where_the_object_is(monkeypatch):
    cube = scenes.cube()
    cube.location = (1.0, 2.0, 3.0)
    cube.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    scenes.edit(cube)
    preview = invoked(monkeypatch)
    points = preview.choice._lines.points(0, preview.choice.count)
    assert len(points) >= 2 * 5
    np.testing.assert_allclose(points.min(axis=0), [1.0, 2.0, 3.0], atol=1e-6)
    np.testing.assert_allclose(points.max(axis=0), [3.0, 4.0, 5.0], atol=1e-6)
    preview.send("ESC")


def test_nothing_to_suggest_shows_no_preview(monkeypatch):
    scenes.edit(scenes.grid(4, 3))
    preview = invoked(monkeypatch)
    assert preview.result == {"CANCELLED"}
    assert preview.reported[0][1].startswith("No seams to suggest")


def test_islands_of_suggested_seams_cover_themselves_nowhere():
    # Of these, rigid holes would lower the distortion of the largest island a little, and let it cover itself.
    edited = suzanne()
    scenes.edit(edited)
    bpy.ops.mesh.subdivide(number_cuts=2, smoothness=1.0)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    arrays = importlib.import_module("spectral_unwrap.edit_mesh.read_map").read_map(bpy.context, edited)
    numbers = scenes.module("core.measure.map_view").MapView(arrays).numbers()
    assert (numbers.flipped, numbers.overlapping) == (0, 0)
    assert numbers.mean_qc < 1.06


def test_the_preview_keeps_few_maps():
    """Its numbers held all maps once, so that the limit freed none."""
    module = scenes.module("operators.seam_preview")
    preview = object.__new__(module.SeamPreview)
    preview.count, preview._laid_out, preview._overlaid = 29, None, None
    preview._layout = SimpleNamespace(show=lambda *_: None)
    preview._measured = {count: module._Measured(None, 1, None, {}, []) for count in (module._UNCUT, *range(30))}
    preview._show_map(bpy.context)
    assert set(preview._measured) == {module._UNCUT, *range(30 - module._KEPT_MAPS, 30)}
    # The map that is shown stays, too, however old.
    preview.count = 22
    preview._measured.update({count: preview._measured[22] for count in range(40, 50)})
    preview._show_map(bpy.context)
    assert set(preview._measured) == {module._UNCUT, 22, *range(50 - module._KEPT_MAPS, 50)}
