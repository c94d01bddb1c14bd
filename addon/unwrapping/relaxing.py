# SPDX-License-Identifier: GPL-3.0-or-later
"""The relaxation of the maps of the meshes in edit mode: read, write, restore and report."""

from collections.abc import Sequence
from dataclasses import replace

import bmesh
import bpy
import numpy as np

from ..core.measure import defects
from ..core.solve.options import Settings
from ..core.solve.relaxing import Relaxed
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh
from ..edit_mesh.write import write_uv
from . import steps


def read(context: bpy.types.Context, correct_aspect: bool) -> tuple[list[EditMesh], bool]:
    """Read the meshes with a UV map and selected faces; without a selection those with visible ones.

    The second value is whether nothing was selected. As in Unwrap, the UV editor without sync selection needs one.
    """
    return steps.read_selected_or_visible(context, Settings(correct_aspect=correct_aspect))


def write(edit_meshes: Sequence[EditMesh], maps: Sequence[np.ndarray], corners: Sequence[np.ndarray]) -> None:
    """Write the map, (C, 2), of every mesh at the faces that have one of its `corners` (C,) bool.

    The others of their corners must have the UV that was read.
    """
    for edit_mesh, uv, of_mesh in zip(edit_meshes, maps, corners):
        if of_mesh.any():
            faces = np.logical_or.reduceat(of_mesh, edit_mesh.polygons.face_offsets[:-1])
            write_uv(edit_mesh, uv, faces[edit_mesh.polygons.face_of_corner()])


def are_there(context: bpy.types.Context, edit_meshes: Sequence[EditMesh]) -> bool:
    """Return whether all meshes are still in edit mode with as many faces and corners as were read.

    The objects in `edit_meshes` may be gone.
    """
    if context.mode != "EDIT_MESH":
        return False
    edited = [each.data for each in context.objects_in_mode_unique_data]
    for edit_mesh in edit_meshes:
        if edit_mesh.mesh not in edited:
            return False
        bm = bmesh.from_edit_mesh(edit_mesh.mesh)
        polygons = edit_mesh.polygons
        if bm.loops.layers.uv.active is None or len(bm.faces) != len(polygons.selected_faces):
            return False
        if sum(len(face.loops) for face in bm.faces) != len(polygons.corner_vertices):
            return False
    return True


def reports(
    edit_meshes: Sequence[EditMesh], found: Relaxed, seconds: float, all_visible: bool
) -> list[tuple[str, str]]:
    """Return what to report of relaxed maps as (level, text) pairs, the most important last."""
    maps = [replace(edit_mesh.polygons, uv=uv) for edit_mesh, uv in zip(edit_meshes, found.maps)]
    of_meshes = defects.find(maps, between_islands=False)
    flipped, overlapping = (
        sum(int(getattr(each, kind).sum()) for each in of_meshes) for kind in ("flipped", "overlapping")
    )
    pairs = [
        ("INFO", translate(texts.NOTHING_SELECTED_RELAXES_ALL) if all_visible else ""),
        ("INFO", texts.relaxed(found.gain, found.steps, flipped, overlapping, seconds)),
    ]
    return [(level, text) for level, text in pairs if text]
