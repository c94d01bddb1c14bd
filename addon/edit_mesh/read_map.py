# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and their active UV maps to arrays, as often as they are drawn."""

import bmesh
import bpy

from .. import compatibility, names
from ..core.map_view import MapArrays


def read_map(context: bpy.types.Context, shown: bpy.types.Object) -> MapArrays | None:
    """Read the mesh of an object: in edit mode what is edited, else as the modifiers leave it.

    None without faces or without a UV map.
    """
    if shown.mode != "EDIT":
        evaluated = shown.evaluated_get(context.evaluated_depsgraph_get()).data
        return _arrays(evaluated, False) if isinstance(evaluated, bpy.types.Mesh) else None
    copy = bpy.data.meshes.new(names.TEMPORARY_MESH)
    try:
        bmesh.from_edit_mesh(shown.data).to_mesh(copy)
        return _arrays(copy, not context.scene.tool_settings.use_uv_select_sync)
    finally:
        bpy.data.meshes.remove(copy, do_unlink=False, do_ui_user=False)


def _arrays(mesh: bpy.types.Mesh, only_selected: bool) -> MapArrays | None:
    if mesh.uv_layers.active is None or not len(mesh.polygons):
        return None
    visible = ~compatibility.flags(mesh, "polygons", "hide")
    return MapArrays(
        positions=compatibility.positions(mesh),
        face_offsets=compatibility.face_offsets(mesh),
        corner_vertices=compatibility.corner_vertices(mesh),
        uv=compatibility.corner_uv(mesh),
        visible_faces=visible,
        uv_faces=visible & compatibility.flags(mesh, "polygons", "select") if only_selected else visible,
    )


def active_face(shown: bpy.types.Object) -> int:
    """Return the index of the active face of an object's mesh, -1 for none."""
    if shown.mode != "EDIT":
        return shown.data.polygons.active if shown.data.polygons else -1
    face = bmesh.from_edit_mesh(shown.data).faces.active
    return -1 if face is None else face.index
