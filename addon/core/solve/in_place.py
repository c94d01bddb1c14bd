# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of islands that are solved while the rest stays."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..mesh.charts import chart_of_face, map_defects
from ..mesh.group_bounds import group_bounds
from ..mesh.island_parts import signed_areas
from ..mesh.polygon_mesh import PolygonMesh
from .options import Settings
from .solution import Solution


class Parts(NamedTuple):
    """Numbers of parts of islands solved in place, of UVs held for them, and of parts with every UV held."""

    solved: int = 0
    held: int = 0
    without_free: int = 0


def count_parts(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution]) -> Parts:
    """Count the solved parts of islands, and the UVs shared with the rest that held them."""
    parts, held, without_free = 0, 0, 0
    for mesh, solution in zip(meshes, solutions):
        if mesh.held_corners is None or not len(solution.charts):
            continue
        corners = np.flatnonzero(mesh.held_corners & solution.solved_corners)
        chart = solution.chart_of_corner
        parts += (n_parts := len(np.unique(chart[corners])))
        held += len(np.unique(np.column_stack([mesh.corner_vertices[corners], mesh.uv[corners]]), axis=0))
        has_free = np.unique(chart[solution.solved_corners & ~mesh.usable_pins()])
        without_free += n_parts - np.count_nonzero(np.isin(np.unique(chart[corners]), has_free))
    return Parts(parts, held, int(without_free))


def with_axis_held(mesh: PolygonMesh, settings: Settings) -> PolygonMesh:
    """Return the mesh with one coordinate held, if the settings move only the other one.

    A whole island without extent along the held axis has no map to keep, so it is not held.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    kept = [axis for axis in (0, 1) if settings.blend[axis] == 0.0]
    if mesh.uv is None or len(kept) != 1 or settings.options.method not in {"spectral", "lscm"}:
        return mesh
    chart = chart_of_face(mesh, mesh.selected_faces)
    n = int(chart.max(initial=-1)) + 1
    of_corner = chart[mesh.face_of_corner()]
    corners = np.flatnonzero((of_corner >= 0) & np.isfinite(mesh.uv).all(axis=1))
    low, high = group_bounds(mesh.uv[corners, kept[0]], of_corner[corners], n)
    is_held = high > low
    if mesh.held_corners is not None:
        is_held[of_corner[mesh.held_corners & (of_corner >= 0)]] = True
    held = np.zeros(len(of_corner), dtype=bool)
    held[corners] = is_held[of_corner[corners]]
    if not held.any():
        return mesh
    mirrored = np.append(signed_areas(mesh, chart, n) < 0.0, False)[of_corner] & held
    return replace(mesh, held_axis=np.where(held, kept[0], -1).astype(np.int8), mirrored_corners=mirrored)


def blended_with_former(
    meshes: Sequence[PolygonMesh],
    solutions: Sequence[Solution],
    maps: Sequence[np.ndarray],
    blend: tuple[float, float] = (1.0, 1.0),
) -> list[np.ndarray]:
    """Return the solved `maps`, (C, 2) each, blended with the former ones; held corners keep every bit.

    `blend` is how far U and V go from the former map, 0, to the solved one, 1.
    """
    result = []
    for mesh, solution, uv in zip(meshes, solutions, maps):
        moved = uv
        if blend != (1.0, 1.0) and mesh.uv is not None:
            former = np.where(np.isfinite(mesh.uv), mesh.uv, uv)
            # Exact at both ends, which `former + blend * (uv - former)` is not.
            moved = np.asarray(blend) * uv + (1.0 - np.asarray(blend)) * former
        if mesh.held_corners is not None:
            moved = np.where((mesh.held_corners & solution.solved_corners)[:, None], mesh.uv, moved)
        result.append(moved)
    return result


def count_new_flips(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution], maps: Sequence[np.ndarray]) -> int:
    """Return how many more solved faces are flipped in the `maps` (C, 2) than in the former ones.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    return sum(
        _count_flipped(mesh, solution, uv) - _count_flipped(mesh, solution, mesh.uv)
        for mesh, solution, uv in zip(meshes, solutions, maps)
        if mesh.uv is not None and solution.solved_corners.any()
    )


def count_covered(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution], maps: Sequence[np.ndarray]) -> int:
    """Count the faces of the rest of islands that solved parts newly cover in the `maps` (C, 2).

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    covered = 0
    for mesh, solution, uv in zip(meshes, solutions, maps):
        if mesh.held_corners is None or not solution.solved_corners.any():
            continue
        after = np.where(solution.solved_corners[:, None], uv, mesh.uv)
        if np.isfinite(after.astype(np.float32)).all() and np.isfinite(mesh.uv).all():
            rest = ~solution.solved_corners[mesh.face_offsets[:-1]]
            before, now = (map_defects(mesh, each).overlapping for each in (mesh.uv, after))
            covered += int(np.count_nonzero(now & ~before & rest))
    return covered


def _count_flipped(mesh: PolygonMesh, solution: Solution, uv: np.ndarray) -> int:
    solved = solution.solved_corners[mesh.face_offsets[:-1]]
    whole = np.where(solution.solved_corners[:, None], uv, mesh.uv)
    if not np.isfinite(whole.astype(np.float32)).all():
        return 0
    return int(np.count_nonzero(map_defects(mesh, whole).flipped & solved))
