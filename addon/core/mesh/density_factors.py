# SPDX-License-Identifier: GPL-3.0-or-later
"""The density factors of faces, which an artist sets: a chart's texel density over that of others."""

import numpy as np

from .group_bounds import group_bounds
from .polygon_mesh import PolygonMesh
from .world_scale import area_vectors

# Factors beyond these limits are mistakes, and would shrink the other charts, or this one, to nothing.
MIN_FACTOR, MAX_FACTOR = 0.01, 100.0


def face_factors(mesh: PolygonMesh) -> np.ndarray:
    """Return the factor of every face, (F,) float64: 1 where no valid one is stored."""
    if mesh.density_factors is None:
        return np.ones(len(mesh.selected_faces))
    stored = np.asarray(mesh.density_factors, dtype=np.float64)
    is_set = np.isfinite(stored) & (stored > 0.0)
    return np.where(is_set, np.clip(stored, MIN_FACTOR, MAX_FACTOR), 1.0)


def chart_factors(mesh: PolygonMesh, chart: np.ndarray, n_charts: int) -> np.ndarray:
    """Return the factor of each chart, (n_charts,): its faces' factor or, where they differ, the average by area.

    `chart` (F,) is the chart of every face, -1 for none.
    """
    if mesh.density_factors is None:
        return np.ones(n_charts)
    area = np.linalg.norm(area_vectors(mesh), axis=1)
    factors = face_factors(mesh)
    means = ratios(chart_sums(factors * area, chart, n_charts), chart_sums(area, chart, n_charts))
    # Equal factors stay exact, however their mean rounds.
    low, high = group_bounds(factors, chart, n_charts)
    return np.where(low == high, low, means)


def chart_sums(values: np.ndarray, chart: np.ndarray, n_charts: int) -> np.ndarray:
    """Return the sum of the `values` (F,) over each chart, (n_charts,), given the `chart` (F,), -1 for none."""
    inside = chart >= 0
    return np.bincount(chart[inside], np.nan_to_num(values[inside]), minlength=n_charts)


def ratios(over: np.ndarray, under: np.ndarray) -> np.ndarray:
    """Return the quotients of positive numbers; 1 where there is none."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        quotient = over / under
    return np.where(np.isfinite(quotient) & (quotient > 0.0), quotient, 1.0)
