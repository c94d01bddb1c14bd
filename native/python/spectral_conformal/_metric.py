"""Metrics for quasi-conformal maps (section 4.3 of the paper)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments, _native

# Beyond this ratio, a triangle is as thin as those that the solver clamps.
RATIO_LIMIT = 1e4


def metric_from_uv(vertices: npt.ArrayLike, triangles: npt.ArrayLike, uv: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the metric (F, 2, 2) of a map: J^T J. A solve with it reproduces the map up to a similarity.

    Args:
        vertices: (V, 3) positions, finite.
        triangles: (F, 3) vertex indices.
        uv: (V, 2) image of each vertex, finite. Triangles without area in 3D get the identity.

    Raises:
        ValueError: an array is not as described here, or a triangle's image has no area.
    """
    vertices, triangles, uv = _arguments.checked_triangle_map(vertices, triangles, uv)
    metric = _native.metric_from_uv(in_own_unit(vertices, triangles), triangles, in_own_unit(uv, triangles))
    bad = _native.first_not_positive_definite(metric)
    if bad >= 0:
        raise ValueError(f"The image of triangle {bad} has no area, so the map has no metric there; unfold it first.")
    return metric


def metric_from_direction(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike, directions: npt.ArrayLike, ratios: npt.ArrayLike
) -> npt.NDArray[np.float64]:
    """Return the metric (F, 2, 2) under which each triangle is `ratio` times as long along a given direction.

    Args:
        vertices: (V, 3) positions, finite.
        triangles: (F, 3) vertex indices.
        directions: (F, 3), or (3,) for all: directions in 3D, of any length, projected onto the triangles' planes. For
            a direction perpendicular to its triangle, the metric is the identity.
        ratios: (F,), or one for all: positive; above 1 the map gets longer along the direction than across it.

    Raises:
        ValueError: an array is not as described here.
    """
    vertices, triangles = _arguments.checked_triangle_mesh(vertices, triangles)
    directions = _arguments.checked_broadcast(directions, "directions", (len(triangles), 3))
    ratios = _arguments.checked_broadcast(ratios, "ratios", (len(triangles),))
    if not (np.isfinite(directions).all() and directions.any(axis=1).all()):
        raise ValueError("directions must be finite and not zero.")
    if not ((ratios >= 1.0 / RATIO_LIMIT) & (ratios <= RATIO_LIMIT)).all():
        raise ValueError(f"ratios must lie between {1.0 / RATIO_LIMIT:g} and {RATIO_LIMIT:g}.")
    return _native.metric_from_direction(in_own_unit(vertices, triangles), triangles, directions, ratios)


def blend_metric(metric: npt.ArrayLike, amount: float) -> npt.NDArray[np.float64]:
    """Return the metric between the identity (amount 0) and `metric` scaled to determinant 1 (amount 1), (F, 2, 2).

    It is the power G^amount: an amount of 0.5 turns a stretch by 4 into one by 2.

    Args:
        metric: (F, 2, 2) symmetric positive definite tensors.
        amount: 0 to 1.

    Raises:
        ValueError: the metric or amount is not as described here.
    """
    array = _arguments.checked_tensors(metric, 2)
    return _native.blend_metric(array, _arguments.checked_between(amount, 0.0, 1.0, "amount"))


def in_own_unit(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the positions scaled by a power of two to a largest coordinate near 1, so that squares do not overflow.

    The scale of a metric has no effect.
    """
    largest = np.abs(positions[triangles]).max(initial=0.0)
    exponent = np.clip(np.frexp(largest)[1], -1000, 1000)
    # Vertices that no triangle uses may hold anything.
    with np.errstate(all="ignore"):
        return np.ldexp(positions, -exponent)
