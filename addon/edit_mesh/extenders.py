# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh, each an integer layer of its vertices.

The layer's name holds the name, strength, half and switch; its values mark both vertices. Blender saves, copies and
joins layers with the mesh, edits of the topology carry them along, and undo in edit mode restores them. That undo
restores no properties: so the list that the panel and scripts see, a collection property of the mesh, is brought in
line with the layers, and a change of its entries renames their layers.
"""

from collections.abc import Iterable, Sequence

import bmesh
import bpy
import numpy as np
from bmesh.types import BMesh, BMVert

from .. import editors, names
from ..core.extenders.pairs import HALF, STRENGTH_LIMIT, amount_of, free_name, half_strengths, strength_of
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.words import texts
from ..session import edit_meshes
from .attributes import integer_layers

# Arguments of a strength property.
STRENGTH = {
    **texts.STRENGTH_PROPERTY,
    **{"default": 1.0, "min": -STRENGTH_LIMIT, "max": STRENGTH_LIMIT, "soft_min": -10.0, "soft_max": 10.0},
}
# Arguments of the property of sliders for new extenders.
NEW_AMOUNT = {
    **texts.AMOUNT_OF_PUSH_PROPERTY,
    **{"default": 50.0, "min": -100.0, "max": 100.0, "subtype": "PERCENTAGE", "precision": 1},
}
# The same where it sets the strength beside it.
AMOUNT = {
    **{key: value for key, value in NEW_AMOUNT.items() if key != "default"},
    "get": lambda each: amount_of(each.strength, each.half),
    "set": lambda each, amount: setattr(each, "strength", strength_of(amount, each.half)),
}
# Arguments of the property beside both that says what the amount stands for.
HALF_OF_PAIR = {**texts.HALF_PROPERTY, "default": HALF, "min": 0.0, "options": {"HIDDEN"}}
# Values at both vertices of an extender, 0 at others. Blender interpolates integers in single precision, which holds
# them exactly; a value between different vertices is never one of them.
_MARKS = (1 << 23, -(1 << 23))
# Blender's limit for names of layers in version 3.4, in bytes.
_MAX_BYTES = 63


def of(mesh: bpy.types.Mesh) -> Sequence[bpy.types.PropertyGroup]:
    """Return the list of extenders of a mesh, each with `name`, `strength`, `use` and the name of its `layer`."""
    return getattr(mesh, names.EXTENDERS_PROPERTY)


def layer_name(name: str, strength: float, use: bool, half: float = HALF) -> str:
    """Return the name of the layer of an extender, with all digits of a strength in single precision.

    A long name is cut. A strength that is not a number or is beyond its limit, as in damaged files, counts as 0.
    """
    strength = strength if abs(strength) <= STRENGTH_LIMIT else 0.0
    number = f"{float(np.float32(strength)):.9g}" + ("" if f"{half:.3g}" == f"{HALF:.3g}" else f"@{half:.3g}")
    layer = f"{names.EXTENDER_LAYER_PREFIX}{use:d}:{number}:{name or _default_name()}"
    return layer.encode()[:_MAX_BYTES].decode(errors="ignore")


def properties(layer: str) -> tuple[str, float, bool, float] | None:
    """Return name, strength, switch and half of the extender whose layer's name starts as all do; None for others."""
    try:
        use, number, name = layer[len(names.EXTENDER_LAYER_PREFIX) :].split(":", 2)
        strength, half = map(float, number.split("@") if "@" in number else (number, HALF))
    except ValueError:
        return None
    return (name, strength, use == "1", half) if abs(strength) <= STRENGTH_LIMIT and 0.0 < half < np.inf else None


def _default_name() -> str:
    # In the user's language if Blender translates the names of new data.
    return bpy.app.translations.pgettext_data(texts.EXTENDER_NAME)


def rename_layer(extender: bpy.types.PropertyGroup) -> bool:
    """Name the layer of a changed extender after its properties; return whether the name is a new one."""
    mesh, name = extender.id_data, layer_name(extender.name, extender.strength, extender.use, extender.half)
    if extender.layer not in mesh.attributes or extender.layer == name:
        return False
    layer = mesh.attributes[extender.layer]
    layer.name = name
    # Blender numbers equal names.
    extender.layer = layer.name
    extender.name, extender.strength, *_ = properties(layer.name)
    return True


def sync(mesh: bpy.types.Mesh) -> None:
    """Bring the list of a mesh in line with its layers."""
    if mesh.library or mesh.override_library:
        return
    _convert(mesh)
    layers = [each for each in integer_layers(mesh, names.EXTENDER_LAYER_PREFIX, "POINT") if properties(each)]
    listed = of(mesh)
    if layers == [extender.layer for extender in listed]:
        return
    listed.clear()
    for layer in layers:
        extender = listed.add()
        extender.name, extender.strength, extender.use, extender.half = properties(layer)
        extender.layer = layer
    _activate(mesh, min(getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY), len(layers) - 1))


def _activate(mesh: bpy.types.Mesh, index: int) -> None:
    setattr(mesh, names.ACTIVE_EXTENDER_PROPERTY, max(index, 0))
    # Blender redraws when a property changes, but not when one is removed.
    editors.redraw(bpy.context)


def _convert(mesh: bpy.types.Mesh) -> None:
    """Give the extenders of a file of version 1 layers of their own: it has identifiers of vertices in a common one."""
    former = integer_layers(mesh, names.FORMER_EXTENDER_LAYER_PREFIX, "POINT")
    if not former:
        return
    if mesh.is_editmode:
        verts = bmesh.from_edit_mesh(mesh).verts
        ids = [vertex[verts.layers.int[former[0]]] for vertex in verts]
    else:
        ids = [each.value for each in mesh.attributes[former[0]].data]
    for each in of(mesh):
        ends = [ids.index(end) if end and end in ids else -1 for end in (each.first_id, each.second_id)]
        _add_layer(mesh, layer_name(each.name, each.strength, each.use), ends)
    for layer in former:
        mesh.attributes.remove(mesh.attributes[layer])


