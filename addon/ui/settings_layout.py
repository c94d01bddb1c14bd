# SPDX-License-Identifier: GPL-3.0-or-later
"""How settings are laid out, in Adjust Last Operation and in the sidebar."""

from collections.abc import Iterable
from typing import Any

import bpy


def split(layout: bpy.types.UILayout, is_narrow: bool = False) -> None:
    """Put names beside the fields; if the layout `is_narrow`, inside them."""
    layout.use_property_split = not is_narrow
    layout.use_property_decorate = False


def draw(layout: bpy.types.UILayout, properties: Any, names: Iterable[str]) -> None:  # noqa: ANN401 - an operator
    """Draw these properties of an operator one below the other."""
    split(layout)
    for name in names:
        layout.prop(properties, name)
