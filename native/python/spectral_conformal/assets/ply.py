"""PLY files as rows: read the geometry, write UVs, and keep every other byte.

The format: Greg Turk, "The PLY Polygon File Format", 1994.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .._arguments import doubles
from .._distinct_rows import parts
from .._quality import face_triangles
from .._texture_size import DrawnTexture, TextureSize
from .._vertex_colors import NAME, VertexColors
from . import images, references
from .edits import Integers, edited, indices_of_copies, joined, numbered, pieces, ranges
from .mesh import (
    AssetError,
    AssetMesh,
    NoMeshError,
    OneMeshAsset,
    UvMap,
    check_end,
    check_text,
    checked,
    checked_corners,
    of_short_faces,
    offsets_of,
)
from .rows import BinaryReader, Column, Element, Property, Reader, Rows, TextReader
from .shared_textures import BASE_COLOR, Colors, SharedTextures

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
_FLOATS = ("f4", "f8")
# Of header lines.
_WITHOUT_MEANING = ("comment", "obj_info", "end_header")
_INDICES = ("vertex_indices", "vertex_index")
# Names of UVs: per corner in MeshLab; per vertex in Blender, MeshLab and others.
_TEXTURE = "texnumber"
_STRIPS = "tristrips"
_FACE_UV = ("texcoord", "texcoords")
# Colors per vertex, in the order of preference.
_COLORS = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))
_TEXTURE_FILE = (b"comment", b"TextureFile")
_VERTEX_UV = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))


class PlyAsset(OneMeshAsset):
    """A PLY file, text or binary; its map consists of the UVs of face corners or, without these, of vertices.

    It is processed in blocks of rows, once to read it and once to write it; of its rows, only the bytes are kept.
    """

    suffix = ".ply"

    def __init__(self, path: Path) -> None:
        """Read the file.

        Raises:
            AssetError: the content is broken, or there is no mesh.
            OSError: the file cannot be opened.
        """
        self.path = path
        self._data = path.read_bytes()
        self._texture = ""
        self.shared: SharedTextures | None = None
        """Textures that it reads instead of its own."""
        self.drawn_textures: list[DrawnTexture] = []
        """Textures that `files` drew last."""
        self._read_header()
        found = {element.name: element for element in self._elements}
        vertex, face = found.get("vertex"), found.get("face")
        missing = [name for name in "xyz" if not vertex or name not in vertex.properties]
        indices = face.first(_INDICES) if face else None
        self._face_uv = face.first(_FACE_UV) if face else None
        names = vertex.properties.keys() if vertex else ()
        self._vertex_uv = next((each for each in _VERTEX_UV if set(each) <= set(names)), None)
        positions, vertex_uv, sizes, corners, face_uv = [], [], [], [], []
        textures: set[float] = set()
        if not self._order:
            check_text(path, self._data)
        self._reader: Reader = (
            BinaryReader(path, self._data, self._order) if self._order else TextReader(path, self._data)
        )
        at = self._header_end
        for element in self._elements:
            element.start = element.end = at
            for rows in self._reader.rows(element):
                element.end = rows.end
                if element is vertex and not missing:
                    positions.append(rows.table("xyz"))
                    vertex_uv += [rows.table(self._vertex_uv)] if self._vertex_uv and not self._face_uv else []
                elif element is face and indices:
                    column = rows.columns[indices.name]
                    sizes.append(column.counts)
                    corners.append(column.values)
                    textures.update(
                        np.unique(rows.columns[_TEXTURE].values).tolist() if _TEXTURE in rows.columns else []
                    )
                    face_uv += [_of_corners(rows.columns[self._face_uv.name], column)] if self._face_uv else []
            at = element.end
        check_end(path, self._data[at:])
        if missing:
            raise AssetError(f"{path}: the element 'vertex' has no property '{missing[0]}'.")
        if face is None and _STRIPS in found:
            raise AssetError(f"{path}: its faces are triangle strips, which cannot be read: convert it to triangles.")
        if face is None:
            raise NoMeshError(f"{path}: has no element 'face', as a point cloud; there is nothing to unwrap.")
        if indices is None:
            raise AssetError(f"{path}: there is no element 'face' with a list 'vertex_indices'.")
        self._vertex, self._face, self._indices = vertex, face, indices
        vertices = joined(positions, np.zeros((0, 3)))
        offsets = offsets_of(joined(sizes, np.zeros(0, np.int64)))
        corner_vertices = checked_corners(
            lambda face: f"{path}: face {face}", offsets, joined(corners, np.zeros(0, np.int64)), len(vertices)
        )
        uv = None
        if self._face_uv:
            uv = joined(face_uv, np.zeros((0, 2)))
        elif self._vertex_uv:
            uv = joined(vertex_uv, np.zeros((0, 2)))[corner_vertices]
        self._offsets, self._corners, self._is_face = offsets, corner_vertices, np.diff(offsets) >= 3
        if not self._is_face.all():
            chosen = np.repeat(self._is_face, np.diff(offsets))
            offsets, corner_vertices = offsets_of(np.diff(offsets)[self._is_face]), corner_vertices[chosen]
            uv = None if uv is None else uv[chosen]
        self.mesh = checked(path, AssetMesh(vertices, offsets, corner_vertices, uv))
        self.warnings = [f"'{line}' in the header is unknown, and was left." for line in self._unknown]
        self.warnings += of_short_faces(int((~self._is_face).sum()), "no UVs for them")
        if len(textures) > 1:
            self.warnings += [
                f"The faces keep their {len(textures)} textures ({_TEXTURE}), but the map has one tile for all."
            ]

    # Reading

    def _read_header(self) -> None:
        data = self._data
        if data[:3].lower() != b"ply":
            raise AssetError(f"{self.path}:1: a PLY file begins with 'ply'.")
        end = data.find(b"end_header")
        if end < 0:
            raise AssetError(f"{self.path}: the header has no 'end_header'.")
        self._header_end = data.find(b"\n", end) + 1 or len(data)
        self._header = data[: self._header_end].splitlines(keepends=True)
        self._order: str | None = "?"
        self._unknown: list[str] = []
        self._elements: list[Element] = []
        for number, line in enumerate(self._header[1:], 1):
            words = line.decode("ascii", errors="replace").split()
            try:
                if words[:1] == ["format"]:
                    self._order = _ORDERS[words[1]]
                elif words[:1] == ["element"]:
                    self._elements.append(Element(words[1], int(words[2]), number, {}))
                elif words[:2] == ["property", "list"]:
                    new = Property(words[4], _TYPES[words[3]], _TYPES[words[2]], number)
                    if new.count_type in _FLOATS:
                        raise ValueError
                    self._elements[-1].properties[new.name] = new
                elif words[:1] == ["property"]:
                    new = Property(words[2], _TYPES[words[1]], None, number)
                    self._elements[-1].properties[new.name] = new
                elif words and words[0] not in _WITHOUT_MEANING:
                    # A line before all elements describes no rows; the effect of others is unknown.
                    if self._elements:
                        raise ValueError
                    self._unknown.append(" ".join(words))
            except (KeyError, IndexError, ValueError):
                line = " ".join(words)
                raise AssetError(f"{self.path}:{number + 1}: '{line}' is not a line of a PLY header.") from None
        if self._order == "?":
            raise AssetError(f"{self.path}: the header has no 'format'.")

    def references(self) -> Iterator[str]:
        """Yield the textures that MeshLab names in comments."""
        for line in self._header:
            words = line.split(None, 2)
            if tuple(words[:2]) == _TEXTURE_FILE and len(words) == 3:
                yield os.fsdecode(words[2].strip())

    # Writing

    def files(
        self, out: Path, maps: Sequence[UvMap], textures: TextureSize | None = None
    ) -> Mapping[Path, Iterable[bytes]]:
        """Return the file with a new UV map, by its path.

        With `textures` that include colors, a file without a texture gets one of its vertex colors, by
        the name that MeshLab reads.
        """
        self._texture, self.drawn_textures = "", []
        others: dict[Path, Iterable[bytes]] = {}
        drawn = self.shared.find(BASE_COLOR) if self.shared else None
        colors = self._colors(maps[0]) if textures and textures.colors and not [*self.references()] else None
        if colors and drawn:
            self._texture, self.drawn_textures = drawn.name_from(out.parent), [drawn.record]
        elif colors:
            baked = colors.drawn(textures)
            path = references.free_beside(out, f"{out.stem}_{NAME}.png", self.path, ())
            others[path], self._texture = [images.written(baked.image, ".png")], path.name
            self.drawn_textures = [DrawnTexture.of(NAME, baked)]
        return {**others, **super().files(out, maps)}

    def share(self, out: Path, maps: Sequence[UvMap], textures: TextureSize, shared: SharedTextures) -> None:  # noqa: ARG002 - as for other formats
        """Add its vertex colors to the textures that assets share; `files` with the same arguments then names these."""
        self.shared = shared
        colors = self._colors(maps[0]) if textures.colors and not [*self.references()] else None
        if colors:
            shared.add(BASE_COLOR, Colors(colors), NAME, lambda _: None)

    def _colors(self, uv_map: UvMap) -> VertexColors | None:
        """Return the vertex colors; None if there are none."""
        properties, mesh = self._vertex.properties, self.mesh
        names = next((each for each in _COLORS if set(each) <= properties.keys()), None)
        if names is None:
            return None
        kinds = [np.dtype(properties[name].type) for name in names]
        highest = [np.iinfo(kind).max if kind.kind in "iu" else 1.0 for kind in kinds]
        values = np.concatenate([rows.table(names) for rows in self._reader.rows(self._vertex)])
        corners, _ = face_triangles(
            mesh.vertices, mesh.face_offsets, mesh.corner_vertices, selected_faces=uv_map.mapped
        )
        # Programs store and mix them as they are shown.
        colors = VertexColors("data")
        colors.add((values / highest)[mesh.corner_vertices], uv_map.uv, corners)
        return colors or None

    def with_uv(self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> Iterator[bytes]:
        """Yield the file with a new UV map.

        If the file has UVs of face corners, they are replaced. Otherwise the UVs are stored per vertex, which most
        programs can read: a vertex with several UVs gets copies of its whole row at the end.

        Args:
            uv: (C, 2).
            mapped: (faces,) a face without a map gets an empty list, or any UV of its vertices at its corners.
        """
        if not self._is_face.all():
            # Rows of the file that are no faces.
            chosen = np.repeat(self._is_face, np.diff(self._offsets))
            of_rows, is_mapped = np.zeros((len(chosen), 2)), self._is_face.copy()
            of_rows[chosen], is_mapped[self._is_face] = uv, mapped
            uv, mapped = of_rows, is_mapped
        changes = _Changes(self._header)
        if self._texture:
            line = next(number for number, text in enumerate(self._header) if text.split()[:1] == [b"format"])
            text = self._header[line].decode("ascii", errors="replace").rstrip()
            changes.set_line(line, f"{text}\n{b' '.join(_TEXTURE_FILE).decode()} {self._texture}")
        if self._face_uv:
            edits = {id(self._face): self._with_face_uv(uv, mapped, changes)}
        else:
            edits = self._with_vertex_uv(uv, mapped, changes)
        yield b"".join(changes.header)
        for element in self._elements:
            yield from edits.get(id(element)) or pieces(self._data, element.start, element.end)
        end = self._elements[-1].end if self._elements else self._header_end
        yield from pieces(self._data, end, len(self._data))

    def _with_face_uv(
        self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_], changes: _Changes
    ) -> Iterator[bytes]:
        """Return the rows of the faces with new UVs; the header's changes are complete at once."""
        sizes = np.diff(self._offsets)
        counts = np.where(mapped, 2 * sizes, 0)
        chosen = slice(None) if mapped.all() else np.repeat(mapped, sizes)
        return self._replaced_lists(self._face_uv, counts, uv[chosen].reshape(-1), _real(self._face_uv.type), changes)

    def _with_vertex_uv(
        self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_], changes: _Changes
    ) -> dict[int, Iterator[bytes]]:
        """Return the rows of the elements that change, by their identities."""
        corners, n_vertices = self._corners, len(self.mesh.vertices)
        corner_mapped = None if mapped.all() else np.repeat(mapped, np.diff(self._offsets))
        first, number = numbered(corners, uv, corner_mapped)
        vertices, different = corners[first], uv[first]
        is_copy, indices = indices_of_copies(vertices, n_vertices)
        of_vertices = np.zeros((n_vertices, 2))
        # Of several values for one index, the last one stays.
        of_vertices[vertices[::-1]] = different[::-1]
        last_column = [*self._vertex.properties.values()][-1]
        if not self._vertex_uv:
            kind = _real(self._vertex.properties["x"].type)
            line = self._header[last_column.line].decode("ascii", errors="replace").rstrip()
            free = [names for names in _VERTEX_UV if not set(names) & self._vertex.properties.keys()]
            if not free:
                raise AssetError(f"{self.path}: the vertices already use all property names for UVs; rename one.")
            new_lines = "".join(f"\nproperty {_NAMES[kind]} {name}" for name in free[0])
            changes.set_line(last_column.line, line + new_lines)
        for name in self._vertex_uv or ():
            column = self._vertex.properties[name]
            if column.type not in _FLOATS:
                changes.set_line(column.line, f"property {_NAMES[_real(column.type)]} {name}")
        n_copies = int(is_copy.sum())
        changes.set_line(self._vertex.line, f"element vertex {n_vertices + n_copies}")
        result = {id(self._vertex): self._vertex_rows(of_vertices, vertices[is_copy], different[is_copy])}
        if n_copies:
            for part in parts(len(corners)):
                number[part] = np.where(number[part] >= 0, indices[number[part]], corners[part])
            sizes = np.diff(self._offsets)
            kind = self._indices.type
            if kind not in _FLOATS:
                kind = _wide_enough(kind, int(number.max(initial=0)))
            result[id(self._face)] = self._replaced_lists(self._indices, sizes, number, kind, changes)
        return result

    def _vertex_rows(
        self, uv: npt.NDArray[np.float64], copied: Integers, uv_of_copies: npt.NDArray[np.float64]
    ) -> Iterator[bytes]:
        """Yield the rows of the vertices with UVs, (V, 2), and behind them copies of some rows with other UVs."""
        line_end = b"" if self._order else _line_end(self._header[-1])
        copies = [b""] * len(copied)
        by_vertex = np.argsort(copied, kind="stable")
        for rows in self._reader.rows(self._vertex):
            last = rows.first + len(rows)
            places, texts = self._uv_edits(rows, np.arange(len(rows)), uv[rows.first : last])
            chosen = by_vertex[slice(*np.searchsorted(copied[by_vertex], [rows.first, last]))]
            own = copied[chosen] - rows.first
            columns = [*rows.columns.values()]
            copy_places, copy_texts = self._uv_edits(rows, own, uv_of_copies[chosen])
            n_parts = len(copy_places) // max(len(own), 1)
            spans = zip(columns[0].starts[own].tolist(), columns[-1].ends[own].tolist())
            for k, (start, end) in enumerate(spans):
                part = slice(k * n_parts, (k + 1) * n_parts)
                text = edited(self._data, start, end, copy_places[part], copy_texts[part])
                copies[int(chosen[k])] = line_end + text
            if last == self._vertex.rows:
                end = columns[-1].ends[-1]
                places, texts = np.concatenate([places, [[end, end]]]), [*texts, b"".join(copies)]
            yield edited(self._data, rows.start, rows.end, places, texts)

    def _uv_edits(self, rows: Rows, chosen: Integers, uv: npt.NDArray[np.float64]) -> tuple[Integers, list[bytes]]:
        """Return the places, (n, 2), and texts that give the chosen rows their UVs, row by row."""
        if self._vertex_uv:
            columns = [(rows.columns[name], _real(self._vertex.properties[name].type)) for name in self._vertex_uv]
            places = [np.column_stack([column.starts[chosen], column.ends[chosen]]) for column, _ in columns]
            texts = [self._rendered(values, kind) for values, (_, kind) in zip(uv.T, columns)]
            return np.stack(places, axis=1).reshape(-1, 2), [text for pair in zip(*texts) for text in pair]
        ends = [*rows.columns.values()][-1].ends[chosen]
        texts = self._rendered(uv.reshape(-1), _real(self._vertex.properties["x"].type))
        blank = b"" if self._order else b" "
        both = [blank + u + blank + v for u, v in zip(texts[::2], texts[1::2])]
        return np.column_stack([ends, ends]), both

    def _replaced_lists(
        self, column: Property, counts: Integers, values: npt.NDArray, kind: str, changes: _Changes
    ) -> Iterator[bytes]:
        """Return the rows of the faces with other lists, with a wider type of their lengths if it is too narrow.

        Args:
            column: the lists.
            counts: (faces,) their new lengths.
            values: (sum of counts,)
            kind: the type to store them as.
            changes: of the header, made before the first row is yielded.
        """
        count_type = _wide_enough(column.count_type, int(counts.max(initial=0)))
        is_wider = (count_type, kind) != (column.count_type, column.type)
        if is_wider:
            changes.set_line(column.line, f"property list {_NAMES[count_type]} {_NAMES[kind]} {column.name}")

        def rows_with_lists() -> Iterator[bytes]:
            first = 0
            for rows in self._reader.rows(self._face):
                new_counts = counts[rows.first : rows.first + len(rows)]
                new = values[first : first + int(new_counts.sum())]
                first += len(new)
                old = rows.columns[column.name]
                changed = np.flatnonzero(is_wider | _different(old, new_counts, new))
                places = np.column_stack([old.starts[changed], old.ends[changed]])
                texts = self._lists(changed, new_counts, new, count_type, kind)
                yield edited(self._data, rows.start, rows.end, places, texts)

        return rows_with_lists()

    def _lists(
        self, chosen: Integers, counts: Integers, values: npt.NDArray, count_type: str, kind: str
    ) -> list[bytes]:
        """Return the chosen ones of lists in the encoding of this file."""
        first = (np.cumsum(counts) - counts)[chosen]
        own = counts[chosen]
        words = self._rendered(values[ranges(first, own)], kind)
        ends = np.cumsum(own).tolist()
        blank = b"" if self._order else b" "
        heads = self._rendered(own, count_type)
        return [blank.join([head, *words[begin:end]]) for head, begin, end in zip(heads, [0, *ends], ends)]

    def _rendered(self, values: npt.NDArray, kind: str) -> list[bytes]:
        """Return each number in the encoding of this file."""
        stored = values.astype((self._order or "") + kind)
        if self._order:
            content, size = stored.tobytes(), stored.itemsize
            return [content[at : at + size] for at in range(0, len(content), size)]
        # Single precision has fewer digits.
        return [str(value).encode() for value in (stored if kind == "f4" else stored.tolist())]


