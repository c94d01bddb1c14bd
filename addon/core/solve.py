# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the charts of polygon meshes: what runs in the thread of a job."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import native
from .joined import joined, numbered_together
from .joined import parts as joined_parts
from .mesh import PolygonMesh
from .options import Options
from .progress import Progress, parts

# Small meshes are joined up to this many corners, a million quads: more would gain nothing and take memory.
_MAX_JOINED_CORNERS = 4_000_000


@dataclass(frozen=True)
class Solution:
    """What the solver made of one mesh with F faces and C corners.

    Attributes:
        uv: (C, 2) float64, meaningful where `chart_of_corner` is not -1.
        chart_of_corner: (C,) intp, index into `charts` of the solved chart; -1 where the map must not change.
        charts: one record per chart, solved or failed, as `spectral_conformal.unwrap` returns them.
        failed_islands: (F,) intp, the failed chart of every face, -1 for the others; one chart where all are refused.
        error: why the whole mesh was refused; empty if it was not.
        unused_extenders: number of the mesh's extenders that no solved chart could use.
    """

    uv: np.ndarray
    chart_of_corner: np.ndarray
    charts: Sequence[Any]
    failed_islands: np.ndarray
    error: str = ""
    unused_extenders: int = 0

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
        """(C,) bool, the corners of solved charts with pins: these charts lie where they must."""
        pinned = [chart.n_pins > 0 for chart in self.charts]
        if not any(pinned):
            return np.zeros(len(self.chart_of_corner), dtype=bool)
        return np.array([*pinned, False])[self.chart_of_corner]


def too_small_faces(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution]) -> int:
    """Return how many solved faces shrink so far in their chart that Blender's single precision merges them.

    A UV near 1 has steps of 2^-24; a face of less than eight has no shape. Faces that are as small in 3D do not count.
    """
    if not meshes:
        return 0
    whole = joined(meshes) if len(meshes) > 1 else meshes[0]
    uv = np.concatenate([solution.uv for solution in solutions])
    chart = numbered_together([solution.chart_of_corner for solution in solutions], [len(s.charts) for s in solutions])
    chart = chart[whole.face_offsets[:-1]]
    image = _part_of_chart(uv, whole, chart)
    small = image < 2.0**-21
    if not small.any():
        return 0
    original = _part_of_chart(whole.vertices[whole.corner_vertices], whole, chart)
    return int(np.count_nonzero(small & (image < original / 16)))


def _part_of_chart(positions: np.ndarray, mesh: PolygonMesh, chart: np.ndarray) -> np.ndarray:
    """Return the extent of the faces of charts as parts of their chart's; `positions` (C, n) of the corners.

    `chart` (F,) is -1 for faces of none; the result has the length of the others, in the order of their charts.
    """
    low, high = (np.ascontiguousarray(bound.T) for bound in mesh.face_bounds(positions))
    if len(chart) and chart[0] >= 0 and (chart == chart[0]).all():
        return (high - low).max(axis=0) / (high.max(axis=1) - low.min(axis=1)).max()
    if (chart[1:] < chart[:-1]).any() or (chart[:1] < 0).any():
        order = np.argsort(chart, kind="stable")[np.count_nonzero(chart < 0) :]
        low, high, chart = low.take(order, axis=1), high.take(order, axis=1), chart.take(order)
    if not len(chart):
        return np.empty(0)
    starts = np.flatnonzero(np.diff(chart, prepend=-1))
    size = np.maximum.reduceat(high, starts, axis=1) - np.minimum.reduceat(low, starts, axis=1)
    return (high - low).max(axis=0) / np.repeat(size.max(axis=0), np.diff(starts, append=len(chart)))


