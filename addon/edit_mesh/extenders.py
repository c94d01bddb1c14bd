# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh, each an integer layer of its vertices.

The layer's name holds all but the vertices, which its values mark. Blender saves, copies and joins layers with the
mesh, edits of the topology carry them along, and undo in edit mode restores them. That undo restores no properties: so
the list that the panel and scripts see, a collection property of the mesh, holds only the names of the layers, and is
brought in line with these. The properties of its entries are read from the names, and a change renames the layer.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import bmesh
import bpy
import numpy as np
from bmesh.types import BMVert

from .. import editors, names
from ..core.errors import ReadableError
from ..core.extenders.pairs import HALF, STRENGTH_LIMIT, free_name, half_strengths, strength_of
from ..core.mesh.polygon_mesh import Force, PolygonMesh
from ..core.words import texts
from ..core.words.translation import translate
from ..session import edit_meshes
from .attributes import integer_layers

# Arguments of the property of a slider.
AMOUNT = {**texts.AMOUNT_OF_PUSH_PROPERTY, "min": -100.0, "max": 100.0, "subtype": "PERCENTAGE", "precision": 1}
# Values at both vertices of an extender, 0 at others. Blender interpolates integers in single precision, which holds
# them exactly; a value between different vertices is never one of them.
_MARKS = (1 << 23, -(1 << 23))


class Extender(NamedTuple):
    """What the name of a layer says; the amount of 50 % stands for the strength `half`."""

    name: str
    strength: float
    use: bool = True
    half: float = HALF


def of(mesh: bpy.types.Mesh) -> Sequence[bpy.types.PropertyGroup]:
    """Return the list of extenders of a mesh, each with the fields of `Extender` and the name of its `layer`."""
    return getattr(mesh, names.EXTENDERS_PROPERTY)


def layer_name(extender: Extender) -> str:
    """Return the name of the layer of an extender, with all digits of a strength in single precision.

    Blender cuts a long name. A strength beyond its limit is limited; one that is not a number counts as 0.
    """
    strength = np.nan_to_num(np.float32(extender.strength)).clip(-STRENGTH_LIMIT, STRENGTH_LIMIT)
    number = f"{float(strength):.9g}@{extender.half:.3g}"
    return f"{names.EXTENDER_LAYER_PREFIX}{extender.use:d}:{number}:{extender.name}"


def of_layer(layer: str) -> Extender | None:
    """Return the extender whose layer's name starts as all do; None for other layers."""
    try:
        use, number, name = layer[len(names.EXTENDER_LAYER_PREFIX) :].split(":", 2)
        strength, half = map(float, number.split("@"))
    except ValueError:
        return None
    is_valid = abs(strength) <= STRENGTH_LIMIT and 0.0 < half < np.inf
    return Extender(name, strength, use == "1", half) if is_valid else None


def stored(field: str) -> dict[str, Callable]:
    """Return the arguments of a property of the list's entries that is a field of `Extender`."""

    def read(entry: bpy.types.PropertyGroup) -> Any:  # noqa: ANN401 - the type of the field
        return getattr(of_layer(entry.layer), field)

    def write(entry: bpy.types.PropertyGroup, value: Any) -> None:  # noqa: ANN401 - the type of the field
        name = layer_name(of_layer(entry.layer)._replace(**{field: value}))
        if entry.layer in entry.id_data.attributes and name != entry.layer:
            layer = entry.id_data.attributes[entry.layer]
            layer.name = name
            # Blender numbers equal names.
            entry.layer = layer.name

    return {"get": read, "set": write}


def sync(mesh: bpy.types.Mesh, index: int | None = None) -> None:
    """Bring the list of a mesh in line with its layers; if it has changed, the one of this `index` becomes active."""
    if mesh.library or mesh.override_library:
        return
    layers = [each for each in integer_layers(mesh, names.EXTENDER_LAYER_PREFIX, "POINT") if of_layer(each)]
    listed = of(mesh)
    if layers == [entry.layer for entry in listed]:
        return
    listed.clear()
    for layer in layers:
        listed.add().layer = layer
    index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY) if index is None else index
    setattr(mesh, names.ACTIVE_EXTENDER_PROPERTY, max(min(index, len(layers) - 1), 0))
    if (known := edit_meshes.kept(mesh)) is not None:
        known.extenders = None
    # Blender redraws when a property changes, but not when one is removed.
    editors.redraw(bpy.context)


