"""OBJ files as lines: read the geometry, write UVs, and keep every other byte.

The format: Wavefront's "Object Files (.obj)", appendix B1 of the Advanced Visualizer's manual.
"""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
import numpy.typing as npt

from .._distinct_rows import parts
from .._map_change import MapChange
from .._quality import face_triangles
from .._texture_size import DrawnTexture, TextureSize
from .._vertex_colors import VertexColors
from . import references
from .edits import Integers, edited, joined, numbered, ranges
from .lines import BLANK, Block, blocks, parsed
from .mesh import AssetError, AssetMesh, OneMeshAsset, UvMap, check_text, checked, of_short_faces, offsets_of
from .obj_textures import MaterialFiles, moves_textures
from .shared_textures import SharedTextures

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_PLACES_LEFT = "Materials scale or move textures of the map (-s, -o), which was left."
_LIBRARY = re.compile(rb"^([ \t]*mtllib[ \t]+)([^\r\n]+)", re.MULTILINE)
_CONTINUATION = re.compile(rb"\\[ \t\r]*\n")
_SLASH_TO_BLANK = bytes.maketrans(b"/", b" ")
_OTHER, _POSITION, _UV, _FACE, _REFERRER, _OBJECT, _MATERIAL = range(7)
# Words of a vertex with a color.
_COLORED = 6
_KINDS = {
    **{b"v": _POSITION, b"vt": _UV, b"f": _FACE, b"l": _REFERRER, b"surf": _REFERRER},
    **{b"o": _OBJECT, b"usemtl": _MATERIAL},
}
# Separated by slashes, a corner's number 0 is its vertex, number 1 its UV: 1, 1/2, 1//3, 1/2/3.
_FORMS = {(0, False): (0,), (1, False): (0, 1), (2, True): (0, 2), (2, False): (0, 1, 2)}
# A name in the file, and the number of faces before it.
_Names = list[tuple[bytes, int]]


