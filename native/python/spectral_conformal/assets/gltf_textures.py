"""The textures of a glTF file that read a replaced UV set, drawn anew for the new one."""

from __future__ import annotations

import base64
import binascii
import copy
import functools
import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from .._drawing_plan import NewTexture
from .._map_change import MapChange, drawn, new_texture
from .._rebaking import Content, Wrap
from .._texture_size import DrawnTexture, TextureSize, planned, said_of_kept, said_of_left
from . import images
from .mesh import AssetError
from .shared_textures import (
    BASE_COLOR,
    EMISSIVE,
    METALLIC_ROUGHNESS,
    NORMAL,
    OCCLUSION,
    Picture,
    SharedTexture,
    SharedTextures,
)

_Json = dict[str, Any]
_Floats = npt.NDArray[np.float64]

UV_SET = "TEXCOORD_"
TRANSFORM = "KHR_texture_transform"
COLORS = "COLOR_0"
_VARIANTS = "KHR_materials_variants"
_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
# By the end of the key in the material. Numbers that light does not multiply are data.
_COLORS = (
    "baseColorTexture",
    "diffuseTexture",
    "emissiveTexture",
    "specularGlossinessTexture",
    "sheenColorTexture",
    "specularColorTexture",
    "diffuseTransmissionColorTexture",
)
_NORMALS = ("normalTexture", "clearcoatNormalTexture")
_WITH_OPACITY = ("baseColorTexture", "diffuseTexture")
_DIRECTIONS = "anisotropyTexture"
# Other sources of a texture that can be read, and those that cannot.
_READABLE_SOURCES = ("EXT_texture_webp",)
_OTHER_SOURCES = ("KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif")
_WRAPS: dict[int, Wrap] = {33071: "clamp", 33648: "mirror"}
_NEAREST = 9728
TRIANGLES, STRIP, FAN = 4, 5, 6
"""Modes of primitives with faces; others are points and lines."""
# Names images by their numbers, which then must stay.
_IMAGE_BASED_LIGHTS = "EXT_lights_image_based"
# Of every material. What it has of them instead of a texture: the key of the texture and of the factor, and the
# factor's default.
_FACTORS: dict[str, tuple[str, str, Sequence[float]]] = {
    BASE_COLOR: ("baseColorTexture", "baseColorFactor", (1.0, 1.0, 1.0, 1.0)),
    METALLIC_ROUGHNESS: ("metallicRoughnessTexture", "", ()),
    NORMAL: ("normalTexture", "", (0.5, 0.5, 1.0)),
    OCCLUSION: ("occlusionTexture", "", (1.0, 1.0, 1.0)),
    EMISSIVE: ("emissiveTexture", "emissiveFactor", (0.0, 0.0, 0.0)),
}
_OF_SURFACE = (BASE_COLOR, METALLIC_ROUGHNESS)


@dataclass(frozen=True)
class _Reading:
    """What determines a new texture: the old one, and how materials read it."""

    texture: int
    content: Content
    has_opacity: bool
    offset: tuple[float, float]
    rotation: float
    scale: tuple[float, float]
    role: str = ""
    """That of the image which assets share; empty for one of its own."""

    def placed(self, uv: _Floats) -> _Floats:
        """Return where the texture is read for stored UVs (n, 2); v runs up in the result."""
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        u, v = (uv * self.scale).T
        return np.c_[cos * u + sin * v + self.offset[0], 1.0 - (cos * v - sin * u + self.offset[1])]


