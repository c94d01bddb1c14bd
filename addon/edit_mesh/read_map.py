# SPDX-License-Identifier: GPL-3.0-or-later
"""Read meshes and their UV maps to show them."""

from dataclasses import replace

import bpy
import numpy as np

from .. import compatibility
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.mesh.world_scale import metric_of
from ..session import edit_meshes
from . import image_aspect, texture_size
from .read import read_arrays, temporary_mesh


def read_map(
    context: bpy.types.Context,
    shown: bpy.types.Object,
    other_uv: np.ndarray | None = None,
    before: PolygonMesh | None = None,
) -> PolygonMesh | None:
    """Read the visible faces of an object's mesh: in edit mode the edited mesh, else with its modifiers.

    In edit mode `other_uv`, (C, 2), replaces the active UV map. None without faces or without a UV map. `before` is as
    in `read_arrays`.
    """
    if shown.mode != "EDIT":
        evaluated = shown.evaluated_get(context.evaluated_depsgraph_get()).data
        if not isinstance(evaluated, bpy.types.Mesh):
            return None
        return _with_map(_read(evaluated, shown, before, image_aspect.aspect_in_object_mode(shown)))
    bm = edit_meshes.keep(shown.data).bm
    with temporary_mesh() as copy:
        bm.to_mesh(copy)
        found = _read(copy, shown, before, image_aspect.aspect(shown, bm))
        if not context.scene.tool_settings.use_uv_select_sync:
            found = replace(found, uv_faces=found.selected_faces & compatibility.flags(copy, "polygons", "select"))
    if other_uv is not None and len(other_uv) == len(found.corner_vertices):
        # As Blender would store it.
        found = replace(found, uv=other_uv.astype(np.float32).astype(np.float64))
    return _with_map(found)


def _read(mesh: bpy.types.Mesh, shown: bpy.types.Object, before: PolygonMesh | None, aspect: float) -> PolygonMesh:
    """Read all visible faces of a `mesh` of an object, at its scale in the world and with its textures."""
    return read_arrays(
        mesh,
        True,
        before,
        aspect=aspect,
        world_metric=metric_of(shown.matrix_world),
        texture_sides=texture_size.sides(mesh, shown),
    )


def _with_map(found: PolygonMesh) -> PolygonMesh | None:
    return found if found.uv is not None and len(found.selected_faces) else None


def n_faces(context: bpy.types.Context, shown: bpy.types.Object) -> int:
    """Return the number of faces that `read_map` would read."""
    if shown.mode == "EDIT":
        return len(edit_meshes.keep(shown.data).bm.faces)
    evaluated = shown.evaluated_get(context.evaluated_depsgraph_get()).data
    return len(evaluated.polygons) if isinstance(evaluated, bpy.types.Mesh) else 0


def read_own_map(context: bpy.types.Context, shown: bpy.types.Object) -> PolygonMesh | None:
    """Read the mesh of an object without its modifiers, hidden faces included; None as in `read_map`."""
    if shown.mode == "EDIT":
        found = read_map(context, shown)
    else:
        found = _with_map(_read(shown.data, shown, None, image_aspect.aspect_in_object_mode(shown)))
    return found and replace(found, selected_faces=np.ones_like(found.selected_faces))


def active_face(shown: bpy.types.Object) -> int:
    """Return the index of the active face of an object's mesh, -1 for none."""
    if shown.mode != "EDIT":
        return shown.data.polygons.active if shown.data.polygons else -1
    face = edit_meshes.keep(shown.data).bm.faces.active
    return -1 if face is None else face.index
