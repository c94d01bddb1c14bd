"""Meshes of OFF files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .edits import Integers, joined, ranges
from .lines import parsed
from .mesh import (
    AssetError,
    AssetMesh,
    check_end,
    check_text,
    checked,
    checked_corners,
    exist,
    of_short_faces,
    offsets_of,
)
from .obj import PlainAsset
from .rows import Element, Property, TextReader

# What each vertex has: texture coordinates, a color, a normal, four homogeneous coordinates, any number of them. The
# word may be missing, and the counts may follow without a space, as in all of ModelNet40.
_FIRST_WORD = re.compile(rb"\s*(?:(ST)?(C)?(N)?(4)?(n)?(?:OFF|off|Off)|(?=\d))")
_BINARY = re.compile(rb"[ \t]+BINARY")
# Of vertices, faces and edges; the last one may be missing if they are on one line.
_COUNTS = re.compile(rb"\s*(?:(\d+)[ \t]+(\d+)[^\n]*|(\d+)\s+(\d+)\s+\d+[ \t]*)\n?")
_ALL_COUNTS = re.compile(rb"\s*\d+\s+\d+\s+\d+(?=\s)")
_COMMENT = re.compile(rb"#[^\n]*")
# Values of the vertices (V, columns), numbers of corners (faces,), corners (C,).
_Rows = tuple[npt.NDArray[np.float64], Integers, Integers]


def read_off(path: Path) -> PlainAsset:
    """Read an OFF file: a row per line, whose other values, such as colors, are ignored, or rows over several lines.

    The format: "Geomview Manual", version 1.9.4, section 4.2.5 (OFF).

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
    has_uv, has_colors, has_normals, is_homogeneous, is_of_any_dimension = (part is not None for part in first.groups())
    if _BINARY.match(data, first.end()):
        raise AssetError(f"{path}: is a binary OFF file, which cannot be read: convert it to text.")
    if is_of_any_dimension:
        raise AssetError(f"{path}: has vertices of any dimension (nOFF), which cannot be read: convert it to OFF.")
    check_text(path, data)
    counts = _COUNTS.match(data, first.end())
    if not counts:
        place = len(data) - len(data[first.end() :].lstrip())
        raise AssetError(f"{_line(path, data, place)}: the numbers of vertices and faces are missing.")
    n_vertices, n_faces = (int(counts[k] or counts[k + 2]) for k in (1, 2))
    columns = [*"xyz", *"w" * is_homogeneous, *("nx", "ny", "nz") * has_normals, *"rgba" * has_colors, *"st" * has_uv]
    # Normals and colors may be missing whatever the word says; so may values of colors.
    needed = columns if has_uv else columns[: 3 + is_homogeneous]
    try:
        vertices, sizes, corner_vertices = _of_lines(path, data, counts.end(), n_vertices, n_faces, needed)
    except AssetError:
        whole = _ALL_COUNTS.match(data, first.end())
        found = _of_words(data[whole.end() :], n_vertices, n_faces, len(columns)) if whole else None
        if found is None:
            raise
        vertices, sizes, corner_vertices = found
    is_face = sizes >= 3
    corner_vertices = corner_vertices[np.repeat(is_face, sizes)]
    uv = vertices[corner_vertices, -2:] if has_uv else None
    positions = vertices[:, :3]
    if is_homogeneous:
        with np.errstate(divide="ignore", invalid="ignore"):
            positions = positions / vertices[:, 3:4]
    asset = PlainAsset([checked(path, AssetMesh(positions, offsets_of(sizes[is_face]), corner_vertices, uv))])
    asset.warnings = of_short_faces(int((~is_face).sum()), "left out")
    return asset


def _of_lines(path: Path, data: bytes, start: int, n_vertices: int, n_faces: int, columns: Sequence[str]) -> _Rows:
    reader = TextReader(path, data)
    # Other values follow; after the corners, colors.
    vertex = Element("vertex", n_vertices, 0, {name: Property(name, "f8", None, 0) for name in columns})
    vertex.start = start
    vertices, sizes, corners = [], [], []
    face = Element("face", n_faces, 0, {"corners": Property("corners", "i4", "i4", 0)}, vertex.start)
    for rows in reader.rows(vertex):
        vertices.append(rows.table(columns))
        face.start = rows.end
    for rows in reader.rows(face):
        face.end = rows.end
        column = rows.columns["corners"]
        sizes.append(column.counts)
        places, offsets = column.starts, offsets_of(column.counts)
        corners.append(
            checked_corners(
                lambda k, places=places: _line(path, data, int(places[k])), offsets, column.values, vertex.rows
            )
        )
    check_end(path, data[face.end or face.start :])
    none = np.zeros(0, np.int64)
    return joined(vertices, np.zeros((0, len(columns)))), joined(sizes, none), joined(corners, none)


def _of_words(text: bytes, n_vertices: int, n_faces: int, n_columns: int) -> _Rows | None:
    """Return the rows wherever lines end; None if they are broken, or have values beside the columns and corners."""
    values = parsed(text, np.float64)
    if values is None or len(values) < n_columns * n_vertices + n_faces:
        return None
    sizes, at = np.zeros(n_faces, np.int64), n_columns * n_vertices
    for face in range(n_faces):
        if at >= len(values) or not 0 <= values[at] < len(values):
            return None
        sizes[face] = values[at]
        at += 1 + int(values[at])
    if at != len(values):
        return None
    ends = n_columns * n_vertices + np.cumsum(sizes + 1)
    corners = values[ranges(ends - sizes, sizes)]
    if sizes.min(initial=3) < 3 or not exist(corners, n_vertices).all():
        return None
    return values[: n_columns * n_vertices].reshape(-1, n_columns), sizes, corners.astype(np.int64)


def _line(path: Path, data: bytes, place: int) -> str:
    """Return path and line of a place in the content, for messages."""
    number = data.count(b"\n", 0, place) + 1
    return f"{path}:{number}"
