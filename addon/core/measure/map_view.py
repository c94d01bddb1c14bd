# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV map of a mesh in numbers, and as arrays to draw."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import choices, native
from ..drawing import island_band
from ..mesh.density_factors import chart_sums
from ..mesh.polygon_mesh import PolygonMesh
from ..mesh.world_scale import area_growth
from . import defects
from .texels import Texels

# Fixed ranges, so that a good map looks good and colors mean the same on all maps: angles off by 50 %, and half and
# double the median size, are seen at once on a checker.
_ANGLE_RANGE, _LOG2_SIZE_RANGE = (1.0, 1.5), (-1.0, 1.0)
# Densities have the median in the middle, too; there is no density that is right everywhere.
_DENSITY_RANGE = (0.5, 1.5)
# Percentiles of the surface that an automatic range spans; outliers would dominate it.
_PERCENTILES = (2.0, 98.0)
# Minimal widths of an automatic range: smaller differences are invisible in a texture.
_MIN_QC_RANGE = 0.2
_MIN_LOG2_SCALE = 0.25
# Drawn in place of an infinite or missing value.
_LARGE = 1e30


@dataclass(frozen=True)
class IslandNumbers:
    """Numbers of some islands of a map together; NaN if none of their faces can be measured.

    Attributes:
        faces: number of selected faces.
        mean_qc: quasi-conformal distortion averaged over the surface.
        max_qc: the largest of a face.
        log2_scale_deviation: standard deviation over the surface of the binary logarithm of the scale.
        flipped: number of faces.
        overlapping: number of faces.
        defective: number of faces that are flipped, overlapping or both.
    """

    faces: int
    mean_qc: float
    max_qc: float
    log2_scale_deviation: float
    flipped: int
    overlapping: int
    defective: int


