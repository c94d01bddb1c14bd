"""The textures of a USD file that read a replaced primvar, drawn anew for the new one.

Of materials of UsdPreviewSurface: UsdUVTexture, which a UsdPrimvarReader_float2 places, maybe by a UsdTransform2d or
several.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._drawing_plan import NewTexture
from .._map_change import MapChange, drawn, new_texture
from .._rebaking import Content, Wrap
from .._texture_size import DrawnTexture, TextureSize, planned, said_of_kept, said_of_left
from . import images
from .mesh import AssetError
from .shared_textures import BASE_COLOR, EMISSIVE, METALLIC, ROUGHNESS, Picture, SharedTextures

if TYPE_CHECKING:
    from pxr import Sdf, Usd, UsdShade

_TEXTURE, _READER, _TRANSFORM = "UsdUVTexture", "UsdPrimvarReader_float2", "UsdTransform2d"
_MATERIAL_X = ("ND_image", "ND_tiledimage")
# Shaders that change where textures are read, by the beginnings of their identifiers: the input that names the map, and
# those that change it, with the values that do not.
_PLACING: dict[str, tuple[str, dict[str, Any]]] = {
    _TRANSFORM: ("in", {"scale": (1.0, 1.0), "rotation": 0.0, "translation": (0.0, 0.0)}),
    "ND_place2d": ("texcoord", {"scale": (1.0, 1.0), "rotate": 0.0, "offset": (0.0, 0.0)}),
    "ND_tiledimage": ("texcoord", {"uvtiling": (1.0, 1.0), "uvoffset": (0.0, 0.0)}),
}
READERS = {_READER: "varname", "ND_geompropvalue_vector2": "geomprop"}
"""Shaders that read UVs, and the input that names the primvar."""
# Also by the names that files of textures have for them.
_WRAPS: dict[str, Wrap] = {
    "repeat": "repeat",
    "periodic": "repeat",
    "mirror": "mirror",
    "clamp": "clamp",
    "black": "black",
}
# Of UVs, which files keep to 7 digits.
_ROUNDED = 1e-5
_COLORS = ("diffuseColor", "emissiveColor", "specularColor")
# The default of a shader's wrap modes.
_OF_FILE = "useMetadata"
_NORMAL, _OPACITY, _DIFFUSE = "normal", "opacity", "diffuseColor"
_SURFACE = "UsdPreviewSurface"
# By its role, an input of surfaces that a texture may feed, and its value without one, by the specification.
_FACTORS: dict[str, tuple[str, Any]] = {
    BASE_COLOR: (_DIFFUSE, (0.18, 0.18, 0.18)),
    EMISSIVE: ("emissiveColor", (0.0, 0.0, 0.0)),
    ROUGHNESS: ("roughness", 0.5),
    METALLIC: ("metallic", 0.0),
}
_COLOR_READER, DISPLAY_COLOR = "UsdPrimvarReader_float3", "displayColor"
_BINDING, _BOUND = "MaterialBindingAPI", "material:binding"
# What a texture is for, by the inputs that it feeds; any other is for what they say.
_ROLES = {"diffuseColor": BASE_COLOR, "emissiveColor": EMISSIVE}


@dataclass(frozen=True)
class _Move:
    """A UsdTransform2d."""

    scale: tuple[float, float]
    angle: float
    offset: tuple[float, float]

    @classmethod
    def of(cls, shader: UsdShade.Shader) -> _Move:
        """Return that of a shader; its rotation is in degrees."""
        scale, offset = (tuple(_value(shader, *each)) for each in (("scale", (1.0, 1.0)), ("translation", (0.0, 0.0))))
        return cls(scale, math.radians(_value(shader, "rotation", 0.0)), offset)

    def moved(self, uv: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return UVs, (n, 2), after it."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        u, v = (uv * self.scale).T
        return np.c_[cos * u - sin * v, sin * u + cos * v] + self.offset


@dataclass(frozen=True)
class _Reading:
    """What determines a new texture: the old one, and how shaders read it."""

    path: str
    content: Content
    has_opacity: bool
    wraps: tuple[Wrap, Wrap]
    moves: tuple[_Move, ...]
    """One after the other."""
    role: str = ""
    """That of the image which assets share; empty for one of its own."""
    is_signed: bool = False
    """Whether it has normals as they are, from -1 to 1, as files of floats may."""

    @property
    def name(self) -> str:
        """That of its file."""
        return PurePosixPath(self.path.rpartition("[")[2].rstrip("]").replace("\\", "/")).name

    def placed(self, uv: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return where the texture is read for UVs (n, 2)."""
        for move in self.moves:
            uv = move.moved(uv)
        return uv


