# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack the islands of maps that are there, whatever made them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import choices
from ..errors import ReadableError
from ..measure import defects
from ..mesh.polygon_mesh import PolygonMesh
from ..solve.progress import Progress
from ..words import texts
from .shape_packing import IGNORED, STAYS, Packed, PackOptions, ShapePacking, obstacles

_STACKS = {
    choices.STACKS_APART: ("none", False),
    choices.STACKS_KEPT: ("none", True),
    choices.STACKS_EQUAL: ("equal", True),
    choices.STACKS_MIRRORED: ("mirrored", True),
}


@dataclass(frozen=True)
class MapPackOptions:
    """The operator's settings, without Blender.

    Attributes:
        side: pixels along a side of the texture, of a square one with as many.
        margin: in these pixels.
        rotation: as in `PackOptions`.
        scale: whether islands fill the tiles at a common scale.
        stacks: an identifier of `texts.STACKS_ITEMS`.
        hold_pinned: whether islands with a pinned UV stay.
        tiles: (column, row) of the UV tiles to fill; None for those in which the islands are, each island in its own.
    """

    side: float = 1024.0
    margin: float = 4.0
    rotation: str = "free"
    scale: bool = True
    stacks: str = choices.STACKS_KEPT
    hold_pinned: bool = True
    tiles: Sequence[tuple[int, int]] | None = None


class MapPacking:
    """The islands of some maps, packed more and more densely.

    Attributes:
        corners: which corners of each mesh are in islands to pack, (C,) bool.
        pinned: number of islands that stay because of pins.
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
            progress: the work is cancelled where it returns False.

        Raises:
            ReadableError: the margin leaves no room in the texture.
            NativeModuleError: `spectral_conformal` cannot be imported.
            spectral_conformal.Cancelled: `progress` returned False.
        """
        found = defects.find([replace(mesh, uv=mesh.uv.astype(np.float32)) for mesh in meshes], between_islands=False)
        islands = [each.island_of_face for each in found]
        wanted = np.unique(np.concatenate([island[faces & (island >= 0)] for island, faces in zip(islands, chosen)]))
        pinned = [_with_pin(mesh, island) for mesh, island in zip(meshes, islands)]
        held = np.intersect1d(wanted, np.concatenate(pinned)) if options.hold_pinned else np.empty(0, dtype=int)
        wanted = np.setdiff1d(wanted, held)
        self.pinned = len(held)
        numbers = [_numbers(mesh, island, wanted) for mesh, island in zip(meshes, islands)]
        self.corners = [(part >= 0)[mesh.face_of_corner()] for mesh, part in zip(meshes, numbers)]
        self._packing: ShapePacking | None = None
        if not len(wanted):
            return
        own_tiles = options.tiles is None
        tiles = _tiles_of(meshes, numbers, len(wanted)) if own_tiles else options.tiles
        # An island needs the margin on both sides, within the narrower side of the image.
        if not 2.0 * options.margin < options.side * min(min(mesh.aspect, 1.0 / mesh.aspect) for mesh in meshes) ** 0.5:
            raise ReadableError(texts.margin_too_wide(options.margin, options.side))
        stacks, keep_stacks = _STACKS[options.stacks]
        shapes = PackOptions(
            options.side, options.margin, options.rotation, options.scale, tiles, own_tiles, stacks, keep_stacks
        )
        self._packing = ShapePacking(meshes, [mesh.uv for mesh in meshes], numbers, shapes, progress)

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


def pack(
    meshes: Sequence[PolygonMesh],
    chosen: Sequence[np.ndarray],
    options: MapPackOptions,
    steps: int,
    progress: Progress | None = None,
) -> MapPacking:
    """Pack as `MapPacking` does, with a number of steps."""
    packing = MapPacking(meshes, chosen, options, progress)
    if packing.can_move and steps:
        packing.step(steps, progress)
    return packing


def _with_pin(mesh: PolygonMesh, island: np.ndarray) -> np.ndarray:
    """Return the numbers of the islands, given that of every face, (F,), with a pinned corner."""
    if mesh.pinned_corners is None or not mesh.pinned_corners.any():
        return np.empty(0, dtype=int)
    return np.unique(island[mesh.face_of_corner()[mesh.pinned_corners]])


def _numbers(mesh: PolygonMesh, island: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the number to pack under of every face, (F,): the index of its island in `wanted`, or why it has none."""
    goes = np.isin(island, wanted)
    stays = obstacles(mesh, mesh.uv, ~goes)
    return np.where(goes, np.searchsorted(wanted, island), np.where(stays, STAYS, IGNORED))


def _tiles_of(meshes: Sequence[PolygonMesh], numbers: Sequence[np.ndarray], count: int) -> list[tuple[int, int]]:
    """Return the UV tiles with the centers of the islands' bounding boxes, in the order of UDIM numbers."""
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    for mesh, number in zip(meshes, numbers):
        faces = number >= 0
        for bound, combine, value in zip((low, high), (np.minimum, np.maximum), mesh.face_bounds(mesh.uv)):
            combine.at(bound, number[faces], value[faces])
    tiles = np.unique(np.floor((low + high) / 2.0).astype(np.int64)[:, ::-1], axis=0)
    return [(column, row) for row, column in tiles.tolist()]
