# SPDX-License-Identifier: GPL-3.0-or-later
"""The constraints of a mesh: each an integer layer of its edges (`shapes`), with the marks of `core.constraints`."""

from dataclasses import replace

import bmesh
import bpy
import numpy as np
from bmesh.types import BMesh

from .. import names
from ..core.constraints import marks
from ..core.constraints.equations import Marked
from ..core.mesh.polygon_mesh import PolygonMesh
from . import shapes
from .elements import edge_ends, elements, marked_edges
from .shapes import EXTENDER, Shape

# UniV's values: two bits for each face at an edge, those of the first face lowest.
_OF_UNIV = {2: marks.VERTICAL, 3: marks.HORIZONTAL}


def of(mesh: bpy.types.Mesh) -> list[tuple[str, Shape]]:
    """Return the constraints of a mesh with the names of their layers."""
    return [(layer, shape) for layer, shape in shapes.of(mesh) if shape.kind != EXTENDER]


def add(mesh: bpy.types.Mesh, constraint: Shape, marked: marks.Marks) -> str:
    """Add a constraint with these marks, by the vertices of edges, to a mesh in edit mode; return its layer's name."""
    numbers = [each.number for _, each in of(mesh) if each.kind == constraint.kind]
    layer_name = shapes.new_layer(mesh, replace(constraint, number=max(numbers, default=0) + 1))
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.edges.layers.int[layer_name]
    bm.verts.index_update()
    for edge in bm.edges:
        edge[layer] = marked.get(edge_ends(edge), 0)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    shapes.activate(mesh, layer_name)
    return layer_name


def acting(mesh: bpy.types.Mesh) -> dict[marks.Edge, tuple]:
    """Return the marked edges of a mesh in edit mode, each with all that constraints in use require of it."""
    result: dict[marks.Edge, tuple] = {}
    for layer, constraint in of(mesh):
        if constraint.use:
            for edge, mark in marked_edges(mesh, layer).items():
                result[edge] = (*result.get(edge, ()), (mark, constraint.angle, constraint.spacing))
    return result


def read(mesh: bpy.types.Mesh, copy: bpy.types.Mesh, polygons: PolygonMesh) -> list[Marked]:
    """Return the constraints in use of a mesh, given a `copy` that is not in edit mode and its arrays."""
    result = []
    used = [(layer, each) for layer, each in of(mesh) if each.use]
    if used:
        edge_of_corner = np.empty(len(polygons.corner_vertices), dtype=np.int32)
        copy.loops.foreach_get("edge_index", edge_of_corner)
        values = np.empty(len(copy.edges), dtype=np.int32)
        for layer, each in used:
            copy.attributes[layer].data.foreach_get("value", values)
            result.append(Marked(values[edge_of_corner], np.radians(each.angle), each.spacing))
    univ = _of_univ(elements(mesh), len(polygons.corner_vertices))
    return result if univ is None else [*result, Marked(univ)]


def _of_univ(bm: BMesh, corners: int) -> np.ndarray | None:
    """Return the marks that UniV's attribute of edges gives to corners, (C,); None if there are none."""
    layer = bm.edges.layers.int.get(names.UNIV_CONSTRAINTS_ATTRIBUTE)
    marked = [edge for edge in bm.edges if edge[layer]] if layer is not None else []
    if not marked:
        return None
    result = np.zeros(corners, dtype=np.int32)
    index = {loop: k for k, loop in enumerate(loop for face in bm.faces for loop in face.loops)}
    for edge in marked:
        for k, loop in enumerate(edge.link_loops):
            result[index[loop]] = _OF_UNIV.get((edge[layer] >> 2 * k) & 3, 0)
    return result
