# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of a mesh, in edit mode or not, and its edges by their vertices."""

import bmesh
import bpy
from bmesh.types import BMEdge, BMesh

from ..core.constraints.marks import Edge


def elements(mesh: bpy.types.Mesh) -> BMesh:
    """Return the edit mesh of a mesh in edit mode; of any other mesh, a copy."""
    if mesh.is_editmode:
        return bmesh.from_edit_mesh(mesh)
    copy = bmesh.new()
    copy.from_mesh(mesh)
    return copy


def edge_ends(edge: BMEdge) -> Edge:
    """Return the indices of the vertices of an edge, the lower one first."""
    first, second = (vertex.index for vertex in edge.verts)
    return (first, second) if first < second else (second, first)


def marked_edges(mesh: bpy.types.Mesh, layer: str) -> dict[Edge, int]:
    """Return the edges of a mesh in edit mode whose value in an integer layer is not 0, with this value."""
    bm = bmesh.from_edit_mesh(mesh)
    values = bm.edges.layers.int.get(layer)
    if values is None:
        return {}
    bm.verts.index_update()
    return {edge_ends(edge): edge[values] for edge in bm.edges if edge[values]}
