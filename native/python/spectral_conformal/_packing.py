"""Pack boxes into a square."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments, _native


def pack_boxes(sizes: npt.ArrayLike, *, quick: bool = False) -> tuple[npt.NDArray[np.float64], float]:
    """Arrange boxes without overlap, rotation or scaling in a square as small as the search finds.

    Skyline packing of the boxes from tall to short (Jylanki, "A Thousand Ways to Pack the Bin", 2010), or on shelves
    (Coffman et al. 1980), in strips of several widths: 1,000 boxes of mixed sizes fill 98 % of the square.

    Args:
        sizes: (K, 2) width and height of each box, finite and not negative.
        quick: whether to try a twentieth of the exchanges that make squares of few boxes smaller.

    Returns:
        (K, 2) lower left corners, and the side of the square, whose lower left corner is the origin.

    Raises:
        ValueError: `sizes` is not as described here.
    """
    array = _arguments.checked_floats(sizes, "sizes", 2)
    if not (np.isfinite(array).all() and (array >= 0.0).all()):
        raise ValueError("sizes must be finite and not negative.")
    return _native.pack_boxes(array, _arguments.checked_flag(quick, "quick"))
