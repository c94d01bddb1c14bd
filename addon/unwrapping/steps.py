# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of an unwrap of the meshes in edit mode: read, solve, place and write."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ..core.layout.placement import Placement, place
from ..core.mesh.charts import faces_of_charts_at
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve.in_place import blended_with_former, with_axis_held
from ..core.solve.options import Settings
from ..core.solve.progress import Progress
from ..core.solve.solution import Solution, solve_all
from ..edit_mesh import selection
from ..edit_mesh.read import EditMesh, Reading, read_meshes
from ..edit_mesh.write import write_all
from ..session import kept_maps


def read(
    context: bpy.types.Context, settings: Settings, all_visible: bool = False, in_place: bool = False
) -> list[EditMesh]:
    """Read every mesh in edit mode that has selected faces, once, and return those with faces to unwrap.

    In the UV editor without sync selection, only faces with a selected UV count. `all_visible` ignores the selection.
    With `in_place` the rest of a partly selected island stays.
    """
    by_uv_selection = not all_visible and selection.selects_uvs(context)
    edit_objects = [
        edit_object
        for edit_object in context.objects_in_mode_unique_data
        if all_visible or edit_object.data.total_face_sel
    ]
    in_place = in_place and not all_visible
    whole_faces = in_place and context.scene.tool_settings.uv_select_mode in {"FACE", "ISLAND"}
    chosen = by_uv_selection, all_visible, settings.correct_aspect, settings.use_subsurf, in_place, whole_faces
    edit_meshes = read_meshes(edit_objects, Reading(*chosen))
    return [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.selected_faces.any()]


def read_selected_or_visible(
    context: bpy.types.Context, settings: Settings, in_place: bool = False
) -> tuple[list[EditMesh], bool]:
    """Read as `read` does, or all visible faces if none is selected; also return whether none was.

    The UV editor without sync selection shows selected faces only, so it needs a selection.
    """
    edit_meshes = read(context, settings, in_place=in_place)
    if edit_meshes or selection.selects_uvs(context):
        return edit_meshes, False
    return read(context, settings, all_visible=True), True


def only_charts_at(edit_meshes: Sequence[EditMesh], edges: Mapping[bpy.types.Mesh, np.ndarray]) -> list[EditMesh]:
    """Return the meshes with `edges` (N, 2), reduced to the faces of charts that have one of these.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    found = [edit_mesh for edit_mesh in edit_meshes if edit_mesh.mesh in edges]
    for edit_mesh in found:
        faces = edit_mesh.polygons.selected_faces
        faces &= faces_of_charts_at(edit_mesh.polygons, faces, edges[edit_mesh.mesh])
    return found


def read_beside(context: bpy.types.Context, settings: Settings, edit_meshes: Sequence[EditMesh]) -> list[PolygonMesh]:
    """Read the other meshes in edit mode, around whose maps the charts of these are packed; none if they are not."""
    if settings.keep_in_place:
        return []
    known = {each.mesh for each in edit_meshes}
    others = [each for each in context.objects_in_mode_unique_data if each.data not in known]
    found = read_meshes(others, Reading(all_visible=True, correct_aspect=settings.correct_aspect))
    return [each.polygons for each in found if each.polygons.uv is not None]


class Solved(NamedTuple):
    """The solutions of meshes, and where their charts go."""

    solutions: list[Solution]
    placement: Placement


def solve_and_place(
    edit_meshes: Sequence[EditMesh],
    settings: Settings,
    progress: Progress | None = None,
    beside: Sequence[PolygonMesh] = (),
) -> Solved:
    """Solve the meshes that `read` returned and place their charts, in any thread.

    Islands that have not changed keep their maps; packed ones lie around what `read_beside` returned. `progress` gets
    the fraction done of all meshes.

    Raises:
        ReadableError: the margin is not finite.
        NativeModuleError: `spectral_conformal` cannot be imported.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    meshes = [with_axis_held(edit_mesh.polygons, settings) for edit_mesh in edit_meshes]
    subdivisions = [edit_mesh.subdivision for edit_mesh in edit_meshes]
    solved = [
        mesh if subdivision is None else subdivision.holding(mesh) for mesh, subdivision in zip(meshes, subdivisions)
    ]
    solutions = [
        solution if subdivision is None else subdivision.on_coarse(solution)
        for solution, subdivision in zip(
            solve_all(solved, settings.options, progress, kept_maps.of_session()), subdivisions
        )
    ]
    placement = place(meshes, solutions, settings, progress, beside)
    return Solved(
        solutions, replace(placement, uv=blended_with_former(meshes, solutions, placement.uv, settings.blend))
    )


def write(edit_meshes: Sequence[EditMesh], solved: Solved) -> None:
    """Write the solved charts; failed ones keep their UVs."""
    maps = [
        (edit_mesh, uv, solution.solved_corners)
        for edit_mesh, uv, solution in zip(edit_meshes, solved.placement.uv, solved.solutions)
        if solution.solved_corners.any()
    ]
    if maps:
        write_all(*zip(*maps))
