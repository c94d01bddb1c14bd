# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Spectral Unwrap, as Adjust Last Operation and the sidebar show them."""

from typing import Any

import bpy

from ..core.words import texts
from .settings_layout import split


def draw_common(layout: bpy.types.UILayout, properties: Any) -> None:  # noqa: ANN401 - the operator or its defaults
    """Draw the common settings."""
    split(layout)
    layout.prop(properties, "area_blend")
    layout.prop(properties, "fold_free")
    layout.prop(properties, "keep_in_place")
    column = layout.column()
    column.active = not properties.keep_in_place
    column.prop(properties, "turn_to_pack")


def draw_fold(layout: bpy.types.UILayout, properties: Any) -> None:  # noqa: ANN401 - the operator or its defaults
    """Draw the heading that folds and unfolds the rest."""
    row = layout.row()
    row.use_property_split = False
    # Without a frame the name would be white, which the light theme's background hides.
    icon = "DOWNARROW_HLT" if properties.show_advanced else "RIGHTARROW"
    row.prop(properties, "show_advanced", icon=icon, toggle=True)


def draw_advanced(
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401 - the operator or its record
    is_narrow: bool = False,
) -> None:
    """Draw the rest."""
    split(layout, is_narrow)
    if is_narrow:
        # In Adjust Last Operation it is a common one.
        layout.prop(properties, "turn_to_pack")
    is_spectral = properties.method == "SPECTRAL"
    _enumeration(layout, properties, "method", texts.METHOD_PROPERTY, is_narrow)
    _enumeration(layout, properties, "weights", texts.WEIGHTS_PROPERTY, is_narrow)
    _enumeration(_row(layout, is_spectral), properties, "boundary", texts.BOUNDARY_PROPERTY, is_narrow)
    layout.prop(properties, "hold_rest")
    layout.prop(properties, "polish")
    layout.prop(properties, "stretch")
    layout.separator()
    layout.prop(properties, "fill_holes")
    _row(layout, is_spectral).prop(properties, "hole_rigidity")
    _row(layout, is_spectral and properties.hole_rigidity == 0.0).prop(properties, "automatic_holes")
    layout.separator()
    _row(layout, is_spectral).prop(properties, "soft_pins")
    _row(layout, is_spectral and properties.soft_pins).prop(properties, "soft_pin_strength")
    layout.separator()
    layout.prop(properties, "correct_aspect")
    layout.prop(properties, "use_subsurf_data")


def _enumeration(
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401 - the operator or its record
    identifier: str,
    words: dict[str, str],
    is_narrow: bool,
) -> None:
    # In the default context Blender translates the boundary as one of sounds.
    name = {"text": words["name"], "text_ctxt": "Operator"}
    if not is_narrow:
        layout.prop(properties, identifier, **name)
        return
    # Blender leaves too little room for the name.
    split = layout.split(factor=0.53)
    split.label(**name)
    split.prop(properties, identifier, text="")


def _row(layout: bpy.types.UILayout, active: bool) -> bpy.types.UILayout:
    row = layout.row()
    row.active = active
    return row
