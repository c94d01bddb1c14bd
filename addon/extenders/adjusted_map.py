# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV map of an edit mesh while the strength of one of its extenders changes."""

from dataclasses import replace
from itertools import chain, compress

import bmesh
import bpy
import numpy as np

from .. import names
from ..core import texts
from ..core.extender_adjustment import AdjustmentError, ExtenderAdjustment
from ..edit_mesh import subsurf
from ..edit_mesh.read import read_mesh
from ..edit_mesh.write import ensure_uv_map, write_loops
from ..unwrapping.last_settings import last_settings
from . import storage


class AdjustedMap:
    """Writes the map for a strength into the active UV map, and what was there before.

    Attributes:
        mesh: the mesh in edit mode.
        index: place of the extender in the mesh's list.
        start: the strength before.
        note: what the user should know; may be empty.
    """

    def __init__(self, context: bpy.types.Context, index: int) -> None:
        """Take an extender of the active object's mesh, and its islands as they are now.

        The islands are those of the selected faces if these have both vertices, otherwise those of all visible faces.

        Raises:
            AdjustmentError: the extender is broken, or acts on no island.
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        edit_object = context.edit_object
        self.mesh = edit_object.data
        self.index = index
        extender = storage.of(self.mesh)[index]
        # A file may have a strength that is no number, from which no drag could start.
        self.start = extender.strength if abs(extender.strength) <= names.EXTENDER_STRENGTH_LIMIT else 0.0
        self._bm = bmesh.from_edit_mesh(self.mesh)
        ends = storage.ends(self._bm, self.mesh)[index]
        if -1 in ends:
            raise AdjustmentError(
                f"{storage.label(extender)} is broken: a vertex of it is gone; remove it and add another"
            )
        self._is_map_added = ensure_uv_map(self.mesh)
        try:
            self._adjustment = self._take(edit_object, ends)
        except AdjustmentError:
            self._remove_added_map()
            raise
        chosen = np.zeros(sum(len(face.verts) for face in self._bm.faces), dtype=bool)
        chosen[self._adjustment.corners] = True
        self._loops = list(compress(chain.from_iterable(face.loops for face in self._bm.faces), chosen.tolist()))
        layer = self._bm.loops.layers.uv.active
        self._before = [tuple(loop[layer].uv) for loop in self._loops]

    def _take(self, edit_object: bpy.types.Object, ends: tuple[int, int]) -> ExtenderAdjustment:
        settings = last_settings()
        subdivided = settings.use_subsurf and subsurf.leading_modifier(edit_object) is not None
        self.note = texts.ADJUSTED_WITHOUT_SUBSURF if subdivided else ""
        for all_visible in (False, True):
            polygons = read_mesh(edit_object, False, all_visible, settings.correct_aspect).polygons
            unwrapped = polygons.corner_vertices[polygons.selected_faces[polygons.face_of_corner()]]
            if np.isin(ends, unwrapped).all():
                break
        if self._is_map_added:
            # Blender fills a new map with whole tiles, which are no place to keep.
            polygons = replace(polygons, uv=None, pinned_corners=None)
        return ExtenderAdjustment(polygons, settings.options, ends)

    def show(self, strength: float, is_final: bool = False) -> None:
        """Write the map for a strength; `is_final` asks the solver for all digits.

        Raises:
            AdjustmentError: an island could not be solved at this strength; the map stays as it is.
        """
        self._write(self._adjustment.map(strength, is_final).tolist())

    def restore(self) -> None:
        """Write exactly what was there before, also where that was no UV map."""
        self._write(self._before)
        self._remove_added_map()

    def _remove_added_map(self) -> None:
        if self._is_map_added:
            self.mesh.uv_layers.remove(self.mesh.uv_layers.active)
            self._is_map_added = False

    def keep(self, strength: float) -> None:
        """Store the strength with the extender."""
        storage.set_strength(self.mesh, self.index, strength)

    @property
    def is_valid(self) -> bool:
        """Whether the mesh is still in edit mode and what it was."""
        return self._bm.is_valid and all(loop.is_valid for loop in self._loops[:1])

    def _write(self, uv: list) -> None:
        layer = self._bm.loops.layers.uv.active
        write_loops(layer, self._loops, uv)
        bmesh.update_edit_mesh(self.mesh, loop_triangles=False, destructive=False)
