# SPDX-License-Identifier: GPL-3.0-or-later
"""The mirror plane of an island in space and the edges on it; islands that mirror each other."""

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..mesh.charts import chart_of_face, corner_edge_keys, twins
from ..mesh.polygon_mesh import PolygonMesh
from .marks import AXIS, CROSSING, Edge, Marks, edges_of_corners

# Relative to the diagonal of the bounding box: more than the errors of single precision and of modeling by hand.
_TOLERANCE = 1e-4
# Fraction of the vertices with a mirror image: an island with a detail on one side still counts.
_MIN_MIRRORED = 0.9
# Moments of inertia this near, relative to the largest, leave the direction of a mirror plane open.
_EQUAL_MOMENTS = 1e-3
# So many images decide that most candidates are no mirror planes.
_SAMPLES = 64

_Plane = tuple[np.ndarray, np.ndarray]
"""Its normal, of length 1, and a point on it."""


def mirror_axes(mesh: PolygonMesh, faces: np.ndarray) -> Marks:
    """Mark the edges on the mirror plane of each island of `faces` (F,) bool that has one, or those that cross it.

    A plane that passes only between the vertices has no edges, and is marked by those that are their own images; an
    edge between two islands only if it is its own image in both, because both would obey the mark. So an island all of
    whose marks lie on seams hands its plane on to the islands beside it that have no better one.

    Candidates pass through the center of the bounding box or of the vertices, or the object's origin, and are
    perpendicular to an axis of the object or of inertia; where inertia leaves the direction open, they take one vertex
    to another. The one with the most mirrored vertices wins, the first of equals. Seams inside an island, as of the
    side of a cylinder, must be mirrored, too.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    islands = _Islands(mesh, chart_of_face(mesh, faces))
    found = islands.among(faces)
    for island in found:
        for plane in _planes(island.points, island.tolerance):
            island.take_if_better(plane)
    keys, of_visible = corner_edge_keys(mesh), mesh.selected_faces[mesh.face_of_corner()]

    def crossing() -> np.ndarray:
        """Return the corners whose edges cross the planes on all of their sides, (C,) bool."""
        on_one = np.zeros(len(keys), dtype=bool)
        for island in found:
            on_one[island.across] = True
        return on_one & ~np.isin(keys, keys[of_visible & ~on_one])

    crosses = crossing()
    for island in found:
        if len(island.across) and not crosses[island.across].any():
            beside = np.unique(islands.of_corner[np.isin(keys, keys[island.across])])
            others = [other for other in found if other is not island and other.number in beside]
            if any([other.adopts(island.plane) for other in others]):
                crosses = crossing()
    edges = islands.edges
    on_plane = np.concatenate([np.empty(0, int), *(island.on_plane for island in found)])
    marks: Marks = dict.fromkeys(map(tuple, edges[on_plane].tolist()), AXIS)
    return {**marks, **dict.fromkeys(map(tuple, edges[crosses].tolist()), CROSSING)}


def seams_alone_differ(mesh: PolygonMesh, faces: np.ndarray) -> bool:
    """Return whether a connected part of the mesh with some of `faces` (F,) bool mirrors, but its seams do not.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    without = replace(mesh, seam_edges=mesh.seam_edges[:0])
    parts = _Islands(mesh, chart_of_face(without, mesh.selected_faces)).among(faces)
    return any(each.seams_alone_differ(plane) for each in parts for plane in _planes(each.points, each.tolerance))


class _Islands:
    """The islands of a mesh, as the corners of its edges see them.

    Attributes:
        of_corner: the island of every corner, (C,), -1 for none.
        edges: the ends of the edge from every corner to the next, (C, 2).
    """

    def __init__(self, mesh: PolygonMesh, island: np.ndarray) -> None:
        """Store the `island` of every face, (F,) int; -1 for none."""
        self.mesh, self.twin, self.edges = mesh, twins(mesh), edges_of_corners(mesh)
        self.face = mesh.face_of_corner()
        self.of_corner = island[self.face]

    def among(self, faces: np.ndarray) -> "list[_Island]":
        """Return the islands with some of `faces` (F,) bool that are finite."""
        numbers = np.unique(self.of_corner[faces[self.face] & (self.of_corner >= 0)])
        return [each for each in map(self._island, numbers.tolist()) if each is not None]

    def _island(self, number: int) -> "_Island | None":
        corner = np.flatnonzero(self.of_corner == number)
        inner = corner[self.twin[corner] >= 0]
        inner = inner[self.of_corner[self.twin[inner]] == number]
        points = self.mesh.vertices[np.unique(self.mesh.corner_vertices[corner])]
        if not np.isfinite(points).all():
            return None
        cut, sides = np.unique(self.edges[corner[self.twin[corner] < 0]], axis=0, return_counts=True)
        return _Island(self, number, corner, inner, points, self.mesh.vertices[cut[sides > 1]].mean(axis=1))


