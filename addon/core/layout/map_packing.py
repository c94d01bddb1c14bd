# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack the islands of existing maps."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import choices
from ..errors import ReadableError
from ..measure import defects
from ..mesh.group_bounds import face_group_bounds
from ..mesh.polygon_mesh import PolygonMesh
from ..solve.progress import Progress
from ..words.translation import translate
from .shape_packing import (
    IGNORED,
    STAYS,
    Packed,
    Region,
    ShapePacking,
    isotropy,
    obstacles,
    region_of_tile,
)

# Arguments of the packer.
_STACKS = {
    choices.STACKS_APART: {"keep_stacks": False},
    choices.STACKS_KEPT: {},
    choices.STACKS_OVERLAPPING: {"keep_overlaps": True},
    choices.STACKS_EQUAL: {"stacks": "equal"},
    choices.STACKS_MIRRORED: {"stacks": "mirrored"},
}


@dataclass(frozen=True)
class MapPackOptions:
    """The operator's settings, without Blender.

    Attributes:
        side: pixels along a side of a square texture with the same number of pixels.
        margin: in these pixels.
        rotation: as in `spectral_conformal.pack`.
        scale: whether islands fill the tiles at a common scale.
        stacks: one of `choices.STACKS_*`.
        hold_pinned: whether islands with a pinned UV stay, and the rest of their groups.
        regions: what to fill, rectangles in this order; `choices.TILES_OWN` to keep each island in its UV tile;
            `choices.TILES_BOUNDS` for the bounding box of all.
        groups: for each mesh the group of every face, (F,) int. Islands with faces of the same group move as one; an
            island with faces of several groups belongs to the first. None for no groups.
        fewest: whether only as many of the regions are filled as islands of this size need; then they are not scaled.
        min_size: in pixels, of the longer side of an island; smaller ones are enlarged.
        snap: whether straight borders get to the borders of pixels.
    """

    side: float = choices.TEXTURE_SIZE
    margin: float = choices.MARGIN
    rotation: str = choices.ROTATION.lower()
    scale: bool = True
    stacks: str = choices.STACKS_KEPT
    hold_pinned: bool = True
    regions: Sequence[Region] | str = choices.TILES_OWN
    groups: Sequence[np.ndarray] | None = None
    fewest: bool = False
    min_size: float = 0.0
    snap: bool = False

    @property
    def fills_box(self) -> bool:
        """Whether a box is filled instead of UV tiles."""
        return self.regions == choices.TILES_BOUNDS or any(
            tuple(region) != region_of_tile((int(np.floor(region[0])), int(np.floor(region[1]))))
            for region in ([] if isinstance(self.regions, str) else self.regions)
        )


