# SPDX-License-Identifier: GPL-3.0-or-later
"""Move and scale charts in the UV plane: side by side, or back into their former bounding boxes.

All functions take `uv` (C, 2) float64 and `chart` (C,) integer, the chart of every corner, -1 for corners to leave
alone; chart numbers need not be consecutive. Charts are only translated, scaled uniformly and turned by quarter turns,
which keeps angles.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np

from .. import native
from ..errors import ReadableError
from ..mesh.corner_groups import CornerGroups
from ..mesh.polygon_mesh import PolygonMesh, face_areas
from ..solve.joined import numbered_together
from ..solve.options import Settings
from ..solve.progress import Progress
from ..solve.solution import Solution, charts_of
from ..words.translation import translate
from .density import at_equal_density
from .kept_stacks import stacked_as_before
from .shape_packing import (
    IGNORED,
    STAYS,
    Packed,
    ShapePacking,
    covered,
    free_tile,
    isotropy,
    obstacles,
    region_of_tile,
    tile_of,
)

# Gap between charts that are placed without a margin, relative to the mean chart size.
GAP = 0.1
# Between boxes, in units of the largest, where a margin leaves them no room.
_NO_ROOM = 100.0
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


def side_by_side(uv: np.ndarray, chart: np.ndarray, margin: float | None = None) -> np.ndarray:
    """Pack the charts' bounding boxes into the unit square, at a common scale, with the margin or a gap between them.

    Returns a copy of `uv`, (C, 2) float64.

    Raises:
        ReadableError: the margin is not finite.
    """
    charts = CornerGroups.of(chart)
    if not len(charts):
        return np.array(uv, dtype=np.float64, order="C")
    return _boxes(charts, charts.bounds(uv), margin).of(charts, uv)


@dataclass(frozen=True)
class _Boxes:
    """The bounding boxes of K charts in the tile: `boxes` (K, 2, 2), shrunk to `scale`, at their `position` (K, 2)."""

    boxes: np.ndarray
    scale: float
    position: np.ndarray

    def of(self, charts: CornerGroups, uv: np.ndarray, tile: tuple[int, int] = (0, 0)) -> np.ndarray:
        """Return a copy of `uv`, (C, 2) float64, in which the `charts` lie in their boxes in a `tile`."""
        points = charts.of_corners(uv) - charts.spread(self.boxes[:, 0])
        points /= self.scale
        points += charts.spread(self.position + tile)
        return charts.with_rows(uv, points)


def _boxes(charts: CornerGroups, boxes: np.ndarray, margin: float | None, quick: bool = False) -> _Boxes:
    """Pack the bounding boxes of the `charts`, (K, 2, 2), as `side_by_side` does; `quick` if shapes are packed then."""
    size = boxes[:, 1] - boxes[:, 0]
    # Any magnitude is possible; dividing first keeps squares and sums in range.
    unit = size.max()
    unit = unit if unit > 0.0 else 1.0
    size /= unit
    if margin is None:
        gap = GAP * max(np.sqrt((size**2).sum(axis=1).mean()), np.finfo(np.float64).tiny)
        position, side = native.spectral_conformal().hosts.pack_boxes(size + gap)
        position += gap / 2.0
    else:
        position, side = _with_margin(size, margin, quick)
    side = side if side > 0.0 else 1.0
    return _Boxes(boxes, unit * side, position / side)


def _with_margin(size: np.ndarray, margin: float, quick: bool) -> tuple[np.ndarray, float]:
    """Return where boxes of `size` (K, 2) lie with a margin, and the side of their square; one too wide shrinks them.

    Raises:
        ReadableError: the margin is not finite.
    """
    if not np.isfinite(margin):
        raise ReadableError(translate("The margin must be a number, not {margin}").format(margin=margin))
    pack_boxes = native.spectral_conformal().hosts.pack_boxes
    try:
        return pack_boxes(size, quick=quick, margin=max(0.0, margin))
    except ValueError:
        space = _NO_ROOM * size.max()
        position, side = pack_boxes(size + space, quick=quick)
        return position + space, side + space


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
    charts = CornerGroups.of(chart)
    if not len(charts):
        return result, placed
    former_low, former_high = charts.bounds(former).transpose(1, 0, 2)
    former_center = (former_low + former_high) / 2.0
    with np.errstate(invalid="ignore"):
        room = np.nan_to_num(former_high - former_low, nan=0.0, posinf=0.0)
    fits = (room > 0.0).all(axis=1)

    low, high = charts.bounds(result).transpose(1, 0, 2)
    size = high - low
    points = charts.of_corners(result) - charts.spread((low + high) / 2.0)
    is_upright = charts.any(upright)
    quarters = np.where(fits, _quarters_toward(points, charts.of_corners(former), charts, size, room, is_upright), 0)
    points = _turned(points, charts.spread(quarters))
    odd = quarters % 2 == 1
    size[odd] = size[odd, ::-1]

    scale = _largest_scale(size, room)
    is_kept = fits & np.isfinite(scale)
    # The others may have no finite scale or center.
    scale[~is_kept], former_center[~is_kept] = 1.0, 0.0
    points *= charts.spread(scale)[:, None]
    points += charts.spread(former_center)
    kept = np.repeat(is_kept, charts.counts)
    points = np.where(kept[:, None], points, charts.of_corners(result))
    placed[slice(None) if charts.corners is None else charts.corners] = kept
    return charts.with_rows(result, points), placed


def _quarters_toward(
    points: np.ndarray,
    former_points: np.ndarray,
    charts: CornerGroups,
    size: np.ndarray,
    room: np.ndarray,
    is_upright: np.ndarray,
) -> np.ndarray:
    """Return the quarter turns, (K,) integer from 0 to 3, that bring every chart to its former orientation.

    `points` (n, 2) are the charts' corners, in boxes of `size` (K, 2) that go into `room`;
    `former_points` are those of the former map. Charts that are `is_upright` (K,) bool get even turns.
    """
    moved, _ = _centered(charts, points)
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        target, _ = _centered(charts, former_points)
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
    charts = CornerGroups.of(chart)
    if not len(charts):
        return np.array(uv, dtype=np.float64)
    moved, _ = _centered(charts, charts.of_corners(uv))
    target, center = _centered(charts, charts.of_corners(reference))
    along = np.add.reduceat(np.conj(moved) * target, charts.starts)
    along = np.where(charts.any(upright), along.real, along)
    turn = np.where(along == 0.0, 1.0, along) / np.where(along == 0.0, 1.0, np.abs(along))
    placed = charts.spread(scale[charts.numbers] * turn) * moved + charts.spread(center)
    return charts.with_rows(uv, placed.view(np.float64).reshape(-1, 2))


def _centered(charts: CornerGroups, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the `points` (n, 2) of the charts' corners as complex numbers about the charts' means, (n,) and (K,)."""
    values = points[:, 0] + 1j * points[:, 1]
    center = np.add.reduceat(values, charts.starts) / charts.counts
    return values - charts.spread(center), center


