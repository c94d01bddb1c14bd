# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that the add-on gives to meshes, scenes and the window manager.

Their values belong to the file: they stay when the add-on is disabled.

Blender keeps the callbacks, and with them everything that this file names. So it must not name `bpy` itself, which bpy
4.2 and 4.5 would then free too late at exit, and crash or hang.
"""

from bpy.props import (
    CollectionProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, Material, Mesh, PropertyGroup, Scene, WindowManager
from bpy.utils import register_class, unregister_class

from . import editors, names
from .core import choices
from .core.extenders.pairs import STRENGTH_LIMIT, amount_of, strength_of
from .core.words import texts
from .edit_mesh import shapes as storage
from .live import following
from .operators.property_kinds import choice, number, numbers, pixel_margin, push_amount, rotation, share, switch
from .overlay import drawn_meshes, map_overlay
from .unwrapping import island_list


def _on_change(shape: PropertyGroup, context: Context) -> None:
    following.on_shape_change(shape.id_data)
    editors.redraw(context)


def _on_toggle(scene: Scene, _context: Context) -> None:
    following.toggled(scene)


def _amount(extender: PropertyGroup) -> float:
    return amount_of(extender.strength, storage.of_layer(extender.layer).half)


def _set_amount(extender: PropertyGroup, amount: float) -> None:
    extender.strength = strength_of(amount, storage.of_layer(extender.layer).half)


class SpectralShape(PropertyGroup):
    """One stored shape of a mesh; constraints have neither a name of their own nor a strength."""

    layer: StringProperty(
        name="Layer", description="Attribute of the vertices or edges that marks them", options={"HIDDEN"}
    )
    kind: StringProperty(name="Shape", description="What the selection becomes", get=storage.stored("kind")["get"])
    name: StringProperty(
        name="Name",
        description="Name in the list",
        get=storage.stored("label")["get"],
        set=storage.stored("name")["set"],
        update=_on_change,
    )
    strength: number(
        "Strength",
        "Above 0 pushes apart, below 0 pulls together; 1 is moderate",
        0.0,
        (-STRENGTH_LIMIT, -10.0, 10.0, STRENGTH_LIMIT),
        **storage.stored("strength"),
        update=_on_change,
    )
    use: switch("Use", "Use it in the next unwrap", **storage.stored("use"), update=_on_change)
    amount: push_amount(get=_amount, set=_set_amount)


def _on_map_change(_overlay: PropertyGroup, context: Context) -> None:
    editors.redraw(context)


def _on_kind(overlay: PropertyGroup, context: Context) -> None:
    # Another kind has another unit.
    overlay.use_range = False
    editors.redraw(context)


def _on_own_range(overlay: PropertyGroup, context: Context) -> None:
    if overlay.use_range:
        map_overlay.set_range(map_overlay.automatic(context))
    editors.redraw(context)


def _on_show(overlay: PropertyGroup, context: Context) -> None:
    if overlay.show:
        drawn_meshes.keep()
    editors.redraw(context)


class SpectralMapOverlay(PropertyGroup):
    """The settings of the UV map overlay; part of the window manager, because showing is not undoable."""

    show: switch(
        "Show UV Map",
        "Color the faces by the quality of the active UV map, in the 3D viewport and the UV editor",
        update=_on_show,
    )
    kind: choice("Show", "What the colors show", texts.LOOK_ITEMS, update=_on_kind)
    use_range: switch(
        "Custom Range",
        "Set the values at both ends of the colors, at first those that fit the shown maps; otherwise they are the "
        "same on all maps: angles off by 0 to 50 %, sizes of half to double the median",
        update=_on_own_range,
    )
    range: numbers(
        "Range",
        "Values at both ends of the colors; for angles the percentage they are off, for sizes a "
        "factor, 1 for the median",
        (0.0, 50.0),
        update=_on_map_change,
    )
    opacity: share("Opacity", "Opacity of the colors", 0.7, update=_on_map_change)
    checks: number("Squares", "Checker squares along one side of a UV tile", 16, (1, 4096), update=_on_map_change)
    legend: switch("Legend", "Show what the colors mean, and the numbers of the map", True, update=_on_map_change)


class SpectralIsland(PropertyGroup):
    """A row of the list of islands; its name is its text."""


def _on_island(window_manager: WindowManager, context: Context) -> None:
    island_list.select(context, getattr(window_manager, names.ACTIVE_ISLAND_PROPERTY))


def _properties() -> list[tuple[type, str, object]]:
    """Return whose properties there are, their names, and themselves."""
    shapes = CollectionProperty(type=SpectralShape, name="Shapes")
    islands = CollectionProperty(
        type=SpectralIsland, name="Islands", description="Islands of the last result, worst first"
    )
    size = {"subtype": "PIXEL", "update": _on_map_change}
    of_material = number(
        "Texture of Material",
        "Pixels along one side of this material's texture, for the texel density; 0 takes the size of its image",
        0,
        (0, 8192, 65536),
        **size,
    )
    of_scene = number(
        "Texture Size",
        "Pixels along one side of the texture, for margins and texel densities; a material's image, or the size "
        "entered for it, goes before",
        choices.TEXTURE_SIZE,
        (1, 8192, 65536),
        **size,
    )
    live = switch(
        texts.LIVE_UNWRAP_LABEL,
        "Let islands follow pins, Push/Pull and moved vertices, and unwrap again when seams or shapes change",
        update=_on_toggle,
    )
    active_shape = number("Active Shape", "The one chosen in the panel", 0, (0, None))
    active_island = number("Island", "Click an island to select its faces", -1, (-1, None), update=_on_island)
    overlay = PointerProperty(type=SpectralMapOverlay, name=texts.MAP_OVERLAY_LABEL)
    return [
        (WindowManager, names.ISLANDS_PROPERTY, islands),
        (WindowManager, names.ACTIVE_ISLAND_PROPERTY, active_island),
        (WindowManager, names.MAP_OVERLAY_PROPERTY, overlay),
        (Mesh, names.SHAPES_PROPERTY, shapes),
        (Mesh, names.ACTIVE_SHAPE_PROPERTY, active_shape),
        (Material, names.TEXTURE_SIZE_PROPERTY, of_material),
        (Scene, names.TEXTURE_SIZE_PROPERTY, of_scene),
        (Scene, names.MARGIN_PROPERTY, pixel_margin(**size)),
        (Scene, names.ROTATION_PROPERTY, rotation()),
        (Scene, names.LIVE_UNWRAP_PROPERTY, live),
    ]


_CLASSES = (SpectralIsland, SpectralMapOverlay, SpectralShape)


def register() -> None:
    """Add the properties."""
    for each in _CLASSES:
        register_class(each)
    for owner, name, made in _properties():
        setattr(owner, name, made)


def unregister() -> None:
    """Remove the properties; their values stay in the file."""
    for owner, name, _ in reversed(_properties()):
        delattr(owner, name)
    for each in reversed(_CLASSES):
        unregister_class(each)
