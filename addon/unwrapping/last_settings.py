# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the Unwrap operator, from its properties."""

from dataclasses import fields
from typing import Any

import bpy

from .. import names
from ..core.solve.options import Options, Settings
from ..edit_mesh import texture_size


def settings_of(properties: Any, margin: float) -> Settings:  # noqa: ANN401 - the operator, or Blender's record of it
    """Return the settings that the operator's properties stand for, with a margin as a fraction of the tile."""
    options = {field.name: getattr(properties, field.name) for field in fields(Options)}
    for name in ("method", "weights", "boundary", "polish"):
        options[name] = options[name].lower()
    options["soft_pins"] *= properties.method == "SPECTRAL"
    return Settings(
        Options(**options),
        keep_in_place=properties.keep_in_place,
        turn_to_pack=properties.turn_to_pack,
        margin=margin,
        correct_aspect=properties.correct_aspect,
        use_subsurf=properties.use_subsurf_data,
        hold_rest=properties.hold_rest,
        blend=tuple(properties.blend) if properties.keep_in_place else (1.0, 1.0),
    )


def settings_for(operator: bpy.types.Operator) -> Settings:
    """Return the settings with which an operator unwraps: the last ones in a window, the defaults for a script.

    What an artist chose in a window does not reach scripts, nor do the preferences, with which a window begins.
    """
    called = operator.options
    if called.is_invoke or called.is_repeat:
        return last_settings()
    return Settings(margin=texture_size.margin(bpy.context))


def last_settings() -> Settings:
    """Return the settings of the operator's last use, its defaults before the first; with the scene's margin."""
    properties = bpy.context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
    margin = texture_size.margin(bpy.context)
    return settings_of(properties, margin) if properties else Settings(margin=margin)
