"""The charts of a mesh, before any solve."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _native
from ._arguments import Faces
from ._mesh import Mesh, checked_polygons, given_mesh


def chart_of_face(
    mesh: Mesh | npt.ArrayLike,
    faces: Faces | None = None,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
) -> npt.NDArray[np.int32]:
    """Return the chart of every face, (faces,), as `unwrap` cuts a mesh if no vertex has several different pins.

    Charts are numbered from 0. Faces that are not selected, or have fewer than three different vertices, are in no
    chart and get -1. This takes a small fraction of the time of a solve.

    Args:
        mesh: as in `unwrap`.
        faces: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        seam_edges: as in `unwrap`.
        selected_faces: as in `unwrap`.

    Raises:
        ValueError: the arrays do not describe a mesh.
    """
    return _native.chart_of_face(
        *checked_polygons(given_mesh(mesh, faces, corner_vertices), seam_edges, selected_faces)
    )
