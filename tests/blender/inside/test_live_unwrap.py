# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap: what follows moved pins and marked seams, and what does not."""

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


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
    """Return the polished pinned map that the native module makes of the mesh as it is."""
    return scenes.directly_solved(edited, pins={pin: tuple(uv_of(edited, pin)) for pin in pins}, hole_rigidity=0.0)


def bumpy_grid(columns=8, rows=6, **options):
    grid = scenes.grid(columns, rows, **options)
    for vertex in grid.data.vertices:
        vertex.co.z = 0.4 * np.sin(vertex.co.x) * np.cos(1.3 * vertex.co.y)
    return grid


def test_nothing_follows_unless_turned_on():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8, 40])
    before = scenes.read_uv(grid)
    move(grid, 8, (0.1, 0.2))
    scenes.module("live.following").look()
    others = scenes.corner_vertices(grid) != 8
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
    edit_with_pins(grid, [0, 8, 40])
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
    for vertex in (0, 5, 6):
        for loop in bm.verts[vertex].link_loops:
            loop[layer].pin_uv = True
            loop[layer].uv = (0.1 * vertex, 0.5)
    turn_on()
    before = scenes.read_uv(cube)
    capfd.readouterr()
    move(cube, 5, (0.5, 0.0))
    others = scenes.corner_vertices(cube) != 5
    np.testing.assert_array_equal(scenes.read_uv(cube)[others], before[others])
    assert "could not" not in capfd.readouterr().out


def cylinder_seam(segments=24, rows=6):
    return [(r * segments, (r + 1) * segments) for r in range(rows)]


def started(changed):
    """Start an unwrap after changed edges, as following does."""
    return scenes.module("live.seams").Follow(bpy.context, changed, scenes.module("core.solve.options").Settings())


@pytest.mark.parametrize("keep_in_place", [False, True])
def test_map_follows_a_marked_seam_with_the_last_settings(monkeypatch, keep_in_place):
    cylinder = scenes.cylinder(closed_seam=False)
    other = scenes.grid(3, 3, offset=(9.0, 0.0, 0.0), name="Other")
    scenes.edit(cylinder, other)
    # Background mode does not remember settings by itself.
    settings = scenes.module("core.solve.options").Settings(keep_in_place=keep_in_place)
    monkeypatch.setattr(scenes.module("live.following"), "last_settings", lambda: settings)
    scenes.select_faces(cylinder, [3])
    other_uv = scenes.read_uv(other)
    turn_on()
    mark_seams(cylinder, cylinder_seam())
    state = scenes.state(cylinder)
    scenes.module("live.following").look()
    stretches = scenes.stretches(cylinder)
    np.testing.assert_allclose(stretches, stretches.mean(), rtol=1e-4)
    assert np.array_equal(scenes.read_uv(other), other_uv) == keep_in_place
    assert scenes.state(cylinder) == state
    # Seen once, a change is not followed again.
    followed = scenes.read_uv(cylinder)
    scenes.write_uv(cylinder, followed * 0.5)
    bpy.context.view_layer.update()
    scenes.module("live.following").look()
    np.testing.assert_allclose(scenes.read_uv(cylinder), followed * 0.5, atol=1e-6)


def test_long_work_is_written_once_it_is_there_for_the_meshes_as_they_are():
    cylinder, following = scenes.cylinder(closed_seam=False), scenes.module("live.following")
    scenes.edit(cylinder)
    turn_on()
    mark_seams(cylinder, cylinder_seam())
    # In a window, what takes longer than this runs in the background.
    by_scene = scenes.module("session").of(following._Solving).by_scene
    key = scenes.module("session.identity").key(bpy.context.scene)
    first = by_scene[key] = started({cylinder.data: np.array(cylinder_seam())})
    before = scenes.read_uv(cylinder)
    assert first.is_done(60.0)
    # Changed meanwhile.
    scenes.edit_mesh(cylinder).verts.ensure_lookup_table()
    scenes.edit_mesh(cylinder).verts[0].co.z -= 0.25
    assert following._write_solved() > 0.0
    np.testing.assert_array_equal(scenes.read_uv(cylinder), before)
    assert by_scene[key] is not first and by_scene[key].is_done(60.0)
    assert following._write_solved() is None
    assert not by_scene
    stretches = scenes.stretches(cylinder)
    np.testing.assert_allclose(stretches, stretches.mean(), rtol=0.2)
    # Undo drops it, and so does what another operator has written.
    dropped = by_scene[key] = started({})
    after = scenes.read_uv(cylinder)
    following.begin()
    assert dropped._worker._canceled.is_set()
    assert following._write_solved() is None
    np.testing.assert_array_equal(scenes.read_uv(cylinder), after)


