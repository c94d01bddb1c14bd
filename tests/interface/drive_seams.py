# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist cuts a cylinder open and unwraps it, by mouse and keyboard."""

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import override, point_at, screenshot, uv, xdotool


def seams():
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    return [sorted(vertex.index for vertex in edge.verts) for edge in bm.edges if edge.seam]


def open_cylinder():
    """Put a cylinder without ends into edit mode, seen from the front, in edge mode without a selection."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_cylinder_add(vertices=16, end_fill_type="NOTHING")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.view3d.view_selected()
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Cylinder")
    yield
    point_at("VIEW_3D")
    xdotool("key", "2")
    yield


def steps():
    yield from open_cylinder()
    before = uv()

    drive.point_at_vertices(8, 9)
    xdotool("click", 1)
    yield
    # Higher up, so that the whole menu has room below the mouse.
    xdotool("mousemove_relative", "--", 0, -200)
    yield from drive.send("key", "u")
    yield from drive.click_below(drive.LAYOUT.first_to_mark_seam, "mark_seam")
    yield
    if not seams():
        # In 4.3 the first click closes the submenu that has opened beside Unwrap.
        xdotool("click", 1)
        yield from drive.until(seams)
    assert seams() == [[8, 9]], seams()

    point_at("VIEW_3D")
    xdotool("key", "a")
    yield
    drive.point_at_header("VIEW_3D", drive.UV_MENU)
    xdotool("click", 1)
    yield
    yield from drive.click_below(drive.LAYOUT.header_to_unwrap, "uv_menu")
    yield from drive.until(lambda: not np.array_equal(uv(), before))
    assert not drive.last_operator().properties.keep_in_place
    packed = uv()
    # Cut along its side, the cylinder becomes a rectangle: 16 chords of radius 1 by a height of 2.
    np.testing.assert_allclose(np.ptp(packed, axis=0), [1.0, 2.0 / (32.0 * np.sin(np.pi / 16.0))], atol=0.01)
    yield from drive.show_uvs()

    yield from drive.open_adjust_last_operation()
    screenshot("seam_unwrapped")
    drive.point_at_setting("keep_in_place")
    yield from drive.send("click", 1)
    assert drive.last_operator().properties.keep_in_place
    kept = uv()
    assert not np.array_equal(kept, packed)
    screenshot("kept_in_place")
    point_at("VIEW_3D")
    yield from drive.check_undo_and_redo(before, kept)

    xdotool("key", "F3")
    yield
    xdotool("type", "--delay", "60", "spectral unwrap")
    yield
    screenshot("search")
    count = len(bpy.context.window_manager.operators)
    yield from drive.send("key", "Return")
    assert len(bpy.context.window_manager.operators) == count + 1
    # The settings are remembered.
    assert drive.last_operator().properties.keep_in_place
    point_at("VIEW_3D")
    yield from drive.check_undo_and_redo(kept, uv())


drive.run(steps)
