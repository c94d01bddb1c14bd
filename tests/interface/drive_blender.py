# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: unwraps Suzanne by mouse and keyboard, and checks what the mesh holds after each.

Keys and clicks are real ones, sent by xdotool to the X server. See session.py.
"""

import bmesh
import bpy
import numpy as np

from tests.interface import driving
from tests.interface.driving import last_operator, point_at_setting
from tests.interface.session import override, point_at, screenshot, uv, xdotool


def open_suzanne():
    """Put Suzanne into edit mode in the UV Editing workspace, with a seam down the back of her head."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_monkey_add()
        bpy.ops.object.mode_set(mode="EDIT")
        mesh = bpy.context.edit_object.data
        bm = bmesh.from_edit_mesh(mesh)
        for edge in bm.edges:
            edge.seam = all(abs(v.co.x) < 1e-4 for v in edge.verts) and sum(v.co.y for v in edge.verts) > 0.0
        bmesh.update_edit_mesh(mesh)
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Mark seams")
    yield


def choose_from_menu(picture=None):
    """Open the unwrap menu with U and choose the add-on's entry, the first, by keyboard.

    `picture` names the screenshot of a menu opened for the first time. Later Blender opens it at the entry chosen last.
    """
    xdotool("key", "u")
    yield
    if picture:
        xdotool("key", "Home")
        yield
        screenshot(picture)
    yield from driving.send("key", "Return")


def steps():
    yield from open_suzanne()
    before = uv()

    point_at("VIEW_3D")
    yield from choose_from_menu("menu_in_viewport")
    yield from driving.until(lambda: not np.array_equal(uv(), before))
    assert not last_operator().properties.keep_in_place
    unwrapped = uv()
    assert np.isfinite(unwrapped).all()
    assert not np.array_equal(unwrapped, before)
    yield from driving.show_uvs()
    screenshot("unwrapped")

    yield from driving.open_adjust_last_operation()
    screenshot("adjust_last_operation")
    point_at_setting("keep_in_place")
    yield
    yield from driving.send("click", 1)
    screenshot("kept_in_place")
    assert last_operator().properties.keep_in_place
    packed, unwrapped = unwrapped, uv()
    assert not np.array_equal(unwrapped, packed)
    point_at("VIEW_3D")
    yield

    yield from driving.check_undo_and_redo(before, unwrapped)

    point_at("IMAGE_EDITOR")
    xdotool("key", "a")
    yield
    done = len(bpy.context.window_manager.operators)
    yield from choose_from_menu("menu_in_uv_editor")
    yield from driving.until(lambda: len(bpy.context.window_manager.operators) > done)
    # The settings are remembered, and in place a second unwrap stays within the same bounds.
    assert last_operator().properties.keep_in_place
    np.testing.assert_allclose(
        [uv().min(axis=0), uv().max(axis=0)], [unwrapped.min(axis=0), unwrapped.max(axis=0)], atol=1e-5
    )
    screenshot("unwrapped_from_uv_editor")

    with override("IMAGE_EDITOR"):
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True, keep_in_place=False) == {"FINISHED"}
    np.testing.assert_allclose(uv(), packed, atol=1e-6)
    unwrapped = uv()
    xdotool("key", "alt+a")
    yield
    yield from choose_from_menu()
    np.testing.assert_array_equal(uv(), unwrapped)
    screenshot("nothing_selected")


driving.run(steps)
