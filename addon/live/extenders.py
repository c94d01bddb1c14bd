# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the islands of added, changed or removed extenders again, in place."""

from collections.abc import Collection

import bpy
import numpy as np

from ..core.errors import ReadableError
from ..core.extenders.adjustment import ExtenderAdjustment
from ..core.mesh.polygon_mesh import Force
from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import subsurf
from ..edit_mesh.write import ChangingMaps
from ..unwrapping import island_list, parts


def follow(edit_object: bpy.types.Object, pairs: Collection[tuple[int, int]], settings: Settings) -> str:
    """Solve the islands that hold both vertices of one of the `pairs` again; they keep their position and size.

    `pairs` are those of changed extenders. Returns a note to the user, which may be empty.

    Raises:
        ReadableError: there is no such island, or it could not be solved; the map is unchanged.
    """
    if settings.options.method != "spectral":
        raise ReadableError(translate("Push/Pull works with the Spectral method only; unwrap with it"))
    islands = AdjustedIslands(edit_object, pairs, settings)
    islands.write()
    return islands.note or texts.counted(islands.adjustment.unused, texts.UNUSED_EXTENDERS) or islands.folds()


class AdjustedIslands:
    """The islands of a mesh in edit mode that some extenders act on, and their former map.

    Attributes:
        adjustment: solves them.
        note: to the user; may be empty.
    """

    def __init__(self, edit_object: bpy.types.Object, pairs: Collection[tuple[int, int]], settings: Settings) -> None:
        """Take the visible islands with both vertices of one of the `pairs`, as they are now.

        The rest of a part that was solved in place last stays.

        Raises:
            ReadableError: there is no UV map, or no such island.
        """
        if not edit_object.data.uv_layers:
            raise ReadableError(translate(texts.NO_UV_MAP))
        self._edit_mesh, polygons, faces = parts.read_visible(edit_object, settings.correct_aspect)
        if faces is not None:
            of_parts = polygons.corner_vertices[faces[polygons.face_of_corner()]]
            polygons = polygons if np.isin(list(pairs), of_parts).all() else self._edit_mesh.polygons
        self.adjustment = ExtenderAdjustment(polygons, settings.options, pairs)
        self._maps = ChangingMaps([self._edit_mesh], [self.adjustment.corners])
        is_subdivided = settings.use_subsurf and subsurf.leading_modifier(edit_object) is not None
        self.note = (
            translate("Adjusting ignores the Subdivision Surface modifier; unwrap again to include it")
            if is_subdivided
            else ""
        )

    def write(self, changed: Force | None = None, is_final: bool = True) -> None:
        """Write the map, as `ExtenderAdjustment.map` returns it; the final one is listed."""
        self._maps.write([self.adjustment.map(changed, is_final)])
        if is_final:
            island_list.update(self._edit_mesh, self.adjustment.charts)

    def folds(self) -> str:
        """Return a warning about faces that are flipped or overlap others in the last map; empty for none."""
        return texts.folds(self.adjustment.flipped, self.adjustment.overlapping)

    def restore(self) -> None:
        """Restore the map in any mode, unless something else has changed it since it was written."""
        self._maps.restore()
