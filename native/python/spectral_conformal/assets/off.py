"""Meshes of OFF files."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .mesh import AssetError, AssetMesh, check_face, checked, numbers, offsets_of
from .obj import PlainAsset

# The counts may follow without a space, as in all of ModelNet40.
_FIRST_WORD = re.compile(r"((?:ST)?C?N?4?n?OFF)(.*)", re.IGNORECASE)


def read_off(path: Path) -> PlainAsset:
    """Read an OFF file; other values in a row, such as colors, are ignored.

    Raises:
        AssetError: the content is broken.
        OSError: the file cannot be opened.
    """
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        lines = [(number, words) for number, line in enumerate(file, 1) if (words := line.split("#", 1)[0].split())]
    first = _FIRST_WORD.fullmatch(lines[0][1][0]) if lines else None
    if not first:
        raise AssetError(f"{path}:1: an OFF file begins with 'OFF'.")
    lines[0] = (lines[0][0], [*filter(None, [first[2]]), *lines[0][1][1:]])
    if not lines[0][1]:
        lines = lines[1:]
    if not lines:
        raise AssetError(f"{path}: ends before the numbers of vertices and faces.")
    number, words = lines[0]
    try:
        n_vertices, n_faces = int(words[0]), int(words[1])
    except (ValueError, IndexError):
        raise AssetError(f"{path}:{number}: the numbers of vertices and faces are missing.") from None
    if len(lines) < 1 + n_vertices + n_faces:
        raise AssetError(
            f"{path}: the header announces {n_vertices} vertices and {n_faces} faces, but {len(lines) - 1} "
            "lines follow."
        )
    # Texture coordinates, colors and normals follow the position.
    positions = [numbers(f"{path}:{number}", words, 3) for number, words in lines[1 : 1 + n_vertices]]
    sizes, corners = [], []
    for number, words in lines[1 + n_vertices : 1 + n_vertices + n_faces]:
        where = f"{path}:{number}"
        size = int(numbers(where, words, 1)[0])
        row = [int(value) for value in numbers(where, words[1:], size)]
        check_face(where, row, n_vertices)
        sizes.append(size)
        corners += row
    vertices = np.array(positions, dtype=np.float64).reshape(-1, 3)
    return PlainAsset([checked(path, AssetMesh(vertices, offsets_of(sizes), np.array(corners, dtype=np.int64)))])