@dataclass
class _Job:
    shaders: dict[Sdf.Path, Sdf.Path] = field(default_factory=dict)
    """Each with the output that is to place it."""
    changes: list[MapChange] = field(default_factory=list)


class Redrawing:
    """Draws the textures of a stage that read replaced primvars."""

    def __init__(self, size: TextureSize, shared: SharedTextures | None = None) -> None:
        """Begin without meshes; `shared` are images for all assets on the same map."""
        self.warnings: list[str] = []
        self.drawn: list[DrawnTexture] = []
        self._size, self._shared = size, shared
        self._values: dict[tuple[Sdf.Path, str], str] = {}
        """The primvar of the map for each surface and role that has a value instead of a texture."""
        self._jobs: dict[_Reading, _Job] = {}

    def add(self, material: UsdShade.Material, name: str, change: MapChange, has_map: bool) -> None:
        """Add triangles with both maps of a primvar, and the material that they show; maybe there is no old map."""
        from pxr import Usd, UsdShade

        if self._shared:
            self._add_values(material, name, change)
        if not has_map:
            return
        for prim in Usd.PrimRange(material.GetPrim()):
            shader = UsdShade.Shader(prim)
            identifier = (shader.GetShaderId() if prim.IsA(UsdShade.Shader) else "") or ""
            if identifier.startswith(_MATERIAL_X):
                self._warn(said_of_kept(_file_of(shader)[0], "it is one of MaterialX"))
            if identifier != _TEXTURE:
                continue
            place = _place(shader)
            if place is None:
                self._warn(said_of_kept(_file_of(shader)[0], "what places it is no primvar"))
            elif place[0] == name:
                reading = self._reading(shader, material, place[2], change)
                if reading is not None:
                    job = self._jobs.setdefault(reading, _Job())
                    job.shaders[prim.GetPath()] = place[1]
                    job.changes.append(change)

    def note_left(self, material: UsdShade.Material, place: Sdf.Path) -> None:
        """Warn if what has this material, at this path, keeps its map, but shows textures that are drawn anew."""
        shaders = [shader for job in self._jobs.values() for shader in job.shaders]
        if any(shader.HasPrefix(material.GetPath()) for shader in shaders):
            self._warn(said_of_left(str(place)))

    def _add_values(self, material: UsdShade.Material, name: str, change: MapChange) -> None:
        """Add what the surface of a material has instead of textures."""
        surface = material.ComputeSurfaceSource()[0]
        if not surface or surface.GetShaderId() != _SURFACE:
            return
        for role, (key, default) in _FACTORS.items():
            if _source(surface, key) is None:
                value = np.ravel(_value(surface, key, default)).tolist()
                value = value if len(value) == 3 else value[:1] * 3
                content: Content = "color" if key in _COLORS else "data"
                self._shared.add_fill(role, value, content, change.new, change.triangles)
                self._values[surface.GetPath(), role] = name

    def share(self) -> None:
        """Add the textures to those that assets share; those that cannot be shared stay on their own."""
        assert self._shared is not None
        kept: dict[_Reading, _Job] = {}
        for reading, job in self._jobs.items():
            placed, suffix = self._placed(reading, job), Path(reading.name).suffix.lower()
            role = reading.role if any(len(each.triangles) for each in placed) else ""
            read = functools.partial(_pixels, reading)
            try:
                if role and read().dtype.kind == "f":
                    self._warn(f"The texture {reading.name} is not in the atlas: it has floats.")
                    role = ""
                if role:
                    how = reading.content, reading.has_opacity, False, reading.wraps
                    picture = Picture(read, placed, *how, images.written_as(suffix))
                    self._shared.add(role, picture, reading.name, self._warn)
            except AssetError:
                # Said when it is drawn on its own.
                role = ""
            kept[replace(reading, role=role)] = job
        self._jobs = kept

    def draw(self, layer: Sdf.Layer, named: Any, folder: Path | None) -> Iterator[tuple[Path, bytes]]:  # noqa: ANN401 - a function
        """Draw the textures; yield the path and content of each file, which the shaders in the layer then read.

        Args:
            layer: to be changed.
            named: returns the path of a new file for an old one's name.
            folder: of the layer; None for a package, which holds copies of the textures that assets share.
        """
        packed: dict[Path, bytes] = {}
        names: dict[str, str] = {}
        own = self._planned()

        def name_of(role: str) -> str:
            """Return how the layer names an image that assets share; empty if there is none."""
            shared = self._shared.find(role) if self._shared and role else None
            if shared and role not in names:
                self.drawn.append(shared.record)
                path = None if folder else named(shared.path.name)
                names[role] = path.name if path else shared.name_from(folder)
                packed.update({path: shared.content} if path else {})
            return names.get(role, "")

        for (surface, role), primvar in self._values.items():
            if name_of(role):
                color_by(layer, surface, name_of(role), primvar, _FACTORS[role][0])
        for reading, job in self._jobs.items():
            if name_of(reading.role):
                _point(layer, job, name_of(reading.role))
            if reading not in own:
                continue
            suffix = own[reading].suffix
            try:
                old = _pixels(reading)
            except AssetError as error:
                self._warn(said_of_kept(reading.name, str(error)))
                continue
            how = reading.content, reading.has_opacity, False, reading.wraps
            size = TextureSize("size", own[reading].size)
            baked, _ = drawn(old, self._placed(reading, job), size, *how, is_signed=reading.is_signed)
            assert baked is not None
            path = named(f"{Path(reading.name).stem}{suffix}")
            self.drawn.append(DrawnTexture.of(reading.name, baked))
            _point(layer, job, path.name)
            yield path, images.written(baked.image.astype(old.dtype, copy=False), suffix)
        yield from packed.items()

    def _planned(self) -> dict[_Reading, NewTexture]:
        """Return the textures to draw, without those that assets share."""
        wanted: dict[_Reading, NewTexture | None] = {}
        for reading, job in self._jobs.items():
            if self._shared and reading.role and self._shared.find(reading.role):
                continue
            suffix = Path(reading.name).suffix.lower()
            try:
                shape = images.shape_of(_content(reading.path), suffix)
            except AssetError as error:
                self._warn(said_of_kept(reading.name, str(error)))
                continue
            how = self._placed(reading, job), self._size, images.written_as(suffix)
            wanted[reading] = new_texture(reading.name, *shape, *how)
        return planned(self._size, wanted, self._warn)

    def _placed(self, reading: _Reading, job: _Job) -> list[MapChange]:
        """Return both maps of the triangles that show a texture, the old one where they read it."""
        return [
            MapChange(reading.placed(each.old), each.new, each.triangles, each.positions, each.normals)
            for each in job.changes
        ]

    def _reading(
        self,
        shader: UsdShade.Shader,
        material: UsdShade.Material,
        moves: tuple[_Move, ...],
        change: MapChange,
    ) -> _Reading | None:
        """Return how a shader reads its image; None, with a warning, if that cannot be drawn anew."""
        name, path = _file_of(shader)
        if not path:
            tiles = "it has tiles" if "<UDIM>" in name else "its image is missing"
            self._warn(said_of_kept(name, tiles))
            return None
        targets = set(_targets(shader, material))
        space = _value(shader, "sourceColorSpace", "auto")
        content: Content = "normals" if (_NORMAL, "rgb") in targets else "data"
        if space == "sRGB" or (space != "raw" and any(key in _COLORS for key, _ in targets)):
            content = "color"
        wraps = [_WRAPS.get(each) for each in _wraps_of(shader, path)]
        has_opacity = content == "color" and (_OPACITY, "a") in targets
        inputs = dict.fromkeys(key for key, channel in sorted(targets) if (key, channel) != (_OPACITY, "a"))
        # Bytes of another coding make another image.
        is_raw = content == "data" and any(key in _COLORS for key in inputs)
        role = " ".join([*(_ROLES.get(key, key) for key in inputs), *(["raw"] if is_raw else [])])
        known: tuple[Wrap, Wrap] = (wraps[0] or "repeat", wraps[1] or "repeat")
        reading = _Reading(path, content, has_opacity, known, moves, role)
        if None in wraps and _leaves_tile(reading, change)[[wrap is None for wrap in wraps]].any():
            self._warn(f"The texture {name} has no wrap mode, so programs differ beyond it: it was drawn as repeated.")
        # Shaders read coded normals by a scale of 2 and a bias of -1; of integers, there are no others.
        is_plain = content == "normals" and min(_value(shader, "bias", (0.0, 0.0, 0.0, 0.0))[:3]) >= 0.0
        return replace(reading, is_signed=is_plain and _has_floats(reading))

    def _warn(self, warning: str) -> None:
        if warning and warning not in self.warnings:
            self.warnings.append(warning)


