"""Image textures of Blender's materials, drawn anew for a new UV map: for the batch and the add-on.

Blender's data comes as arguments; nothing of Blender is imported.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._arguments import Progress
from ._drawing_plan import NewTexture
from ._map_change import MapChange, drawn, new_texture
from ._quality import face_triangles
from ._rebaking import BakedTexture, Content, Wrap
from ._texture_size import TextureSize

# Blender's own types, which exist in Blender alone.
_Mesh = Any
_Material = Any
_Tree = Any
_Node = Any
_Socket = Any
_Image = Any
_Images = Any

Reason = Literal["tiles", "missing", "projection", "procedural", "group"]
"""Why a texture is not drawn anew: it is a sequence, a movie or has tiles; its image is missing; it is projected by
more than a UV map; what moves it is procedural; its node is in a group, which other materials may share."""

_WRAPS: dict[str, Wrap] = {"REPEAT": "repeat", "MIRROR": "mirror", "EXTEND": "clamp", "CLIP": "black"}
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
    role: str = ""
    """That of the image which assets share; empty for one of its own."""


@dataclass(frozen=True)
class TexturedMesh:
    """A mesh whose map is replaced, and its materials.

    Attributes:
        layer: name of the old map.
        is_rendered: whether the old map is the one that nodes read which name none.
        vertices: (V, 3)
        face_offsets: (F + 1,)
        corner_vertices: (C,)
        uv: (C, 2) the old map.
        slots: (F,) the slot of each face.
        normals: (C, 3) that renders use.
        materials: of each slot, those that objects with this mesh show there.
    """

    layer: str
    is_rendered: bool
    vertices: npt.NDArray[np.float64]
    face_offsets: npt.NDArray[np.integer]
    corner_vertices: npt.NDArray[np.integer]
    uv: npt.NDArray[np.float64]
    slots: npt.NDArray[np.integer]
    normals: npt.NDArray[np.floating]
    materials: Sequence[Sequence[_Material]]

    @classmethod
    def of(
        cls,
        mesh: _Mesh,
        layer: str,
        polygons: tuple[npt.NDArray[np.float64], npt.NDArray[np.integer], npt.NDArray[np.integer]],
        uv: npt.NDArray[np.float64],
        materials: Sequence[Sequence[_Material]],
    ) -> TexturedMesh:
        """Return it for a mesh of Blender that is not in edit mode.

        Args:
            mesh: with the old map.
            layer: name of the old map.
            polygons: the positions, the faces' offsets and the vertices of corners.
            uv: (C, 2) the old map.
            materials: as the attribute.
        """
        is_rendered = any(each.active_render and each.name == layer for each in mesh.uv_layers)
        slots = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get("material_index", slots)
        # Blender shows faces of a slot that does not exist with the last one.
        slots = np.minimum(slots, max(len(materials) - 1, 0))
        return cls(layer, is_rendered, *polygons, uv, slots, _normals_of_corners(mesh), materials)


@dataclass
class Job:
    """A texture to draw: how nodes read it, these nodes, and the faces that show it.

    Attributes:
        image: the old one.
        nodes: each with its material.
        faces: (F,) of each mesh, by its number.
    """

    image: _Image
    reading: _Reading
    nodes: list[tuple[_Material, _Node]] = field(default_factory=list)
    faces: dict[int, npt.NDArray[np.bool_]] = field(default_factory=dict)

    def pixels(self) -> np.ndarray:
        """Return the old pixels, (height, width, 4), rows from the top: bytes, or floats."""
        width, height = self.image.size
        values = np.empty(4 * width * height, np.float32)
        self.image.pixels.foreach_get(values)
        values = values.reshape(height, width, 4)[::-1]
        if self._has_coded_normals:
            return light(values)
        return values if self.image.is_float else np.rint(255 * values).astype(np.uint8)

    @property
    def _has_coded_normals(self) -> bool:
        """Whether the image has bytes of normals, but is not marked as data, so that Blender takes them for colors."""
        is_data = self.image.colorspace_settings.is_data
        return self.reading.content == "normals" and not is_data and not self.image.is_float

    def changes(
        self, meshes: Sequence[TexturedMesh], new: Sequence[npt.NDArray[np.floating]], mapped: Sequence[np.ndarray]
    ) -> list[MapChange]:
        """Return the faces with their place in the image and in the new maps (C, 2), of those `mapped` (F,)."""
        found = []
        for number, faces in self.faces.items():
            each = meshes[number]
            corners, _ = face_triangles(
                each.vertices, each.face_offsets, each.corner_vertices, selected_faces=faces & mapped[number]
            )
            positions = each.vertices[each.corner_vertices]
            old = self.reading.place.of(each.uv)
            found.append(MapChange(old, new[number], corners, positions, each.normals).part(corners))
        return found

    def new(self, changes: Sequence[MapChange], size: TextureSize) -> NewTexture | None:
        """Return what `draw` would draw; None if no face shows the texture."""
        width, height = self.image.size
        kind = np.dtype(np.float32 if self.image.is_float or self._has_coded_normals else np.uint8)
        return new_texture(self.image.name, (height, width, 4), kind, changes, size)

    def draw(
        self,
        pixels: np.ndarray,
        changes: Sequence[MapChange],
        size: TextureSize,
        progress: Progress | None = None,
    ) -> tuple[BakedTexture | None, float]:
        """Return the texture for the new maps, and its loss, as `drawn` does; in any thread."""
        return drawn(pixels, changes, size, *self.how(), progress)

    def how(self) -> tuple[Content, bool, bool, tuple[Wrap, Wrap]]:
        """Return what the texture means and how it is read, as `drawn` takes it."""
        read = self.reading
        return read.content, read.has_opacity, read.is_nearest, (read.wrap, read.wrap)

    def new_image(self, images: _Images, pixels: np.ndarray) -> _Image:
        """Add an image like the old one, with these pixels, stored in the file, to Blender's `images`."""
        height, width = pixels.shape[:2]
        image = images.new(f"{self.image.name} rebaked", width, height, alpha=True, float_buffer=self.image.is_float)
        # Blender holds floats as light, whatever their file codes, and stores them so.
        if self.image.colorspace_settings.is_data or not self.image.is_float:
            image.colorspace_settings.name = self.image.colorspace_settings.name
        image.alpha_mode = self.image.alpha_mode
        fill(image, np.rint(255.0 * coded(pixels)).astype(np.uint8) if self._has_coded_normals else pixels)
        return image