@dataclass
class Surface:
    """The triangles of a group of primitives; rows are its vertices, split at the seams of the new map."""

    primitives: list[_Json]
    """In the new document."""
    old: _Floats | None
    """(rows, 2) as stored; None without an old map."""
    new: _Floats
    """(rows, 2) as stored."""
    triangles: list[npt.NDArray[np.integer]]
    """(n, 3) of each primitive."""
    materials: list[set[int]]
    """Of each primitive, also those of its variants."""
    positions: _Floats
    """(rows, 3)"""
    normals: _Floats | None
    """(rows, 3); None for those of the triangles."""
    tangents: _Floats | None
    """(rows, 4) of the old map; None for those of its triangles."""
    new_tangents: _Floats | None
    """(rows, 4) of the new map, if the file has tangents."""

    @property
    def upward(self) -> _Floats:
        """(rows, 2) the new map, v upward."""
        return self.new * (1, -1) + (0, 1)

    def change(self, materials: set[int], reading: _Reading) -> MapChange:
        """Return both maps of the triangles that have one of these materials; none without an old map."""
        old = self.new if self.old is None else self.old
        if self.old is None:
            materials = set()
        chosen = [each for each, own in zip(self.triangles, self.materials) if own & materials]
        triangles = np.concatenate([*chosen, np.zeros((0, 3), np.int64)]).astype(np.int64)
        # As glTF prescribes, tangents are ignored without normals.
        given = (None, None) if self.normals is None else (self.tangents, self.new_tangents)
        placed = reading.placed(old)
        return MapChange(placed, self.upward, triangles, self.positions, self.normals, given).part(triangles)


@dataclass
class _Job:
    name: str
    infos: list[_Json] = field(default_factory=list)
    materials: set[int] = field(default_factory=set)