def reads_colors(material: UsdShade.Material) -> bool:
    """Return whether the diffuse color of a material is that of the vertices."""
    surface = material.ComputeSurfaceSource()[0]
    found = _source(surface, _DIFFUSE) if surface else None
    return bool(found) and found[0].GetShaderId() == _COLOR_READER and _value(found[0], "varname", "") == DISPLAY_COLOR


def color_material(layer: Sdf.Layer, path: Sdf.Path) -> Sdf.Path:
    """Add a material without textures to a layer; return the path of its surface."""
    from pxr import Sdf

    surface = _shader(layer, path.AppendChild("surface"), _SURFACE)
    Sdf.AttributeSpec(surface, "outputs:surface", Sdf.ValueTypeNames.Token)
    material = layer.GetPrimAtPath(path)
    material.specifier, material.typeName = Sdf.SpecifierDef, "Material"
    output = Sdf.AttributeSpec(material, "outputs:surface", Sdf.ValueTypeNames.Token)
    output.connectionPathList.explicitItems.append(_target(surface, "outputs:surface"))
    return surface.path


def color_by(layer: Sdf.Layer, surface: Sdf.Path, file: str, primvar: str, key: str = _DIFFUSE) -> None:
    """Let an image on a map give a surface of a layer one of its inputs: its diffuse color or another."""
    from pxr import Sdf

    types, folder, is_color = Sdf.ValueTypeNames, surface.GetParentPath(), key in _COLORS
    base = folder.AppendChild(f"{surface.name}_{key}_map")
    reader = _shader(layer, base, _READER)
    Sdf.AttributeSpec(reader, "inputs:varname", types.String).default = primvar
    Sdf.AttributeSpec(reader, "outputs:result", types.Float2)
    texture = _shader(layer, folder.AppendChild(f"{surface.name}_{key}_image"), _TEXTURE)
    Sdf.AttributeSpec(texture, "inputs:file", types.Asset).default = Sdf.AssetPath(file)
    Sdf.AttributeSpec(texture, "inputs:sourceColorSpace", types.Token).default = "sRGB" if is_color else "raw"
    place = Sdf.AttributeSpec(texture, "inputs:st", types.Float2)
    place.connectionPathList.explicitItems.append(_target(reader, "outputs:result"))
    output, kind = ("outputs:rgb", types.Float3) if is_color else ("outputs:r", types.Float)
    Sdf.AttributeSpec(texture, output, kind)
    prim, name = Sdf.CreatePrimInLayer(layer, surface), f"inputs:{key}"
    fed = prim.attributes.get(name) or Sdf.AttributeSpec(prim, name, types.Color3f if is_color else types.Float)
    fed.connectionPathList.ClearEditsAndMakeExplicit()
    fed.connectionPathList.explicitItems.append(_target(texture, output))


