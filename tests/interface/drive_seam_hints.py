# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: hints for seams, by click, and settings in the sidebar during the preview."""

import math

import bmesh
import bpy

from tests.interface import driving as drive
from tests.interface.drive_suggest_seams import seams, shown, watch_previews
from tests.interface.extender_sidebar import (
    BY_ANGLE,
    CUT_HERE,
    NEVER_HERE,
    SEAMS,
    SUGGEST_SEAMS,
    click_sidebar,
    open_sidebar,
)
from tests.interface.session import area_of, override, picture, point_at, screenshot, xdotool

WHEEL_DOWN = 5


def open_block():
    """Put a cube with beveled edges, without a UV map, into edit mode, nothing selected, and open the sidebar."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_cube_add(calc_uvs=False)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.bevel(offset=0.25, segments=3)
        bpy.ops.view3d.view_selected()
        bpy.ops.mesh.select_mode(type="EDGE")
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Block")
    yield from open_sidebar()


def select(chosen):
    """Select the edges for which `chosen` holds, given their middle; return their vertices."""
    mesh = bpy.context.edit_object.data
    bm = bmesh.from_edit_mesh(mesh)
    found = set()
    for edge in bm.edges:
        middle = (edge.verts[0].co + edge.verts[1].co) / 2.0
        edge.select_set(chosen(middle))
        if edge.select:
            found.add(tuple(sorted(vertex.index for vertex in edge.verts)))
    bmesh.update_edit_mesh(mesh)
    return found


def has_color(pixels, red, green, blue):
    """Return whether many pixels of a picture have about this color."""
    near = (abs(pixels - (red, green, blue)) < 0.12).all(axis=2)
    return near.sum() > 200


def steps():
    yield from open_block()
    watch_previews()

    # The rim of the top is to be cut, the right side never.
    rim = select(lambda middle: abs(middle.z - 1.0) < 1e-4)
    yield from click_sidebar(SEAMS)
    yield from click_sidebar(CUT_HERE)
    side = select(lambda middle: middle.x > 0.9)
    yield from click_sidebar(NEVER_HERE)
    select(lambda _: False)
    point_at("VIEW_3D", 0.3, 0.3)
    yield
    yield
    pixels = picture("seam_hints")
    assert has_color(pixels, 1.0, 0.92, 0.1), "no yellow lines"
    assert has_color(pixels, 0.75, 0.3, 1.0), "no violet lines"
    rim -= side

    # The search obeys.
    yield from click_sidebar(SUGGEST_SEAMS)
    yield from drive.until(lambda: shown)
    yield from drive.until(lambda: shown[0].count in shown[0]._measured)
    yield
    pixels = picture("seam_hints_preview")
    assert has_color(pixels[:, : area_of("IMAGE_EDITOR").width], 0.17, 0.6, 0.38), "no coming layout"
    edges = {tuple(sorted(edge)) for edge in shown[0].answer[0].edges(0).tolist()}
    assert rim <= edges
    assert not side & edges

    # Settings in the sidebar change the running preview, and clicks there apply nothing.
    settings = bpy.context.window_manager.operator_properties_last("uv.spectral_suggest_seams")
    screenshot("seam_hints_settings")
    yield from click_sidebar(BY_ANGLE)
    yield from drive.until(lambda: settings.style == "ANGLE")
    assert shown
    settings.sharp_angle = math.radians(20.0)
    yield from drive.until(lambda: round(shown[0]._sidebar.angle or 0.0) == 20 and shown[0]._searching is None)
    yield from drive.until(lambda: shown[0].count in shown[0]._measured)
    yield
    screenshot("seam_hints_by_angle")
    islands = shown[0]._measured[0].islands
    point_at("VIEW_3D", 0.4, 0.3)
    for _ in range(15):
        xdotool("click", WHEEL_DOWN)
    yield
    yield from drive.until(lambda: round(math.degrees(settings.sharp_angle)) == 35)
    yield from drive.until(lambda: shown[0]._searching is None and shown[0].count in shown[0]._measured)
    yield
    screenshot("seam_hints_larger_angle")
    assert shown[0]._measured[0].islands < islands
    assert area_of("VIEW_3D")
    xdotool("key", "Return")
    yield from drive.until(seams)
    yield
    assert not shown
    assert rim <= seams()
    assert not side & seams()
    yield from drive.show_uvs()
    screenshot("seam_hints_applied")


if __name__ == "__main__":
    drive.run(steps)
