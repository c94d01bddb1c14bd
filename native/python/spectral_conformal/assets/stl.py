"""Meshes of STL files, whose triangles share no vertices: vertices at the same position are merged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from .edits import in_order_of_use
from .mesh import AssetError, AssetMesh, checked, numbers
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
        corners = np.frombuffer(data, _TRIANGLE, announced, _HEADER + 4)["corners"].reshape(-1, 3).astype(np.float64)
    # -0.0 is the same position as 0.0.
    first, corner_vertices = in_order_of_use(corners + 0.0)
    offsets = np.arange(0, len(corners) + 1, 3, dtype=np.int64)
    return PlainAsset([checked(path, AssetMesh(corners[first] + 0.0, offsets, corner_vertices))])


def _of_text(path: Path, data: bytes) -> npt.NDArray[np.float64]:
    corners, in_facet = [], 0
    for number, line in enumerate(data.decode("utf-8", errors="replace").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        word = words[0].lower()
        if word == "vertex":
            corners.append(numbers(f"{path}:{number}", words[1:], 3))
            in_facet += 1
        elif word == "endfacet":
            if in_facet != 3:
                raise AssetError(f"{path}:{number}: a facet has three vertices, this one has {in_facet}.")
            in_facet = 0
    if in_facet:
        raise AssetError(f"{path}: ends within a facet.")
    return np.array(corners, dtype=np.float64).reshape(-1, 3)