def bind(layer: Sdf.Layer, mesh: Sdf.Path, material: Sdf.Path) -> None:
    """Give a mesh of a layer a material."""
    from pxr import Sdf

    prim = Sdf.CreatePrimInLayer(layer, mesh)
    applied = prim.GetInfo("apiSchemas") if prim.HasInfo("apiSchemas") else Sdf.TokenListOp()
    if _BINDING not in applied.GetAddedOrExplicitItems():
        items = [*(applied.explicitItems if applied.isExplicit else applied.prependedItems), _BINDING]
        if applied.isExplicit:
            applied.explicitItems = items
        else:
            applied.prependedItems = items
        prim.SetInfo("apiSchemas", applied)
    relationship = prim.relationships.get(_BOUND) or Sdf.RelationshipSpec(prim, _BOUND)
    relationship.targetPathList.ClearEditsAndMakeExplicit()
    relationship.targetPathList.explicitItems.append(material.StripAllVariantSelections())


def _shader(layer: Sdf.Layer, path: Sdf.Path, identifier: str) -> Sdf.PrimSpec:
    from pxr import Sdf

    prim = Sdf.CreatePrimInLayer(layer, path)
    prim.specifier, prim.typeName = Sdf.SpecifierDef, "Shader"
    Sdf.AttributeSpec(prim, "info:id", Sdf.ValueTypeNames.Token, Sdf.VariabilityUniform).default = identifier
    return prim


