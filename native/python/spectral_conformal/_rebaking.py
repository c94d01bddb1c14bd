"""Draw textures anew for another map, and values at vertices to a texture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, cast, get_args

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Progress

Content = Literal["data", "color", "normals"]
"""What a texture means, which decides how its texels are averaged. "data": numbers, such as roughness, as they are.
"color": as light; the first three channels (or the first of two) of integers are coded by sRGB, floats are light.
"normals": tangent-space normals in the first three channels, 2 c - 1, which turn into the tangent frame of the new
map."""
Wrap = Literal["repeat", "mirror", "clamp", "black"]
"""How a texture continues outside [0, 1]; "black" is also transparent."""

_PIXELS = {"u1": np.uint8, "u2": np.uint16, "f2": np.float32, "f4": np.float32, "f8": np.float32}


@dataclass(frozen=True, eq=False)
class BakedTexture:
    """A texture drawn for a map."""

    image: np.ndarray
    """(height, width, channels), rows from the top; (height, width) if the source had no axis for channels."""
    covered: npt.NDArray[np.bool_]
    """(height, width) whether a triangle has samples in the texel; others continue the nearest border."""


def rebake(
    image: npt.ArrayLike,
    old_uv: npt.ArrayLike,
    new_uv: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    size: int | tuple[int, int] | None = None,
    content: Content = "data",
    opacity: bool = False,
    nearest: bool = False,
    wrap: Wrap | tuple[Wrap, Wrap] = "repeat",
    normals: npt.ArrayLike | None = None,
    old_tangents: npt.ArrayLike | None = None,
    new_tangents: npt.ArrayLike | None = None,
    progress: Progress | None = None,
) -> BakedTexture:
    """Draw a texture anew for another UV map, so that the surface looks the same.

        baked = sc.rebake(image, old_uv, new_uv, triangles, content="color")
        baked.image

    Each texel gets what the old texture has at the same points of the surface: the mean of up to 32 by 32 samples, at
    most a texel of the old texture apart, each interpolated between four texels. Where the new texture is at least as
    dense, that blurs by at most half a texel. Islands of the old map may overlap or reach beyond the tile. Where those
    of the new map overlap, texels get the mean.

    Args:
        image: (height, width, channels) or (height, width), rows from the top, with up to four channels of bytes,
            16-bit numbers or floats; integers stand for 0 to 1, also in floats that code normals.
        old_uv: (C, 2) the map that the image belongs to. (0, 0) is the lower left corner of the image, (1, 1) the upper
            right one.
        new_uv: (C, 2) the map to draw for; what lies outside [0, 1] is not drawn.
        triangles: (T, 3) rows of both maps, such as vertices split at the seams of both. Those with a UV that is not
            finite are not drawn.
        size: of the result, of one side or width and height; by default that of the image.
        content: what the image means.
        opacity: whether the second or fourth channel is the opacity, in proportion to which other channels count.
        nearest: look up the nearest texel instead of interpolating, as for pixel art.
        wrap: how the image continues outside [0, 1], or (along u, along v).
        normals: (C, 3) of the surface, for content "normals" of three or four channels.
        old_tangents: (C, 4) likewise, of the old map; see `tangents`.
        new_tangents: (C, 4) likewise, of the new map.
        progress: as in `parameterize`.

    Raises:
        TypeError: the image holds other numbers.
        ValueError: an argument is not as described here.
        Cancelled: by `progress`.
    """
    pixels = pixels_of(image)
    height, width, n_channels = pixels.shape
    new_width, new_height = (width, height) if size is None else _size(size)
    frames = normals, old_tangents, new_tangents
    how = content, opacity, nearest, wrap, frames, progress
    target = Target((new_height, new_width, n_channels), pixels.dtype)
    baked = target.baked(draw_onto(target, pixels, old_uv, new_uv, triangles, *how))
    return baked if np.ndim(image) == 3 else replace(baked, image=baked.image[:, :, 0])


class Target:
    """An image that is drawn piece by piece.

    Attributes:
        image: (height, width, channels), contiguous, of uint8, uint16 or float32.
        coverage: (height, width) 255 for texels with samples; for those without, beside an island, at least 1, the more
            the nearer its border is; 0 for others.
    """

    def __init__(self, shape: tuple[int, ...], dtype: npt.DTypeLike) -> None:
        """Begin with zeros, (height, width, channels)."""
        self.image = np.zeros(shape, dtype)
        self.coverage = np.zeros(shape[:2], np.uint8)

    def baked(self, covered: npt.NDArray[np.bool_]) -> BakedTexture:
        """Return it once all is drawn; texels that no island has get the value of the nearest one that has some."""
        fill_margin(self.image, self.coverage)
        return BakedTexture(self.image, covered)


def draw_onto(
    target: Target,
    image: np.ndarray,
    old_uv: npt.ArrayLike,
    new_uv: npt.ArrayLike,
    triangles: npt.ArrayLike,
    content: Content = "data",
    opacity: bool = False,
    nearest: bool = False,
    wrap: Wrap | tuple[Wrap, Wrap] = "repeat",
    frames: Sequence[npt.ArrayLike | None] = (None, None, None),
    progress: Progress | None = None,
) -> npt.NDArray[np.bool_]:
    """Draw a texture as `rebake` does onto an image of as many channels; return which texels have samples.

    Texels beside islands show what the border does, unless they are nearer to that of an earlier piece; others stay.
    The source is as `Target.image`. `frames` are `normals`, `old_tangents` and `new_tangents`.
    """
    old = _arguments.checked_floats(old_uv, "old_uv", 2)
    corners, new = _drawn(new_uv, triangles, "new_uv")
    if len(old) != len(new):
        raise ValueError(f"old_uv has {len(old)} rows, but new_uv has {len(new)}.")
    _check_choice(content, Content, "content")
    both = (wrap, wrap) if isinstance(wrap, str) else tuple(wrap)
    if len(both) != 2:
        raise ValueError(f"wrap must be one of {', '.join(get_args(Wrap))}, or two of them, not {wrap!r}.")
    for each in both:
        _check_choice(each, Wrap, "wrap")
    arrays: list[npt.NDArray[np.float32] | None] = [None, None, None]
    if content == "normals" and image.shape[2] > 2:
        names = ("normals", "old_tangents", "new_tangents")
        arrays = [_frame(values, name, len(new)) for values, name in zip(frames, names)]
    return _native.rebake(
        image,
        old,
        new,
        corners,
        target.image,
        target.coverage,
        content,
        _arguments.checked_flag(opacity, "opacity"),
        _arguments.checked_flag(nearest, "nearest"),
        both,
        arrays[0],
        arrays[1],
        arrays[2],
        _arguments.checked_progress(progress),
    )


def bake_values(
    values: npt.ArrayLike,
    uv: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    size: int | tuple[int, int],
    content: Literal["data", "color"] = "data",
    opacity: bool = False,
    dtype: npt.DTypeLike = np.uint8,
    progress: Progress | None = None,
) -> BakedTexture:
    """Draw values at vertices or corners, such as vertex colors, to a texture; between them they are linear.

        baked = sc.bake_values(colors, uv, triangles, size=2048, content="color")

    Args:
        values: (C, channels) up to four numbers from 0 to 1 each; colors are linear light.
        uv: (C, 2) as `new_uv` in `rebake`.
        triangles: (T, 3) rows of `values` and `uv`.
        size: of the texture, of one side or width and height.
        content: what the values mean; integers code colors by sRGB.
        opacity: as in `rebake`.
        dtype: of the texture: uint8, uint16 or float32.
        progress: as in `parameterize`.

    Raises:
        ValueError: an argument is not as described here.
        Cancelled: by `progress`.
    """
    kind = np.dtype(dtype)
    if kind not in (np.uint8, np.uint16, np.float32):
        raise ValueError(f"dtype must be uint8, uint16 or float32, not {kind}.")
    width, height = _size(size)
    target = Target((height, width, _values(values).shape[1]), kind)
    return target.baked(draw_values_onto(target, values, uv, triangles, content, opacity, progress))


def draw_values_onto(
    target: Target,
    values: npt.ArrayLike,
    uv: npt.ArrayLike,
    triangles: npt.ArrayLike,
    content: Literal["data", "color"] = "data",
    opacity: bool = False,
    progress: Progress | None = None,
) -> npt.NDArray[np.bool_]:
    """Draw values as `bake_values` does onto an image of as many channels, as `draw_onto` does a texture."""
    numbers = _values(values)
    corners, points = _drawn(uv, triangles, "uv")
    if len(numbers) != len(points):
        raise ValueError(f"values has {len(numbers)} rows, but uv has {len(points)}.")
    if content not in ("data", "color"):
        raise ValueError(f"content must be data or color, not {content!r}.")
    has_opacity, listener = _arguments.checked_flag(opacity, "opacity"), _arguments.checked_progress(progress)
    singles = _arguments.converted(numbers, np.float32)
    into = target.image, target.coverage
    return _native.bake_corners(singles, points, corners, *into, content, has_opacity, listener)


def fill_margin(image: np.ndarray, coverage: npt.NDArray[np.uint8]) -> None:
    """Give texels of an image, (height, width, channels), without coverage the value of the nearest one with some."""
    _native.fill_margin(image, coverage)


def _values(values: npt.ArrayLike) -> npt.NDArray[np.floating]:
    numbers = _arguments.checked_reals(values, "values")
    if numbers.ndim != 2 or not 1 <= numbers.shape[1] <= _native.MAX_CHANNELS:
        raise ValueError(f"values must have the shape (n, channels), with up to 4 channels, not {numbers.shape}.")
    return numbers


def pixels_of(image: npt.ArrayLike) -> np.ndarray:
    """Return a copy of an image, (height, width, channels), in a type that the native module reads."""
    array = _arguments.checked_array(image, "image")
    kind = _PIXELS.get(array.dtype.str[1:])
    if kind is None:
        raise TypeError(f"image must hold bytes, 16-bit numbers or floats, not {array.dtype}.")
    if array.ndim == 2:
        array = array[:, :, None]
    sides = array.shape[:2]
    if array.ndim != 3 or not all(1 <= side <= _native.MAX_IMAGE_SIDE for side in sides):
        raise ValueError(
            "image must have the shape (height, width, channels) or (height, width), with sides from 1 to "
            f"{_native.MAX_IMAGE_SIDE}, not {array.shape}."
        )
    if not 1 <= array.shape[2] <= _native.MAX_CHANNELS:
        raise ValueError(f"image must have up to {_native.MAX_CHANNELS} channels, not {array.shape[2]}.")
    return _arguments.converted(array, kind)


def _drawn(
    uv: npt.ArrayLike, triangles: npt.ArrayLike, name: str
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.floating]]:
    points = _arguments.checked_floats(uv, name, 2)
    return _arguments.checked_indices(triangles, "triangles", 3, len(points)), points


def _frame(values: npt.ArrayLike | None, name: str, n_corners: int) -> npt.NDArray[np.float32]:
    if values is None:
        raise ValueError(f"content 'normals' needs normals, old_tangents and new_tangents, but {name} is missing.")
    array = _arguments.checked_floats(values, name, 3 if name == "normals" else 4, keep_single=True)
    if len(array) != n_corners:
        raise ValueError(f"{name} has {len(array)} rows, but new_uv has {n_corners}.")
    return array if array.dtype == np.float32 else _arguments.converted(array, np.float32)


def _size(size: int | tuple[int, int]) -> tuple[int, int]:
    """Return width and height."""
    sides = tuple(size) if isinstance(size, (tuple, list)) else (size, size)
    if len(sides) != 2:
        raise ValueError(f"size must be one side, or width and height, not {size!r}.")
    width, height = (_arguments.checked_count(side, "size") for side in sides)
    if not all(1 <= side <= _native.MAX_IMAGE_SIDE for side in (width, height)):
        raise ValueError(f"size must lie between 1 and {_native.MAX_IMAGE_SIDE}, not {size!r}.")
    return width, height


def _check_choice(value: str, choices: object, name: str) -> None:
    names = cast("tuple[str, ...]", get_args(choices))
    if value not in names:
        raise ValueError(f"{name} must be one of {', '.join(names)}, not {value!r}.")
