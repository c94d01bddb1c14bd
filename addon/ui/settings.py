# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the operators, as Adjust Last Operation, the sidebar and the preferences show them.

`properties` are an operator, Blender's record of its last settings, or the defaults in the preferences. A narrow layout
has the names inside the fields, and leaves out what belongs to one call or stands elsewhere in the sidebar.
"""

from collections.abc import Iterable
from typing import Any

import bpy

from ..core import choices
from ..core.words import texts
from . import widths

_OF_DISTORTION = ("scale_limit", "angle_distortion", "longest_side", "max_length", "keep_front")
# Properties of Suggest Seams that the sidebar shows.
OF_SEAMS = ("style", "sharp_angle", *_OF_DISTORTION, "seam_group", "seam_group_use")
_OF_TILES = {choices.TILES_SEVERAL: ("tile_count",), choices.TILES_BOX: ("box",)}
# The share of a narrow row that a name takes.
_NAME = 0.48


def split(layout: bpy.types.UILayout, is_narrow: bool = False) -> None:
    """Put names beside the fields; if the layout `is_narrow`, inside them."""
    layout.use_property_split = not is_narrow
    layout.use_property_decorate = False


def draw(
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401 - as the module says
    identifiers: Iterable[str],
    is_narrow: bool = False,
) -> None:
    """Draw these properties one below the other."""
    split(layout, is_narrow)
    for identifier in identifiers:
        _draw(layout, properties, identifier, is_narrow)


def _draw(layout: bpy.types.UILayout, properties: Any, identifier: str, is_narrow: bool, active: bool = True) -> None:  # noqa: ANN401
    row = layout.row()
    row.active = active
    # Those of an operator that runs are apart.
    known = getattr(properties, "properties", properties).bl_rna.properties[identifier]
    # In the default context Blender translates the boundary as one of sounds, and long.
    name = {"text": known.name, "text_ctxt": "Operator"}
    if getattr(known, "is_array", False):
        # Points, each in a row.
        column = row.column(align=True)
        column.label(**name)
        for first in range(0, known.array_length, 2):
            point = column.row(align=True)
            for index in (first, first + 1):
                point.prop(properties, identifier, index=index, text="")
        return
    if known.type not in {"ENUM", "BOOLEAN"}:
        row.prop(properties, identifier)
        return
    if not is_narrow or known.type == "BOOLEAN":
        row.prop(properties, identifier, **name)
        return
    chosen = known.enum_items[getattr(properties, identifier)].name
    text = bpy.app.translations.pgettext_iface(chosen, known.translation_context)
    # Blender leaves too little room for the name.
    has_room = widths.has_room_for(bpy.context, text, 1.0 - _NAME)
    parts = row.split(factor=_NAME) if has_room else row.column(align=True)
    parts.label(**name)
    parts.prop(properties, identifier, text="")


def last(operator: str) -> bpy.types.OperatorProperties:
    """Return Blender's record of the settings used last, with which the operator starts."""
    return bpy.context.window_manager.operator_properties_last(operator)


def draw_seams(
    context: bpy.types.Context,
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401
    is_narrow: bool = False,
) -> None:
    """Draw the settings of Suggest Seams."""
    split(layout, is_narrow)
    if is_narrow:
        columns = min(2, widths.columns(context, [label for _, label, _ in texts.SEAM_STYLES]))
        grid = layout.grid_flow(row_major=True, columns=columns, even_columns=True, align=True)
        for style, _, _ in texts.SEAM_STYLES:
            grid.prop_enum(properties, "style", style)
    else:
        layout.prop(properties, "style")
    if properties.style == choices.SEAMS_BY_ANGLE:
        layout.prop(properties, "sharp_angle")
        return
    draw(layout, properties, _OF_DISTORTION, is_narrow)
    name, column = {}, layout.column(align=True)
    if is_narrow:
        # Beside it, the name would leave no room for the group's.
        name = {"text": ""}
        column.label(text="Vertex Group")
    column.prop_search(properties, "seam_group", context.edit_object, "vertex_groups", **name)
    if properties.seam_group:
        column.prop(properties, "seam_group_use", **name)


def draw_unwrap(layout: bpy.types.UILayout, properties: Any) -> None:  # noqa: ANN401
    """Draw the common settings of Spectral Unwrap."""
    draw(layout, properties, ("area_blend", "straighten", "fold_free", "keep_in_place"))


def draw_fold(layout: bpy.types.UILayout, properties: Any) -> None:  # noqa: ANN401
    """Draw the heading that folds and unfolds the rest, and, unfolded, the rest."""
    row = layout.row()
    row.use_property_split = False
    # Without a frame the name would be white, which the light theme's background hides.
    icon = "DOWNARROW_HLT" if properties.show_advanced else "RIGHTARROW"
    row.prop(properties, "show_advanced", icon=icon, toggle=True)
    if properties.show_advanced:
        draw_advanced(layout, properties)


def draw_advanced(layout: bpy.types.UILayout, properties: Any, is_narrow: bool = False) -> None:  # noqa: ANN401
    """Draw the rest of the settings of Spectral Unwrap."""
    is_spectral = properties.method == "SPECTRAL"
    has_rigidity = properties.hole_rigidity > 0.0
    draw(layout, properties, ("method", "weights"), is_narrow)
    _draw(layout, properties, "boundary", is_narrow, is_spectral)
    draw(layout, properties, ("hold_rest", "polish", "stretch", "fill_holes"), is_narrow)
    for identifier, active in (
        ("hole_rigidity", is_spectral),
        ("automatic_hole_rigidity", is_spectral and not has_rigidity),
        ("soft_pins", is_spectral),
    ):
        _draw(layout, properties, identifier, is_narrow, active)
    draw(layout, properties, ("correct_aspect", "use_subsurf_data"), is_narrow)


def draw_relax(layout: bpy.types.UILayout, properties: Any, is_narrow: bool = False) -> None:  # noqa: ANN401
    """Draw the settings of Spectral Relax."""
    of_call = () if is_narrow else ("steps",)
    draw(layout, properties, ("sizes", *of_call, "border", "fold_free"), is_narrow)


def draw_pack(layout: bpy.types.UILayout, properties: Any, is_narrow: bool = False) -> None:  # noqa: ANN401
    """Draw the settings of Spectral Pack."""
    first, of_call = ((), ()) if is_narrow else (("margin", "texture_size", "rotation"), ("steps",))
    of_tiles = _OF_TILES.get(properties.tiles, ())
    scale = () if properties.tiles == choices.TILES_AUTO else ("scale",)
    rest = (*scale, "min_size", "snap", "stacks", "groups", "hold_pinned", "tiles", *of_tiles)
    draw(layout, properties, (*first, *rest, *of_call, "seconds"), is_narrow)