def _target(prim: Sdf.PrimSpec, name: str) -> Sdf.Path:
    return prim.path.StripAllVariantSelections().AppendProperty(name)


def _point(layer: Sdf.Layer, job: _Job, name: str) -> None:
    """Let the shaders of a job read a file, by its name in the layer, from the map itself."""
    from pxr import Sdf

    for shader, source in job.shaders.items():
        prim = Sdf.CreatePrimInLayer(layer, shader)
        file = prim.attributes.get("inputs:file") or Sdf.AttributeSpec(prim, "inputs:file", Sdf.ValueTypeNames.Asset)
        file.connectionPathList.ClearEditsAndMakeExplicit()
        file.default = Sdf.AssetPath(name)
        read = prim.attributes.get("inputs:st") or Sdf.AttributeSpec(prim, "inputs:st", Sdf.ValueTypeNames.Float2)
        read.connectionPathList.ClearEditsAndMakeExplicit()
        read.connectionPathList.explicitItems.append(source)


def _pixels(reading: _Reading) -> np.ndarray:
    return images.read(_content(reading.path), Path(reading.name).suffix.lower())


def _has_floats(reading: _Reading) -> bool:
    """Return whether a texture has floats; a broken one is said when it is drawn."""
    try:
        return images.shape_of(_content(reading.path), Path(reading.name).suffix.lower())[1].kind == "f"
    except AssetError:
        return False


def _value(shader: UsdShade.Shader, name: str, default: Any) -> Any:  # noqa: ANN401 - of any type
    from pxr import UsdShade

    found = shader.GetInput(name)
    values = [each.Get() for each in UsdShade.Utils.GetValueProducingAttributes(found)] if found else []
    return next((value for value in values if value is not None), default)


def _file_of(shader: UsdShade.Shader) -> tuple[str, str]:
    """Return the name of a shader's image, and the path to read it from; the latter empty for none."""
    from pxr import Ar

    file = _value(shader, "file", None)
    if file is None:
        return shader.GetPrim().GetName(), ""
    path = file.resolvedPath
    return Path(file.path).name, path if path and Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path)) else ""


def _content(path: str) -> bytes:
    from pxr import Ar

    return bytes(Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path)).GetBuffer())


def _source(shader: UsdShade.Shader, name: str) -> tuple[Any, Any] | None:
    """Return the shader that feeds an input, and its output; None for none."""
    from pxr import UsdShade

    found = shader.GetInput(name)
    for attribute in UsdShade.Utils.GetValueProducingAttributes(found) if found else ():
        fed = UsdShade.Shader(attribute.GetPrim())
        if fed and UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Output:
            return fed, attribute.GetPath()
    return None


