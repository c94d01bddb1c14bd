# SPDX-License-Identifier: GPL-3.0-or-later
"""Looking at a map: what the overlay shows, the list of islands, and selecting what is distorted."""

import dataclasses
import importlib

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

native = importlib.import_module("spectral_unwrap.core.native")
choices = importlib.import_module("spectral_unwrap.core.choices")
texts = importlib.import_module("spectral_unwrap.core.words.texts")
map_overlay = importlib.import_module("spectral_unwrap.overlay.map_overlay")
session = importlib.import_module("spectral_unwrap.session")
identity = importlib.import_module("spectral_unwrap.session.identity")
shown_mesh = importlib.import_module("spectral_unwrap.overlay.shown_mesh")
read_map = importlib.import_module("spectral_unwrap.edit_mesh.read_map")
map_view = importlib.import_module("spectral_unwrap.core.measure.map_view")
island_list = importlib.import_module("spectral_unwrap.unwrapping.island_list")


def stretched_grid(n=6):
    """A grid whose map is stretched in its last column of faces, in edit mode."""
    grid = scenes.grid(n, n)
    scenes.edit(grid)
    bm = scenes.edit_mesh(grid)
    layer = bm.loops.layers.uv.active or bm.loops.layers.uv.new("UVMap")
    right = max(vertex.co.x for vertex in bm.verts)
    for face in bm.faces:
        for loop in face.loops:
            loop[layer].uv = loop.vert.co.xy
            if abs(loop.vert.co.x - right) < 1e-6:
                loop[layer].uv.x += 1.0
    return grid


def selected(edit_object):
    return {face.index for face in scenes.edit_mesh(edit_object).faces if face.select}


def of_module(edit_object):
    """What the module says of the map as Blender stores it."""
    arrays = read_map.read_map(bpy.context, edit_object)
    return native.spectral_conformal().face_distortion(arrays.with_map(arrays.uv.astype(float)))


@pytest.mark.parametrize("mode", ["EDIT", "OBJECT"])
def test_values_are_those_of_the_module(mode):
    grid = stretched_grid()
    if mode == "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    ((shown, _, view),) = map_overlay.views(bpy.context)
    assert shown == grid
    expected = of_module(grid)
    np.testing.assert_allclose(view.values(choices.LOOK_ANGLE), expected.qc, atol=1e-6)
    assert view.numbers().max_qc == pytest.approx(expected.qc.max())
    assert view.triangle_map(choices.LOOK_ANGLE)[1].max() == pytest.approx(expected.qc.max(), rel=1e-6)
    session.drop(map_overlay.Overlay)


def test_modifiers_count_in_object_mode():
    grid = stretched_grid()
    bpy.ops.object.mode_set(mode="OBJECT")
    grid.modifiers.new("Mirror", "MIRROR")
    ((_, _, view),) = map_overlay.views(bpy.context)
    assert len(view.qc) == 2 * len(grid.data.polygons)
    session.drop(map_overlay.Overlay)


def test_hidden_faces_are_not_shown():
    grid = stretched_grid()
    scenes.edit_mesh(grid).faces[0].hide_set(True)
    arrays = read_map.read_map(bpy.context, grid)
    assert not arrays.selected_faces[0]
    assert arrays.selected_faces[1:].all()


def test_offsets_are_read_again_where_the_corners_are_others():
    grid = stretched_grid()
    before = read_map.read_map(bpy.context, grid)
    assert read_map.read_map(bpy.context, grid, before=before).face_offsets is before.face_offsets
    bm = scenes.edit_mesh(grid)
    bm.faces.ensure_lookup_table()
    bmesh.ops.triangulate(bm, faces=bm.faces[:1])
    after = read_map.read_map(bpy.context, grid, before=before)
    assert len(after.face_offsets) == len(before.face_offsets) + 1
    assert np.diff(after.face_offsets).min() == 3


