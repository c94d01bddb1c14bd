# SPDX-License-Identifier: GPL-3.0-or-later
"""How good the map of several meshes is as a whole, in two numbers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh.polygon_mesh import PolygonMesh
from ..solve.solution import Solution, are_solved, column_of_all


@dataclass(frozen=True)
class MapQuality:
    """Distortion of the faces to unwrap, islands being scaled by their surface area.

    Attributes:
        even: part of the area, 0 to 1, whose linear scale lies within a factor of the median. Faces of islands that
            could not be solved do not.
        mean_qc: quasi-conformal distortion averaged over the solved area; NaN where there is none.
    """

    even: float
    mean_qc: float


def measure(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution], factor: float) -> MapQuality:
    """Measure the maps that `solve` returned for the selected faces of the meshes."""
    parts = [_areas(mesh, solution) for mesh, solution in zip(meshes, solutions)]
    area, image = (np.concatenate(arrays) for arrays in zip(*parts))
    solved = are_solved(solutions)
    weights = column_of_all(solutions, "area")[solved]
    qc = column_of_all(solutions, "mean_qc")[solved]
    mean_qc = np.average(qc, weights=weights) if weights.sum() > 0.0 else np.nan
    return MapQuality(_even(area, image, factor), float(mean_qc))


def _even(area: np.ndarray, image: np.ndarray, factor: float) -> float:
    """Return the part of `area` where the root of `image` / `area` is within `factor` of its median, all (F,)."""
    mapped = (area > 0.0) & (image > 0.0)
    if not mapped.any():
        return 0.0
    scale = 0.5 * (np.log(image[mapped]) - np.log(area[mapped]))
    order = np.argsort(scale)
    below = np.cumsum(area[mapped][order])
    median = scale[order][np.searchsorted(below, 0.5 * below[-1])]
    even = np.abs(scale - median) <= np.log(factor)
    return float(area[mapped][even].sum() / area.sum())


def _areas(mesh: PolygonMesh, solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return the area of every selected face, and that of its image, 0 where it was not solved."""
    uv = np.where(solution.solved_corners[:, None], solution.uv, 0.0)
    in_space = mesh.vertices[mesh.corner_vertices]
    in_plane = np.column_stack([uv, np.zeros(len(uv))])
    return tuple(_polygon_areas(points, mesh)[mesh.selected_faces] for points in (in_space, in_plane))


def _polygon_areas(points: np.ndarray, mesh: PolygonMesh) -> np.ndarray:
    """Return the area of the polygon that the corners (C, 3) of each face make, (F,), 0 where that is not finite."""
    first = mesh.face_offsets[:-1]
    following = mesh.next_corner()
    face = mesh.face_of_corner()
    with np.errstate(invalid="ignore", over="ignore"):
        relative = points - points[first][face]
        normals = 0.5 * np.add.reduceat(np.cross(relative, relative[following]), first)
        areas = np.linalg.norm(normals, axis=1)
    return np.where(np.isfinite(areas), areas, 0.0)
