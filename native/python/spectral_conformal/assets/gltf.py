"""glTF files, text or binary: read the geometry, write UVs, and keep everything else.

The format: "glTF 2.0 Specification", Khronos Group, 2021 (ISO/IEC 12113). Content other than geometry is ignored;
unsupported kinds of geometry are rejected by name.
"""

from __future__ import annotations

import base64
import binascii
import bisect
import functools
import itertools
import json
import os
import struct
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

import numpy as np
import numpy.typing as npt

from .._arguments import doubles
from .._distinct_rows import in_order_of_use, parts
from .._tangents import tangents
from .._texture_size import DrawnTexture, TextureSize
from .._vertex_colors import NAME, VertexColors
from . import images, meshopt, references
from .edits import Integers, indices_of_copies, numbered, renumbered
from .gltf_textures import (
    COLORS,
    FAN,
    TRANSFORM,
    TRIANGLES,
    UV_SET,
    Redrawing,
    Surface,
    color_by,
    content_of,
    has_faces,
    has_opacity,
    lacks_colors,
    materials_of,
    set_of,
    texture_infos,
)
from .mesh import AssetError, AssetMesh, NoMeshError, UvMap, checked, offsets_of
from .shared_textures import BASE_COLOR, Colors, SharedTexture, SharedTextures

_Json = dict[str, Any]

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_FLOAT, _UNSIGNED_BYTE, _UNSIGNED_SHORT, _UNSIGNED_INT = 5126, 5121, 5123, 5125
_GLB = b"glTF"
_JSON_CHUNK, _BINARY_CHUNK = b"JSON", b"BIN\0"
_DRACO = "KHR_draco_mesh_compression"
_NGONS = "FB_ngon_encoding"
_POINTER = "KHR_animation_pointer"
_FEATURES, _METADATA = "EXT_mesh_features", "EXT_structural_metadata"
# Extensions of primitives that name no vertices by number.
_WITHOUT_VERTICES = (_DRACO, _NGONS, _FEATURES, _METADATA, "KHR_materials_variants")
# Beginnings of the names of extensions that name no accessors, or whose accessors are counted as attributes are.
_WITHOUT_ACCESSORS = (
    _DRACO,
    _FEATURES,
    _METADATA,
    "KHR_materials_",
    "KHR_lights_",
    "KHR_xmp",
    "KHR_node_",
    "EXT_lights_",
)
# Beginnings of the names of extensions that leave the geometry alone, or whose geometry is read.
_KNOWN = (
    *_WITHOUT_ACCESSORS,
    _NGONS,
    "KHR_animation_",
    "KHR_mesh_quantization",
    "KHR_texture_",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_",
    "MSFT_",
)
_UNCHANGED = ((0.0, 0.0), (1.0, 1.0))
# The second one, for data of the first version of the bitstream.
_MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
_WORD = 4
_TRANSFORMS_LEFT = f"Textures of the map use different or rotating {TRANSFORM}, which was left."
_VERSION_1 = "{}: is glTF 1.0, which cannot be read: convert it to glTF 2.0."


