# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection of the meshes in edit mode."""

from collections.abc import Mapping

import bmesh
import bpy
import numpy as np

from . import compatibility


def select_only(context: bpy.types.Context, faces: Mapping[bpy.types.Mesh, np.ndarray]) -> None:
    """Make these faces, one (F,) bool per mesh, the whole selection of all meshes in edit mode, and of their UVs.

    Switches to face selection: neighbours on two sides of a seam share vertices and edges.
    """
    context.tool_settings.mesh_select_mode = (False, False, True)
    for edit_object in context.objects_in_mode_unique_data:
        mesh = edit_object.data
        bm = bmesh.from_edit_mesh(mesh)
        flags = faces[mesh].tolist() if mesh in faces else [False] * len(bm.faces)
        for face in bm.faces:
            face.select_set(False)
        for face, flag in zip(bm.faces, flags):
            if flag:
                face.select_set(True)
        bm.select_history.clear()
        layer = bm.loops.layers.uv.active
        if layer is not None and not context.scene.tool_settings.use_uv_select_sync:
            compatibility.select_uv_of_faces(bm, layer, flags)
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
