# SPDX-License-Identifier: GPL-3.0-or-later
"""The islands of extenders that were added, changed or removed are solved again where they lie."""

from collections.abc import Mapping

import bpy
import numpy as np

from ..core.extenders.adjustment import AdjustmentError, ExtenderAdjustment
from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import subsurf
from ..edit_mesh.read import read_mesh
from ..edit_mesh.write import write_uv
from ..unwrapping import island_list
from ..unwrapping.last_settings import last_settings


def follow(edit_object: bpy.types.Object, strengths: Mapping[tuple[int, int], float]) -> str:
    """Solve the islands that hold both vertices of an extender again; they keep their place and size.

    `strengths` are those that changed, by vertices, 0 for extenders that are gone. Returns what the user should know;
    may be empty.

    Raises:
        AdjustmentError: there is no such island, or it could not be solved; the map stays as it is.
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    settings = last_settings()
    if settings.options.method != "spectral":
        raise AdjustmentError(translate(texts.EXTENDERS_NEED_SPECTRAL))
    if not edit_object.data.uv_layers:
        raise AdjustmentError(translate(texts.NO_UV_MAP))
    edit_mesh = read_mesh(edit_object, all_visible=True, correct_aspect=settings.correct_aspect)
    adjustment = ExtenderAdjustment(edit_mesh.polygons, settings.options, list(strengths))
    corners = np.zeros(len(edit_mesh.polygons.corner_vertices), dtype=bool)
    corners[adjustment.corners] = True
    uv = np.zeros((len(corners), 2))
    uv[corners] = adjustment.map(list(strengths.values()), is_final=True)
    write_uv(edit_mesh, uv, corners)
    island_list.update(edit_mesh, adjustment.charts)
    return note_on_subsurf(settings, edit_object) or texts.unused_extenders(adjustment.unused)


def note_on_subsurf(settings: Settings, edit_object: bpy.types.Object) -> str:
    """Return what to say where `settings` are to subdivide the object's mesh, which adjusting does not."""
    is_subdivided = settings.use_subsurf and subsurf.leading_modifier(edit_object) is not None
    return translate(texts.ADJUSTED_WITHOUT_SUBSURF) if is_subdivided else ""
