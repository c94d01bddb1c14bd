"""The seams of a UV map, and its islands in the unit square."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._island_packing import PackedMap, pack
from ._measuring import next_corner
from ._mesh import Mesh
from ._packing import pack_boxes
from .defaults import MARGIN


def map_seams(
    face_offsets: npt.NDArray[np.int64], corner_vertices: npt.NDArray[np.int64], corner_uv: npt.NDArray[np.float64]
) -> npt.NDArray[np.int64]:
    """Return the edges, (S, 2), whose two faces have different UVs at an end.

    Args:
        face_offsets: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        corner_uv: (C, 2); NaN for corners without UVs, which match no other.
    """
    following = next_corner(face_offsets)
    ends = np.c_[np.arange(len(following)), following]
    ends = np.where((corner_vertices[ends[:, 0]] > corner_vertices[ends[:, 1]])[:, None], ends[:, ::-1], ends)
    edges = corner_vertices[ends]
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    one, two = order[:-1], order[1:]
    shared = (edges[one] == edges[two]).all(axis=1)
    agree = (corner_uv[ends[one]] == corner_uv[ends[two]]).all(axis=(1, 2))
    return np.unique(edges[one[shared & ~agree]], axis=0)


def packed(
    uv: npt.NDArray[np.float64],
    chart: npt.NDArray[np.int64],
    margin: tuple[float, float] = (0.004, 0.004),
    aspect: float = 1.0,
) -> npt.NDArray[np.float64]:
    """Pack the charts' bounding boxes into the unit square, at a common scale and without rotation.

    Args:
        uv: (C, 2), any unit.
        chart: (C,) chart of each corner, -1 for corners to leave unchanged.
        margin: between boxes, and between them and the square's border, as fractions of its width and height.
        aspect: width over height of the texture in the square.

    Returns:
        a changed copy of `uv`.

    Raises:
        ValueError: the margin leaves no room for the charts.
    """
    result = np.array(uv, dtype=np.float64)
    corners, starts, counts = _by_chart(chart)
    if not len(corners):
        return result
    rank = np.repeat(np.arange(len(starts)), counts)
    points = result[corners] * [aspect**-0.5, aspect**0.5]
    low = np.minimum.reduceat(points, starts)
    size = np.maximum.reduceat(points, starts) - low
    # Dividing first keeps squares and sums in range at any magnitude.
    unit = float(size.max()) or 1.0
    position, side = pack_boxes(size / unit, margin=margin)
    result[corners] = ((points - low[rank]) / unit + position[rank]) / (side or 1.0)
    return result


def scale_between(uv: npt.NDArray[np.float64], moved: npt.NDArray[np.float64], chart: npt.NDArray[np.int64]) -> float:
    """Return the common factor by which charts have grown from `uv` to `moved`, (C, 2) each; 1 for none with extent.

    Rotations and mirrors do not count. Chart numbers are in `chart` (C,), -1 for corners that do not count.
    """
    corners, starts, counts = _by_chart(chart)
    if not len(corners):
        return 1.0
    squares = []
    for points in (moved[corners], uv[corners]):
        centers = np.add.reduceat(points, starts) / counts[:, None]
        squares.append(float(((points - np.repeat(centers, counts, axis=0)) ** 2).sum()))
    return (squares[0] / squares[1]) ** 0.5 if squares[1] > 0.0 else 1.0


def packed_by_shape(
    uv: npt.NDArray[np.float64],
    face_offsets: npt.NDArray[np.int64],
    chart: npt.NDArray[np.int64],
    *,
    scale: bool = True,
    keep_stacks: bool = False,
    **options: Any,  # noqa: ANN401 - those of `pack`
) -> PackedMap:
    """Pack the charts by their shapes.

    Args:
        uv: (C, 2) UVs of the texture; NaN for corners that obstruct nothing.
        face_offsets: (F + 1,), as in `unwrap`.
        chart: (C,) chart of each corner, the same for all of a face; -1 for obstacles.
        scale: whether charts fill the tiles at a common scale; otherwise some may find no room.
        keep_stacks: as in `pack`. Solved charts lie about the origin, so equal ones coincide without being a stack.
        **options: of `pack`.

    Raises:
        ValueError: the margin leaves no room for the charts, or `pack` refuses an option.
    """
    has_corners = np.diff(face_offsets) > 0
    islands = np.full(len(has_corners), -1)
    islands[has_corners] = chart[face_offsets[:-1][has_corners]]
    found = islands >= 0
    # Consecutive numbers, at most as many as faces.
    islands[found] = np.unique(islands[found], return_inverse=True)[1].ravel()
    # Corners of an island with one UV are one point, whatever their vertices.
    mesh = Mesh(np.zeros((max(1, len(uv)), 3)), face_offsets, uv, corner_vertices=_digest(uv, len(uv)))
    packing = pack(mesh, islands=islands, scale=scale, keep_stacks=keep_stacks, **options)
    if scale and not packing.has_room.all():
        size = f" with islands of at least {options['min_size']:g} pixels" if options.get("min_size") else ""
        raise ValueError(
            f"The margin {options.get('margin', MARGIN):g} leaves no room for the islands{size}; make it smaller."
        )
    return packing


def _digest(uv: npt.NDArray[np.float64], n: int) -> npt.NDArray[np.int32]:
    """Return a number below `n` for each row of `uv` (C, 2), equal for equal rows and hardly ever otherwise."""
    # Both zeros are one number. Multiplied by the golden ratio, the upper bits depend on all (Knuth 1973, 6.4).
    u, v = np.ascontiguousarray(uv + 0.0).view(np.uint64).T
    golden = np.uint64(0x9E3779B97F4A7C15)
    mixed = ((u * golden) ^ (v + (u >> np.uint64(32)))) * golden
    return ((mixed >> np.uint64(33)) % np.uint64(max(1, n))).astype(np.int32)


def _by_chart(
    chart: npt.NDArray[np.int64],
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the corners that belong to charts, grouped by chart, and the start and number of each chart's corners."""
    corners = np.flatnonzero(chart >= 0)
    corners = corners[np.argsort(chart[corners], kind="stable")]
    starts = np.flatnonzero(np.diff(chart[corners], prepend=-1))
    return corners, starts, np.diff(np.append(starts, len(corners)))


