"""Image textures of a .blend or .fbx file, drawn anew for a new UV map."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from ..._blender_textures import Reason, TexturedMesh, find, read_plainly
from ..._texture_size import DrawnTexture, TextureSize, said_of_loss
from ...assets import AssetMesh, UvMap

_WORDS: dict[Reason, str] = {
    "tiles": "it is a sequence, a movie or has tiles",
    "missing": "its image is missing",
    "projection": "it is not projected by a UV map alone",
    "procedural": "what moves it is procedural",
    "group": "it is in a group of nodes",
}


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
    textured, new = [], []
    for mesh, arrays, uv in zip(meshes, read, maps):
        layer = mesh.uv_layers.get(uv_map) if uv_map else mesh.uv_layers.active
        if layer is None or arrays.corner_uv is None:
            continue
        own = [[None if each is None or each.library else each] for each in mesh.materials]
        polygons = arrays.vertices, arrays.face_offsets, arrays.corner_vertices
        textured.append(TexturedMesh.of(mesh, layer.name, polygons, arrays.corner_uv, own))
        new.append(uv)
    jobs, kept = find(textured)
    warnings = [f"The texture {name} was not drawn anew: {_WORDS[reason]}." for name, reason in kept]
    found = []
    for job in jobs:
        changes = job.changes(textured, [each.uv for each in new], [each.mapped for each in new])
        baked, loss = job.draw(job.pixels(), changes, size)
        if baked is None:
            continue
        warnings += filter(None, [said_of_loss(job.image.name, loss)])
        found.append(DrawnTexture.of(job.image.name, baked))
        image = job.new_image(bpy.data.images, baked.image)
        for material, node in job.nodes:
            node.image = image
            read_plainly(material.node_tree, node, job.reading.place.layer)
    return found, warnings
