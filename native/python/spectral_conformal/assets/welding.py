"""Weld adjacent faces that have separate vertices, and find sharp edges and material borders of the welded mesh.

Files often store a vertex once per normal or UV, or once per face. UVs belong to the corners of faces, so a solution on
the welded mesh also holds for the original mesh, which stays unchanged.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import numpy.typing as npt

from .._measuring import edges_between, next_corner
from .._sharp_edges import sharp_edges as edges_by_angle
from .mesh import AssetMesh

Integers = npt.NDArray[np.int64]

# Relative to the size of the mesh: below, single-precision rounding decides; above, welding changes the shape.
DISTANCES = (1e-6, 1e-2)


def coincident_vertices(
    vertices: np.ndarray, face_offsets: np.ndarray, corner_vertices: np.ndarray, distance: float
) -> np.ndarray:
    """Return the representative of every vertex, (V,) int64: the first vertex at the same position, or itself.

    Only vertices on open borders are merged, so bodies that touch each other stay separate. Two vertices of one face
    are merged only if they follow each other and the face keeps three corners, as where quads end in a pole.

    Args:
        vertices: (V, 3), finite.
        face_offsets: (F + 1,).
        corner_vertices: (C,).
        distance: fraction of the bounding box's diagonal, within `DISTANCES`. Vertices at most this far apart are
            merged; vertices four times as far apart are not, unless others lie between them.
    """
    vertex_of = np.arange(len(vertices), dtype=np.int64)
    border = _border_vertices(len(vertices), face_offsets, corner_vertices)
    if len(border) == 0:
        return vertex_of
    points = vertices[border].astype(np.float64)
    points -= points.min(axis=0)
    used = vertices[corner_vertices]
    size = float(np.linalg.norm(np.ptp(used, axis=0).astype(np.float64)))
    if size > 0.0:
        vertex_of[border] = border[_first_in_cell(points / (2.0 * distance * size))]
    _part_corners_of_faces(vertex_of, face_offsets, corner_vertices)
    return vertex_of


def _border_vertices(n_vertices: int, face_offsets: np.ndarray, corner_vertices: np.ndarray) -> np.ndarray:
    """Return the ends of the edges with one face, ascending."""
    pairs = face_edges(face_offsets, corner_vertices)
    _, first, count = np.unique(_keys(pairs, n_vertices), return_index=True, return_counts=True)
    return np.unique(pairs[first[count == 1]])


def face_edges(face_offsets: np.ndarray, corner_vertices: np.ndarray) -> np.ndarray:
    """Return the edge from every corner to the next one in its face, (C, 2), the lower vertex first."""
    return _lower_first(np.column_stack([corner_vertices, corner_vertices[next_corner(face_offsets)]]))


def _lower_first(pairs: np.ndarray) -> np.ndarray:
    # A sort along the axis takes eight times as long.
    first, second = pairs.T
    return np.column_stack([np.minimum(first, second), np.maximum(first, second)])


def _keys(pairs: np.ndarray, n_vertices: int) -> np.ndarray:
    """Return a unique number for every pair of vertices with the lower one first, (n,) int64."""
    return pairs[:, 0].astype(np.int64) * n_vertices + pairs[:, 1]


def _first_in_cell(points: np.ndarray) -> np.ndarray:
    """Return for each point the first one that shares a cell with it, transitively, (n,) intp; cells have side 1.

    The cells of eight grids count, shifted by 0 or 1/2 along each axis: two points at most 1/2 apart along every axis
    share a cell of one of them.
    """
    side = int(points.max()) + 2
    cells = []
    for shift in product((0.0, 0.5), repeat=3):
        x, y, z = np.floor(points + shift).astype(np.int64).T
        cells.append(np.unique((x * side + y) * side + z, return_inverse=True)[1])
    first = np.arange(len(points))
    before = None
    while before is None or not np.array_equal(first, before):
        before = first
        for cell in cells:
            lowest = np.full(int(cell.max()) + 1, len(points))
            np.minimum.at(lowest, cell, first)
            first = lowest[cell]
    return first


def _part_corners_of_faces(vertex_of: np.ndarray, face_offsets: np.ndarray, corner_vertices: np.ndarray) -> None:
    """Make a vertex its own representative if one of its faces has it twice, unless the face loses only short edges."""
    face = np.repeat(np.arange(len(face_offsets) - 1), np.diff(face_offsets))
    key = face * len(vertex_of) + vertex_of[corner_vertices]
    order = np.argsort(key, kind="stable")
    corners = corner_vertices[order]
    same = (np.diff(key[order]) == 0) & (corners[1:] != corners[:-1])
    if not same.any():
        return
    # Of each face, the corners that another vertex follows, and how many vertices these are.
    is_single = key != key[next_corner(face_offsets)]
    n_single = np.add.reduceat(is_single.astype(np.int64), face_offsets[:-1])
    n_different = np.bincount(np.unique(key[is_single]) // len(vertex_of), minlength=len(n_single))
    same &= ~((n_single >= 3) & (n_different == n_single))[face[order[1:]]]
    apart = np.concatenate([corners[1:][same], corners[:-1][same]])
    vertex_of[apart] = apart


def sharp_edges(mesh: AssetMesh, vertex_of: Integers, angle: float) -> Integers:
    """Return the edges, (n, 2), between two faces of the welded mesh whose normals differ by `angle` or more.

    Args:
        mesh: the original mesh.
        vertex_of: (V,) the representative of each vertex.
        angle: in radians.
    """
    return edges_by_angle(mesh.vertices, mesh.face_offsets, mesh.corner_vertices, angle, vertex_of=vertex_of)


def borders_between(mesh: AssetMesh, vertex_of: Integers, values: Integers | None) -> Integers:
    """Return the edges, (n, 2), between two faces of the welded mesh with different values, such as materials.

    Args:
        mesh: the original mesh.
        vertex_of: (V,) the representative of each vertex.
        values: (faces,); None for all alike.
    """
    if values is None:
        return np.zeros((0, 2), np.int64)
    return edges_between(values, mesh.face_offsets, vertex_of[mesh.corner_vertices], len(mesh.vertices))
