"""A surface with its old and its new UV map, and textures drawn from the one for the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from .._rebaking import BakedTexture, Content, Wrap, rebake
from .._tangents import tangents
from .textures import TextureSize, map_area

_Floats = npt.NDArray[np.floating]


@dataclass(frozen=True)
class MapChange:
    """Triangles with two maps. Rows are vertices, split where a map or a normal is not continuous."""

    old: _Floats
    """(rows, 2), v upward."""
    new: _Floats
    """(rows, 2), v upward."""
    triangles: npt.NDArray[np.integer]
    """(T, 3) rows."""
    positions: _Floats
    """(rows, 3)"""
    normals: _Floats | None = None
    """(rows, 3) unit vectors; None for those of the triangles."""
    tangents: tuple[_Floats | None, _Floats | None] = (None, None)
    """(rows, 4) of both maps, if normals are given; None for those that follow from the map."""

    def of_rows(self, rows: npt.NDArray[np.integer], triangles: npt.NDArray[np.integer]) -> MapChange:
        """Return it with these rows, (n,), and triangles, (T, 3), that are numbers in `rows`."""
        old, new, positions = self.old[rows], self.new[rows], self.positions[rows]
        normals = None if self.normals is None else self.normals[rows]
        first, second = (None if each is None else each[rows] for each in self.tangents)
        return MapChange(old, new, triangles, positions, normals, (first, second))

    def part(self, triangles: npt.NDArray[np.integer]) -> MapChange:
        """Return only these triangles, (n, 3), and their rows."""
        used, rows = np.unique(triangles, return_inverse=True)
        return self.of_rows(used, rows.reshape(-1, 3))

    def with_frames(self) -> MapChange:
        """Return it with normals and both tangents, and a row for each side of the old map at a vertex."""
        result = self
        if self.normals is None:
            flat = self.of_rows(self.triangles.ravel(), np.arange(self.triangles.size).reshape(-1, 3))
            result = replace(flat, normals=_normals_of_triangles(flat.positions), tangents=(None, None))
        elif self.tangents[0] is None:
            corners = self.old[self.triangles]
            one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
            is_mirrored = one[:, 0] * two[:, 1] < one[:, 1] * two[:, 0]
            keys = 2 * self.triangles + is_mirrored[:, None]
            used, rows = np.unique(keys, return_inverse=True)
            result = self.of_rows(used // 2, rows.reshape(-1, 3))
        found = [
            tangents(result.positions, result.triangles, uv, result.normals) if given is None else given
            for uv, given in ((result.old, result.tangents[0]), (result.new, result.tangents[1]))
        ]
        return replace(result, tangents=(found[0], found[1]))


def drawn(
    image: np.ndarray,
    changes: Sequence[MapChange],
    size: TextureSize,
    content: Content,
    opacity: bool = False,
    nearest: bool = False,
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat"),
) -> tuple[BakedTexture | None, str]:
    """Return an image drawn for the new map, None if there are no triangles; and a warning if it loses detail.

    The arguments are those of `rebake`, which computes the frames for normals from `changes`.
    """
    changes = [each.with_frames() if content == "normals" else each for each in changes if len(each.triangles)]
    if not changes:
        return None, ""
    firsts = np.cumsum([0, *(len(each.old) for each in changes)])
    triangles = np.concatenate([first + each.triangles for first, each in zip(firsts, changes)])
    old, new = (np.concatenate(each) for each in zip(*((each.old, each.new) for each in changes)))
    height, width = image.shape[:2]
    chosen, loss = size.of((width, height), map_area(old, triangles), map_area(new, triangles))
    frames = {}
    if content == "normals":
        columns = zip(*((each.normals, *each.tangents) for each in changes))
        frames = dict(zip(("normals", "old_tangents", "new_tangents"), map(np.concatenate, columns)))
    how = {"size": chosen, "content": content, "opacity": opacity, "nearest": nearest, "wrap": wrap}
    return rebake(image, old, new, triangles, **how, **frames), loss


def _normals_of_triangles(corners: _Floats) -> npt.NDArray[np.float64]:
    """Return the normal at each of three corners per triangle, (3 T, 3); zero without area."""
    first, second, third = (corners[k::3] for k in range(3))
    normals = np.cross(second - first, third - first)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.repeat(np.divide(normals, length, out=np.zeros_like(normals), where=length > 0), 3, axis=0)
