"""What a file has, listed by readers that share no code with those that write, so that a loss is seen, not believed.

glTF is read as JSON, OBJ and MTL line by line, PLY by its header, and USD as its own library composes it.
"""

from __future__ import annotations

import json
import os
import re
import struct
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Set
from pathlib import Path
from typing import Any, Literal
from urllib.parse import unquote

from . import images, references
from .mesh import AssetError

# How often each item, a kind and a name, occurs.
Items = Counter[tuple[str, str]]
# Takes the path of a file to the one where its content is, which a new file has before it gets its name.
Stored = Callable[[Path], Path]

_FACES, _FILES = "faces", "files"
_SHOWN = 4
_SET_OF_TRANSFORM = ".extensions.KHR_texture_transform.texCoord "
# Of a material in glTF, whatever its name.
_FACTOR = re.compile(r"(baseColor|metallic|roughness|emissive)Factor(\.\d)? [^ ]*$")


def lost(
    source: Path, written: Path, places: Mapping[Path, Path], new_textures: Literal["no", "own", "shared"] = "no"
) -> list[str]:
    """Return what the source has and the written file does not: a phrase for each kind; none for other formats.

    Args:
        source: the file as it was.
        written: path of the main file.
        places: where the content of each written file is, by its resolved path.
        new_textures: whether textures were drawn anew, so that their files, and how materials read them, differ; those
            shared with other assets may also replace factors and be fewer.

    Raises:
        AssetError: the structure of a file violates its format.
    """
    reader = _READERS.get(source.suffix.lower())
    if reader is None or _READERS.get(written.suffix.lower()) is not reader:
        return []
    try:
        before = reader(source, lambda path: path)
        after = reader(written, lambda path: places.get(Path(os.path.realpath(path)), path))
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, struct.error) as error:
        raise AssetError(f"{source}: its content cannot be listed: {type(error).__name__} {error}.") from error
    if new_textures != "no":
        is_shared = new_textures == "shared"
        placed = {name.partition(_SET_OF_TRANSFORM)[0] for _, name in before if _SET_OF_TRANSFORM in name}
        before = Counter({item: n for item, n in before.items() if not _is_of_textures(*item, is_shared, placed)})
    return lacking(before, after)


def _is_of_textures(kind: str, name: str, is_shared: bool, placed: Set[str]) -> bool:
    """Return whether an item of glTF describes which image a material reads from which place of the map.

    `placed` are references whose own UV set is only for readers that know no transforms.
    """
    if is_shared and (kind in ("images", "textures") or (kind == "values in materials" and _FACTOR.search(name))):
        return True
    if kind == "values in materials":
        is_own_set = name.rpartition(".texCoord ")[0] in placed
        return "KHR_texture_transform" in name or "Texture.index " in name or is_own_set
    if kind == "values in meshes":
        # One that reads a texture of vertex colors may be another.
        return ".material " in name
    if kind == "layers and assets":
        return Path(name).suffix.lower() in (*images.OF_GLTF, ".jpeg", ".tif", ".tiff", ".tga", ".bmp", ".exr")
    return kind == _FILES or kind in ("values in textures", "values in images")


def lacking(before: Items, after: Items) -> list[str]:
    """Return what is in the first list and not in the second: a phrase for each kind, with the first few names."""
    missing = before - after
    phrases = []
    for kind in dict.fromkeys(kind for kind, _ in missing):
        names = list(dict.fromkeys(name for of, name in missing if of == kind and name))
        counts = [sum(n for (of, _), n in items.items() if of == kind) for items in (missing, before)]
        more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
        named = f" ({', '.join(names[:_SHOWN])}{more})" if names else ""
        phrases.append(f"{counts[0]} of {counts[1]} {kind}{named}")
    return phrases


def message(path: Path, lost: list[str]) -> str:
    """Return why a file was not written that would lack something."""
    return f"{path.name} was not written, since it would lack {', '.join(lost)} of the source."


# glTF

