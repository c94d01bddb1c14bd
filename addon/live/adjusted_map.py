# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV map of a mesh while the strength of one of its extenders changes."""

from contextlib import ExitStack
from dataclasses import replace
from itertools import chain, compress

import bmesh
import bpy
import numpy as np
from bmesh.types import BMesh, BMLoop

from .. import session
from ..core.extenders.adjustment import AdjustmentError, ExtenderAdjustment
from ..core.words import texts
from ..edit_mesh.read import read_mesh
from ..edit_mesh.write import ensure_uv_map, write_loops
from ..extenders import storage
from ..extenders.strength import STRENGTH_LIMIT
from ..session import Lifetime, Remembered, edit_meshes
from ..unwrapping import island_list
from ..unwrapping.last_settings import last_settings
from . import following
from .extenders import note_on_subsurf


class _Adjusted(Remembered):
    """The adjusted map that is shown now."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        self.shown: AdjustedMap | None = None

    def end(self) -> None:
        """Restore what was there before, where the operator that shows it cannot."""
        if self.shown is not None:
            self.shown.restore()


class AdjustedMap:
    """Shows a strength, in the list of extenders and by its map in the active UV map, until it is kept or restored.

    Live unwrapping pauses meanwhile.

    Attributes:
        mesh: the mesh, in edit mode to begin with.
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
        self._strength_before = extender.strength
        # A file may have a strength that is no number, from which no drag could start.
        self.start = extender.strength if abs(extender.strength) <= STRENGTH_LIMIT else 0.0
        self._paused = ExitStack()
        self._bm = edit_meshes.keep(self.mesh).bm
        ends = storage.ends(self._bm, self.mesh)[index]
        if -1 in ends:
            raise AdjustmentError(texts.broken_extender(storage.label(extender)))
        self._is_map_added = ensure_uv_map(self.mesh)
        self._layer = self._bm.loops.layers.uv.active.name
        try:
            self._adjustment = self._take(edit_object, ends)
            self._n_corners, self._loops = self._find_loops(self._bm)
            layer = self._bm.loops.layers.uv[self._layer]
            self._before = np.array([loop[layer].uv[:] for loop in self._loops]).reshape(-1, 2)
        except BaseException:
            self._remove_added_map()
            raise

    def _take(self, edit_object: bpy.types.Object, ends: tuple[int, int]) -> ExtenderAdjustment:
        settings = last_settings()
        self.note = note_on_subsurf(settings, edit_object)
        for all_visible in (False, True):
            self._edit_mesh = read_mesh(edit_object, False, all_visible, settings.correct_aspect)
            polygons = self._edit_mesh.polygons
            unwrapped = polygons.corner_vertices[polygons.selected_faces[polygons.face_of_corner()]]
            if np.isin(ends, unwrapped).all():
                break
        if self._is_map_added:
            # Blender fills a new map with whole tiles, which are no place to keep.
            polygons = replace(polygons, uv=None, pinned_corners=None)
        return ExtenderAdjustment(polygons, settings.options, [ends])

    def show(self, strength: float, is_final: bool = False) -> None:
        """Show a strength and its map; `is_final` asks the solver for all digits.

        Raises:
            AdjustmentError: an island could not be solved at this strength; the map stays as it is.
        """
        if not self.is_shown:
            session.drop(_Adjusted)
            self._paused.enter_context(following.not_following())
            session.of(_Adjusted).shown = self
        storage.show_strength(self.mesh, self.index, strength)
        uv = self._adjustment.map([strength], is_final)
        write_loops(self._bm.loops.layers.uv[self._layer], self._loops, uv)
        bmesh.update_edit_mesh(self.mesh, loop_triangles=False, destructive=False)

    def keep(self, strength: float) -> None:
        """Store the strength with the extender, and leave the map as it is."""
        # Before, so that the change counts as one.
        storage.show_strength(self.mesh, self.index, self._strength_before)
        storage.set_strength(self.mesh, self.index, strength)
        island_list.update(self._edit_mesh, self._adjustment.charts)
        self._end()

    def restore(self) -> None:
        """Bring back exactly what was there before, also where that was no UV map, and in whatever mode the mesh is.

        A mesh that has gone, or has other faces by now, stays as it is.
        """
        try:
            if self._exists():
                if self.index < len(storage.of(self.mesh)):
                    storage.show_strength(self.mesh, self.index, self._strength_before)
                self._write_before()
                self._remove_added_map()
        finally:
            self._end()

    @property
    def is_shown(self) -> bool:
        """Whether a strength is shown that has been neither kept nor restored."""
        return session.of(_Adjusted).shown is self

    @property
    def is_valid(self) -> bool:
        """Whether the mesh is still in edit mode and what it was."""
        return self._bm.is_valid and all(loop.is_valid for loop in self._loops[:1])

    def _end(self) -> None:
        if self.is_shown:
            session.of(_Adjusted).shown = None
        self._paused.close()

    def _exists(self) -> bool:
        try:
            return bool(self.mesh.name)
        except ReferenceError:
            return False

    def _find_loops(self, bm: BMesh) -> tuple[int, list[BMLoop]]:
        """Return the number of corners and those that the adjustment moves."""
        loops = list(chain.from_iterable(face.loops for face in bm.faces))
        chosen = np.zeros(max(len(loops), self._adjustment.corners.max() + 1), dtype=bool)
        chosen[self._adjustment.corners] = True
        return len(loops), list(compress(loops, chosen.tolist()))

    def _write_before(self) -> None:
        if not self.mesh.is_editmode:
            self._write_before_in_object_mode()
            return
        # Edit mode may have been left and entered again.
        bm = self._bm if self.is_valid else edit_meshes.keep(self.mesh).bm
        layer = bm.loops.layers.uv.get(self._layer)
        n_corners, loops = (self._n_corners, self._loops) if self.is_valid else self._find_loops(bm)
        if layer is not None and n_corners == self._n_corners:
            write_loops(layer, loops, self._before)
            bmesh.update_edit_mesh(self.mesh, loop_triangles=False, destructive=False)

    def _write_before_in_object_mode(self) -> None:
        uv_map = self.mesh.uv_layers.get(self._layer)
        if uv_map is None or len(self.mesh.loops) != self._n_corners:
            return
        uv = np.empty((self._n_corners, 2), dtype=np.float32)
        uv_map.data.foreach_get("uv", uv.ravel())
        uv[self._adjustment.corners] = self._before
        uv_map.data.foreach_set("uv", uv.ravel())
        self.mesh.update()

    def _remove_added_map(self) -> None:
        uv_map = self.mesh.uv_layers.get(self._layer)
        if self._is_map_added and uv_map is not None:
            self.mesh.uv_layers.remove(uv_map)
        self._is_map_added = False
