# SPDX-License-Identifier: GPL-3.0-or-later
"""Write UVs to edit-mode meshes."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import compress

import bmesh
import bpy
import numpy as np
from bmesh.types import BMLayerItem, BMLoop

from .. import names
from ..session.edit_meshes import keep
from .read import EditMesh, active_uv_layer


def ensure_uv_map(mesh: bpy.types.Mesh) -> bool:
    """Give a mesh in edit mode a UV map if it has none; return whether it was added."""
    if mesh.uv_layers:
        return False
    mesh.uv_layers.new(name=names.DEFAULT_UV_MAP)
    return True


def write_loops(layer: BMLayerItem, loops: Iterable[BMLoop], uv: np.ndarray) -> None:
    """Write one UV, a row of `uv` (N, 2), to each of the N `loops`; the caller calls `bmesh.update_edit_mesh`."""
    for loop, point in zip(loops, _points(uv)):
        loop[layer].uv = point


def write_uv(edit_mesh: EditMesh, uv: np.ndarray, corners: np.ndarray) -> None:
    """Write `uv` (C, 2) at the `corners` of whole faces, (C,) bool, to the active UV map."""
    bm, layer = active_uv_layer(edit_mesh.mesh)
    affected = corners[edit_mesh.polygons.face_offsets[:-1]]
    is_whole = bool(affected.all())
    points = _points(uv if is_whole else uv[corners])
    for face in bm.faces if is_whole else compress(bm.faces, affected.tolist()):
        for loop in face.loops:
            loop[layer].uv = next(points)
    bmesh.update_edit_mesh(edit_mesh.mesh, loop_triangles=False, destructive=False)


def is_written(edit_mesh: EditMesh, uv: np.ndarray, corners: np.ndarray) -> bool:
    """Return whether the active UV map has what `write_uv` with these arguments has written, a NaN as well."""
    bm, layer = active_uv_layer(edit_mesh.mesh)
    affected = corners[edit_mesh.polygons.face_offsets[:-1]]
    faces = compress(bm.faces, affected.tolist())
    now = np.array([tuple(loop[layer].uv) for face in faces for loop in face.loops], dtype=np.float32)
    return np.array_equal(now.reshape(-1, 2), uv[corners].astype(np.float32), equal_nan=True)


def write_all(edit_meshes: Sequence[EditMesh], maps: Sequence[np.ndarray], corners: Sequence[np.ndarray]) -> None:
    """Write the map of every mesh as `write_uv` does, to a new UV map if it has none.

    If it is interrupted, even from the keyboard, everything is restored.
    """
    added = [ensure_uv_map(edit_mesh.mesh) for edit_mesh in edit_meshes]
    try:
        for edit_mesh, uv, of_mesh in zip(edit_meshes, maps, corners):
            write_uv(edit_mesh, uv, of_mesh)
    except BaseException:
        for edit_mesh, of_mesh, is_new in zip(edit_meshes, corners, added):
            if is_new:
                edit_mesh.mesh.uv_layers.remove(edit_mesh.mesh.uv_layers.active)
            else:
                write_uv(edit_mesh, edit_mesh.polygons.uv, of_mesh)
        raise


def has_same_map(edit_mesh: EditMesh) -> bool:
    """Return whether a mesh, in any mode, still has the active UV map and the number of corners that were read."""
    mesh, offsets = edit_mesh.mesh, edit_mesh.polygons.face_offsets
    try:
        if mesh.uv_layers.active is None or mesh.uv_layers.active.name != edit_mesh.layer:
            return False
        counts = len(mesh.polygons), len(mesh.loops)
        if mesh.is_editmode:
            faces = keep(mesh).bm.faces
            counts = len(faces), sum(len(face.verts) for face in faces)
    except ReferenceError:
        # The mesh is gone.
        return False
    return counts == (len(offsets) - 1, offsets[-1])


def restore(edit_mesh: EditMesh, corners: np.ndarray) -> None:
    """Write the UVs that were read back at the `corners` of whole faces, (C,) bool, if the mesh `has_same_map`."""
    if not has_same_map(edit_mesh):
        return
    mesh, former = edit_mesh.mesh, edit_mesh.polygons.uv
    if mesh.is_editmode:
        write_uv(edit_mesh, former, corners)
        return
    data, uv = mesh.uv_layers.active.data, np.empty((len(corners), 2), dtype=np.float32)
    data.foreach_get("uv", uv.ravel())
    data.foreach_set("uv", np.where(corners[:, None], former, uv).astype(np.float32).ravel())
    mesh.update()


def _points(uv: np.ndarray) -> Iterator[tuple[float, float]]:
    """Yield the rows of `uv` (N, 2). Lists would take eight times the memory."""
    u, v = np.ascontiguousarray(uv.T)
    return zip(memoryview(u), memoryview(v))
