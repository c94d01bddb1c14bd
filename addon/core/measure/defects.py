# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of the UV maps of several meshes that lie the wrong way round or on others."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh


@dataclass(frozen=True)
class Defects:
    """The defects of one mesh with F faces, each (F,) bool and False for faces that are not selected.

    Attributes:
        flipped: as `spectral_conformal.map_defects` documents.
        overlapping: as there.
        not_finite: a UV of the face is infinite or not a number; it is neither of the others.
    """

    flipped: np.ndarray
    overlapping: np.ndarray
    not_finite: np.ndarray

    def chosen(self, flipped: bool, overlapping: bool) -> np.ndarray:
        """Return the faces with the chosen kinds of defects, (F,) bool. Those without finite UVs are always there."""
        faces = self.not_finite.copy()
        if flipped:
            faces |= self.flipped
        if overlapping:
            faces |= self.overlapping
        return faces


def find(meshes: Sequence[PolygonMesh], between_islands: bool) -> list[Defects]:
    """Look for defects in `PolygonMesh.uv`, which must be there, among the selected faces of all meshes.

    Islands are parts of one mesh; with `between_islands` they overlap those of the other meshes too.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    not_finite = [mesh.selected_faces & _has_corner(mesh, ~np.isfinite(mesh.uv).all(axis=1)) for mesh in meshes]
    face_counts = [len(mesh.selected_faces) for mesh in meshes]
    corner_counts = [len(mesh.corner_vertices) for mesh in meshes]
    first_corner = np.concatenate([[0], np.cumsum(corner_counts)])
    first_vertex = np.concatenate([[0], np.cumsum([len(mesh.vertices) for mesh in meshes])])
    found = native.spectral_conformal().map_defects(
        np.concatenate([[0], *(mesh.face_offsets[1:] + first for mesh, first in zip(meshes, first_corner))]),
        np.concatenate([mesh.corner_vertices + first for mesh, first in zip(meshes, first_vertex)]),
        np.concatenate([mesh.uv for mesh in meshes]),
        selected_faces=np.concatenate([mesh.selected_faces & ~bad for mesh, bad in zip(meshes, not_finite)]),
        between_islands=between_islands,
    )
    ends = np.cumsum(face_counts)[:-1]
    parts = zip(np.split(found.flipped, ends), np.split(found.overlapping, ends), not_finite)
    return [Defects(*part) for part in parts]


def _has_corner(mesh: PolygonMesh, corners: np.ndarray) -> np.ndarray:
    """Return which faces have one of the `corners` (C,) bool, (F,) bool."""
    has = np.zeros(len(mesh.selected_faces), dtype=bool)
    has[mesh.face_of_corner()[corners]] = True
    return has
