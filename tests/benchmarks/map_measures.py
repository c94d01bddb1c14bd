"""Measures of any UV map: islands, length of seams, energy, flips, overlaps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.module import meshes


@dataclass(frozen=True)
class Measures:
    """Of one UV map of a polygon mesh.

    Attributes:
        islands: parts of the map that are connected over edges with the same UVs on both sides.
        length: of the edges of two faces with other UVs on either side, over the root of the area.
        energy: mean of s^2 + t^2 + 1 / s^2 + 1 / t^2 over the triangles, weighted by their area in 3D, at the scale of
            the whole map that makes it least; s and t are the singular values. 4 for an isometry.
        flipped: faces that are flipped relative to their island.
        overlapping: faces that cover part of another one of their island.
    """

    islands: int
    length: float
    energy: float
    flipped: int
    overlapping: int


def measure(vertices: np.ndarray, offsets: np.ndarray, corners: np.ndarray, uv: np.ndarray) -> Measures:
    """Measure a map: vertices (V, 3), faces as in `spectral_conformal.unwrap`, uv (corners, 2)."""
    island, seams = islands_and_seams(offsets, corners, uv)
    defects = meshes.defects(offsets, corners, uv)
    triangles = _fans(offsets, uv)
    area = _areas(vertices[corners], triangles)
    return Measures(
        islands=int(island.max()) + 1,
        length=float(np.linalg.norm(vertices[seams[:, 0]] - vertices[seams[:, 1]], axis=1).sum() / area.sum() ** 0.5),
        energy=_energy(vertices[corners], uv, triangles),
        flipped=int(defects.flipped.sum()),
        overlapping=int(defects.overlapping.sum()),
    )


def _fans(offsets: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """(triangles, 3) corners: every polygon as a fan around the first corner that sees it whole in the map, if any."""
    sizes = np.diff(offsets)
    fans = []
    for size in np.unique(sizes[sizes > 2]):
        first = offsets[:-1][sizes == size]
        steps = np.arange(1, size - 1)
        best, fewest = None, np.full(len(first), size)
        for start in range(size):
            around = [(start + k) % size for k in (0 * steps, steps, steps + 1)]
            fan = first[:, None, None] + np.stack(around, axis=1)
            a, b, c = (uv[fan[..., k]] for k in range(3))
            turns = (b - a)[..., 0] * (c - a)[..., 1] - (b - a)[..., 1] * (c - a)[..., 0]
            reversed_triangles = np.minimum((turns <= 0).sum(1), (turns >= 0).sum(1))
            better = reversed_triangles < fewest
            best = fan if best is None else np.where(better[:, None, None], fan, best)
            fewest = np.minimum(fewest, reversed_triangles)
        fans.append(best.reshape(-1, 3))
    return np.concatenate(fans)


def _areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def _energy(points: np.ndarray, uv: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    side = np.linalg.norm(b - a, axis=1)
    area = _areas(points, triangles)
    good = area > 1e-10 * np.maximum(side, np.linalg.norm(c - a, axis=1)) ** 2
    a, b, c, side, area, triangles = (values[good] for values in (a, b, c, side, area, triangles))
    along = ((c - a) * (b - a)).sum(1) / side
    first, second, third = (uv[triangles[:, k]] for k in range(3))
    to_u = (second - first) / side[:, None]
    to_v = (third - first - to_u * along[:, None]) / (2 * area / side)[:, None]
    squares = (to_u**2).sum(1) + (to_v**2).sum(1)
    determinant = to_u[:, 0] * to_v[:, 1] - to_u[:, 1] * to_v[:, 0]
    inverse = squares / np.maximum(determinant**2, 1e-24 * squares**2 + 1e-300)
    # The scale t minimizes t^2 mean(squares) + mean(inverse) / t^2.
    return float(2 * np.sqrt(np.average(squares, weights=area) * np.average(inverse, weights=area)))


def islands_and_seams(offsets: np.ndarray, corners: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(faces,) number of each face's island, and (n, 2) vertices of the edges that part islands or a slit."""
    n_faces = len(offsets) - 1
    following = np.arange(len(corners)) + 1
    following[offsets[1:] - 1] = offsets[:-1]
    face = np.repeat(np.arange(n_faces), np.diff(offsets))
    ends = np.sort(np.c_[corners, corners[following]], axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    equal = (ends[order[1:]] == ends[order[:-1]]).all(1)
    run = np.r_[0, np.cumsum(~equal)]
    twice = np.bincount(run)[run] == 2
    one, two = order[twice][0::2], order[twice][1::2]
    near = 1e-6 * np.ptp(uv, axis=0).max()

    def at(corner: np.ndarray, vertex: np.ndarray) -> np.ndarray:
        return uv[np.where(corners[corner] == vertex, corner, following[corner])]

    joined = np.all([np.abs(at(one, ends[one, k]) - at(two, ends[one, k])).max(1) <= near for k in (0, 1)], axis=0)
    label = np.arange(n_faces)
    left, right = face[one[joined]], face[two[joined]]
    while True:
        lowest = label.copy()
        np.minimum.at(lowest, left, label[right])
        np.minimum.at(lowest, right, label[left])
        lowest = lowest[lowest]
        if (lowest == label).all():
            break
        label = lowest
    return np.unique(label, return_inverse=True)[1].ravel(), ends[one[~joined]]
