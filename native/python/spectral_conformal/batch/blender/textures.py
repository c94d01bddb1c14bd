"""Image textures of Blender's materials, drawn anew for a new UV map."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..._quality import face_triangles
from ..._rebaking import Content, Wrap
from ...assets import AssetMesh, UvMap
from ...assets.map_change import MapChange, drawn
from ...assets.textures import DrawnTexture, TextureSize, said_of_loss

_WRAPS: dict[str, Wrap] = {"REPEAT": "repeat", "MIRROR": "mirror", "EXTEND": "clamp", "CLIP": "clamp"}
# Of Mapping nodes: what they do to a point.
_POINT = "POINT"


@dataclass(frozen=True)
class _Place:
    """Where a node reads its image, from the UVs of a layer."""

    layer: str
    """Empty for the one that renders use."""
    offset: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)

    def of(self, uv: np.ndarray) -> np.ndarray:
        """Return the places in the image for UVs (n, 2)."""
        x, y = (uv * self.scale).T
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return np.c_[cos * x - sin * y, sin * x + cos * y] + self.offset


@dataclass(frozen=True)
class _Reading:
    """What determines a new texture: the old one, and how nodes read it."""

    image: str
    content: Content
    has_opacity: bool
    place: _Place
    wrap: Wrap
    is_nearest: bool


@dataclass
class _Job:
    nodes: list[tuple[bpy.types.NodeTree, bpy.types.Node]] = field(default_factory=list)
    changes: list[MapChange] = field(default_factory=list)


def redraw(
    meshes: Sequence[bpy.types.Mesh],
    read: Sequence[AssetMesh],
    maps: Sequence[UvMap],
    uv_map: str,
    size: TextureSize,
) -> tuple[list[DrawnTexture], list[str]]:
    """Draw the textures that read the replaced maps anew, into images of their own; return them, and warnings.

    Args:
        meshes: with the old maps.
        read: these meshes as read.
        maps: the new maps.
        uv_map: name of the map that is replaced; empty for the active one.
        size: of the new textures.
    """
    jobs: dict[_Reading, _Job] = {}
    warnings: list[str] = []
    for mesh, arrays, new in zip(meshes, read, maps):
        layer = mesh.uv_layers.get(uv_map) if uv_map else mesh.uv_layers.active
        if layer is None or arrays.corner_uv is None:
            continue
        rendered = next((each.name for each in mesh.uv_layers if each.active_render), "")
        slots = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get("material_index", slots)
        for number, material in enumerate(mesh.materials):
            chosen = (np.minimum(slots, len(mesh.materials) - 1) == number) & new.mapped
            if material is None or material.node_tree is None or material.library or not chosen.any():
                continue
            corners, _ = face_triangles(
                arrays.vertices, arrays.face_offsets, arrays.corner_vertices, selected_faces=chosen
            )
            positions = arrays.vertices[arrays.corner_vertices]
            change = MapChange(arrays.corner_uv, new.uv, corners, positions, _normals_of_corners(mesh)).part(corners)
            for node in _image_nodes(material.node_tree):
                reading = _reading(node)
                if isinstance(reading, str):
                    said = f"The texture {node.image.name} was not drawn anew: {reading}."
                    warnings += [said] if said not in warnings else []
                elif (reading.place.layer or rendered) == layer.name:
                    job = jobs.setdefault(reading, _Job())
                    pair = material.node_tree, node
                    job.nodes += [pair] if pair not in job.nodes else []
                    job.changes.append(change)
    found = []
    for reading, job in jobs.items():
        old = bpy.data.images[reading.image]
        placed = [
            MapChange(reading.place.of(each.old), each.new, each.triangles, each.positions, each.normals)
            for each in job.changes
        ]
        baked, loss = drawn(
            _pixels(old), placed, size, reading.content, reading.has_opacity, reading.is_nearest, (reading.wrap,) * 2
        )
        if baked is None:
            continue
        warnings += [said_of_loss(old.name, loss)] if loss else []
        found.append(DrawnTexture.of(old.name, baked))
        new_image = _new_image(old, baked.image)
        for tree, node in job.nodes:
            node.image = new_image
            _read_plainly(tree, node, reading.place.layer)
    return found, warnings


def _image_nodes(tree: bpy.types.NodeTree) -> Iterator[bpy.types.Node]:
    return (node for node in tree.nodes if node.type == "TEX_IMAGE" and node.image is not None)


def _reading(node: bpy.types.Node) -> _Reading | str:
    """Return how a node reads its image, or why that cannot be drawn anew."""
    image = node.image
    if image.source not in ("FILE", "GENERATED"):
        return "it is a sequence, a movie or has tiles"
    if not image.has_data and not image.pixels:
        return "its image is missing"
    if node.projection != "FLAT":
        return "it is not projected by a UV map alone"
    place = _place(node.inputs["Vector"])
    if place is None:
        return "what moves it is procedural"
    is_color = not image.colorspace_settings.is_data
    turns = any(
        link.to_node.type == "NORMAL_MAP" and link.to_node.space == "TANGENT" for link in node.outputs["Color"].links
    )
    content: Content = "color" if is_color else "normals" if turns else "data"
    has_opacity = is_color and node.outputs["Alpha"].is_linked
    return _Reading(image.name, content, has_opacity, place, _WRAPS[node.extension], node.interpolation == "Closest")


def _place(socket: bpy.types.NodeSocket) -> _Place | None:
    """Return where a vector comes from; None if from something else than a UV map, moved by at most a Mapping node."""
    if not socket.is_linked:
        return _Place("")
    link = socket.links[0]
    node = link.from_node
    if node.type == "UVMAP" and not node.from_instancer:
        return _Place(node.uv_map)
    if node.type == "TEX_COORD" and link.from_socket.name == "UV" and not node.from_instancer:
        return _Place("")
    if node.type == "REROUTE":
        return _place(node.inputs[0])
    if node.type != "MAPPING" or node.vector_type != _POINT:
        return None
    inner = _place(node.inputs["Vector"])
    moves = [node.inputs[name] for name in ("Location", "Rotation", "Scale")]
    if inner is None or inner != _Place(inner.layer) or any(each.is_linked for each in moves):
        return None
    location, rotation, scale = (tuple(each.default_value) for each in moves)
    if rotation[0] or rotation[1]:
        return None
    return _Place(inner.layer, location[:2], rotation[2], scale[:2])


def _normals_of_corners(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """Return the normals that renders use, (C, 3); None in versions without them."""
    if not hasattr(mesh, "corner_normals"):
        return None
    normals = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", normals)
    return normals.reshape(-1, 3).astype(np.float64)


def _pixels(image: bpy.types.Image) -> np.ndarray:
    """Return an image's pixels, (height, width, 4), rows from the top: bytes, or floats."""
    width, height = image.size
    values = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, 4)[::-1]
    return values if image.is_float else np.rint(255 * values).astype(np.uint8)


def _new_image(old: bpy.types.Image, pixels: np.ndarray) -> bpy.types.Image:
    """Return a new image like an old one, stored in the file."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(f"{old.name} rebaked", width, height, alpha=True, float_buffer=old.is_float)
    image.colorspace_settings.name = old.colorspace_settings.name
    image.alpha_mode = old.alpha_mode
    values = pixels if pixels.dtype.kind == "f" else pixels.astype(np.float32) / 255
    image.pixels.foreach_set(np.ascontiguousarray(values[::-1], np.float32).ravel())
    image.update()
    image.pack()
    return image


def _read_plainly(tree: bpy.types.NodeTree, node: bpy.types.Node, layer: str) -> None:
    """Let a node read its image from the UV map itself, if another node moves it."""
    socket = node.inputs["Vector"]
    if not socket.is_linked or socket.links[0].from_node.type in ("UVMAP", "TEX_COORD"):
        return
    source = tree.nodes.new("ShaderNodeUVMap")
    source.uv_map = layer
    source.location = node.location.x - 200, node.location.y
    tree.links.new(source.outputs["UV"], socket)
