# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh as arrays, in the layout that both Blender and `spectral_conformal.unwrap` use."""

import functools
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
        pinned_corners: (C,) bool, the corners whose place in `uv` is to be kept; None for none.
        aspect: width over height of the image that the map is for.
        extenders: (vertex, vertex, strength) of every soft force between two vertices.
        stretch_direction: (3,) float64, of length 1, the direction along which the map may be stretched; None for none.
    """

    vertices: np.ndarray
    face_offsets: np.ndarray
    corner_vertices: np.ndarray
    seam_edges: np.ndarray
    selected_faces: np.ndarray
    uv: np.ndarray | None = None
    pinned_corners: np.ndarray | None = None
    aspect: float = 1.0
    extenders: tuple[tuple[int, int, float], ...] = ()
    stretch_direction: np.ndarray | None = None

    @functools.cached_property
    def topology(self) -> int:
        """A digest of the faces and of their vertices, without the places of these; another in every process."""
        return hash((self.face_offsets.tobytes(), self.corner_vertices.tobytes()))

    def face_of_corner(self) -> np.ndarray:
        """Return the face of every corner, (C,) intp."""
        return np.repeat(np.arange(len(self.selected_faces)), np.diff(self.face_offsets))

    def next_corner(self) -> np.ndarray:
        """Return the corner that follows every corner in its face, (C,) intp."""
        return next_corner(self.face_offsets)

    def face_bounds(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the lower and upper corners of the faces' bounding boxes, (F, n) each, of the corners (C, n)."""
        starts, sizes = self.face_offsets[:-1], np.diff(self.face_offsets)
        if not len(sizes) or (sizes != sizes[0]).any():
            return np.minimum.reduceat(positions, starts), np.maximum.reduceat(positions, starts)
        # All of one size: whole columns of corners at once, many times as fast.
        corners = [positions[k :: sizes[0]] for k in range(sizes[0])]
        return functools.reduce(np.minimum, corners), functools.reduce(np.maximum, corners)

    def usable_pins(self) -> np.ndarray:
        """Return which corners of the selected faces are pinned at a finite position, (C,) bool."""
        if self.uv is None or self.pinned_corners is None or not self.pinned_corners.any():
            return np.zeros(len(self.corner_vertices), dtype=bool)
        return self.pinned_corners & np.isfinite(self.uv).all(axis=1) & self.selected_faces[self.face_of_corner()]

    @property
    def has_usable_pins(self) -> bool:
        """Whether any of `usable_pins` is there."""
        return self.pinned_corners is not None and bool(self.pinned_corners.any() and self.usable_pins().any())

    def isotropic_uv(self) -> np.ndarray | None:
        """Return `uv` in coordinates in which a square of the image is a square and areas are those of `uv`.

        For a square image this is `uv` itself.
        """
        return self.uv if self.uv is None or self.aspect == 1.0 else self.uv * self._isotropy()

    def from_isotropic_uv(self, uv: np.ndarray) -> np.ndarray:
        """Return the coordinates for the image, given those that `isotropic_uv` speaks of, both (C, 2).

        For a square image these are `uv` itself.
        """
        return uv if self.aspect == 1.0 else uv / self._isotropy()

    def _isotropy(self) -> np.ndarray:
        return np.array([self.aspect**0.5, self.aspect**-0.5])

    def equals(self, other: "PolygonMesh") -> bool:
        """Return whether everything is the same; NaN equals NaN."""
        pairs = ((getattr(self, field.name), getattr(other, field.name)) for field in fields(self))
        return all(
            np.array_equal(mine, yours, equal_nan=np.asarray(mine).dtype.kind == "f" and yours is not None)
            for mine, yours in pairs
        )


def next_corner(face_offsets: np.ndarray) -> np.ndarray:
    """Return the corner that follows every corner in its face, (C,) intp, of faces without gaps between them."""
    following = np.arange(1, face_offsets[-1] + 1)
    following[face_offsets[1:] - 1] = face_offsets[:-1]
    return following
