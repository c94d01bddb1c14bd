"""Pack boxes into a square, and join corners to the points that `pack` takes."""

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


def weld_corners(
    corner_vertices: npt.ArrayLike, islands: npt.ArrayLike, uv: npt.ArrayLike, n_vertices: int
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Join the corners of each island that have the same vertex and UV, so that its outline is its border only.

    Args:
        corner_vertices: (C,) from 0 to n_vertices - 1.
        islands: (C,) of each corner, any numbers.
        uv: (C, 2).
        n_vertices: number of vertices of the mesh.

    Returns:
        (C,) the point of each corner, and (P,) the first corner of each point.

    Raises:
        ValueError: an array is not as described here.
    """
    vertices = _arguments.checked_index_vector(corner_vertices, "corner_vertices")
    number = _arguments.checked_integers(islands, "islands")
    points = _arguments.checked_floats(uv, "uv", 2)
    count = _arguments.checked_count(n_vertices, "n_vertices")
    if number.shape != vertices.shape or len(points) != len(vertices):
        raise ValueError("corner_vertices, islands and uv must have one entry for each corner.")
    if len(vertices) and vertices.max() >= count:
        raise ValueError("corner_vertices must lie between 0 and n_vertices - 1.")
    return _native.weld_corners(vertices, number, points, count)
