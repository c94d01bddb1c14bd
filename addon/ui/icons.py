# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators with their icons: Blender's own, one for each, which all versions have."""

import bpy

from .. import names
from ..core import choices
from ..core.words import texts

OF = {
    names.UNWRAP_OPERATOR: "UV",
    names.RELAX_OPERATOR: "MOD_SMOOTH",
    names.PACK_OPERATOR: "PACKAGE",
    names.ARRANGE_OPERATOR: "SORTSIZE",
    names.NEW_TEXTURES_OPERATOR: "IMAGE_DATA",
    names.SUGGEST_SEAMS_OPERATOR: "MOD_EDGESPLIT",
    names.SEAM_HINT_OPERATOR: "BRUSH_DATA",
    names.INSPECT_OPERATOR: "EYEDROPPER",
    names.STORE_OPERATOR: "GROUP_VCOL",
    names.SELECT_OPERATOR: "SELECT_INTERSECT",
    names.EXTENDER_OPERATOR: "ARROW_LEFTRIGHT",
    names.REMOVE_SHAPE_OPERATOR: "X",
}
# Of the kinds of shapes.
OF_SHAPE = {
    choices.SHAPE_STRAIGHT: "IPO_LINEAR",
    choices.SHAPE_RECTANGLE: "MESH_PLANE",
    choices.SHAPE_GRID: "MESH_GRID",
    choices.SHAPE_SYMMETRIC: "MOD_MIRROR",
    choices.SHAPE_UPRIGHT: "ORIENTATION_VIEW",
    choices.SHAPE_EXTENDER: "ARROW_LEFTRIGHT",
}


def draw_shapes(layout: bpy.types.UILayout) -> None:
    """Draw the operator for every kind of shape."""
    for kind, label, _ in texts.SHAPE_ITEMS:
        layout.operator(names.SHAPE_OPERATOR, text=label, icon=OF_SHAPE[kind]).kind = kind


def draw_operator(layout: bpy.types.UILayout, operator: str, text: str | None = None) -> bpy.types.OperatorProperties:
    """Draw an operator with its icon, under its own name unless there is a `text`; return its properties."""
    if text is None:
        return layout.operator(operator, icon=OF[operator])
    return layout.operator(operator, text=text, icon=OF[operator])
