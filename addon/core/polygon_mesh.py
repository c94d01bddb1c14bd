# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh as arrays, in the layout that both Blender and `spectral_conformal.unwrap` use."""

from dataclasses import dataclass, fields

import numpy as np


@dataclass(frozen=True)
class PolygonMesh:
    """A polygon mesh with seams and a selection; V vertices, F faces, C face corners, S seam edges.

    Attributes:
        vertices: (V, 3) float64, positions in object space.
        face_offsets: (F + 1,) int32, the corners of face f are face_offsets[f] to face_offsets[f + 1] - 1.
        corner_vertices: (C,) int32, vertex of every corner.
        seam_edges: (S, 2) int32, vertex pairs.
        selected_faces: (F,) bool, the faces to unwrap.
        uv: (C, 2) float64, the map before; None where the mesh has no UV map.
    """

    vertices: np.ndarray
    face_offsets: np.ndarray
    corner_vertices: np.ndarray
    seam_edges: np.ndarray
    selected_faces: np.ndarray
    uv: np.ndarray | None = None

    def face_of_corner(self) -> np.ndarray:
        """Return the face of every corner, (C,) intp."""
        return np.repeat(np.arange(len(self.selected_faces)), np.diff(self.face_offsets))

    def equals(self, other: "PolygonMesh") -> bool:
        """Return whether everything is the same; NaN equals NaN."""
        pairs = ((getattr(self, field.name), getattr(other, field.name)) for field in fields(self))
        return all(
            np.array_equal(mine, yours, equal_nan=np.asarray(mine).dtype.kind == "f" and yours is not None)
            for mine, yours in pairs
        )
