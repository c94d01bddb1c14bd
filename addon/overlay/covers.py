# SPDX-License-Identifier: GPL-3.0-or-later
"""The regions over the main region of an editor: toolbar, sidebar, headers, Adjust Last Operation."""

import bpy

from .. import editors, names, session
from ..session import Remembered

Box = tuple[float, float, float, float]
"""Left, bottom, right and upper end, in pixels."""


def free_box(area: bpy.types.Area, region: bpy.types.Region, width: float, with_sidebar: bool = True) -> Box:
    """Return the part of a region, in pixels, in whose lower right corner a box of this width is covered by nothing.

    It lies between toolbar and sidebar, above headers and, where the box would reach it, Adjust Last Operation; these
    count where Blender's Region Overlap lays them over the region. The sidebar, which counts if `with_sidebar`, is
    transparent below its panels.
    """
    left, bottom, right = 0.0, 0.0, float(region.width)
    # A hidden region is one pixel wide or high.
    uncounted = {"WINDOW"} if with_sidebar else {"WINDOW", "UI"}
    others = [each for each in area.regions if each.type not in uncounted and min(each.width, each.height) > 1]
    for each in others:
        if each.type in {"TOOLS", "UI"} and each.x <= region.x:
            left = max(left, float(each.x + each.width - region.x))
        elif each.type in {"TOOLS", "UI"} and each.x + each.width >= region.x + region.width:
            right = min(right, float(each.x - region.x))
    for each in others:
        is_at_bottom = each.type == "HUD" or ("HEADER" in each.type and each.y <= region.y)
        if is_at_bottom and each.x + each.width - region.x > right - width:
            bottom = max(bottom, float(each.y + each.height - region.y))
    return left, bottom, right, float(region.height)


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


def _watches() -> list[type]:
    """Return the panel of each kind of editor."""
    bases = (_InAdjustLastOperation, bpy.types.Panel)
    each = zip(names.PANEL_PREFIXES, editors.KINDS)
    return [type(f"{prefix}watch", bases, {"bl_space_type": space}) for prefix, space in each]


register, unregister = bpy.utils.register_classes_factory(_watches())
