"""The material files of an OBJ file, with their textures drawn anew for a new UV map.

The format: Wavefront's "Material Library File (.mtl)", and the keys of later programs for roughness, metal and normals.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

import numpy as np

from .._map_change import MapChange, drawn
from .._rebaking import BakedTexture, Content
from .._texture_size import DrawnTexture, TextureSize, said_of_kept, said_of_loss
from .._vertex_colors import NAME
from . import images, references
from .mesh import AssetError

_MATERIAL = re.compile(rb"^[ \t]*newmtl[ \t]+([^\r\n]*)", re.MULTILINE)
_STATEMENT = re.compile(rb"^([ \t]*(map_\w+|bump|disp|decal|norm|refl)[ \t]+)([^\r\n]+)", re.MULTILINE | re.IGNORECASE)
_COLOR_MAP = re.compile(rb"[ \t]*map_Kd[ \t]", re.IGNORECASE)
_PLACES = re.compile(r"-([so])((?:\s+[-+.\deE]+){1,3})(?=\s|$)\s*")
_TURBULENCE = re.compile(r"-t(?:\s+[-+.\deE]+){1,3}(?=\s|$)\s*")
_CLAMPED = re.compile(r"-clamp\s+on\b", re.IGNORECASE)
_COLORS = ("map_ka", "map_kd", "map_ks", "map_ke", "decal")
_MAY_BE_NORMALS = ("norm", "map_kn", "bump", "map_bump")
_REFLECTION = "refl"


@dataclass(frozen=True)
class _Reading:
    """What determines a new texture: the old one, and how a material reads it."""

    path: Path
    content: Content
    offset: tuple[float, float]
    scale: tuple[float, float]
    is_clamped: bool


@dataclass
class _Job:
    materials: set[bytes] = field(default_factory=set)
    name: str = ""
    """Of the new file; empty if there is none."""


@dataclass(frozen=True)
class _Statement:
    """A line that names a texture, in the text of a material file."""

    start: int
    end: int
    options: str
    name: str
    reading: _Reading | None


class MaterialFiles:
    """New material files beside an OBJ file, and the textures that they name."""

    def __init__(
        self,
        source: Path,
        out: Path,
        names: list[str],
        change_of: Callable[[set[bytes]], MapChange] | None,
        size: TextureSize,
        colors: BakedTexture | None = None,
    ) -> None:
        """Read the material files and draw their textures.

        Args:
            source: the OBJ file.
            out: the file to write.
            names: of its material files, as it names them.
            change_of: returns both maps of the faces that have one of these materials; None without an old map.
            size: of the new textures.
            colors: a texture of vertex colors, for materials without one; without material files, one gets its own.
        """
        self.files: dict[Path, list[bytes]] = {}
        """The new files, textures before material files."""
        self.names: dict[str, str] = {}
        """The new name of each material file that exists."""
        self.beside: list[str] = []
        """Textures that stay, relative to the folder of the source."""
        self.warnings: list[str] = []
        self.drawn: list[DrawnTexture] = []
        self._source, self._out, self._size, self._change_of = source, out, size, change_of
        self._jobs: dict[_Reading, _Job] = {}
        self._pixels: tuple[Path | None, np.ndarray] = (None, np.zeros(0))
        texts = {name: (source.parent / name).read_bytes() for name in names if (source.parent / name).is_file()}
        statements = {name: self._statements(name, text) for name, text in texts.items()}
        for reading, job in self._jobs.items():
            self._draw(reading, job)
        coloring = "" if colors is None else self._store_colors(colors)
        for name, text in texts.items():
            path = self._free(Path(name).name)
            self.names[name] = path.name
            rewritten = self._rewritten(name, text, statements[name])
            self.files[path] = [_colored(rewritten, coloring) if coloring else rewritten]
        self.first_lines = b""
        """To stand before the faces, if there were no material files."""
        if coloring and not names:
            path = self._free(f"{NAME}.mtl")
            self.files[path] = [_colored(b"newmtl %s\n" % NAME.encode(), coloring)]
            self.first_lines = b"mtllib %s\nusemtl %s\n" % (os.fsencode(path.name), NAME.encode())

    def _statements(self, library: str, text: bytes) -> list[_Statement]:
        """Return the lines that name textures, and note which of these to draw."""
        folder = (self._source.parent / library).parent
        materials = [(each.start(), each[1].strip()) for each in _MATERIAL.finditer(text)]
        found = []
        for line in _STATEMENT.finditer(text):
            rest = os.fsdecode(line[3].strip())
            name = references.name_of(rest, folder)
            options = rest[: len(rest) - len(name)]
            material = next((each for start, each in reversed(materials) if start < line.start()), b"")
            reading = self._reading(folder / name.replace("\\", "/"), line[2].decode().lower(), options)
            if reading:
                self._jobs.setdefault(reading, _Job()).materials.add(material)
            found.append(_Statement(line.start(3), line.end(3), options, name, reading))
        return found

    def _reading(self, path: Path, key: str, options: str) -> _Reading | None:
        """Return how a material reads a texture; None if it is not on the map or, with a warning, cannot be drawn."""
        if key == _REFLECTION or self._change_of is None:
            return None
        try:
            pixels = self._read(path)
        except AssetError as error:
            said = said_of_kept(path.name, str(error))
            self.warnings += [said] if said not in self.warnings else []
            return None
        content: Content = "color" if key in _COLORS else "data"
        if key in _MAY_BE_NORMALS and _has_normals(pixels):
            content = "normals"
        places = {"o": (0.0, 0.0), "s": (1.0, 1.0)}
        for what, numbers in _PLACES.findall(options):
            given = [float(number) for number in numbers.split()]
            places[what] = (given[0], given[1] if len(given) > 1 else places[what][1])
        return _Reading(path, content, places["o"], places["s"], bool(_CLAMPED.search(options)))

    def _read(self, path: Path) -> np.ndarray:
        """Return the pixels of an image; the last one is kept."""
        if self._pixels[0] != path:
            if not path.is_file():
                raise AssetError("its image is missing")
            self._pixels = path, images.read(path.read_bytes(), path.suffix.lower())
        return self._pixels[1]

    def _draw(self, reading: _Reading, job: _Job) -> None:
        assert self._change_of is not None
        change = self._change_of(job.materials)
        placed = change.old * reading.scale + reading.offset
        wrap = "clamp" if reading.is_clamped else "repeat"
        baked, loss = drawn(
            self._read(reading.path),
            [MapChange(placed, change.new, change.triangles, change.positions)],
            self._size,
            reading.content,
            wrap=(wrap, wrap),
        )
        if baked is None:
            return
        self.warnings += filter(None, [said_of_loss(reading.path.name, loss)])
        suffix = images.written_as(reading.path.suffix.lower())
        path = self._free(f"{reading.path.stem}{suffix}")
        job.name = path.name
        self.files[path] = [images.written(baked.image, suffix)]
        self.drawn.append(DrawnTexture.of(reading.path.name, baked))

    def _store_colors(self, colors: BakedTexture) -> str:
        """Add the file of a texture of vertex colors; return its name."""
        path = self._free(f"{NAME}.png")
        self.files[path] = [images.written(colors.image, ".png")]
        self.drawn.append(DrawnTexture.of(NAME, colors))
        return path.name

    def _free(self, name: str) -> Path:
        """Return the path of a new file for an old one with this name."""
        taken = {path.name for path in self.files}
        return references.free_beside(self._out, f"{self._out.stem}_{name}", self._source, taken)

    def _rewritten(self, library: str, text: bytes, statements: list[_Statement]) -> bytes:
        """Return a material file that names the new textures, and the others from its new folder."""
        pieces, at = [], 0
        for each in statements:
            job = self._jobs[each.reading] if each.reading else _Job()
            options, name = each.options, job.name
            if name:
                options = _TURBULENCE.sub("", _PLACES.sub("", options))
            else:
                old = (PurePosixPath(library).parent / each.name.replace("\\", "/")).as_posix()
                name = references.elsewhere(old, self._source, self._out)
                self.beside += [old] if name == old else []
            pieces += [text[at : each.start], os.fsencode(options + name)]
            at = each.end
        return b"".join([*pieces, text[at:]])


def _colored(text: bytes, texture: str) -> bytes:
    """Return a material file whose materials without a texture for colors read this one."""
    starts = [each.start() for each in _MATERIAL.finditer(text)]
    pieces = [text[: starts[0]]] if starts else [text]
    for start, end in zip(starts, [*starts[1:], len(text)]):
        first, *others = text[start:end].splitlines(keepends=True)
        has_one = any(_COLOR_MAP.match(line) for line in others)
        line_end = first[len(first.rstrip(b"\r\n")) :] or b"\n"
        new = [] if has_one else [first.rstrip(b"\r\n"), line_end, b"map_Kd ", os.fsencode(texture), line_end]
        pieces += [*(new or [first]), *others]
    return b"".join(pieces)


def _has_normals(pixels: np.ndarray) -> bool:
    """Return whether most pixels code unit vectors, as those of a normal map do; heights have equal channels."""
    if pixels.shape[2] < 3:
        return False
    highest = np.iinfo(pixels.dtype).max if pixels.dtype.kind == "u" else 1.0
    lengths = np.linalg.norm(2.0 * pixels[::4, ::4, :3].astype(np.float64) / highest - 1.0, axis=2)
    return bool((np.abs(lengths - 1.0) < 0.1).mean() > 0.5)
