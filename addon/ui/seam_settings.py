# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Suggest Seams, as Adjust Last Operation and the sidebar show them."""

from typing import Any

import bpy

from .. import names
from ..core.words import texts
from .settings_layout import split

_OF_DISTORTION = ("size_variation", "angle_distortion", "max_length", "keep_front")
# Properties of the operator that the sidebar shows.
NAMES = ("method", "sharp_angle", *_OF_DISTORTION, "seam_group", "seam_group_use")


def last() -> bpy.types.OperatorProperties:
    """Return Blender's record of the settings used last, with which the next search starts."""
    return bpy.context.window_manager.operator_properties_last(names.SUGGEST_SEAMS_OPERATOR)


def draw(
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401 - the operator or its record
    edit_object: bpy.types.Object,
    is_narrow: bool = False,
) -> None:
    """Draw the settings; if it `is_narrow`, with the names inside the fields."""
    split(layout, is_narrow)
    if is_narrow:
        layout.row().prop(properties, "method", expand=True)
    else:
        layout.prop(properties, "method")
    if properties.method == "ANGLE":
        layout.prop(properties, "sharp_angle")
        return
    for name in _OF_DISTORTION:
        layout.prop(properties, name)
    # In a narrow column the name would leave no room for the group's.
    name = {"text": ""} if is_narrow else {}
    layout.prop_search(properties, "seam_group", edit_object, "vertex_groups", **name)
    if properties.seam_group:
        layout.prop(properties, "seam_group_use", text="" if is_narrow else texts.SEAM_GROUP_USE_PROPERTY["name"])
