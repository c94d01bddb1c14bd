# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack boxes into the UV tile, with a margin around each."""

import numpy as np

from .. import native
from ..errors import ReadableError
from ..solve.options import Margin
from ..words import texts

# A margin that is a fraction of the tile depends on the side of the tile, which depends on the margin.
_MAX_ROUNDS = 12
_PRECISION = 1e-3
# Beyond this many times the largest box, a margin leaves nothing of the boxes.
_MAX_MARGIN = 100.0


class MarginError(ReadableError):
    """The margin is not finite; the message says so."""


def pack(size: np.ndarray, margin: Margin, quick: bool = False) -> tuple[np.ndarray, float]:
    """Arrange boxes of `size` (K, 2), not turned, in a small square.

    With `quick`, few orders of the boxes are tried.

    Returns their lower left corners, (K, 2), and the side of the square, whose lower left corner is the origin.

    The methods are those of Blender's packer. SCALED: the margin times a tenth of the sum of the roots of the boxes'
    areas. ADD: the margin times the side that the square has without margins. FRACTION: the margin times the side.

    Raises:
        MarginError: the margin is not finite.
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if not np.isfinite(margin.size):
        raise MarginError(texts.no_margin(margin.size))
    part = max(0.0, margin.size)
    if margin.method == "SCALED":
        return _with_space(size, 0.1 * part * np.sqrt(size.prod(axis=1)).sum(), quick)
    corners, side = _with_space(size, 0.0, quick)
    if margin.method == "ADD":
        return _with_space(size, part * side, quick)
    space, largest = 0.0, size.max(initial=0.0)
    for _ in range(_MAX_ROUNDS):
        if abs(part * side - space) <= _PRECISION * space or space > _MAX_MARGIN * largest:
            break
        space = part * side
        corners, side = _with_space(size, space, quick)
    return corners, side


def _with_space(size: np.ndarray, space: float, quick: bool) -> tuple[np.ndarray, float]:
    corners, side = native.spectral_conformal().hosts.pack_boxes(size + 2.0 * space, quick=quick)
    return corners + space, side
