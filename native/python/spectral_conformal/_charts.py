"""The charts of a mesh, before anything is solved."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Faces


def chart_of_face(
    vertices: npt.ArrayLike,
    faces: Faces,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
) -> npt.NDArray[np.int32]:
    """Return the chart of every face, (faces,), as `unwrap` cuts a mesh without pins that differ at a vertex.

    Charts are numbered from 0; faces that are not selected, or have fewer than three different vertices, are in no
    chart: -1. Takes a small part of the time of a solve.

    Args:
        vertices: this and the others as in `unwrap`.
        faces: see `unwrap`.
        corner_vertices: see `unwrap`.
        seam_edges: see `unwrap`.
        selected_faces: see `unwrap`.

    Raises:
        ValueError: the arrays do not describe a mesh.
    """
    return _native.chart_of_face(
        *_arguments.checked_polygon_mesh(vertices, faces, corner_vertices, seam_edges, selected_faces)
    )