class _Island:
    """An island, and the mirror plane found for it so far.

    Attributes:
        number: of the island.
        points: its vertices, (N, 3).
        tolerance: within which points are equal.
        plane: None for none.
        on_plane: the corners of the inner edges on it.
        across: if there are none, those of the edges that it takes to themselves.
    """

    def __init__(
        self,
        islands: _Islands,
        number: int,
        corner: np.ndarray,
        inner: np.ndarray,
        points: np.ndarray,
        seams: np.ndarray,
    ) -> None:
        """Begin without a plane; `seams` are the middles of the seams within, (S, 3)."""
        self._islands, self._corner, self._inner = islands, corner, inner
        self.number, self.points = number, points
        self.tolerance = _TOLERANCE * np.linalg.norm(np.ptp(points, axis=0))
        self._lookups = [_Lookup(each, self.tolerance) for each in (points, seams) if len(each)]
        self._share = 0.0
        self.plane: _Plane | None = None
        self.on_plane = self.across = corner[:0]

    def take_if_better(self, plane: _Plane) -> None:
        """Take the plane if it mirrors more of the island; one with edges on it goes before others."""
        on_plane, across = self._lines(plane)
        is_first = len(on_plane) > 0 and not len(self.on_plane)
        if not len(on_plane) and (len(self.on_plane) or not len(across)):
            return
        least = 0.0 if is_first else self._share
        share = self._mirrored(plane, least)
        if share >= _MIN_MIRRORED and share > least:
            self._share, self.plane = share, plane
            self.on_plane, self.across = (on_plane, self._corner[:0]) if len(on_plane) else (on_plane, across)

    def adopts(self, plane: _Plane) -> bool:
        """Take the plane of an island beside this one if it is as good, and no edge lies on this one's."""
        _, across = self._lines(plane)
        share = self._mirrored(plane)
        if len(self.on_plane) or not len(across) or share < max(_MIN_MIRRORED, self._share):
            return False
        self._share, self.plane, self.across = share, plane, across
        return True

    def seams_alone_differ(self, plane: _Plane) -> bool:
        """Return whether the plane mirrors the island, but not its seams."""
        surface, *seams = (each.share_mirrored(plane, 0.0) for each in self._lookups)
        return surface >= _MIN_MIRRORED > min(seams, default=1.0)

    def _mirrored(self, plane: _Plane, best: float = 0.0) -> float:
        return min(each.share_mirrored(plane, best) for each in self._lookups)

    def _lines(self, plane: _Plane) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of the inner edges on a plane, and of all edges that it takes to themselves."""
        of, mesh, inner = self._islands, self._islands.mesh, self._inner
        distance = (mesh.vertices - plane[1]) @ plane[0]
        is_on = np.abs(distance) <= self.tolerance
        # Edges of faces within the plane, as of a flat island, have nothing to mirror beside them.
        beside = _sides(mesh, np.where(is_on, 0.0, distance), of.face)
        is_between = beside[of.face[inner]] * beside[of.face[of.twin[inner]]] < 0.0
        across = _are_own_images(mesh.vertices[of.edges[self._corner]], plane, self.tolerance)
        return inner[is_on[of.edges[inner]].all(axis=1) & is_between], self._corner[across]


def mirrored_pairs(mesh: PolygonMesh, faces: np.ndarray) -> list[list[Edge]]:
    """Return the islands of `faces` (F,) bool that mirror another one, each pair by its inner edges.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    chart = chart_of_face(mesh, faces)
    number = chart[chart >= 0]
    face, edges = mesh.face_of_corner(), edges_of_corners(mesh)
    points = mesh.vertices[mesh.corner_vertices]
    centers = np.stack([np.bincount(face, points[:, axis], len(chart)) for axis in range(3)], axis=1)
    centers = (centers / np.maximum(np.bincount(face, minlength=len(chart)), 1)[:, None])[chart >= 0]
    if not len(number) or not np.isfinite(centers).all():
        return []
    tolerance = _TOLERANCE * np.linalg.norm(np.ptp(centers, axis=0))
    lookup, sizes = _Lookup(centers, tolerance), np.bincount(number)
    best: list[tuple[int, int]] = []
    for plane in _planes(centers, tolerance):
        image = lookup.indices(_mirrored(centers, plane))
        met = image >= 0
        pair, counts = np.unique(np.stack([number[met], number[image[met]]], axis=1), axis=0, return_counts=True)
        # The image of the image is the island itself, so it is enough to look from the first of both.
        is_pair = (pair[:, 0] < pair[:, 1]) & (counts >= _MIN_MIRRORED * sizes[pair].max(axis=1))
        if is_pair.sum() > len(best):
            best = [(int(one), int(other)) for one, other in pair[is_pair]]
    # Edges on a seam belong to the islands beside it, too.
    of_corner = np.where(twins(mesh) >= 0, chart[face], -1)
    return [list(map(tuple, np.unique(edges[np.isin(of_corner, pair)], axis=0).tolist())) for pair in best]