def onto_former(
    uv: npt.NDArray[np.float64], former: npt.NDArray[np.float64], chart: npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_]]:
    """Rotate and move each chart onto its former map as closely as possible, at its former size.

    The fit is a least-squares fit; the size is the root mean square distance from the center.

    Args:
        uv: (C, 2), any unit.
        former: (C, 2), NaN for corners without a former UV.
        chart: (C,) chart of each corner, -1 for corners to leave unchanged.

    Returns:
        a changed copy of `uv`, and which corners (C,) were placed; charts without former UVs or extent are not.
    """
    result = np.array(uv, dtype=np.float64)
    placed = np.zeros(len(uv), dtype=bool)
    corners, starts, counts = _by_chart(chart)
    if not len(corners):
        return result, placed

    def centered(points: npt.NDArray[np.float64]) -> tuple[np.ndarray, np.ndarray]:
        values = points[corners, 0] + 1j * points[corners, 1]
        center = np.add.reduceat(values, starts) / counts
        return values - np.repeat(center, counts), center

    with np.errstate(invalid="ignore", divide="ignore"):
        (moved, _), (target, center) = centered(result), centered(former)
        along = np.add.reduceat(np.conj(moved) * target, starts)
        turn = np.where(along == 0.0, 1.0, along / np.abs(along))
        squares = (np.add.reduceat(np.abs(values) ** 2, starts) for values in (target, moved))
        scale = np.sqrt(np.divide(*squares))
    fits = np.isfinite(scale) & (scale > 0.0)
    goes = np.repeat(fits, counts)
    positions = np.repeat(scale * turn, counts) * moved + np.repeat(center, counts)
    result[corners[goes]] = np.column_stack([positions.real, positions.imag])[goes]
    placed[corners[goes]] = True
    return result, placed
