# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested seams in meshes in edit mode: read, mark the cuts, and unwrap."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import bmesh
import bpy
import numpy as np

from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.seams.suggestion import Suggestion, Wishes
from ..core.solve.options import Settings
from ..edit_mesh import edge_marks, seam_hints
from ..edit_mesh.read import EditMesh, read_with_same_choice
from . import steps
from .steps import Solved


@dataclass(frozen=True)
class Target:
    """The meshes to cut and unwrap.

    Attributes:
        edit_meshes: the meshes, never subdivided, because seams belong to their own edges.
        settings: of the unwrap afterward.
        beside: as `steps.read_beside` returns.
    """

    edit_meshes: Sequence[EditMesh]
    settings: Settings
    beside: Sequence[PolygonMesh]

    @property
    def polygons(self) -> list[PolygonMesh]:
        """The meshes as arrays."""
        return [edit_mesh.polygons for edit_mesh in self.edit_meshes]

    @property
    def names(self) -> list[str]:
        """The names of the objects."""
        return [edit_mesh.edit_object.name for edit_mesh in self.edit_meshes]


def read(context: bpy.types.Context, settings: Settings) -> Target | None:
    """Read the meshes in edit mode; None if they have no visible faces."""
    for all_visible in (False, True):
        edit_meshes = steps.read(context, replace(settings, use_subsurf=False), all_visible)
        if edit_meshes:
            return Target(edit_meshes, settings, steps.read_beside(context, settings, edit_meshes))
    return None


def read_wishes(target: Target, group: str, preferred: bool) -> list[Wishes]:
    """Return per mesh where seams are wanted: by hints, by a modeler's marks, and by the weights of a vertex group.

    Unless they are `preferred`, high weights keep seams away; meshes without the group have no preference.
    """
    wishes = []
    for edit_mesh in target.edit_meshes:
        edges, hints = seam_hints.of_edges(edit_mesh.mesh)
        hinted = (edges[hints == hint] for hint in (seam_hints.CUT, seam_hints.NEVER))
        preference = _preference(edit_mesh, group, 1.0 if preferred else -1.0)
        wishes.append(Wishes(preference, *hinted, *edge_marks.of_edges(edit_mesh.mesh)))
    return wishes


def _preference(edit_mesh: EditMesh, group: str, sign: float) -> np.ndarray | None:
    found = edit_mesh.edit_object.vertex_groups.get(group)
    bm = bmesh.from_edit_mesh(edit_mesh.mesh)
    layer = bm.verts.layers.deform.active
    if found is None or layer is None:
        return None
    weights = [vertex[layer].get(found.index, 0.0) for vertex in bm.verts]
    return sign * np.clip(np.array(weights, dtype=np.float64), 0.0, 1.0)


def read_cut_open(target: Target, cuts: Suggestion) -> list[EditMesh]:
    """Read the meshes as they would be with the cuts; nothing changes."""
    found = []
    for index, edit_mesh in enumerate(target.edit_meshes):
        with _seams(edit_mesh.mesh, cuts.edges(index)):
            reading = replace(edit_mesh.reading, use_subsurf=target.settings.use_subsurf)
            found.append(read_with_same_choice(replace(edit_mesh, reading=reading)))
    return found


def mark(target: Target, cuts: Suggestion, seam: bool = True) -> None:
    """Mark the edges of the cuts as seams, or clear them."""
    for index, edit_mesh in enumerate(target.edit_meshes):
        _set_seams(edit_mesh.mesh, cuts.edges(index), seam)
        bmesh.update_edit_mesh(edit_mesh.mesh, loop_triangles=False, destructive=False)


def write(target: Target, cuts: Suggestion, cut_open: Sequence[EditMesh], solved: Solved) -> None:
    """Mark the cuts, and write the solved charts of the meshes that `read_cut_open` returned."""
    mark(target, cuts)
    try:
        steps.write(cut_open, solved)
    except BaseException:
        # Also where a script is interrupted from the keyboard.
        mark(target, cuts, seam=False)
        raise


def _set_seams(mesh: bpy.types.Mesh, pairs: np.ndarray, seam: bool) -> None:
    """Mark or clear the edges between pairs of vertices, (n, 2), of an edit mesh as seams, without an update."""
    bm = bmesh.from_edit_mesh(mesh)
    bm.verts.ensure_lookup_table()
    for i, j in pairs.tolist():
        bm.edges.get((bm.verts[i], bm.verts[j])).seam = seam


@contextmanager
def _seams(mesh: bpy.types.Mesh, pairs: np.ndarray) -> Iterator[None]:
    """Mark these edges as seams within the context, without an update, so that nothing is redrawn."""
    _set_seams(mesh, pairs, seam=True)
    try:
        yield
    finally:
        _set_seams(mesh, pairs, seam=False)
