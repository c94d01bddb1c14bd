# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap the meshes in edit mode: read, solve, place and pack, write."""

import functools
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.layout import obstacles
from ..core.layout.placement import place
from ..core.measure.summary import Summary, summarize
from ..core.solve import kept_maps
from ..core.solve.options import Settings
from ..core.solve.progress import Progress
from ..core.solve.solution import Solution, solve_all
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..edit_mesh.read import EditMesh, read_meshes
from ..edit_mesh.write import ensure_uv_map, write_uv
from . import last_result

# Makes the context manager that is entered while UVs are written: live unwrapping must not follow the pins that move.
WhileWriting = Callable[[], AbstractContextManager[None]]


@dataclass(frozen=True)
class Outcome:
    """What an unwrap did.

    Attributes:
        summary: totals over all meshes.
        without_bounds: number of islands that could not be kept in place.
        notes: what the user should know about the objects.
        warnings: what the user asked for and did not get.
    """

    summary: Summary
    without_bounds: int = 0
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def solve(edit_meshes: Sequence[EditMesh], settings: Settings, progress: Progress | None = None) -> list[Solution]:
    """Solve what has changed of the meshes that `read` returned since it was last solved.

    Touches nothing of Blender's, so that any thread may call it.

    `progress` gets the fraction done of all meshes.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        spectral_conformal.Cancelled: `progress` returned False.
    """
    subdivisions = [edit_mesh.subdivision for edit_mesh in edit_meshes]
    meshes = [
        edit_mesh.polygons if subdivision is None else subdivision.mesh
        for edit_mesh, subdivision in zip(edit_meshes, subdivisions)
    ]
    solutions = solve_all(meshes, settings.options, progress, kept_maps.of_session())
    return [
        solution if subdivision is None else subdivision.on_coarse(solution)
        for solution, subdivision in zip(solutions, subdivisions)
    ]


def write(
    settings: Settings,
    edit_meshes: Sequence[EditMesh],
    solutions: Sequence[Solution],
    while_writing: WhileWriting = nullcontext,
) -> Outcome:
    """Place the solved charts and write them. Failed charts keep their UVs; if all fail, nothing changes.

    `while_writing` makes a context manager that is entered for the time in which UVs change.

    Raises:
        MarginError: the margin is not finite; nothing changed.
    """
    summary = summarize(solutions, [edit_mesh.edit_object.name for edit_mesh in edit_meshes])
    without_bounds, left_tile = 0, False
    if summary.solved:
        without_bounds, left_tile = write_maps(settings, edit_meshes, solutions, while_writing)
    last_result.remember(edit_meshes, solutions)
    warnings = _warnings(summary, edit_meshes, settings, solutions)
    return Outcome(
        summary,
        without_bounds,
        _notes(edit_meshes, settings),
        (*warnings, translate(texts.PACKED_BESIDE_FAILED)) if left_tile else warnings,
    )


def write_maps(
    settings: Settings,
    edit_meshes: Sequence[EditMesh],
    solutions: Sequence[Solution],
    while_writing: WhileWriting = nullcontext,
) -> tuple[int, bool]:
    """Place the solved charts, of which there must be one, and write them.

    Returns how many could not be kept in place, and whether packing had to leave the tile.

    Raises:
        MarginError: the margin is not finite; nothing changed.
    """
    polygons = [edit_mesh.polygons for edit_mesh in edit_meshes]
    margin = None if settings.keep_in_place else settings.margin
    placement = place(polygons, solutions, settings.keep_in_place, settings.turn_to_pack, margin)
    solved = [
        _Solved(edit_mesh, uv, solution)
        for edit_mesh, uv, solution in zip(edit_meshes, placement.uv, solutions)
        if solution.solved_corners.any()
    ]
    left_tile = margin is not None and _keep_off(_failed_boxes(edit_meshes, solutions), solved)
    with while_writing():
        _write(solved)
    return placement.without_bounds, left_tile


def _warnings(
    summary: Summary, edit_meshes: Sequence[EditMesh], settings: Settings, solutions: Sequence[Solution]
) -> tuple[str, ...]:
    """Return which islands need seams, and what extenders and stretching could not do."""
    warnings = [
        # What is stretched on request is so everywhere.
        texts.strained(summary) if settings.options.stretch == 1.0 else "",
        texts.broken_extenders([name for edit_mesh in edit_meshes for name in edit_mesh.broken_extenders]),
        texts.too_small(sum(solution.too_small_faces for solution in solutions)),
        texts.extenders_without_strength([name for m in edit_meshes for name in m.extenders_without_strength]),
        texts.unused_extenders(sum(solution.unused_extenders for solution in solutions)),
    ]
    if settings.options.stretch != 1.0 and all(m.polygons.stretch_direction is None for m in edit_meshes):
        warnings.append(translate(texts.NO_ACTIVE_EDGE))
    return tuple(filter(None, warnings))


def _notes(edit_meshes: Sequence[EditMesh], settings: Settings) -> tuple[str, ...]:
    """Return what Blender's own Unwrap would report about the objects."""
    worlds = [edit_mesh.edit_object.matrix_world for edit_mesh in edit_meshes]
    scales = [tuple(world.to_3x3().col[axis].length for axis in range(3)) for world in worlds]
    notes = [texts.object_scale(scales, [world.is_negative for world in worlds])]
    if settings.use_subsurf and all(edit_mesh.subdivision is None for edit_mesh in edit_meshes):
        notes.append(translate(texts.NO_LEADING_SUBSURF))
    return tuple(filter(None, notes))