def solve(
    mesh: PolygonMesh,
    options: Options,
    progress: Progress | None = None,
    kept: Any = None,  # noqa: ANN401 - a KeptMaps of the native module
) -> Solution:
    """Unwrap the selected faces of `mesh`, chart by chart; those whose maps are `kept` are not solved.

    A mesh that the solver refuses as a whole comes back as a `Solution` with an `error` and no charts, so that the
    other meshes of the same call can still be unwrapped.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    try:
        return _solution(mesh, _unwrap(mesh, options, progress, kept))
    except ValueError as error:
        corners = len(mesh.corner_vertices)
        refused = np.where(mesh.selected_faces, 0, -1)
        return Solution(np.zeros((corners, 2)), np.full(corners, -1), (), refused, str(error))


def _unwrap(mesh: PolygonMesh, options: Options, progress: Progress | None, kept: Any) -> Any:  # noqa: ANN401 - of the module
    return native.spectral_conformal().unwrap(
        mesh.vertices,
        mesh.face_offsets,
        mesh.corner_vertices,
        **soft_constraints(mesh, options),
        **arguments(mesh, options),
        progress=progress,
        kept_maps=kept,
    )


def _solution(mesh: PolygonMesh, result: Any) -> Solution:  # noqa: ANN401 - of the module, or a part of it
    chart_of_corner = np.repeat(result.chart_of_face, np.diff(mesh.face_offsets))
    chart_of_corner[~result.solved_corners] = -1
    failed = [chart.status != "solved" for chart in result.charts]
    if any(failed):
        failed_islands = np.where(np.array([*failed, False])[result.chart_of_face], result.chart_of_face, -1)
    else:
        failed_islands = np.full_like(result.chart_of_face, -1)
    return Solution(
        result.uv,
        chart_of_corner,
        result.charts,
        failed_islands,
        unused_extenders=_count_unused(mesh, result.unused_extenders),
    )


def arguments(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the keyword arguments that `spectral_conformal.unwrap` and `Unwrapper` share."""
    return {
        "seam_edges": mesh.seam_edges,
        "selected_faces": mesh.selected_faces,
        "method": options.method,
        "weights": options.weights,
        "boundary": options.boundary,
        "fill_holes": options.fill_holes,
        "area_blend": options.area_blend,
        "fold_free": options.fold_free,
        "polish": options.polish,
        "metric": _stretched_space(mesh, options.stretch) if _is_stretched(mesh, options) else None,
        **_pins(mesh, options),
    }


def soft_constraints(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the keyword arguments that `spectral_conformal.unwrap` shares with `Unwrapper.solve`."""
    # Only the spectral method has a form that soft constraints could change.
    if options.method != "spectral":
        return {}
    is_automatic = options.automatic_holes and options.hole_rigidity == 0.0
    return {"extenders": mesh.extenders, "hole_rigidity": "automatic" if is_automatic else options.hole_rigidity}


def _count_unused(mesh: PolygonMesh, unused: np.ndarray) -> int:
    """Count the unused extenders of which a vertex is being unwrapped: the others were not meant."""
    if not unused.any():
        return 0
    unwrapped = np.zeros(len(mesh.vertices), dtype=bool)
    unwrapped[mesh.corner_vertices[mesh.selected_faces[mesh.face_of_corner()]]] = True
    ends = np.array([(i, j) for i, j, _ in mesh.extenders])
    return int(np.count_nonzero(unused & unwrapped[ends].any(axis=1)))


def _is_stretched(mesh: PolygonMesh, options: Options) -> bool:
    return mesh.stretch_direction is not None and options.stretch != 1.0


def _stretched_space(mesh: PolygonMesh, stretch: float) -> np.ndarray:
    """Return the metric of the mesh as it would be, stretched in space along its direction, (F, 3, 3) float64.

    Unlike a direction projected to every face, it fades where faces lean away from the direction.
    """
    metric = np.eye(3) + (stretch**2 - 1.0) * np.outer(mesh.stretch_direction, mesh.stretch_direction)
    return np.broadcast_to(metric, (len(mesh.selected_faces), 3, 3))


def _pins(mesh: PolygonMesh, options: Options) -> dict[str, Any]:
    """Return the arguments of `spectral_conformal.unwrap` that say where the pins are; none without pins."""
    pinned = mesh.usable_pins()
    if not pinned.any():
        return {}
    return {"corner_uv": mesh.isotropic_uv(), "pinned_corners": pinned, "soft_pins": options.soft_pins}


def solve_all(
    meshes: Sequence[PolygonMesh],
    options: Options,
    progress: Progress | None = None,
    kept: Any = None,  # noqa: ANN401 - as in solve
) -> list[Solution]:
    """`solve` every mesh; `progress` gets the fraction done of all of them, each counted by its selected faces."""
    groups = _groups(meshes, options)
    solved = [_solve_group(group, options, part, kept) for group, part in zip(groups, parts(groups, progress))]
    return [solution for solutions in solved for solution in solutions]


def _groups(meshes: Sequence[PolygonMesh], options: Options) -> list[list[PolygonMesh]]:
    """Return the meshes in their order, those together that can be joined."""
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
    """Return whether a mesh has what must not reach others: constraints, or a vertex that is named by number."""
    is_constrained = bool(mesh.extenders) or mesh.usable_pins().any() or _is_stretched(mesh, options)
    return is_constrained or not np.isfinite(mesh.vertices).all()


def _solve_group(
    group: Sequence[PolygonMesh],
    options: Options,
    progress: Progress | None,
    kept: Any,  # noqa: ANN401 - as in solve
) -> list[Solution]:
    """Return the solution of every mesh of a `group` that can be joined."""
    if len(group) > 1:
        try:
            result = _unwrap(joined(group), options, progress, kept)
        except ValueError:
            # One of them is refused, which the others must not suffer from.
            pass
        else:
            return [_solution(mesh, part) for mesh, part in zip(group, joined_parts(group, result))]
    each = [progress] if len(group) == 1 else parts([[mesh] for mesh in group], progress)
    return [solve(mesh, options, part, kept) for mesh, part in zip(group, each)]
