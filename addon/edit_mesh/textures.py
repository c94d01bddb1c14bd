# SPDX-License-Identifier: GPL-3.0-or-later
"""The image textures of meshes whose map is replaced: read, and put in place of the old ones."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import bpy
import numpy as np

from .. import compatibility
from ..core import native
from ..core.errors import ReadableError
from ..core.words import texts
from ..core.words.translation import translate
from .read import EditMesh, out_of_edit_mode


class Found(NamedTuple):
    """What reads the old maps.

    Attributes:
        meshes: as `_blender_textures.TexturedMesh`, one for each that was read.
        jobs: the textures to draw, as `_blender_textures.Job`.
        kept: (name of an image, reason) of those that cannot be drawn anew.
    """

    meshes: list[Any]
    jobs: list[Any]
    kept: list[tuple[str, str]]

    @property
    def readings(self) -> list[tuple]:
        """What must not change until the new textures are written."""
        nodes = [[(material.name_full, node.name) for material, node in job.nodes] for job in self.jobs]
        return [(job.reading, of_job) for job, of_job in zip(self.jobs, nodes)]


class Drawn(NamedTuple):
    """A texture to write: its job, and its pixels, (height, width, 4)."""

    job: Any
    pixels: np.ndarray


def find(edit_meshes: Sequence[EditMesh]) -> Found:
    """Find the textures of meshes, all with a UV map.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    module = native.textures()
    meshes = []
    for each in edit_meshes:
        arrays = each.as_it_is
        polygons = arrays.vertices, arrays.face_offsets, arrays.corner_vertices
        with out_of_edit_mode(each.mesh) as copy:
            layer = each.uv_map.of(copy).name
            meshes.append(module.TexturedMesh.of(copy, layer, polygons, arrays.uv, _materials(each.mesh)))
    jobs, kept = module.find(meshes)
    return Found(meshes, jobs, list(kept))


def _users(mesh: bpy.types.Mesh) -> list[bpy.types.Object]:
    return [each for each in bpy.data.objects if each.data == mesh]


def _materials(mesh: bpy.types.Mesh) -> list[list[bpy.types.Material]]:
    """Return the materials of every slot: an object may have another than its mesh."""
    slots = [[slot.material for slot in each.material_slots] for each in _users(mesh)]
    of_slots = zip(*slots)
    return [list(dict.fromkeys(each for each in materials if each is not None)) for materials in of_slots]


def write(edit_meshes: Sequence[EditMesh], maps: Sequence[np.ndarray], drawn: Sequence[Drawn]) -> tuple[str, list[str]]:
    """Add the maps (C, 2), active, and the textures, which read them; old ones stay, and so do all other nodes.

    Edit mode is left meanwhile, because its undo knows of no images and materials.

    Returns:
        The name of the new maps, and those of the materials that were copied for the meshes.

    Raises:
        ReadableError: a mesh has as many maps as Blender allows; nothing was changed.
    """
    meshes, images = [each.mesh for each in edit_meshes], []
    if any(len(mesh.uv_layers) >= compatibility.MAX_UV_MAPS for mesh in meshes):
        raise ReadableError(translate("There is no room for a new UV map: remove one of the eight first"))
    taken = {layer.name for mesh in meshes for layer in mesh.uv_layers}
    old = edit_meshes[0].uv_map.of(meshes[0]).name
    name = next(found for number in range(1, len(taken) + 2) if (found := f"{old}.{number:03}") not in taken)
    try:
        for each in drawn:
            images.append(each.job.new_image(bpy.data.images, each.pixels))
    except BaseException:
        for image in images:
            bpy.data.images.remove(image)
        raise
    with _object_mode():
        for mesh, uv in zip(meshes, maps):
            layer = mesh.uv_layers.new(name=name, do_init=False)
            layer.data.foreach_set("uv", np.ascontiguousarray(uv, np.float32).ravel())
            mesh.uv_layers.active = layer
        own = _own_materials(meshes, drawn)
        for each, image in zip(drawn, images):
            for material, node in each.job.nodes:
                tree = own[material].node_tree
                tree.nodes[node.name].image = image
                native.textures().read_from(tree, tree.nodes[node.name], name)
        for mesh in meshes:
            mesh.update()
        if bpy.ops.ed.undo_push.poll():
            bpy.ops.ed.undo_push(message=texts.NEW_TEXTURES_LABEL)
    return name, [material.name for material, copy in own.items() if copy != material]


def _own_materials(
    meshes: Sequence[bpy.types.Mesh], drawn: Sequence[Drawn]
) -> dict[bpy.types.Material, bpy.types.Material]:
    """Return the materials to change: themselves, or copies in the slots of the meshes that read their old maps.

    These are copies if other objects have them, too.
    """
    readers: dict[bpy.types.Material, set[int]] = {}
    for each in drawn:
        for material, _ in each.job.nodes:
            readers.setdefault(material, set()).update(each.job.faces)
    result = {}
    for material in sorted(readers, key=lambda each: each.name_full):
        users = [each for number in readers[material] for each in _users(meshes[number])]
        others = [each for each in bpy.data.objects if each not in users]
        result[material] = material
        if material.library is not None or any(
            slot.material == material for each in others for slot in each.material_slots
        ):
            result[material] = material.copy()
            for slot in (slot for each in users for slot in each.material_slots if slot.material == material):
                slot.material = result[material]
    return result


@contextmanager
def _object_mode() -> Iterator[None]:
    """Leave edit mode until the context ends."""
    edited = [each for each in bpy.context.view_layer.objects if each.mode == "EDIT"]
    if not edited:
        yield
        return
    selected = list(bpy.context.selected_objects)
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        # All selected objects enter.
        _select(edited)
        bpy.ops.object.mode_set(mode="EDIT")
        _select(selected)


def _select(objects: Sequence[bpy.types.Object]) -> None:
    for each in bpy.context.view_layer.objects:
        each.select_set(each in objects)
