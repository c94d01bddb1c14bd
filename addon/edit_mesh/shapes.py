# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored shapes of a mesh: constraints, each an integer layer of edges, and Push/Pull, each one of vertices.

The layer's name holds all but the marked elements. Blender saves, copies and joins layers with the mesh, edits of the
topology carry them along, and undo in edit mode restores them. That undo restores no properties: so the list that the
panel and scripts see, a collection property of the mesh, holds only the names of the layers, and is brought in line
with these. The properties of its entries are read from the names, and a change renames the layer.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from .. import editors, names
from ..core.choices import SHAPE_EXTENDER as EXTENDER
from ..core.constraints.equations import FREE
from ..core.errors import ReadableError
from ..core.extenders.pairs import HALF, STRENGTH_LIMIT
from ..core.words import texts
from ..core.words.translation import translate
from ..session import edit_meshes
from .attributes import integer_layers


@dataclass(frozen=True)
class Shape:
    """What the name of a layer says.

    Attributes:
        kind: an identifier of `texts.CONSTRAINT_KINDS`, or `EXTENDER`.
        use: whether the next unwrap obeys it.
        number: tells constraints of one kind apart.
        angle: in degrees, of slanted edges.
        spacing: of a grid, as in `core.constraints.equations`.
        name: of a Push/Pull.
        strength: of a Push/Pull; the amount of 50 % stands for the strength `half`.
        half: of a Push/Pull.
    """

    kind: str = EXTENDER
    use: bool = True
    number: int = 1
    angle: float = 0.0
    spacing: int = FREE
    name: str = ""
    strength: float = 0.0
    half: float = HALF

    @property
    def label(self) -> str:
        """Its name in the list."""
        return (
            self.name
            if self.kind == EXTENDER
            else translate(texts.CONSTRAINT_KINDS[self.kind]).format(number=self.number)
        )


# How names of layers begin, and where the marked elements are: of Push/Pull, and of constraints.
_LAYERS = ((names.EXTENDER_LAYER_PREFIX, "POINT"), (names.CONSTRAINT_LAYER_PREFIX, "EDGE"))


def layer_name(shape: Shape) -> str:
    """Return the name of the layer of a shape; Blender cuts a long one.

    A strength has all digits of single precision, within its limit; one that is not a number counts as 0.
    """
    if shape.kind == EXTENDER:
        strength = float(np.nan_to_num(np.float32(shape.strength)).clip(-STRENGTH_LIMIT, STRENGTH_LIMIT))
        fields = (f"{shape.use:d}", f"{strength:.9g}@{shape.half:.3g}", shape.name)
    else:
        fields = (shape.kind, f"{shape.number}", f"{shape.use:d}", f"{shape.angle:.9g}", f"{shape.spacing}")
    return _LAYERS[shape.kind != EXTENDER][0] + ":".join(fields)


def of_layer(layer: str) -> Shape | None:
    """Return the shape whose layer has this name; None for other layers."""
    prefix, _, fields = layer.partition(":")
    try:
        if f"{prefix}:" == names.EXTENDER_LAYER_PREFIX:
            use, force, name = fields.split(":", 2)
            strength, half = map(float, force.split("@"))
            is_valid = abs(strength) <= STRENGTH_LIMIT and 0.0 < half < np.inf
            return Shape(use=use == "1", name=name, strength=strength, half=half) if is_valid else None
        kind, number, use, angle, spacing = fields.split(":")
        is_valid = f"{prefix}:" == names.CONSTRAINT_LAYER_PREFIX and kind in texts.CONSTRAINT_KINDS
        # Blender numbers equal names.
        return Shape(kind, use == "1", int(number), float(angle), int(spacing.split(".")[0])) if is_valid else None
    except ValueError:
        return None


def of(mesh: bpy.types.Mesh) -> list[tuple[str, Shape]]:
    """Return the shapes of a mesh with the names of their layers."""
    layers = [layer for each in _LAYERS for layer in integer_layers(mesh, *each)]
    return [(layer, shape) for layer in layers if (shape := of_layer(layer)) is not None]


def listed(mesh: bpy.types.Mesh) -> Sequence[bpy.types.PropertyGroup]:
    """Return the list that the panel and scripts see: entries with the fields of `Shape` and the `layer`."""
    return getattr(mesh, names.SHAPES_PROPERTY)


def stored(field: str) -> dict[str, Callable]:
    """Return the arguments of a property of the list's entries that is a field of `Shape`."""

    def read(entry: bpy.types.PropertyGroup) -> Any:  # noqa: ANN401 - the type of the field
        return getattr(of_layer(entry.layer), field)

    def write(entry: bpy.types.PropertyGroup, value: Any) -> None:  # noqa: ANN401 - the type of the field
        mesh, name = entry.id_data, layer_name(replace(of_layer(entry.layer), **{field: value}))
        if entry.layer in mesh.attributes and name != entry.layer:
            layer = mesh.attributes[entry.layer]
            layer.name = name
            # Blender numbers equal names.
            entry.layer = layer.name
            mesh.update_tag()

    return {"get": read, "set": write}


def sync(mesh: bpy.types.Mesh, index: int | None = None) -> None:
    """Bring the list of a mesh in line with its layers; if it has changed, the one of this `index` becomes active."""
    if mesh.library or mesh.override_library:
        return
    layers, entries = [layer for layer, _ in of(mesh)], listed(mesh)
    if layers == [entry.layer for entry in entries]:
        return
    entries.clear()
    for layer in layers:
        entries.add().layer = layer
    index = getattr(mesh, names.ACTIVE_SHAPE_PROPERTY) if index is None else index
    setattr(mesh, names.ACTIVE_SHAPE_PROPERTY, max(min(index, len(layers) - 1), 0))
    if (known := edit_meshes.kept(mesh)) is not None:
        known.extenders = None
    # Blender redraws when a property changes, but not when one is removed.
    editors.redraw(bpy.context)


def follow(meshes: Iterable[bpy.types.Mesh] | None = None) -> None:
    """Bring the lists of `meshes` in line, by default of all.

    Only meshes in edit mode may get shapes without a list, by undo.
    """
    for mesh in bpy.data.meshes if meshes is None else meshes:
        if mesh.is_editmode or listed(mesh):
            sync(mesh)


def active(mesh: bpy.types.Mesh) -> int:
    """Return the index of the active entry of the list, or raise a `ReadableError`."""
    sync(mesh)
    return checked(mesh, getattr(mesh, names.ACTIVE_SHAPE_PROPERTY))


def checked(mesh: bpy.types.Mesh, index: int) -> int:
    """Return the index of an entry of the list, or raise a `ReadableError`."""
    if not 0 <= index < len(listed(mesh)):
        raise ReadableError(translate("The list has no such entry; choose another"))
    return index


def new_layer(mesh: bpy.types.Mesh, shape: Shape) -> str:
    """Add the layer of a shape, which marks nothing yet; return its name."""
    return mesh.attributes.new(layer_name(shape), "INT", _LAYERS[shape.kind != EXTENDER][1]).name


def activate(mesh: bpy.types.Mesh, layer: str) -> None:
    """Make the shape of this layer the active one."""
    sync(mesh)
    setattr(mesh, names.ACTIVE_SHAPE_PROPERTY, [entry.layer for entry in listed(mesh)].index(layer))


def remove(mesh: bpy.types.Mesh, index: int) -> None:
    """Remove the shape of this index; the one before becomes active."""
    mesh.attributes.remove(mesh.attributes[listed(mesh)[index].layer])
    sync(mesh, index - 1)
