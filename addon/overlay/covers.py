# SPDX-License-Identifier: GPL-3.0-or-later
"""The regions over the main region of an editor: toolbar, sidebar, headers, Adjust Last Operation."""

import bpy

from ..core.drawing.free_room import Box


def of(area: bpy.types.Area, region: bpy.types.Region, with_sidebar: bool = True) -> tuple[Box, ...]:
    """Return the parts of a region that the editor's other regions cover, in pixels from its lower left corner.

    None if the other regions lie beside it, as without Blender's Region Overlap. The sidebar, which counts if
    `with_sidebar`, is transparent below its panels.
    """
    uncounted = {"WINDOW"} if with_sidebar else {"WINDOW", "UI"}
    # A hidden region is one pixel wide or high.
    others = [each for each in area.regions if each.type not in uncounted and min(each.width, each.height) > 1]
    boxes = [(each.x - region.x, each.y - region.y, each.width, each.height) for each in others]
    return tuple(
        (max(x, 0.0), max(y, 0.0), min(x + width, float(region.width)), min(y + height, float(region.height)))
        for x, y, width, height in boxes
        if x < region.width and y < region.height and x + width > 0 and y + height > 0
    )