class MapPacking:
    """The islands of some maps, packed ever more densely.

    Attributes:
        corners: which corners of each mesh are in islands to pack, (C,) bool.
        pinned: number of islands that stay because of pins.
        kept_turns: number of islands to pack that do not turn, since constraints single out directions.
    """

    def __init__(
        self,
        meshes: Sequence[PolygonMesh],
        chosen: Sequence[np.ndarray],
        options: MapPackOptions,
        progress: Progress | None = None,
    ) -> None:
        """Find the islands with a chosen face and pack them once; nothing if there are none.

        Args:
            meshes: meshes with a map; their selected faces are the visible ones, all others stay.
            chosen: (F,) bool for each mesh.
            options: how to pack.
            progress: the work is canceled where it returns False.

        Raises:
            ReadableError: the margin leaves no room, or, with `fewest`, an island is larger than a region.
            NativeModuleError: `spectral_conformal` cannot be imported.
            spectral_conformal.Cancelled: `progress` returned False.
        """
        found = defects.find([replace(mesh, uv=mesh.uv.astype(np.float32)) for mesh in meshes], between_islands=False)
        islands = [each.island_of_face for each in found]
        wanted = np.unique(np.concatenate([island[faces & (island >= 0)] for island, faces in zip(islands, chosen)]))
        group = _group_of_island(islands, options.groups)
        pinned = np.concatenate([_with_pin(mesh, island) for mesh, island in zip(meshes, islands)])
        held = np.intersect1d(wanted, pinned) if options.hold_pinned else np.empty(0, dtype=int)
        wanted = wanted[~np.isin(group[wanted], group[held])]
        self.pinned = len(held)
        number = np.full(len(group), -1)
        _, number[wanted] = np.unique(group[wanted], return_inverse=True)
        numbers = [_numbers(mesh, np.append(number, -1)[island]) for mesh, island in zip(meshes, islands)]
        self.corners = [(part >= 0)[mesh.face_of_corner()] for mesh, part in zip(meshes, numbers)]
        bound = [part[mesh.face_of_corner()[mesh.constrained_corners()]] for mesh, part in zip(meshes, numbers)]
        keep_turn = np.isin(np.arange(int(number.max(initial=-1)) + 1), np.concatenate(bound))
        self.kept_turns = 0 if options.rotation == "none" else int(keep_turn.sum())
        self._packing: ShapePacking | None = None
        if not len(wanted):
            return
        pixel, margin, regions = 1.0 / options.side / isotropy(meshes), options.margin, options.regions
        if isinstance(regions, str):
            low, high = face_group_bounds(meshes, numbers, int(number.max()) + 1)
            regions = _tiles_of(low, high)
            if options.regions == choices.TILES_BOUNDS:
                # The margin to the border of a region goes outward, so islands stay in the given box.
                regions = [(*(low.min(axis=0) - margin * pixel), *(high.max(axis=0) + margin * pixel))]
        # An island needs the margin on both sides, and to get to pixels up to sqrt(2) more.
        width = min(
            float(((high_u - u) / pixel[0], (high_v - v) / pixel[1])[axis])
            for u, v, high_u, high_v in regions
            for axis in (0, 1)
        )
        if not 2.0 * (margin + (2.0**0.5 if options.snap else 0.0)) < width:
            raise ReadableError(
                translate("A margin of {margin} px leaves no room within {side} px").format(
                    margin=format(options.margin, "g"), side=format(width, ".0f")
                )
            )
        try:
            self._packing = ShapePacking(
                *(meshes, [mesh.uv for mesh in meshes], numbers, options.side, margin, progress),
                rotation=options.rotation,
                keep_turn=keep_turn,
                scale=options.scale and not options.fewest,
                regions=regions,
                keep_regions=options.regions == choices.TILES_OWN,
                fewest=options.fewest,
                min_size=options.min_size,
                snap=options.snap,
                **_STACKS[options.stacks],
            )
        except ValueError as error:
            if not options.fewest:
                raise
            raise ReadableError(
                translate("Islands of this size do not fit into a tile; make them or the margin smaller")
            ) from error

    @property
    def can_move(self) -> bool:
        """Whether there are islands to pack."""
        return self._packing is not None

    def step(self, n: int, progress: Progress | None = None) -> bool:
        """Try `n` more orders of the islands; return whether more may help."""
        return self._packing.step(n, progress)

    def now(self) -> Packed:
        """Return the densest packing so far."""
        return self._packing.now()


def _with_pin(mesh: PolygonMesh, island: np.ndarray) -> np.ndarray:
    """Return the islands with a pinned corner, given the island of every face, (F,)."""
    if mesh.pinned_corners is None or not mesh.pinned_corners.any():
        return np.empty(0, dtype=int)
    return np.unique(island[mesh.face_of_corner()[mesh.pinned_corners]])


def _group_of_island(islands: Sequence[np.ndarray], groups: Sequence[np.ndarray] | None) -> np.ndarray:
    """Return the group of every island, (K,): the first of its faces' `groups`, by default the island itself."""
    island = np.concatenate(islands)
    count = int(island.max(initial=-1)) + 1
    if groups is None:
        return np.arange(count)
    result = np.full(count, np.iinfo(np.int64).max)
    np.minimum.at(result, island[island >= 0], np.concatenate(groups)[island >= 0])
    return result


def _numbers(mesh: PolygonMesh, number: np.ndarray) -> np.ndarray:
    """Return the number of every face for packing, (F,): its `number`, or if negative `STAYS` or `IGNORED`."""
    return np.where(number >= 0, number, np.where(obstacles(mesh, mesh.uv, number < 0), STAYS, IGNORED))


def _tiles_of(low: np.ndarray, high: np.ndarray) -> list[Region]:
    """Return the UV tiles that contain centers of bounding boxes, (K, 2) each, in the order of UDIM numbers."""
    tiles = np.unique(np.floor((low + high) / 2.0).astype(np.int64)[:, ::-1], axis=0)
    return [region_of_tile((column, row)) for row, column in tiles.tolist()]
