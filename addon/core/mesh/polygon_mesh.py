# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh as arrays, in the layout that both Blender and `spectral_conformal` use."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from .. import native

# A soft force: two vertices, its strength, and that with half of the whole effect.
Force = tuple[int, int, float, float]

# Fields of the surface, and of its map.
SURFACE = ("vertices", "face_offsets", "corner_vertices", "selected_faces", "world_metric")
MAP = ("uv", "uv_faces", "aspect", "texture_sides")


@dataclass(frozen=True)
class PolygonMesh:
    """A polygon mesh with seams and a selection; V vertices, F faces, C face corners, S seam edges.

    Attributes:
        vertices: (V, 3) float64, positions in object space.
        face_offsets: (F + 1,) int32, the corners of face f are face_offsets[f] to face_offsets[f + 1] - 1.
        corner_vertices: (C,) int32, vertex of every corner.
        seam_edges: (S, 2) int32, vertex pairs.
        selected_faces: (F,) bool, the faces to unwrap, to measure or to draw.
        uv: (C, 2) float64, the active UV map; None where the mesh has none.
        pinned_corners: (C,) bool, the corners that keep their `uv`; None for none.
        aspect: width over height of the map's image.
        extenders: the soft forces between two vertices each.
        equations: (E, 4, 2) float64, which the map must meet, as `Constraints.equations` on corners; None for none.
        stretch_direction: (3,) float64, of length 1, the direction along which the map may be stretched; None for none.
        uv_faces: (F,) bool, the faces whose UVs the UV editor shows; None for all selected ones.
        world_metric: (3, 3) float64, lengths in the world (`world_scale.metric_of`); None for those of object space.
        density_factors: (F,) float32, a face's texel density over that of others; None for 1.
        texture_sides: (F,) float64, pixels along a side of every face's texture, 0 where unknown; None for all unknown.
        held_corners: (C,) bool, those of the `pinned_corners` that are held because the rest of their island stays
            (`island_parts`); None for none.
        mirrored_corners: (C,) bool, the corners of such islands that are mirrored; None for none.
        held_axis: (C,) int8, the coordinate of its `uv` that a corner keeps, 0 for u, 1 for v, -1 for none; None for
            none at all.
    """

    vertices: np.ndarray
    face_offsets: np.ndarray
    corner_vertices: np.ndarray
    seam_edges: np.ndarray
    selected_faces: np.ndarray
    uv: np.ndarray | None = None
    pinned_corners: np.ndarray | None = None
    aspect: float = 1.0
    extenders: tuple[Force, ...] = ()
    equations: np.ndarray | None = None
    stretch_direction: np.ndarray | None = None
    uv_faces: np.ndarray | None = None
    world_metric: np.ndarray | None = None
    density_factors: np.ndarray | None = None
    texture_sides: np.ndarray | None = None
    held_corners: np.ndarray | None = None
    mirrored_corners: np.ndarray | None = None
    held_axis: np.ndarray | None = None

    @functools.cached_property
    def topology(self) -> int:
        """A digest of the faces and their vertices, without positions; it differs between processes."""
        return hash((self.face_offsets.tobytes(), self.corner_vertices.tobytes()))

    def with_map(self, uv: np.ndarray | None = None) -> Any:  # noqa: ANN401 - of the native module
        """Return the `spectral_conformal.Mesh` of this mesh, with a map (C, 2) or without.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            ValueError: the arrays do not describe a mesh.
        """
        make = native.spectral_conformal().Mesh
        return make(self.vertices, self.face_offsets, uv, corner_vertices=self.corner_vertices)

    def face_of_corner(self) -> np.ndarray:
        """Return the face of every corner, (C,) intp."""
        return np.repeat(np.arange(len(self.selected_faces)), np.diff(self.face_offsets))

    def faces_with(self, corners: np.ndarray) -> np.ndarray:
        """Return which faces have one of the `corners` (C,) bool, (F,) bool."""
        has = np.zeros(len(self.selected_faces), dtype=bool)
        if corners.any():
            has[self.face_of_corner()[corners]] = True
        return has

    def next_corner(self) -> np.ndarray:
        """Return the corner that follows every corner in its face, (C,) int64.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        return native.measuring().next_corner(self.face_offsets)

    def previous_corner(self) -> np.ndarray:
        """Return the corner that precedes every corner in its face, (C,) int64; see `next_corner`."""
        following = self.next_corner()
        result = np.empty_like(following)
        result[following] = np.arange(len(following))
        return result

    def sides(self) -> np.ndarray:
        """Return the vertices of the edge from every corner to the next one of its face, (C, 2); see `next_corner`."""
        return np.stack([self.corner_vertices, self.corner_vertices[self.next_corner()]], axis=1)

    def face_bounds(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the lower and upper corners of the faces' bounding boxes, (F, n) each, of the corners (C, n)."""
        starts, sizes = self.face_offsets[:-1], np.diff(self.face_offsets)
        if not len(sizes) or (sizes != sizes[0]).any():
            return np.minimum.reduceat(positions, starts), np.maximum.reduceat(positions, starts)
        # Faces of one size: many times as fast by columns of corners.
        corners = [positions[k :: sizes[0]] for k in range(sizes[0])]
        return functools.reduce(np.minimum, corners), functools.reduce(np.maximum, corners)

    def constrained_corners(self) -> np.ndarray:
        """Return which corners the `equations` concern, (C,) bool."""
        result = np.zeros(len(self.corner_vertices), dtype=bool)
        if self.equations is not None:
            result[self.equations[self.equations[..., 1] != 0.0][:, 0].astype(int) // 2] = True
        return result

    def usable_pins(self) -> np.ndarray:
        """Return which corners of the selected faces are pinned at a finite position, (C,) bool."""
        if self.uv is None or self.pinned_corners is None or not self.pinned_corners.any():
            return np.zeros(len(self.corner_vertices), dtype=bool)
        return self.pinned_corners & np.isfinite(self.uv).all(axis=1) & self.selected_faces[self.face_of_corner()]

    @property
    def has_usable_pins(self) -> bool:
        """Whether there are `usable_pins`."""
        return self.pinned_corners is not None and bool(self.pinned_corners.any() and self.usable_pins().any())

    def isotropic_uv(self) -> np.ndarray | None:
        """Return `uv` scaled so that pixels of the image are square and areas stay; `uv` itself for a square image."""
        return self.uv if self.uv is None or self.aspect == 1.0 else self.uv * self._isotropy()

    def from_isotropic_uv(self, uv: np.ndarray) -> np.ndarray:
        """Return the coordinates for the image, given isotropic ones, both (C, 2); `uv` itself for a square image."""
        return uv if self.aspect == 1.0 else uv / self._isotropy()

    def _isotropy(self) -> np.ndarray:
        return np.array([self.aspect**0.5, self.aspect**-0.5])

    def equals(self, other: "PolygonMesh", names: Sequence[str] = ()) -> bool:
        """Return whether the fields with these `names`, or all, are the same bit by bit, so that NaN equals NaN."""
        names = names or [field.name for field in fields(self)]
        return all(_same_bits(getattr(self, name), getattr(other, name)) for name in names)


def face_areas(uv: np.ndarray, face_offsets: np.ndarray) -> np.ndarray:
    """Return the area of every face in a map, (F,) float64, negative where it is mirrored, given its `uv` (C, 2).

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    first, following = face_offsets[:-1], native.measuring().next_corner(face_offsets)
    # Relative to the face's first corner, which keeps the digits of a small face far from the origin.
    local = uv - np.repeat(uv[first], np.diff(face_offsets), axis=0)
    return np.add.reduceat(local[:, 0] * local[following, 1] - local[:, 1] * local[following, 0], first) / 2.0


def _same_bits(mine: object, yours: object) -> bool:
    if mine is yours:
        return True
    if not isinstance(mine, np.ndarray) or not isinstance(yours, np.ndarray):
        return type(mine) is type(yours) and mine == yours
    if mine.dtype == yours.dtype == np.float64:
        # A third of the time that `equal_nan` takes.
        mine, yours = mine.view(np.int64), yours.view(np.int64)
    return np.array_equal(mine, yours)
