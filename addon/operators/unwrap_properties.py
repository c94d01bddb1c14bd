# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of operators: the margin of those that pack; the settings of Spectral Unwrap, also for the preferences."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import names
from ..core.extenders.pairs import STRENGTH_LIMIT
from ..core.solve.options import Options
from ..core.words import texts
from ..edit_mesh import texture_size


class PixelProperties:
    """A margin in pixels, and the side of the texture that it counts in; not kept, because the scene has them."""

    margin: FloatProperty(**texture_size.MARGIN, options={"SKIP_SAVE"})
    texture_size: IntProperty(
        **texts.TEXTURE_OF_CALL_PROPERTY, default=0, min=0, max=65536, soft_max=8192, options={"SKIP_SAVE"}
    )

    def pixels(self, context: bpy.types.Context) -> tuple[float, float]:
        """Return the margin, that of the scene unless one is given, and the side of the texture."""
        if not self.properties.is_property_set("margin"):
            self.margin = getattr(context.scene, names.MARGIN_PROPERTY)
        return self.margin, self.texture_size or texture_size.side(context)


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
    automatic_holes: BoolProperty(**texts.AUTOMATIC_HOLES_PROPERTY, default=Options().automatic_holes)
    area_blend: FloatProperty(**texts.AREA_BLEND_PROPERTY, default=0.0, min=0.0, max=1.0, subtype="FACTOR")
    no_flip: BoolProperty(**texts.NO_FLIP_PROPERTY)
    straighten: BoolProperty(**texts.STRAIGHTEN_PROPERTY)
    polish: EnumProperty(**texts.POLISH_PROPERTY, items=texts.POLISH_ITEMS, default=Options().polish.upper())
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
