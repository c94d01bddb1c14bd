"""Blender's own bake: of inputs of shaders that read a replaced UV map otherwise than by images alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass

import bpy
import numpy as np

from ..._blender_textures import TexturedMesh, coded, fill, read_from
from ..._rebaking import BakedTexture, fill_margin
from ..._texture_size import DrawnTexture, TextureSize
from ...assets import UvMap
from . import meshes as arrays_of
from .checker import shader_nodes

_SAMPLES = 16
_NORMAL = "Normal"
# Of texels that are not baked; baked ones have light, or normals as colors. Only some Blenders mark them by opacity.
_EMPTY = -1.0
# What an emission shows, and so can be baked.
_VALUES = ("RGBA", "VALUE")
# Whatever the file's scene says.
_BAKE = {
    "use_selected_to_active": False,
    "use_clear": False,
    "margin": 0,
    "target": "IMAGE_TEXTURES",
    "save_mode": "INTERNAL",
}
_NORMALS = {"normal_space": "TANGENT", "normal_r": "POS_X", "normal_g": "POS_Y", "normal_b": "POS_Z"}

# A material and the name of a node in it.
Place = tuple[str, str]


@dataclass(frozen=True)
class Input:
    """An input of a shader, by names that outlast the open file."""

    material: str
    node: str
    socket: str

    def find(self) -> tuple[bpy.types.NodeTree, bpy.types.NodeSocket]:
        """Return its tree and its socket."""
        tree = next(each for each in bpy.data.materials if each.name_full == self.material).node_tree
        return tree, next(each for each in tree.nodes[self.node].inputs if each.identifier == self.socket)


@dataclass(frozen=True)
class BakedInput:
    """An input and the texture that replaces what feeds it; colors are light."""

    input: Input
    texture: BakedTexture

    def apply(self, layer: str) -> DrawnTexture:
        """Let the input of the open file read an image on a UV map instead."""
        tree, socket = self.input.find()
        height, width = self.texture.covered.shape
        is_color = socket.type == "RGBA"
        # Light beyond what bytes can code.
        is_float = is_color and float(self.texture.image[:, :, :3].max()) > 1.0
        name = f"{self.input.material} {socket.name}"
        image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float, is_data=not is_color)
        values = self.texture.image if is_float or not is_color else coded(self.texture.image)
        fill(image, values if is_float else np.rint(255.0 * np.clip(values, 0.0, 1.0)).astype(np.uint8))
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        node.location = socket.node.location.x - 300, socket.node.location.y
        source = node.outputs["Color"]
        if socket.name == _NORMAL:
            turn = tree.nodes.new("ShaderNodeNormalMap")
            tree.links.new(source, turn.inputs["Color"])
            source = turn.outputs["Normal"]
        tree.links.new(source, socket)
        read_from(tree, node, layer)
        return DrawnTexture.of(name, self.texture)


def inputs(textured: Sequence[TexturedMesh], drawn: Set[Place]) -> tuple[list[Input], list[str]]:
    """Return the inputs of shaders to bake, and warnings about what cannot be.

    Args:
        textured: with the old maps.
        drawn: the image nodes that are drawn anew.
    """
    found: dict[Input, None] = {}
    warnings = []
    for each in textured:
        for material in dict.fromkeys(material for slot in each.materials for material in slot):
            tree = material.node_tree
            for socket in _sockets(tree) if tree is not None else ():
                if not _Upstream(material.name_full, each, drawn).reads_map(socket):
                    continue
                is_surface = socket.name == _NORMAL and socket.node.type == "BSDF_PRINCIPLED"
                if material.library or not (socket.type in _VALUES or is_surface):
                    warnings.append(
                        f"{socket.name} of the material {material.name} reads the old map: bake it in Blender."
                    )
                else:
                    found[Input(material.name_full, socket.node.name, socket.identifier)] = None
    return list(found), list(dict.fromkeys(warnings))


def _sockets(tree: bpy.types.NodeTree) -> Iterator[bpy.types.NodeSocket]:
    """Yield the inputs of shaders and of the output that other nodes than shaders feed."""
    for node in tree.nodes:
        if node.type == "OUTPUT_MATERIAL" or any(each.type == "SHADER" for each in node.outputs):
            yield from (each for each in node.inputs if each.is_linked and each.type != "SHADER")


class _Upstream:
    """The nodes that feed an input."""

    def __init__(self, material: str, mesh: TexturedMesh, drawn: Set[Place]) -> None:
        self._material, self._mesh, self._drawn = material, mesh, drawn
        self._seen: set[str] = set()

    def reads_map(self, socket: bpy.types.NodeSocket) -> bool:
        """Return whether the mesh's old map reaches an input, but for images that are drawn anew."""
        return any(self._does(link.from_node, link.from_socket) for link in socket.links)

    def _does(self, node: bpy.types.Node, output: bpy.types.NodeSocket) -> bool:
        if (self._material, node.name) in self._drawn or f"{node.name} {output.identifier}" in self._seen:
            return False
        self._seen.add(f"{node.name} {output.identifier}")
        if self._reads(node, output) or (node.type == "GROUP" and node.node_tree and self._in_group(node.node_tree)):
            return True
        return any(self.reads_map(each) for each in node.inputs)

    def _in_group(self, tree: bpy.types.NodeTree) -> bool:
        """Return whether any node of a group reads the map."""
        return any(
            any(self._reads(node, each) for each in node.outputs if each.is_linked)
            or (node.type == "GROUP" and node.node_tree is not None and self._in_group(node.node_tree))
            for node in tree.nodes
        )

    def _reads(self, node: bpy.types.Node, output: bpy.types.NodeSocket) -> bool:
        """Return whether a node itself reads the map."""
        if node.type == "TEX_IMAGE":
            is_there = node.image is not None and (node.image.has_data or bool(node.image.pixels))
            return is_there and self._mesh.is_rendered and not node.inputs["Vector"].is_linked
        if node.type == "UVMAP":
            return self._is_map(node.uv_map)
        if node.type == "TEX_COORD":
            return output.name == "UV" and self._mesh.is_rendered
        if node.type == "ATTRIBUTE":
            return node.attribute_name == self._mesh.layer
        if node.type == "NORMAL_MAP" and node.space == "TANGENT" and self._is_map(node.uv_map):
            fed = node.inputs["Color"].links
            return not fed or (self._material, fed[0].from_node.name) not in self._drawn
        return node.type == "TANGENT" and node.direction_type == "UV_MAP" and self._is_map(node.uv_map)

    def _is_map(self, name: str) -> bool:
        return name == self._mesh.layer or (not name and self._mesh.is_rendered)


