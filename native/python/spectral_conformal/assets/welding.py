"""Meshes whose faces lie side by side but have vertices of their own, as if they shared them; and sharp edges of them.

Files often hold a vertex once for every normal or UV that it has, or for every face. UVs belong to the corners of
faces, so that what is solved on the welded mesh holds for the mesh as it is, which does not change.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import numpy.typing as npt

from .._measuring import next_corner
from .mesh import AssetMesh

Integers = npt.NDArray[np.int64]

# Of the size of the mesh: below, rounding of single precision decides; above, it is no longer cleaning.
DISTANCES = (1e-6, 1e-2)


def coincident_vertices(
    vertices: np.ndarray, face_offsets: np.ndarray, corner_vertices: np.ndarray, distance: float
) -> np.ndarray:
    """Return the vertex that stands for every vertex, (V,) int64: the first of those at the same place, or itself.

    Only vertices on open borders have others that stand for them: bodies that touch each other stay apart. So do the
    vertices of one face.

    Args:
        vertices: (V, 3), finite.
        face_offsets: (F + 1,).
        corner_vertices: (C,).
        distance: of the diagonal of the bounding box, within `DISTANCES`. Vertices that are as near as that to each
            other are at one place, none that are four times as far away, unless others lie between them.
    """
    vertex_of = np.arange(len(vertices), dtype=np.int64)
    border = _border_vertices(len(vertices), face_offsets, corner_vertices)
    if len(border) == 0:
        return vertex_of
    places = vertices[border].astype(np.float64)
    places -= places.min(axis=0)
    used = vertices[corner_vertices]
    size = float(np.linalg.norm(np.ptp(used, axis=0).astype(np.float64)))
    if size > 0.0:
        vertex_of[border] = border[_first_at_place(places / (2.0 * distance * size))]
    _part_corners_of_faces(vertex_of, face_offsets, corner_vertices)
    return vertex_of


def _border_vertices(n_vertices: int, face_offsets: np.ndarray, corner_vertices: np.ndarray) -> np.ndarray:
    """Return the ends of the edges that have one face, ascending."""
    pairs = face_edges(face_offsets, corner_vertices)
    _, first, count = np.unique(_keys(pairs, n_vertices), return_index=True, return_counts=True)
    return np.unique(pairs[first[count == 1]])


def face_edges(face_offsets: np.ndarray, corner_vertices: np.ndarray) -> np.ndarray:
    """Return the edge from every corner to the next of its face, (C, 2), the lower vertex first."""
    return _lower_first(np.column_stack([corner_vertices, corner_vertices[next_corner(face_offsets)]]))


def _lower_first(pairs: np.ndarray) -> np.ndarray:
    # A sort along the axis takes eight times as long.
    first, second = pairs.T
    return np.column_stack([np.minimum(first, second), np.maximum(first, second)])


def _keys(pairs: np.ndarray, n_vertices: int) -> np.ndarray:
    """Return a number for every pair of vertices, (n,) int64, the lower one first."""
    return pairs[:, 0].astype(np.int64) * n_vertices + pairs[:, 1]


def _first_at_place(places: np.ndarray) -> np.ndarray:
    """Return the first point of those that share a cell with each, (n,) intp; cells have a side of 1.

    All grids whose cells begin at a whole or a half in each direction count: two points not farther apart than a half
    along any axis share a cell of one of them.
    """
    side = int(places.max()) + 2
    cells = []
    for shift in product((0.0, 0.5), repeat=3):
        x, y, z = np.floor(places + shift).astype(np.int64).T
        cells.append(np.unique((x * side + y) * side + z, return_inverse=True)[1])
    first = np.arange(len(places))
    before = None
    while before is None or not np.array_equal(first, before):
        before = first
        for cell in cells:
            lowest = np.full(int(cell.max()) + 1, len(places))
            np.minimum.at(lowest, cell, first)
            first = lowest[cell]
    return first


def _part_corners_of_faces(vertex_of: np.ndarray, face_offsets: np.ndarray, corner_vertices: np.ndarray) -> None:
    """Let those vertices stand for themselves that belong to a face with another one of the same place."""
    face = np.repeat(np.arange(len(face_offsets) - 1), np.diff(face_offsets))
    key = face * len(vertex_of) + vertex_of[corner_vertices]
    order = np.argsort(key, kind="stable")
    corners = corner_vertices[order]
    same = (np.diff(key[order]) == 0) & (corners[1:] != corners[:-1])
    apart = np.concatenate([corners[1:][same], corners[:-1][same]])
    vertex_of[apart] = apart


def sharp_edges(mesh: AssetMesh, vertex_of: Integers, angle: float) -> Integers:
    """Return the edges, (n, 2), between two faces of the welded mesh whose normals are turned by an angle or more.

    Args:
        mesh: the mesh as it is.
        vertex_of: (V,) the vertex that stands for each.
        angle: in radians.
    """
    pairs = face_edges(mesh.face_offsets, vertex_of[mesh.corner_vertices])
    _, inverse, count = np.unique(_keys(pairs, len(mesh.vertices)), return_inverse=True, return_counts=True)
    corners = np.argsort(inverse, kind="stable")
    corners = corners[count[inverse[corners]] == 2].reshape(-1, 2)
    normals = _face_normals(mesh)[mesh.face_of_corner()]
    first, second = normals[corners[:, 0]], normals[corners[:, 1]]
    # Of two unit vectors this is right for small angles, too; faces without area have none, and no angle.
    turned = 2.0 * np.arctan2(np.linalg.norm(first - second, axis=1), np.linalg.norm(first + second, axis=1))
    has_both = first.any(axis=1) & second.any(axis=1)
    return pairs[corners[has_both & (turned >= angle), 0]]


def _face_normals(mesh: AssetMesh) -> npt.NDArray[np.float64]:
    """Return the unit normals of the faces, (F, 3), by the areas of their projections; 0 where there is none."""
    start = mesh.vertices[mesh.corner_vertices]
    # From one of the face's own corners, so that a place far from the origin costs no digits.
    start -= start[mesh.face_offsets[:-1]][mesh.face_of_corner()]
    crossed = np.cross(start, start[next_corner(mesh.face_offsets)])
    normals = np.add.reduceat(crossed, mesh.face_offsets[:-1], axis=0) if len(crossed) else np.zeros((0, 3))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0.0)
