"""Map values to colors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Color = tuple[float, float, float]

# Displayed colors of good, middle and bad values, as in the add-on's overlay.
GOOD_TO_BAD: tuple[Color, Color, Color] = ((0.16, 0.38, 0.85), (0.98, 0.86, 0.25), (0.86, 0.12, 0.10))


def displayed_colors(
    values: npt.NDArray[np.floating], low: float, high: float, ramp: Sequence[Color]
) -> npt.NDArray[np.float64]:
    """Return the displayed (sRGB) color of every value, (N, 3), from 0 to 1.

    Args:
        values: (N,); NaN counts as very large.
        low: the value of the first color.
        high: the value of the last color, larger than `low`.
        ramp: displayed colors of the lower end, the middle and the upper end.
    """
    part = np.clip((np.nan_to_num(values, nan=high, posinf=high, neginf=low) - low) / (high - low), 0.0, 1.0)
    return np.stack([np.interp(part, (0.0, 0.5, 1.0), channel) for channel in zip(*ramp)], axis=1)
