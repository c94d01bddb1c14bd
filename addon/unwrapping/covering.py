# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that have come to lie on other islands, in the maps of the meshes in edit mode."""

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from ..core.measure import defects
from ..core.mesh.polygon_mesh import PolygonMesh
from ..edit_mesh.read import EditMesh, read_meshes


def newly_covering(context: bpy.types.Context, edit_meshes: Sequence[EditMesh]) -> int:
    """Count the visible faces that overlap another island in the written maps, but not in those of `edit_meshes`.

    A mesh that had no map before counts as it is.
    """
    former = {each.mesh: each.polygons.uv for each in edit_meshes if each.polygons.uv is not None}
    visible = read_meshes(context.objects_in_mode_unique_data, all_visible=True)
    visible = [each for each in visible if each.polygons.uv is not None]
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
