"""Pack the islands of a map by their shapes."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Progress
from ._measuring import connected
from ._mesh import Mesh, double_map_of, given_map, points_of
from ._results import Unwrap
from .defaults import MARGIN, ROTATION, TEXTURE_SIZE

Rotation = Literal["free", "square", "upright", "quarters", "none"]
ROTATIONS = get_args(Rotation)
STACKS = ("none", "equal", "mirrored")
_FIRST_TILE = 1001
_TRIES_FOR_A_TILE = 64
_TILES_IN_A_ROW = 10
# Islands of this size count as points: the scale that would fill a texture with them overflows.
_SMALLEST = 1e-290
_TRIES_OF_FIRST = 16


@dataclass(frozen=True, eq=False)
class PackedMap(Mesh):
    """The mesh with the map of `pack`, whose K islands have the numbers in `islands`."""

    uv: npt.NDArray[np.float64]
    """(C, 2); corners of faces that stay, and of islands without room, keep their UVs to the last bit."""
    islands: npt.NDArray[np.int32]
    """(F,) the island of each face, from 0 to K - 1; -1 for faces that stay."""
    motions: npt.NDArray[np.float64]
    """(K, 2, 3) the motion of each island in the UV plane: u', v' = motions[k] @ (u, v, 1); with `snap`, before it."""
    has_room: npt.NDArray[np.bool_]
    """(K,) whether the island was packed. All are, unless `scale` is False, or margin and least size leave no room."""
    stack: npt.NDArray[np.int32]
    """(K,) the island that this one lies on; itself for islands that lie alone."""
    scale: float
    """The size of all islands in the result over that in the given map, those enlarged to `min_size` aside; 0 if margin
    and least size leave no room for any."""
    fill: float
    """The area of the packed islands, each stack once, over that of the tiles."""
    n_tiles: int
    """Tiles or regions, from the first one on, that were to be filled; with `fewest`, as many as needed."""
    steps: int
    """Tries to find a denser packing after the first."""


class Packer:
    """A packing that gets denser step by step, so that a window can show the progress.

        packer = sc.Packer(mesh, texture_size=2048, margin=8)
        while packer.step(seconds=0.2):
            draw(packer.result.uv)

    The constructor makes the first packing. Steps continue where the last call ended. Threads that share an object take
    turns; a progress function must not call the object that called it.
    """

    def __init__(
        self,
        mesh: Mesh,
        *,
        islands: npt.ArrayLike | None = None,
        texture_size: int | tuple[int, int] = TEXTURE_SIZE,
        margin: float = MARGIN,
        rotation: Rotation = ROTATION,
        keep_turn: npt.ArrayLike | None = None,
        scale: bool = True,
        tiles: Sequence[int] = (1001,),
        regions: npt.ArrayLike | None = None,
        keep_regions: bool = False,
        fewest: bool = False,
        stacks: Literal["none", "equal", "mirrored"] = "none",
        keep_stacks: bool = True,
        keep_overlaps: bool = False,
        stack_tolerance: float = 0.01,
        min_size: float = 0.0,
        snap: bool = False,
        seed: int = 0,
        quick: bool = False,
        progress: Progress | None = None,
    ) -> None:
        """Pack once. Arguments and errors are those of `pack`, and `quick`.

        Args:
            quick: whether the first packing does only what counted work in proportion to the map's corners suffices
                for, a small part of what solving the map takes: bounding boxes, and shapes where few of them or large
                ones make that possible. The first step then makes the packing that it would have been otherwise.
        """
        self._mesh = given_map(mesh)
        progress = _arguments.checked_progress(progress)
        _arguments.poll(progress, "packing")
        offsets = self._mesh.face_offsets
        face_of_corner = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
        uv = double_map_of(self._mesh)
        has_uv = np.ones(len(offsets) - 1, bool)
        has_uv[face_of_corner[~np.isfinite(uv).all(axis=1)]] = False
        # Corners of an island with the same vertex and UV are one point, so that its outline is its border only.
        if islands is None and not isinstance(mesh, Unwrap):
            _check_points(has_uv)
            corners, first = points_of(mesh)
            _arguments.poll(progress, "packing")
            self._islands = island = connected(offsets, corners, len(first))
        else:
            if islands is not None:
                self._islands = _checked_islands(islands, len(offsets) - 1)
            elif isinstance(mesh, Unwrap):
                self._islands = _islands_of_charts(mesh)
            _check_points(has_uv[self._islands >= 0])
            if islands is None:
                has_uv &= self._islands >= 0
            # Faces with -2 are neither packed nor obstacles.
            island = np.where(has_uv, self._islands, -2).astype(np.int32)
            uv = np.where(has_uv[face_of_corner, None], uv, 0.0)
            corners, first = _native.weld_corners(mesh.corner_vertices, island[face_of_corner], uv, len(mesh.vertices))
        _arguments.poll(progress, "packing")
        self._point_of_corner, self._points = corners, uv[first]
        self._island_of_point = island[face_of_corner[first]]
        size = _texture_size(texture_size)
        rectangles = _rectangles(tiles, regions)
        if _arguments.checked_flag(fewest, "fewest") and (scale is not False or keep_regions):
            raise ValueError("fewest needs scale=False, without keep_regions: otherwise islands fill all tiles.")
        margin = _arguments.checked_at_least(margin, 0.0, "margin")
        self._snaps = _arguments.checked_flag(snap, "snap")
        if self._snaps:
            # Two islands may come closer in both directions.
            margin += 2.0**1.5 * _native.MAX_SNAP
        min_size = _arguments.checked_at_least(min_size, 0.0, "min_size")
        if min_size == math.inf:
            raise ValueError("min_size must be finite.")
        if not (np.diff(rectangles.reshape(-1, 2, 2), axis=1)[:, 0] * size > margin).all():
            raise ValueError(f"margin must be less than the width and the height of each region, not {margin!r}.")
        _arguments.checked_choice(rotation, "rotation", ROTATIONS)
        _arguments.checked_choice(stacks, "stacks", STACKS)
        scale = _arguments.checked_flag(scale, "scale")
        keep_regions = _arguments.checked_flag(keep_regions, "keep_regions")
        number = int(self._islands.max(initial=-1)) + 1
        flags = np.zeros(number, bool) if keep_turn is None else keep_turn
        keeps_turn = _arguments.checked_flags(flags, "keep_turn", number, "island")
        low, high = _bounds(self._points, self._island_of_point, number)
        self._size, self._unit = size, 1.0
        collapsed = None
        with np.errstate(over="ignore"):
            # With a common scale, UVs may have any magnitude.
            extent = float((high - low).max(initial=0.0))
            if scale and _SMALLEST < extent < math.inf:
                self._unit = extent
            elif scale and extent <= _SMALLEST:
                of_point = self._island_of_point[:, None]
                collapsed = np.where(
                    of_point >= 0, np.append(low, [[0.0, 0.0]], axis=0)[np.maximum(of_point[:, 0], -1)], self._points
                )
            # Obstacles beyond the largest number obstruct nothing.
            points = self._points / self._unit * size if collapsed is None else collapsed * size
            stays = self._island_of_point < 0
            if self._unit != 1.0 and stays.any():
                points[stays] = self._points[stays] * size
        finite = np.isfinite(points).all(axis=1)
        if not finite.all():
            if not finite[~stays].all():
                raise ValueError("uv has islands so large that their pixels overflow; make them smaller.")
            island[face_of_corner[~finite[corners]]] = -2
            points[~finite] = 0.0
        region = np.full(number, -1, np.int32)
        if keep_regions:
            center = (0.5 * low + 0.5 * high)[:, None]
            inside = ((rectangles[:, :2] <= center) & (center < rectangles[:, 2:])).all(axis=2)
            region = np.where(inside.any(axis=1), inside.argmax(axis=1), -1).astype(np.int32)
        _arguments.poll(progress, "packing")

        def packing(rectangles: npt.NDArray[np.float64], progress: Progress | None) -> _native.Packing:
            # Charts lie about the origin, where all overlap and equal ones coincide.
            keeps = not isinstance(mesh, Unwrap)
            return _native.Packing(
                points,
                offsets,
                corners,
                island,
                region,
                keeps_turn,
                self._unit,
                rectangles * np.tile(size, 2),
                margin,
                rotation,
                stacks,
                _arguments.checked_flag(keep_stacks, "keep_stacks") and keeps,
                _arguments.checked_flag(keep_overlaps, "keep_overlaps") and keeps,
                _arguments.checked_between(stack_tolerance, 0.0, 1.0, "stack_tolerance"),
                min_size,
                scale,
                _arguments.checked_count(seed, "seed"),
                _arguments.checked_flag(quick, "quick"),
                progress,
            )

        self._n_tiles = len(rectangles)
        if fewest:
            self._native, self._n_tiles = _into_fewest(packing, rectangles, progress)
        else:
            self._native = packing(rectangles, progress)

    def step(self, n: int = 2**31 - 1, *, seconds: float = math.inf, progress: Progress | None = None) -> bool:
        """Try `n` times, or for `seconds`, to find a denser packing. Return whether more tries may help.

        Four tries are made at a time; those that are left over are made with those of later calls.

        Raises:
            ValueError: nothing ends the step: no `n`, no `seconds` and no `progress`.
            Cancelled: `progress` returned False; the packing is that of the last call.
        """
        if n == 2**31 - 1 and seconds == math.inf and progress is None:
            raise ValueError("step needs n, seconds or a progress function that ends it.")
        return self._native.advance(
            _arguments.checked_count(n, "n"),
            _arguments.checked_at_least(seconds, 0.0, "seconds"),
            _arguments.checked_progress(progress),
        )

    @property
    def result(self) -> PackedMap:
        """The densest packing so far."""
        state = self._native.state()
        motions, has_room = state["motions"], state["has_room"]
        # From pixels to UVs: x = u w.
        motions[:, :, :2] *= self._size[None, None, :] / self._size[None, :, None] / self._unit
        motions[:, :, 2] /= self._size
        motions[~has_room] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        moved = _native.moved_with_islands(self._points, self._island_of_point, motions, has_room)
        if self._snaps:
            moved = self._snapped(moved, np.where(has_room, state["stack"], -1))
        mesh = self._mesh
        moves = np.append(has_room, [False, False])[self._island_of_point[self._point_of_corner]]
        return PackedMap(
            vertices=mesh.vertices,
            face_offsets=mesh.face_offsets,
            corner_vertices=mesh.corner_vertices,
            seam_edges=mesh.seam_edges,
            uv=np.where(moves[:, None], moved.take(self._point_of_corner, axis=0), double_map_of(mesh)),
            islands=self._islands.copy(),
            motions=motions,
            has_room=has_room,
            stack=state["stack"],
            scale=state["scale"] / self._unit,
            fill=state["fill"],
            n_tiles=self._n_tiles,
            steps=state["steps"],
        )

    def _snapped(self, points: npt.NDArray[np.float64], stack: npt.NDArray[np.int32]) -> npt.NDArray[np.float64]:
        """Return points in UVs with the straight borders of islands between pixels, given the stack of each, or -1."""
        # Stacked islands stay on each other.
        group = np.append(stack, -1)[np.maximum(self._islands, -1)].astype(np.int32)
        offsets = self._mesh.face_offsets
        moved = _native.snapped(points * self._size, offsets, self._point_of_corner, group, len(stack))
        is_moved = (np.append(stack, -1)[np.maximum(self._island_of_point, -1)] >= 0)[:, None]
        return np.where(is_moved, moved / self._size, points)


def pack(
    mesh: Mesh,
    *,
    islands: npt.ArrayLike | None = None,
    texture_size: int | tuple[int, int] = TEXTURE_SIZE,
    margin: float = MARGIN,
    rotation: Rotation = ROTATION,
    keep_turn: npt.ArrayLike | None = None,
    scale: bool = True,
    tiles: Sequence[int] = (1001,),
    regions: npt.ArrayLike | None = None,
    keep_regions: bool = False,
    fewest: bool = False,
    stacks: Literal["none", "equal", "mirrored"] = "none",
    keep_stacks: bool = True,
    keep_overlaps: bool = False,
    stack_tolerance: float = 0.01,
    min_size: float = 0.0,
    snap: bool = False,
    seed: int = 0,
    steps: int = 0,
    seconds: float = math.inf,
    progress: Progress | None = None,
) -> PackedMap:
    """Pack the islands of a map by their shapes: none overlaps another, and one may lie in a hole of another.

        packed = sc.pack(mesh, texture_size=2048, margin=8, steps=200)
        packed.uv, packed.fill

    Islands move, turn and scale as a whole, all by the same scale. The first packing is at least as dense as one by
    bounding boxes and, to within 1 %, as the given map if that meets the options; `steps` and `seconds` allow denser
    ones. The result depends only on the arguments, not on threads or the machine's load, unless `seconds` ends
    the search.

    Args:
        mesh: with a map, finite where an island uses it.
        islands: (F,) the island of each face, numbered from 0. Faces of a group that stays together have the same
            number. Faces with -1 stay where they are, as obstacles where they have finite UVs. By default islands are
            faces that share a vertex and its UV, or the solved charts of an `Unwrap`, whose other faces obstruct
            nothing.
        texture_size: width and height of a tile in pixels.
        margin: in pixels, between islands, to obstacles, and to the border of a region; never less.
        rotation: 'free', 'square', 'upright', 'quarters' or 'none'. 'upright' straightens islands, by their outlines,
            and then turns them by quarters, as 'quarters' does with islands as they are. 'square' does so with islands
            whose outline runs along and across one direction for the most part; the others turn freely.
        keep_turn: (n,) bool, the islands that do not turn. With `stacks`, half a turn may put one onto an equal one.
        scale: whether the islands fill the tiles at a common scale. If not, they keep their sizes, and those without
            room stay where they are.
        tiles: UDIM numbers of the tiles to fill, in this order.
        regions: (R, 4) rectangles to fill instead of tiles: low u, low v, high u, high v.
        keep_regions: whether each island stays in the region in which its center lies.
        fewest: without `scale`: whether only as many of the tiles or regions are filled, from the first one on, as the
            islands need, the least number that is found; all must be as large as the first.
        stacks: 'equal' stacks islands with equal outlines, 'mirrored' also their mirror images, which get mirrored.
        keep_stacks: whether islands that coincide in the given map stay stacked; charts of an `Unwrap` do not.
        keep_overlaps: whether islands that overlap in the given map move as one, whatever their shapes, and count as
            stacked; charts of an `Unwrap` do not.
        stack_tolerance: largest distance between outlines that count as equal, as a fraction of their size.
        min_size: in pixels; islands are enlarged until the longer side of their smallest bounding rectangle has it.
        snap: whether straight borders along the axes, of a pixel or more, get to the border of a pixel, at most half a
            pixel away; the rest of the island stretches evenly between them, and the margin holds all the same.
        seed: of the search.
        steps: tries to find a denser packing after the first; made four at a time, so up to three fewer.
        seconds: ends the steps early.
        progress: as in `parameterize`.

    Raises:
        ValueError: an array is not as described here, an island is too large for double precision or, with `fewest`,
            for a tile, tiles or regions overlap, or the margin is as large as a region.
        TypeError: an argument has the wrong type.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory.
    """
    steps = _arguments.checked_count(steps, "steps")
    # The first packing takes about as long as so many tries.
    share = steps / (steps + _TRIES_OF_FIRST)
    packer = Packer(
        mesh,
        islands=islands,
        texture_size=texture_size,
        margin=margin,
        rotation=rotation,
        keep_turn=keep_turn,
        scale=scale,
        tiles=tiles,
        regions=regions,
        keep_regions=keep_regions,
        fewest=fewest,
        stacks=stacks,
        keep_stacks=keep_stacks,
        keep_overlaps=keep_overlaps,
        stack_tolerance=stack_tolerance,
        min_size=min_size,
        snap=snap,
        seed=seed,
        progress=_part(progress, 0.0, 1.0 - share),
    )
    if steps:
        packer.step(steps, seconds=seconds, progress=_part(progress, 1.0 - share, 1.0))
    return packer.result


def _into_fewest(
    packing: Callable[[npt.NDArray[np.float64], Progress | None], _native.Packing],
    regions: npt.NDArray[np.float64],
    progress: Progress | None,
) -> tuple[_native.Packing, int]:
    """Return a packing into as few regions as are found to have room for all islands, and their number.

    Args:
        packing: into regions, (R, 4).
        regions: (R, 4), to be filled from the first one on.
        progress: as in `parameterize`.

    Raises:
        ValueError: a region has no room for an island, or all have none for some of them.
    """
    tried = 0

    def into(number: int) -> tuple[_native.Packing, int, int]:
        """Pack into regions; return also how many islands have room, and how many do not."""
        nonlocal tried
        tried += 1
        found = packing(regions[:number], _part(progress, 1.0 - 0.5 ** (tried - 1), 1.0 - 0.5**tried))
        return found, *_counts(found)

    number, least, before = 1, 1, -1
    while True:
        best, with_room, without = into(number)
        if not without:
            break
        if without == before:
            islands, them = ("1 island has", "it") if without == 1 else (f"{without} islands have", "them")
            raise ValueError(f"{islands} no room in a tile; make {them} or the margin smaller.")
        if number == len(regions):
            raise ValueError(f"{number} tiles have no room for {without} of the islands; make them smaller.")
        before, least = without, number + 1
        # Large islands come first, so those that are left need fewer regions for their number.
        more = math.floor(0.5 * number * without / max(1, with_room))
        number = min(len(regions), number + max(1, more))
    while least < number:
        middle = (least + number) // 2
        fewer, _, without = into(middle)
        if without:
            least = middle + 1
        else:
            best, number = fewer, middle
    if number > 1:
        # Other orders of the islands may need one region less.
        one_less, _, without = into(number - 1)
        if without:
            one_less.advance(_TRIES_FOR_A_TILE, math.inf, None)
        if not _counts(one_less)[1]:
            best, number = one_less, number - 1
    return best, number


def _counts(packing: _native.Packing) -> tuple[int, int]:
    """Return the number of islands that have room, and of those that have none."""
    has_room = packing.state()["has_room"]
    return int(has_room.sum()), int((~has_room).sum())


def _part(progress: Progress | None, low: float, high: float) -> Progress | None:
    """Return the progress function of a part of the work, from `low` to `high`."""
    _arguments.checked_progress(progress)
    if progress is None:
        return None
    return lambda fraction, phase: progress(low + (high - low) * fraction, phase)


def _texture_size(texture_size: int | tuple[int, int]) -> npt.NDArray[np.float64]:
    sides = texture_size if isinstance(texture_size, (tuple, list)) else (texture_size, texture_size)
    if len(sides) != 2:
        raise ValueError(f"texture_size must be a number of pixels or two, not {texture_size!r}.")
    sizes = [_arguments.checked_count(side, "texture_size") for side in sides]
    if min(sizes) < 1:
        raise ValueError(f"texture_size must be at least one pixel, not {texture_size!r}.")
    return np.array(sizes, dtype=np.float64)


def _rectangles(tiles: Sequence[int], regions: npt.ArrayLike | None) -> npt.NDArray[np.float64]:
    """Return the regions to fill, (R, 4) in UVs."""
    if regions is not None:
        rectangles = _arguments.checked_floats(regions, "regions", 4)
        if not (np.isfinite(rectangles).all() and (rectangles[:, :2] < rectangles[:, 2:]).all()):
            raise ValueError("regions must be finite: low u, low v, high u, high v.")
        _check_apart(rectangles)
    else:
        if not isinstance(tiles, Iterable):
            raise TypeError(f"tiles must be a sequence of UDIM numbers, not {tiles!r}.")
        numbers = [_arguments.checked_count(tile, "tiles") - _FIRST_TILE for tile in tiles]
        if numbers and min(numbers) < 0:
            raise ValueError(f"tiles must be UDIM numbers, from {_FIRST_TILE} on.")
        repeated = [number for number, count in Counter(numbers).items() if count > 1]
        if repeated:
            raise ValueError(f"tiles must differ, since each is filled once; {_FIRST_TILE + repeated[0]} is repeated.")
        low = np.array([(number % _TILES_IN_A_ROW, number // _TILES_IN_A_ROW) for number in numbers], float)
        rectangles = np.hstack([low.reshape(-1, 2), low.reshape(-1, 2) + 1.0])
    if not len(rectangles):
        raise ValueError("tiles or regions must name at least one to fill.")
    return rectangles


def _check_apart(rectangles: npt.NDArray[np.float64]) -> None:
    """Raise ValueError if two of the regions (R, 4) overlap."""
    for k, (low_u, low_v, high_u, high_v) in enumerate(rectangles[:-1]):
        later = rectangles[k + 1 :]
        meets = (later[:, 0] < high_u) & (low_u < later[:, 2]) & (later[:, 1] < high_v) & (low_v < later[:, 3])
        if meets.any():
            raise ValueError(
                f"regions must not overlap, since each is filled on its own; {k} and {k + 1 + int(meets.argmax())} do."
            )


def _check_points(has_uv: npt.NDArray[np.bool_]) -> None:
    """Raise ValueError if a face of an island has no UVs."""
    if not has_uv.all():
        raise ValueError("uv has values that are not finite; every corner of an island needs a point.")


def _checked_islands(islands: npt.ArrayLike, n_faces: int) -> npt.NDArray[np.int32]:
    array = _arguments.checked_integers(islands, "islands")
    if array.shape != (n_faces,):
        raise ValueError(f"islands must have one entry for each of {n_faces} faces, not {array.shape}.")
    # At most as many numbers as faces, so that islands without faces take no memory.
    if array.size and (int(array.min()) < -1 or int(array.max()) >= array.size):
        raise ValueError(f"islands must lie between -1 and {array.size - 1}, one less than the number of faces.")
    return array.astype(np.int32)


def _islands_of_charts(mesh: Unwrap) -> npt.NDArray[np.int32]:
    """Return the solved chart of each face, (F,), -1 for none."""
    is_solved = np.zeros(len(mesh.chart_of_face), bool)
    is_solved[np.repeat(np.arange(len(is_solved)), np.diff(mesh.face_offsets))[mesh.solved_corners]] = True
    return np.where(is_solved, mesh.chart_of_face, -1).astype(np.int32)


def _bounds(
    uv: npt.NDArray[np.float64], island: npt.NDArray[np.int32], number: int
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return the corners of each island's bounding box, (K, 2); 0 for islands without vertices, NaN for NaN."""
    box = _native.island_bounds(uv, island, number)
    box[box[:, 0] > box[:, 2]] = 0.0
    return box[:, :2], box[:, 2:]