def _largest_scale(size: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Return the largest factors with which boxes of `size` (K, 2) fit into `room` (K, 2)."""
    return np.divide(room, size, out=np.full_like(size, np.inf), where=size > 0.0).min(axis=1)


def _turned(points: np.ndarray, quarters: np.ndarray) -> np.ndarray:
    """Turn the `points` (N, 2) counterclockwise about the origin, each by its number of `quarters` (N,), 0 to 3."""
    x, y = points.T
    return np.stack([np.choose(quarters, [x, -y, -x, y]), np.choose(quarters, [y, x, -y, -x])], axis=1)


def _single_pins_at_former_area(mesh: PolygonMesh, solution: Solution) -> np.ndarray:
    """Return the solution's map, (C, 2), with single-pin charts scaled about their pin to their former area.

    Charts whose former area is not positive keep their size. Without such charts this is the solution's own array.
    """
    single = np.append(solution.column("n_pins") == 1, False)
    chart = np.where(single[solution.chart_of_corner], solution.chart_of_corner, -1)
    corners = np.flatnonzero(chart >= 0)
    if not len(corners):
        return solution.uv
    result, former, number = solution.uv.copy(), mesh.isotropic_uv(), len(solution.charts)
    area, former_area = (areas(points, chart, mesh.face_offsets, number) for points in (result, former))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        scale = np.sqrt(former_area / area)
    scale[~(np.isfinite(scale) & (scale > 0.0))] = 1.0
    # All pinned corners of a chart have one position.
    pinned = np.flatnonzero(mesh.usable_pins() & (chart >= 0))
    pin = np.zeros((number, 2))
    pin[chart[pinned]] = former[pinned]
    center = pin[chart[corners]]
    result[corners] = center + (result[corners] - center) * scale[chart[corners], None]
    return result


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
    factors (`density.py`). They turn as the settings say, but for those with constraints. Stacked charts of one mesh
    stay stacked while they have the same shape.

    Raises:
        ReadableError: the margin is not finite.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    if not meshes:
        return Placement([])
    counts = [len(mesh.corner_vertices) for mesh in meshes]
    maps, movable = [solution.uv for solution in solutions], [solution.chart_of_corner for solution in solutions]
    if charts_of(solutions).column("n_pins").any() or any(mesh.held_axis is not None for mesh in meshes):
        maps = [_with_pins_placed(mesh, solution) for mesh, solution in zip(meshes, solutions)]
        movable = [_movable(mesh, solution) for mesh, solution in zip(meshes, solutions)]
    solved = _joined(maps)
    uv = at_equal_density(meshes, movable, solved)
    chart = numbered_together(movable, [len(solution.charts) for solution in solutions])
    if settings.keep_in_place:
        return _in_place(meshes, counts, uv, chart)
    own = _split(chart, counts)
    laid = [
        stacked_as_before(mesh, part, number) if len(solution.charts) > 1 else (part, number)
        for mesh, solution, part, number in zip(meshes, solutions, _split(uv, counts), own)
    ]
    every, has_stacks = chart, any(lies_on is not number for (_, lies_on), number in zip(laid, own))
    if has_stacks:
        uv, chart = (np.concatenate(parts) for parts in zip(*laid))
    uv = _for_images(meshes, counts, uv)
    charts = CornerGroups.of(chart)
    if not len(charts):
        return Placement(_split(uv, counts))
    islands = _Islands(meshes, solutions, counts, uv, chart, charts, beside)
    extents = [solution.chart_extents for solution in solutions]
    # The solver knows those of the maps that it made.
    is_as_solved = uv is solved and all(each is not None for each in extents)
    known = _joined(extents)[charts.numbers] if is_as_solved else None
    bounds = charts.bounds(uv) if known is None else known[:, :4].reshape(-1, 2, 2)
    boxes = _boxes(charts, bounds, settings.margin, quick=True)
    keep_turn = np.isin(charts.numbers, chart[_joined([mesh.constrained_corners() for mesh in meshes])])
    packed = _packed(islands, boxes, settings, keep_turn, progress)
    fill = packed.fill
    if fill is None and known is not None:
        fill = float((known[:, 4] / boxes.scale**2).sum())
    elif fill is None or has_stacks:
        # Each stack counts once.
        alone = np.where(every == chart, chart, -1)
        fill = float(
            sum(
                areas(part, number, mesh.face_offsets, int(chart.max()) + 1).sum()
                for mesh, part, number in zip(meshes, packed.uv, _split(alone, counts))
            )
        )
    stacked = len(np.unique(every[every != chart])) if has_stacks else 0
    return replace(packed, fill=fill, stacked=stacked)


def _in_place(meshes: Sequence[PolygonMesh], counts: Sequence[int], uv: np.ndarray, chart: np.ndarray) -> Placement:
    """Place charts into their former bounding boxes; those without a former extent side by side."""
    former = _joined([np.zeros((n, 2)) if mesh.uv is None else mesh.isotropic_uv() for mesh, n in zip(meshes, counts)])
    upright = _joined([mesh.constrained_corners() for mesh in meshes])
    uv, kept = into_former_bounds(uv, former, chart, upright)
    left = np.where(kept, -1, chart)
    uv = _for_images(meshes, counts, uv)
    return Placement(_split(side_by_side(uv, left), counts), len(np.unique(left[left >= 0])))


def _for_images(meshes: Sequence[PolygonMesh], counts: Sequence[int], uv: np.ndarray) -> np.ndarray:
    """Return isotropic maps (sum of C, 2) in the coordinates of each mesh's image, in which the tile is a square."""
    if all(mesh.aspect == 1.0 for mesh in meshes):
        return uv
    return np.concatenate([mesh.from_isotropic_uv(part) for mesh, part in zip(meshes, _split(uv, counts))])


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
    charts = CornerGroups.of(np.where((mesh.held_axis >= 0) & ~solution.pinned_corners, solution.chart_of_corner, -1))
    if not len(charts):
        return uv
    free = 1 - charts.of_corners(mesh.held_axis)[0]
    center, former_center = (charts.bounds(each)[:, :, free].mean(axis=1) for each in (uv, mesh.isotropic_uv()))
    shift = np.zeros((len(charts), 2))
    shift[:, free] = former_center - center
    return charts.with_rows(uv, charts.of_corners(uv) + charts.spread(shift))


class _Islands:
    """The charts of all meshes as islands to pack, and the faces around them that stay.

    Attributes:
        meshes: those of the charts, then those `beside` with a map.
        counts: number of corners of each of the former.
        uv: the maps of the former, one below the other, (sum of C, 2).
        charts: their corners by chart, K charts.
        maps: the map of each mesh, (C, 2), with the former coordinates of what stays.
        islands: the packed island of every face of each mesh, (F,), from 0 to K - 1; `STAYS` or `IGNORED`.
        staying: the bounding boxes of the faces that stay, (N, 2, 2).
        tile: column and row of the tile of the former maps.
    """

    def __init__(
        self,
        meshes: Sequence[PolygonMesh],
        solutions: Sequence[Solution],
        counts: Sequence[int],
        uv: np.ndarray,
        chart: np.ndarray,
        charts: CornerGroups,
        beside: Sequence[PolygonMesh],
    ) -> None:
        """Number the packed faces without gaps; `chart` (sum of C,) is the chart of every corner, -1 for none."""
        self.counts, self.uv, self.charts = counts, uv, charts
        self.maps, self.islands, staying = [], [], []
        for mesh, solution, own, number in zip(meshes, solutions, _split(uv, counts), _split(chart, counts)):
            self._add(mesh, solution, own, number[mesh.face_offsets[:-1]], staying)
        beside = [mesh for mesh in beside if mesh.uv is not None]
        for mesh in beside:
            n_faces = len(mesh.face_offsets) - 1
            self._add_staying(mesh, mesh.uv, np.full(n_faces, IGNORED), np.ones(n_faces, dtype=bool), staying)
        self.meshes = [*meshes, *beside]
        self.staying = np.concatenate([np.empty((0, 2, 2)), *staying])
        self.tile = self._former_tile(meshes)

    def _add(
        self, mesh: PolygonMesh, solution: Solution, uv: np.ndarray, number: np.ndarray, staying: list[np.ndarray]
    ) -> None:
        """Add a mesh with its map and the chart of every face, (F,), -1 for none."""
        numbers = self.charts.numbers
        # Without gaps, the numbers are those of the islands.
        has_gaps = numbers[-1] != len(numbers) - 1
        island = np.searchsorted(numbers, number) if has_gaps else number
        if not len(number) or number.min() >= 0:
            self.maps.append(uv)
            self.islands.append(island)
            return
        if mesh.uv is not None:
            uv = np.where(solution.solved_corners[:, None], uv, mesh.uv)
        has_map = solution.solved_corners[mesh.face_offsets[:-1]] | (mesh.uv is not None)
        self._add_staying(mesh, uv, np.where(number >= 0, island, IGNORED), has_map & (number < 0), staying)

    def _add_staying(
        self, mesh: PolygonMesh, uv: np.ndarray, island: np.ndarray, faces: np.ndarray, staying: list[np.ndarray]
    ) -> None:
        """Add a mesh of which the `faces` (F,) bool stay where they are, unless nobody has made their map."""
        stays = obstacles(mesh, uv, faces)
        self.maps.append(uv)
        self.islands.append(np.where(stays, STAYS, island))
        staying.append(np.stack(mesh.face_bounds(uv), axis=1)[stays])

    def _former_tile(self, meshes: Sequence[PolygonMesh]) -> tuple[int, int]:
        if all(mesh.uv is None for mesh in meshes):
            return 0, 0
        former = _joined(
            [np.full((n, 2), np.nan) if mesh.uv is None else mesh.uv for mesh, n in zip(meshes, self.counts)]
        )
        with np.errstate(over="ignore", invalid="ignore"):
            return tile_of(self.charts.bounds(former).mean(axis=1), self.charts.counts)

    def packed_into(
        self,
        tile: tuple[int, int],
        is_around: bool,
        settings: Settings,
        keep_turn: np.ndarray,
        progress: Progress | None,
    ) -> Packed | None:
        """Pack by shapes into a tile, if `is_around` around the faces that stay; None if not all find room.

        `keep_turn`, (K,) bool, are the islands that do not turn.
        """
        islands = self.islands
        if not is_around:
            islands = [np.where(each == STAYS, IGNORED, each) for each in islands]
        packed = ShapePacking(
            *(self.meshes, self.maps, islands, _RASTER, max(0.0, settings.margin) * _RASTER, progress),
            rotation=settings.rotation,
            keep_turn=keep_turn,
            regions=[region_of_tile(tile)],
            keep_stacks=False,
            quick=True,
        ).now()
        return None if packed.without_room else packed


def _packed(
    islands: _Islands, boxes: _Boxes, settings: Settings, keep_turn: np.ndarray, progress: Progress | None
) -> Placement:
    """Pack the islands by their shapes, or leave them in their `boxes`, which never fails; that fill is not known."""
    in_tile = covered(islands.staying, islands.tile)
    is_beside, has_room = bool((in_tile > 0.0).any()), in_tile.sum() <= _MAX_COVER
    own_tile = free_tile(islands.tile, islands.staying) if is_beside else islands.tile
    n_meshes, n_islands = len(islands.counts), len(islands.charts)
    # An island needs the margin on both sides, in square pixels. A single island that does not turn is its box.
    has_width = 2.0 * settings.margin < isotropy(islands.meshes).min()
    may_turn = settings.rotation != "none" and not keep_turn.all()
    if has_width and n_islands <= _MAX_SHAPES and (is_beside or may_turn or n_islands > 1):
        options = (settings, keep_turn, progress)
        found = islands.packed_into(islands.tile, is_beside, *options) if has_room else None
        if is_beside and (found is None or found.fill < _MIN_SCALE**2):
            larger = islands.packed_into(own_tile, False, *options)
            if larger is not None and (found is None or found.fill < _MIN_SCALE**2 * larger.fill):
                return Placement(larger.maps[:n_meshes], left_tile=True, fill=larger.fill)
        if found is not None:
            return Placement(found.maps[:n_meshes], fill=found.fill)
    uv = boxes.of(islands.charts, islands.uv, own_tile)
    return Placement(_split(uv, islands.counts), left_tile=own_tile != islands.tile)


def _joined(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Return the parts one below the other; a single one is not copied."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _split(values: np.ndarray, counts: Sequence[int]) -> list[np.ndarray]:
    """Split an array into parts with these numbers of rows."""
    return [values[end - count : end] for count, end in zip(counts, accumulate(counts))]
