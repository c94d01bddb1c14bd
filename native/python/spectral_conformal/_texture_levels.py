"""Smaller copies of a texture for triangles that repeat it so often that the samples of its texels would take too long.

As in Williams, "Pyramidal Parametrics", 1983: level k has half of the width and height of level k - 1.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ._rebaking import Content, Wrap, rebake

_Floats = npt.NDArray[np.floating]
_Sides = tuple[int, int]

# About half a minute of a processor.
_MAX_SAMPLES = float(1 << 30)
# Samples per texel along an axis, as the native code takes them at most, down to one.
_RATES = (32, 16, 8, 4, 2, 1)
_SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
_HALVES = np.array([(0, 1, 2), (0, 2, 3)])


def levels(
    old: _Floats, new: _Floats, triangles: npt.NDArray[np.integer], image: _Sides, target: _Sides
) -> npt.NDArray[np.int64]:
    """Return the level of each triangle, (T,), all 0 if the samples of the image itself are few enough.

    Args:
        old: (C, 2) the map of the image.
        new: (C, 2) the map of the target.
        triangles: (T, 3) rows of both.
        image: width and height in texels.
        target: likewise.
    """
    (a, b), (c, d) = (
        (uv[triangles[:, 1]] - uv[triangles[:, 0]], uv[triangles[:, 2]] - uv[triangles[:, 0]])
        for uv in (old * image, new * target)
    )
    area = c[:, 0] * d[:, 1] - c[:, 1] * d[:, 0]
    with np.errstate(all="ignore"):
        # Texels of the image per texel of the target along each axis.
        along = np.linalg.norm((a * d[:, 1:] - b * c[:, 1:]) / area[:, None], axis=1)
        across = np.linalg.norm((b * c[:, :1] - a * d[:, :1]) / area[:, None], axis=1)
    lengths = np.nan_to_num(np.stack([along, across]), nan=0.0, posinf=0.0)
    texels = np.nan_to_num(0.5 * np.abs(area), posinf=0.0)
    for rate in _RATES:
        if (texels * np.clip(lengths, 1.0, rate).prod(axis=0)).sum() <= _MAX_SAMPLES:
            break
    if rate == _RATES[0]:
        return np.zeros(len(triangles), np.int64)
    needed = np.ceil(np.log2(np.maximum(lengths.max(axis=0), rate) / rate)).astype(np.int64)
    # The last one has a single texel.
    return np.minimum(needed, int(np.ceil(np.log2(max(image)))))


def copies(
    image: np.ndarray, number: int, content: Content, opacity: bool, wrap: tuple[Wrap, Wrap]
) -> Sequence[np.ndarray]:
    """Return an image, (height, width, channels), and so many of the next levels; the others are those of `rebake`."""
    ones = np.ones(4)
    normals, tangents = np.outer(ones, (0.0, 0.0, 1.0)), np.outer(ones, (1.0, 0.0, 0.0, 1.0))
    result = [image]
    for _ in range(number):
        height, width = result[-1].shape[:2]
        half = rebake(
            result[-1],
            _SQUARE,
            _SQUARE,
            _HALVES,
            size=((width + 1) // 2, (height + 1) // 2),
            content=content,
            opacity=opacity,
            wrap=wrap,
            normals=normals,
            old_tangents=tangents,
            new_tangents=tangents,
        )
        result.append(half.image)
    return result
