# SPDX-License-Identifier: GPL-3.0-or-later
"""Where packed islands go so that they do not overlap faces that stay.

Blender's packer from 4.0 on can lock islands, but only pinned ones, and pinning adds a layer to meshes that have none;
where the locked islands fill the tile, it shrinks the others to nothing. So the packed tile is moved as a whole, in the
same way in all versions.
"""

from collections.abc import Sequence

import numpy as np

from ..mesh.polygon_mesh import PolygonMesh

# Cells along a side of the tile: obstacles are known to 1.6 % of it.
_CELLS = 64
# A smaller free square holds less than a sixteenth of the tile's pixels; a tile of its own is better. That of a cube's
# cross, as Blender's own cube has it, is 0.375.
_MIN_SIDE = 0.25
# Blender fills a new map with faces as large as the tile; faces wider and higher than this fraction are of that kind.
_WHOLE_TILE = 0.9


def face_boxes(mesh: PolygonMesh, uv: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the bounding boxes, (N, 2, 2) float64 as [low, high], of the `faces` (F,) bool in the map `uv` (C, 2).

    Faces without finite UVs have none.
    """
    if not faces.any():
        return np.empty((0, 2, 2))
    boxes = np.stack(mesh.face_bounds(uv), axis=1)[faces]
    return boxes[np.isfinite(boxes).all(axis=(1, 2))]


def place_beside(packed: np.ndarray, staying: Sequence[np.ndarray]) -> tuple[float, np.ndarray]:
    """Return the scale and the offset (2,) that move the packed tile, 0 to 1, off the faces that stay.

    It goes into the largest free square of the tile if that is large enough, otherwise into the next free tile to the
    right. Scale 1 and no offset if nothing overlaps.

    Args:
        packed: (N, 2, 2), bounding boxes of the packed faces, as `face_boxes` returns them.
        staying: such arrays of the faces that stay; faces of a map that Blender has filled are no obstacles.
    """
    obstacles = np.concatenate([np.empty((0, 2, 2)), *staying])
    obstacles = obstacles[((obstacles[:, 1] - obstacles[:, 0]) < _WHOLE_TILE).any(axis=1)]
    taken = _occupied(obstacles)
    if not (taken & _occupied(packed)).any():
        return 1.0, np.zeros(2)
    row, column, cells = _largest_free_square(taken)
    if cells >= _MIN_SIDE * _CELLS:
        return cells / _CELLS, np.array([column, row]) / _CELLS
    column = 1
    while _occupied(obstacles - (column, 0.0)).any():
        column += 1
    return 1.0, np.array([float(column), 0.0])


def _occupied(boxes: np.ndarray) -> np.ndarray:
    """Return which cells of the tile the boxes touch, (rows, columns) bool."""
    inside = boxes[(boxes[:, 1] > 0.0).all(axis=1) & (boxes[:, 0] < 1.0).all(axis=1)]
    # Boxes that end on the border between two cells touch the first only.
    low = np.floor(np.clip(inside[:, 0], 0.0, 1.0) * _CELLS).astype(int).clip(max=_CELLS - 1)
    high = np.maximum(np.ceil(np.clip(inside[:, 1], 0.0, 1.0) * _CELLS).astype(int), low + 1)
    # Each box adds 1 from its first cell on and takes it back after its last, along both axes.
    change = np.zeros((_CELLS + 1, _CELLS + 1), dtype=int)
    for columns, rows, sign in ((low, low, 1), (high, low, -1), (low, high, -1), (high, high, 1)):
        np.add.at(change, (rows[:, 1], columns[:, 0]), sign)
    return change.cumsum(axis=0).cumsum(axis=1)[:-1, :-1] > 0


def _largest_free_square(taken: np.ndarray) -> tuple[int, int, int]:
    """Return the lowest row and column of the largest square of cells that are not `taken`, and its side."""
    # side[r, c] is that of the largest free square whose last row and column are r - 1 and c - 1.
    side = np.zeros((_CELLS + 1, _CELLS + 1), dtype=int)
    for r in range(_CELLS):
        for c in range(_CELLS):
            if not taken[r, c]:
                side[r + 1, c + 1] = 1 + min(side[r, c], side[r, c + 1], side[r + 1, c])
    r, c = np.unravel_index(np.argmax(side), side.shape)
    return int(r - side[r, c]), int(c - side[r, c]), int(side[r, c])
