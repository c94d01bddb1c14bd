"""OBJ files as lines: read the geometry, write UVs, and keep every other byte.

The format: Wavefront's "Object Files (.obj)", appendix B1 of the Advanced Visualizer's manual.
"""

from __future__ import annotations

import functools
import os
import re
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
import numpy.typing as npt

from . import references
from .edits import Integers, edited, numbered
from .mesh import AssetError, AssetMesh, OneMeshAsset, UvMap, checked, offsets_of

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_LIBRARY = re.compile(rb"^([ \t]*mtllib[ \t]+)([^\r\n]+)", re.MULTILINE)
_CONTINUATION = re.compile(rb"\\[ \t\r]*\n")
_BLANK = np.zeros(256, dtype=bool)
_BLANK[list(b" \t\r\n\v\f")] = True
_SLASH_TO_BLANK = bytes.maketrans(b"/", b" ")
_OTHER, _POSITION, _UV, _FACE, _REFERRER, _OBJECT, _MATERIAL = range(7)
_KINDS = {
    **{b"v": _POSITION, b"vt": _UV, b"f": _FACE, b"l": _REFERRER, b"surf": _REFERRER},
    **{b"o": _OBJECT, b"usemtl": _MATERIAL},
}
# Separated by slashes, a corner's number 0 is its vertex, number 1 its UV: 1, 1/2, 1//3, 1/2/3.
_FORMS = {(0, False): (0,), (1, False): (0, 1), (2, True): (0, 2), (2, False): (0, 1, 2)}


