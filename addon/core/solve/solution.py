# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the charts of polygon meshes; runs in the thread of a job."""

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from ..words import texts
from .chart_records import ChartsOfAll, column
from .joined import joined
from .joined import parts as joined_parts
from .options import Options
from .progress import Progress, parts

# Small meshes are joined up to a million quads; more would gain nothing and take memory.
_MAX_JOINED_CORNERS = 4_000_000
# Of a chart's map: its bounding box and its area.
_EXTENT = ("low_u", "low_v", "high_u", "high_v", "image_area")
# Options that the module takes as they are.
_SHARED_OPTIONS = ("method", "weights", "boundary", "fill_holes", "area_blend", "fold_free", "polish")
# Why constraints reject charts, and how many vertices the step names.
_CONTRADICTIONS = {"constraints_join_vertices": 2, "constraints_flatten_triangle": 3}


@dataclass(frozen=True)
class Solution:
    """What the solver made of one mesh with F faces and C corners.

    Attributes:
        uv: (C, 2) float64, meaningful where `chart_of_corner` is not -1.
        chart_of_corner: (C,) intp, index into `charts` of the solved chart; -1 where the map must not change.
        charts: one record per chart, solved or failed, as `spectral_conformal.unwrap` returns them. They are made on
            access; `column` returns one field of all.
        failed_islands: (F,) intp, the failed chart of every face, -1 for the others; one chart if the mesh is refused.
        too_small_faces: number of faces that `find_too_small_faces` finds.
        unused_extenders: number of the mesh's extenders that no solved chart could use.
        error: why the whole mesh was refused; empty if it was not.
        chart_extents: (K, 5) float64 for K charts: low u, low v, high u, high v of the bounding box in `uv`, and the
            area there, NaN for failed ones; None where `uv` is not the solver's map itself.
    """

    uv: np.ndarray
    chart_of_corner: np.ndarray
    charts: Sequence[Any]
    failed_islands: np.ndarray
    too_small_faces: int = 0
    unused_extenders: int = 0
    error: str = ""
    chart_extents: np.ndarray | None = None

    @functools.cached_property
    def failed_faces(self) -> np.ndarray:
        """(F,) bool, the faces of failed charts."""
        return self.failed_islands >= 0

    @functools.cached_property
    def solved_corners(self) -> np.ndarray:
        """(C,) bool, the corners that get new coordinates."""
        return self.chart_of_corner >= 0

    @functools.cached_property
    def pinned_corners(self) -> np.ndarray:
        """(C,) bool, the corners of solved charts with pins, which are not moved."""
        pinned = self.column("n_pins") > 0
        if not pinned.any():
            return np.zeros(len(self.chart_of_corner), dtype=bool)
        return np.append(pinned, False)[self.chart_of_corner]

    def contradicting_edges(self) -> list[tuple[int, int]]:
        """Return, sorted and by their vertices, the edges at which constraints contradict each other in failed charts.

        These are edges left without extent and the sides of triangles left without area.
        """
        found: set[tuple[int, int]] = set()
        charts = self.failed_islands[self.failed_islands >= 0] if len(self.charts) else self.failed_islands[:0]
        for step in (step for chart in np.unique(charts).tolist() for step in self.charts[chart].steps):
            if step.reason in _CONTRADICTIONS:
                vertices = [step.count, step.index, step.limit][: _CONTRADICTIONS[step.reason]]
                found |= {(min(ends), max(ends)) for ends in itertools.combinations(vertices, 2)}
        return sorted(found)

    def column(self, name: str) -> np.ndarray:
        """Return one field of all charts, (number of charts,), without a record for each."""
        return column(self.charts, name)


def charts_of(solutions: Sequence[Solution]) -> ChartsOfAll:
    """Return the charts of all solutions, for their columns."""
    return ChartsOfAll(solution.charts for solution in solutions)


def find_too_small_faces(mesh: PolygonMesh, uv: np.ndarray, chart_of_corner: np.ndarray) -> np.ndarray:
    """Return the solved faces that are so small in their chart that Blender's single precision merges them, (N,) intp.

    A UV near 1 has steps of 2^-24; a face smaller than eight of them has no shape. Faces as small in 3D do not count.
    The arrays, (C, 2) and (C,), are those of a `Solution`.
    """
    chart = chart_of_corner[mesh.face_offsets[:-1]]
    order = np.arange(len(chart))
    if (chart[1:] < chart[:-1]).any() or (chart[:1] < 0).any():
        order = np.argsort(chart, kind="stable")[np.count_nonzero(chart < 0) :]
    if not len(order):
        return order
    # A chart without extent gives NaN, and comparisons with it are false.
    with np.errstate(invalid="ignore"):
        image = _part_of_chart(uv, mesh, chart, order)
    small = image < 2.0**-21
    if small.any():
        small &= image < _part_of_chart(mesh.vertices[mesh.corner_vertices], mesh, chart, order) / 16
    return order[small]