class Redrawing:
    """Draws the textures of a document that read one UV set. Without textures there, nothing changes."""

    def __init__(
        self,
        document: _Json,
        uv_set: str,
        size: TextureSize,
        contents: Sequence[bytes | None],
        shared: SharedTextures | None = None,
    ) -> None:
        """Find the textures.

        Args:
            document: to be changed.
            uv_set: name of the attribute.
            size: of the new textures.
            contents: of the files of all images; None for those that are missing.
            shared: images for all assets on the same map; None for images of its own.
        """
        self.taken: set[tuple[int, int]] = set()
        """The material of each reference that is to read a new texture, and the number of the reference in it."""
        self.warnings: list[str] = []
        self.drawn: list[DrawnTexture] = []
        self._document = document
        self._uv_set = uv_set
        self._size = size
        self._contents = contents
        self._surfaces: list[Surface] = []
        self._jobs: dict[_Reading, _Job] = {}
        self._shared = shared
        meshes = document.get("meshes", [])
        choices = [materials_of(primitive) for mesh in meshes for primitive in mesh["primitives"]]
        # Of primitives that show one or another: these lie on each other in the map.
        self._variants = set().union(*(each for each in choices if len(each) > 1))
        for number, material in enumerate(document.get("materials", [])):
            for k, (role, info) in enumerate(_named_infos(material)):
                if set_of(info) == uv_set and self._can_read(info["index"]):
                    self._add_job(number, material, role, info)
                    self.taken.add((number, k))
        drawn = {number for number, _ in self.taken}
        for mesh in meshes:
            for primitive in mesh["primitives"]:
                has_map = uv_set in primitive["attributes"]
                if has_map and not has_faces(primitive) and materials_of(primitive) & drawn:
                    self._warn(said_of_left(f"A primitive of {mesh.get('name', 'a mesh')} without faces"))
        if any(TRANSFORM in str(each) for each in _pointers(document)):
            self._warn(f"Animations of {TRANSFORM} no longer fit the new textures.")

    def add(self, surface: Surface) -> None:
        """Add triangles with both maps."""
        self._surfaces.append(surface)

    def images(self) -> Iterator[tuple[int, str, bytes]]:
        """Draw the textures, one after the other; yield the number of each image, its file's name and its content.

        The document's materials read them then; an image with the number of an old one replaces that.
        """
        kept = self._kept_images()
        replaced: set[int] = set()
        for reading, texture in self._planned().items():
            job, number, suffix = self._jobs[reading], self._image_of(reading), texture.suffix
            try:
                old = images.read(self._contents[number])
            except AssetError as error:
                self._warn_of_kept(job.name, str(error))
                continue
            how = TextureSize("size", texture.size), *self._how(reading)
            baked, _ = drawn(old, self._changes(reading, job), *how)
            assert baked is not None
            self.drawn.append(DrawnTexture.of(job.name, baked))
            new = number
            if number in kept or number in replaced:
                self._document["images"].append({**self._document["images"][number]})
                new = len(self._document["images"]) - 1
            replaced.add(new)
            self._document["images"][new].update(mimeType=images.MIME_TYPES[suffix])
            self._point(reading, job, new)
            self._drop_unused()
            yield new, f"{Path(job.name).stem}{suffix}", images.written(baked.image, suffix)

    def _planned(self) -> dict[_Reading, NewTexture]:
        """Return the textures to draw, without those that assets share."""
        wanted: dict[_Reading, NewTexture | None] = {}
        for reading, job in self._jobs.items():
            if reading.role:
                continue
            content = self._contents[self._image_of(reading)]
            suffix = ".jpg" if images.suffix_of(content) == ".jpg" else ".png"
            try:
                shape = images.shape_of(content)
            except AssetError as error:
                self._warn_of_kept(job.name, str(error))
                continue
            wanted[reading] = new_texture(job.name, *shape, self._changes(reading, job), self._size, suffix)
        return planned(self._size, wanted, self._warn)

    def _image_of(self, reading: _Reading) -> int:
        """Return the number of the image that a texture shows."""
        return _sources_of(self._document["textures"][reading.texture], readable=True)[0]

    def _changes(self, reading: _Reading, job: _Job) -> list[MapChange]:
        return [each.change(job.materials, reading) for each in self._surfaces]

    def share(self, colored: Sequence[_Json]) -> None:
        """Add the textures to those that assets share, and for primitives without one what they have instead.

        Args:
            colored: primitives whose vertex colors become base colors.
        """
        assert self._shared is not None
        for reading, job in list(self._jobs.items()):
            changes = self._changes(reading, job)
            if not reading.role:
                continue
            if not any(len(each.triangles) for each in changes):
                del self._jobs[reading]
                continue
            content = self._contents[self._image_of(reading)]
            assert content is not None
            read = functools.partial(images.read, content)
            try:
                picture = Picture(read, changes, *self._how(reading), images.suffix_of(content))
            except AssetError as error:
                self._warn_of_kept(job.name, str(error))
                del self._jobs[reading]
            else:
                self._shared.add(reading.role, picture, job.name, self._warn)
        for surface in self._surfaces:
            for primitive, triangles in zip(surface.primitives, surface.triangles):
                for role in self._lacking(primitive):
                    if role != BASE_COLOR or not any(primitive is each for each in colored):
                        content = "color" if role in (BASE_COLOR, EMISSIVE) else "data"
                        value = _factor(self._material(primitive), role)
                        self._shared.add_fill(role, value, content, surface.upward, triangles)

    def point_to_shared(self, number_of: Callable[[SharedTexture], int]) -> None:
        """Let the materials read the images that assets share, once these are drawn.

        Args:
            number_of: adds such an image to the document; returns its number.
        """
        assert self._shared is not None
        old: set[int] = set()
        records: dict[Path, DrawnTexture] = {}
        for reading, job in self._jobs.items():
            if reading.role and (drawn := self._shared.find(reading.role)):
                old |= set(_sources_of(self._document["textures"][reading.texture]))
                self._point(reading, job, number_of(drawn))
                records[drawn.path] = drawn.record
        self._drop_unused()
        textures: dict[str, int] = {}
        for primitive in [each for surface in self._surfaces for each in surface.primitives]:
            for role in self._lacking(primitive):
                drawn = self._shared.find(role)
                if drawn is None:
                    continue
                if role not in textures:
                    self._document.setdefault("textures", []).append({"source": number_of(drawn)})
                    textures[role] = len(self._document["textures"]) - 1
                if "material" not in primitive:
                    self._document.setdefault("materials", []).append({})
                    primitive["material"] = len(self._document["materials"]) - 1
                place = int(self._uv_set.removeprefix(UV_SET))
                _replace_factor(self._material(primitive), role, {"index": textures[role], "texCoord": place})
                records[drawn.path] = drawn.record
        self.drawn += records.values()
        self._drop_images(old)

    def _lacking(self, primitive: _Json) -> list[str]:
        """Return the roles for which the one material of a primitive has a factor instead of a texture."""
        material = self._material(primitive)
        if _VARIANTS in primitive.get("extensions", {}) or primitive.get("material") in self._variants:
            return []
        present = {name for name, _ in _named_infos(material)}
        has_surface = _GLOSSINESS not in material.get("extensions", {})
        return [
            role
            for role, (key, _, _) in _FACTORS.items()
            if key not in present and (has_surface or role not in _OF_SURFACE)
        ]

    def _material(self, primitive: _Json) -> _Json:
        return self._document["materials"][primitive["material"]] if "material" in primitive else {}

    def _drop_images(self, numbers: set[int]) -> None:
        """Remove those of these images that nothing reads any more."""
        textures = self._document.get("textures", [])
        unused = numbers - {source for texture in textures for source in _sources_of(texture)}
        if not unused or _IMAGE_BASED_LIGHTS in self._document.get("extensions", {}):
            return
        kept = [number for number in range(len(self._document.get("images", []))) if number not in unused]
        new = {old: number for number, old in enumerate(kept)}
        self._document["images"] = [self._document["images"][number] for number in kept]
        for texture in textures:
            for part in (texture, *texture.get("extensions", {}).values()):
                if isinstance(part, dict) and "source" in part:
                    part["source"] = new[part["source"]]

    def _can_read(self, texture: int) -> bool:
        """Return whether the image of a texture can be read; if not, warn."""
        sources = _sources_of(self._document["textures"][texture], readable=True)
        content = self._contents[sources[0]] if sources else b""
        if content is None:
            self._warn_of_kept(self._name_of(texture), "its image is missing")
        elif images.suffix_of(content) not in images.OF_GLTF:
            self._warn_of_kept(self._name_of(texture), "only PNG, JPEG and WebP can be read")
        return bool(content) and images.suffix_of(content) in images.OF_GLTF

    def _warn_of_kept(self, name: str, reason: str) -> None:
        self._warn(said_of_kept(name, reason))

    def _add_job(self, number: int, material: _Json, role: str, info: _Json) -> None:
        change = info.get("extensions", {}).get(TRANSFORM, {})
        offset, scale = (tuple(map(float, change.get(*each))) for each in (("offset", (0, 0)), ("scale", (1, 1))))
        content: Content = "color" if role in _COLORS else "normals" if role in _NORMALS else "data"
        has_opacity = role in _WITH_OPACITY and material.get("alphaMode", "OPAQUE") != "OPAQUE"
        rotation = float(change.get("rotation", 0.0))
        named = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", role.removesuffix("Texture")).lower() if self._shared else ""
        if named and number in self._variants:
            self._warn(f"The texture {self._name_of(info['index'])} is not in the atlas: it belongs to a variant.")
            named = ""
        reading = _Reading(info["index"], content, has_opacity, offset, rotation, scale, named)
        job = self._jobs.setdefault(reading, _Job(self._name_of(info["index"])))
        job.infos.append(info)
        job.materials.add(number)
        if role == _DIRECTIONS:
            self._warn(f"The directions in the texture {job.name} were not turned to the new map.")

    def _how(self, reading: _Reading) -> tuple[Content, bool, bool, tuple[Wrap, Wrap]]:
        """Return what a texture means and how it is read, as `drawn` takes it."""
        sampler = self._sampler_of(reading.texture)
        first, second = (_WRAPS.get(sampler.get(key), "repeat") for key in ("wrapS", "wrapT"))
        return reading.content, reading.has_opacity, sampler.get("magFilter") == _NEAREST, (first, second)

    def _point(self, reading: _Reading, job: _Job, image: int) -> None:
        """Let the references of a job read the new image, from the map itself."""
        users = [info for material in self._document["materials"] for _, info in _named_infos(material)]
        texture = {key: value for key, value in self._document["textures"][reading.texture].items() if key != "source"}
        extensions = {
            key: value
            for key, value in texture.pop("extensions", {}).items()
            if key not in (*_READABLE_SOURCES, *_OTHER_SOURCES)
        }
        texture = {**texture, "source": image, **({"extensions": extensions} if extensions else {})}
        if sum(info["index"] == reading.texture for info in users) == len(job.infos):
            self._document["textures"][reading.texture] = texture
            number = reading.texture
        else:
            self._document["textures"].append(texture)
            number = len(self._document["textures"]) - 1
        for info in job.infos:
            info["index"] = number
            change = info.get("extensions", {}).pop(TRANSFORM, {})
            if "texCoord" in change:
                info["texCoord"] = change["texCoord"]
            if not info.get("extensions", True):
                del info["extensions"]

    def _drop_unused(self) -> None:
        """Name no extensions that only the old textures used, and that a reader might have to know."""
        for key in ("extensionsUsed", "extensionsRequired"):
            names = self._document.get(key, [])
            of_textures = (TRANSFORM, *_READABLE_SOURCES, *_OTHER_SOURCES)
            left = [name for name in names if name not in of_textures or _has_key(self._document, name)]
            if left:
                self._document[key] = left
            elif names:
                del self._document[key]

    def _kept_images(self) -> set[int]:
        """Return the images that something reads that is not drawn anew."""
        taken = {id(info) for job in self._jobs.values() for info in job.infos}
        # Anything that looks like a reference counts, also in extensions.
        others = [info for info in texture_infos(self._document) if id(info) not in taken]
        textures = self._document.get("textures", [])
        kept = {info["index"] for info in others if info["index"] < len(textures)}
        unread = set(range(len(textures))) - {reading.texture for reading in self._jobs}
        return {image for number in kept | unread for image in _sources_of(textures[number])}

    def _name_of(self, texture: int) -> str:
        number = next(iter(_sources_of(self._document["textures"][texture])), None)
        if number is None:
            return str(texture)
        image = self._document["images"][number]
        uri = image.get("uri", "data:")
        return image.get("name", str(number)) if uri.startswith("data:") else Path(unquote(uri)).name

    def _sampler_of(self, texture: int) -> _Json:
        number = self._document["textures"][texture].get("sampler")
        return {} if number is None else self._document["samplers"][number]

    def _warn(self, warning: str) -> None:
        if warning and warning not in self.warnings:
            self.warnings.append(warning)


