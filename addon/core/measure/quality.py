# SPDX-License-Identifier: GPL-3.0-or-later
"""How good the map of several meshes is, in two numbers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from ..solve.solution import Solution, charts_of
from .summary import mean_qc


@dataclass(frozen=True)
class MapQuality:
    """Distortion of the faces to unwrap, with islands scaled by their surface area.

    Attributes:
        even: part of the area, 0 to 1, whose linear scale lies within a factor of the median; area that could not be
            solved does not count as even.
        mean_qc: quasi-conformal distortion averaged over the solved area; NaN where there is none.
    """

    even: float
    mean_qc: float


def measure(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution], factor: float) -> MapQuality:
    """Measure the maps that `solve` returned for the selected faces of the meshes.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    parts = [_areas_and_scales(mesh, solution) for mesh, solution in zip(meshes, solutions)]
    area, scale = (np.concatenate(arrays) for arrays in zip(*parts))
    (median,) = native.measuring().area_percentiles(scale, area, (50.0,))
    # Comparisons with NaN are false.
    even = np.abs(scale - median) <= np.log2(factor)
    return MapQuality(float(area[even].sum() / area.sum()) if even.any() else 0.0, mean_qc(charts_of(solutions)))


def _areas_and_scales(mesh: PolygonMesh, solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return the area of every face, 0 if not selected, and the binary logarithm of its scale, NaN if not solved."""
    solved = solution.solved_corners[mesh.face_offsets[:-1]]
    face_distortion = native.spectral_conformal().face_distortion
    measured = face_distortion(mesh.with_map(solution.uv), selected_faces=mesh.selected_faces)
    # Overflow from absurdly large positions.
    area = np.where(np.isfinite(measured.area), measured.area, 0.0)
    return area, np.where(solved & np.isfinite(measured.log2_scale), measured.log2_scale, np.nan)