def find(
    meshes: Sequence[TexturedMesh], role_of: Callable[[_Node, Content], str] = lambda node, content: ""
) -> tuple[list[Job], dict[tuple[str, Reason], None]]:
    """Return the textures that read the old maps, and the images that do but cannot be drawn anew, with the reasons.

    `role_of` names the image that an image node may share with others; two that the same faces show share none.
    """
    jobs: dict[_Reading, Job] = {}
    kept: dict[tuple[str, Reason], None] = {}
    for number, each in enumerate(meshes):
        for slot, materials in enumerate(each.materials):
            used = [material for material in materials if material is not None and material.node_tree is not None]
            faces = each.slots == slot
            for material in used if faces.any() else ():
                for node, is_grouped in _image_nodes(material.node_tree):
                    reading = "group" if is_grouped else _reading(node)
                    if isinstance(reading, str):
                        kept[node.image.name, reading] = None
                    elif reading.place.layer == each.layer or (not reading.place.layer and each.is_rendered):
                        reading = replace(reading, role=role_of(node, reading.content))
                        job = jobs.setdefault(reading, Job(node.image, reading))
                        pair = material, node
                        job.nodes += [pair] if pair not in job.nodes else []
                        job.faces[number] = job.faces.get(number, False) | faces
    _part(list(jobs.values()))
    return list(jobs.values()), kept


def moves(material: _Material, layer: str, is_rendered: bool) -> bool:
    """Return whether a material scales, turns or moves images that read a layer; `is_rendered`, if renders use it."""
    for node, _ in _image_nodes(material.node_tree) if material.node_tree else ():
        place = _place(node.inputs["Vector"]) if node.projection == "FLAT" else None
        if place and place != _Place(place.layer) and (place.layer == layer or (not place.layer and is_rendered)):
            return True
    return False


def _part(jobs: Sequence[Job]) -> None:
    """Take the role from jobs of the same role that the same faces show."""
    for one, two in itertools.combinations(jobs, 2):
        both = one.faces.keys() & two.faces.keys()
        if one.reading.role == two.reading.role and any((one.faces[n] & two.faces[n]).any() for n in both):
            for each in (one, two):
                each.reading = replace(each.reading, role="")


