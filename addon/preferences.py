# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: defaults of the operator, limits, colors of the overlay."""

import bpy
from bpy.props import FloatVectorProperty, PointerProperty
from bpy.types import AddonPreferences, Context, PropertyGroup, UILayout
from bpy.utils import register_class, unregister_class

from . import editors, names, user_preferences
from .core import native
from .core.drawing import color_ramp
from .core.words import texts
from .operators.property_kinds import number
from .operators.unwrap_properties import UnwrapProperties, take_as_last
from .overlay import map_overlay
from .ui import settings


class SpectralUnwrapDefaults(UnwrapProperties, PropertyGroup):
    """The default settings of Spectral Unwrap in a new session."""


def _on_color(_preferences: AddonPreferences, context: Context) -> None:
    editors.redraw(context)


def _on_limit(_preferences: AddonPreferences, context: Context) -> None:
    map_overlay.edited()
    editors.redraw(context)


def _on_threads(preferences: AddonPreferences, _context: Context) -> None:
    native.limit_threads(preferences.threads)


def _color(default: color_ramp.Color, **words: str) -> object:
    return FloatVectorProperty(
        **words, subtype="COLOR_GAMMA", size=3, default=default, min=0.0, max=1.0, update=_on_color
    )


class SpectralPreferences(AddonPreferences):
    """The add-on's part of Blender's preferences."""

    bl_idname = names.PACKAGE

    defaults: PointerProperty(type=SpectralUnwrapDefaults)
    threads: number(
        "Threads", "Processor cores to use; 0 for all. The map does not depend on it", 0, (0, 1024), update=_on_threads
    )
    overlay_max_faces: number(
        "Overlay: Faces",
        "Meshes with more faces are not colored, because the overlay follows every edit",
        user_preferences.MAX_FACES,
        (0, None),
        update=_on_limit,
    )
    live_max_faces: number(
        "Live Unwrap: Faces",
        "Live Spectral Unwrap skips meshes with more faces, because it cannot be canceled",
        user_preferences.LIVE_MAX_FACES,
        (0, None),
    )
    angle_low: _color(color_ramp.GOOD_TO_BAD[0], name="Angles Kept", description="Color of faces whose angles are kept")
    angle_middle: _color(color_ramp.GOOD_TO_BAD[1], name="Between", description="Color of the middle of the range")
    angle_high: _color(
        color_ramp.GOOD_TO_BAD[2], name="Angles Distorted", description="Color of the end of the range and beyond"
    )
    size_low: _color(
        color_ramp.SMALL_TO_LARGE[0], name="Small", description="Color of faces smaller in the map than most"
    )
    size_middle: _color(color_ramp.SMALL_TO_LARGE[1], name="Even", description="Color of faces of median size")
    size_high: _color(
        color_ramp.SMALL_TO_LARGE[2], name="Large", description="Color of faces larger in the map than most"
    )

    def draw(self, _context: Context) -> None:
        """Draw the defaults, the limits, the solver's name, and both color scales."""
        box = _part(self.layout, text="Spectral Unwrap Defaults")
        settings.draw_unwrap(box, self.defaults)
        settings.draw_fold(box, self.defaults)
        box = _part(self.layout, text="Limits")
        for name in ("threads", "overlay_max_faces", "live_max_faces"):
            box.prop(self, name)
        _part(self.layout, text="Solver").label(text=_solver(), translate=False)
        box = _part(self.layout, text="Colors of the UV Map Overlay")
        for scale in ("angle", "size"):
            column = box.column(align=True)
            for place in ("low", "middle", "high"):
                column.prop(self, f"{scale}_{place}")


def _solver() -> str:
    try:
        build = native.spectral_conformal().build_info()
    except native.NativeModuleError as error:
        return str(error)
    return texts.solver(build["factorization"], build["kernel"])


def _part(layout: UILayout, text: str) -> UILayout:
    box = layout.box()
    box.label(text=text)
    box.use_property_split = True
    box.use_property_decorate = False
    return box


def register() -> None:
    """Register the preferences, and apply them."""
    register_class(SpectralUnwrapDefaults)
    register_class(SpectralPreferences)
    addon = bpy.context.preferences.addons.get(names.PACKAGE)
    if addon is None or addon.preferences is None:
        return
    take_as_last(addon.preferences.defaults)
    if addon.preferences.threads:
        native.limit_threads(addon.preferences.threads)


def unregister() -> None:
    """Unregister the preferences; Blender keeps their values."""
    if user_preferences.read("threads", 0):
        native.limit_threads(0)
    unregister_class(SpectralPreferences)
    unregister_class(SpectralUnwrapDefaults)