def _add_layer(mesh: bpy.types.Mesh, name: str, ends: Iterable[int]) -> None:
    """Add a layer whose values mark both `ends`, indices of vertices, -1 for none."""
    layer = mesh.attributes.new(name, "INT", "POINT")
    verts = bmesh.from_edit_mesh(mesh).verts if mesh.is_editmode else None
    for vertex, mark in zip(ends, _MARKS):
        if vertex < 0:
            continue
        if verts is None:
            layer.data[vertex].value = mark
        else:
            verts.ensure_lookup_table()
            verts[vertex][verts.layers.int[layer.name]] = mark


def ends(bm: BMesh, mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    """Return the indices of both vertices of every extender of `mesh` in `bm`, its edit mesh; -1 for one that is gone.

    Looks at all vertices. Of duplicated vertices the first one counts, the original.
    """
    found = []
    for extender in of(mesh):
        layer = bm.verts.layers.int.get(extender.layer)
        values = np.fromiter((vertex[layer] for vertex in bm.verts) if layer else (), np.int32)
        marked = [np.flatnonzero(values == mark) for mark in _MARKS]
        found.append(tuple(int(indices[0]) if len(indices) else -1 for indices in marked))
    return found


def resolve(
    bm: BMesh, mesh: bpy.types.Mesh
) -> tuple[list[tuple[int, int, float]], list[str], dict[tuple[int, int], float]]:
    """Return the extenders of `mesh` that act on a solve of `bm`, its edit mesh, names of broken ones, and halves.

    Those that act are on, whole and of nonzero strength: (first vertex, second vertex, strength), with the vertices'
    indices in `bm.verts`. Those that are broken are on, but lost a vertex. The halves are those of all whole pairs.
    """
    sync(mesh)
    used = [(extender, pair) for extender, pair in zip(of(mesh), ends(bm, mesh)) if extender.use]
    forces = [(*pair, extender.strength) for extender, pair in used if -1 not in pair and abs(extender.strength) > 0.0]
    halves = {pair: extender.half for extender, pair in used if -1 not in pair}
    return forces, [extender.name for extender, pair in used if -1 in pair], halves


def follow(meshes: Iterable[bpy.types.Mesh]) -> None:
    """Bring the lists of `meshes` in line, and keep those in edit mode that have extenders, for drawing."""
    for mesh in meshes:
        sync(mesh)
        if mesh.is_editmode and of(mesh):
            edit_meshes.keep(mesh)


def begin() -> None:
    """Follow the meshes of the file that have extenders, or may get some back by undo."""
    follow(mesh for mesh in bpy.data.meshes if mesh.is_editmode or of(mesh))


def vertices(mesh: bpy.types.Mesh) -> list[tuple[BMVert | None, BMVert | None]] | None:
    """Return both vertices of every extender, None for one that is gone; None while the mesh is not kept.

    For drawing: cheap as long as neither the layers nor the topology have changed.
    """
    known = edit_meshes.kept(mesh)
    if known is None:
        return None
    state = len(known.bm.verts), [extender.layer for extender in of(mesh)]
    former, found = known.extenders or (None, [])
    if former != state or not all(vertex is None or vertex.is_valid for pair in found for vertex in pair):
        indices = ends(known.bm, mesh)
        known.bm.verts.ensure_lookup_table()
        found = [tuple(known.bm.verts[index] if index >= 0 else None for index in pair) for pair in indices]
        known.extenders = state, found
    return found


def broken(mesh: bpy.types.Mesh) -> list[bool]:
    """Return which extenders of a mesh in edit mode have lost a vertex, if known."""
    return [None in pair for pair in vertices(mesh) or [()] * len(of(mesh))]


def add(
    mesh: bpy.types.Mesh,
    polygons: PolygonMesh,
    pairs: Iterable[tuple[int, int]],
    amount: float,
    strength: float | None = None,
) -> list[tuple[int, int]]:
    """Add an extender for every pair of vertices of a mesh in edit mode that has none yet; return these pairs.

    The last one becomes the active one. `pairs` are indices of vertices; `polygons` are the mesh and its map as read.
    Each gets the strength for which its slider shows the `amount`, in percent, or a given one.
    """
    sync(mesh)
    present = set(map(frozenset, ends(edit_meshes.keep(mesh).bm, mesh)))
    fresh = [pair for pair in pairs if frozenset(pair) not in present]
    taken = [each.name for each in of(mesh)]
    for pair, measured in zip(fresh, half_strengths(polygons, fresh)):
        taken.append(free_name(_default_name(), taken))
        # As the layer's name keeps it.
        half = float(f"{measured:.3g}")
        own = strength_of(amount, half) if strength is None else strength
        _add_layer(mesh, layer_name(taken[-1], own, True, half), pair)
    if fresh:
        sync(mesh)
        _activate(mesh, len(taken) - 1)
    return fresh


def remove(mesh: bpy.types.Mesh, indices: Sequence[int]) -> None:
    """Remove extenders; the active one stays active, or the one before becomes so."""
    index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY)
    for layer in {of(mesh)[k].layer for k in indices} & set(mesh.attributes.keys()):
        mesh.attributes.remove(mesh.attributes[layer])
    sync(mesh)
    _activate(mesh, index - sum(k < index for k in indices) - (index in indices))
