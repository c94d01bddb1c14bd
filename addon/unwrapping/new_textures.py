# SPDX-License-Identifier: GPL-3.0-or-later
"""A new UV map of whole meshes, and their textures drawn for it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ..core import native
from ..core.measure.summary import Summary, summarize
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve.options import Settings
from ..core.words import texts
from ..edit_mesh import textures
from ..edit_mesh.read import EditMesh, Reading, read_meshes, unchanged
from . import result_numbers
from .steps import Solved


class Read(NamedTuple):
    """The meshes, and what reads their active maps."""

    edit_meshes: list[EditMesh]
    textures: textures.Found

    def is_unchanged(self) -> bool:
        """Return whether the meshes and their materials still are what was read."""
        try:
            return unchanged(self.edit_meshes) and textures.find(self.edit_meshes).readings == self.textures.readings
        except ReferenceError:
            # An image or a material is gone.
            return False


def read(context: bpy.types.Context, settings: Settings) -> Read:
    """Read the meshes in edit mode, or those of the selected objects, that have faces and a UV map: all of each.

    The maps may be cut at the marked seams or, in a mesh without any, at the island borders of the active map.
    """
    reading = Reading(all_visible=True, correct_aspect=settings.correct_aspect)
    found = read_meshes(_objects(context), reading)
    edit_meshes = [
        replace(each, polygons=_whole(each))
        for each in found
        if each.uv_map is not None and len(each.polygons.selected_faces)
    ]
    return Read(edit_meshes, textures.find(edit_meshes))


def _objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return an object for each mesh in edit mode, or of the selected objects, else of the active one."""
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    chosen = context.selected_objects or [context.object]
    meshes = {each.data: each for each in reversed(chosen) if each is not None and each.type == "MESH"}
    return [each for mesh, each in reversed(meshes.items()) if mesh.library is None]


def _whole(edit_mesh: EditMesh) -> PolygonMesh:
    """Return the mesh to unwrap: with all faces, hidden ones, too, and without pins, which belong to the old map."""
    polygons = edit_mesh.polygons
    seams = polygons.seam_edges
    if not len(seams):
        map_seams = native.spectral_conformal("_layout").map_seams
        seams = map_seams(polygons.face_offsets, polygons.corner_vertices, polygons.uv)
    every = np.ones_like(polygons.selected_faces)
    return replace(polygons, seam_edges=seams, selected_faces=every, pinned_corners=None)


def size(rule: str, side: int) -> object:
    """Return the size of new textures, by the property of the operator and the side of the texture in pixels."""
    return native.textures().TextureSize(rule.lower(), (side, side))


def failures(found: Read, solved: Solved) -> str:
    """Return why islands failed."""
    return texts.failures(_summary(found, solved))


def _summary(found: Read, solved: Solved) -> Summary:
    return summarize(solved.solutions, [each.edit_object.name for each in found.edit_meshes])


def finish(
    found: Read, solved: Solved, drawn: Sequence[textures.Drawn], losses: Sequence[float], seconds: float
) -> list[tuple[str, str]]:
    """Write maps and textures, and return the reports."""
    name, copied = textures.write(found.edit_meshes, solved.placement.uv, drawn)
    summary = _summary(found, solved)
    result_numbers.store(
        "new_textures", seconds=seconds, solved=summary.solved, failed=summary.failed, textures=len(drawn)
    )
    is_visible = native.spectral_conformal("_texture_size").is_visible
    coarser = {each.job.image.name: loss for each, loss in zip(drawn, losses) if is_visible(loss)}
    return [
        ("INFO", texts.copied_materials(copied)),
        ("INFO", texts.new_textures(name, summary.solved, len(drawn), seconds)),
        ("WARNING", texts.coarser_textures(coarser)),
        ("WARNING", texts.kept_textures(found.textures.kept)),
        ("WARNING", texts.failures(summary)),
    ]
