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
    """Options of `spectral_conformal.unwrap`, by the names and values it documents, as far as nothing else is said."""

    method: str = "spectral"
    weights: str = "uniform"
    boundary: str = "length"
    fill_holes: bool = False
    soft_pins: float = 0.0
    hole_rigidity: float = 0.0
    area_blend: float = 0.0
    fold_free: bool = False
    stretch: float = 1.0
    """How much longer the map is along `PolygonMesh.stretch_direction` than across it, where the mesh has one."""


@dataclass(frozen=True)
class Solution:
    """What the solver made of one mesh with F faces and C corners.

    Attributes:
        uv: (C, 2) float64, meaningful where `chart_of_corner` is not -1.
        chart_of_corner: (C,) intp, index into `charts` of the solved chart; -1 where the map must not change.
        charts: one record per chart, solved or failed, as `spectral_conformal.unwrap` returns them.
        failed_faces: (F,) bool, the faces of failed charts.
        error: why the whole mesh was refused; empty if it was not.
        unused_extenders: number of the mesh's extenders that no solved chart could use.
    """

    uv: np.ndarray
    chart_of_corner: np.ndarray
    charts: Sequence[Any]
    failed_faces: np.ndarray
    error: str = ""
    unused_extenders: int = 0

    @property
    def solved_corners(self) -> np.ndarray:
        """(C,) bool, the corners that get new coordinates."""
        return self.chart_of_corner >= 0

    def too_small_faces(self, mesh: PolygonMesh) -> int:
        """Return how many solved faces shrink so far in their chart that Blender's single precision merges them.

        A UV near 1 has steps of 2^-24; a face of less than eight has no shape. Faces that are as small in 3D do not
        count.
        """
        starts = mesh.face_offsets[:-1]
        solved = np.flatnonzero(self.solved_corners[starts])
        if not len(solved):
            return 0
        chart = self.chart_of_corner[starts[solved]]
        image = _part_of_chart(self.uv, starts, solved, chart)
        original = _part_of_chart(mesh.vertices[mesh.corner_vertices], starts, solved, chart)
        return int(np.count_nonzero((image < 2.0**-21) & (image < original / 16)))

    @property
    def pinned_corners(self) -> np.ndarray:
        """(C,) bool, the corners of solved charts with pins: these charts lie where they must."""
        pinned = np.array([chart.n_pins > 0 for chart in self.charts] + [False])
        return pinned[self.chart_of_corner]


def _part_of_chart(positions: np.ndarray, starts: np.ndarray, faces: np.ndarray, chart: np.ndarray) -> np.ndarray:
    """Return the extent of `faces` as parts of their chart's; `positions` (C, n) of the corners, `starts` (F,)."""
    low, high = (extreme.reduceat(positions, starts)[faces] for extreme in (np.minimum, np.maximum))
    chart_low = np.full((chart.max() + 1, positions.shape[1]), np.inf)
    chart_high = -chart_low
    np.minimum.at(chart_low, chart, low)
    np.maximum.at(chart_high, chart, high)
    return (high - low).max(axis=1) / (chart_high - chart_low).max(axis=1)[chart]


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
            **forces(mesh, options),
            **arguments(mesh, options),
            progress=progress,
        )
    except ValueError as error:
        corners = len(mesh.corner_vertices)
        return Solution(np.zeros((corners, 2)), np.full(corners, -1), (), mesh.selected_faces, str(error))
    chart_of_corner = result.chart_of_face[mesh.face_of_corner()]
    failed = np.array([chart.status != "solved" for chart in result.charts] + [False])
    return Solution(
        result.uv,
        np.where(result.solved_corners, chart_of_corner, -1),
        result.charts,
        failed[result.chart_of_face],
        unused_extenders=_count_unused(mesh, result.unused_extenders),
    )


