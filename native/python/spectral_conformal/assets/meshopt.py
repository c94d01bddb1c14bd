"""Decompression of `EXT_meshopt_compression`, from Khronos' specification of its bitstream and filters.

This is our own code because the library, meshoptimizer, is on PyPI only as a source that needs a compiler.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Bytes = npt.NDArray[np.uint8]

_ATTRIBUTES, _TRIANGLES, _INDICES = b"\xa0", b"\xe1", b"\xd1"
# Of an attribute's tail at least, of the triangles' and of the indices'.
_TAILS = (32, 16, 4)
_BLOCK_BYTES, _BLOCK, _GROUP = 8192, 256, 16
# By the mode of a group: the largest value, which stands for a whole byte behind the group, and the values in a byte.
_PACKED = {
    mode: (bytes([2**bits - 1]), [bytes(each >> shift & 2**bits - 1 for shift in shifts) for each in range(256)])
    for mode, bits, shifts in ((1, 2, (6, 4, 2, 0)), (2, 4, (4, 0)))
}
_RECENT = 16


def decoded(data: bytes, mode: str, filter_name: str, count: int, stride: int) -> Bytes:
    """Return the content of a buffer view, (count * stride,).

    Args:
        data: as compressed.
        mode: ATTRIBUTES, TRIANGLES or INDICES.
        filter_name: NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL.
        count: of elements.
        stride: bytes of an element.

    Raises:
        ValueError: the data is broken, or of another version or kind.
        IndexError: it ends too early.
    """
    if count < 0 or not 0 < stride <= _BLOCK:
        raise ValueError(f"{count} elements of {stride} bytes")
    if mode == "ATTRIBUTES":
        return _FILTERS[filter_name](_attributes(data, count, stride)).ravel().view(np.uint8)
    if mode not in ("TRIANGLES", "INDICES"):
        raise ValueError(f"the mode {mode} is unknown")
    read = _triangles if mode == "TRIANGLES" else _indices
    numbers = np.fromiter(itertools.chain.from_iterable(read(data, count)), np.uint32, count)
    return numbers.astype({2: "<u2", 4: "<u4"}[stride]).view(np.uint8)


def _checked(data: bytes, begin: bytes) -> None:
    if data[:1] != begin:
        raise ValueError(f"it begins with {data[:1].hex()}, not {begin.hex()}")


def _attributes(data: bytes, count: int, stride: int) -> Bytes:
    """Return the elements, (count, stride)."""
    _checked(data, _ATTRIBUTES)
    tail = max(stride, _TAILS[0])
    result = np.empty((count, stride), np.uint8)
    last = np.frombuffer(data[-stride:], np.uint8)
    most = min(_BLOCK_BYTES // stride // _GROUP * _GROUP, _BLOCK)
    at = 1
    for first in range(0, count, most):
        size = min(most, count - first)
        n_groups = -(-size // _GROUP)
        pieces = []
        for _ in range(stride):
            head, at = data[at : at + -(-n_groups // 4)], at + -(-n_groups // 4)
            for group in range(n_groups):
                values, at = _group(data, at, head[group // 4] >> 2 * (group % 4) & 3)
                pieces.append(values)
        coded = np.frombuffer(b"".join(pieces), np.uint8).reshape(stride, n_groups * _GROUP)[:, :size]
        # Zigzag: the lowest bit is the sign.
        deltas = (coded >> 1) ^ (0 - (coded & 1)).astype(np.uint8)
        result[first : first + size] = (np.cumsum(deltas, axis=1, dtype=np.uint8) + last[:, None]).T
        last = result[first + size - 1]
    if at != len(data) - tail:
        raise ValueError(f"its attributes take {at} of {len(data) - tail} bytes")
    return result


def _group(data: bytes, at: int, mode: int) -> tuple[bytes, int]:
    """Return the bytes of a group, and the place behind it."""
    if mode == 0:
        return bytes(_GROUP), at
    if mode == 3:
        return data[at : at + _GROUP], at + _GROUP
    top, values_of = _PACKED[mode]
    size = _GROUP // len(values_of[0])
    values = b"".join([values_of[each] for each in data[at : at + size]])
    at += size
    if top in values:
        whole = bytearray(values)
        for k, value in enumerate(values):
            if value == top[0]:
                whole[k] = data[at]
                at += 1
        values = bytes(whole)
    return values, at


class _Numbers:
    """Indices by their differences, of seven bits in a byte."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at = data, at
        self.last = 0

    def byte(self) -> int:
        """Return the next byte."""
        self.at += 1
        return self.data[self.at - 1]

    def whole(self) -> int:
        """Return the next number, which may have many bytes."""
        result = shift = 0
        while True:
            byte = self.byte()
            result |= (byte & 127) << shift
            if byte < 128:
                return result
            shift += 7

    def index(self) -> int:
        """Return the next index."""
        self.last = self.last + _signed(self.whole()) & 0xFFFFFFFF
        return self.last


