# SPDX-License-Identifier: GPL-3.0-or-later
"""A band around islands in the UV plane, as wide as each island's share of the margin."""

import numpy as np

# Corners of the polygon that stands for a disk around a corner of the border: it misses 8 % of the width at most.
_SIDES = 8


def border(point: np.ndarray, following: np.ndarray, counted: np.ndarray) -> np.ndarray:
    """Return the corners at which an edge on the border of an island begins, (N,) int.

    Args:
        point: (C,) the point of the map of every corner.
        following: (C,) the next corner in the face of every corner.
        counted: (C,) bool, the corners of faces that are shown.
    """
    corners = np.flatnonzero(counted)
    edges = np.sort(np.column_stack([point[corners], point[following[corners]]]).astype(np.int64), axis=1)
    _, index, count = np.unique(edges @ (len(point), 1), return_inverse=True, return_counts=True)
    return corners[count[index.ravel()] == 1]


def triangles(start: np.ndarray, end: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return triangles, (3 T, 2), that cover all points within a width of the segments.

    Args:
        start: (N, 2) of every segment.
        end: (N, 2).
        width: (N, 2) along both axes, different for a texture that is not square.
    """
    one, two = start / width, end / width
    along = two - one
    length = np.linalg.norm(along, axis=1, keepdims=True)
    side = np.column_stack([-along[:, 1], along[:, 0]]) / np.where(length > 0.0, length, 1.0)
    quads = np.stack([one - side, two - side, two + side, one - side, two + side, one + side], axis=1)
    turns = 2.0 * np.pi * np.arange(_SIDES + 1) / _SIDES
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    fan = np.stack([np.zeros((_SIDES, 2)), circle[:-1], circle[1:]], axis=1).reshape(-1, 2)
    disks = one[:, None] + fan[None]
    scaled = [part * width[:, None] for part in (quads, disks)]
    return np.concatenate([part.reshape(-1, 2) for part in scaled])
