# SPDX-License-Identifier: GPL-3.0-or-later
"""What the UV map of a mesh looks like, in numbers and as arrays to draw."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import choices, native

# Percentiles of the surface between which an automatic range lies; the rest is seldom of interest, and large.
_PERCENTILES = (2.0, 98.0)
# An automatic range is no narrower: differences below are not seen in a texture.
_LEAST_QC = 0.2
_LEAST_LOG2_SCALE = 0.25
# What stands for an infinite or missing value in what is drawn.
_LARGE = 1e30


@dataclass(frozen=True)
class MapArrays:
    """A mesh and its UV map as Blender stores them; V vertices, F faces, C corners.

    Attributes:
        positions: (V, 3) float32 in object space.
        face_offsets: (F + 1,) int32.
        corner_vertices: (C,) int32.
        uv: (C, 2) float32.
        visible_faces: (F,) bool.
        uv_faces: (F,) bool, the faces whose UVs the UV editor shows.
        aspect: width over height of the image that the map is for.
    """

    positions: np.ndarray
    face_offsets: np.ndarray
    corner_vertices: np.ndarray
    uv: np.ndarray
    visible_faces: np.ndarray
    uv_faces: np.ndarray
    aspect: float = 1.0

    def mesh(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return positions, face offsets and corner vertices as `spectral_conformal` takes them."""
        return self.positions.astype(np.float64), self.face_offsets, self.corner_vertices

    def has_mesh_of(self, other: MapArrays) -> bool:
        """Return whether the mesh is the same, bit by bit, and which of its faces are visible."""
        return self._agrees(other, ("positions", "face_offsets", "corner_vertices", "visible_faces"))

    def has_map_of(self, other: MapArrays) -> bool:
        """Return whether everything else is the same, bit by bit."""
        return self._agrees(other, ("uv", "uv_faces", "aspect"))

    def _agrees(self, other: MapArrays, names: Sequence[str]) -> bool:
        return all(_same_bits(np.asarray(getattr(self, name)), np.asarray(getattr(other, name))) for name in names)


def _same_bits(mine: np.ndarray, yours: np.ndarray) -> bool:
    """Return whether arrays are the same; unlike with `equal_nan`, which takes three times as long, 0 is not -0."""
    if mine.dtype == yours.dtype == np.float32:
        mine, yours = mine.view(np.int32), yours.view(np.int32)
    return mine is yours or np.array_equal(mine, yours)


@dataclass(frozen=True)
class IslandNumbers:
    """Numbers of some islands of a map together.

    Attributes:
        faces: number of visible faces.
        mapped: how many of these have a surface, and one in the map.
        mean_qc: quasi-conformal distortion averaged over the surface; NaN without surface.
        max_qc: the largest of a face.
        log2_scale_deviation: standard deviation over the surface of the binary logarithm of the scale.
        log2_scale: its median over the surface.
        flipped: number of faces.
        overlapping: number of faces.
    """

    faces: int
    mapped: int
    mean_qc: float
    max_qc: float
    log2_scale_deviation: float
    log2_scale: float
    flipped: int
    overlapping: int


