"""Meshes of OFF files."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .edits import joined
from .mesh import AssetError, AssetMesh, check_faces, checked, offsets_of
from .obj import PlainAsset
from .rows import Element, Property, TextReader

# The counts may follow without a space, as in all of ModelNet40.
_FIRST_WORD = re.compile(rb"\s*(?:ST)?C?N?4?n?OFF", re.IGNORECASE)
_COUNTS = re.compile(rb"\s*(\d+)[ \t]+(\d+)[^\n]*\n?")
_COMMENT = re.compile(rb"#[^\n]*")


def read_off(path: Path) -> PlainAsset:
    """Read an OFF file; other values in a row, such as colors, are ignored.

    Raises:
        AssetError: the content is broken.
        OSError: the file cannot be opened.
    """
    # Line ends of all systems; comments leave their lines.
    data = path.read_bytes().removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if b"#" in data:
        data = _COMMENT.sub(b"", data)
    first = _FIRST_WORD.match(data)
    if not first:
        raise AssetError(f"{path}:1: an OFF file begins with 'OFF'.")
    counts = _COUNTS.match(data, first.end())
    if not counts:
        place = len(data) - len(data[first.end() :].lstrip())
        raise AssetError(f"{_line(path, data, place)}: the numbers of vertices and faces are missing.")
    reader = TextReader(path, data)
    # Texture coordinates, colors and normals follow the position; colors, the corners.
    vertex = Element("vertex", int(counts[1]), 0, {name: Property(name, "f8", None, 0) for name in "xyz"})
    vertex.start = counts.end()
    positions, sizes, corners = [], [], []
    face = Element("face", int(counts[2]), 0, {"corners": Property("corners", "i4", "i4", 0)}, vertex.start)
    for rows in reader.rows(vertex):
        positions.append(rows.table("xyz"))
        face.start = rows.end
    for rows in reader.rows(face):
        column = rows.columns["corners"]
        sizes.append(column.counts)
        corners.append(column.values.astype(np.int64))
        places = column.starts
        check_faces(
            lambda k, places=places: _line(path, data, int(places[k])), offsets_of(sizes[-1]), corners[-1], vertex.rows
        )
    vertices = joined(positions, np.zeros((0, 3)))
    offsets, corner_vertices = offsets_of(joined(sizes, np.zeros(0, np.int64))), joined(corners, np.zeros(0, np.int64))
    return PlainAsset([checked(path, AssetMesh(vertices, offsets, corner_vertices))])


def _line(path: Path, data: bytes, place: int) -> str:
    """Return path and line of a place in the content, for messages."""
    number = data.count(b"\n", 0, place) + 1
    return f"{path}:{number}"
