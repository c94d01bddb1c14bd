# SPDX-License-Identifier: GPL-3.0-or-later
"""The editors in which the add-on draws: 3D viewports and image editors."""

import bpy

KINDS = ("VIEW_3D", "IMAGE_EDITOR")


def redraw(context: bpy.types.Context) -> None:
    """Redraw the editors in which the add-on draws, in all windows."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in KINDS:
                area.tag_redraw()


def region_at(screen: bpy.types.Screen, x: int, y: int) -> tuple[bpy.types.Area, bpy.types.Region] | None:
    """Return the editor and its main region at a point of the window; None if another region covers it."""
    for area in screen.areas:
        if area.type not in KINDS:
            continue
        found = None
        for region in area.regions:
            if region.x <= x < region.x + region.width and region.y <= y < region.y + region.height:
                if region.type != "WINDOW":
                    return None
                found = found or region
        if found is not None:
            return area, found
    return None
