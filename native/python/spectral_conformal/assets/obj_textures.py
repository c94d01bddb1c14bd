"""The material files of an OBJ file, with their textures drawn anew for a new UV map.

The format: Wavefront's "Material Library File (.mtl)", and the keys of later programs for roughness, metal and normals.
"""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

import numpy as np

from .._drawing_plan import NewTexture
from .._map_change import MapChange, drawn, new_texture
from .._rebaking import Content, Wrap
from .._texture_size import DrawnTexture, TextureSize, planned, said_of_kept
from .._vertex_colors import NAME, VertexColors
from . import images, references
from .mesh import AssetError
from .shared_textures import (
    BASE_COLOR,
    EMISSIVE,
    METALLIC,
    NORMAL,
    ROUGHNESS,
    Colors,
    Picture,
    SharedTexture,
    SharedTextures,
)

_MATERIAL = re.compile(rb"^[ \t]*newmtl[ \t]+([^\r\n]*)", re.MULTILINE)
_STATEMENT = re.compile(rb"^([ \t]*(map_\w+|bump|disp|decal|norm|refl)[ \t]+)([^\r\n]+)", re.MULTILINE | re.IGNORECASE)
_COLOR_MAP = re.compile(rb"[ \t]*map_Kd[ \t]", re.IGNORECASE)
_PLACES = re.compile(r"-([so])((?:\s+[-+.\deE]+){1,3})(?=\s|$)\s*")
_TURBULENCE = re.compile(r"-t(?:\s+[-+.\deE]+){1,3}(?=\s|$)\s*")
_CLAMPED = re.compile(r"-clamp\s+on\b", re.IGNORECASE)
_COLORS = ("map_ka", "map_kd", "map_ks", "map_ke", "decal")
_MAY_BE_NORMALS = ("norm", "map_kn", "bump", "map_bump")
_REFLECTION = "refl"
# What a texture is for, by its key; any other is for what its key says.
_ROLES = {"map_kd": BASE_COLOR, "map_ke": EMISSIVE, "map_pr": ROUGHNESS, "map_pm": METALLIC}
# By its role, the statement of a value that a texture multiplies, and that of the texture.
_FACTORS = {BASE_COLOR: ("Kd", "map_Kd"), EMISSIVE: ("Ke", "map_Ke"), ROUGHNESS: ("Pr", "map_Pr")}
_FACTORS[METALLIC] = ("Pm", "map_Pm")
_NUMBERS = re.compile(rb"^[ \t]*(Kd|Ke|Pr|Pm)((?:[ \t]+[-+.\deE]+){1,3})(?=[ \t\r]*$)", re.MULTILINE)


@dataclass(frozen=True)
class _Reading:
    """What determines a new texture: the old one, and how a material reads it."""

    path: Path
    content: Content
    offset: tuple[float, float]
    scale: tuple[float, float]
    is_clamped: bool
    role: str = ""
    """That of the image which assets share; empty for one of its own."""
    is_signed: bool = False
    """Whether it has normals as they are, from -1 to 1, as files of floats may."""


@dataclass
class _Job:
    materials: set[bytes] = field(default_factory=set)
    name: str = ""
    """Of the new file; empty if there is none."""