def arguments(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the keyword arguments that `spectral_conformal.unwrap` and `Unwrapper` share."""
    stretched = mesh.stretch_direction is not None and options.stretch != 1.0
    return {
        "seam_edges": mesh.seam_edges,
        "selected_faces": mesh.selected_faces,
        "method": options.method,
        "weights": options.weights,
        "boundary": options.boundary,
        "fill_holes": options.fill_holes,
        "area_blend": options.area_blend,
        "fold_free": options.fold_free,
        "metric": _stretched_space(mesh, options.stretch) if stretched else None,
        **_pins(mesh, options),
    }


def forces(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the keyword arguments that `spectral_conformal.unwrap` shares with `Unwrapper.solve`."""
    # Only the spectral method has a form that forces could change.
    if options.method != "spectral":
        return {}
    return {"extenders": mesh.extenders, "hole_rigidity": options.hole_rigidity}


def _count_unused(mesh: PolygonMesh, unused: np.ndarray) -> int:
    """Count the unused extenders of which a vertex is being unwrapped: the others were not meant."""
    if not unused.any():
        return 0
    unwrapped = np.zeros(len(mesh.vertices), dtype=bool)
    unwrapped[mesh.corner_vertices[mesh.selected_faces[mesh.face_of_corner()]]] = True
    ends = np.array([(i, j) for i, j, _ in mesh.extenders])
    return int(np.count_nonzero(unused & unwrapped[ends].any(axis=1)))


def _stretched_space(mesh: PolygonMesh, stretch: float) -> np.ndarray:
    """Return the metric of the mesh as it would be, stretched in space along its direction, (F, 3, 3) float64.

    Unlike a direction projected to every face, it fades where faces lean away from the direction.
    """
    metric = np.eye(3) + (stretch**2 - 1.0) * np.outer(mesh.stretch_direction, mesh.stretch_direction)
    return np.broadcast_to(metric, (len(mesh.selected_faces), 3, 3))


def _pins(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the arguments of `spectral_conformal.unwrap` that say where the pins are; none without pins."""
    pinned = _usable_pins(mesh)
    if not pinned.any():
        return {}
    return {"corner_uv": mesh.isotropic_uv(), "pinned_corners": pinned, "soft_pins": options.soft_pins}


def _usable_pins(mesh: PolygonMesh) -> np.ndarray:
    """Return which corners of the selected faces are pinned at a place that is one, (C,) bool."""
    if mesh.uv is None or mesh.pinned_corners is None:
        return np.zeros(len(mesh.corner_vertices), dtype=bool)
    return mesh.pinned_corners & np.isfinite(mesh.uv).all(axis=1) & mesh.selected_faces[mesh.face_of_corner()]


def solve_all(meshes: Sequence[PolygonMesh], options: Options, progress: Progress | None = None) -> list[Solution]:
    """`solve` every mesh; `progress` gets the fraction done of all of them, each counted by its selected faces."""
    return [solve(mesh, options, part) for mesh, part in zip(meshes, parts(meshes, progress))]


def parts(meshes: Sequence[PolygonMesh], progress: Progress | None) -> list[Progress | None]:
    """Return the progress function of each mesh, all together making `progress`; None for each where that is None."""
    if progress is None:
        return [None] * len(meshes)
    sizes = np.array([max(1, np.count_nonzero(mesh.selected_faces)) for mesh in meshes], dtype=np.float64)
    ends = np.cumsum(sizes) / sizes.sum()
    return [_part(progress, end - size, size) for end, size in zip(ends.tolist(), (sizes / sizes.sum()).tolist())]


def _part(progress: Progress, start: float, length: float) -> Progress:
    """Return the progress function of the part of the work that begins at `start` and has the given `length`."""
    return lambda fraction, phase: progress(start + length * fraction, phase)


def _single_pins_at_former_area(mesh: PolygonMesh, solution: Solution) -> np.ndarray:
    """Return the solution's map, (C, 2) float64, with charts that have one pin scaled about it to their former area."""
    single = np.array([chart.n_pins == 1 for chart in solution.charts] + [False])
    chart = np.where(single[solution.chart_of_corner], solution.chart_of_corner, -1)
    if (chart < 0).all():
        return np.array(solution.uv, dtype=np.float64)
    return placement.to_former_area(solution.uv, mesh.isotropic_uv(), chart, _usable_pins(mesh), mesh.face_offsets)


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

    Charts with pins stay where the solver put them; one with a single pin is scaled about it to its former area. With
    `keep_in_place` every other chart goes into the bounding box that it had in `PolygonMesh.uv`. Otherwise, and for
    charts without a former extent, the charts stand side by side in the unit square, to a common scale.
    """
    corner_counts = [len(mesh.corner_vertices) for mesh in meshes]
    chart_counts = [len(solution.charts) for solution in solutions]
    first_chart = np.concatenate([[0], np.cumsum(chart_counts)])
    uv = np.concatenate([_single_pins_at_former_area(mesh, solution) for mesh, solution in zip(meshes, solutions)])
    chart = np.concatenate(
        [
            np.where(solution.solved_corners, solution.chart_of_corner + first, -1)
            for solution, first in zip(solutions, first_chart)
        ]
    )
    former = np.concatenate(
        [np.zeros((count, 2)) if mesh.uv is None else mesh.isotropic_uv() for mesh, count in zip(meshes, corner_counts)]
    )
    chart = np.where(np.concatenate([solution.pinned_corners for solution in solutions]), -1, chart)
    without_bounds = 0
    if keep_in_place:
        uv, kept = placement.into_former_bounds(uv, former, chart)
        without_bounds = len(np.unique(chart[~kept & (chart >= 0)]))
        chart = np.where(kept, -1, chart)
    uv = placement.side_by_side(uv, chart)
    placed = np.split(uv, np.cumsum(corner_counts)[:-1])
    return Placement([mesh.from_isotropic_uv(part) for mesh, part in zip(meshes, placed)], without_bounds)
