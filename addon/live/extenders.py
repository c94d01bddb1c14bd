# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the islands of added, changed or removed extenders again, in place."""

from collections.abc import Collection, Mapping

import bpy
import numpy as np

from ..core.extenders.adjustment import AdjustmentError, ExtenderAdjustment
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import subsurf
from ..edit_mesh.read import read_mesh
from ..edit_mesh.write import write_uv
from ..session import edit_meshes
from ..unwrapping import island_list
from ..unwrapping.last_settings import last_settings


def follow(edit_object: bpy.types.Object, strengths: Mapping[tuple[int, int], float]) -> str:
    """Solve the islands that hold both vertices of an extender again; they keep their position and size.

    `strengths` are the changed ones, by vertices, 0 for removed extenders. Returns a note to the user, which may be
    empty.

    Raises:
        AdjustmentError: there is no such island, or it could not be solved; the map is unchanged.
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if last_settings().options.method != "spectral":
        raise AdjustmentError(translate(texts.EXTENDERS_NEED_SPECTRAL))
    islands = AdjustedIslands(edit_object, strengths, may_be_selected=False)
    islands.write(strengths.values(), is_final=True)
    islands.update_list()
    return islands.note or texts.unused_extenders(islands.adjustment.unused)


class AdjustedIslands:
    """The islands of a mesh in edit mode that some extenders act on, and their former map.

    Attributes:
        adjustment: solves them.
        note: to the user; may be empty.
    """

    def __init__(
        self, edit_object: bpy.types.Object, pairs: Collection[tuple[int, int]], may_be_selected: bool = True
    ) -> None:
        """Take the islands with both vertices of one of the `pairs`, as they are now.

        They are islands of the selected faces if they `may_be_selected` and hold all vertices, otherwise of all visible
        faces.

        Raises:
            AdjustmentError: there is no UV map, or no such island.
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        if not edit_object.data.uv_layers:
            raise AdjustmentError(translate(texts.NO_UV_MAP))
        settings = last_settings()
        for all_visible in (False, True) if may_be_selected else (True,):
            self._edit_mesh = read_mesh(edit_object, False, all_visible, settings.correct_aspect)
            polygons = self._edit_mesh.polygons
            if np.isin(list(pairs), polygons.corner_vertices[polygons.selected_faces[polygons.face_of_corner()]]).all():
                break
        self.adjustment = ExtenderAdjustment(polygons, settings.options, list(pairs))
        self._corners = np.zeros(len(polygons.corner_vertices), dtype=bool)
        self._corners[self.adjustment.corners] = True
        self._layer = edit_object.data.uv_layers.active.name
        is_subdivided = settings.use_subsurf and subsurf.leading_modifier(edit_object) is not None
        self.note = translate(texts.ADJUSTED_WITHOUT_SUBSURF) if is_subdivided else ""

    def write(self, strengths: Collection[float], is_final: bool) -> None:
        """Write the map for a strength of each pair, as in `ExtenderAdjustment.map`."""
        uv = np.zeros((len(self._corners), 2))
        uv[self._corners] = self.adjustment.map(list(strengths), is_final)
        write_uv(self._edit_mesh, uv, self._corners)

    def update_list(self) -> None:
        """Update the list of islands."""
        island_list.update(self._edit_mesh, self.adjustment.charts)

    def restore(self) -> None:
        """Restore the map in any mode, unless the mesh has another map or other corners now."""
        mesh = self._edit_mesh.mesh
        if mesh.uv_layers.active is None or mesh.uv_layers.active.name != self._layer:
            return
        if mesh.is_editmode:
            if sum(len(face.verts) for face in edit_meshes.keep(mesh).bm.faces) == len(self._corners):
                write_uv(self._edit_mesh, self._edit_mesh.polygons.uv, self._corners)
        elif len(mesh.loops) == len(self._corners):
            uv = np.empty((len(self._corners), 2), dtype=np.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uv.ravel())
            uv[self._corners] = self._edit_mesh.polygons.uv[self._corners]
            mesh.uv_layers.active.data.foreach_set("uv", uv.ravel())
            mesh.update()