@dataclass(frozen=True)
class _Factor:
    """A line with the value that a material has instead of a texture."""

    material: bytes
    role: str
    start: int
    end: int
    value: tuple[float, ...]


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
        change_of: Callable[[set[bytes]], MapChange],
        has_map: bool,
        size: TextureSize,
        colors: VertexColors | None = None,
        shared: SharedTextures | None = None,
    ) -> None:
        """Read the material files.

        Args:
            source: the OBJ file.
            out: the file to write.
            names: of its material files, as it names them.
            change_of: returns both maps of the faces that have one of these materials.
            has_map: whether there is an old map.
            size: of the new textures.
            colors: for a texture of materials without one; without material files, one gets its own.
            shared: images for all assets on the same map; None for images of its own.
        """
        self.files: dict[Path, list[bytes]] = {}
        """The new files, textures before material files."""
        self.names: dict[str, str] = {}
        """The new name of each material file that exists."""
        self.beside: list[str] = []
        """Textures that stay, relative to the folder of the source."""
        self.warnings: list[str] = []
        self.drawn: list[DrawnTexture] = []
        self.first_lines = b""
        """To stand before the faces, if there were no material files."""
        self._source, self._out, self._size, self._change_of = source, out, size, change_of
        self._has_map, self._colors, self._shared, self._libraries = has_map, colors, shared, names
        self._jobs: dict[_Reading, _Job] = {}
        self._pixels: tuple[Path | None, np.ndarray] = (None, np.zeros(0))
        paths = {name: source.parent / name for name in names}
        self._texts = {name: path.read_bytes() for name, path in paths.items() if path.is_file()}
        self._statements_of = {name: self._statements(name, text) for name, text in self._texts.items()}
        self._factors_of = {name: self._factors(text) if shared else [] for name, text in self._texts.items()}

    def share(self) -> None:
        """Add the textures, the colors, and the values of materials without a texture to those that assets share."""
        assert self._shared is not None
        for reading, job in list(self._jobs.items()):
            change = self._placed(reading, job)
            if not len(change.triangles):
                del self._jobs[reading]
                continue
            read = functools.partial(self._read, reading.path)
            how = reading.content, False, False, self._wrap(reading)
            picture = Picture(read, [change], *how, images.written_as(reading.path.suffix.lower()))
            self._shared.add(reading.role, picture, reading.path.name, self._warn)
        self._pixels = None, np.zeros(0)
        if self._colors:
            self._shared.add(BASE_COLOR, Colors(self._colors), NAME, self._warn)
        for factor in self._all_factors():
            change = self._change_of({factor.material})
            content: Content = "color" if factor.role in (BASE_COLOR, EMISSIVE) else "data"
            if len(change.triangles):
                self._shared.add_fill(factor.role, factor.value, content, change.new, change.triangles)

    def write(self) -> None:
        """Draw the textures, unless they are shared, and make the new files."""
        wanted: dict[_Reading, NewTexture | None] = {}
        for reading, job in self._jobs.items():
            if reading.role and self._shared:
                job.name = self._named_shared(self._shared.find(reading.role))
            else:
                wanted[reading] = self._new(reading, job)
        for reading, texture in planned(self._size, wanted, self._warn).items():
            self._draw(reading, self._jobs[reading], texture)
        coloring = self._store_colors() if self._colors else ""
        for name, text in self._texts.items():
            path = self._free(Path(name).name)
            self.names[name] = path.name
            rewritten = self._rewritten(name, text)
            self.files[path] = [_colored(rewritten, coloring) if coloring else rewritten]
        if coloring and not self._libraries:
            path = self._free(f"{NAME}.mtl")
            self.files[path] = [_colored(b"newmtl %s\n" % NAME.encode(), coloring)]
            self.first_lines = b"mtllib %s\nusemtl %s\n" % (os.fsencode(path.name), NAME.encode())

    def _named_shared(self, drawn: SharedTexture | None) -> str:
        """Return the path of an image that assets share, relative to the new material files; empty without one."""
        if drawn is None:
            return ""
        self.drawn += [] if drawn.record in self.drawn else [drawn.record]
        return drawn.name_from(self._out.parent)

    def _factors(self, text: bytes) -> list[_Factor]:
        """Return the values of materials that have no texture instead; with vertex colors, none of the base color."""
        materials = _materials(text)
        taken = {(_material_at(materials, line.start()), line[2].lower()) for line in _STATEMENT.finditer(text)}
        found = []
        for line in _NUMBERS.finditer(text):
            material = _material_at(materials, line.start())
            role, key = next((role, key) for role, (word, key) in _FACTORS.items() if word.encode() == line[1])
            numbers = [float(number) for number in line[2].split()]
            # One number stands for three.
            value = tuple(numbers if len(numbers) == 3 else numbers[:1] * 3)
            if (material, key.lower().encode()) not in taken and not (role == BASE_COLOR and self._colors):
                found.append(_Factor(material, role, line.start(), line.end(), value))
        return found

    def _all_factors(self) -> Sequence[_Factor]:
        return [factor for factors in self._factors_of.values() for factor in factors]

    def _statements(self, library: str, text: bytes) -> list[_Statement]:
        """Return the lines that name textures, and note which of these to draw."""
        folder = (self._source.parent / library).parent
        materials = _materials(text)
        found = []
        for line in _STATEMENT.finditer(text):
            options, name = _options_and_name(line, folder)
            material = _material_at(materials, line.start())
            reading = self._reading(folder / name.replace("\\", "/"), line[2].decode().lower(), options)
            if reading:
                self._jobs.setdefault(reading, _Job()).materials.add(material)
            found.append(_Statement(line.start(3), line.end(3), options, name, reading))
        return found

    def _reading(self, path: Path, key: str, options: str) -> _Reading | None:
        """Return how a material reads a texture; None if it is not on the map or, with a warning, cannot be drawn."""
        if key == _REFLECTION or not self._has_map:
            return None
        try:
            pixels = self._read(path)
        except AssetError as error:
            self._warn(said_of_kept(path.name, str(error)))
            return None
        content: Content = "color" if key in _COLORS else "data"
        # Codes are not negative.
        is_signed = bool(key in _MAY_BE_NORMALS and (pixels < 0).any() and _has_unit_vectors(pixels))
        if is_signed or (key in _MAY_BE_NORMALS and _has_normals(pixels)):
            content = "normals"
        places = _places(options)
        role = ""
        if self._shared and pixels.dtype.kind == "f":
            self._warn(f"The texture {path.name} is not in the atlas: it has floats.")
        elif self._shared:
            role = NORMAL if content == "normals" else _ROLES.get(key, key.removeprefix("map_"))
        return _Reading(path, content, places["o"], places["s"], bool(_CLAMPED.search(options)), role, is_signed)

    def _warn(self, warning: str) -> None:
        self.warnings += [warning] if warning and warning not in self.warnings else []

    def _read(self, path: Path) -> np.ndarray:
        """Return the pixels of an image; the last one is kept."""
        if self._pixels[0] != path:
            if not path.is_file():
                raise AssetError("its image is missing")
            self._pixels = path, images.read(path.read_bytes(), path.suffix.lower())
        return self._pixels[1]

    def _placed(self, reading: _Reading, job: _Job) -> MapChange:
        """Return both maps of the faces that show a texture, the old one where they read it."""
        change = self._change_of(job.materials)
        placed = change.old * reading.scale + reading.offset
        return MapChange(placed, change.new, change.triangles, change.positions)

    def _wrap(self, reading: _Reading) -> tuple[Wrap, Wrap]:
        return ("clamp", "clamp") if reading.is_clamped else ("repeat", "repeat")

    def _new(self, reading: _Reading, job: _Job) -> NewTexture | None:
        """Return what is to be drawn; None if no face shows it."""
        path = reading.path
        shape = images.shape_of(path.read_bytes(), path.suffix.lower())
        suffix = images.written_as(path.suffix.lower())
        return new_texture(path.name, *shape, [self._placed(reading, job)], self._size, suffix)

    def _draw(self, reading: _Reading, job: _Job, texture: NewTexture) -> None:
        pixels, change = self._read(reading.path), self._placed(reading, job)
        size = TextureSize("size", texture.size)
        how = reading.content, False, False, self._wrap(reading)
        baked, _ = drawn(pixels, [change], size, *how, is_signed=reading.is_signed)
        assert baked is not None
        path = self._free(f"{reading.path.stem}{texture.suffix}")
        job.name = path.name
        self.files[path] = [images.written(baked.image.astype(pixels.dtype, copy=False), texture.suffix)]
        self.drawn.append(DrawnTexture.of(reading.path.name, baked))

    def _store_colors(self) -> str:
        """Add the file of a texture of vertex colors, unless it is shared; return its name."""
        assert self._colors is not None
        if shared := self._shared and self._shared.find(BASE_COLOR):
            return self._named_shared(shared)
        baked = self._colors.drawn(self._size)
        path = self._free(f"{NAME}.png")
        self.files[path] = [images.written(baked.image, ".png")]
        self.drawn.append(DrawnTexture.of(NAME, baked))
        return path.name

    def _free(self, name: str) -> Path:
        """Return the path of a new file for an old one with this name."""
        taken = {path.name for path in self.files}
        return references.free_beside(self._out, f"{self._out.stem}_{name}", self._source, taken)

    def _rewritten(self, library: str, text: bytes) -> bytes:
        """Return a material file that names the new textures, and the others from its new folder."""
        parts: list[tuple[int, int, bytes]] = []
        for each in self._statements_of[library]:
            job = self._jobs.get(each.reading, _Job()) if each.reading else _Job()
            options, name = each.options, job.name
            if name:
                options = _TURBULENCE.sub("", _PLACES.sub("", options))
            else:
                old = (PurePosixPath(library).parent / each.name.replace("\\", "/")).as_posix()
                name = references.elsewhere(old, self._source, self._out)
                self.beside += [old] if name == old else []
            parts.append((each.start, each.end, os.fsencode(options + name)))
        for factor in self._factors_of[library]:
            if name := self._named_shared(self._shared and self._shared.find(factor.role)):
                word, key = _FACTORS[factor.role]
                one = b" 1" * (3 if factor.role in (BASE_COLOR, EMISSIVE) else 1)
                line = b"%s%s\n%s %s" % (word.encode(), one, key.encode(), os.fsencode(name))
                parts.append((factor.start, factor.end, line))
        pieces, at = [], 0
        for start, end, new in sorted(parts):
            pieces += [text[at:start], new]
            at = end
        return b"".join([*pieces, text[at:]])


