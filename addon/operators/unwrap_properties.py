# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Spectral Unwrap as properties of the operator and, for its defaults, of the preferences."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .. import names
from ..core.extenders.pairs import STRENGTH_LIMIT
from ..core.words import texts


class UnwrapProperties:
    """The settings of an unwrap."""

    method: EnumProperty(**texts.METHOD_PROPERTY, items=texts.METHOD_ITEMS)
    weights: EnumProperty(**texts.WEIGHTS_PROPERTY, items=texts.WEIGHTS_ITEMS)
    boundary: EnumProperty(**texts.BOUNDARY_PROPERTY, items=texts.BOUNDARY_ITEMS)
    hold_rest: BoolProperty(**texts.HOLD_REST_PROPERTY, default=True)
    keep_in_place: BoolProperty(**texts.KEEP_IN_PLACE_PROPERTY)
    turn_to_pack: BoolProperty(**texts.TURN_TO_PACK_PROPERTY)
    fill_holes: BoolProperty(**texts.FILL_HOLES_PROPERTY)
    hole_rigidity: FloatProperty(
        **texts.HOLE_RIGIDITY_PROPERTY, default=0.0, min=0.0, soft_max=10.0, max=STRENGTH_LIMIT
    )
    automatic_holes: BoolProperty(**texts.AUTOMATIC_HOLES_PROPERTY, default=True)
    area_blend: FloatProperty(**texts.AREA_BLEND_PROPERTY, default=0.0, min=0.0, max=1.0, subtype="FACTOR")
    fold_free: BoolProperty(**texts.FOLD_FREE_PROPERTY)
    straighten: BoolProperty(**texts.STRAIGHTEN_PROPERTY)
    polish: BoolProperty(**texts.POLISH_PROPERTY, default=True)
    stretch: FloatProperty(**texts.STRETCH_PROPERTY, default=1.0, min=0.01, soft_min=0.25, soft_max=4.0, max=100.0)
    use_subsurf_data: BoolProperty(**texts.USE_SUBSURF_DATA_PROPERTY)
    soft_pins: BoolProperty(**texts.SOFT_PINS_PROPERTY)
    soft_pin_strength: FloatProperty(
        **texts.SOFT_PIN_STRENGTH_PROPERTY,
        default=100.0,
        min=1e-6,
        soft_min=1.0,
        max=STRENGTH_LIMIT,
        soft_max=STRENGTH_LIMIT,
    )
    correct_aspect: BoolProperty(**texts.CORRECT_ASPECT_PROPERTY, default=True)
    show_advanced: BoolProperty(**texts.SHOW_ADVANCED_PROPERTY)


def take_as_last(chosen: UnwrapProperties) -> None:
    """Start the operator with these settings the next time an artist calls it; scripts pass theirs."""
    last = bpy.context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
    for name in UnwrapProperties.__annotations__:
        if getattr(last, name) != getattr(chosen, name):
            setattr(last, name, getattr(chosen, name))
