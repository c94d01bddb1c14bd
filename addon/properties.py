# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that the add-on gives to meshes, scenes and the window manager.

Their values belong to the file: they stay when the add-on is disabled.

Blender keeps the callbacks, and with them everything that this file names. So it must not name `bpy` itself, which bpy
4.2 and 4.5 would then free too late at exit, and crash or hang.
"""

from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
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
from .edit_mesh import texture_size
from .edit_mesh.extenders import AMOUNT
from .live import following
from .overlay import drawn_meshes, map_overlay
from .unwrapping import island_list


def _on_change(shape: PropertyGroup, context: Context) -> None:
    following.on_shape_change(shape.id_data)
    editors.redraw(context)


def _on_toggle(scene: Scene, _context: Context) -> None:
    following.toggled(scene)


def _set_amount(extender: PropertyGroup, amount: float) -> None:
    extender.strength = strength_of(amount, extender.half)


class SpectralShape(PropertyGroup):
    """One stored shape of a mesh; constraints have neither a name of their own nor a strength."""

    layer: StringProperty(
        name="Layer", description="Attribute of the vertices or edges that marks them", options={"HIDDEN"}
    )
    kind: StringProperty(**texts.SHAPE_PROPERTY, get=storage.stored("kind")["get"])
    name: StringProperty(
        name="Name",
        description="Name in the list",
        get=storage.stored("label")["get"],
        set=storage.stored("name")["set"],
        update=_on_change,
    )
    strength: FloatProperty(
        name="Strength",
        description="Above 0 pushes apart, below 0 pulls together; 1 is moderate",
        **{"min": -STRENGTH_LIMIT, "max": STRENGTH_LIMIT, "soft_min": -10.0, "soft_max": 10.0},
        **storage.stored("strength"),
        update=_on_change,
    )
    use: BoolProperty(name="Use", description="Use it in the next unwrap", **storage.stored("use"), update=_on_change)
    half: FloatProperty(
        name="Half",
        description="Strength at 50 %, which has half of the full effect; measured when the pair is added",
        get=storage.stored("half")["get"],
    )
    amount: FloatProperty(**AMOUNT, get=lambda each: amount_of(each.strength, each.half), set=_set_amount)


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

    show: BoolProperty(
        name="Show UV Map",
        description="Color the faces by the quality of the active UV map, in the 3D viewport and the UV editor",
        update=_on_show,
    )
    kind: EnumProperty(name="Show", description="What the colors show", items=texts.LOOK_ITEMS, update=_on_kind)
    use_range: BoolProperty(**texts.USE_RANGE_PROPERTY, update=_on_own_range)
    range_low: FloatProperty(
        name="Low",
        description=(
            "Value at the lower end of the colors; for angles the percentage they are off, for sizes "
            "a factor, 1 for the median"
        ),
        default=0.0,
        update=_on_map_change,
    )
    range_high: FloatProperty(
        name="High",
        description=(
            "Value at the upper end of the colors; for angles the percentage they are off, for sizes "
            "a factor, 1 for the median"
        ),
        default=50.0,
        update=_on_map_change,
    )
    opacity: FloatProperty(
        name="Opacity",
        description="Opacity of the colors",
        default=0.7,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
        update=_on_map_change,
    )
    checks: IntProperty(
        name="Squares",
        description="Checker squares along one side of a UV tile",
        default=16,
        min=1,
        max=4096,
        update=_on_map_change,
    )
    legend: BoolProperty(
        name="Legend",
        description="Show what the colors mean, and the numbers of the map",
        default=True,
        update=_on_map_change,
    )


class SpectralIsland(PropertyGroup):
    """A row of the list of islands; its name is its text."""

    is_bad: BoolProperty(options={"HIDDEN"})


def _on_island(window_manager: WindowManager, context: Context) -> None:
    island_list.select(context, getattr(window_manager, names.ACTIVE_ISLAND_PROPERTY))


def register() -> None:
    """Add the properties."""
    register_class(SpectralIsland)
    setattr(
        WindowManager,
        names.ISLANDS_PROPERTY,
        CollectionProperty(type=SpectralIsland, name="Islands", description="Islands of the last result, worst first"),
    )
    active_island = IntProperty(
        name="Island", description="Click an island to select its faces", default=-1, min=-1, update=_on_island
    )
    setattr(WindowManager, names.ACTIVE_ISLAND_PROPERTY, active_island)
    register_class(SpectralMapOverlay)
    overlay = PointerProperty(type=SpectralMapOverlay, name=texts.MAP_OVERLAY_LABEL)
    setattr(WindowManager, names.MAP_OVERLAY_PROPERTY, overlay)
    register_class(SpectralShape)
    setattr(Mesh, names.SHAPES_PROPERTY, CollectionProperty(type=SpectralShape, name="Shapes"))
    setattr(
        Mesh,
        names.ACTIVE_SHAPE_PROPERTY,
        IntProperty(name="Active Shape", description="The one chosen in the panel", min=0),
    )
    pixels = {"max": 65536, "soft_max": 8192, "subtype": "PIXEL", "update": _on_map_change}
    of_material = IntProperty(
        name="Texture of Material",
        description=(
            "Pixels along one side of this material's texture, for the texel density; 0 takes the size of its image"
        ),
        default=0,
        min=0,
        **pixels,
    )
    setattr(Material, names.TEXTURE_SIZE_PROPERTY, of_material)
    of_scene = IntProperty(
        name="Texture Size",
        description=(
            "Pixels along one side of the texture, for margins and texel densities; a material's "
            "image, or the size entered for it, goes before"
        ),
        default=choices.TEXTURE_SIZE,
        min=1,
        **pixels,
    )
    setattr(Scene, names.TEXTURE_SIZE_PROPERTY, of_scene)
    margin = FloatProperty(**texture_size.MARGIN, subtype="PIXEL", update=_on_map_change)
    setattr(Scene, names.MARGIN_PROPERTY, margin)
    live = BoolProperty(
        name=texts.LIVE_UNWRAP_LABEL,
        description=(
            "Let islands follow pins, Push/Pull and moved vertices, and unwrap again when seams or shapes change"
        ),
        update=_on_toggle,
    )
    setattr(Scene, names.LIVE_UNWRAP_PROPERTY, live)


def unregister() -> None:
    """Remove the properties; their values stay in the file."""
    delattr(Scene, names.LIVE_UNWRAP_PROPERTY)
    delattr(Scene, names.MARGIN_PROPERTY)
    for owner in (Scene, Material):
        delattr(owner, names.TEXTURE_SIZE_PROPERTY)
    for name in (names.ACTIVE_SHAPE_PROPERTY, names.SHAPES_PROPERTY):
        delattr(Mesh, name)
    unregister_class(SpectralShape)
    for name in (names.ACTIVE_ISLAND_PROPERTY, names.ISLANDS_PROPERTY):
        delattr(WindowManager, name)
    unregister_class(SpectralIsland)
    delattr(WindowManager, names.MAP_OVERLAY_PROPERTY)
    unregister_class(SpectralMapOverlay)
