"""What drawing the textures of an asset takes, known before anything is drawn; and smaller ones if that is too much."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ._arguments import heed

# Seconds of one thread: to draw a texel, and to code a byte of it in a file and to read that again. Any other file
# takes less than a PNG. By the 4096 x 4096 texels of tests/module/test_many_textures.py, rounded up.
_SECONDS_PER_TEXEL = 4e-8
_SECONDS_PER_BYTE = {".png": 6e-8, ".jpg": 4e-9}
# Bytes per byte of the largest texture: its pixels, those read again, its file and what covers it; and per byte of all
# textures, whose files wait until all are drawn.
_OF_LARGEST, _OF_ALL = 4.0, 0.5
# Of an asset's time and memory.
_SHARE = 0.5


@dataclass(frozen=True)
class NewTexture:
    """A texture that is to be drawn.

    Attributes:
        name: of the old one.
        size: width and height.
        texel_bytes: of a texel.
        suffix: of its file.
        old_texels: that are looked up.
        loss: how many times fewer texels per length it has than wanted (`TextureSize.of`).
        is_reduced: whether it is smaller than it would be without limits.
    """

    name: str
    size: tuple[int, int]
    texel_bytes: int
    suffix: str = ".png"
    old_texels: float = 0.0
    loss: float = 1.0
    is_reduced: bool = False

    @property
    def texels(self) -> int:
        """Their number."""
        return self.size[0] * self.size[1]

    @property
    def n_bytes(self) -> int:
        """Of its pixels."""
        return self.texels * self.texel_bytes

    @property
    def seconds(self) -> float:
        """Of one thread, to draw and to write it."""
        per_byte = _SECONDS_PER_BYTE.get(self.suffix, _SECONDS_PER_BYTE[".png"])
        return _SECONDS_PER_TEXEL * max(self.texels, self.old_texels) + per_byte * self.n_bytes

    def halved(self) -> NewTexture:
        """Return it with half of its width and height."""
        width, height = ((side + 1) // 2 for side in self.size)
        return replace(self, size=(width, height), loss=2.0 * self.loss, is_reduced=True)


@dataclass(frozen=True)
class DrawingPlan:
    """The textures of an asset that are to be drawn, within `limits`.

    Attributes:
        textures: these.
        asked_texels: that all of them would have without limits.
    """

    textures: Sequence[NewTexture]
    asked_texels: int

    @property
    def texels(self) -> int:
        """The number of all."""
        return sum(each.texels for each in self.textures)

    @property
    def seconds(self) -> float:
        """Of one thread, for all."""
        return sum(each.seconds for each in self.textures)

    @property
    def memory(self) -> float:
        """Bytes, at most, beside the asset's."""
        sizes = [each.n_bytes for each in self.textures]
        return _OF_LARGEST * max(sizes, default=0) + _OF_ALL * sum(sizes)

    @property
    def warning(self) -> str:
        """That some are smaller than asked for; empty if none is."""
        reduced = [each for each in self.textures if each.is_reduced]
        if not reduced:
            return ""
        asked, left = (f"{number / 1e6:,.1f} million texels" for number in (self.asked_texels, self.texels))
        loss = f"up to {max(each.loss for each in reduced):.2g} times fewer per length than before"
        what = f"{len(self.textures)} textures" if len(self.textures) > 1 else f"The texture {reduced[0].name}"
        return (
            f"{what} would have {asked}, more than there is time or memory for, but got {left}, {loss}. Raise "
            "--seconds and --memory, or draw fewer or smaller ones: --atlas makes one of each kind, and with --pack-by "
            "material each material has a map of its own."
        )


@dataclass(frozen=True)
class DrawingLimits:
    """What drawing the textures of an asset may take.

    Attributes:
        seconds: of one thread.
        memory: bytes.
        tell: takes the plan before anything is drawn; if it returns False, nothing is, and `Cancelled` is raised.
    """

    seconds: float = math.inf
    memory: float = math.inf
    tell: Callable[[DrawingPlan], bool | None] | None = None

    @classmethod
    def share_of(
        cls, seconds: float | None, memory: float | None, tell: Callable[[DrawingPlan], bool | None] | None = None
    ) -> DrawingLimits:
        """Return the textures' share of an asset's limits, of which None is none."""
        return cls(_SHARE * (seconds or math.inf), _SHARE * (memory or math.inf), tell)

    def planned(self, textures: Sequence[NewTexture]) -> DrawingPlan:
        """Return a plan within the limits, once told: while it exceeds one, the largest texture is halved.

        Raises:
            Cancelled: `tell` returned False.
        """
        plan = DrawingPlan(textures, sum(each.texels for each in textures))
        while plan.seconds > self.seconds or plan.memory > self.memory:
            sizes = [each.n_bytes for each in plan.textures]
            largest = sizes.index(max(sizes))
            if plan.textures[largest].texels <= 1:
                break
            halved = [each.halved() if k == largest else each for k, each in enumerate(plan.textures)]
            plan = replace(plan, textures=halved)
        if textures and self.tell:
            heed(self.tell(plan))
        return plan
