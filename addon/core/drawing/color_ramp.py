# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors that stand for values."""

from collections.abc import Sequence

import numpy as np

from .. import native

Color = tuple[float, float, float]

# Displayed colors of the lower end, the middle and the upper end.
GOOD_TO_BAD: tuple[Color, Color, Color] = ((0.16, 0.38, 0.85), (0.98, 0.86, 0.25), (0.86, 0.12, 0.10))
SMALL_TO_LARGE: tuple[Color, Color, Color] = ((0.13, 0.40, 0.80), (0.93, 0.93, 0.93), (0.85, 0.25, 0.14))


def linear(color: np.ndarray) -> np.ndarray:
    """Convert displayed (sRGB) colors, 0 to 1, any shape, to linear ones (IEC 61966-2-1)."""
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def colors_of(values: np.ndarray, low: float, high: float, ramp: Sequence[Color]) -> np.ndarray:
    """Return the linear color of every value, (N, 4) float64 with the opacity 1; arguments as in `displayed_colors`.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    displayed = native.spectral_conformal("_color_ramp").displayed_colors(values, low, high, ramp)
    return np.column_stack([linear(displayed), np.ones(len(values))])
