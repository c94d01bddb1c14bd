# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack islands of several meshes by their shapes, all in one UV plane, around the faces that stay."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from ..solve.joined import joined
from ..solve.progress import Progress

# In place of an island's number: the face stays and is an obstacle, or is ignored.
STAYS = -1
IGNORED = -2
# Blender fills a new map with faces as large as the tile; faces wider and higher than this fraction are of that kind.
_WHOLE_TILE = 0.9

# low u, low v, high u, high v
Region = tuple[float, float, float, float]
_TILE: Region = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class Packed:
    """A packing: one map, (C, 2), per mesh, in which faces without an island keep their UVs to the bit.

    Attributes:
        maps: the maps.
        fill: area of the islands, each stack once, over that of the tiles.
        islands: number of islands.
        without_room: number of islands without room, which stay where they were.
        stacked: number of islands that lie on another.
        steps: orders of the islands tried after the first.
        regions: number of tiles, or boxes, to fill.
        is_kept: whether all islands are where they were.
    """

    maps: list[np.ndarray]
    fill: float
    islands: int
    without_room: int
    stacked: int
    steps: int
    regions: int
    is_kept: bool = False


class ShapePacking:
    """Islands that are packed ever more densely; the first packing is made at once."""

    def __init__(
        self,
        meshes: Sequence[PolygonMesh],
        maps: Sequence[np.ndarray],
        islands: Sequence[np.ndarray],
        side: float,
        margin: float,
        progress: Progress | None = None,
        *,
        rotation: str = "free",
        regions: Sequence[Region] = (_TILE,),
        min_size: float = 0.0,
        snap: bool = False,
        **options: object,
    ) -> None:
        """Pack once.

        Args:
            meshes: the meshes.
            maps: their UVs, (C, 2) each, finite where an island uses them.
            islands: (F,) each, the island of every face, numbered from 0 over all meshes; `STAYS` or `IGNORED`.
            side: in pixels, of a square texture with the same number of pixels; the raster of the search.
            margin: in these pixels.
            progress: the work is canceled where it returns False.
            rotation: as in `spectral_conformal.Packer`.
            regions: of the rectangles to fill, in this order.
            min_size: in pixels, of the longer side of an island.
            snap: whether straight borders get to those of pixels.
            options: further arguments of `spectral_conformal.Packer`.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            spectral_conformal.Cancelled: `progress` returned False.
            ValueError: the margin is as large as a tile; or, with `fewest`, there is no room.
        """
        self._maps = list(maps)
        # Images of different shapes have no space in common in which islands could turn.
        rotation = rotation if len({mesh.aspect for mesh in meshes}) == 1 else "none"
        self._isotropy = isotropy(meshes)
        island = np.concatenate(islands)
        self._number = int(island.max(initial=-1)) + 1
        sizes = np.concatenate([np.diff(mesh.face_offsets) for mesh in meshes])
        self._island_of_corner = np.repeat(island, sizes)
        uv = np.concatenate(maps)
        uv = np.where((self._island_of_corner == IGNORED)[:, None], np.nan, uv * self._isotropy)
        size = 2 * (max(1, math.ceil(side)),)
        pixel = size[0] / max(1.0, side)
        if snap:
            # The pixels of the texture itself, whatever its shape.
            size = tuple(max(1, round(side * factor)) for factor in self._isotropy.tolist())
            uv, self._isotropy, pixel = uv / self._isotropy, np.ones(2), 1.0
        self._packer = native.spectral_conformal().Packer(
            joined(meshes).with_map(uv),
            islands=np.maximum(island, STAYS),
            texture_size=size,
            margin=margin * pixel,
            rotation=rotation,
            regions=np.array(regions, dtype=np.float64).reshape(-1, 4) * np.tile(self._isotropy, 2),
            min_size=min_size * pixel,
            snap=snap,
            progress=progress,
            **options,
        )

    def step(self, n: int, progress: Progress | None = None) -> bool:
        """Try `n` more orders of the islands; return whether more may help.

        Raises:
            spectral_conformal.Cancelled: `progress` returned False.
        """
        return self._packer.step(n, progress=progress)

    def now(self) -> Packed:
        """Return the densest packing so far."""
        found = self._packer.result
        uv = found.uv if (self._isotropy == 1.0).all() else found.uv / self._isotropy
        # Coordinates of the texture and back may round; islands that stay keep their bits.
        stays = (found.motions == np.eye(2, 3)).all(axis=(1, 2))
        # The last two entries are those of faces without an island: `IGNORED` and `STAYS`.
        goes = np.append(found.has_room & ~stays, [False, False])
        ends = np.cumsum([len(before) for before in self._maps])[:-1]
        moved = np.split(uv, ends)
        moves = goes[self._island_of_corner]
        if not moves.all():
            parts = zip(np.split(moves, ends), moved, self._maps)
            moved = [np.where(part[:, None], after, before) for part, after, before in parts]
        without_room = int((~found.has_room).sum())
        stacked = int((found.stack != np.arange(self._number)).sum())
        is_kept = bool(stays.all())
        return Packed(moved, found.fill, self._number, without_room, stacked, found.steps, found.n_tiles, is_kept)


