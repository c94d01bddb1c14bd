# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrows that show extenders, as triangles on the screen."""

from dataclasses import dataclass

import numpy as np

# In pixels; shorter arrows have no direction on the screen.
_MIN_LENGTH = 1e-3
# Of the arrow's length, so that two heads leave a fifth of it for the shaft.
_MAX_HEAD = 0.4
# Of a head's length: half the gap between two tips that point at each other.
_GAP = 0.1


@dataclass(frozen=True)
class ArrowSize:
    """Sizes of an arrow in pixels: width of its shaft, length and width of its heads, and margin around all of it."""

    shaft: float = 2.0
    head_length: float = 12.0
    head_width: float = 10.0
    margin: float = 0.0

    def scaled(self, factor: float) -> "ArrowSize":
        """Return the size for another resolution of the screen."""
        sizes = (self.shaft, self.head_length, self.head_width, self.margin)
        return ArrowSize(*(size * factor for size in sizes))


def nearest_pair(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the closest pair of the points `first` (N, 2) and `second` (M, 2); the first of equal pairs."""
    distance = np.linalg.norm(first[:, None] - second[None], axis=2)
    a, b = np.unravel_index(np.argmin(distance), distance.shape)
    return first[a], second[b]


def arrow(start: np.ndarray, end: np.ndarray, outward: bool, size: ArrowSize) -> np.ndarray:
    """Return the triangles (T, 3, 2) of an arrow between two points (2,) of the screen, in pixels.

    `outward` arrows have their heads at the ends, pointing away from each other; the others have them in the middle,
    pointing at each other. Heads shrink if there is no room for two. Coincident points give no triangles.
    """
    along = np.subtract(end, start, dtype=np.float64)
    length = np.linalg.norm(along)
    if not np.isfinite(length) or length < _MIN_LENGTH:
        return np.empty((0, 3, 2))
    head = min(size.head_length, _MAX_HEAD * length)
    width = size.head_width * head / size.head_length
    # In a frame with the middle at 0 and both ends on the axis, `length` apart.
    tip = 0.5 * length if outward else _GAP * head
    base = tip - head if outward else tip + head
    shafts = [(-base, base)] if outward else [(-0.5 * length, -base), (base, 0.5 * length)]
    triangles = [_head(side * tip, side * base, width, size.margin) for side in (-1.0, 1.0)]
    for low, high in shafts:
        triangles += _bar(low - size.margin, high + size.margin, size.shaft + 2.0 * size.margin)
    frame = np.stack([along, (-along[1], along[0])]) / length
    return np.add(start, end, dtype=np.float64) / 2.0 + np.array(triangles) @ frame


def _head(tip: float, base: float, width: float, margin: float) -> list[tuple[float, float]]:
    """Return the triangle with tip and base at these positions on the axis, enlarged by `margin`."""
    forward = 1.0 if tip > base else -1.0
    # The sides of the enlarged triangle are parallel to those of the original, `margin` outside.
    slope = 0.5 * width / abs(tip - base)
    tip += forward * margin * np.hypot(1.0, slope) / slope
    base -= forward * margin
    half = slope * abs(tip - base)
    return [(tip, 0.0), (base, half), (base, -half)]


def _bar(low: float, high: float, width: float) -> list[list[tuple[float, float]]]:
    half = 0.5 * width
    corners = [(low, -half), (high, -half), (high, half), (low, half)]
    return [[corners[i] for i in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