# Lists that describe where data lies; data that nothing uses is left out.
_STORAGE = ("accessors", "bufferViews", "buffers", "extensionsUsed", "extensionsRequired")
# Numbers of places, paths, and how geometry is stored.
_PLACES = ("bufferView", "uri", "indices", "mode")
_COMPRESSION = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def _of_gltf(path: Path, stored: Stored) -> Items:
    data = stored(path).read_bytes()
    binary = 0
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        binary = len(data) - 20 - length
        data = data[20 : 20 + length]
    document = json.loads(data.decode("utf-8-sig"))
    found: Items = Counter()
    for kind, items in document.items():
        if kind in _STORAGE:
            continue
        pairs = enumerate(items) if isinstance(items, list) else [("", items)]
        for number, item in pairs:
            name = str(item.get("name", number) if isinstance(item, dict) else number)
            for leaf in _leaves(item):
                found[f"values in {kind}", f"{name}: {leaf}"] += 1
            found[kind, name] += 1
    for part in (*document.get("buffers", []), *document.get("images", [])):
        name = unquote(part.get("uri", "data:"))
        if not name.startswith("data:") and part in document.get("images", []) and stored(path.parent / name).is_file():
            found[_FILES, Path(name).name] += 1
    sizes = [_size_of(each, path, stored, binary) for each in document.get("buffers", [])]
    accessors = document.get("accessors", [])
    for number, accessor in enumerate(accessors):
        if _is_whole(accessor, document, sizes):
            found["accessors", str(number)] += 1
    for number, mesh in enumerate(document.get("meshes", [])):
        for primitive in mesh["primitives"]:
            corners = primitive.get("indices", primitive["attributes"].get("POSITION"))
            count = accessors[corners]["count"] if corners is not None else 0
            mode = primitive.get("mode", 4)
            triangles = count // 3 if mode == 4 else max(count - 2, 0) if mode in (5, 6) else 0
            found[_FACES, str(mesh.get("name", number))] += triangles
    return found


def _leaves(part: Any, path: str = "") -> Iterator[str]:  # noqa: ANN401 - any of JSON's
    """Yield every value with its path, without what storing the geometry differently changes."""
    if isinstance(part, (dict, list)):
        pairs = part.items() if isinstance(part, dict) else enumerate(part)
        for key, value in pairs:
            if key in _PLACES or key in _COMPRESSION:
                continue
            place = f"{path}.{key}" if path else str(key)
            if key == "attributes" and isinstance(value, dict):
                yield from _names(value, place)
            elif key == "targets" and isinstance(value, list) and all(isinstance(each, dict) for each in value):
                for number, each in enumerate(value):
                    yield from _names(each, f"{place}.{number}")
            else:
                yield from _leaves(value, place)
    else:
        yield f"{path} {json.dumps(part)}"


def _names(attributes: Mapping[str, int], path: str) -> Iterator[str]:
    """Yield the names of attributes with their path, but neither their order nor their accessors' numbers.

    Colors that became a texture have a name of the file's own.
    """
    for name in attributes:
        yield f"{path} {name.removeprefix('_') if name == '_COLOR_0' else name}"


