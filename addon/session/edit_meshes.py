# SPDX-License-Identifier: GPL-3.0-or-later
"""The keeper of Blender's Python wrappers of edit meshes, and of what is known of each.

Making or freeing a wrapper moves UVs in memory, to which a running transform has pointers. So wrappers are made in
handlers and timers, which run before a transform can start, never while drawing, and kept until edit mode ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bmesh
import bpy

from . import Lifetime, Remembered, of

if TYPE_CHECKING:
    from bmesh.types import BMesh, BMVert

    from ..live.snapshot import Snapshot


class KeptMesh:
    """A mesh in edit mode.

    Attributes:
        bm: its edit mesh.
        extenders: the vertices of its extenders, if known, and the numbers of vertices and extenders then.
        seen: the last snapshot of live unwrapping, if the mesh is followed.
    """

    def __init__(self, bm: BMesh) -> None:
        """Begin with the edit mesh only."""
        self.bm = bm
        self.extenders: tuple[tuple[int, int], list[tuple[BMVert | None, BMVert | None]]] | None = None
        self.seen: Snapshot | None = None


class EditMeshes(Remembered):
    """The kept meshes, by the address of the mesh."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        """Begin without meshes."""
        self.by_address: dict[int, KeptMesh] = {}


def keep(mesh: bpy.types.Mesh) -> KeptMesh:
    """Keep a mesh in edit mode; return what is known of it."""
    return kept(mesh) or of(EditMeshes).by_address.setdefault(mesh.as_pointer(), KeptMesh(bmesh.from_edit_mesh(mesh)))


def kept(mesh: bpy.types.Mesh) -> KeptMesh | None:
    """Return what is known of a mesh; None if it is not kept or has left edit mode."""
    found = of(EditMeshes).by_address.get(mesh.as_pointer())
    if found is not None and not found.bm.is_valid:
        del of(EditMeshes).by_address[mesh.as_pointer()]
        return None
    return found


def all_kept() -> list[KeptMesh]:
    """Return what is known of every mesh that is kept and still in edit mode."""
    let_go_left()
    return list(of(EditMeshes).by_address.values())


def let_go_left() -> None:
    """Drop meshes that have left edit mode."""
    meshes = of(EditMeshes).by_address
    for address in [address for address, found in meshes.items() if not found.bm.is_valid]:
        del meshes[address]


def edited() -> list[bpy.types.Object]:
    """Return one object for every mesh in edit mode."""
    if bpy.context.mode != "EDIT_MESH":
        return []
    # While a file is being opened, they are not in it yet.
    return [each for each in bpy.context.objects_in_mode_unique_data if each.data.is_editmode]
