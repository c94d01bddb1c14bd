"""A picture of a UV layout colored by distortion, as a PNG file; only with NumPy, which Blender's Python has."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

import numpy as np

from .._color_ramp import GOOD_TO_BAD, displayed_colors

_BACKGROUND = (30, 30, 34)
_TILE = (44, 44, 50)
_INK = (225, 225, 225)
# Rows or pixels of triangles per step, to limit memory.
_BLOCK = 1 << 21
# Files are a tenth larger than at zlib's default level, in half the time.
_COMPRESSION = 4

# Glyphs of 5 x 7 pixels, one number per row, the highest bit at the left.
_GLYPHS = {
    "0": (14, 17, 19, 21, 25, 17, 14),
    "1": (4, 12, 4, 4, 4, 4, 14),
    "2": (14, 17, 1, 2, 4, 8, 31),
    "3": (31, 2, 4, 2, 1, 17, 14),
    "4": (2, 6, 10, 18, 31, 2, 2),
    "5": (31, 16, 30, 1, 1, 17, 14),
    "6": (6, 8, 16, 30, 17, 17, 14),
    "7": (31, 1, 2, 4, 8, 8, 8),
    "8": (14, 17, 17, 14, 17, 17, 14),
    "9": (14, 17, 17, 15, 1, 2, 12),
    ".": (0, 0, 0, 0, 0, 12, 12),
    "+": (0, 4, 4, 31, 4, 4, 0),
    "Q": (14, 17, 17, 17, 21, 18, 13),
    "C": (14, 17, 16, 16, 16, 17, 14),
    " ": (0, 0, 0, 0, 0, 0, 0),
}
_LEGEND_HEIGHT = 28
_LEGEND_WIDTH = 64


def draw(uv: np.ndarray, values: np.ndarray, low: float, high: float, size: int) -> np.ndarray:
    """Return the picture of a layout with its legend below, (size + 28, size, 3) uint8, the first row at the top.

    Args:
        uv: (T, 3, 2), triangles in the map. The picture shows the unit square, or more if triangles lie outside.
        values: (T,), quasi-conformal distortion of each.
        low: the value of the first color.
        high: the value of the last color, which larger values get, too.
        size: side of the square in pixels.
    """
    finite = np.isfinite(uv)
    if not finite.all():
        kept = finite.all(axis=(1, 2))
        uv, values = uv[kept], values[kept]
    corner, extent = np.zeros(2), 1.0
    if len(uv) and (uv.min() < 0.0 or uv.max() > 1.0):
        corner = np.minimum(uv.min(axis=(0, 1)), 0.0)
        extent = float((np.maximum(uv.max(axis=(0, 1)), 1.0) - corner).max())
    picture = np.empty((size, size, 3), dtype=np.uint8)
    picture[:] = _BACKGROUND
    low_tile, high_tile = (np.clip((value - corner) / extent * size, 0, size).astype(int) for value in (0.0, 1.0))
    picture[low_tile[1] : high_tile[1], low_tile[0] : high_tile[0]] = _TILE
    # The worst triangles come last, on top of others in the same pixel.
    order = np.argsort(np.nan_to_num(values, nan=np.inf), kind="stable")
    _fill(picture, (uv[order] - corner) / extent * size, _colors(values[order], low, high))
    return np.concatenate([picture[::-1], _legend(size, low, high)])


def _colors(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return displayed colors, (T, 3) uint8."""
    return np.rint(255.0 * displayed_colors(values, low, high, GOOD_TO_BAD)).astype(np.uint8)