def _signed(value: int) -> int:
    return ~(value >> 1) if value & 1 else value >> 1


def _triangles(data: bytes, count: int) -> Iterator[tuple[int, int, int]]:
    """Yield the triangles of so many indices."""
    _checked(data, _TRIANGLES)
    codes, end = data[1 : 1 + count // 3], len(data) - _TAILS[1]
    table = data[end:]
    numbers = _Numbers(data, 1 + count // 3)
    # The most recent one last.
    edges, vertices = [(0, 0)] * _RECENT, [0] * _RECENT
    following = 0

    def new(code: int, is_free: bool = False) -> int:
        """Return a vertex: the next one, a recent one, or, if allowed, one given by its difference; remember it."""
        nonlocal following
        if code == 0:
            following += 1
            vertex = following - 1
        elif code < 15 or not is_free:
            return recent[-code]
        else:
            vertex = numbers.index()
        vertices.append(vertex)
        return vertex

    for code in codes:
        high, low = code >> 4, code & 15
        recent = vertices[-_RECENT:]
        if high < 15:
            a, b = edges[-1 - high]
            if low in (13, 14):
                c = numbers.last = numbers.last + (-1 if low == 13 else 1)
                vertices.append(c)
            else:
                c = recent[-1 - low] if 0 < low < 13 else new(low, True)
            edges += [(c, b), (a, c)]
        else:
            pair = table[low] if low < 14 else numbers.byte()
            if low >= 14 and pair == 0:
                following = 0
            a = new(0 if low < 15 else 15, True)
            b, c = new(pair >> 4, low >= 14), new(pair & 15, low >= 14)
            edges += [(b, a), (c, b), (a, c)]
        del edges[:-_RECENT], vertices[:-_RECENT]
        yield a, b, c
    if numbers.at != end:
        raise ValueError(f"its triangles take {numbers.at} of {end} bytes")


def _indices(data: bytes, count: int) -> Iterator[tuple[int]]:
    """Yield each of so many indices."""
    _checked(data, _INDICES)
    numbers, last = _Numbers(data, 1), [0, 0]
    for _ in range(count):
        value = numbers.whole()
        last[value & 1] = last[value & 1] + _signed(value >> 1) & 0xFFFFFFFF
        yield (last[value & 1],)
    if numbers.at != len(data) - _TAILS[2]:
        raise ValueError(f"its indices take {numbers.at} of {len(data) - _TAILS[2]} bytes")


def _octahedral(rows: Bytes) -> npt.NDArray:
    kind = {4: np.dtype("<i1"), 8: np.dtype("<i2")}[rows.shape[1]]
    stored = rows.view(kind)
    x, y = (stored[:, :2] / stored[:, 2:3].astype(np.float32)).T
    z = 1.0 - np.abs(x) - np.abs(y)
    below = np.minimum(z, 0.0)
    unit = np.stack([x - np.copysign(below, x), y - np.copysign(below, y), z], axis=1)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    result = stored.copy()
    result[:, :3] = np.rint(unit * np.iinfo(kind).max)
    return result


def _quaternion(rows: Bytes) -> npt.NDArray:
    stored = rows.view("<i2").astype(np.int32)
    small = stored[:, :3] / (stored[:, 3:] | 3) / np.sqrt(2.0)
    large = np.sqrt(np.maximum(0.0, 1.0 - (small**2).sum(axis=1)))
    result = np.empty((len(rows), 4), "<i2")
    places = ((stored[:, 3:] & 3) + np.arange(4)) % 4
    np.put_along_axis(result, places, np.rint(np.column_stack([large, small]) * 32767).astype("<i2"), axis=1)
    return result


def _exponential(rows: Bytes) -> npt.NDArray:
    stored = rows.view("<i4")
    return np.ldexp(((stored << 8) >> 8).astype(np.float32), stored >> 24).astype("<f4")


_FILTERS = {
    "NONE": lambda rows: rows,
    "OCTAHEDRAL": _octahedral,
    "QUATERNION": _quaternion,
    "EXPONENTIAL": _exponential,
}
