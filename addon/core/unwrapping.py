# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the charts of polygon meshes and place them in the UV plane, without packing."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import native, placement
from .polygon_mesh import PolygonMesh

Progress = Callable[[float, str], "bool | None"]


@dataclass(frozen=True)
class Options:
    """Options of `spectral_conformal.unwrap`, by the names and values it documents."""

    method: str = "spectral"
    weights: str = "uniform"
    boundary: str = "length"


@dataclass(frozen=True)
class Solution:
    """What the solver made of one mesh with F faces and C corners.

    Attributes:
        uv: (C, 2) float64, meaningful where `chart_of_corner` is not -1.
        chart_of_corner: (C,) intp, index into `charts` of the solved chart; -1 where the map must not change.
        charts: one record per chart, solved or failed, as `spectral_conformal.unwrap` returns them.
        error: why the whole mesh was refused; empty if it was not.
    """

    uv: np.ndarray
    chart_of_corner: np.ndarray
    charts: Sequence[Any]
    error: str = ""

    @property
    def solved_corners(self) -> np.ndarray:
        """(C,) bool, the corners that get new coordinates."""
        return self.chart_of_corner >= 0


def solve(mesh: PolygonMesh, options: Options, progress: Progress | None = None) -> Solution:
    """Unwrap the selected faces of `mesh`, chart by chart.

    A mesh that the solver refuses as a whole comes back as a `Solution` with an `error` and no charts, so that the
    other meshes of the same call can still be unwrapped.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    module = native.spectral_conformal()
    try:
        result = module.unwrap(
            mesh.vertices,
            mesh.face_offsets,
            mesh.corner_vertices,
            seam_edges=mesh.seam_edges,
            selected_faces=mesh.selected_faces,
            method=options.method,
            weights=options.weights,
            boundary=options.boundary,
            progress=progress,
        )
    except ValueError as error:
        corners = len(mesh.corner_vertices)
        return Solution(np.zeros((corners, 2)), np.full(corners, -1), (), str(error))
    chart_of_corner = result.chart_of_face[mesh.face_of_corner()]
    return Solution(result.uv, np.where(result.solved_corners, chart_of_corner, -1), result.charts)


def solve_all(meshes: Sequence[PolygonMesh], options: Options, progress: Progress | None = None) -> list[Solution]:
    """`solve` every mesh; `progress` gets the fraction done of all of them, each counted by its selected faces."""
    sizes = np.array([max(1, np.count_nonzero(mesh.selected_faces)) for mesh in meshes], dtype=np.float64)
    ends = np.cumsum(sizes) / sizes.sum()
    return [
        solve(mesh, options, progress and _part(progress, end - size, size))
        for mesh, end, size in zip(meshes, ends.tolist(), (sizes / sizes.sum()).tolist())
    ]


def _part(progress: Progress, start: float, length: float) -> Progress:
    """Return the progress function of the part of the work that begins at `start` and has the given `length`."""
    return lambda fraction, phase: progress(start + length * fraction, phase)


@dataclass(frozen=True)
class Placement:
    """The maps of all meshes, placed together.

    Attributes:
        uv: one (C, 2) float64 array per mesh, meaningful at its solved corners.
        without_bounds: number of charts that could not be kept in place because they had no extent before.
    """

    uv: list[np.ndarray]
    without_bounds: int = 0


def place(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution], keep_in_place: bool) -> Placement:
    """Place the solved charts of all meshes in one UV plane.

    With `keep_in_place` every chart goes into the bounding box that it had in `PolygonMesh.uv`. Otherwise, and for
    charts without a former extent, the charts stand side by side in the unit square, to a common scale.
    """
    corner_counts = [len(mesh.corner_vertices) for mesh in meshes]
    chart_counts = [len(solution.charts) for solution in solutions]
    first_chart = np.concatenate([[0], np.cumsum(chart_counts)])
    uv = np.concatenate([solution.uv for solution in solutions]).astype(np.float64)
    chart = np.concatenate(
        [
            np.where(solution.solved_corners, solution.chart_of_corner + first, -1)
            for solution, first in zip(solutions, first_chart)
        ]
    )
    without_bounds = 0
    if keep_in_place:
        former = np.concatenate(
            [np.zeros((count, 2)) if mesh.uv is None else mesh.uv for mesh, count in zip(meshes, corner_counts)]
        )
        uv, kept = placement.into_former_bounds(uv, former, chart)
        without_bounds = len(np.unique(chart[~kept & (chart >= 0)]))
        chart = np.where(kept, -1, chart)
    uv = placement.side_by_side(uv, chart)
    return Placement(np.split(uv, np.cumsum(corner_counts)[:-1]), without_bounds)
