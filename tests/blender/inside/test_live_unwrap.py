# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap: what follows a moved pin and a marked seam, and what does not."""

import sys

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def module(name):
    return sys.modules[f"spectral_unwrap.{name}"]


def turn_on():
    bpy.context.scene.spectral_unwrap_live = True


def prepare_pins(edited):
    """Turn sync selection off and make the layer of the pins, which 5.0 does not make by itself."""
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    layer = edited.data.uv_layers.active
    if hasattr(layer, "pin_ensure"):
        layer.pin_ensure()


def edit_with_pins(edited, pins):
    """Enter edit mode, unwrap, deselect all UVs and pin all corners of the vertices `pins`."""
    prepare_pins(edited)
    scenes.edit(edited)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    scenes.set_uv_flags(edited, np.zeros(len(scenes.read_uv(edited)), dtype=bool))
    bm = scenes.edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    for vertex in pins:
        for loop in bm.verts[vertex].link_loops:
            loop[layer].pin_uv = True
    bmesh.update_edit_mesh(edited.data)
    bpy.context.view_layer.update()


def move(edited, vertex, offset):
    """Move all UVs of a vertex as a transform does, and let Blender update."""
    bm = scenes.edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    for loop in bm.verts[vertex].link_loops:
        loop[layer].uv = loop[layer].uv[0] + offset[0], loop[layer].uv[1] + offset[1]
    bmesh.update_edit_mesh(edited.data)
    bpy.context.view_layer.update()


def uv_of(edited, vertex):
    bm = scenes.edit_mesh(edited)
    return np.array(bm.verts[vertex].link_loops[0][bm.loops.layers.uv.active].uv)


def mark_seams(edited, pairs, seam=True):
    bm = scenes.edit_mesh(edited)
    for pair in pairs:
        bm.edges.get([bm.verts[v] for v in pair]).seam = seam
    bmesh.update_edit_mesh(edited.data)
    bpy.context.view_layer.update()


def directly_pinned(edited, pins):
    """Return the pinned map that the native module makes of the mesh as it is."""
    native = module("core.native").spectral_conformal()
    bm = scenes.edit_mesh(edited)
    corners = [loop.vert.index for face in bm.faces for loop in face.loops]
    offsets = np.cumsum([0] + [len(face.loops) for face in bm.faces])
    seams = np.array([[v.index for v in e.verts] for e in bm.edges if e.seam], dtype=int).reshape(-1, 2)
    return native.unwrap(
        np.array([v.co for v in bm.verts], dtype=float),
        offsets,
        corners,
        seam_edges=seams,
        method="lscm",
        pins={pin: tuple(uv_of(edited, pin)) for pin in pins},
    ).uv


def bumpy_grid(columns=8, rows=6, **options):
    grid = scenes.grid(columns, rows, **options)
    for vertex in grid.data.vertices:
        vertex.co.z = 0.4 * np.sin(vertex.co.x) * np.cos(1.3 * vertex.co.y)
    return grid


def test_nothing_follows_unless_turned_on():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    before = scenes.read_uv(grid)
    move(grid, 8, (0.1, 0.2))
    module("live_unwrap").look()
    others = np.array([loop.vert.index != 8 for face in scenes.edit_mesh(grid).faces for loop in face.loops])
    np.testing.assert_array_equal(scenes.read_uv(grid)[others], before[others])


def test_map_follows_a_moved_pin_as_the_pinned_solve_has_it():
    grid = bumpy_grid()
    pins = [0, 8, 62]
    edit_with_pins(grid, pins)
    turn_on()
    held = [uv_of(grid, pin) for pin in pins]
    for step in range(1, 8):
        move(grid, 8, (0.03 * step, 0.02))
        held[1] = held[1] + np.float32([0.03 * step, 0.02])
        for pin, place in zip(pins, held):
            np.testing.assert_allclose(uv_of(grid, pin), place, atol=1e-6)
        np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, pins), atol=2e-5)
    move(grid, 62, (-0.1, 0.3))
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, pins), atol=2e-5)


def test_pins_back_at_the_start_bring_the_map_back():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    turn_on()
    before = scenes.read_uv(grid)
    move(grid, 8, (0.25, 0.5))
    assert not np.allclose(scenes.read_uv(grid), before, atol=0.01)
    bm = scenes.edit_mesh(grid)
    layer = bm.loops.layers.uv.active
    corners = [loop for face in bm.faces for loop in face.loops]
    for loop, uv in zip(corners, before):
        if loop.vert.index == 8:
            loop[layer].uv = uv
    bmesh.update_edit_mesh(grid.data)
    bpy.context.view_layer.update()
    np.testing.assert_array_equal(scenes.read_uv(grid), before)


