# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: unwraps Suzanne by mouse and keyboard, and checks what the mesh holds after each.

    blender --factory-startup --python drive_blender.py -- <folder for the screenshots> <file for the verdict>

Keys and clicks are real ones, sent by xdotool to the X server. The steps are a generator; Blender's event loop runs at
each `yield`. The verdict is "passed" or a traceback.
"""

import subprocess
import sys
import traceback
from pathlib import Path

import addon_utils
import bmesh
import bpy
import numpy as np

SCREENSHOTS, VERDICT = (Path(path) for path in sys.argv[sys.argv.index("--") + 1 :])
PAUSE = 0.7  # seconds between steps; software rendering takes up to half of it


def xdotool(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True)


def screenshot(name):
    subprocess.run(["import", "-window", "root", str(SCREENSHOTS / f"{name}.png")], check=True)


def area_of(kind):
    return next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == kind)


def override(kind):
    area = area_of(kind)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region)


def point_at(kind, x=0.5, y=0.5):
    """Move the mouse to a place in an editor, `x` to the right and `y` upwards, each from 0 to 1."""
    area, window = area_of(kind), bpy.context.window_manager.windows[0]
    xdotool("mousemove", int(area.x + x * area.width), int(window.height - area.y - y * area.height))


def point_at_adjust_last_operation(row):
    """Move the mouse to the field in a row, counted from 0 at the bottom, of Adjust Last Operation in the viewport."""
    region = next(region for region in area_of("VIEW_3D").regions if region.type == "HUD")
    window = bpy.context.window_manager.windows[0]
    xdotool("mousemove", region.x + int(0.7 * region.width), window.height - region.y - 20 - 22 * row)


def uv():
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    layer = bm.loops.layers.uv.active
    return np.array([loop[layer].uv for face in bm.faces for loop in face.loops])


def last_operator():
    """Return the last operator, which must be the add-on's."""
    operator = bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "UV_OT_spectral_unwrap", operator.bl_idname
    return operator


def open_suzanne():
    """Put Suzanne into edit mode in the UV Editing workspace, with a seam down the back of her head."""
    bpy.context.preferences.view.show_splash = False
    # Without a window manager nobody gives Blender the focus; without it, reports are not shown.
    xdotool("search", "--onlyvisible", "--class", "blender", "windowfocus")
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.context.window_manager.windows[0].workspace = bpy.data.workspaces["UV Editing"]
    yield
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
    """Open the unwrap menu with U and choose the add-on's entry by keyboard: its last.

    `picture` names the screenshot of a menu opened for the first time. Later Blender opens it at the entry chosen last.
    """
    xdotool("key", "u")
    yield
    if picture:
        xdotool("key", "Up")
        yield
        screenshot(picture)
    xdotool("key", "Return")
    yield
    yield


def steps():
    yield from open_suzanne()
    before = uv()

    point_at("VIEW_3D")
    yield from choose_from_menu("menu_in_viewport")
    assert last_operator().properties.placement == "PACK"
    unwrapped = uv()
    assert np.isfinite(unwrapped).all()
    assert not np.array_equal(unwrapped, before)
    with override("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    yield
    screenshot("unwrapped")

    point_at_adjust_last_operation(0)
    yield
    xdotool("click", 1)
    yield
    yield
    screenshot("adjust_last_operation")
    point_at_adjust_last_operation(1)
    yield
    # Over a list, Ctrl and the wheel choose the next entry.
    xdotool("keydown", "ctrl", "click", 5, "keyup", "ctrl")
    yield
    yield
    screenshot("kept_in_place")
    assert last_operator().properties.placement == "KEEP"
    packed, unwrapped = unwrapped, uv()
    assert not np.array_equal(unwrapped, packed)
    point_at("VIEW_3D")
    yield

    xdotool("key", "ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), before)
    xdotool("key", "ctrl+shift+z")
    yield
    np.testing.assert_array_equal(uv(), unwrapped)

    point_at("IMAGE_EDITOR")
    xdotool("key", "a")
    yield
    yield from choose_from_menu("menu_in_uv_editor")
    # The settings are remembered, and in place a second unwrap stays within the same bounds.
    assert last_operator().properties.placement == "KEEP"
    np.testing.assert_allclose(
        [uv().min(axis=0), uv().max(axis=0)], [unwrapped.min(axis=0), unwrapped.max(axis=0)], atol=1e-5
    )
    screenshot("unwrapped_from_uv_editor")

    with override("IMAGE_EDITOR"):
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True, placement="PACK") == {"FINISHED"}
    np.testing.assert_allclose(uv(), packed, atol=1e-6)
    unwrapped = uv()
    xdotool("key", "alt+a")
    yield
    yield from choose_from_menu()
    np.testing.assert_array_equal(uv(), unwrapped)
    screenshot("nothing_selected")


def run():
    sequence = steps()

    def advance():
        try:
            next(sequence)
            return PAUSE
        except StopIteration:
            VERDICT.write_text("passed")
        except BaseException:  # noqa: BLE001 - whatever happened goes to the test that waits for the verdict
            screenshot("failed")
            VERDICT.write_text(traceback.format_exc())
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(advance, first_interval=3.0)


addon_utils.enable("spectral_unwrap", default_set=True)
run()