def bake(
    wanted: Sequence[Input], meshes: Sequence[bpy.types.Mesh], maps: Sequence[UvMap], uv_map: str, size: TextureSize
) -> list[BakedInput]:
    """Bake inputs for the new maps of meshes; what Blender holds then is to be thrown away.

    Raises:
        RuntimeError: Blender cannot.
    """
    width, height = size.layout
    _set_up(bpy.context.scene)
    solids = [_solid(mesh, new, uv_map) for mesh, new in zip(meshes, maps)]
    empty = _target("empty", 1, 1)
    others = bpy.data.materials.new("others")
    _aim(others, shader_nodes(others).new("ShaderNodeTexImage"), empty)
    found = []
    # To bake the others, materials lose their surface.
    for each in sorted(wanted, key=lambda each: each.find()[1].name != _NORMAL):
        image = _target(each.material, width, height)
        tree, socket = each.find()
        material = next(one for one in bpy.data.materials if one.name_full == each.material)
        _aim(material, tree.nodes.new("ShaderNodeTexImage"), image)
        if socket.name != _NORMAL:
            _show(tree, socket)
        for solid, materials in solids:
            if not any(material in own for own in materials):
                continue
            for slot, own in zip(solid.material_slots, materials):
                slot.material = material if material in own else others
            _select(solid)
            kind = {"type": "NORMAL", **_NORMALS} if socket.name == _NORMAL else {"type": "EMIT"}
            if "FINISHED" not in bpy.ops.object.bake(**kind, **_BAKE):
                raise RuntimeError(f"{each.material} cannot be baked.")
        values = np.empty(4 * width * height, np.float32)
        image.pixels.foreach_get(values)
        values = np.ascontiguousarray(values.reshape(height, width, 4)[::-1])
        covered = (values[:, :, :3] != _EMPTY).any(axis=2)
        values[:, :, 3] = 1.0
        fill_margin(values, covered.view(np.uint8))
        found.append(BakedInput(each, BakedTexture(values, covered)))
    return found


def _set_up(scene: bpy.types.Scene) -> None:
    scene.render.engine = "CYCLES"
    scene.render.use_simplify = False
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", _SAMPLES, 0
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False


def _solid(mesh: bpy.types.Mesh, new: UvMap, uv_map: str) -> tuple[bpy.types.Object, list[set[bpy.types.Material]]]:
    """Return a new object with a copy of a mesh, whose active map is the new one, and the materials of each slot."""
    users = [item for item in bpy.data.objects if item.data == mesh]
    copy = mesh.copy()
    old = copy.uv_layers.get(uv_map) if uv_map else copy.uv_layers.active
    solid = bpy.data.objects.new("bake", copy)
    bpy.context.scene.collection.objects.link(solid)
    solid.matrix_world = users[0].matrix_world
    materials = [{slot.material for slot in of_users} for of_users in zip(*(each.material_slots for each in users))]
    for slot in solid.material_slots:
        slot.link = "OBJECT"
    if old is not None:
        added = copy.uv_layers.new(name="bake", do_init=True)
        if added is None:
            raise RuntimeError(f"{mesh.name} has no room for another UV map: remove one.")
        copy.uv_layers.active = added
        arrays_of.write_uv(copy, added.name, new)
    return solid, materials


def _target(name: str, width: int, height: int) -> bpy.types.Image:
    """Return an image of which nothing is covered."""
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=True, is_data=True)
    image.pixels.foreach_set(np.full(4 * width * height, _EMPTY, np.float32))
    image.update()
    return image


def _aim(material: bpy.types.Material, node: bpy.types.Node, image: bpy.types.Image) -> None:
    """Let Blender bake the faces with a material to an image."""
    node.image = image
    for each in material.node_tree.nodes:
        each.select = each == node
    material.node_tree.nodes.active = node


def _show(tree: bpy.types.NodeTree, socket: bpy.types.NodeSocket) -> None:
    """Let a material emit what feeds an input."""
    light = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(socket.links[0].from_socket, light.inputs["Color"])
    output = tree.get_output_node("CYCLES") or tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(light.outputs["Emission"], output.inputs["Surface"])


def _select(solid: bpy.types.Object) -> None:
    bpy.context.view_layer.update()
    for each in bpy.context.view_layer.objects:
        each.select_set(each == solid)
    bpy.context.view_layer.objects.active = solid