def content_of(image: _Json, folder: Path, view: Any) -> bytes | None:  # noqa: ANN401 - a function
    """Return the content of an image's file; None if it is missing.

    Args:
        image: its description.
        folder: of the glTF file.
        view: returns the content of a buffer view by its number.
    """
    if "bufferView" in image:
        return view(image["bufferView"])
    uri = image.get("uri", "")
    if uri.startswith("data:"):
        try:
            return base64.b64decode(uri.partition(",")[2], validate=True)
        except binascii.Error:
            return None
    path = folder / unquote(uri)
    return path.read_bytes() if uri and path.is_file() else None


def materials_of(primitive: _Json) -> set[int]:
    """Return the materials of a primitive and of its variants."""
    mappings = primitive.get("extensions", {}).get(_VARIANTS, {}).get("mappings", [])
    return {each["material"] for each in (primitive, *mappings) if "material" in each}


def lacks_colors(document: _Json, primitive: _Json) -> bool:
    """Return whether the vertex colors of a primitive can become a texture: its one material has none for colors."""
    targets = primitive.get("targets", [])
    if _VARIANTS in primitive.get("extensions", {}) or any(COLORS in each for each in targets):
        return False
    material = document["materials"][primitive["material"]] if "material" in primitive else {}
    parts = material.get("pbrMetallicRoughness", {}), material.get("extensions", {}).get(_GLOSSINESS, {})
    return not any({"baseColorTexture", "diffuseTexture"} & part.keys() for part in parts)


