# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the Unwrap operator, from its properties."""

from dataclasses import fields
from typing import Any

import bpy

from .. import names
from ..core.choices import KEEP
from ..core.solve.options import Margin, Options, Settings


def settings_of(properties: Any) -> Settings:  # noqa: ANN401 - the operator, or Blender's record of its properties
    """Return the settings that the operator's properties stand for."""
    options = {field.name: getattr(properties, field.name) for field in fields(Options)}
    for name in ("method", "weights", "boundary"):
        options[name] = options[name].lower()
    is_soft = properties.soft_pins and properties.method == "SPECTRAL"
    options["soft_pins"] = properties.soft_pin_strength if is_soft else 0.0
    return Settings(
        Options(**options),
        keep_in_place=properties.placement == KEEP,
        turn_to_pack=properties.turn_to_pack,
        margin=Margin(properties.margin, properties.margin_method),
        correct_aspect=properties.correct_aspect,
        use_subsurf=properties.use_subsurf_data,
        in_place=properties.in_place,
    )


def last_settings() -> Settings:
    """Return the settings of the operator's last use; its defaults before the first."""
    properties = bpy.context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
    return settings_of(properties) if properties else Settings()
