# SPDX-License-Identifier: GPL-3.0-or-later
"""What fits into the sidebar, in the language and with the letters that it is drawn in."""

import math
from collections.abc import Iterable

import blf
import bpy

from .. import compatibility

# Pixels of a region, times the scale of the interface, beside a line with an icon: icon, tabs and margins.
_BESIDE_LINES = 80.0
# The same beside a row, and beside one that ends with a button of an icon alone.
_BESIDE_ROWS, _BESIDE_BUTTONS = 40.0, 60.0
# Around the text of a button, of one with an icon, and of a menu with its arrow.
_IN_BUTTON, _IN_ICON_BUTTON, _IN_MENU = 8.0, 26.0, 28.0


def _scale_of_letters(context: bpy.types.Context) -> float:
    """Let `blf` measure as the sidebar writes; return the scale of the interface."""
    scale = context.preferences.system.ui_scale
    # Blender may round the size of its letters up.
    blf.size(0, math.ceil(compatibility.label_points(context.preferences) * scale))
    return scale


def columns(context: bpy.types.Context, labels: Iterable[str], has_icons: bool = False) -> int:
    """Return how many buttons with these labels fit side by side: each with an icon, or all beside one of an icon."""
    scale = _scale_of_letters(context)
    shown = [bpy.app.translations.pgettext_iface(label, "Operator") for label in labels]
    beside, around = (_BESIDE_ROWS, _IN_ICON_BUTTON) if has_icons else (_BESIDE_BUTTONS, _IN_BUTTON)
    widest = max(blf.dimensions(0, text)[0] for text in shown) + around * scale
    # In background Blender's scale is 0.
    return max(1, int((context.region.width - beside * scale) // max(1.0, widest)))


def wrapped(context: bpy.types.Context, text: str) -> list[str]:
    """Return a text in lines that fit beside an icon in the region."""
    scale = _scale_of_letters(context)
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and blf.dimensions(0, longer)[0] <= context.region.width - _BESIDE_LINES * scale:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def has_room_for(context: bpy.types.Context, text: str, share: float) -> bool:
    """Return whether a menu that shows this text fits into a share of a row of the region."""
    if context.region is None:
        # In background.
        return True
    scale = _scale_of_letters(context)
    room = share * (context.region.width - _BESIDE_ROWS * scale) - _IN_MENU * scale
    return blf.dimensions(0, text)[0] <= room
