# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps track of the extenders of meshes in edit mode: their vertices, for what is drawn, and their lists after undo.

A track keeps Blender's Python wrapper of the edit mesh alive, because making or freeing one moves the UVs in memory, to
which a running transform holds pointers. So wrappers are made in handlers, which run before a transform can start, and
never while drawing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import bmesh
import bpy
from bmesh.types import BMesh, BMVert
from bpy.app.handlers import persistent

from . import storage


@dataclass
class Track:
    """A mesh in edit mode and both vertices of every extender in its list, None for one that is gone."""

    bm: BMesh
    vertex_ids: list[tuple[int, int]]
    n_vertices: int
    ends: list[tuple[BMVert | None, BMVert | None]]

    def is_current(self, mesh: bpy.types.Mesh) -> bool:
        """Return whether the vertices can still be used, and are those of the list."""
        return (
            self.bm.is_valid
            and len(self.bm.verts) == self.n_vertices
            and self.vertex_ids == _vertex_ids(mesh)
            and all(vertex is None or vertex.is_valid for pair in self.ends for vertex in pair)
        )


_tracks: dict[int, Track] = {}


def track(mesh: bpy.types.Mesh) -> Track | None:
    """Return the track of a mesh, brought up to date; None while the mesh is not in edit mode or not yet tracked.

    Cheap as long as neither the list nor the topology has changed.
    """
    tracked = _tracks.get(mesh.as_pointer())
    if tracked is None or not tracked.bm.is_valid:
        return None
    if not tracked.is_current(mesh):
        tracked = _tracks[mesh.as_pointer()] = _resolved(tracked.bm, mesh)
    return tracked


def broken(mesh: bpy.types.Mesh) -> list[bool]:
    """Return which extenders of a mesh in edit mode have lost a vertex, as far as is known."""
    tracked = track(mesh)
    if tracked is None:
        return [False] * len(storage.of(mesh))
    return [None in pair for pair in tracked.ends]


def _resolved(bm: BMesh, mesh: bpy.types.Mesh) -> Track:
    found = storage.ends(bm, mesh)
    bm.verts.ensure_lookup_table()
    vertices = [tuple(bm.verts[index] if index >= 0 else None for index in pair) for pair in found]
    return Track(bm, _vertex_ids(mesh), len(bm.verts), vertices)


def _vertex_ids(mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    return [(extender.first_id, extender.second_id) for extender in storage.of(mesh)]


def _follow(meshes: Sequence[bpy.types.Mesh]) -> None:
    """Start to track those of the `meshes` that are in edit mode and have extenders; forget those that left it."""
    for key in [key for key, tracked in _tracks.items() if not tracked.bm.is_valid]:
        del _tracks[key]
    for mesh in meshes:
        if mesh.is_editmode and storage.of(mesh) and mesh.as_pointer() not in _tracks:
            storage.remember(mesh)
            _tracks[mesh.as_pointer()] = _resolved(bmesh.from_edit_mesh(mesh), mesh)


@persistent
def _on_depsgraph_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    updated = [update.id.original for update in depsgraph.updates if update.is_updated_geometry]
    meshes = [block.data if isinstance(block, bpy.types.Object) else block for block in updated]
    _follow([mesh for mesh in meshes if isinstance(mesh, bpy.types.Mesh)])


@persistent
def _after_undo(*_arguments: object) -> None:
    _tracks.clear()
    for mesh in bpy.data.meshes:
        if mesh.is_editmode:
            storage.restore(mesh)
    _follow(bpy.data.meshes)


@persistent
def _before_load(*_arguments: object) -> None:
    _tracks.clear()
    storage.forget()


@persistent
def _after_load(*_arguments: object) -> None:
    _follow(bpy.data.meshes)


_HANDLERS = (
    ("depsgraph_update_post", _on_depsgraph_update),
    ("undo_post", _after_undo),
    ("redo_post", _after_undo),
    ("load_pre", _before_load),
    ("load_post", _after_load),
)


def register() -> None:
    """Add the handlers."""
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)


def unregister() -> None:
    """Remove the handlers and let the meshes go."""
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    _tracks.clear()