def test_single_pin_takes_its_island_along():
    grid = bumpy_grid()
    edit_with_pins(grid, [4])
    turn_on()
    before = scenes.read_uv(grid)
    move(grid, 4, (0.25, -0.5))
    np.testing.assert_allclose(scenes.read_uv(grid), before + (0.25, -0.5), atol=1e-6)


def test_other_islands_and_hidden_faces_stay():
    grid = bumpy_grid(8, 6, seams=[(r * 9 + 4, r * 9 + 13) for r in range(6)])
    edit_with_pins(grid, [0, 3, 8])
    scenes.edit_mesh(grid).faces[8].hide_set(True)
    turn_on()
    before = scenes.read_uv(grid)
    move(grid, 0, (0.2, 0.1))
    after = scenes.read_uv(grid)
    left = scenes.corners_of(grid, [face for face in range(48) if face % 8 < 4 and face != 8])
    np.testing.assert_array_equal(after[~left], before[~left])
    assert np.mean(np.abs(after - before)[left] > 1e-4) > 0.7


def test_island_moved_as_a_whole_is_left_alone():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    scenes.set_uv_flags(grid, np.ones(len(scenes.read_uv(grid)), dtype=bool))
    turn_on()
    moved = scenes.read_uv(grid) * (0.5, 0.25)
    scenes.write_uv(grid, moved)
    bpy.context.view_layer.update()
    np.testing.assert_allclose(scenes.read_uv(grid), moved, atol=1e-6)


def test_closed_island_is_left_alone_in_silence(capfd):
    cube = scenes.cube()
    prepare_pins(cube)
    scenes.edit(cube)
    scenes.set_uv_flags(cube, np.zeros(24, dtype=bool))
    bm = scenes.edit_mesh(cube)
    layer = bm.loops.layers.uv.active
    for vertex in (0, 5):
        for loop in bm.verts[vertex].link_loops:
            loop[layer].pin_uv = True
            loop[layer].uv = (0.1 * vertex, 0.5)
    turn_on()
    before = scenes.read_uv(cube)
    capfd.readouterr()
    move(cube, 5, (0.5, 0.0))
    others = np.array([loop.vert.index != 5 for face in scenes.edit_mesh(cube).faces for loop in face.loops])
    np.testing.assert_array_equal(scenes.read_uv(cube)[others], before[others])
    assert "could not" not in capfd.readouterr().out


def cylinder_seam(segments=24, rows=6):
    return [(r * segments, (r + 1) * segments) for r in range(rows)]


@pytest.mark.parametrize("placement", ["PACK", "KEEP"])
def test_map_follows_a_marked_seam_with_the_last_settings(monkeypatch, placement):
    cylinder = scenes.cylinder(closed_seam=False)
    other = scenes.grid(3, 3, offset=(9.0, 0.0, 0.0), name="Other")
    scenes.edit(cylinder, other)
    # Background mode does not remember settings by itself.
    settings = module("edit_mode_unwrap").Settings(keep_in_place=placement == "KEEP")
    monkeypatch.setattr(module("live_unwrap"), "last_settings", lambda: settings)
    scenes.select_faces(cylinder, [3])
    other_uv = scenes.read_uv(other)
    turn_on()
    mark_seams(cylinder, cylinder_seam())
    state = scenes.state(cylinder)
    module("live_unwrap").look()
    stretches = scenes.stretches(cylinder)
    np.testing.assert_allclose(stretches, stretches.mean(), rtol=1e-4)
    assert np.array_equal(scenes.read_uv(other), other_uv) == (placement == "KEEP")
    assert scenes.state(cylinder) == state
    # Seen once, a change is not followed again.
    followed = scenes.read_uv(cylinder)
    scenes.write_uv(cylinder, followed * 0.5)
    bpy.context.view_layer.update()
    module("live_unwrap").look()
    np.testing.assert_allclose(scenes.read_uv(cylinder), followed * 0.5, atol=1e-6)


def test_changed_faces_are_not_taken_for_changed_seams():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    turn_on()
    scenes.select_faces(grid, [20])
    bpy.ops.mesh.delete(type="FACE")
    before = scenes.read_uv(grid)
    mark_seams(grid, [(4, 13)])
    module("live_unwrap").look()
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    # From here on the mesh is known.
    move(grid, 8, (0.1, 0.1))
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, [0, 8]), atol=2e-5)


