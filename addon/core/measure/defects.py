# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of the UV maps of several meshes, and the faces that are flipped or overlap others."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from ..solve.joined import joined


@dataclass(frozen=True)
class Defects:
    """The defects of one mesh with F faces; False, or -1, for faces that are not selected.

    Attributes:
        flipped: (F,) bool, as `spectral_conformal.map_defects` documents.
        overlapping: (F,) bool, as there.
        not_finite: (F,) bool, a UV of the face is infinite or not a number; it is neither of the others.
        island_of_face: (F,) int32, counted over all meshes; -1 also for faces that are `not_finite`.
    """

    flipped: np.ndarray
    overlapping: np.ndarray
    not_finite: np.ndarray
    island_of_face: np.ndarray

    def chosen(self, flipped: bool, overlapping: bool) -> np.ndarray:
        """Return the faces with the chosen kinds of defects, (F,) bool; those without finite UVs in any case."""
        faces = self.not_finite.copy()
        if flipped:
            faces |= self.flipped
        if overlapping:
            faces |= self.overlapping
        return faces


def find(meshes: Sequence[PolygonMesh], between_islands: bool) -> list[Defects]:
    """Find the defects of the selected faces of all meshes, which must have a UV map.

    An island is part of one mesh; with `between_islands` it may overlap those of other meshes.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if not meshes:
        return []
    not_finite = [mesh.selected_faces & mesh.faces_with(~np.isfinite(mesh.uv).all(axis=1)) for mesh in meshes]
    whole = joined(meshes)
    found = native.spectral_conformal().map_defects(
        whole.with_map(np.concatenate([mesh.uv for mesh in meshes])),
        selected_faces=whole.selected_faces & ~np.concatenate(not_finite),
        between_islands=between_islands,
    )
    ends = np.cumsum([len(mesh.selected_faces) for mesh in meshes])[:-1]
    flipped, overlapping, islands = (
        np.split(array, ends) for array in (found.flipped, found.overlapping, found.island_of_face)
    )
    return [Defects(*parts) for parts in zip(flipped, overlapping, not_finite, islands)]


def chosen_islands(meshes: Sequence[PolygonMesh], chosen: Sequence[np.ndarray]) -> tuple[list[np.ndarray], int]:
    """Number the islands that have a `chosen` face, (F,) bool for each mesh, over all meshes.

    Returns the number of every face, (F,) int for each mesh, -1 for faces of others, and how many there are.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    islands = [found.island_of_face for found in find(meshes, between_islands=False)]
    wanted = np.unique(np.concatenate([island[faces & (island >= 0)] for island, faces in zip(islands, chosen)]))
    # The last entry is that of faces in no island.
    number = np.full(max((int(island.max(initial=-1)) for island in islands), default=-1) + 2, -1)
    number[wanted] = np.arange(len(wanted))
    return [number[island] for island in islands], len(wanted)