def _leaves_tile(reading: _Reading, change: MapChange) -> npt.NDArray[np.bool_]:
    """Return whether an image is read beyond it along u and v, (2,)."""
    used = reading.placed(change.old[np.unique(change.triangles)])
    return ((used < -_ROUNDED) | (used > 1.0 + _ROUNDED)).any(axis=0)


def _wraps_of(shader: UsdShade.Shader, path: str) -> Sequence[str]:
    """Return the names of the wrap modes along u and v; those of the image's file where the shader names none."""
    stated = [_value(shader, key, _OF_FILE) for key in ("wrapS", "wrapT")]
    if _OF_FILE not in stated:
        return stated
    try:
        of_file = images.wraps_of(_content(path), Path(path.rstrip("]")).suffix.lower())
    except AssetError:
        # Said when it is drawn.
        of_file = ("", "")
    return [own if each == _OF_FILE else each for each, own in zip(stated, of_file)]


def _followed(shader: UsdShade.Shader, name: str) -> tuple[tuple[Any, Any] | None, Sequence[UsdShade.Shader]]:
    """Return the shader that places what an input reads, and its output; and the transforms between, the last first."""
    moves: dict[Sdf.Path, UsdShade.Shader] = {}
    found = _source(shader, name)
    while found and found[0].GetShaderId() == _TRANSFORM and found[0].GetPath() not in moves:
        moves[found[0].GetPath()] = found[0]
        found = _source(found[0], "in")
    return found, list(moves.values())


def _place(shader: UsdShade.Shader) -> tuple[str, Sdf.Path, tuple[_Move, ...]] | None:
    """Return the primvar that places a texture, the output that reads it, and how it is moved; None if else."""
    found, moves = _followed(shader, "st")
    if not found or found[0].GetShaderId() != _READER:
        return None
    return str(_value(found[0], "varname", "")), found[1], tuple(map(_Move.of, reversed(moves)))


def places(material: UsdShade.Material, name: str) -> bool:
    """Return whether a material scales, turns or moves textures that read a primvar."""
    from pxr import Usd, UsdShade

    for prim in Usd.PrimRange(material.GetPrim()):
        shader = UsdShade.Shader(prim)
        identifier = (shader.GetShaderId() if prim.IsA(UsdShade.Shader) else "") or ""
        begin = next((each for each in _PLACING if identifier.startswith(each)), "")
        if not begin:
            continue
        input_name, neutral = _PLACING[begin]
        found, _ = _followed(shader, input_name)
        reader = found[0] if found else None
        if reader and str(_value(reader, READERS.get(reader.GetShaderId(), ""), name)) != name:
            continue
        if any(not np.array_equal(_value(shader, each, value), value) for each, value in neutral.items()):
            return True
    return False


def _targets(shader: UsdShade.Shader, material: UsdShade.Material) -> Iterator[tuple[str, str]]:
    """Yield the inputs of the material's surface that a texture feeds, each with the name of the texture's output."""
    from pxr import UsdShade

    surface = material.ComputeSurfaceSource()[0]
    for each in surface.GetInputs() if surface else ():
        for attribute in UsdShade.Utils.GetValueProducingAttributes(each):
            if attribute.GetPrim() == shader.GetPrim():
                yield each.GetBaseName(), attribute.GetName().removeprefix("outputs:")


def materials(prim: Usd.Prim, n_faces: int) -> Iterable[tuple[UsdShade.Material, npt.NDArray[np.bool_]]]:
    """Yield the materials of a mesh and of its subsets, each with its faces, (F,)."""
    from pxr import UsdGeom, UsdShade

    rest = np.ones(n_faces, bool)
    subsets = UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
    parts: Sequence[UsdGeom.Subset] = [each for each in subsets if each.GetIndicesAttr().Get() is not None]
    for subset in parts:
        faces = np.zeros(n_faces, bool)
        indices = np.array(subset.GetIndicesAttr().Get(), np.int64)
        faces[indices[(indices >= 0) & (indices < n_faces)]] = True
        material = UsdShade.MaterialBindingAPI(subset.GetPrim()).ComputeBoundMaterial()[0]
        if material:
            rest &= ~faces
            yield material, faces
    material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
    if material and rest.any():
        yield material, rest