class ObjAsset(OneMeshAsset):
    """An OBJ file and its polygons.

    It is processed block by block, once to read it and once to write it; of its text, only the bytes are kept.
    """

    suffix = ".obj"

    def __init__(self, path: Path) -> None:
        """Read the file.

        Raises:
            AssetError: a line is broken, or there is no mesh.
            OSError: the file cannot be opened.
        """
        self.path = path
        self._data = path.read_bytes()
        check_text(path, self._data)
        self._beside: list[str] = []
        self.drawn_textures: list[DrawnTexture] = []
        """Textures that `files` drew last."""
        self.shared: SharedTextures | None = None
        """Textures that it reads instead of its own."""
        self._redrawn: MaterialFiles | None = None
        self._newline = b"\r\n" if b"\r\n" in self._data else b"\n" if b"\n" in self._data else b"\r"
        self._spans: list[_Span] = []
        positions, uv, sizes, corners, uv_numbers = [], [], [], [], []
        objects: _Names = []
        materials: _Names = []
        n_short, short = 0, None
        for block in self._read_blocks():
            n_short += len(block.short_faces)
            short = short or (block if len(block.short_faces) else None)
            positions.append(block.table(_POSITION, 3, 3))
            # A texture of one dimension has no v.
            uv.append(block.table(_UV, 1, 2))
            sizes.append(block.sizes)
            of_vertex, of_uv = block.corners()
            corners.append(of_vertex)
            uv_numbers.append(of_uv.astype(np.int32))
            objects += block.names(_OBJECT)
            materials += block.names(_MATERIAL)
        offsets = offsets_of(joined(sizes, np.zeros(0, np.int64)))
        if len(offsets) == 1 and not any(map(len, positions)):
            # Any text reads as a file without statements.
            raise AssetError(f"{path}: has no faces; there is nothing to unwrap.")
        if not self._data.endswith((b"\n", b"\r")) and n_short and block.ends_within_face:
            raise self.broken(block, int(block.short_faces[-1]), "ends within a face: the file is cut off")
        if short and len(offsets) == 1:
            raise self.broken(short, int(short.short_faces[0]), "a face needs at least three corners")
        self.warnings = of_short_faces(n_short, "no UVs for them")
        vertices, corner_vertices = joined(positions, np.zeros((0, 3))), joined(corners, np.zeros(0, np.int64))
        table, numbers = joined(uv, np.zeros((0, 2))), joined(uv_numbers, np.zeros(0, np.int32))
        self._n_uv = len(table)
        if not len(table) and numbers.max(initial=-1) >= 0:
            numbers[:] = -1
            self.warnings += ["Faces name UVs, but the file had none."]
        self._check(offsets, corner_vertices, len(vertices), "vertex")
        self._check(offsets, numbers, len(table), "UV")
        # The last row is that of corners without a UV.
        found = np.vstack([table, [[np.nan, np.nan]]])[numbers] if numbers.max(initial=-1) >= 0 else None
        n_faces = len(offsets) - 1
        self._materials = materials
        material, only = _material_of_face(materials, n_faces)
        self.mesh = checked(
            path,
            AssetMesh(
                vertices,
                offsets,
                corner_vertices,
                found,
                material_of_face=material,
                material=only,
                **_parts(objects, n_faces),
            ),
        )

    def _read_blocks(self) -> Iterator[_Block]:
        """Yield the blocks of the file in order, and note where they are; the first face begins a block."""
        counts = dict.fromkeys((_POSITION, _UV, _FACE), 0)
        for start, end in blocks(self._data, 0, self._newline[-1:]):
            found = [_Block(self, _Span(start, end, dict(counts)))]
            faces = found[0].lines_of(_FACE)
            if len(faces) and faces[0] > 0 and not counts[_FACE]:
                at = start + int(found[0].lines.starts[faces[0]])
                found = [_Block(self, _Span(start, at, dict(counts)))]
                counts = found[0].counts_after()
                found.append(_Block(self, _Span(at, end, dict(counts))))
            for block in found:
                self._spans.append(block.span)
                counts = block.counts_after()
                yield block

    def _check(self, offsets: Integers, indices: npt.NDArray[np.integer], total: int, what: str) -> None:
        """Raise AssetError, naming the line, if a corner's index reaches beyond the table that it refers to."""
        if indices.max(initial=-1) < total:
            return
        first = int((indices >= total).argmax())
        face = int(np.searchsorted(offsets, first, side="right")) - 1
        block = _Block(self, next(span for span in reversed(self._spans) if span.before[_FACE] <= face))
        line = int(block.lines_of(_FACE)[face - block.span.before[_FACE]])
        raise self.broken(block, line, f"there is no {what} {indices[first] + 1}; the file has {total}")

    def broken(self, block: _Block, line: int, problem: object) -> AssetError:
        """Return the error about a line of a block."""
        number = self._data.count(self._newline[-1:], 0, block.span.start + int(block.lines.starts[line])) + 1
        return AssetError(f"{self.path}:{number}: {problem}.")

    def with_uv(self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> Iterator[bytes]:
        """Yield the file with a new UV map.

        Args:
            uv: (C, 2), written with all digits.
            mapped: (faces,) faces without a map get no UVs.
        """
        corner_mapped = None if mapped.all() else np.repeat(mapped, np.diff(self.mesh.face_offsets))
        first, number = numbered(self.mesh.corner_vertices, uv, corner_mapped)
        with_faces = next(span for span in self._spans if span.n_faces)
        # Other statements that refer to UVs keep theirs.
        referring = (_Block(self, span) for span in self._spans if span.has_referrers)
        is_referred = any(len(block.uses_of_uv(self._n_uv)[0]) for block in referring)
        before = with_faces.before[_UV] if is_referred else 0
        at = 0
        for span in self._spans:
            block = _Block(self, span)
            if span is with_faces:
                if self._redrawn and self._redrawn.first_lines:
                    yield self._redrawn.first_lines
                for part in parts(len(first)):
                    yield b"".join([b"vt %r %r%s" % (u, v, self._newline) for u, v in uv[first[part]].tolist()])
            own = number[at : at + len(block.corner_words)]
            at += len(own)
            words, referred = block.uses_of_uv(self._n_uv)
            referred = np.where(referred < before, referred, referred + len(first))
            places, texts = block.uv_parts(
                np.append(block.corner_words, words), np.append(np.where(own >= 0, before + own + 1, 0), referred + 1)
            )
            if not is_referred:
                dropped = block.whole(block.lines_of(_UV))
                places, texts = np.concatenate([places, dropped]), texts + [b""] * len(dropped)
            yield edited(self._data, span.start, span.end, places, texts)

    def files(
        self, out: Path, maps: Sequence[UvMap], textures: TextureSize | None = None
    ) -> Mapping[Path, Iterable[bytes]]:
        """Return the file with a new UV map; paths to materials above its folder are adapted to the new folder.

        With `textures`, those of its materials are drawn anew, and it gets new material files.
        """
        self._beside = []
        of_last = self._redrawn.warnings if self._redrawn else []
        self.warnings = [each for each in self.warnings if each not in (*of_last, _PLACES_LEFT)]
        # Textures drawn anew are read as they are.
        if textures is None and self._moves_textures():
            self.warnings.append(_PLACES_LEFT)
        if not self.shared:
            self._redrawn = self._material_files(out, maps[0], textures)
        others: Mapping[Path, Iterable[bytes]] = {}
        if self._redrawn:
            self._redrawn.write()
            self.drawn_textures, others = self._redrawn.drawn, self._redrawn.files
            self.warnings = [*self.warnings, *self._redrawn.warnings]
        named = functools.partial(self._named, out=out)
        # Every piece has whole lines.
        own = self._redrawn.first_lines if self._redrawn else b""
        written = {
            path: (_LIBRARY.sub(named, each) if b"mtllib" in each and each is not own else each for each in content)
            for path, content in super().files(out, maps).items()
        }
        return {**others, **written}

    def share(self, out: Path, maps: Sequence[UvMap], textures: TextureSize, shared: SharedTextures) -> None:
        """Add its textures to those that assets share; `files` with the same arguments then names these."""
        self.shared = shared
        self._redrawn = self._material_files(out, maps[0], textures)
        if self._redrawn:
            self._redrawn.share()

    def _material_files(self, out: Path, uv_map: UvMap, textures: TextureSize | None) -> MaterialFiles | None:
        """Return new material files; None if none are wanted, or nothing could be drawn for them."""
        if textures is None:
            return None
        colors = self._colors(uv_map) if textures.colors else None
        has_map = self.mesh.corner_uv is not None
        if not (has_map or colors or self.shared):
            return None
        change = functools.partial(self._change, uv_map)
        given = self._libraries(), change, has_map, textures, colors, self.shared
        return MaterialFiles(self.path, out, *given)

    def _colors(self, uv_map: UvMap) -> VertexColors | None:
        """Return the colors behind the positions of vertices; None if not all vertices have some."""
        mesh, found = self.mesh, []
        for span in self._spans:
            colors = _Block(self, span).colors()
            if colors is None:
                return None
            found.append(colors)
        corners, _ = face_triangles(
            mesh.vertices, mesh.face_offsets, mesh.corner_vertices, selected_faces=uv_map.mapped
        )
        # Programs store and mix them as they are shown.
        colors = VertexColors("data")
        colors.add(np.concatenate(found)[mesh.corner_vertices], uv_map.uv, corners)
        return colors or None

    def _moves_textures(self) -> bool:
        """Return whether its materials scale or move textures."""
        used = {name for name, _ in self._materials}
        paths = [self.path.parent / name for name in self._libraries()]
        return any(moves_textures(path, used) for path in paths if path.is_file())

    def _libraries(self) -> list[str]:
        """Return the names of its material files."""
        names = [name for line in _LIBRARY.findall(self._data) for name in self._names(line[1])]
        return list(dict.fromkeys(names))

    def _names(self, rest: bytes) -> list[str]:
        """Return the material files of a line: one name with spaces, or several."""
        text = os.fsdecode(rest.strip())
        return [text] if (self.path.parent / text).is_file() else text.split()

    def _change(self, uv_map: UvMap, names: set[bytes]) -> MapChange:
        """Return both maps of the faces that have one of these materials."""
        mesh = self.mesh
        is_named = np.array([*((name in names) for name, _ in self._materials), False])
        chosen = uv_map.mapped.copy()
        chosen &= is_named[_last_before(self._materials, len(chosen))] if self._materials else False
        corners, _ = face_triangles(mesh.vertices, mesh.face_offsets, mesh.corner_vertices, selected_faces=chosen)
        old = uv_map.uv if mesh.corner_uv is None else mesh.corner_uv
        return MapChange(old, uv_map.uv, corners, mesh.vertices[mesh.corner_vertices]).part(corners)

    def _named(self, found: re.Match[bytes], out: Path) -> bytes:
        names = self._names(found[2])
        redrawn = self._redrawn.names if self._redrawn else {}
        new = [redrawn.get(name) or references.elsewhere(name, self.path, out) for name in names]
        self._beside += [name for name, other in zip(names, new) if other == name]
        return found[0] if new == names else found[1] + os.fsencode(" ".join(new))

    def references(self) -> Iterator[str]:
        """Yield the material files, and the textures that these name."""
        if self._redrawn:
            yield from self._redrawn.beside
        for name in self._beside:
            yield name
            folder = PurePosixPath(name).parent
            yield from (str(folder / texture) for texture in references.textures_of(self.path.parent / name))

    def rename(self, source: Path, copy: Path, named: Callable[[str], str]) -> None:
        """Change the paths of textures in the copy of a material file."""
        references.rename_textures(source, copy, named)

    def text(self, start: int, end: int) -> bytes:
        """Return the statements in a range of whole lines, each on one line and without comments, at the same places.

        Spaces replace the bytes that join two lines. A comment may follow numbers; names may contain a "#".
        """
        found = self._data[start:end]
        if self._newline == b"\r":
            found = found.replace(b"\r", b"\n")
        text: bytes | bytearray = found
        if start == 0 and found.startswith(_BYTE_ORDER_MARK):
            text = bytearray(found)
            text[: len(_BYTE_ORDER_MARK)] = b" " * len(_BYTE_ORDER_MARK)
        if b"\\" in found:
            text = bytearray(text)
            for joint in _CONTINUATION.finditer(found):
                if b"#" not in text[text.rfind(b"\n", 0, joint.start()) + 1 : joint.start()]:
                    text[joint.start() : joint.end()] = b" " * len(joint[0])
        return bytes(text)

    @property
    def data(self) -> bytes:
        """The file."""
        return self._data


@dataclass(frozen=True)
class _Span:
    """Where a block is, and what is before and in it."""

    start: int
    end: int
    before: dict[int, int]
    """Statements of the kinds that others count, in all blocks before."""
    n_faces: int = 0
    has_referrers: bool = False


class _Block:
    """Statements of an OBJ file, and what they say."""

    def __init__(self, asset: ObjAsset, span: _Span) -> None:
        """Find statements, their kinds and words; faces with fewer than three corners count as lines."""
        self._asset = asset
        self.lines = Block(asset.text(span.start, span.end), span.start)
        self.kinds = self._kinds()
        if b"#" in self.lines.text:
            self.lines = Block(self._without_comments(), span.start)
        sizes = np.diff(self.lines.first_words) - 1
        self.short_faces = np.flatnonzero((self.kinds == _FACE) & (sizes < 3))
        self.kinds[self.short_faces] = _REFERRER
        self.faces = self.lines_of(_FACE)
        self.sizes = sizes[self.faces]
        """(faces,) number of corners."""
        self.span = _Span(span.start, span.end, span.before, len(self.faces), bool(len(self.lines_of(_REFERRER))))
        self.corner_words = ranges(self.lines.first_words[self.faces] + 1, self.sizes)
        """(C,)"""

    @property
    def ends_within_face(self) -> bool:
        """Whether the last line is a face with fewer than three corners."""
        return self.short_faces[-1:].tolist() == [len(self.lines.ends) - 1]

    def _kinds(self) -> npt.NDArray[np.int8]:
        starts, ends, array = self.lines.starts, self.lines.ends, self.lines.array
        first = starts.copy()
        indented = np.arange(len(first))
        while len(indented := indented[(first[indented] < ends[indented]) & BLANK[array[first[indented]]]]):
            first[indented] += 1
        padded = np.append(array, np.full(1 + max(map(len, _KINDS)), ord("\n"), np.uint8))
        kinds = np.zeros(len(first), dtype=np.int8)
        for word, kind in _KINDS.items():
            is_word = BLANK[padded[first + len(word)]]
            for k, byte in enumerate(word):
                is_word &= padded[first + k] == byte
            kinds[is_word] = kind
        return kinds

    def _without_comments(self) -> bytes:
        text = bytearray(self.lines.text)
        marks = np.flatnonzero(self.lines.array == ord("#"))
        lines = np.searchsorted(self.lines.ends, marks)
        for line, place in zip(lines.tolist(), marks.tolist()):
            if self.kinds[line] != _OTHER:
                end = int(self.lines.ends[line])
                text[place:end] = b" " * (end - place)
        return bytes(text)

    def lines_of(self, kind: int) -> Integers:
        """Return the lines of a kind."""
        return np.flatnonzero(self.kinds == kind)

    def counts_after(self) -> dict[int, int]:
        """Return the statements of the kinds that others count, up to the end of the block."""
        return {kind: count + int((self.kinds == kind).sum()) for kind, count in self.span.before.items()}

    def names(self, kind: int) -> _Names:
        """Return what follows the keyword in the lines of a kind, each with the number of faces before it."""
        lines = self.lines_of(kind)
        data, start = self._asset.data, self.span.start
        spans = zip((start + self.lines.starts[lines]).tolist(), (start + self.lines.ends[lines]).tolist())
        found = [b"".join(data[first:last].split(maxsplit=1)[1:]).strip() for first, last in spans]
        return list(zip(found, (self.span.before[_FACE] + np.searchsorted(self.faces, lines)).tolist()))

    def whole(self, lines: Integers) -> Integers:
        """Return the places of lines with their ends, (n, 2)."""
        ends = np.append(self.lines.starts, self.span.end - self.span.start)[lines + 1]
        return self.span.start + np.column_stack([self.lines.starts[lines], ends])

    # Numbers

    def table(self, kind: int, least: int, width: int) -> npt.NDArray[np.float64]:
        """Return the first numbers of all statements of a kind, (n, width); 0 for what follows the least number."""
        lines = self.lines_of(kind)
        if not len(lines):
            return np.zeros((0, width))
        (word,) = (word for word, meant in _KINDS.items() if meant == kind)
        counts = np.diff(self.lines.first_words)[lines] - 1
        if (counts < least).any():
            problem = f"'{word.decode()}' has too few numbers"
            raise self._asset.broken(self, lines[(counts < least).argmax()], problem)
        flat = parsed(self.lines.joined(lines).translate(None, word), np.float64)
        if flat is None or len(flat) != counts.sum():
            flat = np.array([value for line in lines.tolist() for value in self._floats(line)])
        first = np.cumsum(counts) - counts
        columns = [np.where(k < counts, flat[first + np.minimum(k, counts - 1)], 0.0) for k in range(width)]
        return np.stack(columns, axis=1)

    def colors(self) -> npt.NDArray[np.float64] | None:
        """Return the colors of the vertices, (n, 3), which stand behind their positions; None if some have none."""
        lines = self.lines_of(_POSITION)
        counts = np.diff(self.lines.first_words)[lines] - 1
        if (counts < _COLORED).any():
            return None
        found = self.table(_POSITION, _COLORED, _COLORED)[:, 3:]
        # Some programs write bytes.
        return found / 255.0 if found.max(initial=0.0) > 1.0 else found

    def _floats(self, line: int) -> list[float]:
        words = self.lines.words(line)[1:]
        try:
            return [float(word) for word in words]
        except ValueError:
            text = b" ".join(words).decode("utf-8", errors="replace")
            raise self._asset.broken(self, line, f"'{text}' has a word that is not a number") from None

    def corners(self) -> tuple[Integers, Integers]:
        """Return the vertex and the UV of every corner, (C,), -1 for none.

        Whether they exist is up to the caller, except for those that count back.
        """
        lines = np.repeat(self.faces, self.sizes)
        starts, ends = self.lines.word_starts[self.corner_words], self.lines.word_ends[self.corner_words]
        slashes = np.flatnonzero(self.lines.array == ord("/"))
        doubled = slashes[:-1][np.diff(slashes) == 1]
        n_slashes = np.searchsorted(slashes, ends) - np.searchsorted(slashes, starts)
        is_doubled = np.searchsorted(doubled, ends) > np.searchsorted(doubled, starts)
        given = np.zeros((len(lines), 3), dtype=np.int64)
        is_left = np.ones(len(lines), dtype=bool)
        face_of_corner = np.repeat(np.arange(len(self.faces)), self.sizes)
        for (count, double), fields in _FORMS.items():
            is_of_form = (n_slashes == count) & (is_doubled == double)
            whole = np.ones(len(self.faces), dtype=bool)
            whole[face_of_corner[~is_of_form]] = False
            if not whole.any():
                continue
            numbers = parsed(self.lines.joined(self.faces[whole]).translate(_SLASH_TO_BLANK, b"f"), np.int64)
            chosen = whole[face_of_corner]
            if numbers is not None and len(numbers) == len(fields) * chosen.sum():
                given[np.flatnonzero(chosen)[:, None], fields] = numbers.reshape(-1, len(fields))
                is_left &= ~chosen
        vertices = self._resolved(given[:, 0], lines, _POSITION)
        uv = self._resolved(given[:, 1], lines, _UV)
        for k in np.flatnonzero(is_left | (vertices < 0) | ((uv < 0) & (given[:, 1] != 0))).tolist():
            vertex, *others = self.lines.text[starts[k] : ends[k]].split(b"/")
            vertices[k] = self._index(int(lines[k]), vertex, _POSITION, "vertex")
            uv[k] = self._index(int(lines[k]), others[0], _UV, "UV") if others and others[0] else -1
        return vertices, uv

    def _before(self, kind: int, lines: npt.ArrayLike) -> Integers:
        """Return the number of statements of a kind before lines."""
        return self.span.before[kind] + np.searchsorted(self.lines_of(kind), lines)

    def _resolved(self, given: Integers, lines: Integers, kind: int) -> Integers:
        """Convert indices that count from 1, or back from the preceding entry, to indices from 0; -1 if invalid."""
        before = self._before(kind, lines) if (given < 0).any() else 0
        return np.where(given > 0, given - 1, np.where(given < 0, np.maximum(before + given, -1), -1))

    def _index(self, line: int, word: bytes, kind: int, what: str) -> int:
        try:
            value = int(word)
        except ValueError:
            problem = f"'{word.decode(errors='replace')}' is not the number of a {what}"
            raise self._asset.broken(self, line, problem) from None
        before = int(self._before(kind, line))
        index = value - 1 if value > 0 else before + value
        if value == 0 or index < 0:
            known = f"{before} stand before this line" if value < 0 else "numbers begin with 1"
            raise self._asset.broken(self, line, f"there is no {what} {value}; {known}")
        return index

    # Writing

    def uv_parts(self, words: Integers, numbers: Integers) -> tuple[Integers, list[bytes]]:
        """Return the places of UVs in corners such as 1/2/3, (n, 2), with a slash, and their texts for new numbers.

        0 stands for no UV.
        """
        starts, ends = self.lines.word_starts[words], self.lines.word_ends[words]
        slashes = np.flatnonzero(self.lines.array == ord("/"))
        slashes = np.append(slashes, [len(self.lines.text), len(self.lines.text)])
        following = np.searchsorted(slashes, starts)
        first, second = (np.minimum(slashes[following + k], ends) for k in (0, 1))
        is_last = second + 1 >= ends
        texts = [
            b"/%d" % number if number else b"" if last else b"/"
            for number, last in zip(numbers.tolist(), is_last.tolist())
        ]
        return self.span.start + np.column_stack([first, np.where(is_last, ends, second)]), texts

    def uses_of_uv(self, n_uv: int) -> tuple[Integers, Integers]:
        """Return the words outside of faces that refer to a UV, and the UV of each, of `n_uv`."""
        words, named = [], []
        for line in self.lines_of(_REFERRER).tolist():
            for word in range(self.lines.first_words[line] + 1, self.lines.first_words[line + 1]):
                split = self.lines.text[self.lines.word_starts[word] : self.lines.word_ends[word]].split(b"/")
                if len(split) > 1 and split[1]:
                    words.append(word)
                    named.append(self._index(line, split[1], _UV, "UV"))
                    if named[-1] >= n_uv:
                        raise self._asset.broken(self, line, f"there is no UV {named[-1] + 1}; the file has {n_uv}")
        return np.array(words, dtype=np.int64), np.array(named, dtype=np.int64)


def _parts(objects: _Names, n_faces: int) -> dict[str, Any]:
    """Return the objects of the mesh as the parts of an `AssetMesh`; none for a file with fewer than two."""
    if len(objects) < 2:
        return {}
    names = tuple(name.decode("utf-8", errors="replace") for name, _ in objects)
    return {"parts": names, "part_of_face": _last_before(objects, n_faces)}


def _material_of_face(materials: _Names, n_faces: int) -> tuple[npt.NDArray[np.int64] | None, int]:
    """Return the material of every face, or that of all: `material_of_face` and `material` of `AssetMesh`."""
    if not materials or not n_faces:
        return None, -1
    numbers: dict[bytes, int] = {}
    of_name = np.array([*(numbers.setdefault(name, len(numbers)) for name, _ in materials), -1])
    found = of_name[_last_before(materials, n_faces)]
    return found if (found != found[:1]).any() else None, int(found[0])


def _last_before(names: _Names, n_faces: int) -> Integers:
    """Return the last name before each face, -1 without one."""
    first_faces = np.array([faces for _, faces in names])
    counts = np.diff(np.concatenate([[0], first_faces, [n_faces]]))
    return np.repeat(np.arange(-1, len(names)), counts)


class PlainAsset:
    """Meshes written as OBJ, because their format holds no UVs or the user asks for OBJ."""

    path = None
    suffix = ".obj"
    uv_map = ""
    meters = None
    warnings: Sequence[str] = ()

    def __init__(self, meshes: Sequence[AssetMesh]) -> None:
        """Take the meshes; those with names become objects."""
        self.meshes = meshes

    def references(self) -> Sequence[str]:
        """Return no files."""
        return ()

    def rename(self, source: Path, copy: Path, named: Callable[[str], str]) -> None:
        """Do nothing: it references no files."""

    def files(self, out: Path, maps: Sequence[UvMap]) -> Mapping[Path, Iterator[bytes]]:
        """Return an OBJ file, by its path, with positions in the scene; all numbers have all digits."""
        return {out: self._content(maps)}

    def _content(self, maps: Sequence[UvMap]) -> Iterator[bytes]:
        n_vertices, n_uv = 0, 0
        for mesh, uv_map in zip(self.meshes, maps):
            offsets, corners = mesh.face_offsets, mesh.corner_vertices
            corner_mapped = None if uv_map.mapped.all() else np.repeat(uv_map.mapped, np.diff(offsets))
            first, number = numbered(corners, uv_map.uv, corner_mapped)
            if mesh.name:
                yield f"o {mesh.name}\n".encode("utf-8", "surrogateescape")
            is_placed = not np.array_equal(mesh.placement, np.eye(4))
            for part in parts(len(mesh.vertices)):
                rows = mesh.vertices[part]
                if is_placed:
                    rows = rows @ mesh.placement[:3, :3].T + mesh.placement[:3, 3]
                yield b"".join([b"v %r %r %r\n" % (x, y, z) for x, y, z in rows.tolist()])
            for part in parts(len(first)):
                yield b"".join([b"vt %r %r\n" % (u, v) for u, v in uv_map.uv[first[part]].tolist()])
            for part in parts(len(offsets) - 1):
                bounds = offsets[part.start : part.stop + 1]
                own = slice(int(bounds[0]), int(bounds[-1]))
                pairs = zip((n_vertices + 1 + corners[own]).tolist(), (n_uv + 1 + number[own]).tolist())
                words = [b"%d/%d" % (v, t) if t > n_uv else b"%d" % v for v, t in pairs]
                ends = (bounds - bounds[0]).tolist()
                yield b"".join([b"f %s\n" % b" ".join(words[begin:end]) for begin, end in zip(ends, ends[1:])])
            n_vertices += len(mesh.vertices)
            n_uv += len(first)
