# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh, which artists call Push/Pull: each an integer layer of its vertices (`shapes`)."""

from collections.abc import Iterable

import bpy
from bmesh.types import BMVert

from ..core.extenders.pairs import free_name, half_strengths, strength_of
from ..core.mesh.polygon_mesh import Force, PolygonMesh
from ..session import edit_meshes
from . import shapes
from .elements import elements
from .shapes import EXTENDER, Shape

# Values at both vertices of an extender, 0 at others. Blender interpolates integers in single precision, which holds
# them exactly; a value between different vertices is never one of them.
_MARKS = (1 << 23, -(1 << 23))


def of(mesh: bpy.types.Mesh) -> list[tuple[str, Shape]]:
    """Return the extenders of a mesh with the names of their layers."""
    return [(layer, shape) for layer, shape in shapes.of(mesh) if shape.kind == EXTENDER]


def ends(mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    """Return the indices of both vertices of every extender of a mesh; -1 for one that is gone.

    Looks at all vertices. Of duplicated vertices the first one counts, the original.
    """
    bm, found = elements(mesh), []
    for name, _ in of(mesh):
        layer = bm.verts.layers.int.get(name)
        values = [vertex[layer] for vertex in bm.verts] if layer else []
        found.append(tuple(values.index(mark) if mark in values else -1 for mark in _MARKS))
    return found


def resolve(mesh: bpy.types.Mesh) -> tuple[list[Force], list[str]]:
    """Return the extenders that act on a solve of a mesh, and the names of broken ones.

    Those that act are on, whole and of nonzero strength: (first vertex, second vertex, strength, half). Those that are
    broken are on, but lost a vertex.
    """
    used = [(extender, pair) for (_, extender), pair in zip(of(mesh), ends(mesh)) if extender.use]
    whole = [(*pair, extender.strength, extender.half) for extender, pair in used if -1 not in pair]
    return [each for each in whole if each[2] != 0.0], [extender.name for extender, pair in used if -1 in pair]


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


def is_broken(mesh: bpy.types.Mesh, layer: str) -> bool:
    """Return whether the extender of this layer is known to have lost a vertex; for drawing."""
    known = dict(zip((name for name, _ in of(mesh)), vertices(mesh) or ()))
    return None in known.get(layer, ())


def add(
    mesh: bpy.types.Mesh, polygons: PolygonMesh, pairs: Iterable[tuple[int, int]], amount: float
) -> list[tuple[int, int]]:
    """Add an extender for every pair of vertices of a mesh in edit mode that has none yet; return these pairs.

    The last one becomes the active one. `pairs` are indices of vertices; `polygons` are the mesh and its map as read.
    Each gets the strength for which its slider shows the `amount`, in percent.
    """
    bm = edit_meshes.keep(mesh).bm
    present = set(map(frozenset, ends(mesh)))
    fresh = [pair for pair in pairs if frozenset(pair) not in present]
    # In the user's language if Blender translates the names of new data.
    name, taken = bpy.app.translations.pgettext_data("Push/Pull"), [each.name for _, each in of(mesh)]
    bm.verts.ensure_lookup_table()
    for pair, measured in zip(fresh, half_strengths(polygons, fresh)):
        taken.append(free_name(name, taken))
        # As the layer's name keeps it.
        half = float(f"{measured:.3g}")
        layer = shapes.new_layer(mesh, Shape(name=taken[-1], strength=strength_of(amount, half), half=half))
        for vertex, mark in zip(pair, _MARKS):
            bm.verts[vertex][bm.verts.layers.int[layer]] = mark
    if fresh:
        shapes.activate(mesh, layer)
    return fresh
