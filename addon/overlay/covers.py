# SPDX-License-Identifier: GPL-3.0-or-later
"""The regions over the main region of an editor: toolbar, sidebar, headers, Adjust Last Operation."""

import bpy

from .. import session
from ..core.drawing.free_room import Box
from ..session import Remembered


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


class _Laid(Remembered):
    """Where Adjust Last Operation was laid out last, by the address of its editor."""

    def __init__(self) -> None:
        self.boxes: dict[int, Box] = {}


class _InAdjustLastOperation:
    """Redraws an editor below Adjust Last Operation when that is laid out anew: Blender draws the panel alone.

    Base of panels that are never shown; Blender asks whether they are after each change of the size.
    """

    bl_region_type = "HUD"
    bl_label = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Redraw the main region if something else lies over it now; the answer is no."""
        area, region, boxes = context.area, context.region, session.of(_Laid).boxes
        if area is None:
            return False
        box = (float(region.x), float(region.y), float(region.width), float(region.height))
        if boxes.get(area.as_pointer()) != box:
            boxes[area.as_pointer()] = box
            for each in area.regions:
                if each.type == "WINDOW":
                    each.tag_redraw()
        return False

    def draw(self, context: bpy.types.Context) -> None:
        """Draw nothing."""


class VIEW3D_PT_spectral_watch(_InAdjustLastOperation, bpy.types.Panel):
    """In the 3D viewport."""

    bl_space_type = "VIEW_3D"


class IMAGE_PT_spectral_watch(_InAdjustLastOperation, bpy.types.Panel):
    """In the UV editor."""

    bl_space_type = "IMAGE_EDITOR"


def register() -> None:
    """Watch Adjust Last Operation."""
    bpy.utils.register_class(VIEW3D_PT_spectral_watch)
    bpy.utils.register_class(IMAGE_PT_spectral_watch)


def unregister() -> None:
    """Stop watching."""
    bpy.utils.unregister_class(IMAGE_PT_spectral_watch)
    bpy.utils.unregister_class(VIEW3D_PT_spectral_watch)