class MapView:
    """What is known of the UV map of one mesh; everything is computed when it is first asked for.

    Raises NativeModuleError where `spectral_conformal` cannot be imported, whatever is asked.
    """

    def __init__(self, arrays: MapArrays, before: MapView | None = None) -> None:
        """Take the arrays as they are, and what is known of the same mesh with the map that it had `before`."""
        self.arrays = arrays
        if before is not None:
            self.triangles = before.triangles

    @functools.cached_property
    def _distortion(self) -> object:
        arrays = self.arrays
        shown = arrays.uv
        if arrays.aspect != 1.0:
            # As the image shows it, at the same area.
            shown = shown * np.array((arrays.aspect**0.5, arrays.aspect**-0.5))
        return native.spectral_conformal().face_distortion(*arrays.mesh(), shown, selected_faces=arrays.visible_faces)

    @property
    def qc(self) -> np.ndarray:
        """Quasi-conformal distortion of every face, (F,) float64, as `spectral_conformal.face_distortion` has it."""
        return self._distortion.qc

    @property
    def log2_scale(self) -> np.ndarray:
        """Binary logarithm of the linear scale of every face, (F,) float64, UVs over object space."""
        return self._distortion.log2_scale

    @property
    def area(self) -> np.ndarray:
        """Area of every face in object space, (F,) float64; 0 where it is not visible or cannot be measured."""
        return self._distortion.area

    @functools.cached_property
    def triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """The visible faces as triangles: their corners, (T, 3), and the face of each, (T,), both int32."""
        arrays = self.arrays
        return native.spectral_conformal().hosts.face_triangles(*arrays.mesh(), selected_faces=arrays.visible_faces)

    @functools.cached_property
    def _defects(self) -> object:
        arrays = self.arrays
        finite = np.isfinite(arrays.uv).all(axis=1)
        faces = arrays.visible_faces.copy()
        if not finite.all():
            faces[np.repeat(np.arange(len(faces)), np.diff(arrays.face_offsets))[~finite]] = False
        return native.spectral_conformal().map_defects(
            arrays.face_offsets,
            arrays.corner_vertices,
            np.where(finite[:, None], arrays.uv, 0.0),
            selected_faces=faces,
        )

    @property
    def flipped(self) -> np.ndarray:
        """Which faces lie the wrong way round in their island, (F,) bool."""
        return self._defects.flipped

    @property
    def overlapping(self) -> np.ndarray:
        """Which faces cover others of their island, (F,) bool."""
        return self._defects.overlapping

    @property
    def island_of_face(self) -> np.ndarray:
        """Which island every face belongs to, (F,) int32, -1 for none."""
        return self._defects.island_of_face

    @functools.cached_property
    def median_log2_scale(self) -> float:
        """`log2_scale` in the middle of the surface; 0 where nothing is mapped."""
        return weighted_percentiles(self.log2_scale, self.area, (50.0,))[0] if self.is_measured.any() else 0.0

    @property
    def is_measured(self) -> np.ndarray:
        """Which faces have a surface and a finite size in the map, (F,) bool."""
        return (self.area > 0.0) & np.isfinite(self.log2_scale)

    def values(self, kind: str, density: float = 1.0) -> np.ndarray:
        """Return what is shown of every face, (F,) float64.

        Args:
            kind: one of `choices.LOOK_ANGLE` (quasi-conformal distortion), `LOOK_SIZE` (binary logarithm of the scale
                over its median), `LOOK_DENSITY` (pixels per unit of length), `LOOK_DEFECTS` (1 flipped, 0.5
                overlapping, 0 neither) and `LOOK_CHECKER`, which shows none.
            density: root of the number of pixels that a UV tile has.
        """
        if kind == choices.LOOK_ANGLE:
            return self.qc
        if kind == choices.LOOK_SIZE:
            return self.log2_scale - self.median_log2_scale
        if kind == choices.LOOK_DENSITY:
            return density * np.exp2(self.log2_scale)
        if kind == choices.LOOK_DEFECTS:
            return np.where(self.flipped, 1.0, np.where(self.overlapping, 0.5, 0.0))
        return np.zeros(len(self.arrays.visible_faces))

    def triangle_positions(self) -> np.ndarray:
        """Return where the corners of the triangles are, (3 T, 3) float32."""
        # Taking rows is three times as fast as indexing them.
        return self.arrays.positions.take(self.arrays.corner_vertices.take(self.triangles[0].ravel()), axis=0)

    def triangle_map(self, kind: str, density: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """Return UVs (3 T, 2) and values (3 T,) of the corners of the triangles, float32."""
        corners, face = self.triangles
        with np.errstate(over="ignore"):
            values = np.nan_to_num(self.values(kind, density), nan=_LARGE, posinf=_LARGE, neginf=-_LARGE)
        return self.arrays.uv.take(corners.ravel(), axis=0), values.astype(np.float32).take(face).repeat(3)

    def face_at(self, point: Sequence[float]) -> int:
        """Return a face that covers a place of the map, (u, v), of those that the UV editor shows; -1 for none."""
        corners, face = self.triangles
        arms = self.arrays.uv.take(corners, axis=0) - np.asarray(point, dtype=np.float64)
        u, v = arms[..., 0], arms[..., 1]
        with np.errstate(all="ignore"):
            turns = u * np.roll(v, -1, axis=1) - v * np.roll(u, -1, axis=1)
            covers = (turns >= 0.0).all(axis=1) | (turns <= 0.0).all(axis=1)
        covers &= self.is_in_uv_editor() & (turns != 0.0).any(axis=1)
        return int(face[covers.argmax()]) if covers.any() else -1

    def is_in_uv_editor(self) -> np.ndarray:
        """Return which of the triangles the UV editor shows, (T,) bool."""
        return self.arrays.uv_faces[self.triangles[1]]

    def numbers(self, islands: Sequence[int] | None = None) -> IslandNumbers:
        """Return the numbers of some islands, of all visible faces when left out."""
        if islands is None:
            return joined_numbers([self])
        return _numbers([(self, np.isin(self.island_of_face, islands))])


def joined_numbers(views: Sequence[MapView]) -> IslandNumbers:
    """Return the numbers of all visible faces of at least one map together."""
    return _numbers([(view, view.arrays.visible_faces) for view in views])


def _numbers(parts: Sequence[tuple[MapView, np.ndarray]]) -> IslandNumbers:
    """Return the numbers of the chosen faces, (F,) bool, of some maps together."""
    counted = [(view, chosen & view.is_measured) for view, chosen in parts]
    weights, scale, qc = (
        np.concatenate([getattr(view, name)[faces] for view, faces in counted]) for name in ("area", "log2_scale", "qc")
    )
    means = (float("nan"),) * 4
    if len(qc):
        mean_scale = float(np.average(scale, weights=weights))
        means = (
            float(np.average(qc, weights=weights)),
            float(qc.max()),
            float(np.sqrt(np.average((scale - mean_scale) ** 2, weights=weights))),
            weighted_percentiles(scale, weights, (50.0,))[0],
        )
    faces, flipped, overlapping = (
        sum(int(flags[chosen].sum()) for flags, chosen in found)
        for found in (
            [(chosen, chosen) for _, chosen in parts],
            [(view.flipped, chosen) for view, chosen in parts],
            [(view.overlapping, chosen) for view, chosen in parts],
        )
    )
    return IslandNumbers(faces, len(qc), *means, flipped, overlapping)


def weighted_percentiles(values: np.ndarray, weights: np.ndarray, percentiles: Sequence[float]) -> list[float]:
    """Return the values below which the given percentages of the weights lie; those that are not finite do not count.

    At least one finite value must have a weight.
    """
    counted = (weights > 0.0) & np.isfinite(values)
    order = np.argsort(values[counted])
    sums = np.cumsum(weights[counted][order])
    places = np.searchsorted(sums, np.asarray(percentiles) / 100.0 * sums[-1])
    return values[counted][order][np.minimum(places, len(order) - 1)].tolist()


def automatic_range(views: Sequence[MapView], kind: str, density: float = 1.0) -> tuple[float, float]:
    """Return the values to show as the two ends of the colours: what most of the surface of all meshes has.

    Sizes are centred at the median, angles begin at 1; either range has a least width, so that a good map looks good.
    """
    if kind in (choices.LOOK_DEFECTS, choices.LOOK_CHECKER):
        return 0.0, 1.0
    values = np.concatenate([view.values(kind, density) for view in views])
    weights = np.concatenate([view.area for view in views])
    if not ((weights > 0.0) & np.isfinite(values)).any():
        return (1.0, 1.0 + _LEAST_QC) if kind == choices.LOOK_ANGLE else (-1.0, 1.0)
    low, high = weighted_percentiles(values, weights, _PERCENTILES)
    if kind == choices.LOOK_ANGLE:
        return 1.0, max(high, 1.0 + _LEAST_QC)
    if kind == choices.LOOK_SIZE:
        size = max(-low, high, _LEAST_LOG2_SCALE)
        return -size, size
    middle, factor = (low * high) ** 0.5, 2.0**_LEAST_LOG2_SCALE
    return min(low, middle / factor), max(high, middle * factor)


def worst(
    views: Sequence[MapView],
    measure: str,
    percent: float,
    whole_islands: bool,
    limit: float | None = None,
) -> list[np.ndarray]:
    """Return the faces of each map, (F,) bool, that are the worst part of the surface of all, or worse than a limit.

    Args:
        views: at least one.
        measure: `choices.LOOK_ANGLE` or `choices.LOOK_SIZE`.
        percent: of the surface, 0 to 100; at least one face or island is chosen.
        whole_islands: choose islands by their averages.
        limit: in place of `percent`, quasi-conformal distortion above which, or factor of the scale over its median, or
            under it, beyond which faces or islands are chosen.
    """
    if measure == choices.LOOK_SIZE:
        scales, areas = (np.concatenate([getattr(v, name) for v in views]) for name in ("log2_scale", "area"))
        is_measured = (areas > 0.0) & np.isfinite(scales)
        median = weighted_percentiles(scales, areas, (50.0,))[0] if is_measured.any() else 0.0
        badness = [np.abs(view.log2_scale - median) for view in views]
        least = None if limit is None else float(np.log2(max(limit, 1.0)))
    else:
        badness, least = [view.qc for view in views], limit
    if whole_islands:
        badness = [_island_means(view, values) for view, values in zip(views, badness)]
    counts = np.cumsum([len(values) for values in badness])[:-1]
    values, areas = np.concatenate(badness), np.concatenate([view.area for view in views])
    values = np.nan_to_num(values, nan=_LARGE, posinf=_LARGE)
    chosen = np.zeros(len(values), dtype=bool)
    if least is not None:
        chosen = (areas > 0.0) & (values > least)
    elif areas.any():
        order = np.argsort(-values, kind="stable")
        order = order[areas[order] > 0.0]
        before = np.cumsum(areas[order]) - areas[order]
        last = order[np.flatnonzero(before < percent / 100.0 * areas.sum())[-1]]
        # With it all that are as bad: of an island every face, of a symmetric mesh both sides.
        chosen = (areas > 0.0) & (values >= values[last])
    return np.split(chosen, counts)


def _island_means(view: MapView, values: np.ndarray) -> np.ndarray:
    """Return the mean of the `values` (F,) over the surface of the island of every face."""
    island = view.island_of_face
    counted = (island >= 0) & (view.area > 0.0)
    n = int(island.max(initial=-1)) + 1
    area = np.bincount(island[counted], view.area[counted], n)
    total = np.bincount(island[counted], (view.area * np.nan_to_num(values, nan=_LARGE, posinf=_LARGE))[counted], n)
    means = np.zeros(len(values))
    means[counted] = (total / np.maximum(area, np.finfo(float).tiny))[island[counted]]
    return means
