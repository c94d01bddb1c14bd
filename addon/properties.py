# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that the add-on gives to meshes and scenes: extenders, and whether live unwrapping is on.

Their values belong to the file: they stay in it when the add-on is disabled, and count again when it is enabled.

Blender keeps the callbacks, and with them all that this file names. So it must not name `bpy` itself, which bpy 4.2 and
4.5 would then free too late when Python ends, and crash or hang.
"""

from bpy.props import BoolProperty, CollectionProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Mesh, PropertyGroup, Scene
from bpy.utils import register_class, unregister_class

from . import names
from .core import texts
from .extenders import storage
from .extenders.strength import STRENGTH
from .live import following


def _on_change(extender: PropertyGroup, _context: Context) -> None:
    if storage.changed(extender):
        following.on_extender_change(extender.id_data)


def _on_rename(extender: PropertyGroup, _context: Context) -> None:
    storage.renamed(extender)


def _on_toggle(_scene: Scene, _context: Context) -> None:
    following.toggled()


class SpectralExtender(PropertyGroup):
    """One extender of a mesh."""

    name: StringProperty(**texts.EXTENDER_NAME_PROPERTY, update=_on_rename)
    strength: FloatProperty(**STRENGTH, update=_on_change)
    use: BoolProperty(**texts.EXTENDER_USE_PROPERTY, default=True, update=_on_change)
    first_id: IntProperty(**texts.FIRST_VERTEX_PROPERTY, options={"HIDDEN"})
    second_id: IntProperty(**texts.SECOND_VERTEX_PROPERTY, options={"HIDDEN"})


def register() -> None:
    """Add the properties."""
    register_class(SpectralExtender)
    setattr(Mesh, names.EXTENDERS_PROPERTY, CollectionProperty(type=SpectralExtender, name=texts.EXTENDERS_LABEL))
    active = IntProperty(**texts.ACTIVE_EXTENDER_PROPERTY, min=0)
    setattr(Mesh, names.ACTIVE_EXTENDER_PROPERTY, active)
    setattr(Mesh, names.EXTENDER_LAYER_PROPERTY, StringProperty(options={"HIDDEN"}))
    live = BoolProperty(name=texts.LIVE_UNWRAP_LABEL, description=texts.LIVE_UNWRAP_DESCRIPTION, update=_on_toggle)
    setattr(Scene, names.LIVE_UNWRAP_PROPERTY, live)


def unregister() -> None:
    """Remove the properties; their values stay in the file."""
    storage.forget()
    delattr(Scene, names.LIVE_UNWRAP_PROPERTY)
    for name in (names.EXTENDER_LAYER_PROPERTY, names.ACTIVE_EXTENDER_PROPERTY, names.EXTENDERS_PROPERTY):
        delattr(Mesh, name)
    unregister_class(SpectralExtender)
