"""The textures of several assets on one map: one image for each role, such as the base color or the normals.

First every asset adds what it has for each role, then the images are drawn, then every asset is written.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

from .._drawing_plan import NewTexture
from .._map_change import MapChange, joined
from .._rebaking import Content, Target, Wrap
from .._texture_size import DrawnTexture, TextureSize, said_of_loss
from .._vertex_colors import VertexColors
from . import images

# Those that several formats have.
BASE_COLOR, NORMAL, EMISSIVE, OCCLUSION = "base color", "normal", "emissive", "occlusion"
ROUGHNESS, METALLIC, METALLIC_ROUGHNESS = "roughness", "metallic", "metallic roughness"
# Of a piece's texels: islands whose margin is narrower than a texel share more than none at their borders.
_VISIBLY_COVERED = 0.02


class Piece(Protocol):
    """What an asset has in one of the images."""

    n_channels: int
    """That it needs: 3, or 4 with opacity."""
    dtype: np.dtype
    """Of bytes or 16-bit numbers."""
    suffix: str
    """Of the file that keeps it."""

    def wanted(self, size: TextureSize) -> tuple[int, int]:
        """Return the width and height that it needs."""
        ...

    def draw(self, target: Target) -> tuple[npt.NDArray[np.bool_], float]:
        """Draw it onto an image; return which texels it covers, (height, width), and its loss (`TextureSize.of`)."""
        ...


class Picture:
    """An image of an asset, to be drawn for the new map."""

    def __init__(
        self,
        read: Callable[[], np.ndarray],
        changes: Sequence[MapChange],
        content: Content,
        opacity: bool = False,
        nearest: bool = False,
        wrap: tuple[Wrap, Wrap] = ("repeat", "repeat"),
        suffix: str = ".png",
    ) -> None:
        """Take how materials read the image.

        Args:
            read: returns its pixels, (height, width, channels), of bytes or 16-bit numbers.
            changes: the triangles that show it, with both maps.
            content: as in `rebake`, like the next three.
            opacity: see there.
            nearest: see there.
            wrap: see there.
            suffix: of its file.
        """
        pixels = read()
        self.n_channels = 3 if pixels.shape[2] % 2 else 4
        self.dtype, self.suffix = pixels.dtype, suffix
        self._height, self._width = pixels.shape[:2]
        # The pixels of all assets may need too much memory at a time.
        self._read = read
        self._changes = joined(changes, content)
        self._how = content, opacity, nearest, wrap

    def wanted(self, size: TextureSize) -> tuple[int, int]:
        """Return the width and height that it needs."""
        if self._changes is None:
            return size.layout
        return size.of((self._width, self._height), *self._changes.areas())[0]

    def draw(self, target: Target) -> tuple[npt.NDArray[np.bool_], float]:
        """Draw it onto an image."""
        if self._changes is None:
            return np.zeros(target.coverage.shape, bool), 1.0
        pixels = _with_channels(self._read(), target.image.shape[2])
        covered = self._changes.drawn_onto(target, pixels, *self._how)
        given = TextureSize("size", target.coverage.shape[::-1])
        return covered, given.of((self._width, self._height), *self._changes.areas())[1]


class Colors:
    """Colors of vertices, or one color of all as a fill."""

    dtype, suffix = np.dtype(np.uint8), ".png"

    def __init__(self, colors: VertexColors, opacity: bool = False, is_fill: bool = False) -> None:
        """Take the colors, with their opacity; a fill needs no size."""
        self.n_channels = 4 if opacity else 3
        self._colors, self._is_fill = colors, is_fill
        self._opacity = opacity

    def wanted(self, size: TextureSize) -> tuple[int, int]:
        """Return the width and height that they need."""
        return size.layout if self._is_fill else self._colors.wanted(size)

    def draw(self, target: Target) -> tuple[npt.NDArray[np.bool_], float]:
        """Draw them onto an image."""
        return self._colors.drawn_onto(target, self._opacity), 1.0


@dataclass(frozen=True)
class SharedTexture:
    """A drawn image.

    Attributes:
        path: of its file.
        content: of its file.
        record: for reports.
    """

    path: Path
    content: bytes
    record: DrawnTexture

    def name_from(self, folder: Path) -> str:
        """Return its path relative to a folder, with slashes."""
        return Path(os.path.relpath(self.path.resolve(), folder.resolve())).as_posix()


@dataclass
class _Role:
    pieces: list[tuple[Piece, str, Callable[[str], None]]] = field(default_factory=list)
    """Each with its name and what takes warnings about it."""
    fills: list[Piece] = field(default_factory=list)

    def format(self) -> tuple[int, int]:
        """Return the number of channels of its image, and the bytes of each."""
        pieces = [piece for piece, _, _ in self.pieces]
        return max(piece.n_channels for piece in pieces), max(piece.dtype.itemsize for piece in pieces)


class SharedTextures:
    """The images that assets share."""

    def __init__(self, folder: Path, name: str, size: TextureSize) -> None:
        """Begin without any.

        Args:
            folder: for their files.
            name: that these begin with.
            size: of the images.
        """
        self.is_drawn = False
        self._folder, self._name, self._size = folder, name, size
        self._roles: dict[str, _Role] = {}
        self._drawn: dict[str, SharedTexture] = {}

    def add(self, role: str, piece: Piece, name: str, warn: Callable[[str], None]) -> None:
        """Add what an asset has for a role; `name` is that of its texture in the warnings that `warn` takes."""
        self._roles.setdefault(role, _Role()).pieces.append((piece, name, warn))

    def add_fill(
        self,
        role: str,
        value: Sequence[float],
        content: Content,
        uv: npt.NDArray[np.floating],
        triangles: npt.NDArray[np.integer],
    ) -> None:
        """Add triangles (T, 3) of a map (n, 2) that have one value, (3,), should others have a texture for this role.

        The value of a "color" is light; others are stored as they are.
        """
        colors = VertexColors("color" if content == "color" else "data")
        colors.add(np.broadcast_to(np.array(value, np.float64), (len(uv), 3)), uv, triangles)
        self._roles.setdefault(role, _Role()).fills.append(Colors(colors, is_fill=True))

    def draw(self) -> None:
        """Draw the image of each role for which any asset has a texture; now they can be found."""
        roles = {name: role for name, role in self._roles.items() if role.pieces}
        plan = self._size.limits.planned([self._new(name, role) for name, role in roles.items()])
        for (name, role), texture in zip(roles.items(), plan.textures):
            if texture.is_reduced:
                role.pieces[0][2](plan.warning)
            self._drawn[name] = self._drawn_role(role, texture)
        self._roles = {}
        self.is_drawn = True

    def _new(self, name: str, role: _Role) -> NewTexture:
        """Return the image that a role needs."""
        pieces = [piece for piece, _, _ in role.pieces]
        width, height = np.array([piece.wanted(self._size) for piece in pieces]).max(axis=0).tolist()
        n_channels, itemsize = role.format()
        has_jpeg_only = all(piece.suffix == ".jpg" for piece in pieces) and n_channels * itemsize == 3
        return NewTexture(name, (width, height), n_channels * itemsize, ".jpg" if has_jpeg_only else ".png")

    def _drawn_role(self, role: _Role, texture: NewTexture) -> SharedTexture:
        width, height = texture.size
        n_channels, itemsize = role.format()
        target = Target((height, width, n_channels), f"u{itemsize}")
        covered = np.zeros((height, width), bool)
        for fill in role.fills:
            covered |= fill.draw(target)[0]
        for piece, title, warn in role.pieces:
            own, loss = piece.draw(target)
            if (own & covered).sum() > _VISIBLY_COVERED * own.sum():
                warn(f"Islands with the texture {title} lie on others of the atlas, which show the same.")
            if warning := said_of_loss(title, loss):
                warn(warning)
            covered |= own
        baked = target.baked(covered)
        path = self._folder / f"{self._name}_{re.sub(r'[^A-Za-z0-9]+', '_', texture.name)}{texture.suffix}"
        record = DrawnTexture.of(path.name, baked)
        return SharedTexture(path, images.written(baked.image, texture.suffix), record)

    def find(self, role: str) -> SharedTexture | None:
        """Return the image of a role, once drawn; None if no asset has a texture for it."""
        return self._drawn.get(role)

    def all(self) -> Sequence[SharedTexture]:
        """Return the images, once drawn."""
        return list(self._drawn.values())


def _with_channels(pixels: np.ndarray, number: int) -> np.ndarray:
    """Return pixels, (height, width, up to 4), with 3 channels, or 4 with opacity; one without is opaque."""
    n_colors = pixels.shape[2] - 1 + pixels.shape[2] % 2
    sides = pixels.shape[:2]
    colors = np.broadcast_to(pixels[:, :, :n_colors], (*sides, 3))
    if number == 3:
        return colors
    opaque = np.full((*sides, 1), np.iinfo(pixels.dtype).max, pixels.dtype)
    return np.concatenate([colors, pixels[:, :, n_colors:] if n_colors < pixels.shape[2] else opaque], axis=2)
