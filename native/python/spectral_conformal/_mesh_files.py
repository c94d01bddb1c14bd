"""Polygon meshes from OBJ, PLY and OFF files, and OBJ files with a UV map.

Own code, since what is asked for is little, and the libraries for it triangulate, merge or reorder vertices, or do not
say which line is broken.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt


class MeshFileError(ValueError):
    """A file cannot be read as a mesh; the message names file, line or element, and the violated condition."""


@dataclass(frozen=True)
class MeshFile:
    """A polygon mesh as it stands in a file, vertices and faces in the file's order."""

    vertices: npt.NDArray[np.float64]
    """(V, 3)"""
    face_offsets: npt.NDArray[np.int64]
    """(faces + 1,) as in `unwrap`."""
    corner_vertices: npt.NDArray[np.int64]
    """(C,)"""
    corner_uv: npt.NDArray[np.float64] | None
    """(C, 2), not a number where a corner has none; None where the file has no UV map."""


def read_mesh(path: Path) -> MeshFile:
    """Read a mesh; the suffix says which format it is in.

    Raises:
        MeshFileError: the suffix is none of .obj, .ply and .off, or the content is broken.
        OSError: the file cannot be opened.
    """
    reader = {".obj": _read_obj, ".ply": _read_ply, ".off": _read_off}.get(path.suffix.lower())
    if reader is None:
        raise MeshFileError(f"{path}: only .obj, .ply and .off files can be read, not '{path.suffix}'.")
    mesh = reader(path)
    if len(mesh.face_offsets) == 1:
        raise MeshFileError(f"{path}: has no faces; there is nothing to unwrap.")
    missing = ~np.isfinite(mesh.vertices).all(axis=1)
    if missing.any():
        raise MeshFileError(f"{path}: the position of vertex {missing.argmax() + 1} is not finite.")
    return mesh


# OBJ


def _read_obj(path: Path) -> MeshFile:
    positions: list[list[float]] = []
    uv: list[list[float]] = []
    corners: list[int] = []
    corner_uv: list[int] = []
    sizes: list[int] = []
    for number, words in _obj_statements(path):
        try:
            if words[0] == "v":
                positions.append([float(words[1]), float(words[2]), float(words[3])])
            elif words[0] == "vt":
                uv.append([float(words[1]), float(words[2]) if len(words) > 2 else 0.0])
            elif words[0] == "f":
                for word in words[1:]:
                    parts = word.split("/")
                    corners.append(_obj_index(parts[0], len(positions), "vertex"))
                    corner_uv.append(_obj_index(parts[1], len(uv), "UV") if len(parts) > 1 and parts[1] else -1)
                sizes.append(len(words) - 1)
                if len(words) < 4:
                    raise ValueError("a face needs at least three corners")
        except IndexError:
            raise MeshFileError(f"{path}:{number}: '{words[0]}' has too few numbers.") from None
        except ValueError as error:
            raise MeshFileError(f"{path}:{number}: {error}.") from None
    found = None
    if uv and max(corner_uv, default=-1) >= 0:
        found = np.vstack([np.array(uv, dtype=np.float64), [[np.nan, np.nan]]])[np.array(corner_uv)]
    return _mesh(positions, sizes, corners, found)