class ObjAsset(OneMeshAsset):
    """An OBJ file: the bytes of its statements, and its polygons."""

    suffix = ".obj"

    def __init__(self, path: Path) -> None:
        """Read the file.

        Raises:
            AssetError: a line is broken, or there is no mesh.
            OSError: the file cannot be opened.
        """
        self.path = path
        self._data = path.read_bytes()
        self._beside: list[str] = []
        self._newline = b"\r\n" if b"\r\n" in self._data else b"\n" if b"\n" in self._data else b"\r"
        self._find_statements()
        self._find_words()
        positions = self._table(_POSITION, 3)[:, :3]
        uv = self._table(_UV, 1)
        # A texture of one dimension has no v.
        self._uv = np.c_[uv, np.zeros(len(uv))][:, :2]
        self._faces = self._lines_of(_FACE)
        sizes = np.diff(self._first_words)[self._faces] - 1
        if (sizes < 3).any():
            raise self._broken(self._faces[(sizes < 3).argmax()], "a face needs at least three corners")
        self._corner_words = _ranges(self._first_words[self._faces] + 1, sizes)
        corners, corner_uv = self._corners(np.repeat(self._faces, sizes), len(positions))
        has_map = corner_uv.max(initial=-1) >= 0
        found = np.vstack([self._uv, [[np.nan, np.nan]]])[corner_uv] if has_map else None
        material = self._materials()
        self.mesh = checked(
            path,
            AssetMesh(positions, offsets_of(sizes), corners, found, material_of_face=material, **self._objects()),
        )

    def _objects(self) -> dict[str, Any]:
        """Return the objects of the mesh as the parts of an `AssetMesh`; none for a file with fewer than two."""
        lines = self._lines_of(_OBJECT)
        if len(lines) < 2:
            return {}
        parts = tuple(name.decode("utf-8", errors="replace") for name in self._names(lines))
        return {"parts": parts, "part_of_face": np.searchsorted(lines, self._faces, side="right") - 1}

    def _materials(self) -> npt.NDArray[np.int64] | None:
        """Return the material of every face, `AssetMesh.material_of_face`."""
        lines = self._lines_of(_MATERIAL)
        if len(lines) == 0:
            return None
        numbers: dict[bytes, int] = {}
        of_line = np.array([numbers.setdefault(name, len(numbers)) for name in self._names(lines)], dtype=np.int64)
        line = np.searchsorted(lines, self._faces, side="right") - 1
        found = np.where(line < 0, -1, of_line[line])
        return found if (found != found[:1]).any() else None

    def _names(self, lines: Integers) -> list[bytes]:
        """Return what follows the keyword in each of the lines."""
        spans = zip(self._starts[lines].tolist(), self._ends[lines].tolist())
        return [b"".join(self._data[start:end].split(maxsplit=1)[1:]).strip() for start, end in spans]

    def with_uv(self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> bytes:
        """Return the file with a new UV map.

        Args:
            uv: (C, 2), written with all digits.
            mapped: (faces,) faces without a map get no UVs.
        """
        corner_mapped = np.repeat(mapped, np.diff(self.mesh.face_offsets))
        _, different, index = numbered(self.mesh.corner_vertices[corner_mapped], uv[corner_mapped])
        first_face = self._faces[0]
        lines_of_uv = self._lines_of(_UV)
        referring, referred = self._uses_of_uv()
        before = 0
        if len(referring):
            # Other statements that refer to UVs keep theirs.
            before = int(np.searchsorted(lines_of_uv, first_face))
            referred = np.where(referred < before, referred, referred + len(different))
            lines_of_uv = lines_of_uv[:0]
        numbers = np.zeros(len(uv), dtype=np.int64)
        numbers[corner_mapped] = before + 1 + index
        words = np.append(self._corner_words, referring)
        numbers = np.append(numbers, referred + 1)
        starts, ends, is_last = self._uv_parts(words)
        texts = [
            b"/%d" % number if number else b"" if last else b"/"
            for number, last in zip(numbers.tolist(), is_last.tolist())
        ]
        texts += [b""] * len(lines_of_uv)
        texts.append(b"".join(b"vt %r %r%s" % (u, v, self._newline) for u, v in different.tolist()))
        starts = np.concatenate([starts, self._starts[lines_of_uv], [self._starts[first_face]]])
        ends = np.concatenate([ends, np.append(self._starts, len(self._data))[lines_of_uv + 1], starts[-1:]])
        return edited(self._data, starts, ends, texts)

    def files(self, out: Path, maps: Sequence[UvMap]) -> dict[Path, bytes]:
        """Return the file with a new UV map; paths to materials above its folder are adapted to the new folder."""
        self._beside = []
        named = functools.partial(self._named, out=out)
        return {path: _LIBRARY.sub(named, content) for path, content in super().files(out, maps).items()}

    def _named(self, found: re.Match[bytes], out: Path) -> bytes:
        rest = os.fsdecode(found[2].strip())
        new = references.elsewhere(rest, self.path, out)
        if new != rest:
            return found[1] + os.fsencode(new)
        self._beside += [rest] if (self.path.parent / rest).is_file() else rest.split()
        return found[0]

    def references(self) -> Iterator[str]:
        """Yield the material files, and the textures that these name."""
        for name in self._beside:
            yield name
            folder = PurePosixPath(name).parent
            yield from (str(folder / texture) for texture in references.textures_of(self.path.parent / name))

    def _uv_parts(self, words: Integers) -> tuple[Integers, Integers, npt.NDArray[np.bool_]]:
        """Return where UVs in corners such as 1/2/3 begin (with the slash) and end, and whether they come last."""
        starts, ends = self._word_starts[words], self._word_ends[words]
        slashes = np.flatnonzero(np.frombuffer(self._data, np.uint8) == ord("/"))
        slashes = np.append(slashes, [len(self._data), len(self._data)])
        following = np.searchsorted(slashes, starts)
        first, second = (np.minimum(slashes[following + k], ends) for k in (0, 1))
        is_last = second + 1 >= ends
        return first, np.where(is_last, ends, second), is_last

    def _uses_of_uv(self) -> tuple[Integers, Integers]:
        """Return the words outside of faces that refer to a UV, and the UV of each."""
        words, named = [], []
        for line in self._lines_of(_REFERRER).tolist():
            before = int(np.searchsorted(self._lines_of(_UV), line))
            for word in range(self._first_words[line] + 1, self._first_words[line + 1]):
                parts = self._data[self._word_starts[word] : self._word_ends[word]].split(b"/")
                if len(parts) > 1 and parts[1]:
                    words.append(word)
                    named.append(self._index(line, parts[1], before, len(self._uv), "UV"))
        return np.array(words, dtype=np.int64), np.array(named, dtype=np.int64)

    # Statements and their words

    def _find_statements(self) -> None:
        """Find the begin, end and kind of each statement."""
        text = bytearray(self._data)
        if text.startswith(_BYTE_ORDER_MARK):
            text[: len(_BYTE_ORDER_MARK)] = b" " * len(_BYTE_ORDER_MARK)
        if self._newline == b"\r":
            text = text.replace(b"\r", b"\n")
        # Spaces replace the bytes that join two lines, so all offsets stay valid.
        for found in _CONTINUATION.finditer(self._data):
            if b"#" not in text[text.rfind(b"\n", 0, found.start()) + 1 : found.start()]:
                text[found.start() : found.end()] = b" " * len(found[0])
        if not text.endswith(b"\n"):
            text += b"\n"
        array = np.frombuffer(bytes(text), np.uint8)
        self._ends = np.flatnonzero(array == ord("\n"))
        self._starts = np.append(0, self._ends[:-1] + 1)
        first = self._starts.copy()
        indented = np.arange(len(first))
        while len(indented := indented[(first[indented] < self._ends[indented]) & _BLANK[array[first[indented]]]]):
            first[indented] += 1
        padded = np.append(array, np.full(1 + max(map(len, _KINDS)), ord("\n"), np.uint8))
        self._kinds = np.zeros(len(first), dtype=np.int8)
        for word, kind in _KINDS.items():
            is_word = _BLANK[padded[first + len(word)]]
            for k, byte in enumerate(word):
                is_word &= padded[first + k] == byte
            self._kinds[is_word] = kind
        # A comment may follow numbers; names may contain a "#".
        for place in np.flatnonzero(array == ord("#")).tolist():
            line = int(np.searchsorted(self._ends, place))
            if self._kinds[line] != _OTHER:
                text[place : self._ends[line]] = b" " * (int(self._ends[line]) - place)
        self._text = bytes(text)

    def _find_words(self) -> None:
        """Find the begin and end of each word, and the first word of each statement."""
        blank = _BLANK[np.frombuffer(self._text, np.uint8)]
        after_blank = np.append(True, blank[:-1])
        self._word_starts = np.flatnonzero(~blank & after_blank)
        self._word_ends = np.flatnonzero(blank & ~after_blank)
        self._first_words = np.searchsorted(self._word_starts, np.append(self._starts, len(self._text)))

    def _lines_of(self, kind: int) -> Integers:
        return np.flatnonzero(self._kinds == kind)

    def _joined(self, lines: Integers) -> bytes:
        """Return the text of these statements only."""
        breaks = np.flatnonzero(np.diff(lines) != 1)
        firsts, lasts = lines[np.append(0, breaks + 1)], lines[np.append(breaks, -1)]
        pieces = zip(self._starts[firsts].tolist(), (self._ends[lasts] + 1).tolist())
        return b"".join([self._text[start:end] for start, end in pieces])

    def _broken(self, line: int, problem: object) -> AssetError:
        number = self._data.count(self._newline[-1:], 0, int(self._starts[line])) + 1
        return AssetError(f"{self.path}:{number}: {problem}.")

    # Numbers

    def _table(self, kind: int, least: int) -> npt.NDArray[np.float64]:
        """Return the numbers of all statements of a kind; each is cut to the length of the shortest."""
        lines = self._lines_of(kind)
        if not len(lines):
            return np.zeros((0, least))
        (word,) = (word for word, meant in _KINDS.items() if meant == kind)
        counts = np.diff(self._first_words)[lines] - 1
        if (counts < least).any():
            raise self._broken(lines[(counts < least).argmax()], f"'{word.decode()}' has too few numbers")
        flat = _parsed(self._joined(lines).translate(None, word), np.float64)
        if flat is None or len(flat) != counts.sum():
            flat = np.array([value for line in lines.tolist() for value in self._floats(line)])
        return flat[(np.cumsum(counts) - counts)[:, None] + np.arange(counts.min())]

    def _floats(self, line: int) -> list[float]:
        words = self._text[self._starts[line] : self._ends[line]].split()[1:]
        try:
            return [float(word) for word in words]
        except ValueError as error:
            raise self._broken(line, str(error).replace(": b'", ": '")) from None

    def _corners(self, lines: Integers, n_vertices: int) -> tuple[Integers, Integers]:
        """Return the vertex and the UV of every corner, -1 for none; `lines` gives the statement of each corner."""
        text = np.frombuffer(self._text, np.uint8)
        starts, ends = self._word_starts[self._corner_words], self._word_ends[self._corner_words]
        slashes = np.flatnonzero(text == ord("/"))
        doubled = slashes[:-1][np.diff(slashes) == 1]
        n_slashes = np.searchsorted(slashes, ends) - np.searchsorted(slashes, starts)
        is_doubled = np.searchsorted(doubled, ends) > np.searchsorted(doubled, starts)
        given = np.zeros((len(lines), 3), dtype=np.int64)
        is_left = np.ones(len(lines), dtype=bool)
        faces, face_of_corner = np.unique(lines, return_inverse=True)
        for (count, double), fields in _FORMS.items():
            is_of_form = (n_slashes == count) & (is_doubled == double)
            whole = np.ones(len(faces), dtype=bool)
            whole[face_of_corner[~is_of_form]] = False
            if not whole.any():
                continue
            numbers = _parsed(self._joined(faces[whole]).translate(_SLASH_TO_BLANK, b"f"), np.int64)
            corners = whole[face_of_corner]
            if numbers is not None and len(numbers) == len(fields) * corners.sum():
                given[np.flatnonzero(corners)[:, None], fields] = numbers.reshape(-1, len(fields))
                is_left &= ~corners
        vertices = self._resolved(given[:, 0], lines, _POSITION, n_vertices)
        uv = self._resolved(given[:, 1], lines, _UV, len(self._uv))
        for k in np.flatnonzero(is_left | (vertices < 0) | ((uv < 0) & (given[:, 1] != 0))).tolist():
            vertices[k], uv[k] = self._corner(int(lines[k]), self._text[starts[k] : ends[k]], n_vertices)
        return vertices, uv

    def _resolved(self, given: Integers, lines: Integers, kind: int, total: int) -> Integers:
        """Convert indices that count from 1, or back from the preceding entry, to indices from 0; -1 if invalid."""
        before = np.searchsorted(self._lines_of(kind), lines) if (given < 0).any() else 0
        result = np.where(given > 0, given - 1, before + given)
        return np.where((given == 0) | (result < 0) | (result >= total), -1, result)

    def _corner(self, line: int, word: bytes, n_vertices: int) -> tuple[int, int]:
        """Return the index in one corner, and raise if it does not exist."""
        vertex, *others = word.split(b"/")
        before = [int(np.searchsorted(self._lines_of(kind), line)) for kind in (_POSITION, _UV)]
        of_uv = self._index(line, others[0], before[1], len(self._uv), "UV") if others and others[0] else -1
        return self._index(line, vertex, before[0], n_vertices, "vertex"), of_uv

    def _index(self, line: int, word: bytes, before: int, total: int, what: str) -> int:
        try:
            value = int(word)
        except ValueError:
            raise self._broken(line, f"'{word.decode(errors='replace')}' is not the number of a {what}") from None
        index = value - 1 if value > 0 else before + value
        if value == 0 or not 0 <= index < total:
            known = f"{before} stand before this line" if value < 0 else f"the file has {total}"
            raise self._broken(line, f"there is no {what} {value}; {known}")
        return index


class PlainAsset:
    """Meshes written as OBJ, because their format holds no UVs or the user asks for OBJ."""

    path = None
    suffix = ".obj"
    uv_map = ""
    warnings: Sequence[str] = ()

    def __init__(self, meshes: Sequence[AssetMesh]) -> None:
        """Take the meshes; those with names become objects."""
        self.meshes = meshes

    def references(self) -> Sequence[str]:
        """Return no files."""
        return ()

    def files(self, out: Path, maps: Sequence[UvMap]) -> dict[Path, bytes]:
        """Return an OBJ file, by its path, with positions in the scene; all numbers have all digits."""
        n_vertices, n_uv, rows = 0, 0, []
        for mesh, uv_map in zip(self.meshes, maps):
            corner_mapped = np.repeat(uv_map.mapped, np.diff(mesh.face_offsets))
            _, different, index = numbered(mesh.corner_vertices[corner_mapped], uv_map.uv[corner_mapped])
            numbers = np.zeros(len(uv_map.uv), dtype=np.int64)
            numbers[corner_mapped] = n_uv + 1 + index
            rows += [f"o {mesh.name}"] if mesh.name else []
            placed = mesh.vertices
            if not np.array_equal(mesh.placement, np.eye(4)):
                placed = mesh.vertices @ mesh.placement[:3, :3].T + mesh.placement[:3, 3]
            rows += [f"v {x!r} {y!r} {z!r}" for x, y, z in placed.tolist()]
            rows += [f"vt {u!r} {v!r}" for u, v in different.tolist()]
            vertices = (n_vertices + 1 + mesh.corner_vertices).tolist()
            corners = [f"{v}/{t}" if t else str(v) for v, t in zip(vertices, numbers.tolist())]
            bounds = zip(mesh.face_offsets[:-1].tolist(), mesh.face_offsets[1:].tolist())
            rows += [f"f {' '.join(corners[first:last])}" for first, last in bounds]
            n_vertices += len(mesh.vertices)
            n_uv += len(different)
        return {out: "".join(f"{row}\n" for row in rows).encode("utf-8", "surrogateescape")}


def _parsed(text: bytes, kind: type) -> npt.NDArray | None:
    """Return the numbers in a text, or None if it contains anything else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(text, dtype=kind, sep=" ")
        except (DeprecationWarning, ValueError, OverflowError):
            return None


def _ranges(starts: Integers, counts: Integers) -> Integers:
    """Return the concatenated ranges start, start + 1, ... of each."""
    offsets = offsets_of(counts)
    return np.repeat(starts - offsets[:-1], counts) + np.arange(offsets[-1])
