# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracks the extenders of meshes in edit mode: their vertices, for what is drawn, and their lists after undo."""

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
from bmesh.types import BMesh, BMVert

from ..session import edit_meshes
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
            len(self.bm.verts) == self.n_vertices
            and self.vertex_ids == _vertex_ids(mesh)
            and all(vertex is None or vertex.is_valid for pair in self.ends for vertex in pair)
        )


def begin() -> None:
    """Track the meshes in edit mode, each with the list that goes with it."""
    meshes = [edit_object.data for edit_object in edit_meshes.edited()]
    for mesh in meshes:
        storage.restore(mesh)
    follow(meshes)


def follow(meshes: Iterable[bpy.types.Mesh]) -> None:
    """Start to track those of the `meshes`, all in edit mode, that have extenders."""
    for mesh in meshes:
        if storage.of(mesh) and edit_meshes.kept(mesh) is None:
            edit_meshes.keep(mesh)
            storage.remember(mesh)


def track(mesh: bpy.types.Mesh) -> Track | None:
    """Return the track of a mesh, brought up to date; None while the mesh is not in edit mode or not yet kept.

    Cheap as long as neither the list nor the topology has changed.
    """
    known = edit_meshes.kept(mesh)
    if known is None:
        return None
    if known.track is None or not known.track.is_current(mesh):
        known.track = _resolved(known.bm, mesh)
    return known.track


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