def _obj_statements(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Give the words of each statement with the number of its (first) line; a backslash continues a line."""
    carried: list[str] = []
    first = 0
    with path.open(encoding="utf-8", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            words = line.split("#", 1)[0].split()
            first = first if carried else number
            if words and words[-1].endswith("\\"):
                carried += [*words[:-1], *filter(None, [words[-1][:-1]])]
                continue
            words, carried = carried + words, []
            if words:
                yield first, words


def _obj_index(word: str, count: int, what: str) -> int:
    """Return the index from 0 of one that counts from 1, or back from the last one before the line."""
    try:
        value = int(word)
    except ValueError:
        raise ValueError(f"'{word}' is no number of a {what}") from None
    index = value - 1 if value > 0 else count + value
    if value == 0 or not 0 <= index < count:
        raise ValueError(f"there is no {what} {value}; {count} stand before this line")
    return index


def write_obj(
    path: Path, mesh: MeshFile, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_], source: Path
) -> None:
    """Write a mesh with a UV map, whole or not at all.

    An OBJ file as source is copied statement by statement, its UVs replaced, so that objects, groups, materials,
    normals and the order of everything stay.

    Args:
        path: where to.
        mesh: as read from the source.
        uv: (C, 2).
        mapped: (faces,) faces without a map get no UVs.
        source: the file that the mesh is from.
    """
    corner_mapped = np.repeat(mapped, np.diff(mesh.face_offsets))
    # One vt per corner of the same vertex and the same UV, as importers join a map by equal indices.
    keys = np.c_[mesh.corner_vertices, uv][corner_mapped]
    different, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(1, len(order) + 1)
    index = np.zeros(len(uv), dtype=np.int64)
    index[corner_mapped] = rank[number.ravel()]
    # Nine digits give single precision back.
    coordinates = [f"vt {u:.9g} {v:.9g}\n" for u, v in different[order, 1:]]
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with temporary.open("w", encoding="utf-8", newline="\n") as out:
            copied = source.suffix.lower() == ".obj"
            out.writelines(_copied_obj(source, index, coordinates) if copied else _plain_obj(mesh, index, coordinates))
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _plain_obj(mesh: MeshFile, index: npt.NDArray[np.int64], coordinates: list[str]) -> Iterator[str]:
    for x, y, z in mesh.vertices.tolist():
        yield f"v {x!r} {y!r} {z!r}\n"
    yield from coordinates
    corners = [f"{v}/{t}" if t else str(v) for v, t in zip((mesh.corner_vertices + 1).tolist(), index.tolist())]
    for first, last in zip(mesh.face_offsets[:-1].tolist(), mesh.face_offsets[1:].tolist()):
        yield f"f {' '.join(corners[first:last])}\n"


def _copied_obj(source: Path, index: npt.NDArray[np.int64], coordinates: list[str]) -> Iterator[str]:
    numbers = iter(index.tolist())
    for _, words in _obj_statements(source):
        if words[0] == "vt":
            continue
        if words[0] == "f":
            yield from coordinates
            coordinates = []
            corners = []
            for word, number in zip(words[1:], numbers):
                parts = word.split("/")
                normal = parts[2] if len(parts) > 2 else ""
                middle = str(number) if number else ""
                corners.append("/".join([parts[0], middle, normal]).rstrip("/"))
            yield f"f {' '.join(corners)}\n"
        else:
            yield f"{' '.join(words)}\n"


# OFF


def _read_off(path: Path) -> MeshFile:
    with path.open(encoding="utf-8", errors="replace") as file:
        lines = [(number, words) for number, line in enumerate(file, 1) if (words := line.split("#", 1)[0].split())]
    if not lines or not lines[0][1][0].upper().endswith("OFF"):
        raise MeshFileError(f"{path}:1: an OFF file begins with 'OFF'.")
    if len(lines[0][1]) > 1:
        lines[0] = (lines[0][0], lines[0][1][1:])  # the counts stand beside the word
    else:
        lines = lines[1:]
    if not lines:
        raise MeshFileError(f"{path}: ends before the numbers of vertices and faces.")
    number, words = lines[0]
    try:
        n_vertices, n_faces = int(words[0]), int(words[1])
    except (ValueError, IndexError):
        raise MeshFileError(f"{path}:{number}: the numbers of vertices and faces are missing.") from None
    if len(lines) < 1 + n_vertices + n_faces:
        raise MeshFileError(
            f"{path}: {n_vertices} vertices and {n_faces} faces are announced, {len(lines) - 1} lines follow."
        )
    positions, sizes, corners = [], [], []
    for number, words in lines[1 : 1 + n_vertices]:
        positions.append(_numbers(path, number, words, 3))
    for number, words in lines[1 + n_vertices : 1 + n_vertices + n_faces]:
        size = int(_numbers(path, number, words, 1)[0])
        row = [int(value) for value in _numbers(path, number, words[1:], size)]
        _check_face(f"{path}:{number}", row, n_vertices)
        sizes.append(size)
        corners += row
    return _mesh(positions, sizes, corners, None)


def _numbers(path: Path, line: int, words: list[str], count: int) -> list[float]:
    try:
        numbers = [float(word) for word in words[:count]]
    except ValueError:
        raise MeshFileError(f"{path}:{line}: '{' '.join(words)}' has something that is no number.") from None
    if len(numbers) < count:
        raise MeshFileError(f"{path}:{line}: {count} numbers are needed, {len(numbers)} are there.")
    return numbers


def _check_face(where: str, row: Iterable[int], n_vertices: int) -> None:
    row = list(row)
    if len(row) < 3:
        raise MeshFileError(f"{where}: a face needs at least three corners.")
    for index in row:
        if not 0 <= index < n_vertices:
            raise MeshFileError(f"{where}: there is no vertex {index}; {n_vertices} are numbered from 0.")


# PLY

_PLY_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_PLY_FORMATS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass
class _Property:
    name: str
    type: str
    count_type: str | None
    """Of a list: the type of its length."""


@dataclass
class _Element:
    name: str
    rows: int
    properties: list[_Property]


Columns = dict[str, list[npt.NDArray]]


def _read_ply(path: Path) -> MeshFile:
    data = path.read_bytes()
    order, elements, start, lines = _ply_header(path, data)
    if order is None:
        columns = _ply_text(path, data[start:], elements, lines)
    else:
        columns = _ply_binary(path, data, start, elements, order)
    vertex, face = columns.get("vertex", {}), columns.get("face", {})
    missing = [name for name in "xyz" if name not in vertex]
    if missing:
        raise MeshFileError(f"{path}: the element 'vertex' has no property '{missing[0]}'.")
    faces = face.get("vertex_indices", face.get("vertex_index"))
    if faces is None:
        raise MeshFileError(f"{path}: there is no element 'face' with a list 'vertex_indices'.")
    positions = np.stack([np.array(vertex[name], dtype=np.float64).ravel() for name in "xyz"], axis=1)
    sizes = np.array([len(row) for row in faces], dtype=np.int64)
    corners = np.concatenate([np.zeros(0, np.int64), *faces]).astype(np.int64) if len(sizes) else np.zeros(0, np.int64)
    bad = np.flatnonzero((corners < 0) | (corners >= len(positions)))
    if (sizes < 3).any() or len(bad):
        offsets = np.r_[0, np.cumsum(sizes)]
        number = (sizes < 3).argmax() if (sizes < 3).any() else np.searchsorted(offsets, bad[0], side="right") - 1
        _check_face(f"{path}: face {number}", faces[number].astype(np.int64).tolist(), len(positions))
    return _mesh(positions, sizes, corners, None)


def _ply_header(path: Path, data: bytes) -> tuple[str | None, list[_Element], int, int]:
    """Return the byte order, None for text; the elements; where the data begins; the number of lines before it."""
    if data[:3] != b"ply":
        raise MeshFileError(f"{path}:1: a PLY file begins with 'ply'.")
    end = data.find(b"end_header")
    if end < 0:
        raise MeshFileError(f"{path}: the header has no 'end_header'.")
    start = data.find(b"\n", end) + 1 or len(data)
    order, elements = "?", []
    header = data[:start].decode("ascii", errors="replace").splitlines()
    for number, line in enumerate(header, 1):
        words = line.split()
        try:
            if words[:1] == ["format"]:
                order = _PLY_FORMATS[words[1]]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                count, kind = _PLY_TYPES[words[2]], _PLY_TYPES[words[3]]
                elements[-1].properties.append(_Property(words[4], kind, count))
            elif words[:1] == ["property"]:
                elements[-1].properties.append(_Property(words[2], _PLY_TYPES[words[1]], None))
        except (KeyError, IndexError, ValueError):
            raise MeshFileError(f"{path}:{number}: '{line.strip()}' is no line of a PLY header.") from None
    if order == "?":
        raise MeshFileError(f"{path}: the header has no 'format'.")
    return order, elements, start, len(header)


def _ply_text(path: Path, data: bytes, elements: list[_Element], before: int) -> dict[str, Columns]:
    numbered = enumerate(data.decode("ascii", errors="replace").splitlines(), before + 1)
    lines = ((number, words) for number, line in numbered if (words := line.split()))
    columns: dict[str, Columns] = {}
    for element in elements:
        rows: Columns = {each.name: [] for each in element.properties}
        for row in range(element.rows):
            number, words = next(lines, (0, []))
            if not number:
                raise MeshFileError(f"{path}: ends at {element.name} {row} of {element.rows}.")
            at = 0
            for each in element.properties:
                count = 1
                if each.count_type:
                    count = int(_numbers(path, number, words[at:], 1)[0])
                    at += 1
                rows[each.name].append(np.array(_numbers(path, number, words[at:], count)))
                at += count
        columns[element.name] = rows
    return columns


def _ply_binary(path: Path, data: bytes, at: int, elements: list[_Element], order: str) -> dict[str, Columns]:
    columns: dict[str, Columns] = {}
    for element in elements:
        columns[element.name], at = _ply_rows(path, data, at, element, order)
    return columns


def _ply_rows(path: Path, data: bytes, at: int, element: _Element, order: str) -> tuple[Columns, int]:
    """Return the columns of an element, and where it ends, in pieces of rows whose lists are as long as the first's."""
    rows: Columns = {each.name: [] for each in element.properties}
    done = 0
    most = element.rows  # in the next piece: looking far ahead is for nothing where lengths change with every row
    while done < element.rows:
        layout, lengths, ahead = [], [], at
        for each in element.properties:
            length = 1
            if each.count_type:
                kind = np.dtype(order + each.count_type)
                length = int(np.frombuffer(_piece(path, data, ahead, kind.itemsize, element, done), kind)[0])
                if length < 0:
                    raise MeshFileError(f"{path}: {element.name} {done} has a list of negative length.")
                layout.append((f"n {each.name}", kind))
                ahead += kind.itemsize
            layout.append((each.name, np.dtype(order + each.type), (length,)))
            lengths.append(length)
            ahead += np.dtype(each.type).itemsize * length
        row = np.dtype(layout)
        _piece(path, data, at, row.itemsize, element, done)
        possible = min(most, element.rows - done, (len(data) - at) // max(row.itemsize, 1)) or 1
        table = np.frombuffer(data, row, possible, at)
        same = np.ones(possible, dtype=bool)
        for each, length in zip(element.properties, lengths):
            if each.count_type:
                same &= table[f"n {each.name}"] == length
        taken = possible if same.all() else int(same.argmin())
        for each in element.properties:
            rows[each.name] += list(table[each.name][:taken])
        at += taken * row.itemsize
        done += taken
        most = 2 * taken
    return rows, at


def _piece(path: Path, data: bytes, at: int, size: int, element: _Element, row: int) -> bytes:
    piece = data[at : at + size]
    if len(piece) < size:
        raise MeshFileError(f"{path}: ends at {element.name} {row} of {element.rows}.")
    return piece


def _mesh(
    positions: npt.ArrayLike, sizes: npt.ArrayLike, corners: npt.ArrayLike, uv: npt.NDArray[np.float64] | None
) -> MeshFile:
    offsets = np.concatenate([[0], np.cumsum(np.asarray(sizes, dtype=np.int64))]).astype(np.int64)
    vertices = np.asarray(positions, dtype=np.float64).reshape(-1, 3)
    return MeshFile(vertices, offsets, np.asarray(corners, dtype=np.int64), uv)
