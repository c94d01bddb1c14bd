# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: the colours of the overlay."""

from bpy.props import FloatVectorProperty
from bpy.types import AddonPreferences, Context
from bpy.utils import register_class, unregister_class

from . import names
from .core import color_ramp, texts
from .overlay import map_overlay


def _on_color(_preferences: AddonPreferences, context: Context) -> None:
    map_overlay.redraw(context)


def _color(words: dict[str, str], default: color_ramp.Color) -> object:
    return FloatVectorProperty(
        **words, subtype="COLOR_GAMMA", size=3, default=default, min=0.0, max=1.0, update=_on_color
    )


class SpectralPreferences(AddonPreferences):
    """Colours; Blender keeps them with the user's preferences."""

    bl_idname = names.PACKAGE

    angle_low: _color(texts.ANGLE_LOW_PROPERTY, color_ramp.GOOD_TO_BAD[0])
    angle_middle: _color(texts.ANGLE_MIDDLE_PROPERTY, color_ramp.GOOD_TO_BAD[1])
    angle_high: _color(texts.ANGLE_HIGH_PROPERTY, color_ramp.GOOD_TO_BAD[2])
    size_low: _color(texts.SIZE_LOW_PROPERTY, color_ramp.SMALL_TO_LARGE[0])
    size_middle: _color(texts.SIZE_MIDDLE_PROPERTY, color_ramp.SMALL_TO_LARGE[1])
    size_high: _color(texts.SIZE_HIGH_PROPERTY, color_ramp.SMALL_TO_LARGE[2])

    def draw(self, _context: Context) -> None:
        """Draw both scales of colours."""
        layout = self.layout
        layout.label(text=texts.OVERLAY_COLORS_LABEL)
        layout.use_property_split = True
        layout.use_property_decorate = False
        for scale in ("angle", "size"):
            column = layout.column(align=True)
            for place in ("low", "middle", "high"):
                column.prop(self, f"{scale}_{place}")


def register() -> None:
    """Add the preferences."""
    register_class(SpectralPreferences)


def unregister() -> None:
    """Remove the preferences; what the user chose stays in Blender's."""
    unregister_class(SpectralPreferences)