def test_what_undo_changes_is_not_followed():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    turn_on()
    live = module("live_unwrap")
    live._before_undo()
    before = scenes.read_uv(grid)
    move(grid, 8, (0.1, 0.0))
    mark_seams(grid, [(4, 13)])
    live._after_undo_or_load()
    live.look()
    others = np.array([loop.vert.index != 8 for face in scenes.edit_mesh(grid).faces for loop in face.loops])
    np.testing.assert_array_equal(scenes.read_uv(grid)[others], before[others])
    move(grid, 8, (0.1, 0.0))
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, [0, 8]), atol=2e-5)


def test_slow_map_waits_for_the_pins_to_rest(monkeypatch):
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    turn_on()
    live = module("live_unwrap")
    monkeypatch.setattr(live, "_SLOW", -1.0)
    before = scenes.read_uv(grid)
    for _ in range(3):
        move(grid, 8, (0.1, 0.1))
    live.look()
    others = np.array([loop.vert.index != 8 for face in scenes.edit_mesh(grid).faces for loop in face.loops])
    np.testing.assert_array_equal(scenes.read_uv(grid)[others], before[others])
    monkeypatch.setattr(live, "_REST", 0.0)
    assert live._rest() is None
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, [0, 8]), atol=2e-5)


def test_error_is_told_once_and_not_raised(monkeypatch, capfd):
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    turn_on()

    def fail():
        raise module("core.native").NativeModuleError("no module for the test")

    monkeypatch.setattr(module("core.native"), "spectral_conformal", fail)
    move(grid, 8, (0.1, 0.0))
    move(grid, 8, (0.1, 0.0))
    output = capfd.readouterr().out
    assert output.count("Live Spectral Unwrap could not follow: no module for the test") == 1


def test_disabling_the_add_on_removes_handlers_and_property():
    import addon_utils

    turn_on()
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    addon_utils.disable("spectral_unwrap")
    events = ("depsgraph_update_post", "undo_pre", "undo_post", "redo_pre", "redo_post", "load_pre", "load_post")
    for event in events:
        assert not [f for f in getattr(bpy.app.handlers, event) if "live_unwrap" in f.__module__]
    assert not hasattr(bpy.context.scene, "spectral_unwrap_live")
    assert "spectral_unwrap_live" not in bpy.context.scene
    move(grid, 8, (0.1, 0.0))
    addon_utils.enable("spectral_unwrap", default_set=True)
    assert not bpy.context.scene.spectral_unwrap_live


def test_pins_that_an_unwrap_moves_are_not_followed():
    grid = bumpy_grid(8, 6)
    edit_with_pins(grid, [0, 3, 27, 8, 62])
    # Pins that no map has, so that soft ones move.
    uv = scenes.read_uv(grid)
    scenes.write_uv(grid, uv + 0.05 * np.sin(17.0 * uv[:, ::-1]))
    turn_on()
    # The border of the selection lies within the island that would follow.
    scenes.select_faces(grid, [face for face in range(48) if face % 8 < 4])
    bpy.context.view_layer.update()
    before = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_unwrap(soft_pins=True, soft_pin_strength=0.1) == {"FINISHED"}
    bpy.context.view_layer.update()
    after, others = scenes.read_uv(grid), scenes.corners_of(grid, [face for face in range(48) if face % 8 >= 4])
    np.testing.assert_array_equal(after[others], before[others])
    pinned = scenes.pins(grid) & ~others
    assert not np.isclose(after[pinned], before[pinned], atol=1e-4).all()
    solved = scenes.read_uv(grid)
    move(grid, 8, (0.1, 0.2))
    assert not np.allclose(scenes.read_uv(grid)[others], solved[others], atol=1e-3)


@pytest.mark.parametrize("pins", [[4], [0, 8, 62]], ids=["one pin", "three pins"])
def test_a_pin_at_no_place_takes_nothing_along(pins):
    grid = bumpy_grid()
    edit_with_pins(grid, pins)
    turn_on()
    # Followed once, so that maps of other places are known.
    move(grid, pins[0], (0.1, 0.2))
    move(grid, pins[0], (np.nan, 0.0))
    others = np.array([loop.vert.index != pins[0] for face in scenes.edit_mesh(grid).faces for loop in face.loops])
    assert np.isfinite(scenes.read_uv(grid)[others]).all()
    assert not np.isfinite(scenes.read_uv(grid)[~others]).all()
