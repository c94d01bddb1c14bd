# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure and change the texel density of the selected islands of all meshes in edit mode."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.layout.density import scaled_about_centers
from ..core.measure.island_density import IslandDensities, of_islands
from ..core.measure.map_view import MapView
from ..core.measure.texels import Texels
from ..core.mesh.charts import chart_of_face
from ..edit_mesh import attributes, selection, texture_size
from ..edit_mesh.read import Reading, read_mesh
from ..edit_mesh.read_map import read_map
from ..edit_mesh.write import write_uv


@dataclass(frozen=True)
class SelectedIslands:
    """The selected islands of the meshes in edit mode; of all visible faces if none is selected."""

    views: Mapping[bpy.types.Object, MapView]
    densities: IslandDensities
    texels: Texels


def selected_islands(context: bpy.types.Context) -> SelectedIslands | None:
    """Measure the islands with a selected face, in the UV editor without sync selection with a selected UV.

    None if no mesh in edit mode has a UV map.
    """
    found = {each: read_map(context, each) for each in context.objects_in_mode_unique_data}
    views = {each: MapView(mesh) for each, mesh in found.items() if mesh is not None}
    if not views:
        return None
    chosen = list(selected_faces(context, list(views)).values())
    measured = texture_size.texels(context)
    return SelectedIslands(views, of_islands(list(views.values()), chosen, measured), measured)


def selected_faces(
    context: bpy.types.Context, objects: Sequence[bpy.types.Object]
) -> dict[bpy.types.Object, np.ndarray]:
    """Return the selected visible faces of the meshes of the `objects`, (F,) bool each; all visible ones if none is."""
    by_uv = selection.selects_uvs(context)
    found = {each: read_mesh(each, Reading(by_uv)).polygons.selected_faces for each in objects}
    if any(faces.any() for faces in found.values()):
        return found
    return {each: read_mesh(each, Reading(all_visible=True)).polygons.selected_faces for each in objects}


def scale(islands: SelectedIslands, scales: np.ndarray) -> None:
    """Scale every island, (K,), about the center of its bounding box; other UVs keep their bits."""
    for (edit_object, view), island in zip(islands.views.items(), islands.densities.island):
        of_corner = island[view.mesh.face_of_corner()]
        changed = np.append(scales, 1.0)[of_corner] != 1.0
        if changed.any():
            edit_mesh = read_mesh(edit_object, Reading(all_visible=True))
            write_uv(edit_mesh, scaled_about_centers(edit_mesh.polygons.uv, of_corner, scales), changed)


def store_factor(context: bpy.types.Context, name: str, factor: float) -> int:
    """Store a factor on the faces of the selected islands, as they are in the map and as seams cut them.

    Returns the number of islands. A mesh without a map has the islands that seams cut.
    """
    islands = 0
    for edit_object, chosen in selected_faces(context, context.objects_in_mode_unique_data).items():
        if not chosen.any():
            continue
        polygons = read_mesh(edit_object, Reading(all_visible=True)).polygons
        island = chart_of_face(polygons, polygons.selected_faces).astype(np.int64)
        if polygons.uv is not None:
            in_map = MapView(polygons).island_of_face
            island = np.where((island < 0) | (in_map < 0), -1, island * (len(in_map) + 1) + in_map)
        numbers = np.unique(island[chosen & (island >= 0)])
        islands += len(numbers)
        if len(numbers):
            faces = np.isin(island, numbers)
            attributes.set_face_values(edit_object.data, name, faces, np.full(len(faces), factor))
    return islands