def _part_of_chart(positions: np.ndarray, mesh: PolygonMesh, chart: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Return the extents of faces relative to those of their charts, (len(order),), given corner `positions` (C, n).

    `order` are the faces of charts, sorted by their `chart` (F,).
    """
    low, high = (np.ascontiguousarray(bound.T) for bound in mesh.face_bounds(positions))
    if len(order) < len(chart) or chart[order[0]] != chart[0] or (chart[1:] < chart[:-1]).any():
        low, high, chart = low.take(order, axis=1), high.take(order, axis=1), chart.take(order)
    if chart[0] == chart[-1]:
        return (high - low).max(axis=0) / (high.max(axis=1) - low.min(axis=1)).max()
    starts = np.flatnonzero(np.diff(chart, prepend=-1))
    size = np.maximum.reduceat(high, starts, axis=1) - np.minimum.reduceat(low, starts, axis=1)
    return (high - low).max(axis=0) / np.repeat(size.max(axis=0), np.diff(starts, append=len(chart)))


def solve(
    mesh: PolygonMesh,
    options: Options,
    progress: Progress | None = None,
    kept: Any = None,  # noqa: ANN401 - a KeptMaps of the native module
) -> Solution:
    """Unwrap the selected faces of `mesh`, chart by chart; charts whose maps are `kept` are not solved again.

    A mesh that the solver refuses gives a `Solution` with an `error` and no charts, so that the other meshes of the
    call are still unwrapped.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    try:
        result = _unwrap(mesh, options, progress, kept)
    except ValueError as error:
        return _refused(mesh, str(error))
    return _solutions([mesh], mesh, result)[0]


def _refused(mesh: PolygonMesh, message: str) -> Solution:
    corners = len(mesh.corner_vertices)
    failed_islands = np.where(mesh.selected_faces, 0, -1)
    return Solution(np.zeros((corners, 2)), np.full(corners, -1), (), failed_islands, error=message)


def _unwrap(mesh: PolygonMesh, options: Options, progress: Progress | None, kept: Any) -> Any:  # noqa: ANN401 - of the module
    return native.spectral_conformal().unwrap(
        **soft_constraints(mesh, options),
        **arguments(mesh, options),
        straighten="auto" if options.straighten else 0.0,
        progress=progress,
        kept_maps=kept,
    )


def _solutions(
    meshes: Sequence[PolygonMesh],
    whole: PolygonMesh,
    result: Any,  # noqa: ANN401 - of the native module
) -> list[Solution]:
    """Split the result for the `whole`, all `meshes` in one, into a solution of each; `result` is changed."""
    chart_of_corner = np.repeat(result.chart_of_face, np.diff(whole.face_offsets))
    chart_of_corner[~result.solved_corners] = -1
    failed = np.append(column(result.charts, "status") != "solved", False)
    failed_islands = np.where(failed[result.chart_of_face], result.chart_of_face, -1)
    too_small = find_too_small_faces(whole, result.uv, chart_of_corner)
    extents = np.stack([column(result.charts, name) for name in _EXTENT], axis=1)
    if len(meshes) == 1:
        unused = _count_unused(whole, result.unused_extenders)
        uv = unmirrored(whole, result.uv)
        known = extents if uv is result.uv else None
        return [Solution(uv, chart_of_corner, result.charts, failed_islands, len(too_small), unused, "", known)]
    # Joined meshes have no extenders.
    parts = joined_parts(meshes, result, chart_of_corner, failed_islands, too_small, extents)
    return [Solution(*part[:-1], chart_extents=part[-1]) for part in parts]


def arguments(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the keyword arguments that `spectral_conformal.unwrap` and `Unwrapper` share."""
    has_pins = mesh.has_usable_pins
    return {
        "mesh": mesh.with_map(unmirrored(mesh, mesh.isotropic_uv()) if has_pins else None),
        "seam_edges": mesh.seam_edges,
        "selected_faces": mesh.selected_faces,
        **{name: getattr(options, name) for name in _SHARED_OPTIONS},
        "metric": _stretched_space(mesh, options.stretch) if _is_stretched(mesh, options) else None,
        **(_pins(mesh, options) if has_pins else {}),
        **constraints(mesh),
    }


def soft_constraints(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the keyword arguments that `spectral_conformal.unwrap` shares with `Unwrapper.solve`."""
    # Only the spectral method has soft constraints.
    if options.method != "spectral":
        return {}
    return {"extenders": mesh.extenders, "hole_rigidity": options.hole_rigidity}


def _count_unused(mesh: PolygonMesh, unused: np.ndarray) -> int:
    """Count the unused extenders with an unwrapped vertex; the others do not concern this unwrap."""
    if not unused.any():
        return 0
    unwrapped = np.zeros(len(mesh.vertices), dtype=bool)
    unwrapped[mesh.corner_vertices[mesh.selected_faces[mesh.face_of_corner()]]] = True
    ends = np.array([extender[:2] for extender in mesh.extenders])
    return int(np.count_nonzero(unused & unwrapped[ends].any(axis=1)))


def _is_stretched(mesh: PolygonMesh, options: Options) -> bool:
    return mesh.stretch_direction is not None and options.stretch != 1.0


def _stretched_space(mesh: PolygonMesh, stretch: float) -> np.ndarray:
    """Return the metric of the mesh stretched in space along its direction, (F, 3, 3) float64.

    Unlike a direction projected onto every face, it fades where faces lean away from the direction.
    """
    metric = np.eye(3) + (stretch**2 - 1.0) * np.outer(mesh.stretch_direction, mesh.stretch_direction)
    return np.broadcast_to(metric, (len(mesh.selected_faces), 3, 3))


def constraints(mesh: PolygonMesh) -> dict[str, Any]:
    """Return the argument of `spectral_conformal.unwrap` for constraints; none without them."""
    held = None
    if mesh.held_axis is not None:
        corners = np.flatnonzero(mesh.held_axis >= 0)
        axis = mesh.held_axis[corners]
        held = np.column_stack([2 * corners + axis, unmirrored(mesh, mesh.isotropic_uv())[corners, axis]])
    if mesh.equations is None and held is None:
        return {}
    return {"constraints": native.spectral_conformal().Constraints(equations=mesh.equations, held=held, of="corners")}


def _pins(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the arguments of `spectral_conformal.unwrap` for the pins of a mesh that has some."""
    return {
        "fixed": mesh.usable_pins(),
        # Held corners hold exactly.
        "soft_pins": options.soft_pins if mesh.held_corners is None else 0.0,
    }


def unmirrored(mesh: PolygonMesh, uv: np.ndarray) -> np.ndarray:
    """Return `uv` (C, 2) with mirrored islands mirrored back: from and to the solver's orientation."""
    if mesh.mirrored_corners is None or not mesh.mirrored_corners.any():
        return uv
    return np.where(mesh.mirrored_corners[:, None], uv * (-1.0, 1.0), uv)


def solve_all(
    meshes: Sequence[PolygonMesh],
    options: Options,
    progress: Progress | None = None,
    kept: Any = None,  # noqa: ANN401 - as in solve
) -> list[Solution]:
    """`solve` every mesh; `progress` gets the fraction done of all of them, each counted by its selected faces.

    Raises:
        MemoryError: there is too little memory for all of them. If there is enough for some, the others are refused.
    """
    groups = _groups(meshes, options)
    solved = [_solve_group(group, options, part, kept) for group, part in zip(groups, parts(groups, progress))]
    solutions = [solution for group in solved for solution in group]
    if solutions and not any(solutions):
        raise MemoryError
    return [
        solution or _refused(mesh, message=texts.TOO_LITTLE_MEMORY_FOR_MESH)
        for mesh, solution in zip(meshes, solutions)
    ]


def _groups(meshes: Sequence[PolygonMesh], options: Options) -> list[list[PolygonMesh]]:
    """Return the meshes in their order, in groups that can be joined."""
    groups: list[list[PolygonMesh]] = []
    room = -1
    for mesh in meshes:
        is_alone = _is_to_be_alone(mesh, options)
        if is_alone or len(mesh.corner_vertices) > room:
            groups.append([])
            room = -1 if is_alone else _MAX_JOINED_CORNERS
        groups[-1].append(mesh)
        room -= len(mesh.corner_vertices)
    return groups


def _is_to_be_alone(mesh: PolygonMesh, options: Options) -> bool:
    """Return whether a mesh cannot be joined: it has constraints, or an error that would name a vertex by its index."""
    is_constrained = (
        bool(mesh.extenders)
        or mesh.equations is not None
        or mesh.held_axis is not None
        or mesh.has_usable_pins
        or _is_stretched(mesh, options)
    )
    return is_constrained or not np.isfinite(mesh.vertices).all()


def _solve_group(
    group: Sequence[PolygonMesh],
    options: Options,
    progress: Progress | None,
    kept: Any,  # noqa: ANN401 - as in solve
) -> list[Solution | None]:
    """Return the solution of every mesh of a `group`, None where there is too little memory."""
    if len(group) > 1:
        try:
            whole = joined(group)
            result = _unwrap(whole, options, progress, kept)
        except (ValueError, MemoryError):
            # One of them is refused or too large; the others are solved alone.
            pass
        else:
            return _solutions(group, whole, result)
    each = [progress] if len(group) == 1 else parts([[mesh] for mesh in group], progress)
    return [_solve_within_memory(mesh, options, part, kept) for mesh, part in zip(group, each)]


def _solve_within_memory(
    mesh: PolygonMesh,
    options: Options,
    progress: Progress | None,
    kept: Any,  # noqa: ANN401 - as in solve
) -> Solution | None:
    try:
        return solve(mesh, options, progress, kept)
    except MemoryError:
        return None
