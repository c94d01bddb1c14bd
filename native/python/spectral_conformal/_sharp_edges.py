"""The angles at the edges of a polygon mesh: for seams by angle, and for their style."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arguments import Progress, poll
from ._measuring import edge_keys, next_corner

_PART = 1 << 16


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
    progress: Progress | None = None,
) -> tuple[npt.NDArray[np.integer], npt.NDArray[np.float64]]:
    """Return the edges, (n, 2), the lower vertex first, between two faces, and the angles of their normals, (n,).

    Args:
        vertices: (V, 3).
        face_offsets: (F + 1,) the first corner of every face, and the number of corners.
        corner_vertices: (C,) the vertex of every corner.
        vertex_of: (V,) the representative of each vertex where vertices are welded.
        selected_faces: (F,) only edges between two of these; by default all faces.
        progress: called between parts of the work with 0 and "seams".

    Raises:
        Cancelled: `progress` returned False.
    """
    poll(progress, "seams")
    # Faces may have no corners.
    if selected_faces is not None:
        selected_faces = selected_faces[np.diff(face_offsets) > 0]
    face_offsets = face_offsets[np.append(True, face_offsets[1:] > face_offsets[:-1])]
    ends = corner_vertices if vertex_of is None else vertex_of[corner_vertices]
    sides = np.stack([ends, ends[next_corner(face_offsets)]], axis=1)
    keys = edge_keys(sides, len(vertices))
    order = _order(keys, progress)
    keys = keys[order]
    same = keys[1:] == keys[:-1]
    # Two corners that are those of an edge, and no third one.
    begins = same & ~np.r_[False, same[:-1]] & ~np.r_[same[1:], False]
    corners = np.stack([order[:-1][begins], order[1:][begins]], axis=1)
    del keys, order, same, begins
    faces = np.repeat(np.arange(len(face_offsets) - 1), np.diff(face_offsets))[corners]
    if selected_faces is not None:
        is_between = selected_faces[faces].all(axis=1)
        corners, faces = corners[is_between], faces[is_between]
    normals = _face_normals(vertices, face_offsets, corner_vertices, progress)
    turned, has_both = np.empty(len(faces)), np.empty(len(faces), dtype=bool)
    for part in _parts(len(faces)):
        poll(progress, "seams")
        first, second = normals[faces[part, 0]], normals[faces[part, 1]]
        # Accurate for small angles, too. Faces without area have no normal, hence no angle.
        turned[part] = 2.0 * np.arctan2(np.linalg.norm(first - second, axis=1), np.linalg.norm(first + second, axis=1))
        has_both[part] = first.any(axis=1) & second.any(axis=1)
    return np.sort(sides[corners[has_both, 0]], axis=1), turned[has_both]


def _order(keys: npt.NDArray[np.int64], progress: Progress | None) -> npt.NDArray[np.int64]:
    """Return what sorts nonnegative numbers, (n,), equal ones in order: by 16 bits at a time, polling between."""
    order, shift = np.arange(len(keys)), 0
    while keys.max(initial=0) >> shift:
        poll(progress, "seams")
        digits = (keys >> shift).astype(np.uint16)[order]
        order = order[np.argsort(digits, kind="stable")]
        shift += 16
    poll(progress, "seams")
    return order


def _face_normals(
    vertices: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    progress: Progress | None,
) -> npt.NDArray[np.float64]:
    """Return the unit normals of the faces, (F, 3), from their projected areas; 0 for faces without area."""
    normals = np.zeros((len(face_offsets) - 1, 3))
    for part in _parts(len(normals)):
        poll(progress, "seams")
        offsets = face_offsets[part.start : part.stop + 1]
        start = vertices[corner_vertices[offsets[0] : offsets[-1]]]
        offsets = offsets - offsets[0]
        # Relative to a corner of the face, so that a position far from the origin costs no digits.
        start -= np.repeat(start[offsets[:-1]], np.diff(offsets), axis=0)
        crossed = np.cross(start, start[next_corner(offsets)])
        areas = np.add.reduceat(crossed, offsets[:-1], axis=0)
        lengths = np.linalg.norm(areas, axis=1, keepdims=True)
        np.divide(areas, lengths, out=normals[part], where=lengths > 0.0)
    return normals


def _parts(n: int) -> list[slice]:
    """Return parts of n elements whose arrays take little memory beside those of all."""
    return [slice(first, min(first + _PART, n)) for first in range(0, n, _PART)]