def _are_own_images(ends: np.ndarray, plane: _Plane, tolerance: float) -> np.ndarray:
    """Return which edges, given their ends (N, 2, 3), a plane takes to themselves by exchanging the ends, (N,) bool."""
    away = np.linalg.norm(_mirrored(ends[:, 0], plane) - ends[:, 1], axis=1)
    return (away <= tolerance) & (np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) > 2.0 * tolerance)


def _sides(mesh: PolygonMesh, distance: np.ndarray, face: np.ndarray) -> np.ndarray:
    """Return on which side of a plane every face lies, (F,): the `distance` of its farthest vertex, (V,)."""
    of_corner = distance[mesh.corner_vertices]
    low, high = np.zeros(len(mesh.selected_faces)), np.zeros(len(mesh.selected_faces))
    np.minimum.at(low, face, of_corner)
    np.maximum.at(high, face, of_corner)
    return np.where(high >= -low, high, low)


def _mirrored(points: np.ndarray, plane: _Plane) -> np.ndarray:
    normal, center = plane
    return points - 2.0 * ((points - center) @ normal)[:, None] * normal


def _planes(points: np.ndarray, tolerance: float) -> Iterator[_Plane]:
    """Yield candidates for the mirror plane of points (N, 3), which are finite."""
    middle, mean = (points.min(axis=0) + points.max(axis=0)) / 2.0, points.mean(axis=0)
    yield from itertools.product(np.eye(3), (middle, mean, np.zeros(3)))
    if len(points) < 3:
        return
    moments, directions = np.linalg.eigh(np.cov((points - mean).T))
    yield from ((normal, mean) for normal in directions.T)
    if np.diff(moments).min() > _EQUAL_MOMENTS * moments[-1]:
        return
    # A mirror plane passes through the mean. Of three vertices that span space with it, one is not on the plane, and
    # has its image at the same distance from the mean.
    arms = points - mean
    length = np.linalg.norm(arms, axis=1)
    first = arms[length.argmax()]
    second = arms[np.linalg.norm(np.cross(arms, first), axis=1).argmax()]
    third = arms[np.abs(arms @ np.cross(first, second)).argmax()]
    for arm in (first, second, third):
        between = arms[np.abs(length - np.linalg.norm(arm)) <= tolerance] - arm
        size = np.linalg.norm(between, axis=1)
        yield from ((each, mean) for each in between[size > tolerance] / size[size > tolerance, None])


class _Lookup:
    """Finds points (N, 3), N > 0, that are near others."""

    def __init__(self, points: np.ndarray, tolerance: float) -> None:
        """Prepare to find points up to the `tolerance` away."""
        self._points, self._tolerance = points, tolerance
        # Two points this close share a cell of one of the eight grids that are shifted by half a cell.
        self._cell = max(4.0 * tolerance, np.finfo(float).tiny)
        self._low = points.min(axis=0) - self._cell
        self._n = self._cells(points, 1.0).max(axis=0) + 2
        self._grids = []
        for shift in itertools.product((0.0, 0.5), repeat=3):
            keys = self._keys(points, shift)
            order = np.argsort(keys, kind="stable")
            self._grids.append((shift, keys[order], order))

    def indices(self, others: np.ndarray) -> np.ndarray:
        """Return for each of the `others` (M, 3) a point within the tolerance, (M,) int; -1 for none."""
        found = np.full(len(others), -1)
        inside = ((others >= self._low) & (others <= self._points.max(axis=0) + self._cell)).all(axis=1)
        others = np.where(inside[:, None], others, self._low)
        for shift, keys, order in self._grids:
            own = self._keys(others, shift)
            at = np.minimum(np.searchsorted(keys, own), len(keys) - 1)
            near = order[at]
            is_met = inside & (keys[at] == own)
            is_met &= np.linalg.norm(self._points[near] - others, axis=1) <= self._tolerance
            found[is_met & (found < 0)] = near[is_met & (found < 0)]
        return found

    def share_mirrored(self, plane: _Plane, best: float) -> float:
        """Return the fraction of the points with a mirror image; 0 if it is surely below `_MIN_MIRRORED` or `best`."""
        images = _mirrored(self._points, plane)
        some = images[:: max(1, len(images) // _SAMPLES)]
        # Half of that: images that are missing may lie together.
        if best >= 1.0 or (self.indices(some) >= 0).mean() < 0.5 * _MIN_MIRRORED:
            return 0.0
        return float((self.indices(images) >= 0).mean())

    def _cells(self, points: np.ndarray, shift: "float | tuple[float, float, float]") -> np.ndarray:
        return np.floor((points - self._low) / self._cell + shift).astype(np.int64)

    def _keys(self, points: np.ndarray, shift: tuple[float, float, float]) -> np.ndarray:
        cells = self._cells(points, shift)
        return cells[:, 0] + self._n[0] * (cells[:, 1] + self._n[1] * cells[:, 2])
