# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection of the meshes in edit mode."""

from collections.abc import Collection, Hashable, Mapping, Sequence
from typing import NamedTuple

import bmesh
import bpy
import numpy as np
from bmesh.types import BMesh, BMLayerItem, BMLoop, BMVert

from .. import compatibility
from ..core.constraints.marks import Edge
from .elements import edge_ends


def select_only(context: bpy.types.Context, faces: Mapping[bpy.types.Mesh, np.ndarray], extend: bool = False) -> None:
    """Make these faces, one (F,) bool per mesh, the whole selection of all meshes in edit mode, and of their UVs.

    With `extend` they are added to the selection. Switches to face selection, because neighbors on two sides of a seam
    share vertices and edges.
    """
    context.tool_settings.mesh_select_mode = (False, False, True)
    for edit_object in context.objects_in_mode_unique_data:
        mesh = edit_object.data
        bm = bmesh.from_edit_mesh(mesh)
        flags = faces[mesh].tolist() if mesh in faces else [False] * len(bm.faces)
        if not extend:
            for face in bm.faces:
                face.select_set(False)
        for face, flag in zip(bm.faces, flags):
            if flag:
                face.select_set(True)
        bm.select_history.clear()
        layer = bm.loops.layers.uv.active
        if context.scene.tool_settings.use_uv_select_sync:
            compatibility.derive_uv_selection(bm)
        elif layer is not None:
            corners = [flag for face, flag in zip(bm.faces, flags) for _ in face.loops]
            among = [not face.hide and (flag or not extend) for face, flag in zip(bm.faces, flags)]
            compatibility.select_uv_corners(bm, layer, corners, among)
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def select_island(context: bpy.types.Context, mesh: bpy.types.Mesh, faces: np.ndarray, extend: bool = False) -> None:
    """Select the `faces` (F,) bool of an island as `select_only` does, as a step that can be undone."""
    select_only(context, {mesh: faces}, extend)
    if bpy.ops.ed.undo_push.poll():
        bpy.ops.ed.undo_push(message="Select Island")


def select_only_edges(context: bpy.types.Context, edges: Mapping[bpy.types.Mesh, Collection[tuple[int, int]]]) -> None:
    """Select exactly these edges, by their vertices, of the meshes in edit mode, in edge selection mode."""
    context.tool_settings.mesh_select_mode = (False, True, False)
    for edit_object in context.objects_in_mode_unique_data:
        bm = bmesh.from_edit_mesh(edit_object.data)
        for face in bm.faces:
            face.select_set(False)
        for edge in bm.edges:
            edge.select_set(False)
        bm.verts.ensure_lookup_table()
        for ends in edges.get(edit_object.data, ()):
            edge = bm.edges.get([bm.verts[vertex] for vertex in ends])
            # The diagonal of a quad is not an edge.
            if edge is not None:
                edge.select_set(True)
        bm.select_history.clear()
        compatibility.derive_uv_selection(bm)
        bmesh.update_edit_mesh(edit_object.data, loop_triangles=False, destructive=False)


def select_shown(context: bpy.types.Context, faces: Mapping[bpy.types.Mesh, np.ndarray], extend: bool = False) -> None:
    """Select these faces as `select_only` does, but in the UV editor without sync selection only their UVs.

    There the selected faces of the mesh are those that the editor shows; they stay selected. With sticky selection, UVs
    of neighbors at the same position are selected, too, so that moving them tears nothing.
    """
    if not selects_uvs(context):
        select_only(context, faces, extend)
        return
    context.scene.tool_settings.uv_select_mode = "FACE"
    sticky = compatibility.sticky_selection(context)
    for edit_object in context.objects_in_mode_unique_data:
        bm = bmesh.from_edit_mesh(edit_object.data)
        layer = bm.loops.layers.uv.active
        if layer is None:
            continue
        flags = faces[edit_object.data].tolist() if edit_object.data in faces else [False] * len(bm.faces)
        corners = _stuck_corners(bm, layer, flags, sticky)
        if extend:
            corners = (np.array(corners) | compatibility.selected_uv_corners(bm, layer)).tolist()
        # The UV editor shows no others.
        among = [face.select and not face.hide for face in bm.faces]
        compatibility.select_uv_corners(bm, layer, corners, among)
        bmesh.update_edit_mesh(edit_object.data, loop_triangles=False, destructive=False)


def _stuck_corners(bm: BMesh, layer: BMLayerItem, faces: Sequence[bool], sticky: str) -> list[bool]:
    """Return a flag per corner: whether it belongs to one of the `faces`, or sticks to such a corner."""

    def key(loop: BMLoop) -> Hashable:
        return (loop.vert, *loop[layer].uv) if sticky == "SHARED_LOCATION" else loop.vert

    keys = set()
    if sticky != "DISABLED":
        keys.update(key(loop) for face, flag in zip(bm.faces, faces) if flag for loop in face.loops)
    return [flag or key(loop) in keys for face, flag in zip(bm.faces, faces) for loop in face.loops]


class Selected(NamedTuple):
    """What is selected in a mesh: edges, faces (F,) bool, vertices, and the active one of these."""

    edges: list[Edge]
    faces: np.ndarray
    vertices: list[int]
    active: int | None


def selected(context: bpy.types.Context, mesh: bpy.types.Mesh) -> Selected:
    """Return what is selected in a mesh in edit mode; in the UV editor without sync selection what its UVs select."""
    bm = bmesh.from_edit_mesh(mesh)
    bm.verts.index_update()
    layer = bm.loops.layers.uv.active
    faces = np.array([face.select and not face.hide for face in bm.faces], dtype=bool)
    if not selects_uvs(context) or layer is None:
        edges = [edge_ends(edge) for edge in bm.edges if edge.select and not edge.hide]
        vertices, active = [vertex.index for vertex in bm.verts if vertex.select], bm.select_history.active
        return Selected(edges, faces, vertices, active.index if isinstance(active, BMVert) else None)
    flags = iter(compatibility.selected_uv_corners(bm, layer).tolist())
    marked: dict[Edge, None] = {}
    vertices = set()
    for index, face in enumerate(bm.faces):
        corners = [next(flags) for _ in face.loops]
        for k, loop in enumerate(face.loops if faces[index] else ()):
            if corners[k]:
                vertices.add(loop.vert.index)
                if corners[(k + 1) % len(corners)]:
                    marked[edge_ends(loop.edge)] = None
        faces[index] &= all(corners)
    return Selected(list(marked), faces, sorted(vertices), None)


def selects_uvs(context: bpy.types.Context) -> bool:
    """Return whether the UV editor is the context and has a selection of its own."""
    return (
        context.area is not None
        and context.area.type == "IMAGE_EDITOR"
        and not context.scene.tool_settings.use_uv_select_sync
    )
