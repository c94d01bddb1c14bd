"""Seams that a UV map has, and islands side by side in the unit square."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def map_seams(
    face_offsets: npt.NDArray[np.int64], corner_vertices: npt.NDArray[np.int64], corner_uv: npt.NDArray[np.float64]
) -> npt.NDArray[np.int64]:
    """Return the edges, (S, 2), whose two faces have different UVs at either end.

    Args:
        face_offsets: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        corner_uv: (C, 2); corners without UVs, not numbers, agree with none.
    """
    following = np.arange(1, len(corner_vertices) + 1)
    following[face_offsets[1:] - 1] = face_offsets[:-1]
    ends = np.c_[np.arange(len(following)), following]
    ends = np.where((corner_vertices[ends[:, 0]] > corner_vertices[ends[:, 1]])[:, None], ends[:, ::-1], ends)
    edges = corner_vertices[ends]
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    one, two = order[:-1], order[1:]
    shared = (edges[one] == edges[two]).all(axis=1)
    agree = (corner_uv[ends[one]] == corner_uv[ends[two]]).all(axis=(1, 2))
    return np.unique(edges[one[shared & ~agree]], axis=0)


def on_shelves(
    uv: npt.NDArray[np.float64], chart: npt.NDArray[np.int32], margin: float = 0.004
) -> npt.NDArray[np.float64]:
    """Lay charts out in rows in the unit square, tallest first, at a common scale, their bounding boxes apart.

    Charts higher than wide are laid on their side. A plain layout, which leaves gaps, for use
    without Blender, whose packer is a better one.

    Args:
        uv: (C, 2), any unit.
        chart: (C,) of each corner, -1 for corners to leave alone.
        margin: between charts, as a fraction of the square's side.

    Returns:
        a copy of `uv`.
    """
    result = np.array(uv, dtype=np.float64)
    corners = np.flatnonzero(chart >= 0)
    corners = corners[np.argsort(chart[corners], kind="stable")]
    if not len(corners):
        return result
    starts = np.flatnonzero(np.diff(chart[corners], prepend=-1))
    rank = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(corners))))
    points = result[corners]
    size = np.maximum.reduceat(points, starts) - np.minimum.reduceat(points, starts)
    on_side = (size[:, 1] > size[:, 0])[rank]
    points[on_side] = np.c_[points[on_side, 1], -points[on_side, 0]]
    low = np.minimum.reduceat(points, starts)
    size = np.maximum.reduceat(points, starts) - low
    side = _side(size, margin)
    position, _ = _rows(size + margin * side, side * (1.0 - margin))
    result[corners] = (points - low[rank] + position[rank] + margin * side) / side
    return result


def _side(size: npt.NDArray[np.float64], margin: float) -> float:
    """Return the smallest side found, by halving, of a square that holds boxes of `size` (K, 2) and their margins."""
    side = float(max(np.sqrt(size.prod(axis=1).sum()), size.max(), np.finfo(np.float64).tiny))

    def holds(side: float) -> bool:
        room = side * (1.0 - margin)
        boxes = size + margin * side
        return boxes.max() <= room and _rows(boxes, room)[1] <= room

    high = side
    while not holds(high):
        high *= 2.0
        if high > 1e6 * side:
            raise ValueError(f"the margin {margin:g} leaves no room for {len(size)} islands; make it smaller.")
    low = high / 2.0
    for _ in range(12):
        middle = (low + high) / 2.0
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def _rows(size: npt.NDArray[np.float64], width: float) -> tuple[npt.NDArray[np.float64], float]:
    """Return the lower corners (K, 2) of boxes set in rows of this width, tallest first, and the height of all rows."""
    order = np.argsort(-size[:, 1], kind="stable")
    position = np.empty_like(size)
    x = y = height = 0.0
    for box, (box_width, box_height) in zip(order.tolist(), size[order].tolist()):
        if x > 0.0 and x + box_width > width:
            x, y, height = 0.0, y + height, 0.0
        position[box] = x, y
        x += box_width
        height = max(height, box_height)
    return position, y + height
