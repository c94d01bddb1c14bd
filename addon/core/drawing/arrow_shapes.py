# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrows that show extenders, as lines on the screen."""

import numpy as np
import numpy.typing as npt

# In pixels; shorter arrows have no direction on the screen.
_MIN_LENGTH = 1e-3
# Length of a head in pixels, at most this fraction of the arrow's length: two heads then leave a fifth for the shaft.
_HEAD = 12.0
_MAX_HEAD = 0.4
# Half the width of a head over its length.
_SLOPE = 0.45
# Of a head's length: half the gap between two tips that point at each other.
_GAP = 0.1


def nearest_pair(first: npt.ArrayLike, second: npt.ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return the closest pair of the points `first` (N, 2) and `second` (M, 2); the first of equal pairs."""
    first, second = np.asarray(first), np.asarray(second)
    distance = np.linalg.norm(first[:, None] - second, axis=2)
    a, b = np.unravel_index(np.argmin(distance), distance.shape)
    return first[a], second[b]


def arrow(start: np.ndarray, end: np.ndarray, outward: bool, scale: float = 1.0) -> np.ndarray:
    """Return the lines (L, 2, 2), each by its ends, of an arrow between two points (2,) of the screen, in pixels.

    `outward` arrows have their heads at the ends, pointing away from each other; the others have them in the middle,
    pointing at each other. The first four lines are those of the heads, from their tips. Heads have their size at the
    `scale` of the interface, less where there is no room for two. No lines for points in one place.
    """
    along = np.subtract(end, start, dtype=np.float64)
    length = np.linalg.norm(along)
    if not np.isfinite(length) or length < _MIN_LENGTH:
        return np.empty((0, 2, 2))
    head = min(_HEAD * scale, _MAX_HEAD * length)
    # In a frame with the middle at 0 and both ends on the axis, `length` apart.
    tip, base = (0.5 * length, 0.5 * length - head) if outward else (_GAP * head, (1.0 + _GAP) * head)
    lines = [[(side * tip, 0.0), (side * base, up * _SLOPE * head)] for side in (-1, 1) for up in (-1, 1)]
    shafts = [(-tip, tip)] if outward else [(-0.5 * length, -tip), (tip, 0.5 * length)]
    lines += [[(low, 0.0), (high, 0.0)] for low, high in shafts]
    frame = np.stack([along, (-along[1], along[0])]) / length
    return np.add(start, end, dtype=np.float64) / 2.0 + np.array(lines) @ frame
