"""Which size textures get when they are drawn anew for another map."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from ._drawing_plan import DrawingLimits, NewTexture
from ._rebaking import BakedTexture

_Key = TypeVar("_Key")

FITTING, SAME = "auto", "same"
# Of one side. Beyond this, programs refuse textures.
_LARGEST = 8192
# As much of a texture's area may be lost without a doubling of its size: its length then shrinks by 5 %.
_LOSS = 0.1
# Of texels per length: without this, a warning would follow from the room between islands alone.
_VISIBLE_LOSS = 1.2


@dataclass(frozen=True)
class TextureSize:
    """The size of textures that are drawn anew.

    Attributes:
        rule: auto: that of the layout, doubled until a texture has as many texels on the surface as wanted (`of`);
            same: the texture's own; size: that of the layout.
        layout: width and height of the texture that islands were laid out for.
        colors: whether vertex colors become a texture, too, where a material has none for them.
        limits: of all textures of an asset together.
    """

    rule: str
    layout: tuple[int, int]
    colors: bool = False
    limits: DrawingLimits = field(default=DrawingLimits(), compare=False)

    def of(
        self, old: tuple[int, int], old_area: float, new_area: float, n_points: int = 0
    ) -> tuple[tuple[int, int], float]:
        """Return width and height of a new texture, and how many times fewer texels per length it has than wanted.

        As many as the old one has are wanted, and one for each triangle that showed a point of it, as of a palette.

        Args:
            old: width and height of the old one.
            old_area: of all triangles in the old map.
            new_area: likewise in the new one.
            n_points: number of triangles without area in the old map.
        """
        wanted = (1.0 - _LOSS) * (old_area * old[0] * old[1] + n_points)
        width, height = old if self.rule == SAME else self._doubled(wanted, new_area)
        found = width * height * new_area
        return (width, height), (wanted / found) ** 0.5 if found else 1.0

    def of_samples(self, number: int, new_area: float) -> tuple[int, int]:
        """Return width and height of a texture of so many colors of vertices, which cover an area of the new map."""
        # Two texels for each in either direction keep what varies from one to the next.
        return self._doubled(4.0 * number, new_area)

    def _doubled(self, wanted: float, area: float) -> tuple[int, int]:
        """Return the size of the layout, by the rule auto doubled until an area has as many texels as wanted."""
        width, height = self.layout
        if self.rule == FITTING:
            while width * height * area < wanted and 2 * max(width, height) <= _LARGEST:
                width, height = 2 * width, 2 * height
        return width, height


@dataclass(frozen=True)
class DrawnTexture:
    """A texture that was drawn anew."""

    name: str
    width: int
    height: int
    covered: float
    """Of its texels, the fraction that islands cover."""

    @classmethod
    def of(cls, name: str, baked: BakedTexture) -> DrawnTexture:
        """Return the record of a drawn texture."""
        height, width = baked.covered.shape
        return cls(name, width, height, float(baked.covered.mean()))


def said_of_kept(name: str, reason: str) -> str:
    """Return the warning about a texture that stays as it was."""
    return f"The texture {name} was not drawn anew and does not fit the new map: {reason}."


def said_of_left(what: str) -> str:
    """Return the warning about what shows new textures with its old map."""
    return f"{what} kept the old map, which the new textures do not fit: give it a material of its own."


def is_visible(loss: float) -> bool:
    """Return whether a texture has visibly fewer texels per length, `loss` times, than before."""
    return loss > _VISIBLE_LOSS


def said_of_loss(name: str, loss: float) -> str:
    """Return the warning about a texture with a `loss`, as `TextureSize.of` returns it; empty if it is not visible."""
    if not is_visible(loss):
        return ""
    return f"The texture {name} has {loss:.2g} times fewer texels per length than before: --rebake takes another size."


def planned(
    size: TextureSize, wanted: Mapping[_Key, NewTexture | None], warn: Callable[[str], None]
) -> dict[_Key, NewTexture]:
    """Return the textures of an asset to be drawn, by any keys, within its limits; without those that are None.

    Warns if some are smaller than asked for; others may get coarser anyway.
    """
    found = {key: texture for key, texture in wanted.items() if texture}
    plan = size.limits.planned(list(found.values()))
    losses = (said_of_loss(each.name, each.loss) for each in plan.textures if not each.is_reduced)
    for warning in filter(None, (plan.warning, *losses)):
        warn(warning)
    return dict(zip(found, plan.textures))


def map_area(uv: npt.NDArray[np.float64], triangles: npt.NDArray[np.integer]) -> float:
    """Return the sum of the areas of triangles (T, 3) in a map (C, 2)."""
    return float(map_areas(uv, triangles).sum())


def map_areas(uv: npt.NDArray[np.float64], triangles: npt.NDArray[np.integer]) -> npt.NDArray[np.float64]:
    """Return the areas, (T,), of triangles (T, 3) in a map (C, 2)."""
    first, second = (uv[triangles[:, k]] - uv[triangles[:, 0]] for k in (1, 2))
    return 0.5 * np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
