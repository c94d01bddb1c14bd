# SPDX-License-Identifier: GPL-3.0-or-later
"""Move and scale charts in the UV plane: side by side, or back into their former bounding boxes.

All functions take `uv` (C, 2) float64 and `chart` (C,) integer, the chart of every corner, -1 for corners to leave
alone; chart numbers need not be consecutive. Charts are only translated, scaled uniformly and turned by quarter turns,
which keeps angles.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh, face_areas
from ..solve.joined import numbered_together
from ..solve.options import Margin, Settings
from ..solve.progress import Progress
from ..solve.solution import Solution
from .density import at_equal_density
from .kept_stacks import stacked_as_before
from .packing import pack
from .shape_packing import (
    IGNORED,
    STAYS,
    Packed,
    PackOptions,
    ShapePacking,
    covered,
    free_tile,
    obstacles,
    region_of_tile,
    tile_of,
)

# Gap between charts that are placed without a margin, relative to the mean chart size.
GAP = 0.1
# Lengths within 1 % count as equal, so that rounding does not decide how the chart of a square is turned.
_EQUAL = 1.01
# Pixels along a side of the raster: finer ones find hardly more room, and take longer.
_RASTER = 1024
# Packing by shape takes seconds beyond; boxes as small as these leave little more of the tile empty.
_MAX_SHAPES = 20_000
# Islands that fill less than a sixteenth of the tile beside those that stay get a tile of their own, if that makes them
# four times as large.
_MIN_SCALE = 0.25
# Faces that stay are no map, and leave no room, where their bounding boxes cover the tile this many times: twice for
# triangles, and as often again for rotated ones and for stacks.
_MAX_COVER = 8.0
# From this correlation of a chart's map with its former one, both have the same shape, and the former decides how it
# is turned: maps of one chart by different options have 0.98 to 1.
_SAME_SHAPE = 0.9
# Below this correlation the former orientation is unknown: random UVs of eight corners stay below it in nine of ten
# cases.
_NO_SHAPE = 0.6


@dataclass(frozen=True)
class _Charts:
    """Corners grouped by chart: K charts, `corners` sorted so that chart k has `counts[k]` from `starts[k]` on."""

    corners: np.ndarray
    starts: np.ndarray
    counts: np.ndarray

    def points(self, uv: np.ndarray) -> np.ndarray:
        """Return the `uv` (C, 2) of the corners, (len(corners), 2)."""
        # Ten times as fast as indexing rows.
        return uv.take(self.corners, axis=0)

    def bounds(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of the charts' bounding boxes, (K, 2) low and high, of `points` (len(corners), 2)."""
        columns = np.ascontiguousarray(points.T)
        return tuple(bound.reduceat(columns, self.starts, axis=1).T for bound in (np.minimum, np.maximum))

    def any(self, corners: np.ndarray) -> np.ndarray:
        """Return which charts have one of the `corners` (C,) bool, (K,) bool."""
        return np.logical_or.reduceat(corners[self.corners], self.starts)

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Return the `values` (K, ...) of the charts for every entry of `corners`."""
        return np.repeat(values, self.counts, axis=0)

    def centered(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return `points` (len(corners), 2) as complex numbers about the charts' means, and the means, (K,)."""
        values = points[:, 0] + 1j * points[:, 1]
        center = np.add.reduceat(values, self.starts) / self.counts
        return values - self.spread(center), center


def _group(chart: np.ndarray) -> _Charts:
    corners = np.flatnonzero(chart >= 0)
    number = chart.take(corners)
    if (number[1:] < number[:-1]).any():
        order = np.argsort(number, kind="stable")
        corners, number = corners.take(order), number.take(order)
    starts = np.flatnonzero(np.concatenate([number[:1] >= 0, number[1:] != number[:-1]]))
    return _Charts(corners, starts, np.diff(starts, append=len(corners)))


def _set_rows(uv: np.ndarray, corners: np.ndarray, points: np.ndarray) -> None:
    """Set the rows `corners` of `uv` (C, 2) to the `points`, both float64 and contiguous."""
    # As complex numbers, because indexing rows is slow.
    uv.view(np.complex128)[corners, 0] = points.view(np.complex128)[:, 0]


def side_by_side(uv: np.ndarray, chart: np.ndarray, margin: Margin | None = None) -> np.ndarray:
    """Pack the charts' bounding boxes into the unit square, at a common scale, with the margin or a gap between them.

    Returns a copy of `uv`, (C, 2) float64.

    Raises:
        MarginError: the margin is not finite.
    """
    return _boxes(uv, chart, margin)[0]


