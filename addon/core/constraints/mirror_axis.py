# SPDX-License-Identifier: GPL-3.0-or-later
"""The mirror plane of an island in space, and the edges on it."""

import itertools

import numpy as np

from ..mesh.charts import chart_of_face, twins
from ..mesh.polygon_mesh import PolygonMesh
from .marks import AXIS, Marks, edges_of_corners

# Relative to the diagonal of the bounding box: more than the errors of single precision and of modeling by hand.
_TOLERANCE = 1e-4
# Fraction of the vertices with a mirror image: an island with a detail on one side still counts.
_MIN_MIRRORED = 0.9


def mirror_axes(mesh: PolygonMesh, faces: np.ndarray) -> Marks:
    """Mark the edges on the mirror plane of each island of `faces` (F,) bool that has one.

    Candidates are perpendicular to an axis of the object or of inertia, and pass through the center of the bounding
    box or of the vertices. The one with the most mirrored vertices wins, the first of equals. Seams inside an island,
    as of the side of a cylinder, must be mirrored, too.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    chart, twin, edges = chart_of_face(mesh, faces), twins(mesh), edges_of_corners(mesh)
    following = mesh.next_corner()
    of_corner = chart[mesh.face_of_corner()]
    marks: Marks = {}
    for number in range(chart.max(initial=-1) + 1):
        corners = np.flatnonzero((of_corner == number) & (twin >= 0))
        inner = np.unique(edges[corners[of_corner[twin[corners]] == number]], axis=0)
        vertices = np.unique(mesh.corner_vertices[of_corner == number])
        points = mesh.vertices[vertices]
        ends = np.searchsorted(vertices, inner)
        corner = np.flatnonzero(of_corner == number)
        cut, sides = np.unique(edges[corner[twin[corner] < 0]], axis=0, return_counts=True)
        seams = mesh.vertices[cut[sides > 1]].mean(axis=1)
        three = [corner, following[corner], following[following[corner]]]
        three = np.searchsorted(vertices, mesh.corner_vertices[three])
        best = 0.0
        found = np.empty((0, 2), dtype=np.int64)
        for normal, center in _planes(points):
            distance = (points - center) @ normal
            size = np.linalg.norm(np.ptp(points, axis=0))
            is_on = np.abs(distance) <= _TOLERANCE * size
            on_plane = is_on[ends].all(axis=1)
            # Nor the plane of faces, which mirrors a flat island onto itself.
            if not on_plane.any() or is_on[three].all(axis=0).any():
                continue
            share = _share_of_images(points, _mirrored(points, normal, center), _TOLERANCE * size)
            if len(seams):
                share = min(share, _share_of_images(seams, _mirrored(seams, normal, center), _TOLERANCE * size))
            if share >= _MIN_MIRRORED and share > best:
                best, found = share, inner[on_plane]
        marks.update(dict.fromkeys(map(tuple, found.tolist()), AXIS))
    return marks


def _mirrored(points: np.ndarray, normal: np.ndarray, center: np.ndarray) -> np.ndarray:
    return points - 2.0 * ((points - center) @ normal)[:, None] * normal


def _planes(points: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return candidates for the mirror plane of points (N, 3), each as its normal and a point on it."""
    if not np.isfinite(points).all():
        return []
    middle, mean = (points.min(axis=0) + points.max(axis=0)) / 2.0, points.mean(axis=0)
    inertia = np.linalg.eigh(np.cov((points - mean).T))[1].T if len(points) > 2 else np.empty((0, 3))
    return [*itertools.product(np.eye(3), (middle, mean)), *((normal, mean) for normal in inertia)]


def _share_of_images(points: np.ndarray, images: np.ndarray, tolerance: float) -> float:
    """Return the fraction of the `images` (N, 3) that lies within the `tolerance` of a point (N, 3)."""
    # Two points this close share a cell of one of the eight grids that are shifted by half a cell.
    cell = 4.0 * tolerance
    low = np.minimum(points.min(axis=0), images.min(axis=0))
    is_met = np.zeros(len(points), dtype=bool)
    for shift in itertools.product((0.0, 0.5), repeat=3):
        own, other = (np.floor((each - low) / cell + shift).astype(np.int64) for each in (points, images))
        n = np.maximum(own.max(axis=0), other.max(axis=0)) + 1
        keys, other_keys = (each[:, 0] + n[0] * (each[:, 1] + n[1] * each[:, 2]) for each in (own, other))
        order = np.argsort(keys, kind="stable")
        at = np.minimum(np.searchsorted(keys[order], other_keys), len(points) - 1)
        nearest = order[at]
        same = keys[nearest] == other_keys
        is_met |= same & (np.linalg.norm(points[nearest] - images, axis=1) <= tolerance)
    return float(is_met.mean())