def _size_of(buffer: dict[str, Any], path: Path, stored: Stored, binary: int) -> int:
    """Return how many of the bytes that a buffer announces are there."""
    uri, size = buffer.get("uri"), buffer["byteLength"]
    if uri is None:
        return min(size, binary)
    if uri.startswith("data:"):
        return min(size, len(uri.partition(",")[2]) * 3 // 4)
    place = stored(path.parent / unquote(uri))
    return min(size, place.stat().st_size) if place.is_file() else 0


def _is_whole(accessor: dict[str, Any], document: dict[str, Any], sizes: list[int]) -> bool:
    """Return whether all values of an accessor lie in its view, and the view in its buffer."""
    if "bufferView" not in accessor:
        return True
    view = document["bufferViews"][accessor["bufferView"]]
    row = _BYTES[accessor["componentType"]] * _WIDTHS[accessor["type"]]
    end = accessor.get("byteOffset", 0) + view.get("byteStride", row) * (accessor["count"] - 1) + row
    return end <= view["byteLength"] and view.get("byteOffset", 0) + view["byteLength"] <= sizes[view["buffer"]]


# OBJ


def _of_obj(path: Path, stored: Stored) -> Items:
    found: Items = Counter()
    is_continued = False
    for line in _lines(stored(path)):
        was_continued, is_continued = is_continued, line.rstrip().endswith("\\") and "#" not in line
        word, rest = _split(line)
        if was_continued or not word or word[0] == "#" or word == "vt":
            continue
        if word == "f":
            found[_FACES, ""] += 1
        elif word in ("o", "g", "usemtl"):
            found[{"o": "objects", "g": "groups", "usemtl": "uses of materials"}[word], rest] += 1
        elif word == "mtllib":
            for name in [rest] if stored(path.parent / _path(rest)).is_file() else rest.split():
                _add_library(found, path.parent / _path(name), stored)
        else:
            found[f"lines '{word}'", ""] += 1
    return found


def _add_library(found: Items, library: Path, stored: Stored) -> None:
    place = stored(library)
    if not place.is_file():
        return
    found[_FILES, library.name] += 1
    for line in _lines(place):
        word, rest = _split(line)
        if word == "newmtl":
            found["materials", rest] += 1
    for texture in references.textures_of(place):
        if stored(library.parent / texture).is_file():
            found[_FILES, Path(texture).name] += 1


def _split(line: str) -> tuple[str, str]:
    """Return the first word of a line, and what follows the blanks or tabs behind it."""
    word, *rest = line.split(None, 1)[:2] or [""]
    return word, "".join(rest).rstrip()


def _lines(path: Path) -> Iterator[str]:
    # Universal line ends; every byte is a character.
    with path.open(encoding="latin-1") as file:
        yield from file


def _path(name: str) -> str:
    """Return a name in a line as the system has it."""
    return os.fsdecode(name.encode("latin-1"))


# PLY


def _of_ply(path: Path, stored: Stored) -> Items:
    found: Items = Counter()
    element = ""
    with stored(path).open("rb") as file:
        for line in file:
            words = line.decode("latin-1").split()
            if words[:1] == ["end_header"]:
                break
            if words[:1] == ["element"] and len(words) == 3:
                element = words[1]
                found[_FACES if element == "face" else f"rows of {element}", ""] += int(words[2])
            elif words[:1] == ["property"]:
                found["properties", f"{element} {words[-1]}"] += 1
            elif words:
                found["lines of the header", " ".join(words)] += 1
            if words[:2] == ["comment", "TextureFile"]:
                name = _path(line.decode("latin-1").split(None, 2)[2].strip())
                found.update([(_FILES, Path(name).name)] if (path.parent / name).is_file() else [])
    return found


# USD

# What describes a layer itself, or how it is composed.
_OF_LAYER = ("comment", "documentation", "customLayerData", "subLayers", "subLayerOffsets", "layerRelocates")


def _of_usd(path: Path, stored: Stored) -> Items:
    from pxr import Usd, UsdGeom, UsdUtils

    place = stored(path)
    stage = Usd.Stage.Open(str(place))
    found: Items = Counter()
    for key, value in stage.GetPseudoRoot().GetAllMetadata().items():
        if key not in _OF_LAYER:
            found["metadata of the stage", f"{key} {value}"] += 1
    for prim in stage.Traverse(Usd.TraverseInstanceProxies(Usd.PrimAllPrimsPredicate)):
        name = str(prim.GetPath())
        found[f"prims of type {prim.GetTypeName()}" if prim.GetTypeName() else "prims", name] += 1
        if prim.IsA(UsdGeom.Mesh):
            sizes = UsdGeom.Mesh(prim).GetFaceVertexCountsAttr().Get(Usd.TimeCode.EarliestTime())
            found[_FACES, name] += len(sizes or ())
        for each in prim.GetAuthoredProperties():
            found["properties", f"{name}.{each.GetName()}"] += 1
            if isinstance(each, Usd.Relationship):
                found.update(("targets", f"{name}.{each.GetName()} {target}") for target in each.GetTargets())
            elif str(each.GetTypeName()) in ("asset", "asset[]"):
                value = each.Get(Usd.TimeCode.EarliestTime())
                values = value if str(each.GetTypeName()) == "asset[]" else [value]
                found.update((_FILES, _base(v.resolvedPath)) for v in values or () if v and v.resolvedPath)
    layers, others, _ = UsdUtils.ComputeAllDependencies(str(place))
    # Which of them are missing now was there before.
    used = [layer.realPath or layer.identifier for layer in layers if layer != stage.GetRootLayer()]
    found.update(("layers and assets", _base(each)) for each in (*used, *map(str, others)))
    return found


def _base(path: str) -> str:
    """Return the name of a file, maybe within a package."""
    return re.split(r"[/\\\[]", path)[-1].rstrip("]")


_READERS: dict[str, Callable[[Path, Stored], Items]] = {
    ".glb": _of_gltf,
    ".gltf": _of_gltf,
    ".obj": _of_obj,
    ".ply": _of_ply,
    **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), _of_usd),
}
