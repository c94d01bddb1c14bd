# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap the meshes in edit mode: read, solve, place, write, pack."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from . import mesh_io, packing
from .core import reporting, unwrapping
from .mesh_io import EditMesh


@dataclass(frozen=True)
class Outcome:
    """What an unwrap did: totals over all meshes, and how many islands could not be kept in place."""

    summary: reporting.Summary
    without_bounds: int = 0


def unwrap(
    context: bpy.types.Context, options: unwrapping.Options, keep_in_place: bool, margin: float
) -> Outcome | None:
    """Unwrap the selected visible faces of all objects in edit mode into their active UV maps.

    Called from the UV editor without sync selection, only faces with a selected UV count. Returns None, having changed
    nothing, if no face is selected. Failed charts keep their UVs; if all fail, nothing changes.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        PackingError: Blender's packer did not run; nothing changed.
    """
    edit_meshes = _read_selected(context)
    if not edit_meshes:
        return None
    solutions = [unwrapping.solve(edit_mesh.polygons, options) for edit_mesh in edit_meshes]
    summary = reporting.summarize(solutions, [edit_mesh.edit_object.name for edit_mesh in edit_meshes])
    if summary.solved == 0:
        return Outcome(summary)
    placement = unwrapping.place([edit_mesh.polygons for edit_mesh in edit_meshes], solutions, keep_in_place)
    solved = [
        (edit_mesh, uv, solution.solved_corners)
        for edit_mesh, uv, solution in zip(edit_meshes, placement.uv, solutions)
        if solution.solved_corners.any()
    ]
    _write(context, solved, None if keep_in_place else margin)
    return Outcome(summary, placement.without_bounds)


def _read_selected(context: bpy.types.Context) -> list[EditMesh]:
    """Read every mesh in edit mode that has selected faces, once, and return those with faces to unwrap."""
    by_uv_selection = (
        context.area is not None
        and context.area.type == "IMAGE_EDITOR"
        and not context.scene.tool_settings.use_uv_select_sync
    )
    edit_meshes = [
        mesh_io.read(edit_object, by_uv_selection)
        for edit_object in context.objects_in_mode_unique_data
        if edit_object.data.total_face_sel
    ]
    return [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.selected_faces.any()]


def _write(
    context: bpy.types.Context,
    solved: Sequence[tuple[EditMesh, np.ndarray, np.ndarray]],
    margin: float | None,
) -> None:
    """Write the UVs, each (C, 2), at the solved corners, each (C,) bool, and pack unless `margin` is None."""
    added = [edit_mesh.mesh for edit_mesh, _, _ in solved if mesh_io.ensure_uv_map(edit_mesh.mesh)]
    for edit_mesh, uv, corners in solved:
        mesh_io.write_uv(edit_mesh, uv, corners)
    if margin is None:
        return
    faces = [np.logical_and.reduceat(corners, edit_mesh.polygons.face_offsets[:-1]) for edit_mesh, _, corners in solved]
    try:
        packing.pack(context, [edit_mesh for edit_mesh, _, _ in solved], faces, margin)
    except packing.PackingError:
        for edit_mesh, _, corners in solved:
            if edit_mesh.mesh in added:
                edit_mesh.mesh.uv_layers.remove(edit_mesh.mesh.uv_layers.active)
            else:
                mesh_io.write_uv(edit_mesh, edit_mesh.polygons.uv, corners)
        raise