def reports(outcome: Outcome, seconds: float) -> list[tuple[str, str]]:
    """Return what to tell the user of an unwrap that took `seconds`, as (level, text) pairs.

    Blender shows the last one in the status bar, all of them in the Info editor: what asks for something comes last.
    """
    summary = outcome.summary
    pairs = (
        ("INFO", texts.repairs(summary)),
        ("INFO", texts.unfolded(summary)),
        ("INFO", texts.pinned(summary)),
        ("INFO", texts.information(summary, seconds, texts.SELECT_DEFECTS_LABEL) if summary.solved else ""),
        *(("INFO", note) for note in outcome.notes),
        *(("WARNING", warning) for warning in outcome.warnings),
        ("WARNING", texts.without_bounds(outcome.without_bounds)),
        ("WARNING", texts.failures(summary)),
    )
    return [(level, text) for level, text in pairs if text]


def read(context: bpy.types.Context, settings: Settings, all_visible: bool = False) -> list[EditMesh]:
    """Read every mesh in edit mode that has selected faces, once, and return those with faces to unwrap.

    Called from the UV editor without sync selection, only faces with a selected UV count. With `all_visible` the
    selection does not count at all.
    """
    by_uv_selection = not all_visible and selection.selects_uvs(context)
    edit_objects = [
        edit_object
        for edit_object in context.objects_in_mode_unique_data
        if all_visible or edit_object.data.total_face_sel
    ]
    edit_meshes = read_meshes(edit_objects, by_uv_selection, all_visible, settings.correct_aspect, settings.use_subsurf)
    return [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.selected_faces.any()]


def read_again(
    context: bpy.types.Context, settings: Settings, edit_meshes: Sequence[EditMesh], all_visible: bool = False
) -> list[EditMesh] | None:
    """Read what an earlier `read` returned once more; None if anything in it has changed or gone since.

    The objects in `edit_meshes` need not exist any more.
    """
    if context.mode != "EDIT_MESH":
        return None
    now = read(context, settings, all_visible)
    same = len(now) == len(edit_meshes) and all(
        new.edit_object == old.edit_object and new.polygons.equals(old.polygons) for new, old in zip(now, edit_meshes)
    )
    return now if same else None


class _Solved:
    """A mesh with solved charts.

    Attributes:
        edit_mesh: the mesh.
        uv: (C, 2), meaningful at the solved corners.
        corners: (C,) bool, the corners of the solved charts.
    """

    def __init__(self, edit_mesh: EditMesh, uv: np.ndarray, solution: Solution) -> None:
        """Take a mesh and what was solved of it."""
        self.edit_mesh = edit_mesh
        self.uv = uv
        self.corners = solution.solved_corners
        self._solution = solution

    @functools.cached_property
    def movable_corners(self) -> np.ndarray:
        """(C,) bool, those of the solved charts without pins."""
        return self.corners & ~self._solution.pinned_corners

    @functools.cached_property
    def movable_faces(self) -> np.ndarray:
        """(F,) bool, the faces of these."""
        # Charts are made of whole faces.
        return self.movable_corners[self.edit_mesh.polygons.face_offsets[:-1]]


def _write(solved: Sequence[_Solved]) -> None:
    """Write the UVs at the solved corners; where that is interrupted, everything is as before."""
    added = [item.edit_mesh.mesh for item in solved if ensure_uv_map(item.edit_mesh.mesh)]
    try:
        for item in solved:
            write_uv(item.edit_mesh, item.uv, item.corners)
    except BaseException:
        # Also where a script is interrupted from the keyboard.
        for item in solved:
            if item.edit_mesh.mesh in added:
                item.edit_mesh.mesh.uv_layers.remove(item.edit_mesh.mesh.uv_layers.active)
            else:
                write_uv(item.edit_mesh, item.edit_mesh.polygons.uv, item.corners)
        raise


def _keep_off(staying: Sequence[np.ndarray], solved: Sequence[_Solved]) -> bool:
    """Move the charts without pins off the faces that stay, given their bounding boxes.

    Returns whether that took them out of the tile.
    """
    if not any(map(len, staying)):
        return False
    movable = [item for item in solved if item.movable_faces.any()]
    if not movable:
        return False
    boxes = [obstacles.face_boxes(item.edit_mesh.polygons, item.uv, item.movable_faces) for item in movable]
    scale, offset = obstacles.place_beside(np.concatenate(boxes), staying)
    if scale != 1.0 or offset.any():
        for item in movable:
            item.uv[item.movable_corners] = item.uv[item.movable_corners] * scale + offset
    return bool(offset.max() >= 1.0)


def _failed_boxes(edit_meshes: Sequence[EditMesh], solutions: Sequence[Solution]) -> list[np.ndarray]:
    """Return the bounding boxes of the faces of failed charts in the map that they keep."""
    return [
        obstacles.face_boxes(edit_mesh.polygons, edit_mesh.polygons.uv, solution.failed_faces)
        for edit_mesh, solution in zip(edit_meshes, solutions)
        if solution.has_failures and edit_mesh.polygons.uv is not None
    ]