def moves_textures(path: Path, used: Collection[bytes]) -> bool:
    """Return whether used materials of a file scale or move textures on the map."""
    text = path.read_bytes()
    materials = _materials(text)
    return any(
        _places(_options_and_name(line, path.parent)[0]) != _places("")
        for line in _STATEMENT.finditer(text)
        if line[2].decode().lower() != _REFLECTION and _material_at(materials, line.start()) in used
    )


def _options_and_name(line: re.Match[bytes], folder: Path) -> tuple[str, str]:
    """Return the two parts of a statement that names a texture."""
    rest = os.fsdecode(line[3].strip())
    name = references.name_of(rest, folder)
    return rest[: len(rest) - len(name)], name


def _places(options: str) -> dict[str, tuple[float, float]]:
    """Return the offset "o" and the scale "s" of a texture."""
    places = {"o": (0.0, 0.0), "s": (1.0, 1.0)}
    for what, numbers in _PLACES.findall(options):
        given = [float(number) for number in numbers.split()]
        places[what] = (given[0], given[1] if len(given) > 1 else places[what][1])
    return places


def _materials(text: bytes) -> list[tuple[int, bytes]]:
    """Return where the materials of a file begin, and their names."""
    return [(each.start(), each[1].strip()) for each in _MATERIAL.finditer(text)]


def _material_at(materials: Sequence[tuple[int, bytes]], place: int) -> bytes:
    """Return the material to which a place belongs; empty before the first one."""
    return next((name for start, name in reversed(materials) if start < place), b"")


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
    highest = np.iinfo(pixels.dtype).max if pixels.dtype.kind == "u" else 1.0
    return _has_unit_vectors(2.0 * pixels[::4, ::4].astype(np.float64) / highest - 1.0)


def _has_unit_vectors(pixels: np.ndarray) -> bool:
    """Return whether the first three channels of most pixels are unit vectors."""
    if pixels.shape[2] < 3:
        return False
    lengths = np.linalg.norm(pixels[:, :, :3].astype(np.float64), axis=2)
    return bool((np.abs(lengths - 1.0) < 0.1).mean() > 0.5)
