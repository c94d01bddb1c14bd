# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh of one object in the overlay: what is read and drawn."""

import bpy
import gpu
import numpy as np
from mathutils.bvhtree import BVHTree

from .. import user_preferences
from ..core.measure.map_view import MapView
from ..core.measure.texels import Texels
from ..core.mesh.polygon_mesh import MAP, SURFACE, PolygonMesh
from ..edit_mesh import read_map
from . import colored_triangles


class ShownMesh:
    """A mesh and its map as read last.

    Attributes:
        is_too_large: whether it has more faces than the preferences allow.
        islands_known: whether its islands, flips and overlaps are computed.
    """

    def __init__(self) -> None:
        """Read nothing before `view`."""
        self._view: MapView | None = None
        self._is_stale = True
        self._trusts_faces = False
        self._batches: dict[tuple[str, Texels, int], gpu.types.GPUBatch] = {}
        self._in_editor: dict[tuple[str, Texels, int], gpu.types.GPUBatch] = {}
        self._band: tuple[tuple[float, Texels], gpu.types.GPUBatch | None] | None = None
        self._positions: gpu.types.GPUVertBuf | None = None
        self._tree: BVHTree | None = None
        self.is_too_large = False
        self.islands_known = False

    def edited(self) -> None:
        """Read again when asked next."""
        self._is_stale = True

    def has_scale(self, metric: np.ndarray | None) -> bool:
        """Return whether the object had this metric in the world when it was read; True before."""
        known = None if self._view is None else self._view.mesh.world_metric
        return self._view is None or np.allclose(*(np.eye(3) if each is None else each for each in (known, metric)))

    def view(
        self, context: bpy.types.Context, shown: bpy.types.Object, other_uv: np.ndarray | None = None
    ) -> MapView | None:
        """Return the current map of the object, or with `other_uv` instead; None without faces or a UV map."""
        if self._is_stale:
            self._read(context, shown, other_uv, self._view and self._view.mesh)
        return self._view

    @property
    def last_view(self) -> MapView | None:
        """The map as read last, which may be older than the object's; reads nothing."""
        return self._view

    def confirm(
        self, context: bpy.types.Context, shown: bpy.types.Object, other_uv: np.ndarray | None = None
    ) -> MapView | None:
        """Return the map after reading in full, without the assumptions of `view`."""
        if self._trusts_faces:
            self._read(context, shown, other_uv, None)
        return self._view

    def _read(
        self,
        context: bpy.types.Context,
        shown: bpy.types.Object,
        other_uv: np.ndarray | None,
        before: PolygonMesh | None,
    ) -> None:
        self._is_stale = False
        max_faces = user_preferences.read("overlay_max_faces", user_preferences.MAX_FACES)
        self.is_too_large = read_map.n_faces(context, shown) > max_faces
        arrays = None if self.is_too_large else read_map.read_map(context, shown, other_uv, before)
        are_known = arrays is not None and before is not None
        self._trusts_faces = are_known and arrays.face_offsets is before.face_offsets
        self._show(arrays)

    def _show(self, arrays: PolygonMesh | None) -> None:
        """Replace the map by what was read, and keep what has not changed."""
        before = self._view
        if arrays is None and before is None:
            return
        has_mesh = arrays is not None and before is not None and arrays.equals(before.mesh, SURFACE)
        if has_mesh and arrays.equals(before.mesh, MAP):
            return
        self._view = None if arrays is None else MapView(arrays, before if has_mesh else None)
        self._batches.clear()
        self._in_editor.clear()
        self._band = None
        self.islands_known = False
        if not has_mesh:
            self._positions = self._tree = None

    def batch(
        self, kind: str, texels: Texels, in_editor: bool, own: tuple[int, np.ndarray] | None = None
    ) -> gpu.types.GPUBatch | None:
        """Return the triangles to draw for the last view; None for none.

        `own` are values to show instead, (F,), and their serial number.
        """
        serial, shown_values = own or (0, None)
        known, key = (self._in_editor if in_editor else self._batches), (kind, texels, serial)
        if key not in known:
            known.clear()
            uv, values = self._view.triangle_map(kind, texels, shown_values)
            chosen = np.repeat(self._view.is_in_uv_editor(), 3) if in_editor else np.ones(1, dtype=bool)
            if not chosen.all():
                positions = colored_triangles.buffer(self._view.triangle_positions()[chosen]) if chosen.any() else None
                uv, values = uv[chosen], values[chosen]
            else:
                if self._positions is None:
                    self._positions = self._positions_of_all()
                positions = self._positions
            known[key] = colored_triangles.batch(positions, uv, values) if len(values) else None
        return known[key]

    def band(self, margin: float, texels: Texels) -> gpu.types.GPUBatch | None:
        """Return the band around the islands in the UV editor, half of a margin in pixels wide; None for none."""
        if self._band is None or self._band[0] != (margin, texels):
            uv = self._view.border_band(margin, texels)
            positions = colored_triangles.buffer(np.zeros((len(uv), 3), dtype=np.float32)) if len(uv) else None
            drawn = colored_triangles.batch(positions, uv, np.full(len(uv), -1.0, np.float32)) if len(uv) else None
            self._band = (margin, texels), drawn
        return self._band[1]

    def tree(self) -> BVHTree:
        """Return a ray-casting tree of the triangles of the last view, made on first use."""
        if self._tree is None:
            mesh = self._view.mesh
            vertices = mesh.corner_vertices.take(self._view.triangles[0])
            self._tree = BVHTree.FromPolygons(mesh.vertices.tolist(), vertices.tolist(), all_triangles=True)
        return self._tree

    def _positions_of_all(self) -> gpu.types.GPUVertBuf | None:
        positions = self._view.triangle_positions()
        return colored_triangles.buffer(positions) if len(positions) else None
