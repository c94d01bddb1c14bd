"""Whether seams are those of a hard surface or of an organic one, by the shape."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from ._arguments import Progress
from ._sharp_edges import bends

Style = Literal["auto", "hard", "organic"]
STYLES = get_args(Style)
CREASE = np.radians(30.0)
"""Shading shows an edge that is sharper than this."""


def hardness(
    vertices: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    *,
    vertex_of: npt.NDArray[np.integer] | None = None,
    selected_faces: npt.NDArray[np.bool_] | None = None,
    progress: Progress | None = None,
) -> float:
    """Return how much of a surface's bending lies on creases, from 0 to 1; 1 for a flat one.

    It is the share of edges sharper than 30 degrees in the sum of l t^2 over all edges with length l and angle t. On
    finer meshes of the same shape, it tends to 1 with creases and to 0 without, since the angles of n edges around a
    bend decrease as 1 / n, the sum of their squares, too, and the angle of a crease stays.

    Args:
        vertices: (V, 3).
        face_offsets: (F + 1,) the first corner of every face, and the number of corners.
        corner_vertices: (C,) the vertex of every corner.
        vertex_of: (V,) the representative of each vertex where vertices are welded.
        selected_faces: (F,) only edges between two of these; by default all faces.
        progress: called between parts of the work; see `bends`.

    Raises:
        Cancelled: `progress` returned False.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        edges, angles = bends(
            vertices,
            face_offsets,
            corner_vertices,
            vertex_of=vertex_of,
            selected_faces=selected_faces,
            progress=progress,
        )
        lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
        # Relative, so that no square is out of range.
        bending = lengths / lengths.max(initial=0.0) * angles**2
    total = bending.sum()
    return float(bending[angles >= CREASE].sum() / total) if 0.0 < total < np.inf else 1.0


def style_of(
    vertices: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    *,
    vertex_of: npt.NDArray[np.integer] | None = None,
    selected_faces: npt.NDArray[np.bool_] | None = None,
    progress: Progress | None = None,
) -> Literal["hard", "organic"]:
    """Return "hard" if at least half of the bending lies on creases, else "organic"; arguments as for `hardness`."""
    found = hardness(
        vertices,
        face_offsets,
        corner_vertices,
        vertex_of=vertex_of,
        selected_faces=selected_faces,
        progress=progress,
    )
    # In single precision, so that rounding does not decide.
    return "hard" if np.float32(found) >= 0.5 else "organic"
