# SPDX-License-Identifier: GPL-3.0-or-later
"""The icons of the operators: Blender's own, one for each, which all versions have."""

import bpy

from .. import names

OF = {
    names.UNWRAP_OPERATOR: "UV",
    names.RELAX_OPERATOR: "MOD_SMOOTH",
    names.PACK_OPERATOR: "PACKAGE",
    names.SUGGEST_SEAMS_OPERATOR: "MOD_EDGESPLIT",
    names.SEAM_WISH_OPERATOR: "BRUSH_DATA",
    names.INSPECT_OPERATOR: "EYEDROPPER",
    names.FIT_RANGE_OPERATOR: "VIEWZOOM",
    names.STORE_OPERATOR: "GROUP_VCOL",
    names.PICK_DENSITY_OPERATOR: "EYEDROPPER",
    names.SET_DENSITY_OPERATOR: "TEXTURE",
    names.DENSITY_FACTOR_OPERATOR: "FULLSCREEN_ENTER",
    names.SELECT_OPERATOR: "SELECT_INTERSECT",
    names.STRAIGHTEN_OPERATOR: "IPO_LINEAR",
    names.RECTANGLE_OPERATOR: "MESH_PLANE",
    names.GRID_OPERATOR: "MESH_GRID",
    names.SYMMETRIC_OPERATOR: "MOD_MIRROR",
    names.ALIGN_OPERATOR: "ORIENTATION_VIEW",
    names.SWITCH_CONSTRAINT_OPERATOR: "CHECKBOX_HLT",
    names.REMOVE_CONSTRAINT_OPERATOR: "X",
    names.ADD_EXTENDER_OPERATOR: "ADD",
    names.ADJUST_EXTENDER_OPERATOR: "ARROW_LEFTRIGHT",
    names.REMOVE_EXTENDER_OPERATOR: "REMOVE",
}


def draw_operator(layout: bpy.types.UILayout, operator: str, text: str | None = None) -> bpy.types.OperatorProperties:
    """Draw an operator with its icon, under its own name unless there is a `text`; return its properties."""
    if text is None:
        return layout.operator(operator, icon=OF[operator])
    return layout.operator(operator, text=text, icon=OF[operator])
