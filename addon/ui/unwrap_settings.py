# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Spectral Unwrap, as Adjust Last Operation and the sidebar show them."""

from typing import Any

import bpy

from ..core import texts


def draw_common(layout: bpy.types.UILayout, properties: Any) -> None:  # noqa: ANN401 - the operator or its record
    """Draw what artists change."""
    _split(layout)
    layout.prop(properties, "area_blend")
    layout.prop(properties, "fold_free")
    layout.prop(properties, "placement")
    column = layout.column()
    column.active = properties.placement == texts.PACK
    column.prop(properties, "turn_to_pack")
    column.prop(properties, "margin_method")
    column.prop(properties, "margin")


def draw_advanced(layout: bpy.types.UILayout, properties: Any) -> None:  # noqa: ANN401 - the operator or its record
    """Draw the rest."""
    _split(layout)
    is_spectral = properties.method == "SPECTRAL"
    layout.prop(properties, "method")
    layout.prop(properties, "weights")
    _row(layout, is_spectral).prop(properties, "boundary")
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


def _split(layout: bpy.types.UILayout) -> None:
    layout.use_property_split = True
    layout.use_property_decorate = False


def _row(layout: bpy.types.UILayout, active: bool) -> bpy.types.UILayout:
    row = layout.row()
    row.active = active
    return row
