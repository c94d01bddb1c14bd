# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps track of the extenders of meshes in edit mode: their vertices, for what is drawn, and their lists after undo.

A track keeps Blender's Python wrapper of the edit mesh alive, because making or freeing one moves the UVs in memory, to
which a running transform holds pointers. So wrappers are made in handlers (handlers.py), which run before a transform
can start, and never while drawing.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import bmesh
import bpy
from bmesh.types import BMesh, BMVert

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


def follow(meshes: Iterable[bpy.types.Mesh]) -> None:
    """Start to track those of the `meshes`, all in edit mode, that have extenders; forget those that left it."""
    forget_left()
    for mesh in meshes:
        if storage.of(mesh) and mesh.as_pointer() not in _tracks:
            storage.remember(mesh)
            _tracks[mesh.as_pointer()] = _resolved(bmesh.from_edit_mesh(mesh), mesh)


def follow_after_undo(meshes: Sequence[bpy.types.Mesh]) -> None:
    """Track the `meshes`, all in edit mode, anew after an undo or redo, with the lists that go with them."""
    forget()
    for mesh in meshes:
        storage.restore(mesh)
    follow(meshes)


def forget_left() -> None:
    """Let meshes go that have left edit mode."""
    for key in [key for key, tracked in _tracks.items() if not tracked.bm.is_valid]:
        del _tracks[key]


def forget() -> None:
    """Let all meshes go."""
    _tracks.clear()