class MapView:
    """Measures of the UV map of one mesh, over its selected faces; computed on first use.

    Angles are compared with those in object space, as the unwrap does, sizes with those in the world.

    Every measure raises NativeModuleError if `spectral_conformal` cannot be imported.
    """

    def __init__(self, mesh: PolygonMesh, before: MapView | None = None) -> None:
        """Measure a `mesh` with a UV map; `before` has the triangles of the same surface with another map."""
        self.mesh = mesh
        if before is not None:
            self.triangles = before.triangles

    @functools.cached_property
    def _distortion(self) -> object:
        # As the image shows the map.
        uv, faces = self.mesh.isotropic_uv(), self.mesh.selected_faces
        return native.spectral_conformal().face_distortion(self.mesh.with_map(uv), selected_faces=faces)

    @property
    def qc(self) -> np.ndarray:
        """Quasi-conformal distortion of every face, (F,) float64, as `spectral_conformal.face_distortion` has it."""
        return self._distortion.qc

    @functools.cached_property
    def log2_scale(self) -> np.ndarray:
        """Binary logarithm of the linear scale of every face, (F,) float64, UVs over the world."""
        if self.mesh.world_metric is None:
            return self._distortion.log2_scale
        return self._distortion.log2_scale - 0.5 * np.log2(area_growth(self.mesh))

    @functools.cached_property
    def area(self) -> np.ndarray:
        """Area of every face in the world, (F,) float64; 0 where it is not selected or cannot be measured."""
        if self.mesh.world_metric is None:
            return self._distortion.area
        return self._distortion.area * area_growth(self.mesh)

    @functools.cached_property
    def triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """The selected faces as triangles: their corners, (T, 3), and the face of each, (T,), both int32."""
        faces = self.mesh.selected_faces
        return native.spectral_conformal().hosts.face_triangles(self.mesh.with_map(), selected_faces=faces)

    @functools.cached_property
    def _defects(self) -> defects.Defects:
        return defects.find([self.mesh], between_islands=False)[0]

    @property
    def flipped(self) -> np.ndarray:
        """Which faces are flipped in their island, (F,) bool."""
        return self._defects.flipped

    @property
    def overlapping(self) -> np.ndarray:
        """Which faces overlap others of their island, (F,) bool."""
        return self._defects.overlapping

    @property
    def island_of_face(self) -> np.ndarray:
        """Which island every face belongs to, (F,) int32, -1 for none."""
        return self._defects.island_of_face

    @functools.cached_property
    def median_log2_scale(self) -> float:
        """The median of `log2_scale` over the surface; 0 where nothing is mapped."""
        return median_log2_scale([self])

    @property
    def is_measured(self) -> np.ndarray:
        """Which faces have a surface and a finite size in the map, (F,) bool."""
        return (self.area > 0.0) & np.isfinite(self.log2_scale)

    def densities(self, texels: Texels | None = None) -> np.ndarray:
        """Return the texel density of every face, (F,) float64: pixels along the unit of `texels`."""
        texels = texels or Texels()
        return self._sides(texels) * texels.length * np.exp2(self.log2_scale)

    def _sides(self, texels: Texels) -> np.ndarray:
        """Return the pixels along a side of the texture of every face, (F,) float64."""
        known = self.mesh.texture_sides
        if known is None:
            return np.full(len(self.mesh.selected_faces), float(texels.side))
        return np.where(known > 0.0, known, texels.side)

    def mean_density(self, texels: Texels | None = None) -> float:
        """Return the texel density of all selected faces together; NaN without a surface."""
        squares = native.measuring().area_mean(np.nan_to_num(self.densities(texels)) ** 2, self.area)
        return float(squares**0.5)

    def values(self, kind: str, texels: Texels | None = None, median: float | None = None) -> np.ndarray:
        """Return the value to show for every face, (F,) float64.

        Args:
            kind: one of `choices.LOOK_ANGLE` (quasi-conformal distortion), `LOOK_SIZE` (binary logarithm of the scale
                over its median), `LOOK_DENSITY` (`densities`), `LOOK_DEFECTS` (1 flipped, 0.5 overlapping, 0 neither)
                and `LOOK_CHECKER` and `LOOK_STACKS`, which have no values of one map.
            texels: how densities are measured; by default textures have one pixel.
            median: of the binary logarithm of the scale, of all maps shown together; of this map by default.
        """
        if kind == choices.LOOK_ANGLE:
            return self.qc
        if kind == choices.LOOK_SIZE:
            return self.log2_scale - (self.median_log2_scale if median is None else median)
        if kind == choices.LOOK_DENSITY:
            return self.densities(texels)
        if kind == choices.LOOK_DEFECTS:
            return np.where(self.flipped, 1.0, np.where(self.overlapping, 0.5, 0.0))
        return np.zeros(len(self.mesh.selected_faces))

    def triangle_positions(self) -> np.ndarray:
        """Return the positions of the corners of the triangles, (3 T, 3) float32."""
        # Taking rows is three times as fast as indexing them.
        vertices = self.mesh.corner_vertices.take(self.triangles[0].ravel())
        return self.mesh.vertices.astype(np.float32).take(vertices, axis=0)

    def triangle_map(
        self, kind: str, texels: Texels | None = None, values: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return UVs (3 T, 2) and values (3 T,) of the corners of the triangles, float32.

        `values` (F,) are shown instead of those of the kind.
        """
        corners, face = self.triangles
        with np.errstate(over="ignore"):
            values = self.values(kind, texels) if values is None else values
            values = np.nan_to_num(values, nan=_LARGE, posinf=_LARGE, neginf=-_LARGE)
        uv = self.mesh.uv.astype(np.float32).take(corners.ravel(), axis=0)
        return uv, values.astype(np.float32).take(face).repeat(3)

    def border_band(self, margin: float, texels: Texels) -> np.ndarray:
        """Return triangles, (3 T, 2) float32, that cover half of a `margin` in pixels around all islands."""
        mesh, corner_faces = self.mesh, self.mesh.face_of_corner()
        following = mesh.next_corner()
        shown = mesh.selected_faces if mesh.uv_faces is None else mesh.uv_faces
        point, _ = native.spectral_conformal("_mesh").points_of(mesh.with_map(mesh.uv))
        begins = island_band.border(point, following, shown[corner_faces])
        width = 0.5 * margin / self._sides(texels)[corner_faces[begins]]
        stretch = [mesh.aspect**-0.5, mesh.aspect**0.5]
        both_axes = width[:, None] * stretch
        return island_band.triangles(mesh.uv[begins], mesh.uv[following[begins]], both_axes).astype(np.float32)

    def face_at(self, point: Sequence[float]) -> int:
        """Return a face at the `point` (u, v), of those that the UV editor shows; -1 for none."""
        corners, face = self.triangles
        arms = self.mesh.uv.take(corners, axis=0) - np.asarray(point, dtype=np.float64)
        u, v = arms[..., 0], arms[..., 1]
        with np.errstate(all="ignore"):
            turns = u * np.roll(v, -1, axis=1) - v * np.roll(u, -1, axis=1)
            covers = (turns >= 0.0).all(axis=1) | (turns <= 0.0).all(axis=1)
        covers &= self.is_in_uv_editor() & (turns != 0.0).any(axis=1)
        return int(face[covers.argmax()]) if covers.any() else -1

    def is_in_uv_editor(self) -> np.ndarray:
        """Return which of the triangles the UV editor shows, (T,) bool."""
        faces = self.mesh.selected_faces if self.mesh.uv_faces is None else self.mesh.uv_faces
        return faces[self.triangles[1]]

    def numbers(self, islands: Sequence[int] | None = None) -> IslandNumbers:
        """Return the numbers of some islands, or of all selected faces."""
        if islands is None:
            return joined_numbers([self])
        return _numbers([(self, np.isin(self.island_of_face, islands))])


def _joined(views: Sequence[MapView], name: str) -> np.ndarray:
    """Return a value of the faces of all maps, one map after the other."""
    return np.concatenate([getattr(view, name) for view in views])


def median_log2_scale(views: Sequence[MapView]) -> float:
    """Return the median over the surface of all maps; 0 where nothing is mapped."""
    percentiles = native.measuring().area_percentiles(_joined(views, "log2_scale"), _joined(views, "area"), (50.0,))
    return float(np.nan_to_num(percentiles[0]))


def joined_numbers(views: Sequence[MapView]) -> IslandNumbers:
    """Return the numbers of all selected faces of at least one map together."""
    return _numbers([(view, view.mesh.selected_faces) for view in views])


def joined_density(views: Sequence[MapView], texels: Texels) -> float:
    """Return the texel density of all selected faces of at least one map together; NaN without a surface."""
    areas = np.array([view.area.sum() for view in views])
    squares = np.array([view.mean_density(texels) for view in views]) ** 2
    return float(native.measuring().area_mean(np.where(areas > 0.0, squares, 0.0), areas) ** 0.5)


def _numbers(parts: Sequence[tuple[MapView, np.ndarray]]) -> IslandNumbers:
    """Return the numbers of the chosen faces, (F,) bool, of some maps together."""
    measuring = native.measuring()
    counted = [(view, chosen & view.is_measured) for view, chosen in parts]
    area, scale, qc = (
        np.concatenate([getattr(view, name)[faces] for view, faces in counted]) for name in ("area", "log2_scale", "qc")
    )
    return IslandNumbers(
        faces=sum(int(chosen.sum()) for _, chosen in parts),
        mean_qc=measuring.area_mean(qc, area),
        max_qc=float(qc.max()) if len(qc) else float("nan"),
        log2_scale_deviation=measuring.area_mean((scale - measuring.area_mean(scale, area)) ** 2, area) ** 0.5,
        flipped=sum(int(view.flipped[chosen].sum()) for view, chosen in parts),
        overlapping=sum(int(view.overlapping[chosen].sum()) for view, chosen in parts),
        defective=sum(int((view.flipped | view.overlapping)[chosen].sum()) for view, chosen in parts),
    )


def fixed_range(views: Sequence[MapView], kind: str, texels: Texels | None = None) -> tuple[float, float]:
    """Return the default values at the two ends of the colors: always the same, for densities around the median."""
    if kind == choices.LOOK_ANGLE:
        return _ANGLE_RANGE
    if kind == choices.LOOK_SIZE:
        return _LOG2_SIZE_RANGE
    if kind != choices.LOOK_DENSITY:
        return 0.0, 1.0
    densities, area = np.concatenate([view.densities(texels) for view in views]), _joined(views, "area")
    (median,) = native.measuring().area_percentiles(densities, area, (50.0,))
    median = median if np.isfinite(median) and median > 0.0 else 1.0
    return _DENSITY_RANGE[0] * median, _DENSITY_RANGE[1] * median


def automatic_range(views: Sequence[MapView], kind: str, texels: Texels | None = None) -> tuple[float, float]:
    """Return the values at the two ends of the colors: the range of most of the surface of all meshes.

    Sizes are centered at the median, angles begin at 1. Ranges have a minimal width, so that a good map looks good.
    """
    if kind in (choices.LOOK_DEFECTS, choices.LOOK_CHECKER):
        return 0.0, 1.0
    median = median_log2_scale(views) if kind == choices.LOOK_SIZE else None
    values = np.concatenate([view.values(kind, texels, median) for view in views])
    low, high = native.measuring().area_percentiles(values, _joined(views, "area"), _PERCENTILES)
    if np.isnan(low):
        return (1.0, 1.0 + _MIN_QC_RANGE) if kind == choices.LOOK_ANGLE else (-1.0, 1.0)
    if kind == choices.LOOK_ANGLE:
        return 1.0, max(high, 1.0 + _MIN_QC_RANGE)
    if kind == choices.LOOK_SIZE:
        size = max(-low, high, _MIN_LOG2_SCALE)
        return -size, size
    middle, factor = (low * high) ** 0.5, 2.0**_MIN_LOG2_SCALE
    return min(low, middle / factor), max(high, middle * factor)


def worst(
    views: Sequence[MapView], measure: str, percent: float, whole_islands: bool, limit: float | None = None
) -> list[np.ndarray]:
    """Return the faces of each map, (F,) bool, that are the worst part of the whole surface, or beyond a limit.

    Args:
        views: at least one.
        measure: `choices.LOOK_ANGLE` or `choices.LOOK_SIZE`.
        percent: of the surface, 0 to 100; at least one face or island is chosen.
        whole_islands: choose islands by their averages.
        limit: instead of `percent`, the quasi-conformal distortion, or the factor between scale and median, beyond
            which faces or islands are chosen.
    """
    if measure == choices.LOOK_SIZE:
        median = median_log2_scale(views)
        badness = [np.abs(view.log2_scale - median) for view in views]
        limit = None if limit is None else float(np.log2(max(limit, 1.0)))
    else:
        badness = [view.qc for view in views]
    if whole_islands:
        badness = [_island_means(view, values) for view, values in zip(views, badness)]
    counts = np.cumsum([len(values) for values in badness])[:-1]
    values, areas = np.nan_to_num(np.concatenate(badness), nan=_LARGE, posinf=_LARGE), _joined(views, "area")
    chosen = np.zeros(len(values), dtype=bool)
    if limit is not None:
        chosen = (areas > 0.0) & (values > limit)
    elif areas.any():
        order = np.argsort(-values, kind="stable")
        order = order[areas[order] > 0.0]
        before = np.cumsum(areas[order]) - areas[order]
        last = order[np.flatnonzero(before < percent / 100.0 * areas.sum())[-1]]
        # And all others that are equally bad: every face of an island, both sides of a symmetric mesh.
        chosen = (areas > 0.0) & (values >= values[last])
    return np.split(chosen, counts)


def _island_means(view: MapView, values: np.ndarray) -> np.ndarray:
    """Return the mean of the `values` (F,) over the surface of the island of every face."""
    island = np.where(view.area > 0.0, view.island_of_face, -1)
    n = int(island.max(initial=-1)) + 1
    total = chart_sums(view.area * np.nan_to_num(values, nan=_LARGE, posinf=_LARGE), island, n)
    # The last is for faces without an island.
    return np.append(total / np.maximum(chart_sums(view.area, island, n), np.finfo(float).tiny), 0.0)[island]
