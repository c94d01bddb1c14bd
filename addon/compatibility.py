# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that differs between the Blender versions that this add-on runs in (3.4 and later)."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
from bmesh.types import BMesh, BMFace, BMLayerItem, BMLoop

# From 5.0 the UV selection belongs to the mesh; before, to each UV map.
_UV_SELECTION_ON_MESH = hasattr(BMLoop, "uv_select_vert")


@dataclass(frozen=True)
class UVSelection:
    """The UV selection of a mesh: flags per corner, in the order of faces and their corners, and per face."""

    vertices: list[bool]
    edges: list[bool]
    faces: list[bool] | None
    matches_mesh: bool | None


def read_uv_selection(bm: BMesh, layer: BMLayerItem) -> UVSelection:
    """Return the UV selection of all faces of `bm`, hidden and unselected ones too."""
    if _UV_SELECTION_ON_MESH:
        return UVSelection(
            [loop.uv_select_vert for face in bm.faces for loop in face.loops],
            [loop.uv_select_edge for face in bm.faces for loop in face.loops],
            [face.uv_select for face in bm.faces],
            bm.uv_select_sync_valid,
        )
    return UVSelection(
        [loop[layer].select for face in bm.faces for loop in face.loops],
        [loop[layer].select_edge for face in bm.faces for loop in face.loops],
        None,
        None,
    )


def write_uv_selection(bm: BMesh, layer: BMLayerItem, selection: UVSelection) -> None:
    """Set exactly the flags that `read_uv_selection` returned."""
    loops = (loop for face in bm.faces for loop in face.loops)
    if _UV_SELECTION_ON_MESH:
        for loop, vertex, edge in zip(loops, selection.vertices, selection.edges):
            loop.uv_select_vert = vertex
            loop.uv_select_edge = edge
        for face, selected in zip(bm.faces, selection.faces):
            face.uv_select = selected
        bm.uv_select_sync_valid = selection.matches_mesh
    else:
        for loop, vertex, edge in zip(loops, selection.vertices, selection.edges):
            uv = loop[layer]
            uv.select = vertex
            uv.select_edge = edge


def select_uv_of_faces(bm: BMesh, layer: BMLayerItem, selected: list[bool]) -> None:
    """Make the UVs of the `selected` faces, one flag per face, the whole UV selection."""
    for face, flag in zip(bm.faces, selected):
        for loop in face.loops:
            if _UV_SELECTION_ON_MESH:
                loop.uv_select_vert = loop.uv_select_edge = flag
            else:
                uv = loop[layer]
                uv.select = uv.select_edge = flag
        if _UV_SELECTION_ON_MESH:
            face.uv_select = flag


def can_pack_by_mesh_selection(tool_settings: bpy.types.ToolSettings) -> bool:
    """Return whether sync selection can be on without a change of the UV selection, which turning it on is in 5.0."""
    return tool_settings.use_uv_select_sync or not _UV_SELECTION_ON_MESH


@contextmanager
def mesh_selection_only(bm: BMesh) -> Iterator[None]:
    """Within, sync selection looks at the mesh selection and not at the finer UV selection that 5.0 keeps beside it."""
    if not _UV_SELECTION_ON_MESH:
        yield
        return
    before = bm.uv_select_sync_valid
    bm.uv_select_sync_valid = False
    try:
        yield
    finally:
        bm.uv_select_sync_valid = before


def has_selected_uv(face: BMFace, layer: BMLayerItem) -> bool:
    """Return whether a corner of `face` is selected in the UV editor, sync selection being off."""
    if _UV_SELECTION_ON_MESH:
        return any(loop.uv_select_vert for loop in face.loops)
    return any(loop[layer].select for loop in face.loops)


def bounding_box_packing() -> dict[str, str]:
    """Return the arguments that make `bpy.ops.uv.pack_islands` pack bounding boxes, as Blender's own Unwrap does.

    That is all that 3.4 can do. The default from 4.0, exact shapes, takes seconds for a cube's six faces.
    """
    has_shapes = "shape_method" in bpy.ops.uv.pack_islands.get_rna_type().properties
    return {"shape_method": "AABB"} if has_shapes else {}
