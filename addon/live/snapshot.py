# SPDX-License-Identifier: GPL-3.0-or-later
"""A snapshot of a mesh in edit mode, for live unwrapping.

Blender only says that a mesh has changed; what has changed is the difference from its snapshot. A snapshot takes one
pass over the edges, one over the corners and a copy for the positions. All arrays of the mesh, which take several times
as long, are read only if it has pins, because the former map is unavailable after pins have moved.

Snapshots are taken in handlers and timers, never during a transform (`session.edit_meshes`).
"""

from dataclasses import dataclass

import bpy
import numpy as np
from bmesh.types import BMesh

from .. import compatibility, user_preferences
from ..core.constraints.marks import Edge
from ..edit_mesh import constraints
from ..edit_mesh import extenders as storage
from ..edit_mesh.elements import edge_ends
from ..edit_mesh.read import temporary_mesh
from ..session import edit_meshes
from ..unwrapping import parts
from . import last_operator
from .pins import PinnedMap


@dataclass
class Snapshot:
    """A mesh in edit mode that has a UV map.

    Attributes:
        edit_object: an object of the mesh.
        scene: the scene in which it is edited.
        bm: its edit mesh.
        layer: name of the active UV map.
        counts: numbers of vertices, edges and faces.
        seams: the edges that are seams, by their vertices, the lower index first.
        strengths: strength of the extenders that act, by their vertices, the lower index first.
        constraints: all that constraints in use ask of edges, by their vertices.
        positions: (V, 3) float32, of the vertices.
        operator: `last_operator.address()` at that time.
        pinned: the map, if it has pins.
    """

    edit_object: bpy.types.Object
    scene: bpy.types.Scene
    bm: BMesh
    layer: str
    counts: tuple[int, int, int]
    seams: set[Edge]
    strengths: dict[Edge, float]
    constraints: dict[Edge, tuple]
    positions: np.ndarray
    operator: int
    pinned: PinnedMap | None

    @property
    def is_current(self) -> bool:
        """Whether the mesh is still in edit mode, with the same number of elements and the same active UV map."""
        if not self.bm.is_valid or _counts(self.bm) != self.counts:
            return False
        layer = self.bm.loops.layers.uv.active
        return layer is not None and layer.name == self.layer and (self.pinned is None or self.pinned.is_valid)

    def note_operators(self) -> None:
        """Note that no operator until now has changed the mesh."""
        self.operator = last_operator.address()
        if self.pinned is not None:
            self.pinned.note_operators()

    def changed_seams(self, later: "Snapshot") -> set[Edge]:
        """Return the edges marked or cleared until a `later` snapshot; none if the faces have changed.

        Faces have changed if their number has, or if a former seam is no longer an edge.
        """
        changed = self.seams ^ later.seams
        if not changed or self.counts != later.counts:
            return set()
        later.bm.verts.ensure_lookup_table()
        vertices = later.bm.verts
        is_gone = any(later.bm.edges.get([vertices[v] for v in edge]) is None for edge in self.seams - later.seams)
        return set() if is_gone else changed

    def moved_edges(self, later: "Snapshot") -> set[Edge]:
        """Return the edges with an end that has moved until a `later` snapshot; none if the faces have changed."""
        if self.counts != later.counts or np.array_equal(self.positions, later.positions, equal_nan=True):
            return set()
        is_moved = (self.positions != later.positions).any(axis=1).tolist()
        return {pair for pair in map(edge_ends, later.bm.edges) if is_moved[pair[0]] or is_moved[pair[1]]}

    def changed_constraints(self, later: "Snapshot") -> set[Edge]:
        """Return the edges of which constraints ask something else in a `later` snapshot."""
        return self._changed(later, "constraints")

    def changed_extenders(self, later: "Snapshot") -> set[Edge]:
        """Return the vertices of the extenders that acted with another strength, or not, in a `later` snapshot."""
        return self._changed(later, "strengths")

    def _changed(self, later: "Snapshot", name: str) -> set[Edge]:
        if self.counts != later.counts:
            return set()
        return {pair for pair, _ in getattr(self, name).items() ^ getattr(later, name).items()}


def take(edit_object: bpy.types.Object, correct_aspect: bool) -> Snapshot | None:
    """Return a snapshot of an object in edit mode; None if it has no UV map, or too many faces to follow.

    With `correct_aspect`, its pinned islands follow in the aspect of the image.
    """
    mesh = edit_object.data
    bm = edit_meshes.keep(mesh).bm
    layer = bm.loops.layers.uv.active
    if layer is None or len(bm.faces) > user_preferences.read("live_max_faces", user_preferences.LIVE_MAX_FACES):
        return None
    has_pins = compatibility.has_pins(bm, layer) or parts.has_parts(mesh)
    pinned = _pinned_map(edit_object, correct_aspect) if has_pins else None
    seams = {edge_ends(edge) for edge in bm.edges if edge.seam}
    forces, _ = storage.resolve(mesh)
    strengths = {(min(pair), max(pair)): strength for *pair, strength, _ in forces}
    constrained = constraints.acting(mesh)
    scene, counts = bpy.context.scene, _counts(bm)
    return Snapshot(
        edit_object,
        scene,
        bm,
        layer.name,
        counts,
        seams,
        strengths,
        constrained,
        _positions(bm),
        last_operator.address(),
        pinned,
    )


def _pinned_map(edit_object: bpy.types.Object, correct_aspect: bool) -> PinnedMap | None:
    edit_mesh, with_parts, faces = parts.read_visible(edit_object, correct_aspect)
    if not with_parts.pinned_corners.any():
        return None
    return PinnedMap(edit_object.data, edit_mesh.polygons, with_parts, faces)


def _positions(bm: BMesh) -> np.ndarray:
    with temporary_mesh() as copy:
        bm.to_mesh(copy)
        return compatibility.positions(copy)


def _counts(bm: BMesh) -> tuple[int, int, int]:
    return len(bm.verts), len(bm.edges), len(bm.faces)