def test_a_seam_without_visible_faces_changes_nothing():
    cylinder = scenes.cylinder()
    scenes.edit(cylinder)
    bpy.ops.uv.spectral_unwrap()
    bpy.ops.mesh.hide(unselected=False)
    follow = started({cylinder.data: np.array(cylinder_seam())})
    lines = scenes.module("unwrapping.island_list").lines()
    assert lines and not follow.write()
    assert scenes.module("unwrapping.island_list").lines() == lines


def test_changed_faces_are_not_taken_for_changed_seams():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8, 40])
    turn_on()
    scenes.select_faces(grid, [20])
    bpy.ops.mesh.delete(type="FACE")
    before = scenes.read_uv(grid)
    mark_seams(grid, [(4, 13)])
    scenes.module("live.following").look()
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    # From here on the mesh is known.
    move(grid, 8, (0.1, 0.1))
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, [0, 8, 40]), atol=2e-5)


def test_what_undo_changes_is_not_followed():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8, 40])
    turn_on()
    live, handlers = scenes.module("live.following"), scenes.module("handlers")
    handlers._before_undo()
    before = scenes.read_uv(grid)
    move(grid, 8, (0.1, 0.0))
    mark_seams(grid, [(4, 13)])
    handlers._after_undo()
    live.look()
    others = scenes.corner_vertices(grid) != 8
    np.testing.assert_array_equal(scenes.read_uv(grid)[others], before[others])
    move(grid, 8, (0.1, 0.0))
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, [0, 8, 40]), atol=2e-5)


def test_slow_map_waits_for_the_pins_to_rest(monkeypatch):
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8, 40])
    turn_on()
    live = scenes.module("live.following")
    monkeypatch.setattr(scenes.module("live.pins"), "_SLOW", -1.0)
    before = scenes.read_uv(grid)
    for _ in range(3):
        move(grid, 8, (0.1, 0.1))
    live.look()
    others = scenes.corner_vertices(grid) != 8
    np.testing.assert_array_equal(scenes.read_uv(grid)[others], before[others])
    monkeypatch.setattr(live, "_REST", 0.0)
    assert live._rest() is None
    np.testing.assert_allclose(scenes.read_uv(grid), directly_pinned(grid, [0, 8, 40]), atol=2e-5)


def test_error_is_told_once_and_not_raised(monkeypatch, capfd):
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8, 40])
    turn_on()

    def fail():
        raise scenes.module("core.native").NativeModuleError("no module for the test")

    monkeypatch.setattr(scenes.module("core.native"), "spectral_conformal", fail)
    move(grid, 8, (0.1, 0.0))
    move(grid, 8, (0.1, 0.0))
    output = capfd.readouterr().out
    assert output.count("Live Spectral Unwrap could not follow: no module for the test") == 1


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
    assert bpy.ops.uv.spectral_unwrap(hold_rest=False, soft_pins=0.1) == {"FINISHED"}
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
    others = scenes.corner_vertices(grid) != pins[0]
    assert np.isfinite(scenes.read_uv(grid)[others]).all()
    assert not np.isfinite(scenes.read_uv(grid)[~others]).all()


class Counted:
    """Counts the calls of a function."""

    def __init__(self, monkeypatch, owner, name):
        self.calls = 0
        function = getattr(owner, name)

        def counting(*arguments, **options):
            self.calls += 1
            return function(*arguments, **options)

        monkeypatch.setattr(owner, name, counting)


