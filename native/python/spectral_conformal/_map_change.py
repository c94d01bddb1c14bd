"""A surface with its old and its new UV map, and textures drawn from the one for the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
import numpy.typing as npt

from ._arguments import Progress
from ._distinct_rows import in_order_of_use
from ._drawing_plan import NewTexture
from ._rebaking import BakedTexture, Content, Target, Wrap, draw_onto, pixels_of
from ._tangents import tangents
from ._texture_levels import copies, levels
from ._texture_size import TextureSize, map_area, map_areas

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
        """Return it with normals and both tangents, and a row for each side of a map at a vertex."""
        result, given = self, self.tangents
        if self.normals is None:
            flat = self.of_rows(self.triangles.ravel(), np.arange(self.triangles.size).reshape(-1, 3))
            result, given = replace(flat, normals=_normals_of_triangles(flat.positions)), (None, None)
        elif given[0] is None:
            sides = 2 * _is_mirrored(self.old, self.triangles) + _is_mirrored(self.new, self.triangles)
            used, rows = np.unique(4 * self.triangles + sides[:, None], return_inverse=True)
            result = self.of_rows(used // 4, rows.reshape(-1, 3))
        both = [result._tangents(uv) if known is None else known for uv, known in zip((result.old, result.new), given)]
        return replace(result, tangents=(both[0], both[1]))

    def frames(self) -> tuple[_Floats, _Floats, _Floats]:
        """Return the normals and the tangents of both maps, which it has `with_frames`."""
        return cast("tuple[_Floats, _Floats, _Floats]", (self.normals, *self.tangents))

    def _tangents(self, uv: _Floats) -> npt.NDArray[np.float64]:
        """Return tangents, (rows, 4), shared by triangles of one side that meet with equal normals and UVs."""
        normals = cast(_Floats, self.normals)
        side = np.zeros(len(uv))
        side[self.triangles] = _is_mirrored(uv, self.triangles)[:, None]
        first, number = in_order_of_use(np.c_[self.positions, normals, uv, side])
        found = tangents(self.positions[first], number[self.triangles], uv[first], normals[first])
        return found[number]


@dataclass(frozen=True)
class JoinedChanges:
    """The triangles of several changes; rows as in `MapChange`, with normals and both tangents for normal maps."""

    old: _Floats
    new: _Floats
    triangles: npt.NDArray[np.integer]
    frames: Sequence[_Floats | None]

    def areas(self) -> tuple[float, float, int]:
        """Return the areas of all triangles in the old and the new map, and how many have none in the old one."""
        old = map_areas(self.old, self.triangles)
        return float(old.sum()), map_area(self.new, self.triangles), int((old == 0.0).sum())

    def drawn_onto(
        self,
        target: Target,
        image: np.ndarray,
        content: Content,
        opacity: bool = False,
        nearest: bool = False,
        wrap: tuple[Wrap, Wrap] = ("repeat", "repeat"),
        progress: Progress | None = None,
    ) -> npt.NDArray[np.bool_]:
        """Draw an image for the new map onto another one, as `draw_onto` does.

        Triangles that repeat it too often show a smaller copy (`_texture_levels`).
        """
        (height, width), (new_height, new_width) = image.shape[:2], target.coverage.shape
        sides = (width, height), (new_width, new_height)
        level_of = levels(self.old, self.new, self.triangles, *sides)
        images = copies(np.ascontiguousarray(image), int(level_of.max(initial=0)), content, opacity, wrap)
        covered = np.zeros(target.coverage.shape, bool)
        # The finest ones last, for texels at common borders.
        drawn = [level for level in reversed(range(len(images))) if (level_of == level).any()]
        for number, level in enumerate(drawn):
            triangles = self.triangles[level_of == level]
            how = content, opacity, nearest, wrap, self.frames, _share(progress, number, len(drawn))
            covered |= draw_onto(target, images[level], self.old, self.new, triangles, *how)
        return covered


def joined(changes: Sequence[MapChange], content: Content) -> JoinedChanges | None:
    """Return the triangles of all changes, for a texture of this content; None if there are none."""
    changes = [each.with_frames() if content == "normals" else each for each in changes if len(each.triangles)]
    if not changes:
        return None
    firsts = np.cumsum([0, *(len(each.old) for each in changes)])
    triangles = np.concatenate([first + each.triangles for first, each in zip(firsts, changes)])
    old, new = (np.concatenate(each) for each in zip(*((each.old, each.new) for each in changes)))
    frames: list[_Floats | None] = [None, None, None]
    if content == "normals":
        frames = [np.concatenate(column) for column in zip(*(each.frames() for each in changes))]
    return JoinedChanges(old, new, triangles, frames)


def new_texture(
    name: str,
    image: tuple[int, int, int],
    dtype: np.dtype,
    changes: Sequence[MapChange],
    size: TextureSize,
    suffix: str = ".png",
) -> NewTexture | None:
    """Return what `drawn` would draw, None if there are no triangles.

    Args:
        name: of the old image.
        image: its height, width and number of channels.
        dtype: of its pixels.
        changes: as for `drawn`.
        size: likewise.
        suffix: of the new file.
    """
    # Areas need no frames, whatever the content.
    found = joined(changes, "data")
    if found is None:
        return None
    height, width, n_channels = image
    areas = found.areas()
    chosen, loss = size.of((width, height), *areas)
    return NewTexture(name, chosen, n_channels * dtype.itemsize, suffix, areas[0] * width * height, loss)


def drawn(
    image: np.ndarray,
    changes: Sequence[MapChange],
    size: TextureSize,
    content: Content,
    opacity: bool = False,
    nearest: bool = False,
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat"),
    progress: Progress | None = None,
    is_signed: bool = False,
) -> tuple[BakedTexture | None, float]:
    """Return an image drawn for the new map, None if there are no triangles; and its loss, as `TextureSize.of` does.

    The arguments are those of `rebake`, which computes the frames for normals from `changes`. With `is_signed`, the
    image has normals from -1 to 1 instead of their codes from 0 to 1, and so has the result.
    """
    found = joined(changes, content)
    if found is None:
        return None, 1.0
    pixels = pixels_of(image)
    if is_signed:
        pixels = 0.5 * (pixels + 1.0)
    height, width = pixels.shape[:2]
    chosen, loss = size.of((width, height), *found.areas())
    target = Target((*chosen[::-1], pixels.shape[2]), pixels.dtype)
    baked = target.baked(found.drawn_onto(target, pixels, content, opacity, nearest, wrap, progress))
    return replace(baked, image=2.0 * baked.image - 1.0) if is_signed else baked, loss


def _share(progress: Progress | None, number: int, count: int) -> Progress | None:
    """Return what hears the progress of one of several equal parts."""
    return progress and (lambda fraction, phase: progress((number + fraction) / count, phase))


def _is_mirrored(uv: _Floats, triangles: npt.NDArray[np.integer]) -> npt.NDArray[np.bool_]:
    """Return which triangles, (T, 3), are clockwise in a map."""
    one, two = (uv[triangles[:, k]] - uv[triangles[:, 0]] for k in (1, 2))
    return one[:, 0] * two[:, 1] < one[:, 1] * two[:, 0]


def _normals_of_triangles(corners: _Floats) -> npt.NDArray[np.float64]:
    """Return the normal at each of three corners per triangle, (3 T, 3); zero without area."""
    first, second, third = (corners[k::3] for k in range(3))
    normals = np.cross(second - first, third - first)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.repeat(np.divide(normals, length, out=np.zeros_like(normals), where=length > 0), 3, axis=0)
