# SPDX-License-Identifier: GPL-3.0-or-later
"""The islands of the last result, worst first, for the sidebar's list, which select their faces."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from .. import names, session
from ..core.mesh.charts import is_island
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve import chart_records
from ..core.solve.solution import Solution
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..edit_mesh.read import EditMesh, read_mesh
from ..session import Remembered, identity
from ..session.identity import Identity

# More would make the list slow and are not read.
_MAX_ROWS = 500


@dataclass(frozen=True)
class _Island:
    """An island of a mesh.

    Attributes:
        mesh: which it is.
        topology: the digest of the topology that its faces belong to.
        domain: (F,) bool, the faces that were unwrapped with it.
        chart: its record, of the native module.
    """

    mesh: Identity
    topology: int
    domain: np.ndarray
    chart: Any

    def is_one_of(self, polygons: PolygonMesh) -> bool:
        """Return whether a mesh, as it is now, has this island still; one that failed has no map to tell by."""
        if polygons.topology != self.topology:
            return False
        return self.chart.status != "solved" or is_island(polygons, self.domain, self.chart.faces)


class _LastResult(Remembered):
    """The islands of the list, in its order; the reports of the last result, and the operators that select causes."""

    def __init__(self) -> None:
        self.islands: list[_Island] = []
        self.lines: list[tuple[str, str]] = []
        self.problem = ""
        self.selecting: tuple[str, ...] = ()


def _last() -> _LastResult:
    return session.of(_LastResult)


def show(
    edit_meshes: Sequence[EditMesh],
    solutions: Sequence[Solution],
    reports: Sequence[tuple[str, str]],
    others_stay: bool = False,
    selecting: Sequence[str] = (),
) -> None:
    """Make these solutions, with their reports as (level, text), the last result.

    With `others_stay` islands of other faces, which have not been unwrapped again, stay in the list. `selecting` names
    the operators that select what the reports warn of.
    """
    _last().lines, _last().selecting, _last().problem = list(reports), tuple(selecting), ""
    charts = [solution.charts for solution in solutions]
    others = _others(edit_meshes, [edit_mesh.polygons.selected_faces for edit_mesh in edit_meshes])
    _fill([*(others if others_stay else ()), *_islands_of(edit_meshes, charts)])


def update(edit_mesh: EditMesh, charts: Sequence[Any]) -> None:
    """Update islands of the list that were solved again, given their charts."""
    solved = np.zeros(len(edit_mesh.polygons.selected_faces), dtype=bool)
    for chart in charts:
        solved[chart.faces] = True
    others = _others([edit_mesh], [solved])
    if len(others) < len(_last().islands):
        _fill([*others, *_islands_of([edit_mesh], [charts])])


def _islands_of(edit_meshes: Sequence[EditMesh], charts: Sequence[Sequence[Any]]) -> list[_Island]:
    found = []
    for edit_mesh, of_mesh in zip(edit_meshes, charts):
        polygons, mesh = edit_mesh.polygons, identity.of(edit_mesh.mesh)
        for index in _worst_first(of_mesh)[:_MAX_ROWS].tolist():
            found.append(_Island(mesh, polygons.topology, polygons.selected_faces, of_mesh[index]))
    return found


def _others(edit_meshes: Sequence[EditMesh], solved: Sequence[np.ndarray]) -> list[_Island]:
    """Return the islands of the list without those of the `solved` faces of these meshes, (F,) bool each."""

    by_mesh = {identity.of(each.mesh): (each.polygons.topology, faces) for each, faces in zip(edit_meshes, solved)}

    def stays(island: _Island) -> bool:
        if island.mesh not in by_mesh:
            return True
        topology, faces = by_mesh[island.mesh]
        return island.topology == topology and not faces[island.chart.faces].any()

    return [island for island in _last().islands if stays(island)]


def _fill(islands: Sequence[_Island]) -> None:
    """Make these the list, the worst first."""
    order = _worst_first([island.chart for island in islands])
    _last().islands = [islands[index] for index in order[:_MAX_ROWS].tolist()]
    window_manager = bpy.context.window_manager
    rows = getattr(window_manager, names.ISLANDS_PROPERTY)
    rows.clear()
    for island in _last().islands:
        chart = island.chart
        row = rows.add()
        row.name = _text(chart)
        row.is_bad = chart.status != "solved" or bool(chart.flipped or chart.overlapping)
    setattr(window_manager, names.ACTIVE_ISLAND_PROPERTY, -1)


def lines() -> list[tuple[str, str]]:
    """Return the reports of the last result, and what has gone wrong since, as (level, text)."""
    return [*_last().lines, *([("WARNING", _last().problem)] if _last().problem else [])]


def note(problem: str) -> None:
    """Show what has gone wrong since the last result; empty for nothing."""
    _last().problem = problem


def selecting() -> tuple[str, ...]:
    """Return the operators that select what the reports of the last result warn of."""
    return _last().selecting


def select(context: bpy.types.Context, index: int) -> None:
    """Select the visible faces of an island of the list, as a step that can be undone; -1 for none.

    If its mesh is no longer in edit mode, or now has other faces or islands, the list says so.
    """
    if not 0 <= index < len(_last().islands):
        return
    island = _last().islands[index]
    for edit_object in context.objects_in_mode_unique_data if context.mode == "EDIT_MESH" else ():
        if identity.of(edit_object.data) is not island.mesh:
            continue
        edit_mesh = read_mesh(edit_object, all_visible=True)
        if not island.is_one_of(edit_mesh.polygons):
            break
        faces = np.zeros(len(edit_mesh.polygons.selected_faces), dtype=bool)
        faces[island.chart.faces] = True
        selection.select_island(context, edit_mesh.mesh, faces & edit_mesh.polygons.selected_faces)
        return
    note(translate(texts.ISLAND_GONE))


def _worst_first(charts: Sequence[Any]) -> np.ndarray:
    """Return the order of charts: failed ones, those with flipped or overlapping faces, then by their worst face."""
    if not len(charts):
        return np.zeros(0, dtype=np.intp)

    def of(name: str) -> np.ndarray:
        return chart_records.column(charts, name)

    solved = of("status") == "solved"
    number = np.where(solved, of("flipped") + of("overlapping"), of("n_faces"))
    return np.lexsort([np.where(solved, -of("max_qc"), 0.0), -number, solved])


def _text(chart: object) -> str:
    if chart.status != "solved":
        return texts.island_failed(len(chart.faces))
    return texts.island_row(len(chart.faces), chart.mean_qc, chart.max_qc, chart.flipped, chart.overlapping)