def touch(edited):
    bmesh.update_edit_mesh(edited.data)
    bpy.context.view_layer.update()


def test_only_changed_meshes_are_seen_again_and_arrays_read_for_pins_only(monkeypatch):
    pinned, *others = (bumpy_grid(name=name) for name in ("Pinned", "One", "Other"))
    prepare_pins(pinned)
    scenes.edit(pinned, *others)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    scenes.pin(pinned, [0])
    bpy.context.view_layer.update()
    look = scenes.module("live.following").look
    seen = Counted(monkeypatch, scenes.module("live.snapshot"), "take")
    read = Counted(monkeypatch, scenes.module("unwrapping.parts"), "read_mesh")
    turn_on()
    assert (seen.calls, read.calls) == (3, 1)
    look()
    assert (seen.calls, read.calls) == (3, 1)
    touch(others[0])
    look()
    assert (seen.calls, read.calls) == (4, 1)
    look()
    assert (seen.calls, read.calls) == (4, 1)
    touch(pinned)
    look()
    assert (seen.calls, read.calls) == (5, 2)
    # A change of the selection does not count.
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.context.view_layer.update()
    look()
    assert (seen.calls, read.calls) == (5, 2)


def test_seams_whose_edges_are_gone_are_not_taken_for_cleared_ones():
    grid = bumpy_grid()
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    mark_seams(grid, [(4, 13)])
    turn_on()
    before = scenes.read_uv(grid)
    bm = scenes.edit_mesh(grid)
    # Turned within its two faces, the numbers of elements stay.
    edge = bm.edges.get([bm.verts[4], bm.verts[13]])
    bmesh.ops.rotate_edges(bm, edges=[edge], use_ccw=False)
    bmesh.update_edit_mesh(grid.data)
    bpy.context.view_layer.update()
    scenes.module("live.following").look()
    np.testing.assert_array_equal(np.sort(scenes.read_uv(grid), axis=0).shape, before.shape)
    assert np.isin(np.round(scenes.read_uv(grid), 4), np.round(before, 4)).all()


def test_nothing_is_seen_outside_edit_mode(monkeypatch):
    grid = bumpy_grid()
    scenes.edit(grid)
    turn_on()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    handlers = scenes.module("handlers")

    class NoUpdates:
        mode = "VIEWPORT"

        @property
        def updates(self):
            raise AssertionError("the updates are looked through")

    handlers._on_depsgraph_update(bpy.context.scene, NoUpdates())
    assert scenes.module("session.edit_meshes").all_kept() == []


def add_extender(edited, first, second, **options):
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    bpy.ops.mesh.select_all(action="DESELECT")
    scenes.select_vertices(edited, (first, second))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER", **options) == {"FINISHED"}
    bpy.context.view_layer.update()


def unwrapped_with(edited):
    """Return what the map would be after an unwrap, without placing it."""
    native = scenes.module("core.native").spectral_conformal()
    read = scenes.module("edit_mesh.read")
    polygons = read.read_mesh(edited, read.Reading(all_visible=True)).polygons
    return native.unwrap(
        polygons.vertices, polygons.face_offsets, polygons.corner_vertices, extenders=polygons.extenders
    ).uv


def test_without_live_unwrapping_an_added_extender_says_when_it_acts(reports):
    grid = bumpy_grid()
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    before = scenes.read_uv(grid)
    reports()
    add_extender(grid, 0, 62, amount=90.0)
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    ((level, text),) = reports()
    assert level == "Info"
    assert text.startswith("Added 1 push/pull for the next unwrap")


def test_the_sidebar_says_that_a_pull_cannot_be_followed():
    grid = bumpy_grid()
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    turn_on()
    add_extender(grid, 2, 5, amount=1.0)
    look, lines = scenes.module("live.following").look, scenes.module("unwrapping.island_list").lines
    before = lines()
    grid.data.spectral_shapes[0].amount = -100.0
    look()
    assert [text.split(":")[0] for _, text in lines()[len(before) :]] == ["Live Spectral Unwrap could not follow"]
    grid.data.spectral_shapes[0].amount = -1.0
    look()
    assert lines() == before


