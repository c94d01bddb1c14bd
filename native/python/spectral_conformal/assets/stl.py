"""Meshes of STL files, whose triangles share no vertices: vertices at the same position are merged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from .._arguments import doubles
from .._distinct_rows import in_order_of_use
from .edits import joined
from .lines import Block, blocks, parsed
from .mesh import AssetError, AssetMesh, check_text, checked, numbers
from .obj import PlainAsset

_HEADER = 80
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(path: Path) -> PlainAsset:
    """Read an STL file, text or binary.

    Raises:
        AssetError: the content is broken.
        OSError: the file cannot be opened.
    """
    data = path.read_bytes()
    # Binary files may begin with "solid", too; the length decides.
    announced = int.from_bytes(data[_HEADER : _HEADER + 4], "little")
    is_binary = len(data) >= _HEADER + 4 + announced * _TRIANGLE.itemsize and b"\0" in data[: _HEADER + 4]
    if data.lstrip()[:5].lower() == b"solid" and not is_binary:
        corners = _of_text(path, data)
    elif len(data) < _HEADER + 4:
        raise AssetError(f"{path}: ends before the number of triangles.")
    elif len(data) < _HEADER + 4 + announced * _TRIANGLE.itemsize:
        raise AssetError(f"{path}: the header announces {announced} triangles, but the file ends before the last.")
    else:
        corners = _of_bytes(path, data, announced)
    # -0.0 is the same position as 0.0.
    corners = np.where(corners == 0.0, corners.dtype.type(0.0), corners)
    first, corner_vertices = in_order_of_use(corners)
    offsets = np.arange(0, len(corners) + 1, 3, dtype=np.int64)
    vertices = doubles(corners[first])
    return PlainAsset([checked(path, AssetMesh(vertices, offsets, corner_vertices))])


def _of_bytes(path: Path, data: bytes, announced: int) -> npt.NDArray[np.float32]:
    """Return the corners, (C, 3)."""
    size = _TRIANGLE.itemsize
    present, rest = divmod(len(data) - _HEADER - 4, size)
    # Other bytes behind the triangles are of programs that add some.
    if announced < present and 0 in (announced, rest):
        raise AssetError(f"{path}: the header announces {announced} triangles, but the file has {present}.")
    rows = np.frombuffer(data, np.uint8, announced * size, _HEADER + 4).reshape(-1, size)
    is_lost = ~rows.any(axis=1)
    if is_lost.any():
        raise AssetError(f"{path}: triangle {int(is_lost.argmax()) + 1} consists of zeros: the file is damaged.")
    return np.frombuffer(data, _TRIANGLE, announced, _HEADER + 4)["corners"].reshape(-1, 3)


def _of_text(path: Path, data: bytes) -> npt.NDArray[np.float64]:
    """Return the corners, (C, 3)."""
    check_text(path, data)
    corners, in_facet = [], 0
    for start, end in blocks(data, 0, b"\n" if b"\n" in data else b"\r"):
        block = Block(data[start:end].replace(b"\r", b"\n").lower(), start)
        firsts = block.first_words[:-1][np.diff(block.first_words) > 0]
        lines = np.flatnonzero(np.diff(block.first_words) > 0)
        is_corner, is_end = (_begin_with(block, firsts, word) for word in (b"vertex", b"endfacet"))
        # Corners since the last end of a facet, at each end.
        before = np.append(0, np.cumsum(is_corner))
        ends = np.flatnonzero(is_end)
        counts = np.diff(np.append(-in_facet, before[ends]))
        if (counts != 3).any():
            bad = int((counts != 3).argmax())
            where = _where(path, data, block, int(lines[ends[bad]]))
            raise AssetError(f"{where}: a facet has three vertices, this one has {counts[bad]}.")
        in_facet = int(before[-1] - before[ends[-1]]) if len(ends) else in_facet + int(before[-1])
        corners.append(_positions(path, data, block, lines[is_corner]))
    if in_facet:
        raise AssetError(f"{path}: ends within a facet.")
    last = data.rstrip(b" \t\r\n\0").rpartition(b"\n" if b"\n" in data else b"\r")[2]
    # Some programs write "end solid".
    if not last.lower().replace(b" ", b"").startswith(b"endsolid"):
        raise AssetError(f"{path}: ends without 'endsolid': the file is cut off.")
    return joined(corners, np.zeros((0, 3)))


def _begin_with(block: Block, words: npt.NDArray[np.int64], text: bytes) -> npt.NDArray[np.bool_]:
    """Return which words, (n,), are this text."""
    starts = block.word_starts[words]
    result = block.word_ends[words] - starts == len(text)
    for k, byte in enumerate(text):
        result &= block.array[np.minimum(starts + k, len(block.array) - 1)] == byte
    return result


def _positions(path: Path, data: bytes, block: Block, lines: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """Return the first three numbers of each line, (n, 3)."""
    flat = parsed(block.joined(lines).replace(b"vertex", b""), np.float64)
    if flat is not None and len(flat) == 3 * len(lines) and (np.diff(block.first_words)[lines] == 4).all():
        return flat.reshape(-1, 3)
    rows = []
    for line in lines.tolist():
        words = [word.decode(errors="replace") for word in block.words(line)[1:]]
        rows.append(numbers(_where(path, data, block, line), words, 3))
    return np.array(rows, dtype=np.float64).reshape(-1, 3)


def _where(path: Path, data: bytes, block: Block, line: int) -> str:
    """Return file and line, for a message; its end may be that of any system."""
    before = data[: block.start + int(block.starts[line])]
    number = 1 + max(before.count(end) for end in (b"\n", b"\r"))
    return f"{path}:{number}"
