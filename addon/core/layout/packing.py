# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack boxes into a square, with a margin between them and to its border."""

import numpy as np

from .. import native
from ..errors import ReadableError
from ..words.translation import translate

# The margin is a fraction of the side of the square, which depends on the margin.
_MAX_ROUNDS = 12
_PRECISION = 1e-3
# Beyond this many times the largest box, a margin leaves nothing of the boxes.
_MAX_MARGIN = 100.0


def pack(size: np.ndarray, margin: float, quick: bool = False) -> tuple[np.ndarray, float]:
    """Arrange boxes of `size` (K, 2), not turned, in a small square; with `quick`, few orders of them are tried.

    Returns their lower left corners, (K, 2), and the side of the square, whose lower left corner is the origin. The
    space s between the boxes, and between them and the border, is the margin times the side S(s): a fixed point of
    s -> margin S(s).

    Raises:
        ReadableError: the margin is not finite.
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if not np.isfinite(margin):
        raise ReadableError(translate("The margin must be a number, not {margin}").format(margin=margin))
    part, space, largest = max(0.0, margin), 0.0, size.max(initial=0.0)
    corners, side = _with_space(size, space, quick)
    for _ in range(_MAX_ROUNDS):
        if abs(part * side - space) <= _PRECISION * space or space > _MAX_MARGIN * largest:
            break
        space = part * side
        corners, side = _with_space(size, space, quick)
    return corners, side


def _with_space(size: np.ndarray, space: float, quick: bool) -> tuple[np.ndarray, float]:
    corners, side = native.spectral_conformal().hosts.pack_boxes(size + space, quick=quick)
    return corners + space, side + space
