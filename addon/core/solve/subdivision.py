# SPDX-License-Identifier: GPL-3.0-or-later
"""A subdivided mesh that is solved instead of its coarse mesh."""

from dataclasses import dataclass, replace

import numpy as np

from ..mesh.polygon_mesh import PolygonMesh
from .chart_records import PartOfCharts
from .solution import Solution, find_too_small_faces


@dataclass(frozen=True)
class Subdivision:
    """A subdivided mesh, and the C corners of its coarse mesh in it.

    Attributes:
        coarse: the mesh that was subdivided.
        mesh: the subdivided mesh, with the coarse mesh's selection, map and pins.
        face_of_face: (G,) intp, the coarse face of every face of `mesh`.
        corner_of_corner: (C,) intp, the corner of `mesh` at every coarse corner.
    """

    coarse: PolygonMesh
    mesh: PolygonMesh
    face_of_face: np.ndarray
    corner_of_corner: np.ndarray

    def holding(self, coarse: PolygonMesh) -> PolygonMesh:
        """Return `mesh` with the same axes held as in `coarse`, at its corners; only they may differ in `coarse`."""
        if coarse.held_axis is None:
            return self.mesh
        held_axis = np.full(len(self.mesh.corner_vertices), -1, dtype=np.int8)
        held_axis[self.corner_of_corner] = coarse.held_axis
        mirrored = _of_faces(coarse, self.mesh, self.face_of_face)
        return replace(self.mesh, held_axis=held_axis, mirrored_corners=mirrored)

    def on_coarse(self, solution: Solution) -> Solution:
        """Convert a solution of `mesh` to one of the coarse mesh."""
        chart = solution.chart_of_corner[self.corner_of_corner]
        whole = np.logical_and.reduceat(chart >= 0, self.coarse.face_offsets[:-1])
        failed = np.full(len(whole), -1)
        failed[self.face_of_face[solution.failed_faces]] = solution.failed_islands[solution.failed_faces]
        uv, chart = solution.uv[self.corner_of_corner], np.where(whole[self.coarse.face_of_corner()], chart, -1)
        return replace(
            solution,
            uv=uv,
            chart_of_corner=chart,
            charts=PartOfCharts(solution.charts, face_of_face=self.face_of_face),
            failed_islands=failed,
            too_small_faces=len(find_too_small_faces(self.coarse, uv, chart)),
            chart_extents=None,
        )


def _of_faces(coarse: PolygonMesh, subdivided: PolygonMesh, face_of_face: np.ndarray) -> np.ndarray | None:
    """Return the mirrored corners of the subdivided mesh: islands are mirrored as a whole, so one corner decides."""
    if coarse.mirrored_corners is None:
        return None
    return coarse.mirrored_corners[coarse.face_offsets[:-1]][face_of_face][subdivided.face_of_corner()]


def subdivision(coarse: PolygonMesh, subdivided: PolygonMesh, face_of_face: np.ndarray) -> Subdivision:
    """Find the corners of `coarse` in `subdivided`, and copy the selection, the map and the pins.

    The vertices of `coarse` come first in `subdivided`, in the same order; `face_of_face` is as in `Subdivision`.
    """
    face_of_corner = face_of_face[subdivided.face_of_corner()].astype(np.int64)
    vertices = len(coarse.vertices)
    at_vertex = np.flatnonzero(subdivided.corner_vertices < vertices)
    key = face_of_corner[at_vertex] * vertices + subdivided.corner_vertices[at_vertex]
    order = np.argsort(key)
    coarse_key = coarse.face_of_corner() * vertices + coarse.corner_vertices
    corner = at_vertex[order][np.searchsorted(key[order], coarse_key)]

    def carried(values: np.ndarray | None) -> np.ndarray | None:
        if values is None:
            return None
        result = np.zeros((len(subdivided.corner_vertices), *values.shape[1:]), dtype=values.dtype)
        result[corner] = values
        return result

    equations = None
    if coarse.equations is not None:
        equations = coarse.equations.copy()
        coordinate = equations[..., 0].astype(np.int64)
        equations[..., 0] = 2 * corner[coordinate // 2] + coordinate % 2
    mesh = replace(
        subdivided,
        selected_faces=coarse.selected_faces[face_of_face],
        uv=carried(coarse.uv),
        pinned_corners=carried(coarse.pinned_corners),
        held_corners=carried(coarse.held_corners),
        mirrored_corners=_of_faces(coarse, subdivided, face_of_face),
        aspect=coarse.aspect,
        extenders=coarse.extenders,
        equations=equations,
        stretch_direction=coarse.stretch_direction,
    )
    return Subdivision(coarse, mesh, face_of_face, corner)