def test_added_changed_and_removed_extenders_are_followed(reports):
    grid = bumpy_grid()
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    turn_on()
    look, shape = scenes.module("live.following").look, scenes.normalized
    start = scenes.read_uv(grid)
    reports()
    add_extender(grid, 0, 62, amount=90.0)
    # At once, in the undo step of the operator.
    assert reports() == [("Info", "Added 1 push/pull")]
    np.testing.assert_allclose(shape(scenes.read_uv(grid)), shape(unwrapped_with(grid)), atol=1e-5)
    assert not np.allclose(shape(scenes.read_uv(grid)), shape(start), atol=1e-3)
    np.testing.assert_allclose(scenes.read_uv(grid).mean(axis=0), start.mean(axis=0), atol=1e-5)
    followed = scenes.read_uv(grid)
    look()
    np.testing.assert_array_equal(scenes.read_uv(grid), followed)

    grid.data.spectral_shapes[0].strength = 0.1
    look()
    np.testing.assert_allclose(shape(scenes.read_uv(grid)), shape(unwrapped_with(grid)), atol=1e-5)
    assert not np.allclose(shape(scenes.read_uv(grid)), shape(followed), atol=1e-3)

    grid.data.spectral_shapes[0].use = False
    look()
    np.testing.assert_allclose(shape(scenes.read_uv(grid)), shape(start), atol=1e-5)

    grid.data.spectral_shapes[0].use = True
    look()
    assert bpy.ops.uv.spectral_shape_remove() == {"FINISHED"}
    np.testing.assert_allclose(scenes.read_uv(grid), start, atol=1e-4)


def test_an_extender_that_cannot_be_followed_is_added_with_a_warning(reports):
    grid = bumpy_grid(8, 6, seams=[(r * 9 + 4, r * 9 + 13) for r in range(6)])
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    turn_on()
    before = scenes.read_uv(grid)
    reports()
    add_extender(grid, 0, 8)
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    (warning,) = [text for level, text in reports() if level == "Warning"]
    assert "different islands" in warning
    assert len(grid.data.spectral_shapes) == 1


def test_a_doubled_face_does_not_split_its_island():
    # The solver joins the faces around a doubled one; an island that followed without it would be torn there.
    grid = bumpy_grid()
    mesh = grid.data
    faces = [tuple(polygon.vertices) for polygon in mesh.polygons]
    positions = [tuple(vertex.co) for vertex in mesh.vertices]
    doubled = scenes.new_object(positions, [*faces, faces[20]], name="Doubled")
    edit_with_pins(doubled, [0, 8, 62])
    turn_on()
    move(doubled, 8, (0.1, 0.2))
    np.testing.assert_allclose(scenes.read_uv(doubled), directly_pinned(doubled, [0, 8, 62]), atol=2e-5)


def test_two_pins_turn_and_scale_their_island_as_it_is():
    grid = bumpy_grid()
    edit_with_pins(grid, [0, 8])
    turn_on()
    before = scenes.read_uv(grid)
    move(grid, 8, (0.1, 0.2))
    after = scenes.read_uv(grid)
    points, moved = before @ [1, 1j], after @ [1, 1j]
    factor, shift = np.polyfit(points, moved, 1)
    np.testing.assert_allclose(factor * points + shift, moved, atol=1e-5)
    assert abs(factor - 1) > 0.1


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_part_solved_in_place_follows_the_uvs_around_it(mirrored):
    edited = scenes.bumpy_grid(8, 6)
    prepare_pins(edited)
    scenes.edit(edited)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    if mirrored:
        scenes.write_uv(edited, scenes.read_uv(edited) * (-1.0, 1.0))
    else:
        scenes.pin(edited, [0, 1])
    turn_on()
    part = [8 * row + column for row in (2, 3, 4) for column in (2, 3, 4, 5)]
    scenes.select_faces(edited, part)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    scenes.select_faces(edited, [0])
    bpy.context.view_layer.update()
    inside = scenes.corners_of(edited, part)
    before = scenes.read_uv(edited)
    vertices = scenes.corner_vertices(edited)
    moved = next(iter(set(vertices[inside].tolist()) & set(vertices[~inside].tolist())))
    free = inside & ~np.isin(vertices, vertices[~inside])
    move(edited, moved, (0.02, -0.01))
    after = scenes.read_uv(edited)
    stays = ~free & (vertices != moved)
    np.testing.assert_array_equal(after[stays], before[stays])
    assert (after[free] != before[free]).any(axis=1).all()
    # A solve of the part as it is now gives the same map.
    scenes.select_faces(edited, part)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    np.testing.assert_allclose(scenes.read_uv(edited), after, atol=2e-6)
    if not mirrored:
        # The pins of the rest take the part along.
        scenes.select_faces(edited, [47])
        bpy.context.view_layer.update()
        move(edited, 0, (-0.05, 0.03))
        assert (scenes.read_uv(edited) != after)[vertices != 1].any(axis=1).all()