def has_opacity(document: _Json, primitives: Sequence[_Json]) -> bool:
    """Return whether the material of one of these primitives blends or cuts out."""
    materials = [document["materials"][each["material"]] for each in primitives if "material" in each]
    return any(each.get("alphaMode", "OPAQUE") != "OPAQUE" for each in materials)


def color_by(document: _Json, primitives: Sequence[_Json], image: int, uv_set: str) -> None:
    """Let an image on a UV set color these primitives instead of their vertices; others keep their materials."""
    document.setdefault("textures", []).append({"source": image})
    info = {"index": len(document["textures"]) - 1, "texCoord": int(uv_set.removeprefix(UV_SET))}
    materials = document.setdefault("materials", [])
    colored = {id(each) for each in primitives}
    others = [each for mesh in document["meshes"] for each in mesh["primitives"] if id(each) not in colored]
    taken = set().union(*map(materials_of, others))
    new: dict[int | None, int] = {}
    for primitive in primitives:
        old = primitive.get("material")
        if old not in new:
            new[old] = len(materials) if old is None or old in taken else old
            if new[old] != old:
                materials.append({} if old is None else copy.deepcopy(materials[old]))
            material = materials[new[old]]
            material.setdefault("pbrMetallicRoughness", {})["baseColorTexture"] = info
            if _GLOSSINESS in material.get("extensions", {}):
                material["extensions"][_GLOSSINESS]["diffuseTexture"] = dict(info)
        primitive["material"] = new[old]
        # A name of the file's own: colors that multiply the texture would count twice.
        primitive["attributes"] = {
            f"_{key}" if key == COLORS else key: number for key, number in primitive["attributes"].items()
        }


