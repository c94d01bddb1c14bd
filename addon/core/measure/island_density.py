# SPDX-License-Identifier: GPL-3.0-or-later
"""The texel density of chosen islands of several maps, and the scales that change it.

Over the faces f of an island k, with areas a_f in the map, A_f in the world and textures of p_f pixels along a side,
the density is d_k = sqrt(sum a_f p_f^2 / sum A_f).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh.density_factors import chart_factors, chart_sums
from . import defects
from .map_view import MapView
from .texels import Texels


@dataclass(frozen=True)
class IslandDensities:
    """K islands of several maps.

    Attributes:
        island: for each map the island of every face, (F,) int, -1 for those not chosen.
        density: (K,) float64, pixels along the unit of length; NaN for islands without an area.
        area: (K,) float64, in the world.
        factor: (K,) float64, how many times the density of others the artist wants.
    """

    island: list[np.ndarray]
    density: np.ndarray
    area: np.ndarray
    factor: np.ndarray

    def scales_to(self, density: float) -> np.ndarray:
        """Return the factors, (K,), that give all islands this density, whatever their own factors; 1 without one."""
        return np.where(np.isfinite(self.density), density / self.density, 1.0)

    def equalizing_scales(self) -> np.ndarray:
        """Return the factors, (K,), that make d_k / c_k equal and keep the pixels of all islands together.

        The new densities are d c_k with sum A_k (c_k d)^2 = sum A_k d_k^2.
        """
        counted = np.isfinite(self.density)
        pixels = (self.area * self.density**2)[counted].sum()
        wanted = (self.area * self.factor**2)[counted].sum()
        return self.scales_to(np.sqrt(pixels / wanted) * self.factor) if counted.any() else np.ones(len(self.area))

    def mean(self) -> float:
        """Return the density of all islands together; NaN where none has one."""
        counted = np.isfinite(self.density)
        if not counted.any():
            return float("nan")
        return float(np.sqrt((self.area * self.density**2)[counted].sum() / self.area[counted].sum()))


def of_islands(views: Sequence[MapView], chosen: Sequence[np.ndarray], texels: Texels) -> IslandDensities:
    """Measure the islands of at least one map that have a `chosen` face, one (F,) bool for each map.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    islands, n = defects.chosen_islands([view.mesh for view in views], chosen)
    pixels, area, factor = np.zeros(n), np.zeros(n), np.ones(n)
    for view, island in zip(views, islands):
        pixels += chart_sums(view.area * view.densities(texels) ** 2, island, n)
        area += chart_sums(view.area, island, n)
        here = np.unique(island[island >= 0])
        factor[here] = chart_factors(view.mesh, island, n)[here]
    with np.errstate(invalid="ignore", divide="ignore"):
        density = np.sqrt(pixels / area)
    density[~(np.isfinite(density) & (density > 0.0))] = np.nan
    return IslandDensities(islands, density, area, factor)
