"""Shared by all measurements of meshes and maps: averages over the surface, corners and edges of faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from . import _native

# Of log2 of the scale, weighted by area: a texture is 1.4 times as coarse as on average over much of an island, as
# where an open tube becomes a ring whose sizes differ four times.
_UNEVEN = 0.5


def next_corner(face_offsets: npt.NDArray[np.integer]) -> npt.NDArray[np.int64]:
    """Return the next corner in the face of every corner, (C,); a face may have none."""
    following = np.arange(1, face_offsets[-1] + 1, dtype=np.int64)
    has_corners = face_offsets[1:] > face_offsets[:-1]
    following[face_offsets[1:][has_corners] - 1] = face_offsets[:-1][has_corners]
    return following


def edge_keys(edges: npt.NDArray[np.integer], n_vertices: int) -> npt.NDArray[np.int64]:
    """Return one number per edge, (N,), the same for both directions, given its two vertices, (N, 2)."""
    first, second = edges.reshape(-1, 2).T
    return np.minimum(first, second).astype(np.int64) * n_vertices + np.maximum(first, second)


def edges_between(
    values: npt.NDArray[np.integer],
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    n_vertices: int,
) -> npt.NDArray[np.integer]:
    """Return the edges, (n, 2), the lower vertex first, whose faces have different values, (F,)."""
    if (values == values[:1]).all():
        return np.zeros((0, 2), dtype=corner_vertices.dtype)
    pairs = np.sort(np.stack([corner_vertices, corner_vertices[next_corner(face_offsets)]], axis=1), axis=1)
    of_corner = np.repeat(values, np.diff(face_offsets))
    keys = edge_keys(pairs, n_vertices)
    order = np.lexsort((of_corner, keys))
    keys, of_corner = keys[order], of_corner[order]
    differs = (keys[1:] == keys[:-1]) & (of_corner[1:] != of_corner[:-1])
    return np.unique(pairs[order[1:][differs]], axis=0)


def connected(offsets: npt.NDArray[np.int32], corners: npt.NDArray[np.int32], n_vertices: int) -> npt.NDArray[np.int32]:
    """Return the component of each face, (F,), in the order of their first faces; -1 for faces without corners."""
    return _native.connected_faces(offsets, corners, n_vertices)


def area_mean(values: npt.NDArray[np.floating], area: npt.NDArray[np.floating]) -> float:
    """Return the mean of `values` (N,) over the surface, given the `area` (N,) of each; NaN without area."""
    total = area.sum()
    # Dividing first keeps the products in range.
    return float((values * (area / total)).sum()) if total > 0.0 else float("nan")


def uneven(scale_deviation: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
    """Return those of the islands' deviations of log2 of the scale that are visible, and finite.

    An infinite one has collapsed faces, which are counted as such.
    """
    return scale_deviation[(scale_deviation > _UNEVEN) & np.isfinite(scale_deviation)]


def area_percentiles(
    values: npt.NDArray[np.floating], area: npt.NDArray[np.floating], percentages: Sequence[float]
) -> list[float]:
    """Return the percentiles of N values over the surface, given the `area` of each.

    Values that are not finite do not count. All are NaN if no value has an area.
    """
    counted = (area > 0.0) & np.isfinite(values)
    if not counted.any():
        return [float("nan")] * len(percentages)
    order = np.argsort(values[counted])
    below = np.cumsum(area[counted][order])
    indices = np.searchsorted(below, np.asarray(percentages) / 100.0 * below[-1])
    return values[counted][order][np.minimum(indices, len(order) - 1)].tolist()