def _factor(material: _Json, role: str) -> list[float]:
    """Return the values, (3,), that a material has instead of a texture: colors as light, others as stored."""
    surface = material.get("pbrMetallicRoughness", {})
    if role == METALLIC_ROUGHNESS:
        return [1.0, *(float(surface.get(key, 1.0)) for key in ("roughnessFactor", "metallicFactor"))]
    _, key, default = _FACTORS[role]
    found = (surface if role in _OF_SURFACE else material).get(key, default)
    return [float(value) for value in found[:3]]


def _replace_factor(material: _Json, role: str, info: _Json) -> None:
    """Let a material read a texture that has its factor, which it loses; of the base color the opacity stays."""
    key, factor, _ = _FACTORS[role]
    part = material.setdefault("pbrMetallicRoughness", {}) if role in _OF_SURFACE else material
    part[key] = info
    if role == METALLIC_ROUGHNESS:
        part.pop("roughnessFactor", None)
        part.pop("metallicFactor", None)
    elif role == EMISSIVE:
        part[factor] = [1.0, 1.0, 1.0]
    elif role == BASE_COLOR:
        opacity = part.pop(factor, [1.0])[-1]
        part.update({} if opacity == 1.0 else {factor: [1.0, 1.0, 1.0, opacity]})


def texture_infos(part: object) -> Iterator[_Json]:
    """Yield the references to textures in a material or an extension."""
    for _, info in _named_infos(part):
        yield info


def _named_infos(part: object, name: str = "") -> Iterator[tuple[str, _Json]]:
    """Yield the references to textures, each with the key at which it stands."""
    if isinstance(part, dict):
        if isinstance(part.get("index"), int):
            yield name, part
        for key, value in part.items():
            yield from _named_infos(value, key)
    elif isinstance(part, list):
        for value in part:
            yield from _named_infos(value, name)


def has_faces(primitive: _Json) -> bool:
    """Return whether a primitive has faces, which then are mapped."""
    return primitive.get("mode", TRIANGLES) in (TRIANGLES, STRIP, FAN)


def set_of(info: _Json) -> str:
    """Return the name of the UV set that a reference to a texture uses."""
    change = info.get("extensions", {}).get(TRANSFORM, {})
    return f"{UV_SET}{change.get('texCoord', info.get('texCoord', 0))}"


def _has_key(part: object, key: str) -> bool:
    """Return whether a part of the document has a key anywhere."""
    if isinstance(part, dict):
        return key in part or any(_has_key(value, key) for value in part.values())
    return isinstance(part, list) and any(_has_key(each, key) for each in part)


def _sources_of(texture: _Json, readable: bool = False) -> list[int]:
    """Return the images of a texture."""
    extensions = texture.get("extensions", {})
    names = _READABLE_SOURCES if readable else (*_READABLE_SOURCES, *_OTHER_SOURCES)
    found = [extensions[name].get("source") for name in names if name in extensions]
    return [number for number in (*found, texture.get("source")) if number is not None]


def _pointers(document: _Json) -> Iterator[object]:
    """Yield the targets of animations that are extensions."""
    for animation in document.get("animations", []):
        for channel in animation.get("channels", []):
            yield channel.get("target", {}).get("extensions", "")