class GltfAsset:
    """A glTF file: the polygons of each mesh; triangles are joined at equal positions."""

    meters: float | None = 1.0

    def __init__(self, path: Path, uv_map: str = "", places: Mapping[Path, Path] | None = None) -> None:
        """Read the file and its buffers.

        Args:
            path: of a .gltf or .glb file.
            uv_map: n of the TEXCOORD_n to read and write, or that name itself; by default the first set. The format
                cannot store any other name, which selects the first set that no mesh has.
            places: where the content of buffers is that have no names of their own yet, by their resolved paths.

        Raises:
            AssetError: the content is broken, or the geometry is compressed or missing.
            OSError: a file cannot be opened.
        """
        self.path = path
        self._places = places or {}
        self.chunks: list[tuple[bytes, memoryview]] = []
        self.beside: list[str] = []
        self._read(path.read_bytes())
        self.suffix = ".glb" if self.chunks else ".gltf"
        self._notes: list[str] = []
        self.drawn_textures: list[DrawnTexture] = []
        """Textures that `files` drew last."""
        self.shared: SharedTextures | None = None
        """Those that it reads instead of its own."""
        self._edit: _Edit | None = None
        with self._structure():
            self.uv_map = self._set_named(uv_map)
            self.view_numbers = set(_view_numbers(self.json))
            self._decompress_views()
            self._decompress()
            for name in self.json.get("extensionsRequired", []):
                if not name.startswith(_KNOWN):
                    self.warn(f"The file requires {name}, which is unknown here and may hold or change geometry.")
            self._meshes = [_Mesh(self, number, each) for number, each in enumerate(self.json.get("meshes", []))]
            self._meshes = [mesh for mesh in self._meshes if mesh.groups]
            placements = _placements(self.json)
            polygons = [mesh.polygons(self.uv_map, placements.get(mesh.number, np.eye(4))) for mesh in self._meshes]
        if not polygons:
            raise NoMeshError(f"{path}: has no triangles; there is nothing to unwrap.")
        self.meshes = [checked(path, mesh) for mesh in polygons]
        with self._structure():
            self._name_animated()
            if not uv_map:
                self._name_sets_read()
        self.warnings = list(self._notes)

    def references(self) -> Sequence[str]:
        """Return the separate files of images, and of the buffers that `files` left unchanged."""
        return self.beside

    def rename(self, source: Path, copy: Path, named: Callable[[str], str]) -> None:
        """Do nothing: the files that it references contain no paths."""

    def share(self, out: Path, maps: Sequence[UvMap], textures: TextureSize, shared: SharedTextures) -> None:  # noqa: ARG002 - as for other formats
        """Add its textures to those that assets share; `files` with the same arguments then names these."""
        self.shared = shared
        with self._structure():
            self._edit = self._edited(maps, textures)
            self._edit.share()

    def files(
        self, out: Path, maps: Sequence[UvMap], textures: TextureSize | None = None
    ) -> Mapping[Path, Iterable[bytes]]:
        """Return the files of this asset with new UVs; the main one has the path `out` and comes last.

        With `textures`, those that read the set are drawn anew, for the new map as it is.
        """
        with self._structure():
            edit, self._edit = self._edit or self._edited(maps, textures), None
            return edit.files(out)

    def _edited(self, maps: Sequence[UvMap], textures: TextureSize | None) -> _Edit:
        """Return the new version of the file, with new UVs."""
        # Drawn anew, they have none.
        self.warnings = [each for each in self._notes if not (textures and each == _TRANSFORMS_LEFT)]
        edit = _Edit(self, textures, self.shared)
        for mesh, uv_map in zip(self._meshes, maps):
            uv, mapped, face = uv_map.uv, uv_map.mapped, 0
            if mesh.corners is not None:
                uv, mapped = uv[mesh.corners], mapped[mesh.face_of_triangle]
            for group in mesh.groups:
                end = face + sum(map(len, group.triangles))
                edit.write_group(group, self.uv_map, uv[3 * face : 3 * end], mapped[face:end])
                face = end
        return edit

    def _set_named(self, uv_map: str) -> str:
        """Return the name of the attribute for the name of a UV map."""
        number = uv_map.removeprefix(UV_SET) or "0"
        if not number.isdecimal():
            primitives = [each for mesh in self.json.get("meshes", []) for each in mesh["primitives"]]
            present = {name for primitive in primitives for name in primitive["attributes"]}
            number = str(next(n for n in itertools.count() if f"{UV_SET}{n}" not in present))
            self._notes.append(f"glTF has no names for UV maps: {uv_map} is {UV_SET}{number}.")
        return f"{UV_SET}{int(number)}"

    def _name_sets_read(self) -> None:
        """Warn of materials whose textures read other sets than the one to write."""
        primitives = [each for mesh in self._meshes for group in mesh.groups for each in group.primitives]
        numbers = sorted({number for each in primitives for number in materials_of(each)})
        read = {number: {set_of(info) for info in texture_infos(self.json["materials"][number])} for number in numbers}
        read = {number: sets for number, sets in read.items() if sets}
        others = {number: sets for number, sets in read.items() if self.uv_map not in sets}
        if others:
            named = ", ".join(self.json["materials"][number].get("name", f"material {number}") for number in others)
            whose = f" of {named}" if len(others) < len(read) else ""
            found = ", ".join(sorted(set().union(*others.values())))
            self.warn(
                f"No texture{whose} reads {self.uv_map}, only {found}: name that as the UV map to show the new one."
            )

    def _name_animated(self) -> None:
        """Warn if animations change what materials make of the map."""
        channels = [each for animation in self.json.get("animations", []) for each in animation["channels"]]
        pointers = [each["target"].get("extensions", {}).get(_POINTER, {}).get("pointer", "") for each in channels]
        if any(TRANSFORM in each for each in pointers):
            self.warn(f"Animations change {TRANSFORM}, of which the new map has the state without them.")

    @contextmanager
    def _structure(self) -> Iterator[None]:
        """Report a broken file if its structure violates the format."""
        try:
            yield
        except AssetError:
            raise
        except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
            reason = f"{type(error).__name__} {error}"
            raise AssetError(f"{self.path}: the structure is not that of glTF 2.0: {reason}.") from error

    # Reading

    def _read(self, data: bytes) -> None:
        if data[:4] != _GLB:
            text = data
            if self.path.suffix.lower() == ".glb" and not data.lstrip().startswith((b"{", b"\xef\xbb\xbf")):
                raise AssetError(f"{self.path}: a binary glTF file begins with 'glTF'.")
        else:
            version = struct.unpack_from("<I", data, 4)[0] if len(data) >= 20 else 0
            if version == 1:
                raise AssetError(_VERSION_1.format(self.path))
            if version != 2:
                raise AssetError(f"{self.path}: is not a binary glTF of version 2.")
            at = 12
            while at + 8 <= len(data):
                length, kind = struct.unpack_from("<I4s", data, at)
                if at + 8 + length > len(data):
                    raise AssetError(f"{self.path}: ends within a chunk; the file is cut off.")
                self.chunks.append((kind, memoryview(data)[at + 8 : at + 8 + length]))
                at += 8 + length
            if not self.chunks or self.chunks[0][0] != _JSON_CHUNK:
                raise AssetError(f"{self.path}: the first chunk is not JSON.")
            text = bytes(self.chunks[0][1])
        try:
            self.text = text.decode("utf-8-sig")
            self.json: _Json = json.loads(self.text)
        except RecursionError:
            raise AssetError(f"{self.path}: its JSON is nested too deeply to be glTF.") from None
        except ValueError as error:
            raise AssetError(f"{self.path}: is not JSON: {error}.") from None
        if not isinstance(self.json, dict):
            raise AssetError(f"{self.path}: is not glTF: its JSON must be an object.")
        # Version 1 has objects by name instead of lists; its files may lack a version.
        if isinstance(self.json.get("meshes"), dict):
            raise AssetError(_VERSION_1.format(self.path))
        binary = [content for kind, content in self.chunks[1:] if kind == _BINARY_CHUNK]
        with self._structure():
            plain = {view["buffer"] for view in self.json.get("bufferViews", []) if not _meshopt_of(view)}
            compressed = {_meshopt_of(view)["buffer"] for view in self.json.get("bufferViews", []) if _meshopt_of(view)}
            # Other buffers are places for what is decompressed, and may have no data.
            used = plain | compressed if compressed else range(len(self.json.get("buffers", [])))
            self.buffers = [
                self._buffer(each, binary) if number in used else b""
                for number, each in enumerate(self.json.get("buffers", []))
            ]

    def _buffer(self, buffer: _Json, binary: list[memoryview]) -> bytes | memoryview:
        uri = buffer.get("uri")
        if uri is None:
            data = binary[0] if binary else b""
        elif uri.startswith("data:"):
            try:
                data = base64.b64decode(uri.partition(",")[2], validate=True)
            except binascii.Error as error:
                raise AssetError(f"{self.path}: a buffer is not valid base64: {error}.") from None
        else:
            beside = self.path.parent / unquote(uri)
            data = self._places.get(Path(os.path.realpath(beside)), beside).read_bytes()
        if len(data) < buffer.get("byteLength", 0):
            raise AssetError(f"{self.path}: a buffer of {buffer['byteLength']} bytes has {len(data)}.")
        return data

    def _decompress_views(self) -> None:
        """Replace buffers with views compressed by meshopt with one buffer of plain views."""
        views = self.json.get("bufferViews", [])
        if not any(map(_meshopt_of, views)):
            return
        kept = next(_meshopt_of(view)["buffer"] for view in views if _meshopt_of(view))
        pieces: list[bytes | memoryview] = []
        for number, view in enumerate(views):
            packed = _meshopt_of(view)
            place = packed or view
            start = place.get("byteOffset", 0)
            content = self.buffers[place["buffer"]][start : start + place["byteLength"]]
            if packed:
                kind = packed["mode"], packed.get("filter", "NONE"), packed["count"], packed["byteStride"]
                try:
                    content = meshopt.decoded(bytes(content), *kind).data
                except (KeyError, IndexError, ValueError) as error:
                    raise AssetError(
                        f"{self.path}: bufferView {number}, compressed by meshopt, is broken: {error}."
                    ) from None
                for name in _MESHOPT:
                    view["extensions"].pop(name, None)
                if not view["extensions"]:
                    del view["extensions"]
            size = sum(map(len, pieces))
            pieces += [bytes(-size % _WORD), content]
            view.update(buffer=0, byteOffset=size + -size % _WORD, byteLength=len(content))
        self.buffers = [b"".join(pieces)]
        self.json["buffers"] = [{**self.json["buffers"][kept], "byteLength": len(self.buffers[0])}]
        self._note_decompressed("meshopt", *_MESHOPT)

    def _note_decompressed(self, what: str, *extensions: str) -> None:
        for key in ("extensionsUsed", "extensionsRequired"):
            names = [name for name in self.json.pop(key, []) if name not in extensions]
            if names:
                self.json[key] = names
        self.text = json.dumps(self.json, ensure_ascii=False, indent=_indent(self.text))
        self._notes.append(f"Geometry that was compressed by {what} is now uncompressed.")

    def _decompress(self) -> None:
        """Replace geometry compressed by Draco with plain accessors."""
        primitives = [each for mesh in self.json.get("meshes", []) for each in mesh["primitives"]]
        compressed = [each for each in primitives if _DRACO in each.get("extensions", {})]
        if not compressed:
            return
        try:
            import DracoPy
        except ImportError as error:
            needed = 'pip install "spectral_conformal[batch]"'
            raise AssetError(f"{self.path}: the geometry is compressed by Draco, which needs {needed}.") from error
        pieces: list[bytes | memoryview] = [self.buffers[0]]
        for primitive in compressed:
            draco = primitive["extensions"].pop(_DRACO)
            if not primitive["extensions"]:
                del primitive["extensions"]
            view = self.json["bufferViews"][draco["bufferView"]]
            start = view.get("byteOffset", 0)
            try:
                mesh = DracoPy.decode(bytes(self.buffers[view["buffer"]][start : start + view["byteLength"]]))
            except DracoPy.FileTypeException as error:
                raise AssetError(f"{self.path}: the geometry compressed by Draco is broken: {error}.") from None
            arrays = {
                primitive["attributes"][name]: mesh.get_attribute_by_unique_id(k)["data"]
                for name, k in draco["attributes"].items()
            }
            arrays[primitive["indices"]] = np.reshape(mesh.faces, (-1, 1))
            for number, values in arrays.items():
                accessor = self.json["accessors"][number]
                self._append(accessor, values.astype(_COMPONENTS[accessor["componentType"]]), pieces)
        self.buffers[0] = b"".join(pieces)
        self.json["buffers"][0]["byteLength"] = len(self.buffers[0])
        self._note_decompressed("Draco", _DRACO)

    def _append(self, accessor: _Json, values: npt.NDArray, pieces: list[bytes | memoryview]) -> None:
        """Append the content of an accessor to the pieces of the first buffer."""
        values, stride = _aligned(values)
        pieces.append(bytes(-sum(map(len, pieces)) % _WORD))
        new = {"buffer": 0, "byteOffset": sum(map(len, pieces)), "byteLength": values.nbytes, **stride}
        pieces.append(values.tobytes())
        self.json["bufferViews"].append(new)
        self.view_numbers.add(len(self.json["bufferViews"]) - 1)
        accessor["bufferView"] = len(self.json["bufferViews"]) - 1
        accessor["count"] = len(values)
        accessor.pop("byteOffset", None)

    def array(self, number: int) -> npt.NDArray:
        """Return the values of an accessor, (count, width), in their stored type."""
        accessor = self.json["accessors"][number]
        kind, width = np.dtype(_COMPONENTS[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        if "bufferView" in accessor:
            result = self._rows(accessor, accessor["bufferView"], kind, accessor["count"], width).copy()
        else:
            result = np.zeros((accessor["count"], width), kind)
        if sparse := accessor.get("sparse"):
            indices, values = sparse["indices"], sparse["values"]
            index_kind = np.dtype(_COMPONENTS[indices["componentType"]])
            rows = self._rows(indices, indices["bufferView"], index_kind, sparse["count"], 1).ravel()
            if len(rows) and rows.max() >= len(result):
                raise AssetError(
                    f"{self.path}: accessor {number} has {len(result)} values, but one for index {rows.max()}."
                )
            result[rows] = self._rows(values, values["bufferView"], kind, sparse["count"], width)
        return result

    def _rows(self, place: _Json, view_number: int, kind: np.dtype, count: int, width: int) -> npt.NDArray:
        view = self.json["bufferViews"][view_number]
        buffer = self.buffers[view["buffer"]]
        start = view.get("byteOffset", 0) + place.get("byteOffset", 0)
        row = kind.itemsize * width
        stride = view.get("byteStride", row)
        if count < 0 or start + (stride * (count - 1) + row if count else 0) > len(buffer):
            raise AssetError(f"{self.path}: bufferView {view_number} reaches beyond its buffer.")
        return np.ndarray((count, width), kind, buffer, start, (stride, kind.itemsize))

    def numbers(self, number: int) -> npt.NDArray[np.float64]:
        """Return the values of an accessor as floats; normalized integers become fractions."""
        accessor, stored = self.json["accessors"][number], self.array(number)
        if accessor.get("normalized") and stored.dtype.kind != "f":
            return np.maximum(stored / np.iinfo(stored.dtype).max, -1.0)
        return doubles(stored)

    def transform(
        self, group: _Group, name: str, left_out: Set[tuple[int, int]] = frozenset()
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return the offset (2,) and scale (2,) that the materials of a group apply to a UV set.

        If they differ or rotate, none is applied, and a warning says so. `left_out` are references that do not count:
        the material, and the number of the reference in it.
        """
        used = {number for each in group.primitives for number in materials_of(each)}
        infos = [
            info
            for number in sorted(used)
            for k, info in enumerate(texture_infos(self.json["materials"][number]))
            if (number, k) not in left_out
        ]
        found = set()
        for info in infos:
            change = info.get("extensions", {}).get(TRANSFORM, {})
            if set_of(info) == name:
                pairs = tuple(tuple(map(float, change.get(*each))) for each in (("offset", (0, 0)), ("scale", (1, 1))))
                found.add((pairs, bool(change.get("rotation"))))
        ((offset, scale), is_turned), *others = found or {(_UNCHANGED, False)}
        if others or is_turned or not all(scale):
            self.warn(_TRANSFORMS_LEFT)
            offset, scale = _UNCHANGED
        return np.array(offset), np.array(scale)

    def content_of_view(self, number: int) -> bytes:
        """Return the bytes of a buffer view."""
        view = self.json["bufferViews"][number]
        start = view.get("byteOffset", 0)
        return bytes(self.buffers[view["buffer"]][start : start + view["byteLength"]])

    def warn(self, warning: str) -> None:
        """Add a note about the file, once."""
        if warning not in self._notes:
            self._notes.append(warning)


class _Group:
    """The primitives of a mesh that share their vertices."""

    def __init__(self, asset: GltfAsset, attributes: dict[str, int]) -> None:
        self.attributes = attributes
        self.n_rows = asset.json["accessors"][attributes["POSITION"]]["count"]
        self.primitives: list[_Json] = []
        self.triangles: list[npt.NDArray[np.integer]] = []

    @property
    def corners(self) -> npt.NDArray[np.integer]:
        """(3 triangles,) the row of each corner, over all primitives."""
        if len(self.triangles) == 1:
            return self.triangles[0].ravel()
        return np.concatenate([each.ravel() for each in self.triangles])

    @property
    def materials(self) -> Integers:
        """(triangles,) the material of each triangle, over all primitives; -1 without one."""
        numbers = [each.get("material", -1) for each in self.primitives]
        return np.repeat(np.array(numbers, dtype=np.int64), [len(each) for each in self.triangles])


class _Mesh:
    def __init__(self, asset: GltfAsset, number: int, mesh: _Json) -> None:
        self._asset = asset
        self.number = number
        self.name = mesh.get("name", f"mesh {number}")
        groups: dict[str, _Group] = {}
        for primitive in mesh["primitives"]:
            if not has_faces(primitive):
                continue
            if "POSITION" not in primitive["attributes"]:
                continue
            key = json.dumps([primitive["attributes"], primitive.get("targets")], sort_keys=True)
            group = groups.setdefault(key, _Group(asset, primitive["attributes"]))
            triangles = _triangles(asset, primitive, group.n_rows)
            if len(triangles):
                self._name_data(primitive)
                group.primitives.append(primitive)
                group.triangles.append(triangles)
        self.groups = [group for group in groups.values() if group.primitives]
        self.corners: Integers | None = None
        """(3 triangles,) the corner of the polygons for each of the triangles; None if these are the polygons."""
        if _NGONS in asset.json.get("extensionsUsed", []) and self.groups:
            self._join_ngons()

    def _join_ngons(self) -> None:
        """Find the polygons: fans of successive triangles, which begin at the same vertex; others begin elsewhere."""
        parts = [
            (each, _NGONS in primitive.get("extensions", {}))
            for group in self.groups
            for primitive, each in zip(group.primitives, group.triangles)
        ]
        continues = np.concatenate([_continues(each) & is_encoded for each, is_encoded in parts])
        self.face_of_triangle = np.cumsum(~continues) - 1
        """(triangles,)"""
        # Each face has two corners more than triangles.
        last = np.arange(len(continues)) + 2 * self.face_of_triangle + 2
        first = np.flatnonzero(~continues)[self.face_of_triangle] + 2 * self.face_of_triangle
        self.corners = np.stack([first, last - 1, last], axis=1).ravel()

    def _name_data(self, primitive: _Json) -> None:
        """Warn of data on the map to replace: textures that are no colors, and what morph targets add to it."""
        extensions, name = primitive.get("extensions", {}), self._asset.uv_map
        schema = self._asset.json.get("extensions", {}).get(_METADATA, {})
        chosen = extensions.get(_METADATA, {}).get("propertyTextures", [])
        tables = [schema["propertyTextures"][number]["properties"] for number in chosen]
        users = (
            ("feature ids", any(set_of(info) == name for info in texture_infos(extensions.get(_FEATURES)))),
            ("property textures", any(set_of(info) == name for info in texture_infos(tables))),
            ("morph targets", any(name in target for target in primitive.get("targets", []))),
        )
        for what, is_user in users:
            if name in primitive["attributes"] and is_user:
                self._asset.warn(
                    f"{self.name}: {what} use {name}, whose new map they do not fit; write to another set."
                )

    def polygons(self, uv_name: str, placement: npt.NDArray[np.float64]) -> AssetMesh:
        """Return the triangles of all groups, in their order."""
        positions, corners, uv, has_uv, first_row = [], [], [], False, 0
        for group in self.groups:
            places = self._asset.numbers(group.attributes["POSITION"])
            if places.shape[1] != 3:
                raise AssetError(
                    f"{self._asset.path}: {self.name} has positions of {places.shape[1]} values, not of 3."
                )
            positions.append(places)
            rows = group.corners
            corners.append(first_row + rows if first_row else rows)
            first_row += group.n_rows
            found = group.attributes.get(uv_name)
            has_uv |= found is not None
            # glTF's UVs have their origin at the top.
            offset, scale = self._asset.transform(group, uv_name)
            of_rows = (
                (self._asset.numbers(found) * scale + offset) * (1, -1) + (0, 1)
                if found is not None
                else np.full((group.n_rows, 2), np.nan)
            )
            uv.append((of_rows, rows))
        # -0.0 is the same position as 0.0.
        stored = np.concatenate(positions) + 0.0
        first, number_of_row = in_order_of_use(stored)
        used, number = renumbered(np.concatenate(corners), number_of_row)
        found_uv = None
        if has_uv:
            found_uv = np.empty((len(number), 2))
            at = 0
            for of_rows, rows in uv:
                found_uv[at : at + len(rows)] = of_rows[rows]
                at += len(rows)
        material = np.concatenate([group.materials for group in self.groups])
        if self.corners is None:
            offsets = np.arange(0, len(number) + 1, 3, dtype=np.int64)
        else:
            # A corner of a polygon is the first of the corners of triangles there.
            chosen = np.unique(self.corners, return_index=True)[1]
            number, found_uv = number[chosen], None if found_uv is None else found_uv[chosen]
            offsets = offsets_of(np.bincount(self.face_of_triangle) + 2)
            material = material[np.unique(self.face_of_triangle, return_index=True)[1]]
        return AssetMesh(
            *(stored[first[used]], offsets, number, found_uv, self.name, placement),
            material_of_face=material if (material != material[:1]).any() else None,
            material=int(material[0]) if len(material) else -1,
        )


def _triangles(asset: GltfAsset, primitive: _Json, n_rows: int) -> npt.NDArray[np.integer]:
    """Return the triangles of a primitive, (n, 3), in the winding of the first one."""
    if "indices" in primitive:
        stored = asset.array(primitive["indices"])
        if stored.dtype.kind != "u" or stored.shape[1] != 1:
            raise AssetError(f"{asset.path}: the indices are not unsigned integers.")
        rows = stored.ravel()
        if len(rows) and rows.max() >= n_rows:
            raise AssetError(f"{asset.path}: there is an index {rows.max()}, but only {n_rows} vertices.")
        # Half of the memory of int64.
        rows = rows.astype(np.int32 if n_rows <= np.iinfo(np.int32).max else np.int64)
    else:
        rows = np.arange(n_rows, dtype=np.int64)
    mode = primitive.get("mode", TRIANGLES)
    if mode == TRIANGLES:
        return rows[: len(rows) // 3 * 3].reshape(-1, 3)
    if len(rows) < 3:
        return np.zeros((0, 3), dtype=np.int64)
    if mode == FAN:
        return np.stack([rows[1:-1], rows[2:], np.broadcast_to(rows[0], len(rows) - 2)], axis=1)
    odd = np.arange(len(rows) - 2) % 2
    k = np.arange(len(rows) - 2)
    return np.stack([rows[k], rows[k + 1 + odd], rows[k + 2 - odd]], axis=1)


def _continues(triangles: npt.NDArray[np.integer]) -> npt.NDArray[np.bool_]:
    """Return which triangles, (n, 3), continue the fan of the one before."""
    result = np.zeros(len(triangles), dtype=bool)
    result[1:] = (triangles[1:, 0] == triangles[:-1, 0]) & (triangles[1:, 1] == triangles[:-1, 2])
    return result


def _placements(document: _Json) -> dict[int, npt.NDArray[np.float64]]:
    """Return the placement (4, 4) of each mesh with a node, by the first such node."""
    nodes = document.get("nodes", [])
    children = {child for node in nodes for child in node.get("children", [])}
    result: dict[int, npt.NDArray[np.float64]] = {}
    waiting = [(number, np.eye(4)) for number in reversed(range(len(nodes))) if number not in children]
    while waiting:
        number, parent = waiting.pop()
        node = nodes[number]
        placement = parent @ _matrix_of(node)
        if "mesh" in node:
            # A skinned mesh lies at its joints.
            result.setdefault(node["mesh"], np.eye(4) if "skin" in node else placement)
        waiting += [(child, placement) for child in reversed(node.get("children", []))]
        if len(waiting) > len(nodes):
            raise ValueError("nodes that are children of each other")
    return result


def _matrix_of(node: _Json) -> npt.NDArray[np.float64]:
    """Return the local matrix (4, 4) of a node: its own, or from scale, rotation (a quaternion) and translation."""
    if "matrix" in node:
        return np.reshape(np.array(node["matrix"], dtype=np.float64), (4, 4)).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.get("scale", (1.0, 1.0, 1.0)))
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


class _Edit:
    """A new version of a file: accessors with new content, and buffers without their unused parts."""

    def __init__(
        self, asset: GltfAsset, textures: TextureSize | None = None, shared: SharedTextures | None = None
    ) -> None:
        self._asset = asset
        self._shared = shared
        self._json: _Json = json.loads(asset.text)
        self._redrawing = None
        if textures:
            contents = [
                content_of(each, asset.path.parent, asset.content_of_view) for each in self._json.get("images", [])
            ]
            self._redrawing = Redrawing(self._json, asset.uv_map, textures, contents, shared)
        self._size = textures
        self._numbers: dict[Path, int] = {}
        """Of the images that assets share, by their paths."""
        self._outside: set[str] = set()
        self._colors = VertexColors("color")
        # The primitives whose colors become a texture.
        self._colored: list[_Json] = []
        self._blobs: list[bytes] = []
        self._n_views = len(self._json.get("bufferViews", []))
        self._uses = _uses(self._json)
        self._used_views = asset.view_numbers
        keys = [(m, p) for m, mesh in enumerate(asset.json["meshes"]) for p in range(len(mesh["primitives"]))]
        self._place_of = {id(asset.json["meshes"][m]["primitives"][p]): (m, p) for m, p in keys}

    def write_group(self, group: _Group, name: str, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> None:
        """Give the primitives of a group their UVs; a vertex with several gets a copy of all its data for each.

        Args:
            group: the primitives.
            name: of the attribute.
            uv: (3 triangles, 2)
            mapped: (triangles,)
        """
        rows = group.corners
        # What the material makes of the stored map is the new one.
        offset, scale = self._asset.transform(group, name, self._redrawing.taken if self._redrawing else frozenset())
        texels = np.empty((len(rows), 2), "<f4")
        for part in parts(len(rows)):
            texels[part] = (uv[part] * (1, -1) + (0, 1) - offset) / scale
        first, number_of_corner = numbered(rows, texels, None if mapped.all() else np.repeat(mapped, 3))
        of_row, different = rows[first], texels[first]
        del texels
        is_copy, indices = indices_of_copies(of_row, group.n_rows)
        sources = of_row[is_copy]
        coordinates = np.zeros((group.n_rows + len(sources), 2), "<f4")
        if name in group.attributes:
            coordinates[: group.n_rows] = self._asset.numbers(group.attributes[name])
        coordinates[indices] = different
        primitives = [self._primitive(each) for each in group.primitives]
        accessor = {"componentType": _FLOAT, "type": "VEC2"}
        number = self._put(group.attributes.get(name), accessor, coordinates)
        attributes = {**group.attributes, name: number}
        bends_light = any(self._bends_light(each, name) for each in group.primitives)
        recomputed = {"TANGENT"} if bends_light else set()
        old_targets = group.primitives[0].get("targets", [])
        targets = [dict(each) for each in old_targets]
        if len(sources):
            for extension in sorted({name for each in primitives for name in each.get("extensions", {})}):
                if extension not in _WITHOUT_VERTICES:
                    said = f"{extension} may name vertices by number, of which those at seams now have copies."
                    self._asset.warnings += [said] if said not in self._asset.warnings else []
            for numbers, new in ((attributes, {name}), *((each, set()) for each in targets)):
                for key in [key for key in numbers if key not in new | recomputed]:
                    numbers[key] = self._with_copies(numbers[key], sources)
        new_rows = number_of_corner
        for part in parts(len(rows)):
            is_new = new_rows[part] >= 0
            new_rows[part][is_new] = indices[new_rows[part][is_new]]
            new_rows[part][~is_new] = rows[part][~is_new]
        at_rest = None
        if bends_light:
            corners, of_material = new_rows.reshape(-1, 3), (coordinates * scale + offset) * (1, -1)
            at_rest = self._tangents(group, None, sources, corners, of_material)
            accessor = {"componentType": _FLOAT, "type": "VEC4"}
            attributes["TANGENT"] = self._put(attributes["TANGENT"], accessor, at_rest)
            for old, target in zip(old_targets, targets):
                if "TANGENT" in old:
                    added = (self._tangents(group, old, sources, corners, of_material) - at_rest)[:, :3]
                    target["TANGENT"] = self._put(old["TANGENT"], {"componentType": _FLOAT, "type": "VEC3"}, added)
            self._asset.warnings.append("The tangents of the replaced map were recomputed.")
        if self._redrawing and (self._shared or name in group.attributes):
            self._add_surface(
                group, coordinates, sources, np.where(mapped[:, None], new_rows.reshape(-1, 3), -1), at_rest
            )
        draws_colors = COLORS in attributes and self._size is not None and self._size.colors
        values = self._with_sources(group, COLORS, sources) if draws_colors else None
        at = 0
        for primitive, triangles in zip(primitives, group.triangles):
            primitive["attributes"] = attributes
            if values is not None and lacks_colors(self._json, primitive):
                own = slice(at // 3, at // 3 + len(triangles))
                drawn = new_rows[at : at + triangles.size].reshape(-1, 3)[mapped[own]]
                self._colors.add(values, coordinates * (1, -1) + (0, 1), drawn)
                self._colored.append(primitive)
            if targets:
                primitive["targets"] = targets
            if len(sources):
                primitive["indices"] = self._put_indices(primitive, new_rows[at : at + triangles.size])
                primitive.pop("mode", None)
            at += triangles.size

    def _with_sources(
        self, group: _Group, key: str, sources: Integers, target: Mapping[str, int] | None = None
    ) -> npt.NDArray[np.float64]:
        """Return an attribute, at rest or under a morph target, with the values of copied vertices at its end."""
        values = self._asset.numbers(group.attributes[key])
        if target and key in target:
            values = values + self._asset.numbers(target[key])
        return np.concatenate([values, values[sources]])

    def _tangents(
        self,
        group: _Group,
        target: Mapping[str, int] | None,
        sources: Integers,
        triangles: Integers,
        uv: npt.NDArray[np.float64],
    ) -> npt.NDArray[np.float32]:
        """Return the tangents of the vertices of a group at rest or under a morph target, for a map with v upward."""
        vertices, normals = (self._with_sources(group, key, sources, target) for key in ("POSITION", "NORMAL"))
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        return tangents(vertices, triangles, uv, normals / np.where(lengths > 0, lengths, 1)).astype("<f4")

    def _add_surface(
        self,
        group: _Group,
        coordinates: npt.NDArray[np.float32],
        sources: Integers,
        triangles: Integers,
        new_tangents: npt.NDArray[np.float32] | None,
    ) -> None:
        """Add the triangles of a group for drawing its textures; those without a map have the vertices -1."""
        given = {
            key: self._with_sources(group, name, sources) if name in group.attributes else None
            for key, name in (("old", self._asset.uv_map), ("normals", "NORMAL"), ("tangents", "TANGENT"))
        }
        ends = np.cumsum([len(each) for each in group.triangles])[:-1]
        pieces = [each[each[:, 0] >= 0] for each in np.split(triangles, ends)]
        self._redrawing.add(
            Surface(
                **given,
                primitives=[self._primitive(each) for each in group.primitives],
                new=coordinates.astype(np.float64),
                triangles=pieces,
                materials=[materials_of(each) for each in group.primitives],
                positions=self._with_sources(group, "POSITION", sources),
                new_tangents=given["tangents"] if new_tangents is None else new_tangents,
            )
        )

    def share(self) -> None:
        """Add the textures, and vertex colors for a texture, to those that assets share."""
        assert self._shared and self._redrawing
        self._redrawing.share(self._colored)
        if self._colors:
            opacity = has_opacity(self._json, self._colored)
            self._shared.add(BASE_COLOR, Colors(self._colors, opacity), NAME, self._asset.warnings.append)

    def _draw_colors(self, out: Path) -> None:
        """Draw vertex colors to a texture, which the materials of their primitives then read."""
        if not self._colors:
            return
        drawn = self._shared.find(BASE_COLOR) if self._shared else None
        if drawn:
            number, record = self._number_of(drawn, out), drawn.record
        else:
            baked = self._colors.drawn(self._size, opacity=has_opacity(self._json, self._colored))
            number = self._add_image({"name": NAME, "mimeType": "image/png"}, images.written(baked.image, ".png"))
            record = DrawnTexture.of(NAME, baked)
        color_by(self._json, self._colored, number, self._asset.uv_map)
        self._asset.drawn_textures.append(record)

    def _add_image(self, image: _Json, content: bytes) -> int:
        """Add an image, stored in the first buffer; return its number."""
        self._blobs.append(content)
        self._json["bufferViews"].append({"buffer": 0, "byteLength": len(content)})
        view = len(self._json["bufferViews"]) - 1
        self._json.setdefault("images", []).append({**image, "bufferView": view})
        return len(self._json["images"]) - 1

    def _number_of(self, drawn: SharedTexture, out: Path) -> int:
        """Return the number of an image that assets share: in a binary file, the others name it."""
        if drawn.path in self._numbers:
            return self._numbers[drawn.path]
        image = {"name": drawn.path.stem, "mimeType": images.MIME_TYPES[drawn.path.suffix]}
        if self._asset.chunks:
            number = self._add_image(image, drawn.content)
        else:
            uri = quote(drawn.name_from(out.parent))
            self._outside.add(uri)
            self._json.setdefault("images", []).append({**image, "uri": uri})
            number = len(self._json["images"]) - 1
        self._numbers[drawn.path] = number
        return number

    def _bends_light(self, primitive: _Json, name: str) -> bool:
        """Return whether a primitive has tangents that belong to this UV set, which its normal map uses."""
        if not {"TANGENT", "NORMAL"} <= primitive["attributes"].keys():
            return False
        material = self._json["materials"][primitive["material"]] if "material" in primitive else {}
        normals = material.get("normalTexture")
        return normals is not None and name == set_of(normals)

    def _primitive(self, original: _Json) -> _Json:
        mesh, place = self._place_of[id(original)]
        return self._json["meshes"][mesh]["primitives"][place]

    def _with_copies(self, number: int, sources: Integers) -> int:
        stored = self._asset.array(number)
        accessor = {
            k: v
            for k, v in self._json["accessors"][number].items()
            if k not in ("bufferView", "byteOffset", "sparse", "count")
        }
        return self._put(number, accessor, np.concatenate([stored, stored[sources]]))

    def _put_indices(self, primitive: _Json, rows: Integers) -> int:
        old = primitive.get("indices")
        least = self._json["accessors"][old]["componentType"] if old is not None else _UNSIGNED_BYTE
        # The highest number of a type can mark the end of a strip.
        kinds = [kind for kind in (_UNSIGNED_BYTE, _UNSIGNED_SHORT, _UNSIGNED_INT) if kind >= least]
        kind = next(kind for kind in kinds if rows.max(initial=0) < np.iinfo(_COMPONENTS[kind]).max)
        accessor = {"componentType": kind, "type": "SCALAR"}
        return self._put(old, accessor, rows.astype(_COMPONENTS[kind])[:, None], is_vertex=False)

    def _put(self, number: int | None, accessor: _Json, values: npt.NDArray, is_vertex: bool = True) -> int:
        """Replace the content of an accessor, or make a new one if others share it; return its number."""
        stride: dict[str, int] = {}
        if is_vertex:
            values, stride = _aligned(values)
        view: _Json = {"buffer": 0, "byteLength": 0, **stride}
        self._blobs.append(values.tobytes())
        self._json.setdefault("bufferViews", []).append(view)
        new = {"bufferView": len(self._json["bufferViews"]) - 1, "count": len(values), **accessor}
        if number is not None and self._uses.get(number, 1) == 1:
            kept = {k: v for k, v in self._json["accessors"][number].items() if k in ("name", "extras")}
            self._json["accessors"][number] = {**new, **kept}
            return number
        if number is not None:
            self._uses[number] -= 1
        self._json["accessors"].append(new)
        return len(self._json["accessors"]) - 1

    # Buffers

    def files(self, out: Path) -> Mapping[Path, Iterable[bytes | memoryview]]:
        """Return the contents of the files, in pieces, by path."""
        new_images = self._new_images(out)
        self._draw_colors(out)
        if self._redrawing:
            if self._shared:
                self._redrawing.point_to_shared(functools.partial(self._number_of, out=out))
            self._asset.drawn_textures = list(dict.fromkeys([*self._asset.drawn_textures, *self._redrawing.drawn]))
            self._asset.warnings += self._redrawing.warnings
        views = self._json["bufferViews"]
        used = set(_view_numbers(self._json))
        dropped = sorted(self._used_views - used)
        buffers: list[list[bytes | memoryview]] = []
        old = views[: self._n_views]
        for number, buffer in enumerate(self._asset.buffers):
            mine = [(k in dropped, view) for k, view in enumerate(old) if view["buffer"] == number]
            buffers.append(
                _without(buffer, *([view for out_of, view in mine if out_of == drop] for drop in (True, False)))
            )
        size = sum(map(len, buffers[0]))
        for view, blob in zip(views[self._n_views :], self._blobs):
            padding = bytes(-size % _WORD)
            view.update(buffer=0, byteOffset=size + len(padding), byteLength=len(blob))
            buffers[0] += [padding, blob]
            size += len(padding) + len(blob)
        numbers = {old: new for new, old in enumerate(k for k in range(len(views)) if k not in dropped)}
        _renumber_views(self._json, numbers)
        self._json["bufferViews"] = [view for k, view in enumerate(views) if k in numbers]
        for description, buffer in zip(self._json["buffers"], buffers):
            description["byteLength"] = sum(map(len, buffer))
        return self._stored(out, buffers, new_images)

    def _new_images(self, out: Path) -> dict[Path, Iterable[bytes]]:
        """Draw textures anew and store each as its image was: in a buffer, in the text, or as a file to be written."""
        files: dict[Path, Iterable[bytes]] = {}
        self._asset.drawn_textures = []
        if not self._redrawing:
            return files
        old_names = {unquote(image.get("uri", "")) for image in self._json.get("images", [])}
        for number, name, content in self._redrawing.images():
            image = self._json["images"][number]
            uri = image.get("uri")
            if uri is None:
                self._blobs.append(content)
                self._json["bufferViews"].append({"buffer": 0, "byteLength": len(content)})
                image["bufferView"] = len(self._json["bufferViews"]) - 1
            elif uri.startswith("data:"):
                image["uri"] = f"data:{image['mimeType']};base64,{base64.b64encode(content).decode()}"
            else:
                taken = {*old_names, *(path.name for path in files)}
                path = references.free_beside(out, f"{out.stem}_{name}", self._asset.path, taken)
                image["uri"] = quote(path.name)
                files[path] = [content]
        return files

    def _stored(
        self,
        out: Path,
        buffers: Sequence[Sequence[bytes | memoryview]],
        images: Mapping[Path, Iterable[bytes]],
    ) -> Mapping[Path, Iterable[bytes | memoryview]]:
        files: dict[Path, Iterable[bytes | memoryview]] = dict(images)
        new_names = {*(quote(path.name) for path in images), *self._outside}
        others = [image for image in self._json.get("images", []) if image.get("uri") not in new_names]
        binary: list[bytes | memoryview] = []
        for number, (description, content) in enumerate(zip(self._json["buffers"], buffers)):
            uri = description.get("uri")
            if uri is None:
                binary = list(content)
            elif uri.startswith("data:"):
                description["uri"] = f"{uri.partition(',')[0]},{base64.b64encode(b''.join(content)).decode()}"
            elif sum(map(len, content)) == len(self._asset.buffers[number]) and len(content) == 1:
                others.append(description)
            else:
                path = _free_path(out, f"{out.stem}.bin" if number == 0 else f"{out.stem}_{number}.bin")
                description["uri"] = quote(path.name)
                files[path] = content
        self._asset.beside = list(self._named(others, out))
        if not self._asset.chunks:
            files[out] = [json.dumps(self._json, ensure_ascii=False, indent=_indent(self._asset.text)).encode()]
            return files
        text = json.dumps(self._json, ensure_ascii=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % _WORD)
        chunks = [(_JSON_CHUNK, [text])]
        if binary:
            binary.append(bytes(-sum(map(len, binary)) % _WORD))
            chunks.append((_BINARY_CHUNK, binary))
        chunks += [(kind, [content]) for kind, content in self._asset.chunks[1:] if kind != _BINARY_CHUNK]
        body: list[bytes | memoryview] = []
        for kind, content in chunks:
            body += [struct.pack("<I4s", sum(map(len, content)), kind), *content]
        files[out] = [_GLB + struct.pack("<II", 2, 12 + sum(map(len, body))), *body]
        return files

    def _named(self, parts: Sequence[_Json], out: Path) -> Iterator[str]:
        """Rewrite the paths of separate images and buffers relative to `out`; yield the files to copy along."""
        for part in parts:
            uri = part.get("uri", "")
            if not uri or uri.startswith("data:"):
                continue
            name = unquote(uri)
            new = references.elsewhere(name, self._asset.path, out)
            if new == name:
                yield name
            else:
                part["uri"] = quote(new)


def _without(buffer: bytes | memoryview, dropped: list[_Json], kept: list[_Json]) -> list[bytes | memoryview]:
    """Return a buffer, in pieces, without the whole words that only dropped views use; the other views are shifted."""
    # Where the numbers of dropped and kept views change.
    changes: dict[int, list[int]] = {}
    for which, views in enumerate((dropped, kept)):
        for view in views:
            start = view.get("byteOffset", 0)
            for place, change in ((start, 1), (start + view["byteLength"], -1)):
                changes.setdefault(min(place, len(buffer)), [0, 0])[which] += change
    free: list[list[int]] = []
    counts, places = [0, 0], sorted(changes)
    for place, end in zip(places, places[1:]):
        counts = [count + change for count, change in zip(counts, changes[place])]
        if counts[0] and not counts[1]:
            free += [] if free and free[-1][1] == place else [[place, place]]
            free[-1][1] = end
    free = [[start + -start % _WORD, end - end % _WORD] for start, end in free]
    free = [[start, end] for start, end in free if start < end]
    ends, lengths = [end for _, end in free], [0, *itertools.accumulate(end - start for start, end in free)]
    for view in kept:
        if start := view.get("byteOffset", 0):
            view["byteOffset"] = start - lengths[bisect.bisect_right(ends, start)]
    whole = memoryview(buffer)
    bounds = zip([0, *ends], [*(start for start, _ in free), len(buffer)])
    return [whole[start:end] for start, end in bounds] if free else [buffer]


def _free_path(out: Path, name: str) -> Path:
    """Return the path for a buffer of the file `out`: beside it, and not the buffer of another glTF in the folder."""
    others = [path.read_bytes() for path in out.parent.glob("*.gltf") if path.name != out.name]

    def is_of_others(path: Path) -> bool:
        spellings = [json.dumps(each)[1:-1].encode() for each in (path.name, quote(path.name))]
        return path.exists() and any(spelling in other for spelling in spellings for other in others)

    numbered = (out.with_name(f"{Path(name).stem}_{number}.bin") for number in itertools.count(1))
    return next(path for path in itertools.chain([out.with_name(name)], numbered) if not is_of_others(path))


def _aligned(values: npt.NDArray) -> tuple[npt.NDArray, dict[str, int]]:
    """Return rows of vertices padded to whole words, and the stride for a view of them."""
    row = values.dtype.itemsize * values.shape[1]
    if row % _WORD == 0:
        return values, {}
    padded = np.zeros((len(values), row + -row % _WORD), np.uint8)
    padded[:, :row] = np.ascontiguousarray(values).view(np.uint8).reshape(len(values), row)
    return padded, {"byteStride": padded.shape[1]}


def _indent(text: str) -> str | None:
    """Return the indentation of the second line of a JSON text."""
    second = text.partition("\n")[2]
    return second[: len(second) - len(second.lstrip(" \t"))] or None


def _meshopt_of(view: _Json) -> _Json:
    """Return what meshopt's extension says of a view; empty if it is not compressed."""
    extensions = view.get("extensions", {})
    return next((extensions[name] for name in _MESHOPT if name in extensions), {})


def _uses(document: _Json) -> dict[int, int]:
    """Return the number of uses of each accessor."""
    result: dict[int, int] = {}
    seen = set()
    for m, mesh in enumerate(document.get("meshes", [])):
        for primitive in mesh["primitives"]:
            sets = [primitive["attributes"], *primitive.get("targets", [])]
            # Mapped primitives that share all vertices are one use; points and lines keep the vertices that they have.
            key = (m, has_faces(primitive), json.dumps(sets, sort_keys=True))
            numbers = [] if key in seen else [number for each in sets for number in each.values()]
            seen.add(key)
            for number in (*numbers, *([primitive["indices"]] if "indices" in primitive else [])):
                result[number] = result.get(number, 0) + 1
    others = [skin.get("inverseBindMatrices") for skin in document.get("skins", [])]
    for animation in document.get("animations", []):
        others += [sampler[key] for sampler in animation["samplers"] for key in ("input", "output")]
    places = [document, *document.get("nodes", []), *document.get("meshes", [])]
    places += [primitive for mesh in document.get("meshes", []) for primitive in mesh["primitives"]]
    for place in places:
        for name, content in place.get("extensions", {}).items():
            # Any number in an unknown extension may be that of an accessor.
            others += [] if name.startswith(_WITHOUT_ACCESSORS) else _integers(content)
    for number in others:
        if number is not None:
            result[number] = result.get(number, 0) + 1
    return result


def _integers(part: object) -> list[int]:
    """Return the integers in a part of the document that may number accessors."""
    if isinstance(part, dict):
        part = [value for key, value in part.items() if key != "bufferView"]
    if isinstance(part, list):
        return [number for each in part for number in _integers(each)]
    return [part] if isinstance(part, int) and not isinstance(part, bool) else []


def _view_numbers(part: object) -> Iterator[int]:
    """Yield the number of every view that a part of the document names, including extensions."""
    if isinstance(part, dict):
        for key, value in part.items():
            if key == "bufferView" and isinstance(value, int):
                yield value
            else:
                yield from _view_numbers(value)
    elif isinstance(part, list):
        for each in part:
            yield from _view_numbers(each)


def _renumber_views(part: object, numbers: dict[int, int]) -> None:
    if isinstance(part, dict):
        for key, value in part.items():
            if key == "bufferView" and isinstance(value, int):
                part[key] = numbers[value]
            else:
                _renumber_views(value, numbers)
    elif isinstance(part, list):
        for each in part:
            _renumber_views(each, numbers)
