# SPDX-License-Identifier: GPL-3.0-or-later
"""Scale charts to an equal texel density in the world, times their own factors.

With the area A_k of chart k in the world, its area a_k in the map and its factor c_k, which an artist sets, the density
per pixel of the texture is sqrt(a_k / A_k); densities are equal if all sqrt(a_k / A_k) / c_k are.
"""

from collections.abc import Sequence

import numpy as np

from ..mesh.density_factors import chart_factors, chart_sums, ratios
from ..mesh.group_bounds import group_bounds
from ..mesh.polygon_mesh import PolygonMesh
from ..mesh.world_scale import area_growth, area_vectors, is_uneven


def chart_scales(mesh: PolygonMesh, chart: np.ndarray, n_charts: int) -> np.ndarray:
    """Return the factors c_k sqrt(A_k / a_k), (n_charts,), for charts that have their area in object space.

    `chart` (F,) is the chart of every face, -1 for none.
    """
    scales = chart_factors(mesh, chart, n_charts)
    if mesh.world_metric is None:
        return scales
    if not is_uneven(mesh.world_metric):
        return scales * np.sqrt(mesh.world_metric[0, 0])
    area = np.linalg.norm(area_vectors(mesh), axis=1)
    growth = ratios(chart_sums(area * area_growth(mesh), chart, n_charts), chart_sums(area, chart, n_charts))
    return scales * np.sqrt(growth)


def at_equal_density(meshes: Sequence[PolygonMesh], charts: Sequence[np.ndarray], uv: np.ndarray) -> np.ndarray:
    """Scale the charts of all meshes from their area in object space to an equal density in the world.

    Args:
        meshes: the meshes.
        charts: for each mesh the chart of every corner, (C,), -1 for none.
        uv: the maps of all meshes, one below the other, (sum of C, 2) float64, each chart with its area in object
            space.

    Returns:
        `uv` itself if all charts would be scaled alike, else a scaled copy.
    """
    if all(mesh.world_metric is None and mesh.density_factors is None for mesh in meshes):
        return uv
    scales, present = [], []
    for mesh, chart in zip(meshes, charts):
        number = chart[mesh.face_offsets[:-1]]
        # The last entry is that of corners without a chart.
        scales.append(np.append(chart_scales(mesh, number, int(number.max(initial=-1)) + 1), 1.0))
        present.append(scales[-1][np.unique(number[number >= 0])])
    inside = np.concatenate(present)
    if not len(inside) or (inside == inside[0]).all():
        return uv
    return uv * np.concatenate([scale[chart] for scale, chart in zip(scales, charts)])[:, None]


def scaled_about_centers(uv: np.ndarray, island: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Scale every island about the center of its bounding box; returns a copy of `uv`, (C, 2) float64.

    Corners of islands with the factor 1, and those of none, keep their UVs bit by bit.

    Args:
        uv: (C, 2).
        island: (C,) the island of every corner, -1 for none.
        scale: (K,) the factor of each island.
    """
    result = np.array(uv, dtype=np.float64)
    corners = np.flatnonzero((island >= 0) & (np.append(scale, 1.0)[island] != 1.0))
    number = island[corners]
    low, high = group_bounds(result[corners], number, len(scale))
    with np.errstate(invalid="ignore"):
        center = ((low + high) / 2.0)[number]
    result[corners] = center + (result[corners] - center) * scale[number, None]
    return result
