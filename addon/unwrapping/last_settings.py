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
    is_soft = properties.soft_pins and properties.method == "SPECTRAL"
    options["soft_pins"] = properties.soft_pin_strength if is_soft else 0.0
    return Settings(
        Options(**options),
        keep_in_place=properties.keep_in_place,
        turn_to_pack=properties.turn_to_pack,
        margin=margin,
        correct_aspect=properties.correct_aspect,
        use_subsurf=properties.use_subsurf_data,
        hold_rest=properties.hold_rest,
        amount=_amount(properties) if properties.keep_in_place else (1.0, 1.0),
    )


def _amount(properties: Any) -> tuple[float, float]:  # noqa: ANN401 - as above
    """Return how far U and V go from the map as it was to the solved one."""
    u, v = (0.0 if properties.coordinates == other else properties.blend for other in ("V", "U"))
    return u, v


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