def _boxes(uv: np.ndarray, chart: np.ndarray, margin: Margin | None) -> tuple[np.ndarray, float]:
    """Pack as `side_by_side` does; also return the boxes' distance from the border, half of that between two."""
    result = np.array(uv, dtype=np.float64, order="C")
    charts = _group(chart)
    if len(charts.corners) == 0:
        return result, 0.0
    points = charts.points(result)
    low, high = charts.bounds(points)
    # Any magnitude is possible; dividing first keeps squares and sums in range.
    unit = (high - low).max()
    unit = unit if unit > 0.0 else 1.0
    size = (high - low) / unit
    if margin is None:
        gap = GAP * max(np.sqrt((size**2).sum(axis=1).mean()), np.finfo(np.float64).tiny)
        position, side = native.spectral_conformal().hosts.pack_boxes(size + gap)
        position += gap / 2.0
    else:
        position, side = pack(size, margin)
    side = side if side > 0.0 else 1.0
    points -= charts.spread(low)
    points /= unit * side
    points += charts.spread(position / side)
    _set_rows(result, charts.corners, points)
    return result, float(position.min()) / side


def into_former_bounds(
    uv: np.ndarray, former: np.ndarray, chart: np.ndarray, upright: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Fit every chart into the bounding box that its corners have in `former` (C, 2), and keep the center.

    A chart of the same shape as in `former` is turned by quarter turns to its former orientation. Any other chart is
    turned by a quarter if it fits larger that way, toward its former orientation if that is known. Charts with
    `upright` (C,) bool corners are only turned by halves. All are scaled to the largest size that fits. A chart whose
    former box has no width, no height or a non-finite coordinate stays.

    Returns a copy of `uv`, (C, 2) float64, and which corners were placed, (C,) bool.
    """
    result = np.array(uv, dtype=np.float64, order="C")
    placed = np.zeros(len(result), dtype=bool)
    charts = _group(chart)
    if len(charts.corners) == 0:
        return result, placed
    former_points = charts.points(former)
    former_low, former_high = charts.bounds(former_points)
    former_center = (former_low + former_high) / 2.0
    with np.errstate(invalid="ignore"):
        room = np.nan_to_num(former_high - former_low, nan=0.0, posinf=0.0)
    fits = (room > 0.0).all(axis=1)

    points = charts.points(result)
    low, high = charts.bounds(points)
    size = high - low
    points -= charts.spread((low + high) / 2.0)
    is_upright = charts.any(upright)
    quarters = np.where(fits, _quarters_toward(points, former_points, charts, size, room, is_upright), 0)
    points = _turned(points, charts.spread(quarters))
    odd = quarters % 2 == 1
    size[odd] = size[odd, ::-1]

    scale = _largest_scale(size, room)
    is_kept = fits & np.isfinite(scale)
    # The others may have no finite scale or center.
    scale[~is_kept], former_center[~is_kept] = 1.0, 0.0
    points *= charts.spread(scale)[:, None]
    points += charts.spread(former_center)
    keep = charts.spread(is_kept)
    kept = charts.corners[keep]
    _set_rows(result, kept, points[keep])
    placed[kept] = True
    return result, placed


def _quarters_toward(
    points: np.ndarray,
    former_points: np.ndarray,
    charts: _Charts,
    size: np.ndarray,
    room: np.ndarray,
    is_upright: np.ndarray,
) -> np.ndarray:
    """Return the quarter turns, (K,) integer from 0 to 3, that bring every chart to its former orientation.

    `points` (len(charts.corners), 2) are the charts' corners, in boxes of `size` (K, 2) that go into `room`;
    `former_points` are those of the former map. Charts that are `is_upright` (K,) bool get even turns.
    """
    moved, _ = charts.centered(points)
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        target, _ = charts.centered(former_points)
        along = np.add.reduceat(np.conj(moved) * target, charts.starts)
        squares = [np.add.reduceat(np.abs(values) ** 2, charts.starts) for values in (moved, target)]
        correlation = np.abs(along) / np.sqrt(squares[0] * squares[1])
        nearest = np.nan_to_num(np.angle(along) / (np.pi / 2.0)).round().astype(int) % 4
    turns = (_largest_scale(size[:, ::-1], room) > _largest_scale(size, room) * _EQUAL) & ~is_upright
    # Of the two turns that fit larger, the one within a quarter turn of the former orientation.
    side = np.where(turns, np.where(along.imag >= 0.0, 1, 3), np.where(along.real >= 0.0, 0, 2))
    untold = np.where(turns, 1, 0)
    # Comparisons with NaN are false.
    return np.where(
        (correlation >= _SAME_SHAPE) & ~is_upright, nearest, np.where(correlation >= _NO_SHAPE, side, untold)
    )


def to_former_area(
    uv: np.ndarray, former: np.ndarray, chart: np.ndarray, pinned: np.ndarray, face_offsets: np.ndarray
) -> np.ndarray:
    """Scale every chart about its pin to its area in `former` (C, 2), if that is positive.

    Every chart has one pin: all its `pinned` (C,) corners have one position in `former`, the same as in `uv`. The
    corners of face f are face_offsets[f] to face_offsets[f + 1] - 1. Returns a copy of `uv`, (C, 2) float64.
    """
    result = np.array(uv, dtype=np.float64)
    number = chart.max() + 1
    area, former_area = (areas(points, chart, face_offsets, number) for points in (result, former))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        scale = np.sqrt(former_area / area)
    scale[~(np.isfinite(scale) & (scale > 0.0))] = 1.0
    pins = np.flatnonzero(pinned & (chart >= 0))
    pin = np.zeros((number, 2))
    pin[chart[pins]] = former[pins]
    corners = np.flatnonzero(chart >= 0)
    center = pin[chart[corners]]
    result[corners] = center + (result[corners] - center) * scale[chart[corners], None]
    return result


def areas(uv: np.ndarray, chart: np.ndarray, face_offsets: np.ndarray, number: int) -> np.ndarray:
    """Return the unsigned area of each of `number` charts, (number,)."""
    of_face = chart[face_offsets[:-1]]
    inside = of_face >= 0
    return np.bincount(of_face[inside], np.abs(face_areas(uv, face_offsets))[inside], minlength=number)


def turned_onto(
    uv: np.ndarray, reference: np.ndarray, chart: np.ndarray, scale: np.ndarray, upright: np.ndarray
) -> np.ndarray:
    """Scale every chart k by scale[k], then turn and move it onto `reference` (C, 2), by least squares over corners.

    Charts with `upright` (C,) bool corners are only turned by halves. Returns a copy of `uv`, (C, 2) float64.
    """
    result = np.array(uv, dtype=np.float64, order="C")
    charts = _group(chart)
    if len(charts.corners) == 0:
        return result
    number = chart[charts.corners[charts.starts]]

    moved, _ = charts.centered(charts.points(result))
    target, center = charts.centered(charts.points(reference))
    along = np.add.reduceat(np.conj(moved) * target, charts.starts)
    along = np.where(charts.any(upright), along.real, along)
    turn = np.where(along == 0.0, 1.0, along) / np.where(along == 0.0, 1.0, np.abs(along))
    placed = charts.spread(scale[number] * turn) * moved + charts.spread(center)
    result[charts.corners] = np.stack([placed.real, placed.imag], axis=1)
    return result


def _largest_scale(size: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Return the largest factors with which boxes of `size` (K, 2) fit into `room` (K, 2)."""
    return np.divide(room, size, out=np.full_like(size, np.inf), where=size > 0.0).min(axis=1)


def _turned(points: np.ndarray, quarters: np.ndarray) -> np.ndarray:
    """Turn the `points` (N, 2) counterclockwise about the origin, each by its number of `quarters` (N,), 0 to 3."""
    x, y = points.T
    return np.stack([np.choose(quarters, [x, -y, -x, y]), np.choose(quarters, [y, x, -y, -x])], axis=1)


def _single_pins_at_former_area(mesh: PolygonMesh, solution: Solution) -> np.ndarray:
    """Return the solution's map, (C, 2), with single-pin charts scaled about their pin to their former area.

    Without such charts this is the solution's own array.
    """
    single = np.append(solution.column("n_pins") == 1, False)
    if not single.any():
        return solution.uv
    chart = np.where(single[solution.chart_of_corner], solution.chart_of_corner, -1)
    if (chart < 0).all():
        return solution.uv
    return to_former_area(solution.uv, mesh.isotropic_uv(), chart, mesh.usable_pins(), mesh.face_offsets)


@dataclass(frozen=True)
class Placement:
    """The maps of all meshes, placed together.

    Attributes:
        uv: one (C, 2) float64 array per mesh, meaningful at its solved corners.
        without_bounds: number of charts that could not be kept in place, because they had no former extent.
        left_tile: whether packed charts lie in another tile, because faces that stay leave too little room.
        fill: area of the packed charts, each stack once, over that of the tile; None if none was packed.
        stacked: number of charts that lie on others, as they did before.
    """

    uv: list[np.ndarray]
    without_bounds: int = 0
    left_tile: bool = False
    fill: float | None = None
    stacked: int = 0


def place(
    meshes: Sequence[PolygonMesh],
    solutions: Sequence[Solution],
    settings: Settings,
    progress: Progress | None = None,
    beside: Sequence[PolygonMesh] = (),
) -> Placement:
    """Place the solved charts of all meshes in one UV plane.

    Charts with pins stay where the solver put them; a single-pin chart is scaled about its pin to its former area. With
    `keep_in_place` every other chart goes into its bounding box in `PolygonMesh.uv`; charts without a former extent are
    packed as boxes into the first UV tile. Otherwise charts are packed by their shapes into the tile of their former
    map, around all faces that stay and the maps of the meshes `beside`, at a common scale in the world times their own
    factors (`density.py`). They stand upright, or are turned to fit best with `turn_to_pack` unless one has
    constraints. Stacked charts of one mesh stay stacked while they have the same shape.

    Raises:
        MarginError: the margin is not finite.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    if not meshes:
        return Placement([])
    corner_counts = [len(mesh.corner_vertices) for mesh in meshes]
    uv = np.concatenate([_with_pins_placed(mesh, solution) for mesh, solution in zip(meshes, solutions)])
    movable = [_movable(mesh, solution) for mesh, solution in zip(meshes, solutions)]
    uv = at_equal_density(meshes, movable, uv)
    chart = numbered_together(movable, [len(solution.charts) for solution in solutions])
    without_bounds = 0
    margin = None if settings.keep_in_place else settings.margin
    if settings.keep_in_place:
        former = np.concatenate(
            [np.zeros((n, 2)) if mesh.uv is None else mesh.isotropic_uv() for mesh, n in zip(meshes, corner_counts)]
        )
        upright = np.concatenate([mesh.constrained_corners() for mesh in meshes])
        uv, kept = into_former_bounds(uv, former, chart, upright)
        without_bounds = len(np.unique(chart[~kept & (chart >= 0)]))
        chart = np.where(kept, -1, chart)
    every, own = chart, _split(chart, corner_counts)
    laid = [stacked_as_before(*each) for each in zip(meshes, _split(uv, corner_counts), own)] if margin else []
    if any(lies_on is not alone for (_, lies_on), alone in zip(laid, own)):
        uv, chart = (np.concatenate(parts) for parts in zip(*laid))
    lies_alone = every == chart
    # The tile is a square in the coordinates of each mesh's image.
    if any(mesh.aspect != 1.0 for mesh in meshes):
        uv = np.concatenate([mesh.from_isotropic_uv(part) for mesh, part in zip(meshes, _split(uv, corner_counts))])
    if margin is None or not (chart >= 0).any():
        return Placement(_split(side_by_side(uv, chart, margin), corner_counts), without_bounds)
    maps, charts = _split(uv, corner_counts), _split(chart, corner_counts)
    may_turn = settings.turn_to_pack and all(mesh.equations is None for mesh in meshes)
    maps, left_tile = _packed(meshes, solutions, maps, charts, may_turn, margin, progress, beside)
    counted = _split(np.where(lies_alone, chart, -1), corner_counts)
    fill = sum(
        areas(part, own, mesh.face_offsets, int(chart.max()) + 1).sum()
        for mesh, part, own in zip(meshes, maps, counted)
    )
    return Placement(maps, without_bounds, left_tile, float(fill), len(np.unique(every[~lies_alone])))


def _movable(mesh: PolygonMesh, solution: Solution) -> np.ndarray:
    """Return the chart of every corner, (C,), -1 for none and for charts with pins or a held coordinate."""
    chart = solution.chart_of_corner
    if solution.column("n_pins").any():
        chart = np.where(solution.pinned_corners, -1, chart)
    return chart if mesh.held_axis is None else np.where(mesh.held_axis >= 0, -1, chart)


def _with_pins_placed(mesh: PolygonMesh, solution: Solution) -> np.ndarray:
    """Return the solution's map, (C, 2), with partly held charts as they were in all else.

    Charts with a single pin get their former area about it. Charts without pins that hold one coordinate get their
    former center along the other.
    """
    uv = _single_pins_at_former_area(mesh, solution)
    if mesh.held_axis is None:
        return uv
    charts = _group(np.where((mesh.held_axis >= 0) & ~solution.pinned_corners, solution.chart_of_corner, -1))
    if not len(charts.corners):
        return uv
    result = np.array(uv, dtype=np.float64, order="C")
    points, free = charts.points(result), 1 - mesh.held_axis[charts.corners[0]]
    bounds = [charts.bounds(each) for each in (points, charts.points(mesh.isotropic_uv()))]
    center, former_center = ((low[:, free] + high[:, free]) / 2.0 for low, high in bounds)
    points[:, free] += charts.spread(former_center - center)
    _set_rows(result, charts.corners, points)
    return result


def _packed(
    meshes: Sequence[PolygonMesh],
    solutions: Sequence[Solution],
    maps: Sequence[np.ndarray],
    charts: Sequence[np.ndarray],
    may_turn: bool,
    margin: Margin,
    progress: Progress | None,
    beside: Sequence[PolygonMesh],
) -> tuple[list[np.ndarray], bool]:
    """Pack the `charts` (C,) of the `maps` (C, 2); return the maps, and whether the charts left their tile."""
    whole = [
        uv if mesh.uv is None else np.where((solution.chart_of_corner >= 0)[:, None], uv, mesh.uv)
        for mesh, solution, uv in zip(meshes, solutions, maps)
    ]
    islands, staying = [], []
    for mesh, solution, uv, chart in zip(meshes, solutions, whole, charts):
        first = mesh.face_offsets[:-1]
        has_map = (solution.chart_of_corner[first] >= 0) | (mesh.uv is not None)
        stays = obstacles(mesh, uv, has_map & (chart[first] < 0))
        islands.append(np.where(stays, STAYS, np.where(chart[first] >= 0, chart[first], IGNORED)))
        staying.append(np.stack(mesh.face_bounds(uv), axis=1)[stays])
    beside = [mesh for mesh in beside if mesh.uv is not None]
    for mesh in beside:
        stays = obstacles(mesh, mesh.uv, np.ones(len(mesh.face_offsets) - 1, dtype=bool))
        islands.append(np.where(stays, STAYS, IGNORED))
        staying.append(np.stack(mesh.face_bounds(mesh.uv), axis=1)[stays])
    # Packed faces are numbered without gaps.
    numbers = np.unique(np.concatenate(islands))
    numbers = numbers[numbers >= 0]
    islands = [np.where(each >= 0, np.searchsorted(numbers, each), each) for each in islands]
    former = [mesh.uv[chart >= 0] for mesh, chart in zip(meshes, charts) if mesh.uv is not None]
    tile = tile_of(np.concatenate([np.empty((0, 2)), *former]))
    own_tile, in_tile = free_tile(tile, staying), np.concatenate([covered(boxes, tile) for boxes in staying])
    is_beside, has_room = bool((in_tile > 0.0).any()), in_tile.sum() <= _MAX_COVER
    alone = [np.where(each == STAYS, IGNORED, each) for each in islands]
    uv, chart = np.concatenate(maps), np.concatenate(charts)
    # Packing boxes gives the margin relative to the tile, and never fails.
    boxes, margin_in_tile = _boxes(uv, chart, margin)
    found = None
    # Shapes need the width between two islands at both borders. A single upright island is its box.
    has_width = 4.0 * margin_in_tile < 1.0
    if has_width and len(numbers) <= _MAX_SHAPES and (is_beside or may_turn or len(numbers) > 1):

        def pack_into(column_and_row: tuple[int, int], which: Sequence[np.ndarray]) -> Packed | None:
            options = PackOptions(
                _RASTER,
                2.0 * margin_in_tile * _RASTER,
                "free" if may_turn else "none",
                regions=[region_of_tile(column_and_row)],
                keep_stacks=False,
            )
            maps = [*whole, *(mesh.uv for mesh in beside)]
            packed = ShapePacking([*meshes, *beside], maps, which, options, progress).now()
            return None if packed.without_room else packed

        if has_room:
            found = pack_into(tile, islands if is_beside else alone)
        if is_beside and (found is None or found.fill < _MIN_SCALE**2):
            larger = pack_into(own_tile, alone)
            if larger is not None and (found is None or found.fill < _MIN_SCALE**2 * larger.fill):
                return larger.maps[: len(meshes)], True
    if found is not None:
        return found.maps[: len(meshes)], False
    goes_to = own_tile if is_beside else tile
    boxes[chart >= 0] += goes_to
    return _split(boxes, [len(part) for part in maps]), goes_to != tile


def _split(values: np.ndarray, counts: Sequence[int]) -> list[np.ndarray]:
    """Split an array into parts with these numbers of rows."""
    return [values[end - count : end] for count, end in zip(counts, accumulate(counts))]
