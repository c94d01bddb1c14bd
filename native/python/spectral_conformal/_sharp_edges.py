"""The angles at the edges of a polygon mesh: for seams by angle, and for their style."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._measuring import edge_keys, next_corner


def sharp_edges(
    vertices: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    angle: float,
    *,
    vertex_of: npt.NDArray[np.integer] | None = None,
    selected_faces: npt.NDArray[np.bool_] | None = None,
) -> npt.NDArray[np.integer]:
    """Return the edges of `bends`, (n, 2), whose angle is `angle` or more, in radians."""
    edges, turned = bends(vertices, face_offsets, corner_vertices, vertex_of=vertex_of, selected_faces=selected_faces)
    return edges[turned >= angle]


def bends(
    vertices: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    *,
    vertex_of: npt.NDArray[np.integer] | None = None,
    selected_faces: npt.NDArray[np.bool_] | None = None,
) -> tuple[npt.NDArray[np.integer], npt.NDArray[np.float64]]:
    """Return the edges, (n, 2), the lower vertex first, between two faces, and the angles of their normals, (n,).

    Args:
        vertices: (V, 3).
        face_offsets: (F + 1,) the first corner of every face, and the number of corners.
        corner_vertices: (C,) the vertex of every corner.
        vertex_of: (V,) the representative of each vertex where vertices are welded.
        selected_faces: (F,) only edges between two of these; by default all faces.
    """
    # Faces may have no corners.
    if selected_faces is not None:
        selected_faces = selected_faces[np.diff(face_offsets) > 0]
    face_offsets = np.unique(face_offsets)
    welded = corner_vertices if vertex_of is None else vertex_of[corner_vertices]
    pairs = np.sort(np.stack([welded, welded[next_corner(face_offsets)]], axis=1), axis=1)
    face_of_corner = np.repeat(np.arange(len(face_offsets) - 1), np.diff(face_offsets))
    _, inverse, count = np.unique(edge_keys(pairs, len(vertices)), return_inverse=True, return_counts=True)
    corners = np.argsort(inverse, kind="stable")
    corners = corners[count[inverse[corners]] == 2].reshape(-1, 2)
    if selected_faces is not None:
        corners = corners[selected_faces[face_of_corner[corners]].all(axis=1)]
    normals = _face_normals(vertices, face_offsets, corner_vertices, face_of_corner)
    first, second = normals[face_of_corner[corners[:, 0]]], normals[face_of_corner[corners[:, 1]]]
    # Accurate for small angles, too. Faces without area have no normal, hence no angle.
    turned = 2.0 * np.arctan2(np.linalg.norm(first - second, axis=1), np.linalg.norm(first + second, axis=1))
    has_both = first.any(axis=1) & second.any(axis=1)
    return pairs[corners[has_both, 0]], turned[has_both]


def _face_normals(
    vertices: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    face_of_corner: npt.NDArray[np.integer],
) -> npt.NDArray[np.float64]:
    """Return the unit normals of the faces, (F, 3), from their projected areas; 0 for faces without area."""
    start = vertices[corner_vertices]
    # Relative to a corner of the face, so that a position far from the origin costs no digits.
    start -= start[face_offsets[:-1]][face_of_corner]
    crossed = np.cross(start, start[next_corner(face_offsets)])
    normals = np.add.reduceat(crossed, face_offsets[:-1], axis=0) if len(crossed) else np.zeros((0, 3))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0.0)
