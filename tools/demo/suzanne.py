# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Suzanne, with the seams that an artist would mark, subdivided to about 63,000 vertices."""

from __future__ import annotations

import heapq

import bpy

# isort: split
# With the bpy wheel these can be imported only after bpy.
import bmesh
from mathutils import Vector

# Paths over the base mesh's edges, each the shortest one through these points (right half; the left is its mirror
# image). Six islands: face and muzzle, back of the head with the backs of the ears, two ears, two eyeballs.
SEAMS = {
    "around the ear, behind its rim": [
        (0.86, 0.38, 0.38), (0.83, 0.13, -0.07), (0.79, 0.33, -0.12), (1.37, 0.5, 0.3), (0.86, 0.38, 0.38),
    ],
    "ear to forehead": [(0.86, 0.38, 0.38), (0.8, 0.12, 0.62), (0, -0.29, 0.9)],
    "ear to nape": [(0.79, 0.33, -0.12), (0, 0.35, -0.38)],
    "back of the head": [(0, 0.08, 0.98), (0, 0.35, -0.38)],
    "nape to throat": [(0, 0.35, -0.38), (0, -0.28, -0.48)],
    "jaw, under the muzzle": [(0, -0.28, -0.48), (0.23, -0.41, -0.35), (0.33, -0.4, -0.91), (0.37, -0.53, -0.89)],
}  # fmt: skip
SUBDIVISIONS = 3


def add_suzanne() -> bpy.types.Object:
    """Add Suzanne with seams, subdivided, with every quad split into four triangles at its center."""
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    mesh = suzanne.data
    # Seams first: they survive subdivision.
    edit = bmesh.new()
    edit.from_mesh(mesh)
    for points in SEAMS.values():
        for side in (1.0, -1.0):
            mark_path(edit, [Vector((side * x, y, z)) for x, y, z in points])
    edit.to_mesh(mesh)
    edit.free()
    subdivision = suzanne.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = SUBDIVISIONS
    bpy.ops.object.modifier_apply(modifier=subdivision.name)
    edit = bmesh.new()
    edit.from_mesh(mesh)
    bmesh.ops.poke(edit, faces=edit.faces)
    edit.to_mesh(mesh)
    edit.free()
    return suzanne


def mark_path(edit: bmesh.types.BMesh, points: list[Vector]) -> None:
    """Mark as seams the shortest path through the vertices nearest to the points."""
    stops = [min(edit.verts, key=lambda vertex, at=point: (vertex.co - at).length) for point in points]
    for start, end in zip(stops, stops[1:]):
        for edge in shortest_path(start, end):
            edge.seam = True


def shortest_path(start: bmesh.types.BMVert, end: bmesh.types.BMVert) -> list[bmesh.types.BMEdge]:
    """Return the edges of the shortest path between two vertices (Dijkstra)."""
    distance = {start: 0.0}
    arrival = {}
    queue = [(0.0, start.index, start)]
    while queue:
        length, _, vertex = heapq.heappop(queue)
        if vertex == end:
            break
        for edge in vertex.link_edges:
            other = edge.other_vert(vertex)
            through = length + edge.calc_length()
            if through < distance.get(other, float("inf")):
                distance[other] = through
                arrival[other] = edge
                heapq.heappush(queue, (through, other.index, other))
    path = []
    vertex = end
    while vertex != start:
        path.append(arrival[vertex])
        vertex = arrival[vertex].other_vert(vertex)
    return path
