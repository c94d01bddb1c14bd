# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the Unwrap operator, from its properties."""

from dataclasses import fields
from typing import Any

import bpy

from .. import names
from ..core.solve.options import Options, Settings
from ..edit_mesh import texture_size


def settings_of(properties: Any, margin: float, rotation: str) -> Settings:  # noqa: ANN401 - the operator, or Blender's record
    """Return the settings that the operator's properties stand for; `margin` and `rotation` as in `Settings`."""
    options = {field.name: getattr(properties, field.name) for field in fields(Options)}
    for name in ("method", "weights", "boundary", "polish"):
        options[name] = options[name].lower()
    options["soft_pins"] *= properties.method == "SPECTRAL"
    if properties.automatic_hole_rigidity and not options["hole_rigidity"]:
        options["hole_rigidity"] = "automatic"
    return Settings(
        Options(**options),
        keep_in_place=properties.keep_in_place,
        margin=margin,
        rotation=rotation,
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
    return Settings(**_of_scene())


def last_settings() -> Settings:
    """Return the settings of the operator's last use, its defaults before the first; with what the scene says."""
    properties = bpy.context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
    return settings_of(properties, **_of_scene()) if properties else Settings(**_of_scene())


def _of_scene() -> dict[str, Any]:
    return {"margin": texture_size.margin(bpy.context), "rotation": texture_size.rotation(bpy.context)}
