# SPDX-License-Identifier: GPL-3.0-or-later
"""Subdivide a mesh as an object's Subdivision Surface modifier does."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from bmesh.types import BMesh

from .. import names

_COPIED_SETTINGS = ("subdivision_type", "levels", "quality", "boundary_smooth", "use_creases", "use_limit_surface")


def leading_modifier(edit_object: bpy.types.Object) -> bpy.types.SubsurfModifier | None:
    """Return the Subdivision Surface modifier that Blender's own Unwrap uses: it is the first and has levels."""
    modifier = next(iter(edit_object.modifiers), None)
    return modifier if modifier is not None and modifier.type == "SUBSURF" and modifier.levels > 0 else None


@contextmanager
def subdivided(bm: BMesh, modifier: bpy.types.SubsurfModifier) -> Iterator[tuple[bpy.types.Mesh, np.ndarray]]:
    """Yield `bm` subdivided by `modifier`, and the face of `bm` for each of its faces; within the context only.

    The vertices of `bm` come first in the subdivided mesh.
    """
    # The object must be in the user's file. In a scene of its own it changes no view layer of the user's, and Simplify
    # does not limit the levels.
    mesh = bpy.data.meshes.new(names.TEMPORARY_MESH)
    scene = bpy.data.scenes.new(names.TEMPORARY_SCENE)
    carrier = bpy.data.objects.new(names.TEMPORARY_OBJECT, mesh)
    try:
        bm.to_mesh(mesh)
        attribute = mesh.attributes.new(names.ORIGINAL_FACE_ATTRIBUTE, "INT", "FACE")
        attribute.data.foreach_set("value", np.arange(len(mesh.polygons), dtype=np.int32))
        scene.collection.objects.link(carrier)
        copy = carrier.modifiers.new(modifier.name, modifier.type)
        for setting in _COPIED_SETTINGS:
            setattr(copy, setting, getattr(modifier, setting))
        scene.view_layers[0].update()
        evaluated = carrier.evaluated_get(scene.view_layers[0].depsgraph)
        try:
            result = evaluated.to_mesh()
            face_of_face = np.empty(len(result.polygons), dtype=np.int32)
            result.attributes[names.ORIGINAL_FACE_ATTRIBUTE].data.foreach_get("value", face_of_face)
            yield result, face_of_face
        finally:
            evaluated.to_mesh_clear()
    finally:
        bpy.data.objects.remove(carrier)
        bpy.data.scenes.remove(scene)
        # Nothing refers to it any more, so Blender need not search for references, nor redraw.
        bpy.data.meshes.remove(mesh, do_unlink=False, do_ui_user=False)
