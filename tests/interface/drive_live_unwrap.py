# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: drags a pin and marks a seam by mouse and keyboard, Live Spectral Unwrap on."""

import sys

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import area_of, override, point_at, screenshot, uv, xdotool

COLUMNS, ROWS = 24, 12


def open_cylinder():
    """Put half a bent cylinder, pinned at two corners, into edit mode in the UV Editing workspace."""
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=COLUMNS, y_subdivisions=ROWS)
        bpy.ops.object.mode_set(mode="EDIT")
        mesh = bpy.context.edit_object.data
        bm = bmesh.from_edit_mesh(mesh)
        for vertex in bm.verts:
            vertex.co.z = 0.3 * np.sin(3.0 * vertex.co.x) * np.cos(2.0 * vertex.co.y)
        layer = bm.loops.layers.uv.active
        for loop in corners(bm):
            place = loop[layer].uv
            place *= 0.5
            place.x += 0.25
            place.y += 0.25
        for loop in corners(bm):
            x, y = loop.vert.co.xy
            is_corner = abs(y) > 0.999 and abs(x) > 0.999
            loop[layer].pin_uv = is_corner
            on_mesh = drive.UV_SELECTION_ON_MESH
            selection = loop if on_mesh else loop[layer]
            names = ("uv_select_vert", "uv_select_edge") if on_mesh else ("select", "select_edge")
            for name, flag in zip(names, (is_corner and x > 0.0 and y > 0.0, False)):
                setattr(selection, name, flag)
        if drive.UV_SELECTION_ON_MESH:
            for face in bm.faces:
                face.uv_select = False
        bmesh.update_edit_mesh(mesh)
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Pin corners")
    with override("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    yield


def corners(bm):
    return [loop for face in bm.faces for loop in face.loops]


def pins_and_others():
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    layer = bm.loops.layers.uv.active
    pinned = np.array([loop[layer].pin_uv for loop in corners(bm)])
    return uv()[pinned], uv()[~pinned]


def drag(*ways):
    """Start to drag the selected pin, and move the mouse in several steps; return the map after each."""
    point_at("IMAGE_EDITOR", 0.6, 0.6)
    yield
    xdotool("key", "g")
    yield
    maps = []
    _, others = pins_and_others()
    for x, y in ways:
        point_at("IMAGE_EDITOR", x, y)
        yield
        # A busy machine follows later than by the next step.
        yield from drive.until(lambda others=others: np.abs(pins_and_others()[1] - others).max() > 0.005)
        maps.append(pins_and_others())
        others = maps[-1][1]
    return maps


def steps():
    yield from open_cylinder()
    bpy.context.scene.spectral_unwrap_live = True
    yield
    before = uv()

    # Everything follows while the mouse moves.
    (pins, first), (_, second), (moved, third) = yield from drag((0.65, 0.65), (0.7, 0.6), (0.75, 0.75))
    screenshot("live_pin_dragged")
    assert np.abs(moved - pins).max() > 0.03, "the pin does not move"
    assert np.abs(first - second).max() > 0.005
    assert np.abs(second - third).max() > 0.005
    assert np.mean(np.abs(second - third).max(axis=1) > 1e-4) > 0.9, "the map does not follow"

    # Esc puts everything back.
    yield from drive.send("key", "Escape")
    np.testing.assert_array_equal(uv(), before)

    # Confirmed, undone and redone.
    yield from drag((0.65, 0.65), (0.72, 0.7))
    yield from drive.send("click", 1)
    after = uv()
    assert not np.allclose(after, before, atol=0.01)
    screenshot("live_pin_moved")
    yield from drive.check_undo_and_redo(before, after)

    # A confirmed drag is the start of the next.
    yield from drag((0.65, 0.5), (0.7, 0.45))
    assert not np.allclose(uv(), after, atol=0.01)
    yield from drive.send("key", "Escape")
    np.testing.assert_array_equal(uv(), after)

    # A map that takes long waits until the pin rests, after the drag has ended; one undo takes back both.
    pins_module = sys.modules["spectral_unwrap.live.pins"]
    slow, pins_module._SLOW = pins_module._SLOW, -1.0
    point_at("IMAGE_EDITOR", 0.6, 0.6)
    yield
    xdotool("key", "g")
    yield
    region = drive.region_of("IMAGE_EDITOR")
    x, y = region.x + 0.68 * region.width, drive.window().height - region.y - 0.5 * region.height
    xdotool("mousemove", int(x), int(y), "click", 1)
    _, others = pins_and_others()
    yield from drive.until(lambda: np.abs(pins_and_others()[1] - others).max() > 0.005)
    yield
    late = uv()
    screenshot("live_slow_pin_moved")
    yield from drive.check_undo_and_redo(after, late)
    xdotool("key", "ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), after)
    pins_module._SLOW = slow

    # A seam across separates two islands, which are unwrapped and packed.
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    layer = bm.loops.layers.uv.active
    for loop in corners(bm):
        loop[layer].pin_uv = False
    bmesh.update_edit_mesh(bpy.context.edit_object.data)
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    with override("VIEW_3D"):
        bpy.ops.mesh.select_mode(type="EDGE")
        bpy.ops.mesh.select_all(action="DESELECT")
        bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
        middle = sorted(bm.verts, key=lambda vertex: abs(vertex.co.x))[0].co.x
        for edge in bm.edges:
            edge.select = all(abs(vertex.co.x - middle) < 1e-4 for vertex in edge.verts)
        bmesh.update_edit_mesh(bpy.context.edit_object.data)
        bpy.ops.ed.undo_push(message="Select")
    yield
    before = uv()
    point_at("VIEW_3D")
    xdotool("key", "ctrl+e")
    yield
    # The Edge menu's entry with this letter.
    xdotool("key", "m")
    yield
    screenshot("live_edge_menu")
    yield
    marked = [edge for edge in bmesh.from_edit_mesh(bpy.context.edit_object.data).edges if edge.seam]
    assert marked, "no seam is marked"
    with override("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    yield
    screenshot("live_seam_marked")
    followed = uv()
    assert not np.allclose(followed, before, atol=0.01)
    # The seam and its map are one step.
    yield from drive.send("key", "ctrl+z")
    screenshot("live_seam_undone")
    np.testing.assert_array_equal(uv(), before)
    assert not any(edge.seam for edge in bmesh.from_edit_mesh(bpy.context.edit_object.data).edges)
    yield from drive.send("key", "ctrl+shift+z")
    np.testing.assert_array_equal(uv(), followed)
    assert any(edge.seam for edge in bmesh.from_edit_mesh(bpy.context.edit_object.data).edges)
    # Once everything rests, the add-on does not look for changes any more.
    look = sys.modules["spectral_unwrap.live.following"]
    looks = []

    def rests():
        looks.append(look._state().last_look)
        return len(looks) > 3 and len(set(looks[-4:])) == 1

    yield from drive.until(rests)
    assert area_of("IMAGE_EDITOR")


drive.run(steps)