def isotropy(meshes: Sequence[PolygonMesh]) -> np.ndarray:
    """Return the factors of u and v, (2,), that make pixels of the image square; 1 if images differ in shape."""
    aspects = {mesh.aspect for mesh in meshes}
    aspect = aspects.pop() if len(aspects) == 1 else 1.0
    return np.array([aspect**0.5, aspect**-0.5])


def region_of_tile(tile: tuple[int, int]) -> Region:
    """Return the rectangle of a UV tile, given its column and row."""
    column, row = tile
    return float(column), float(row), column + 1.0, row + 1.0


def obstacles(mesh: PolygonMesh, uv: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return which of the `faces`, (F,) bool, of the map `uv` (C, 2) are obstacles; an untouched map has none."""
    if not faces.any():
        return faces
    low, high = mesh.face_bounds(uv)
    with np.errstate(invalid="ignore"):
        return faces & np.isfinite(high - low).all(axis=1) & ~((high - low) >= _WHOLE_TILE).all(axis=1)


def tile_of(uv: np.ndarray, weights: np.ndarray) -> tuple[int, int]:
    """Return column and row of the UV tile with most of these points (n, 2), each counted with its weight (n,).

    Points that are not finite do not count; the first tile if none does.
    """
    # Beyond, single precision has no tiles.
    with np.errstate(invalid="ignore"):
        counts = (np.abs(uv) < 2.0**20).all(axis=1)
    if not counts.any():
        return 0, 0
    tiles = np.floor(uv[counts])
    if (tiles != tiles[0]).any():
        tiles, tile = np.unique(tiles, axis=0, return_inverse=True)
        tiles = tiles[[np.argmax(np.bincount(tile.ravel(), weights[counts]))]]
    column, row = tiles[0]
    return int(column), int(row)


def covered(boxes: np.ndarray, tile: tuple[int, int]) -> np.ndarray:
    """Return how much of a UV tile each of the `boxes`, (N, 2, 2) as [low, high], covers, (N,)."""
    inside = np.clip(boxes - np.array(tile, dtype=np.float64), 0.0, 1.0)
    return (inside[:, 1] - inside[:, 0]).prod(axis=1)


def free_tile(tile: tuple[int, int], taken: np.ndarray) -> tuple[int, int]:
    """Return the next tile to the right of `tile` without one of the boxes `taken`, (N, 2, 2) as [low, high]."""
    column, row = tile
    in_row = taken[(taken[:, 0, 1] < row + 1.0) & (taken[:, 1, 1] > row)]
    while True:
        column += 1
        if not ((in_row[:, 0, 0] < column + 1.0) & (in_row[:, 1, 0] > column)).any():
            return column, row
