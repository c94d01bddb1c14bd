# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Spectral Relax and Spectral Pack, as Adjust Last Operation and the sidebar show them."""

from typing import Any

import bpy

from ..core import choices
from .settings_layout import split

_OF_TILES = {choices.TILES_SEVERAL: ("tile_count",), choices.TILES_BOX: ("box_low", "box_high")}


def draw_relax(
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401 - the operator or its record
    is_narrow: bool = False,
) -> None:
    """Draw the settings of Spectral Relax; if it `is_narrow`, without those of a call."""
    split(layout, is_narrow)
    of_call = () if is_narrow else ("steps",)
    _draw(layout, properties, ("sizes", *of_call, "hold_border", "fold_free", "correct_aspect"), is_narrow)


def draw_pack(
    layout: bpy.types.UILayout,
    properties: Any,  # noqa: ANN401 - the operator or its record
    is_narrow: bool = False,
) -> None:
    """Draw the settings of Spectral Pack; if it `is_narrow`, without those that stand elsewhere or are of a call."""
    split(layout, is_narrow)
    first = () if is_narrow else ("margin", "texture_size", "rotation")
    of_call = () if is_narrow else ("steps",)
    names = ("scale", "stacks", "groups", "hold_pinned", "tiles", *_OF_TILES.get(properties.tiles, ()))
    _draw(layout, properties, (*first, *names, "correct_aspect", *of_call, "seconds"), is_narrow)


def _draw(layout: bpy.types.UILayout, properties: Any, names: tuple[str, ...], is_narrow: bool) -> None:  # noqa: ANN401
    for name in names:
        if is_narrow and properties.bl_rna.properties[name].type == "ENUM":
            # Blender leaves too little room for the name.
            row = layout.split(factor=0.4)
            row.label(text=properties.bl_rna.properties[name].name)
            row.prop(properties, name, text="")
        else:
            layout.prop(properties, name)
