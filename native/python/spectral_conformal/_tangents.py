"""The tangent frames in which textures give normals."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments

# Triangles at a time: beside the result, memory does not grow with them.
_TRIANGLES_AT_ONCE = 1 << 16


def tangents(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike, uv: npt.ArrayLike, normals: npt.ArrayLike
) -> npt.NDArray[np.float64]:
    """Return the tangent of each vertex, (V, 4): the direction of growing u, across the normal, and the side of v.

    The triangles at a vertex are weighted by their angles, as in Mikkelsen, "Simulation of Wrinkled Surfaces
    Revisited", 2008; if they lie on both sides, the majority decides. Vertices that no triangle uses, or whose
    triangles have no area in the map, get any direction across the normal.

    Args:
        vertices: (V, 3) positions, split where UVs or normals differ.
        triangles: (T, 3) vertex indices.
        uv: (V, 2), v upward.
        normals: (V, 3) unit vectors.

    Raises:
        ValueError: an array is not as described here.
    """
    positions, corners, points = _arguments.checked_triangle_map(vertices, triangles, uv)
    directions = _arguments.checked_floats(normals, "normals", 3)
    if len(directions) != len(positions):
        raise ValueError(f"normals has {len(directions)} rows, but there are {len(positions)} vertices.")
    sums, sides = np.zeros((len(positions), 3)), np.zeros(len(positions))
    for first in range(0, len(corners), _TRIANGLES_AT_ONCE):
        _add_tangents(sums, sides, positions, directions, points, corners[first : first + _TRIANGLES_AT_ONCE])
    # If no triangle defines it, any direction across the normal.
    least = np.eye(3)[np.abs(directions).argmin(axis=1)] if len(directions) else np.zeros((0, 3))
    fallback = least - directions * (least * directions).sum(axis=1)[:, None]
    sums -= directions * (sums * directions).sum(axis=1)[:, None]
    has_direction = np.linalg.norm(sums, axis=1) > 1e-9
    result = _unit(np.where(has_direction[:, None], sums, fallback))
    return np.c_[result, np.where(sides < 0, -1.0, 1.0)]


def _add_tangents(
    sums: npt.NDArray[np.float64],
    sides: npt.NDArray[np.float64],
    positions: npt.NDArray[np.float64],
    normals: npt.NDArray[np.float64],
    uv: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.integer],
) -> None:
    """Add the weighted directions, (V, 3), and sides, (V,), of some triangles at their vertices."""
    corners, texels = positions[triangles], uv[triangles]
    (one, two), (first, second) = ((each[:, 1] - each[:, 0], each[:, 2] - each[:, 0]) for each in (corners, texels))
    area = first[:, 0] * second[:, 1] - second[:, 0] * first[:, 1]
    along = (one * second[:, 1:] - two * first[:, 1:]) * np.sign(area)[:, None]
    for k in range(3):
        rows, normal = triangles[:, k], normals[triangles[:, k]]
        left, right = (_unit(corners[:, (k + step) % 3] - corners[:, k]) for step in (1, 2))
        angle = np.arccos(np.clip((left * right).sum(axis=1), -1, 1))
        across = _unit(along - normal * (along * normal).sum(axis=1)[:, None])
        np.add.at(sums, rows, across * angle[:, None])
        np.add.at(sides, rows, np.sign(area) * angle)


def _unit(vectors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return vectors (n, 3) scaled to length 1; zero vectors stay zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
