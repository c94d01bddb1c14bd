"""PLY files as rows: read the geometry, write UVs, and keep every other byte.

The format: Greg Turk, "The PLY Polygon File Format", 1994.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .edits import Integers, edited, indices_of_copies, numbered
from .mesh import AssetError, AssetMesh, OneMeshAsset, check_face, checked, numbers, offsets_of

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_NAMES = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
    "f4": "float",
    "f8": "double",
}
_ORDERS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}
# Of header lines; the effect of any other on the rows is unknown.
_WITHOUT_MEANING = ("ply", "comment", "obj_info", "end_header")
_INDICES = ("vertex_indices", "vertex_index")
# Names of UVs: per corner in MeshLab; per vertex in Blender, MeshLab and others.
_FACE_UV = ("texcoord", "texcoords")
_VERTEX_UV = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))
_WORD = re.compile(rb"\S+")


@dataclass
class _Property:
    """A property of each row of an element; a list stores its length before its values."""

    name: str
    type: str
    count_type: str | None
    """Of a list: the type of its length."""
    line: int
    """In the header, from 0."""
    values: list[npt.NDArray] = field(default_factory=list)
    starts: list[int] = field(default_factory=list)
    ends: list[int] = field(default_factory=list)


@dataclass
class _Element:
    name: str
    rows: int
    line: int
    """In the header, from 0."""
    properties: dict[str, _Property]

    def first(self, names: Sequence[str]) -> _Property | None:
        """Return the first of these properties that exists."""
        return next((self.properties[name] for name in names if name in self.properties), None)


class PlyAsset(OneMeshAsset):
    """A PLY file, text or binary; its map consists of the UVs of face corners or, without these, of vertices."""

    suffix = ".ply"

    def __init__(self, path: Path) -> None:
        """Read the file.

        Raises:
            AssetError: the content is broken, or there is no mesh.
            OSError: the file cannot be opened.
        """
        self.path = path
        self._data = path.read_bytes()
        self._read_header()
        at = self._header_end
        for element in self._elements:
            at = self._read_text(element, at) if self._order is None else self._read_binary(element, at)
        found = {element.name: element for element in self._elements}
        vertex, face = found.get("vertex"), found.get("face")
        missing = [name for name in "xyz" if not vertex or name not in vertex.properties]
        if missing:
            raise AssetError(f"{path}: the element 'vertex' has no property '{missing[0]}'.")
        indices = face.first(_INDICES) if face else None
        if indices is None:
            raise AssetError(f"{path}: there is no element 'face' with a list 'vertex_indices'.")
        self._vertex, self._indices = vertex, indices
        positions = _table(vertex, "xyz")
        sizes = np.array([len(row) for row in indices.values], dtype=np.int64)
        corners = np.concatenate([np.zeros(0, np.int64), *indices.values]).astype(np.int64)
        offsets = offsets_of(sizes)
        bad = np.flatnonzero((corners < 0) | (corners >= len(positions)))
        if (sizes < 3).any() or len(bad):
            number = (sizes < 3).argmax() if (sizes < 3).any() else np.searchsorted(offsets, bad[0], side="right") - 1
            check_face(f"{path}: face {number}", indices.values[number].astype(np.int64).tolist(), len(positions))
        self._face_uv = face.first(_FACE_UV)
        self._vertex_uv = next((names for names in _VERTEX_UV if set(names) <= vertex.properties.keys()), None)
        self.mesh = checked(path, AssetMesh(positions, offsets, corners, self._map(corners, offsets)))

    def _map(self, corners: Integers, offsets: Integers) -> npt.NDArray[np.float64] | None:
        if self._face_uv:
            uv = np.full((len(corners), 2), np.nan)
            for first, last, row in zip(offsets[:-1].tolist(), offsets[1:].tolist(), self._face_uv.values):
                # Others, such as an empty list, belong to faces without a map.
                if len(row) == 2 * (last - first):
                    uv[first:last] = np.reshape(row, (-1, 2))
            return uv
        return _table(self._vertex, self._vertex_uv)[corners] if self._vertex_uv else None

    # Reading

    def _read_header(self) -> None:
        data = self._data
        if data[:3] != b"ply":
            raise AssetError(f"{self.path}:1: a PLY file begins with 'ply'.")
        end = data.find(b"end_header")
        if end < 0:
            raise AssetError(f"{self.path}: the header has no 'end_header'.")
        self._header_end = data.find(b"\n", end) + 1 or len(data)
        self._header = data[: self._header_end].splitlines(keepends=True)
        self._order: str | None = "?"
        self._elements: list[_Element] = []
        for number, line in enumerate(self._header):
            words = line.decode("ascii", errors="replace").split()
            try:
                if words[:1] == ["format"]:
                    self._order = _ORDERS[words[1]]
                elif words[:1] == ["element"]:
                    self._elements.append(_Element(words[1], int(words[2]), number, {}))
                elif words[:2] == ["property", "list"]:
                    new = _Property(words[4], _TYPES[words[3]], _TYPES[words[2]], number)
                    self._elements[-1].properties[new.name] = new
                elif words[:1] == ["property"]:
                    new = _Property(words[2], _TYPES[words[1]], None, number)
                    self._elements[-1].properties[new.name] = new
                elif words and words[0] not in _WITHOUT_MEANING:
                    raise ValueError
            except (KeyError, IndexError, ValueError):
                line = " ".join(words)
                raise AssetError(f"{self.path}:{number + 1}: '{line}' is not a line of a PLY header.") from None
        if self._order == "?":
            raise AssetError(f"{self.path}: the header has no 'format'.")

    def _read_text(self, element: _Element, at: int) -> int:
        for row in range(element.rows):
            while True:
                end = self._data.find(b"\n", at)
                end = len(self._data) if end < 0 else end
                spans = [found.span() for found in _WORD.finditer(self._data, at, end)]
                if spans or end == len(self._data):
                    break
                at = end + 1
            if not spans:
                raise AssetError(f"{self.path}: ends at {element.name} {row} of {element.rows}.")
            words = [self._data[first:last].decode("ascii", errors="replace") for first, last in spans]
            place = 0
            for each in element.properties.values():
                first, count = place, 1
                if each.count_type:
                    count = int(self._row_numbers(at, words[place:], 1)[0])
                    place += 1
                values = self._row_numbers(at, words[place:], count)
                place += count
                each.values.append(np.array(values))
                each.starts.append(spans[first][0])
                each.ends.append(spans[place - 1][1])
            at = end + 1
        return min(at, len(self._data))

    def _row_numbers(self, at: int, words: list[str], count: int) -> list[float]:
        try:
            return numbers("", words, count)
        except AssetError:
            line = self._data.count(b"\n", 0, at) + 1
            return numbers(f"{self.path}:{line}", words, count)

    def _read_binary(self, element: _Element, at: int) -> int:
        """Read the rows of an element in runs whose lists are as long as those of the run's first row."""
        done = 0
        most = element.rows  # in the next run: looking far ahead is a waste if lengths change with every row
        while done < element.rows:
            layout = self._layout(element, at, done)
            self._piece(at, layout.itemsize, element, done)
            possible = min(most, element.rows - done, (len(self._data) - at) // max(layout.itemsize, 1)) or 1
            table = np.frombuffer(self._data, layout, possible, at)
            same = np.ones(possible, dtype=bool)
            for each in element.properties.values():
                if each.count_type:
                    same &= table[f"n {each.name}"] == table[f"n {each.name}"][0]
            taken = possible if same.all() else int(same.argmin())
            begins = at + layout.itemsize * np.arange(taken)
            for each in element.properties.values():
                kind, place = layout.fields[each.name]
                each.values += list(table[each.name][:taken])
                each.starts += (begins + layout.fields[f"n {each.name}" if each.count_type else each.name][1]).tolist()
                each.ends += (begins + place + kind.itemsize).tolist()
            at += taken * layout.itemsize
            done += taken
            most = 2 * taken
        return at

    def _layout(self, element: _Element, at: int, row: int) -> np.dtype:
        """Return the layout of the row that begins here."""
        layout = []
        for each in element.properties.values():
            length = 1
            if each.count_type:
                kind = np.dtype(self._order + each.count_type)
                length = int(np.frombuffer(self._piece(at, kind.itemsize, element, row), kind)[0])
                if length < 0:
                    raise AssetError(f"{self.path}: {element.name} {row} has a list of negative length.")
                layout.append((f"n {each.name}", kind))
                at += kind.itemsize
                # Checked before making a type of this size.
                self._piece(at, length * np.dtype(each.type).itemsize, element, row)
            layout.append((each.name, np.dtype(self._order + each.type), (length,)))
            at += np.dtype(each.type).itemsize * length
        return np.dtype(layout)

    def _piece(self, at: int, size: int, element: _Element, row: int) -> bytes:
        piece = self._data[at : at + size]
        if len(piece) < size:
            raise AssetError(f"{self.path}: ends at {element.name} {row} of {element.rows}.")
        return piece

    def references(self) -> Iterator[str]:
        """Yield the textures that MeshLab names in comments."""
        for line in self._header:
            words = line.split(None, 2)
            if words[:2] == [b"comment", b"TextureFile"] and len(words) == 3:
                yield os.fsdecode(words[2].strip())

    # Writing

    def with_uv(self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> bytes:
        """Return the file with a new UV map.

        If the file has UVs of face corners, they are replaced. Otherwise the UVs are stored per vertex, which most
        programs can read: a vertex with several UVs gets copies of its whole row at the end.

        Args:
            uv: (C, 2).
            mapped: (faces,) a face without a map gets an empty list, or any UV of its vertices at its corners.
        """
        if self._face_uv:
            return self._with_face_uv(uv, mapped)
        return self._with_vertex_uv(uv, np.repeat(mapped, np.diff(self.mesh.face_offsets)))

    def _with_face_uv(self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> bytes:
        bounds = zip(self.mesh.face_offsets[:-1].tolist(), self.mesh.face_offsets[1:].tolist(), mapped.tolist())
        rows = [uv[first:last].ravel() if has_map else np.zeros(0) for first, last, has_map in bounds]
        changes = _Changes(self._header)
        self._replace_lists(self._face_uv, rows, changes)
        return changes.applied(self._data)

    def _with_vertex_uv(self, uv: npt.NDArray[np.float64], corner_mapped: npt.NDArray[np.bool_]) -> bytes:
        corners, n_vertices = self.mesh.corner_vertices, len(self.mesh.vertices)
        vertices, different, index = numbered(corners[corner_mapped], uv[corner_mapped])
        is_copy, indices = indices_of_copies(vertices, n_vertices)
        of_vertices = np.zeros((n_vertices, 2))
        of_vertices[vertices[~is_copy]] = different[~is_copy]
        changes = _Changes(self._header)
        kind = self._vertex.properties["x"].type
        first_column, *_, last_column = self._vertex.properties.values()
        starts, ends = first_column.starts, last_column.ends
        if self._vertex_uv:
            columns = [self._vertex.properties[name] for name in self._vertex_uv]
            for each, values in zip(columns, of_vertices.T):
                for start, end, value in zip(each.starts, each.ends, values):
                    changes.replace(start, end, self._rendered([value], each.type))
        else:
            columns = []
            for end, row in zip(ends, of_vertices):
                changes.replace(end, end, self._blank() + self._rendered(row, kind))
            line = self._header[last_column.line].decode("ascii", errors="replace").rstrip()
            free = [names for names in _VERTEX_UV if not set(names) & self._vertex.properties.keys()]
            if not free:
                raise AssetError(f"{self.path}: the vertices already use all property names for UVs; rename one.")
            new_lines = "".join(f"\nproperty {_NAMES[kind]} {name}" for name in free[0])
            changes.set_line(last_column.line, line + new_lines)
        copies = []
        for vertex, row in zip(vertices[is_copy].tolist(), different[is_copy]):
            old = _Changes([])
            for each, value in zip(columns, row):
                old.replace(each.starts[vertex] - starts[vertex], each.ends[vertex] - starts[vertex],
                            self._rendered([value], each.type))  # fmt: skip
            text = old.applied(self._data[starts[vertex] : ends[vertex]])
            copies.append(text if columns else text + self._blank() + self._rendered(row, kind))
        line_end = b"" if self._order else _line_end(self._header[-1])
        changes.replace(ends[-1], ends[-1], b"".join(line_end + text for text in copies))
        changes.set_line(self._vertex.line, f"element vertex {n_vertices + len(copies)}")
        new_corners = corners.copy()
        new_corners[corner_mapped] = indices[index]
        if len(copies):
            self._replace_lists(self._indices, np.split(new_corners, self.mesh.face_offsets[1:-1]), changes)
        return changes.applied(self._data)

    def _replace_lists(self, column: _Property, rows: Sequence[npt.NDArray], changes: _Changes) -> None:
        """Replace lists, with wider types if the current ones are too narrow."""
        count_type = _wide_enough(column.count_type, max(map(len, rows), default=0))
        kind = column.type
        if kind[0] != "f":
            kind = _wide_enough(kind, max((int(row.max()) for row in rows if len(row)), default=0))
        if (count_type, kind) != (column.count_type, column.type):
            changes.set_line(column.line, f"property list {_NAMES[count_type]} {_NAMES[kind]} {column.name}")
        for start, end, row, old in zip(column.starts, column.ends, rows, column.values):
            if len(row) == len(old) and (row == old).all() and kind == column.type and count_type == column.count_type:
                continue
            count = self._rendered([len(row)], count_type)
            changes.replace(start, end, count + (self._blank() + self._rendered(row, kind) if len(row) else b""))

    def _rendered(self, values: Iterable[float], kind: str) -> bytes:
        """Return numbers in the encoding of this file."""
        numbers_of_kind = np.array(values).astype((self._order or "") + kind)
        return numbers_of_kind.tobytes() if self._order else " ".join(map(str, numbers_of_kind)).encode()

    def _blank(self) -> bytes:
        return b"" if self._order else b" "


class _Changes:
    """Replacements for parts of the rows and for lines of the header."""

    def __init__(self, header: Sequence[bytes]) -> None:
        self._start = sum(map(len, header))
        self.header = list(header)
        self._starts: list[int] = []
        self._ends: list[int] = []
        self._texts: list[bytes] = []

    def replace(self, start: int, end: int, text: bytes) -> None:
        self._starts.append(start)
        self._ends.append(end)
        self._texts.append(text)

    def set_line(self, number: int, text: str) -> None:
        """Replace a line of the header; the new text may have several lines."""
        line_end = _line_end(self.header[number])
        self.header[number] = text.encode().replace(b"\n", line_end) + line_end

    def applied(self, data: bytes) -> bytes:
        starts, ends = (np.array(each, dtype=np.int64) for each in (self._starts, self._ends))
        body = edited(data[self._start :], starts - self._start, ends - self._start, self._texts)
        return b"".join(self.header) + body


def _line_end(line: bytes) -> bytes:
    return line[len(line.rstrip(b"\r\n")) :]


def _table(element: _Element, names: Iterable[str]) -> npt.NDArray[np.float64]:
    columns = [np.array(element.properties[name].values, dtype=np.float64).ravel() for name in names]
    return np.stack(columns, axis=1)


def _wide_enough(kind: str, largest: int) -> str:
    """Return a type that holds this number: the given one if possible."""
    return kind if largest <= np.iinfo(kind).max else "i4"