def _fill(picture: np.ndarray, points: np.ndarray, colors: np.ndarray) -> None:
    """Color the pixels whose centers lie in triangles, (T, 3, 2) in pixels; later triangles cover earlier ones."""
    size = len(picture)
    # Of several values for one pixel, the last one stays.
    owner = np.full(size * size, -1)
    # Corner by corner: ten times as fast as along a short axis.
    a, b, c = points.transpose(1, 0, 2)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    first, end = _centers(low[:, 1], high[:, 1], size)
    for triangles in _parts(end - first):
        row, chosen = _ranges(first[triangles], end[triangles])
        left, right = _spans(points[triangles][chosen], row + 0.5)
        left, right = _centers(left, right, size)
        for spans in _parts(right - left):
            column, span = _ranges(left[spans], right[spans])
            owner[row[spans][span] * size + column] = triangles.start + chosen[spans][span]
    # A triangle within one pixel fills it; otherwise many would be invisible.
    places = np.clip(np.floor(low), 0, size - 1).astype(int)
    small = np.flatnonzero((places == np.clip(np.floor(high), 0, size - 1)).all(axis=1))
    owner_of_small = np.full(size * size, -1)
    owner_of_small[places[small, 1] * size + places[small, 0]] = small
    np.maximum(owner, owner_of_small, out=owner)
    flat = picture.reshape(-1, 3)
    flat[owner >= 0] = colors[owner[owner >= 0]]


def _centers(low: np.ndarray, high: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the range (begin, end) of a line's pixels whose centers lie between `low` and `high`."""
    first = np.clip(np.ceil(low - 0.5), 0, size).astype(int)
    return first, np.maximum(first, np.clip(np.floor(high + 0.5), 0, size).astype(int))


def _parts(counts: np.ndarray) -> Iterator[slice]:
    """Yield slices of items, given their numbers of parts, small enough to process at once."""
    ends = np.cumsum(counts)
    start = 0
    while start < len(counts):
        before = ends[start - 1] if start else 0
        end = max(start + 1, int(np.searchsorted(ends, before + _BLOCK, side="right")))
        yield slice(start, end)
        start = end


def _ranges(first: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the concatenated ranges from `first` to `end`, and the index of each number's range."""
    counts = end - first
    owner = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    return first[owner] + within, owner


def _spans(corners: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of horizontal lines, at `y` (N,), within triangles, (N, 3, 2)."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for k in range(3):
        (start_x, start_y), (end_x, end_y) = corners[:, k].T, corners[:, (k + 1) % 3].T
        with np.errstate(divide="ignore", invalid="ignore"):
            x = start_x + (y - start_y) / (end_y - start_y) * (end_x - start_x)
        # Horizontal edges can be skipped: the two adjacent edges share their ends.
        crosses = (np.minimum(start_y, end_y) <= y) & (y <= np.maximum(start_y, end_y)) & (start_y != end_y)
        np.minimum(left, x, out=left, where=crosses)
        np.maximum(right, x, out=right, where=crosses)
    return left, right


def _legend(width: int, low: float, high: float) -> np.ndarray:
    """Return the legend: a name, and the colors between their end values."""
    legend = np.empty((_LEGEND_HEIGHT, width, 3), dtype=np.uint8)
    legend[:] = _BACKGROUND
    cells = max(1, width - 2 * _LEGEND_WIDTH)
    ramp = _colors(np.linspace(low, high, cells), low, high)
    legend[8:20, _LEGEND_WIDTH : _LEGEND_WIDTH + cells] = ramp[: width - _LEGEND_WIDTH]
    _write(legend, 4, f"QC {low:.2f}")
    _write(legend, width - _LEGEND_WIDTH + 6, f"{high:.2f}+")
    return legend


def _write(picture: np.ndarray, left: int, text: str) -> None:
    for index, character in enumerate(text):
        rows = np.array(_GLYPHS[character])
        bits = (rows[:, None] >> np.arange(4, -1, -1)) & 1
        x = left + 6 * index
        area = picture[10:17, x : x + 5]
        area[bits[:, : area.shape[1]] == 1] = _INK


def png(picture: np.ndarray) -> bytes:
    """Return an image, (height, width, 3) uint8, as a PNG file (ISO/IEC 15948)."""
    height, width, _ = picture.shape
    rows = np.concatenate([np.zeros((height, 1), dtype=np.uint8), picture.reshape(height, -1)], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), _COMPRESSION)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in parts)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def thumbnail(picture: np.ndarray, size: int) -> np.ndarray:
    """Return the picture reduced to sides of at most `size` by averaging blocks of pixels."""
    step = -(-max(picture.shape[:2]) // size)
    height, width = (length // step * step for length in picture.shape[:2])
    total = np.zeros((height // step, width // step, 3))
    for row in range(step):
        for column in range(step):
            total += picture[row:height:step, column:width:step]
    return np.rint(total / step**2).astype(np.uint8)