def test_what_was_taken_for_granted_is_read_again():
    grid = stretched_grid()
    shown = shown_mesh.ShownMesh()
    shown.view(bpy.context, grid)
    view = shown.confirm(bpy.context, grid)
    right = view.mesh
    # Faces of three and of five corners in place of two of four: the corners are the same.
    wrong = right.face_offsets.copy()
    wrong[1] -= 1
    view.mesh = dataclasses.replace(right, face_offsets=wrong)
    shown.edited()
    assert shown.view(bpy.context, grid).mesh.face_offsets is wrong
    assert np.array_equal(shown.confirm(bpy.context, grid).mesh.face_offsets, right.face_offsets)


def test_without_a_map_nothing_is_shown():
    grid = scenes.grid(2, 2)
    while grid.data.uv_layers:
        grid.data.uv_layers.remove(grid.data.uv_layers[0])
    scenes.edit(grid)
    assert map_overlay.views(bpy.context) == []


def test_nothing_is_read_while_it_is_off(monkeypatch):
    def read(*_arguments):
        raise AssertionError("read although nothing is shown")

    monkeypatch.setattr(map_overlay.read_map, "read_map", read)
    grid = stretched_grid()
    assert not bpy.context.window_manager.spectral_map_overlay.show
    grid.data.update()
    bpy.context.view_layer.update()
    bpy.ops.uv.spectral_unwrap()