def active(mesh: bpy.types.Mesh) -> int:
    """Return the index of the active extender, or raise a `ReadableError`."""
    sync(mesh)
    index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY)
    if not 0 <= index < len(of(mesh)):
        raise ReadableError(translate(texts.NO_SUCH_EXTENDER))
    return index


def ends(mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    """Return the indices of both vertices of every extender of a mesh in edit mode; -1 for one that is gone.

    Looks at all vertices. Of duplicated vertices the first one counts, the original.
    """
    bm, found = bmesh.from_edit_mesh(mesh), []
    for extender in of(mesh):
        layer = bm.verts.layers.int.get(extender.layer)
        values = [vertex[layer] for vertex in bm.verts] if layer else []
        found.append(tuple(values.index(mark) if mark in values else -1 for mark in _MARKS))
    return found


def resolve(mesh: bpy.types.Mesh) -> tuple[list[Force], list[str]]:
    """Return the extenders that act on a solve of a mesh in edit mode, and the names of broken ones.

    Those that act are on, whole and of nonzero strength: (first vertex, second vertex, strength, half). Those that are
    broken are on, but lost a vertex.
    """
    sync(mesh)
    used = [(extender, pair) for extender, pair in zip(of(mesh), ends(mesh)) if extender.use]
    whole = [(*pair, extender.strength, extender.half) for extender, pair in used if -1 not in pair]
    return [each for each in whole if each[2] != 0.0], [extender.name for extender, pair in used if -1 in pair]


def follow(meshes: Iterable[bpy.types.Mesh] | None = None) -> None:
    """Bring the lists of `meshes` in line, by default of all, and keep those in edit mode with extenders, for drawing.

    Only meshes in edit mode may get extenders without a list, by undo.
    """
    for mesh in bpy.data.meshes if meshes is None else meshes:
        if mesh.is_editmode or of(mesh):
            sync(mesh)
            if mesh.is_editmode and of(mesh):
                edit_meshes.keep(mesh)


def vertices(mesh: bpy.types.Mesh) -> list[tuple[BMVert | None, BMVert | None]] | None:
    """Return both vertices of every extender, None for one that is gone; None while the mesh is not kept.

    For drawing: cheap as long as neither the list nor the topology has changed.
    """
    known = edit_meshes.kept(mesh)
    if known is None:
        return None
    state = len(known.bm.verts), len(of(mesh))
    former, found = known.extenders or (None, [])
    if former != state or not all(vertex is None or vertex.is_valid for pair in found for vertex in pair):
        indices = ends(mesh)
        known.bm.verts.ensure_lookup_table()
        found = [tuple(known.bm.verts[index] if index >= 0 else None for index in pair) for pair in indices]
        known.extenders = state, found
    return found


def add(
    mesh: bpy.types.Mesh, polygons: PolygonMesh, pairs: Iterable[tuple[int, int]], amount: float
) -> list[tuple[int, int]]:
    """Add an extender for every pair of vertices of a mesh in edit mode that has none yet; return these pairs.

    The last one becomes the active one. `pairs` are indices of vertices; `polygons` are the mesh and its map as read.
    Each gets the strength for which its slider shows the `amount`, in percent.
    """
    sync(mesh)
    bm = edit_meshes.keep(mesh).bm
    present = set(map(frozenset, ends(mesh)))
    fresh = [pair for pair in pairs if frozenset(pair) not in present]
    # In the user's language if Blender translates the names of new data.
    name, taken = bpy.app.translations.pgettext_data(texts.EXTENDER_NAME), [each.name for each in of(mesh)]
    bm.verts.ensure_lookup_table()
    for pair, measured in zip(fresh, half_strengths(polygons, fresh)):
        taken.append(free_name(name, taken))
        # As the layer's name keeps it.
        half = float(f"{measured:.3g}")
        new = Extender(taken[-1], strength_of(amount, half), half=half)
        layer = mesh.attributes.new(layer_name(new), "INT", "POINT").name
        for vertex, mark in zip(pair, _MARKS):
            bm.verts[vertex][bm.verts.layers.int[layer]] = mark
    sync(mesh, len(taken) - 1)
    return fresh


def remove(mesh: bpy.types.Mesh) -> None:
    """Remove the active extender; the one before becomes active."""
    index = active(mesh)
    mesh.attributes.remove(mesh.attributes[of(mesh)[index].layer])
    sync(mesh, index - 1)
