"""The islands of Blender's Smart UV Project."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy

from ..._layout import map_seams
from ...assets.unwrapping import CutMesh
from ...assets.welding import Integers
from . import meshes

# The space between its islands does not matter, because they are unwrapped again.
_OPTIONS = {"island_margin": 0.0}


def seams(cut_meshes: Sequence[CutMesh]) -> list[Integers]:
    """Return the island borders of each welded mesh as edges, (n, 2). Blender is empty before and after."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    polygons = [replace(each.mesh, corner_vertices=each.polygons[2], corner_uv=None) for each in cut_meshes]
    objects = meshes.link(polygons, bpy.context.scene)
    for item in objects:
        item.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(**_OPTIONS)
    bpy.ops.object.mode_set(mode="OBJECT")
    found = [
        map_seams(mesh.face_offsets, mesh.corner_vertices, meshes.uv_of(item.data))
        for mesh, item in zip(polygons, objects)
    ]
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return found