def is_cut(edited):
    return any(edge.seam for edge in scenes.edit_mesh(edited).edges)


def test_one_undo_takes_back_a_seam_and_its_map():
    grid = bumpy_grid(8, 6)
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    turn_on()
    bpy.ops.ed.undo_push(message="Unwrap")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.ed.undo_push(message="Deselect")
    before = scenes.read_uv(grid)
    mark_seams(grid, [(4 + 9 * row, 13 + 9 * row) for row in range(6)])
    bpy.ops.ed.undo_push(message="Mark Seam")
    # What the artist selects until the map follows has no map, either.
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.ed.undo_push(message="Select")
    scenes.module("live.following").look()
    after = scenes.read_uv(grid)
    assert not np.array_equal(after, before)
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.ed.undo_push(message="Deselect again")
    for _ in range(2):
        bpy.ops.ed.undo()
        np.testing.assert_array_equal(scenes.read_uv(grid), after)
        bpy.ops.ed.redo()
        bpy.ops.ed.undo()
        bpy.ops.ed.undo()
        np.testing.assert_array_equal(scenes.read_uv(grid), before)
        assert not is_cut(grid)
        bpy.ops.ed.redo()
        np.testing.assert_array_equal(scenes.read_uv(grid), after)
        assert is_cut(grid)
        bpy.ops.ed.redo()
    # Further back it is as ever.
    for _ in range(3):
        bpy.ops.ed.undo()
    assert not is_cut(grid) and bpy.context.edit_object == grid
    np.testing.assert_array_equal(scenes.read_uv(grid), before)


@pytest.mark.parametrize("is_ours", [True, False], ids=["unwrapped", "mapped by someone else"])
def test_islands_of_moved_vertices_follow_in_place_and_one_undo_takes_back_both(is_ours):
    grid = bumpy_grid(8, 6)
    scenes.edit(grid)
    mark_seams(grid, [(4 + 9 * row, 13 + 9 * row) for row in range(6)])
    if is_ours:
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    turn_on()
    before, where = scenes.read_uv(grid), scenes.corner_positions(grid)
    is_left = np.repeat(np.arange(48) % 8 < 4, 4)
    scenes.edit_mesh(grid).verts.ensure_lookup_table()
    bpy.ops.mesh.select_all(action="DESELECT")
    scenes.edit_mesh(grid).verts[20].select_set(True)
    bpy.ops.ed.undo_push(message="Select")
    assert bpy.ops.transform.translate(value=(0.0, 0.0, 0.8)) == {"FINISHED"}
    bpy.ops.ed.undo_push(message="Move")
    bpy.context.view_layer.update()
    scenes.module("live.following").look()
    after = scenes.read_uv(grid)
    assert not np.array_equal(scenes.corner_positions(grid), where)
    np.testing.assert_array_equal(after[~is_left], before[~is_left])
    assert np.array_equal(after, before) != is_ours
    if is_ours:
        np.testing.assert_allclose(after[is_left].mean(axis=0), before[is_left].mean(axis=0), atol=0.05)
        bpy.ops.ed.undo()
        np.testing.assert_array_equal(scenes.read_uv(grid), before)
        np.testing.assert_array_equal(scenes.corner_positions(grid), where)
