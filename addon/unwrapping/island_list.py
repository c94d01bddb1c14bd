# SPDX-License-Identifier: GPL-3.0-or-later
"""The islands of the last result, worst first, for the sidebar's list, which select their faces."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from .. import names
from ..core import texts
from ..core.solve import Solution, are_solved, column_of_all
from ..core.translation import translate
from ..edit_mesh import selection
from ..edit_mesh.read import EditMesh, read_mesh

# More would make the list slow and are not read.
_MAX_ROWS = 500


@dataclass(frozen=True)
class _Island:
    """An island: the name of its mesh, the digest of the topology that its faces belong to, and the faces."""

    mesh: str
    topology: int
    faces: np.ndarray


_islands: list[_Island] = []
_lines: list[tuple[str, str]] = []


def show(
    edit_meshes: Sequence[EditMesh],
    solutions: Sequence[Solution],
    reports: Sequence[tuple[str, str]],
) -> None:
    """Make these solutions, and what was reported of them as (level, text), the last result."""
    _lines[:] = reports
    _islands.clear()
    window_manager = bpy.context.window_manager
    rows = getattr(window_manager, names.ISLANDS_PROPERTY)
    rows.clear()
    first = np.cumsum([0, *(len(solution.charts) for solution in solutions)])
    for index in _worst_first(solutions)[:_MAX_ROWS].tolist():
        owner = int(np.searchsorted(first, index, side="right")) - 1
        edit_mesh, chart = edit_meshes[owner], solutions[owner].charts[index - int(first[owner])]
        _islands.append(_Island(edit_mesh.mesh.name_full, edit_mesh.polygons.topology, chart.faces))
        row = rows.add()
        row.name = _text(chart)
        row.is_bad = chart.status != "solved" or bool(chart.flipped or chart.overlapping)
    setattr(window_manager, names.ACTIVE_ISLAND_PROPERTY, -1)


def lines() -> list[tuple[str, str]]:
    """Return what was reported of the last result, as (level, text)."""
    return _lines


def select(context: bpy.types.Context, index: int) -> None:
    """Select the visible faces of an island of the list, as a step that can be undone; -1 for none.

    Where its mesh is not in edit mode any more, or has other faces now, the list says so.
    """
    if not 0 <= index < len(_islands):
        return
    island = _islands[index]
    for edit_object in context.objects_in_mode_unique_data if context.mode == "EDIT_MESH" else ():
        if edit_object.data.name_full != island.mesh:
            continue
        edit_mesh = read_mesh(edit_object, all_visible=True)
        if edit_mesh.polygons.topology != island.topology:
            break
        faces = np.zeros(len(edit_mesh.polygons.selected_faces), dtype=bool)
        faces[island.faces] = True
        selection.select_only(context, {edit_mesh.mesh: faces & edit_mesh.polygons.selected_faces})
        if bpy.ops.ed.undo_push.poll():
            bpy.ops.ed.undo_push(message=texts.SELECT_ISLAND_LABEL)
        return
    gone = ("WARNING", translate(texts.ISLAND_GONE))
    if gone not in _lines:
        _lines.append(gone)


def forget() -> None:
    """Forget the faces, as names mean other meshes in another file, and what was said."""
    _islands.clear()
    _lines.clear()


def _worst_first(solutions: Sequence[Solution]) -> np.ndarray:
    """Return all islands, failed ones first, then those with flipped or overlapping faces, then by their worst face."""

    def of(name: str) -> np.ndarray:
        return column_of_all(solutions, name)

    solved = are_solved(solutions)
    number = np.where(solved, of("flipped") + of("overlapping"), of("n_faces"))
    return np.lexsort([np.where(solved, -of("max_qc"), 0.0), -number, solved])


def _text(chart: object) -> str:
    if chart.status != "solved":
        return texts.island_failed(len(chart.faces))
    return texts.island_row(len(chart.faces), chart.mean_qc, chart.max_qc, chart.flipped, chart.overlapping)
