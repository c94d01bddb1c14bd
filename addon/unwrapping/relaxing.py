# SPDX-License-Identifier: GPL-3.0-or-later
"""The relaxation of the maps of the meshes in edit mode: progress and reports."""

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from ..core.measure import defects
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve.relaxing import Relaxed
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh, Reading, read_meshes
from . import result_numbers

# In tiles: a hundredth of a pixel of 1024.
_ROUNDING = 1e-5


def status(found: Relaxed | None) -> str:
    """Return the text of the status bar for a relaxation in progress."""
    return texts.relax_status(found.gain if found else 0.0, found.steps if found else 0)


def reports(
    context: bpy.types.Context, edit_meshes: Sequence[EditMesh], found: Relaxed, seconds: float, all_visible: bool
) -> list[tuple[str, str]]:
    """Return the reports of relaxed maps as (level, text) pairs, some empty, the most important last."""
    maps = [replace(edit_mesh.polygons, uv=uv) for edit_mesh, uv in zip(edit_meshes, found.maps)]
    of_meshes = defects.find(maps, between_islands=False)
    flipped, overlapping = (
        sum(int(getattr(each, kind).sum()) for each in of_meshes) for kind in ("flipped", "overlapping")
    )
    result_numbers.store("relax", seconds=seconds, steps=found.steps, flipped=flipped, overlapping=overlapping)
    return [
        ("INFO", translate("Nothing was selected, so all visible faces were relaxed") if all_visible else ""),
        (
            "INFO",
            translate("UVs that violate a stored shape stayed; unwrap again, or clear its check mark in the list")
            if any(each.has_unmet for each in found.meshes)
            else "",
        ),
        ("INFO", texts.relaxed(found.gain, found.steps, flipped, overlapping, seconds)),
        ("WARNING", texts.newly_beyond_tile(sum(map(_newly_beyond_tile, edit_meshes, found.maps)))),
        ("WARNING", texts.newly_covering(newly_covering(context, edit_meshes))),
    ]


def _newly_beyond_tile(edit_mesh: EditMesh, uv: np.ndarray) -> int:
    """Count the faces that lay within a UV tile, and lie beyond it in the map `uv` (C, 2)."""
    before, now = (edit_mesh.polygons.face_bounds(each) for each in (edit_mesh.polygons.uv, uv))
    tile = np.floor((before[0] + before[1]) / 2.0)
    lay, lie = (
        ((low >= tile - _ROUNDING) & (high <= tile + 1.0 + _ROUNDING)).all(axis=1) for low, high in (before, now)
    )
    return int(np.count_nonzero(lay & ~lie))


def newly_covering(context: bpy.types.Context, edit_meshes: Sequence[EditMesh]) -> int:
    """Count the visible faces that overlap another island in the written maps, but not in those of `edit_meshes`.

    A mesh that had no map before counts as it is.
    """
    former = {each.mesh: each.polygons.uv for each in edit_meshes if each.polygons.uv is not None}
    visible = read_meshes(context.objects_in_mode_unique_data, Reading(all_visible=True))
    visible = [each for each in visible if each.polygons.uv is not None]
    if not visible:
        return 0
    now = _between_islands([each.polygons for each in visible])
    if not now.any():
        return 0
    before = [replace(each.polygons, uv=former.get(each.mesh, each.polygons.uv)) for each in visible]
    return int(np.count_nonzero(now & ~_between_islands(before)))


def _between_islands(meshes: Sequence[PolygonMesh]) -> np.ndarray:
    """Return which faces of all meshes, (F,) bool, overlap another island but none of their own."""
    kinds = [[each.overlapping for each in defects.find(meshes, between_islands)] for between_islands in (True, False)]
    overlapping, within = map(np.concatenate, kinds)
    return overlapping & ~within