def test_rendering_does_not_touch_what_is_shown(tmp_path, monkeypatch):
    grid, scene, modes = stretched_grid(), bpy.context.scene, []
    bpy.ops.object.mode_set(mode="OBJECT")
    # Animated, so that every frame has another mesh.
    grid.shape_key_add(name="Basis")
    key = grid.shape_key_add(name="Key")
    for frame, value in ((1, 0.0), (3, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    monkeypatch.setattr(map_overlay, "on_update", lambda depsgraph: modes.append(depsgraph.mode))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera, scene.render.engine, scene.cycles.samples = camera, "CYCLES", 1
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.frame_start, scene.frame_end, scene.render.filepath = 1, 3, str(tmp_path / "frame")
    bpy.ops.render.render(animation=True)
    assert len(list(tmp_path.iterdir())) == 3
    # Back at the former frame, the window's own graph changes.
    assert set(modes) <= {"VIEWPORT"}


def test_list_of_islands_selects_their_faces():
    cube = scenes.cube()
    scenes.edit(cube)
    for edge in scenes.edit_mesh(cube).edges:
        edge.seam = True
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    window_manager = bpy.context.window_manager
    assert len(window_manager.spectral_islands) == 6
    assert window_manager.spectral_islands_active == -1
    assert island_list.lines()[-1][1].startswith("Unwrapped 6 islands: ")
    chosen = set()
    for index in range(6):
        window_manager.spectral_islands_active = index
        assert len(selected(cube)) == 1
        chosen |= selected(cube)
    assert chosen == set(range(6))


def test_list_of_islands_says_when_the_mesh_is_another():
    cube = scenes.cube()
    scenes.edit(cube)
    for edge in scenes.edit_mesh(cube).edges:
        edge.seam = True
    bpy.ops.uv.spectral_unwrap()
    bpy.ops.mesh.subdivide()
    before = selected(cube)
    bpy.context.window_manager.spectral_islands_active = 2
    assert selected(cube) == before
    assert island_list.lines()[-1] == ("WARNING", texts.ISLAND_GONE)


def test_failed_islands_come_first():
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    (row,) = bpy.context.window_manager.spectral_islands
    assert island_list.is_bad(0)
    assert row.name == "Not unwrapped   6 f."


@pytest.mark.parametrize("measure", ["ANGLE", "SIZE"])
def test_the_most_distorted_faces_are_selected(measure):
    grid = stretched_grid()
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    assert bpy.ops.uv.spectral_select(measure=measure, amount=5.0) == {"FINISHED"}
    faces = scenes.edit_mesh(grid).faces
    right = max(face.calc_center_median().x for face in faces)
    assert selected(grid) == {face.index for face in faces if abs(face.calc_center_median().x - right) < 1e-6}


def test_whole_islands_are_selected_by_their_average():
    grid = stretched_grid()
    bm = scenes.edit_mesh(grid)
    layer = bm.loops.layers.uv.active
    apart = {face.index for face in bm.faces if face.calc_center_median().x < 3.0}
    for face in bm.faces:
        if face.index in apart:
            for loop in face.loops:
                loop[layer].uv.x -= 50.0
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    assert bpy.ops.uv.spectral_select(amount=1.0, whole_islands=True) == {"FINISHED"}
    assert selected(grid) == {face.index for face in scenes.edit_mesh(grid).faces} - apart


def test_islands_above_a_limit_are_selected():
    grid = stretched_grid()
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    assert bpy.ops.uv.spectral_select(limit=90.0) == {"FINISHED"}
    stretched = selected(grid)
    assert len(stretched) == 6
    scenes.select_faces(grid, [0])
    assert bpy.ops.uv.spectral_select(limit=110.0) == {"FINISHED"}
    assert selected(grid) == {0}
    # On average the island is distorted by a sixth.
    for limit, count in ((10.0, 36), (20.0, 1)):
        scenes.select_faces(grid, [0])
        bpy.ops.uv.spectral_select(limit=limit, whole_islands=True)
        assert len(selected(grid)) == count


def test_another_map_can_be_shown_in_place_of_the_mesh_s_own():
    grid = stretched_grid()
    ((_, _, own),) = map_overlay.views(bpy.context)
    assert own.qc.max() > 1.9
    even = np.array([vertex.co.xy for face in scenes.edit_mesh(grid).faces for vertex in face.verts])
    before = scenes.state(grid)
    window_manager = bpy.context.window_manager
    try:
        map_overlay.preview(bpy.context, {identity.key(grid): even})
        ((_, _, other),) = map_overlay.views(bpy.context)
        assert other.qc == pytest.approx(1.0, abs=1e-6)
        map_overlay.preview(bpy.context, {})
        ((_, _, again),) = map_overlay.views(bpy.context)
        assert again.qc == pytest.approx(own.qc)
    finally:
        session.drop(map_overlay.Overlay)
    assert scenes.state(grid) == before
    assert not window_manager.spectral_map_overlay.show


def test_colors_are_those_of_the_preferences():
    legend = importlib.import_module("spectral_unwrap.overlay.legend")
    color_ramp = importlib.import_module("spectral_unwrap.core.drawing.color_ramp")
    preferences = bpy.context.preferences.addons["spectral_unwrap"].preferences
    assert legend.colors_of("ANGLE", 1.0).low == pytest.approx(color_ramp.GOOD_TO_BAD[0])
    preferences.angle_low = (0.5, 0.25, 0.75)
    try:
        assert legend.colors_of("ANGLE", 1.0).low == pytest.approx((0.5, 0.25, 0.75))
        assert legend.colors_of("SIZE", 1.0).low == pytest.approx(color_ramp.SMALL_TO_LARGE[0])
    finally:
        preferences.property_unset("angle_low")


def test_the_sidebar_shows_the_number_of_the_shown_maps_and_reads_nothing(monkeypatch):
    grid = stretched_grid()
    assert map_overlay.figure(bpy.context) == ""
    overlay = map_overlay.settings()
    overlay.show = True
    try:
        assert map_overlay.figure(bpy.context) == ""
        map_overlay._look_at_islands_of(bpy.context)
        found = of_module(grid)
        percent = 100.0 * (float((found.qc * found.area).sum() / found.area.sum()) - 1.0)
        with monkeypatch.context() as patched:
            patched.setattr(shown_mesh.ShownMesh, "view", None)
            assert map_overlay.figure(bpy.context) == f"{percent:.0f} %"
            map_overlay.edited()
            assert map_overlay.figure(bpy.context) == f"{percent:.0f} %"
            overlay.kind = "CHECKER"
            assert map_overlay.figure(bpy.context) == ""
    finally:
        overlay.kind, overlay.show = "ANGLE", False