def fill(image: _Image, pixels: np.ndarray) -> None:
    """Give an image its pixels, (height, width, 4), rows from the top: bytes, or floats; store it in the file."""
    upward = pixels[::-1]
    # In one pass: the largest textures have a gigabyte of floats.
    values = upward if pixels.dtype.kind == "f" else np.divide(upward, 255, dtype=np.float32, order="C")
    image.pixels.foreach_set(np.ascontiguousarray(values, np.float32).ravel())
    image.update()
    image.pack()


def light(colors: np.ndarray) -> npt.NDArray[np.float32]:
    """Return colors, (height, width, 4) from 0 to 1, of which sRGB (IEC 61966-2-1) codes the first three channels."""
    found = np.array(colors, np.float32)
    codes = found[:, :, :3]
    found[:, :, :3] = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return found


def coded(colors: np.ndarray) -> npt.NDArray[np.float32]:
    """Return the colors of which `light` returns these."""
    found = np.array(colors, np.float32)
    inside = np.clip(found[:, :, :3], 0.0, 1.0)
    found[:, :, :3] = np.where(inside <= 0.0031308, 12.92 * inside, 1.055 * inside ** (1 / 2.4) - 0.055)
    return found


def read_from(tree: _Tree, node: _Node, layer: str) -> None:
    """Let an image node of a tree, and the normal maps that it feeds, read a layer by its name; nothing moves it."""
    source = tree.nodes.new("ShaderNodeUVMap")
    source.uv_map = layer
    source.location = node.location.x - 200, node.location.y
    tree.links.new(source.outputs["UV"], node.inputs["Vector"])
    for turned in _normal_maps(node):
        turned.uv_map = layer


def read_plainly(tree: _Tree, node: _Node, layer: str) -> None:
    """Let a node read its image from the UV map itself, if another node moves it."""
    socket = node.inputs["Vector"]
    if socket.is_linked and socket.links[0].from_node.type not in ("UVMAP", "TEX_COORD"):
        read_from(tree, node, layer)


def _image_nodes(tree: _Tree, is_grouped: bool = False) -> Iterator[tuple[_Node, bool]]:
    """Yield the nodes with images, and whether they are in a group."""
    for node in tree.nodes:
        if node.type == "TEX_IMAGE" and node.image is not None:
            yield node, is_grouped
        elif node.type == "GROUP" and node.node_tree is not None:
            yield from _image_nodes(node.node_tree, is_grouped=True)


def _normal_maps(node: _Node) -> list[_Node]:
    """Return the nodes that turn the colors of an image to normals by the tangents of a map."""
    fed = [link.to_node for link in node.outputs["Color"].links]
    return [each for each in fed if each.type == "NORMAL_MAP" and each.space == "TANGENT"]


def _reading(node: _Node) -> _Reading | Reason:
    """Return how a node reads its image, or why that cannot be drawn anew."""
    image = node.image
    if image.source not in ("FILE", "GENERATED"):
        return "tiles"
    if not image.has_data and not image.pixels:
        return "missing"
    if node.projection != "FLAT":
        return "projection"
    place = _place(node.inputs["Vector"])
    if place is None:
        return "procedural"
    is_color = not image.colorspace_settings.is_data
    turned = _normal_maps(node)
    is_turned = len(turned) == len(node.outputs["Color"].links) if is_color else bool(turned)
    content: Content = "normals" if turned and is_turned else "color" if is_color else "data"
    # Blender holds floats multiplied by their opacity, and packed channels have none.
    is_apart = not image.is_float and image.alpha_mode != "CHANNEL_PACKED"
    has_opacity = content == "color" and is_apart and node.outputs["Alpha"].is_linked
    return _Reading(image.name, content, has_opacity, place, _WRAPS[node.extension], node.interpolation == "Closest")


def _place(socket: _Socket) -> _Place | None:
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


def _normals_of_corners(mesh: _Mesh) -> npt.NDArray[np.float32]:
    """Return the normals that renders use, (C, 3)."""
    normals = np.empty(3 * len(mesh.loops), np.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", normals)
    else:
        # Before 4.1.
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals)
        mesh.free_normals_split()
    return normals.reshape(-1, 3)
