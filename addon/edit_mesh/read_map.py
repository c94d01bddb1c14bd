# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and their active UV maps to arrays, as often as they are drawn."""

from dataclasses import replace

import bmesh
import bpy
import numpy as np

from .. import compatibility
from ..core.measure.map_view import MapArrays
from . import image_aspect
from .read import temporary_mesh


def read_map(
    context: bpy.types.Context,
    shown: bpy.types.Object,
    other_uv: np.ndarray | None = None,
    before: MapArrays | None = None,
) -> MapArrays | None:
    """Read the mesh of an object: in edit mode what is edited, else as the modifiers leave it.

    In edit mode `other_uv`, (C, 2), takes the place of the active UV map. None without faces or without a UV map.

    Given what was read `before`, its face offsets, the very array, are taken for those of now where there are as many
    faces on the same corners in the same order: that other faces have the same is next to impossible, but can be.
    """
    if shown.mode != "EDIT":
        evaluated = shown.evaluated_get(context.evaluated_depsgraph_get()).data
        if not isinstance(evaluated, bpy.types.Mesh):
            return None
        return _arrays(evaluated, False, image_aspect.aspect_in_object_mode(shown), before=before)
    with temporary_mesh() as copy:
        bm = bmesh.from_edit_mesh(shown.data)
        bm.to_mesh(copy)
        only_selected = not context.scene.tool_settings.use_uv_select_sync
        return _arrays(copy, only_selected, image_aspect.aspect(shown, bm), other_uv, before)


def n_faces(context: bpy.types.Context, shown: bpy.types.Object) -> int:
    """Return how many faces `read_map` would read."""
    if shown.mode == "EDIT":
        return len(bmesh.from_edit_mesh(shown.data).faces)
    evaluated = shown.evaluated_get(context.evaluated_depsgraph_get()).data
    return len(evaluated.polygons) if isinstance(evaluated, bpy.types.Mesh) else 0


def read_own_map(context: bpy.types.Context, shown: bpy.types.Object) -> MapArrays | None:
    """Read the mesh of an object without its modifiers, all faces as visible ones; None as `read_map` has it."""
    if shown.mode == "EDIT":
        arrays = read_map(context, shown)
    else:
        arrays = _arrays(shown.data, False, image_aspect.aspect_in_object_mode(shown))
    return arrays and replace(arrays, visible_faces=np.ones_like(arrays.visible_faces))


def _arrays(
    mesh: bpy.types.Mesh,
    only_selected: bool,
    aspect: float,
    other_uv: np.ndarray | None = None,
    before: MapArrays | None = None,
) -> MapArrays | None:
    is_other = other_uv is not None and len(other_uv) == len(mesh.loops)
    if (mesh.uv_layers.active is None and not is_other) or not len(mesh.polygons):
        return None
    visible = ~compatibility.flags(mesh, "polygons", "hide")
    corner_vertices = compatibility.corner_vertices(mesh)
    # Blender has no fast way to read offsets: they take as long as all the rest.
    has_same_faces = (
        before is not None
        and len(before.visible_faces) == len(visible)
        and np.array_equal(before.corner_vertices, corner_vertices)
    )
    return MapArrays(
        positions=compatibility.positions(mesh),
        face_offsets=before.face_offsets if has_same_faces else compatibility.face_offsets(mesh),
        corner_vertices=corner_vertices,
        uv=other_uv.astype(np.float32) if is_other else compatibility.corner_uv(mesh),
        visible_faces=visible,
        uv_faces=visible & compatibility.flags(mesh, "polygons", "select") if only_selected else visible,
        aspect=aspect,
    )


def active_face(shown: bpy.types.Object) -> int:
    """Return the index of the active face of an object's mesh, -1 for none."""
    if shown.mode != "EDIT":
        return shown.data.polygons.active if shown.data.polygons else -1
    face = bmesh.from_edit_mesh(shown.data).faces.active
    return -1 if face is None else face.index
