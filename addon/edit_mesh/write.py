# SPDX-License-Identifier: GPL-3.0-or-later
"""Write UVs to edit-mode meshes."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import compress

import bmesh
import bpy
import numpy as np
from bmesh.types import BMLayerItem, BMLoop

from .. import compatibility, names
from .read import EditMesh, out_of_edit_mode


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
    """Write `uv` (C, 2) at the `corners` of whole faces, (C,) bool, to the map that was read, else the active one."""
    bm = bmesh.from_edit_mesh(edit_mesh.mesh)
    layer = bm.loops.layers.uv.active if edit_mesh.uv_map is None else edit_mesh.uv_map.layer(bm)
    affected = corners[edit_mesh.polygons.face_offsets[:-1]]
    is_whole = bool(affected.all())
    points = _points(uv if is_whole else uv[corners])
    for face in bm.faces if is_whole else compress(bm.faces, affected.tolist()):
        for loop in face.loops:
            loop[layer].uv = next(points)
    bmesh.update_edit_mesh(edit_mesh.mesh, loop_triangles=False, destructive=False)


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


class ChangingMaps:
    """Maps that are written again and again at some corners; in the end they stay or are restored."""

    def __init__(self, edit_meshes: Sequence[EditMesh], corners: Sequence[np.ndarray]) -> None:
        """Take meshes with a map, and which corners change, (C,) bool each: other UVs of their faces stay as read."""
        self._shown = [each.polygons.uv for each in edit_meshes]
        self._is_written = False
        self._changed = []
        for k, (edit_mesh, of_mesh) in enumerate(zip(edit_meshes, corners)):
            if of_mesh.any():
                polygons = edit_mesh.polygons
                self._changed.append((k, edit_mesh, polygons.faces_with(of_mesh)[polygons.face_of_corner()]))

    def write(self, maps: Sequence[np.ndarray]) -> None:
        """Write the map, (C, 2), of every mesh."""
        for k, edit_mesh, corners in self._changed:
            write_uv(edit_mesh, maps[k], corners)
        self._shown, self._is_written = maps, True

    def are_shown(self) -> bool:
        """Return whether the meshes, in any mode, have the maps that were written last, or were read."""
        return all(_has_map(edit_mesh, self._shown[k], corners) for k, edit_mesh, corners in self._changed)

    def restore(self) -> None:
        """Write the UVs that were read, in any mode, unless something else has changed the maps since."""
        if self._is_written and self.are_shown():
            for _, edit_mesh, corners in self._changed:
                _restore(edit_mesh, corners)


def _has_map(edit_mesh: EditMesh, uv: np.ndarray, corners: np.ndarray) -> bool:
    """Return whether a mesh, in any mode, has the faces and the UV map that were read, and `uv` at the `corners`.

    `uv` and `corners` are those of `write_uv`; a NaN that was written counts, too.
    """
    try:
        with out_of_edit_mode(edit_mesh.mesh) as mesh:
            uv_map = None if edit_mesh.uv_map is None else edit_mesh.uv_map.of(mesh)
            if uv_map is None or len(mesh.polygons) != len(edit_mesh.polygons.selected_faces):
                return False
            if not np.array_equal(compatibility.corner_vertices(mesh), edit_mesh.polygons.corner_vertices):
                return False
            now = compatibility.corner_uv(mesh, uv_map)[corners]
    except ReferenceError:
        # The mesh is gone.
        return False
    return np.array_equal(now, uv[corners].astype(np.float32), equal_nan=True)


def _restore(edit_mesh: EditMesh, corners: np.ndarray) -> None:
    """Write the UVs that were read back at the `corners` of whole faces, (C,) bool, of a mesh with the map read."""
    mesh, former = edit_mesh.mesh, edit_mesh.polygons.uv
    if mesh.is_editmode:
        write_uv(edit_mesh, former, corners)
        return
    data, uv = edit_mesh.uv_map.of(mesh).data, np.empty((len(corners), 2), dtype=np.float32)
    data.foreach_get("uv", uv.ravel())
    data.foreach_set("uv", np.where(corners[:, None], former, uv).astype(np.float32).ravel())
    mesh.update()


def _points(uv: np.ndarray) -> Iterator[tuple[float, float]]:
    """Yield the rows of `uv` (N, 2). Lists would take eight times the memory."""
    u, v = np.ascontiguousarray(uv.T)
    return zip(memoryview(u), memoryview(v))
