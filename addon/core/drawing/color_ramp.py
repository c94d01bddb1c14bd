# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours that stand for values."""

from collections.abc import Sequence

import numpy as np

Color = tuple[float, float, float]

# Displayed colours of the lower end, the middle and the upper end: from good to bad, or from small over even to large.
GOOD_TO_BAD: tuple[Color, Color, Color] = ((0.16, 0.38, 0.85), (0.98, 0.86, 0.25), (0.86, 0.12, 0.10))
SMALL_TO_LARGE: tuple[Color, Color, Color] = ((0.13, 0.40, 0.80), (0.93, 0.93, 0.93), (0.85, 0.25, 0.14))


def linear(color: np.ndarray) -> np.ndarray:
    """Return displayed (sRGB) colours, 0 to 1, any shape, as linear ones (IEC 61966-2-1)."""
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def colors_of(values: np.ndarray, low: float, high: float, ramp: Sequence[Color]) -> np.ndarray:
    """Return the linear colour of every value, (N, 4) float64 with the opacity 1.

    Args:
        values: (N,), what is not finite counts as very large.
        low: the value of the first colour.
        high: the value of the last colour, larger than `low`.
        ramp: displayed colours of the lower end, the middle and the upper end.
    """
    place = np.clip((np.nan_to_num(values, nan=high, posinf=high, neginf=low) - low) / (high - low), 0.0, 1.0)
    displayed = np.stack([np.interp(place, (0.0, 0.5, 1.0), channel) for channel in zip(*ramp)], axis=1)
    return np.column_stack([linear(displayed), np.ones(len(values))])