class _Changes:
    """New lines of the header."""

    def __init__(self, header: Sequence[bytes]) -> None:
        self.header = list(header)

    def set_line(self, number: int, text: str) -> None:
        """Replace a line of the header; the new text may have several lines."""
        line_end = _line_end(self.header[number])
        self.header[number] = text.encode().replace(b"\n", line_end) + line_end


def _line_end(line: bytes) -> bytes:
    return line[len(line.rstrip(b"\r\n")) :]


def _of_corners(uv: Column, indices: Column) -> npt.NDArray[np.float64]:
    """Return the UV of each corner, (C, 2), NaN for faces whose list has another length, such as an empty one."""
    result = np.full((int(indices.counts.sum()), 2), np.nan)
    fits = uv.counts == 2 * indices.counts
    result[np.repeat(fits, indices.counts)] = doubles(uv.values[np.repeat(fits, uv.counts)]).reshape(-1, 2)
    return result


def _different(old: Column, counts: Integers, values: npt.NDArray) -> npt.NDArray[np.bool_]:
    """Return which lists, (n,), differ from the old ones."""
    result = old.counts != counts
    same = np.repeat(~result, counts)
    row = np.repeat(np.arange(len(counts)), counts)[same]
    result[row[values[same] != doubles(old.values[np.repeat(~result, old.counts)])]] = True
    return result


def _real(kind: str) -> str:
    """Return a type for UVs: the given one if possible."""
    return kind if kind in _FLOATS else _FLOATS[0]


def _wide_enough(kind: str, largest: int) -> str:
    """Return a type that holds this number: the given one if possible."""
    return kind if largest <= np.iinfo(kind).max else "i4"
