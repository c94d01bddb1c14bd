"""Image textures of a .blend or .fbx file, drawn anew for a new UV map; and those made of color attributes."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

from ..._blender_textures import Job, Reason, TexturedMesh, fill, find, moves, read_from, read_plainly
from ..._map_change import MapChange
from ..._quality import face_triangles
from ..._texture_size import DrawnTexture, TextureSize, planned
from ..._vertex_colors import VertexColors
from ...assets import AssetMesh, SharedTextures, UvMap
from ...assets.shared_textures import Picture, SharedTexture
from . import baking, roles
from .checker import shader_nodes

_WORDS: dict[Reason, str] = {
    "tiles": "it is a sequence, a movie or has tiles",
    "missing": "its image is missing",
    "projection": "it is not projected by a UV map alone",
    "procedural": "what moves it is procedural",
    "group": "it is in a group of nodes",
}
_OWN = "it has floats, another color space, opacity apart, or is not the one image of an input of the Principled BSDF"


@dataclass(frozen=True)
class Atlas:
    """Images that an asset shares with others.

    Attributes:
        images: these.
        readings: those of the asset's textures that are part of them.
    """

    images: SharedTextures
    readings: Set[Any]


def redraw(
    meshes: Sequence[bpy.types.Mesh],
    read: Sequence[AssetMesh],
    maps: Sequence[UvMap],
    uv_map: str,
    size: TextureSize,
    atlas: Atlas | None = None,
    bakes: bool = False,
) -> tuple[list[DrawnTexture], list[str]]:
    """Draw the textures that read the replaced maps anew, into images of their own; return them, and warnings.

    Args:
        meshes: with the old maps.
        read: these meshes as read.
        maps: the new maps.
        uv_map: name of the map that is replaced; empty for the active one.
        size: of the new textures.
        atlas: drawn images that are read instead of own ones.
        bakes: whether what cannot be drawn is baked, or warned of, in another way, but for missing images.
    """
    jobs, kept, changes_of, _ = _jobs(meshes, read, maps, uv_map)
    left = [(name, reason) for name, reason in kept if reason == "missing" or not bakes]
    warnings = [f"The texture {name} was not drawn anew: {_WORDS[reason]}." for name, reason in left]
    found: dict[str, DrawnTexture] = {}
    for job in jobs:
        warnings += _on_linked(job)
    jobs = [job for job in jobs if any(not material.library for material, _ in job.nodes)]

    def shared_of(job: Job) -> SharedTexture | None:
        return atlas.images.find(job.reading.role) if atlas and job.reading in atlas.readings else None

    wanted = {number: job.new(changes_of(job), size) for number, job in enumerate(jobs) if shared_of(job) is None}
    own = planned(size, wanted, warnings.append)
    for number, job in enumerate(jobs):
        nodes = [(material, node) for material, node in job.nodes if not material.library]
        drawn = shared_of(job)
        if drawn is not None:
            image = _image_of(drawn, job)
            found[drawn.record.name] = drawn.record
        else:
            if number not in own:
                continue
            baked, _ = job.draw(job.pixels(), changes_of(job), TextureSize("size", own[number].size))
            assert baked is not None
            found[f"own {len(found)}"] = DrawnTexture.of(job.image.name, baked)
            image = job.new_image(bpy.data.images, baked.image)
        for material, node in nodes:
            node.image = image
            read_plainly(material.node_tree, node, job.reading.place.layer)
    return list(found.values()), list(dict.fromkeys(warnings))


def share(
    meshes: Sequence[bpy.types.Mesh],
    read: Sequence[AssetMesh],
    maps: Sequence[UvMap],
    uv_map: str,
    shared: SharedTextures,
    warn: Callable[[str], None],
) -> Atlas:
    """Add the textures to those that assets share; others will get images of their own.

    The first arguments are those of `redraw`; `warn` takes warnings, also while the images are drawn.
    """
    jobs, _, changes_of, _ = _jobs(meshes, read, maps, uv_map)
    readings = set()
    for job in jobs:
        changes = changes_of(job)
        if not any(len(each.triangles) for each in changes) or all(material.library for material, _ in job.nodes):
            continue
        pixels = _shareable(job)
        if pixels is None:
            warn(f"The texture {job.image.name} is not in the atlas: {_OWN}.")
            continue
        suffix = ".jpg" if job.image.file_format == "JPEG" else ".png"
        picture = Picture(_stored(pixels), changes, *job.how(), suffix)
        shared.add(job.reading.role, picture, job.image.name, warn)
        readings.add(job.reading)
    return Atlas(shared, readings)


def _jobs(
    meshes: Sequence[bpy.types.Mesh], read: Sequence[AssetMesh], maps: Sequence[UvMap], uv_map: str
) -> tuple[list[Job], Iterable[tuple[str, Reason]], Callable[[Job], list[MapChange]], Sequence[TexturedMesh]]:
    """Return the textures that read the replaced maps, those that cannot be drawn, and what returns a job's changes.

    And the meshes that have maps.
    """
    textured, new = [], []
    for mesh, arrays, uv, materials in zip(meshes, read, maps, _materials(meshes)):
        layer = mesh.uv_layers.get(uv_map) if uv_map else mesh.uv_layers.active
        if layer is None or arrays.corner_uv is None:
            continue
        polygons = arrays.vertices, arrays.face_offsets, arrays.corner_vertices
        textured.append(TexturedMesh.of(mesh, layer.name, polygons, arrays.corner_uv, materials))
        new.append(uv)
    jobs, kept = find(textured, roles.role_of)
    uv, mapped = [each.uv for each in new], [each.mapped for each in new]
    return jobs, kept, lambda job: job.changes(textured, uv, mapped), textured


def are_moved(meshes: Sequence[bpy.types.Mesh], uv_map: str) -> bool:
    """Return whether materials scale, turn or move images that read the map; the arguments are those of `redraw`."""
    for mesh, slots in zip(meshes, _materials(meshes)):
        layer = mesh.uv_layers.get(uv_map) if uv_map else mesh.uv_layers.active
        if layer and any(moves(each, layer.name, layer.active_render) for slot in slots for each in slot):
            return True
    return False


def to_bake(
    meshes: Sequence[bpy.types.Mesh], read: Sequence[AssetMesh], maps: Sequence[UvMap], uv_map: str
) -> tuple[list[baking.Input], list[str]]:
    """Return the inputs of shaders that Blender has to bake, and warnings; the arguments are those of `redraw`."""
    jobs, _, _, textured = _jobs(meshes, read, maps, uv_map)
    return baking.inputs(textured, {(material.name_full, node.name) for job in jobs for material, node in job.nodes})


def part_materials(
    meshes: Sequence[bpy.types.Mesh], read: Sequence[AssetMesh], maps: Sequence[UvMap], uv_map: str
) -> None:
    """Give meshes copies of the materials that read their replaced maps, if other objects, with other maps, show these.

    The arguments are those of `redraw`.
    """
    readers: dict[str, set[bpy.types.Mesh]] = {}
    for mesh, *own in zip(meshes, read, maps):
        given = [mesh], *([each] for each in own), uv_map
        drawn = [material.name_full for job in _jobs(*given)[0] for material, _ in job.nodes]
        for name in (*drawn, *(each.material for each in to_bake(*given)[0])):
            readers.setdefault(name, set()).add(mesh)
    for material in [each for each in bpy.data.materials if each.name_full in readers and each.library is None]:
        users = [item for item in bpy.data.objects if _shows(item, material)]
        changed = [item for item in users if item.data in readers[material.name_full]]
        if len(changed) < len(users):
            copy = material.copy()
            for slot in (slot for item in changed for slot in item.material_slots if slot.material == material):
                slot.material = copy


def _shows(item: bpy.types.Object, material: bpy.types.Material) -> bool:
    """Return whether any face of an object, or anything of another kind of object, has a material."""
    slots = [number for number, slot in enumerate(item.material_slots) if slot.material == material]
    if not slots or item.type != "MESH":
        return bool(slots)
    of_faces = np.empty(len(item.data.polygons), np.int32)
    item.data.polygons.foreach_get("material_index", of_faces)
    return bool(np.isin(np.minimum(of_faces, len(item.material_slots) - 1), slots).any())


def _materials(meshes: Sequence[bpy.types.Mesh]) -> list[list[list[bpy.types.Material]]]:
    """Return the materials of each slot of each mesh: an object may have another one than its mesh."""
    slots: dict[str, list[list[bpy.types.Material | None]]] = {mesh.name_full: [] for mesh in meshes}
    for item in bpy.data.objects:
        if item.type == "MESH" and item.data.name_full in slots:
            slots[item.data.name_full].append([slot.material for slot in item.material_slots])
    of_meshes = (zip(*slots[mesh.name_full]) for mesh in meshes)
    return [[list(dict.fromkeys(filter(None, slot))) for slot in of_slots] for of_slots in of_meshes]


def _on_linked(job: Job) -> list[str]:
    """Warn of materials that cannot be changed."""
    linked = {material.name: None for material, _ in job.nodes if material.library}
    return [f"The texture {job.image.name} stays in the material {name}, which is linked." for name in linked]


def _shareable(job: Job) -> np.ndarray | None:
    """Return the pixels of a texture as other formats have them; None if it needs an image of its own."""
    if not job.reading.role:
        return None
    pixels = job.pixels()
    if job.image.alpha_mode == "NONE" or (pixels[:, :, 3] == np.iinfo(pixels.dtype).max).all():
        return pixels[:, :, :3]
    return pixels if job.image.alpha_mode == "STRAIGHT" else None


def _stored(pixels: np.ndarray) -> Callable[[], np.ndarray]:
    """Keep pixels in a temporary file, since those of all assets may need too much memory; return what reads them."""
    with tempfile.TemporaryFile() as file:
        file.write(np.ascontiguousarray(pixels))
        file.flush()
        mapped = np.memmap(file, pixels.dtype, "r", shape=pixels.shape)
    return lambda: mapped


def _image_of(drawn: SharedTexture, job: Job) -> bpy.types.Image:
    """Return the image of a file that assets share, added if missing."""
    image = bpy.data.images.load(str(drawn.path.resolve()), check_existing=True)
    if bpy.data.filepath:
        image.filepath = bpy.path.relpath(image.filepath)
    image.colorspace_settings.name = job.image.colorspace_settings.name
    return image


def unlink_full_opacity() -> None:
    """Leave out links of the opacity of images that are opaque, as importers of FBX make them.

    Written, they would be textures of transparency, for which Blender then reads the image as data, also as color.
    """
    for material in bpy.data.materials:
        tree = None if material.library else material.node_tree
        for shader in [node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"] if tree else ():
            for link in shader.inputs["Alpha"].links:
                if link.from_node.type == "TEX_IMAGE" and link.from_node.image and _is_opaque(link.from_node.image):
                    tree.links.remove(link)


def _is_opaque(image: bpy.types.Image) -> bool:
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return bool((values[3::4] == 1.0).all()) and image.channels == 4


@dataclass
class _ColorJob:
    nodes: list[tuple[bpy.types.NodeTree, bpy.types.Node]] = field(default_factory=list)
    colors: VertexColors = field(default_factory=lambda: VertexColors("color"))
    layer: str = ""


def draw_colors(
    meshes: Sequence[bpy.types.Mesh],
    read: Sequence[AssetMesh],
    maps: Sequence[UvMap],
    uv_map: str,
    size: TextureSize,
    as_base: bool = False,
) -> list[DrawnTexture]:
    """Draw each color attribute that materials read to an image, which they read instead; the attributes stay.

    The arguments are those of `redraw`; the meshes may have no map yet. With `as_base`, materials whose base color
    reads nothing read the rendered attribute, as in formats without nodes; a mesh without materials gets one.
    """
    if as_base:
        for mesh in meshes:
            _show_colors(mesh)
    jobs: dict[str, _ColorJob] = {}
    for mesh, arrays, new, materials in zip(meshes, read, maps, _materials(meshes)):
        slots = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get("material_index", slots)
        layer = uv_map or (mesh.uv_layers.active.name if mesh.uv_layers.active else "")
        for slot, material in ((slot, each) for slot, several in enumerate(materials) for each in several):
            chosen = (np.minimum(slots, len(materials) - 1) == slot) & new.mapped
            if material.node_tree is None or material.library or not chosen.any():
                continue
            polygons = arrays.vertices, arrays.face_offsets, arrays.corner_vertices
            corners, _ = face_triangles(*polygons, selected_faces=chosen)
            names = dict.fromkeys(name for name, _ in _color_nodes(material.node_tree, mesh))
            for name in names:
                job = jobs.setdefault(name, _ColorJob(layer=layer))
                job.colors.add(_colors_of_corners(mesh, name), new.uv, corners)
                of_material = [node for own, node in _color_nodes(material.node_tree, mesh) if own == name]
                job.nodes += [pair for node in of_material if (pair := (material.node_tree, node)) not in job.nodes]
    found = []
    for name, job in jobs.items():
        baked = job.colors.drawn(size, opacity=True)
        if baked is None:
            continue
        found.append(DrawnTexture.of(name, baked))
        height, width = baked.image.shape[:2]
        image = bpy.data.images.new(name, width, height, alpha=True)
        fill(image, baked.image)
        for tree, node in job.nodes:
            _replace(tree, node, image, job.layer)
    return found


def _color_nodes(tree: bpy.types.NodeTree, mesh: bpy.types.Mesh) -> Iterator[tuple[str, bpy.types.Node]]:
    """Yield the nodes that read a color attribute of a mesh, with its name."""
    rendered = mesh.color_attributes.render_color_index
    for node in tree.nodes:
        name = ""
        if node.type == "VERTEX_COLOR":
            is_known = 0 <= rendered < len(mesh.color_attributes)
            name = node.layer_name or (mesh.color_attributes[rendered].name if is_known else "")
        elif node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY":
            name = node.attribute_name
        if name in mesh.color_attributes and any(node.outputs[key].is_linked for key in ("Color", "Alpha")):
            yield name, node


def _show_colors(mesh: bpy.types.Mesh) -> None:
    """Let materials whose base color reads nothing read the rendered color attribute of a mesh, if it has one."""
    if not 0 <= mesh.color_attributes.render_color_index < len(mesh.color_attributes):
        return
    if not any(mesh.materials):
        material = bpy.data.materials.new(mesh.name)
        shader_nodes(material)
        mesh.materials.clear()
        mesh.materials.append(material)
    for material in filter(None, mesh.materials):
        tree = None if material.library else material.node_tree
        for shader in [node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"] if tree else ():
            if not shader.inputs["Base Color"].is_linked:
                node = tree.nodes.new("ShaderNodeVertexColor")
                tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])


def _colors_of_corners(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Return a color attribute, (C, 4), linear."""
    attribute = mesh.color_attributes[name]
    values = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color", values)
    values = values.reshape(-1, 4)
    if attribute.domain == "CORNER":
        return values
    vertices = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    return values[vertices]


def _replace(tree: bpy.types.NodeTree, node: bpy.types.Node, image: bpy.types.Image, layer: str) -> None:
    """Let what a node feeds read an image instead."""
    new = tree.nodes.new("ShaderNodeTexImage")
    new.image = image
    new.location = node.location
    if layer:
        read_from(tree, new, layer)
    for key in ("Color", "Alpha"):
        for link in list(node.outputs[key].links):
            tree.links.new(new.outputs[key], link.to_socket)
