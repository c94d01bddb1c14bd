# SPDX-License-Identifier: GPL-3.0-or-later
"""The islands of the last result, worst first, for the sidebar's list, which select their faces."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import bpy
import numpy as np

from .. import compatibility, names, session
from ..core.mesh.charts import is_island
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve.chart_records import ChartsOfAll
from ..core.solve.solution import Solution
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..edit_mesh.read import EditMesh, Reading, out_of_edit_mode, read_mesh
from ..session import Remembered, identity
from ..session.identity import Identity

# More would make the list slow and are not read.
_MAX_ROWS = 500


class _Measures(NamedTuple):
    """What the list shows of an island, and sorts by: fields of its chart's record."""

    is_solved: bool
    n_faces: int
    mean_qc: float
    max_qc: float
    flipped: int
    overlapping: int


@dataclass(frozen=True)
class _Island:
    """An island of a mesh.

    Attributes:
        mesh: which it is.
        topology: the digest of the topology that its faces belong to.
        domain: (F,) bool, the faces that were unwrapped with it.
        charts: the charts of the mesh, of the native module.
        index: of its own chart.
        measures: of this chart.
    """

    mesh: Identity
    topology: int
    domain: np.ndarray
    charts: Sequence[Any]
    index: int
    measures: _Measures

    @functools.cached_property
    def chart(self) -> Any:  # noqa: ANN401 - a record of the native module
        """The record of its chart, made on access: most islands of the list are never asked for theirs."""
        return self.charts[self.index]

    def is_one_of(self, polygons: PolygonMesh) -> bool:
        """Return whether a mesh, as it is now, has this island still; one that failed has no map to tell by."""
        if polygons.topology != self.topology:
            return False
        return not self.measures.is_solved or is_island(polygons, self.domain, self.chart.faces)


class _LastResult(Remembered):
    """The islands of the list, in its order; the reports of the last result, and the kinds of faces that cause them.

    Attributes:
        former: the map, (C, 2), of every mesh before the result, as it was read; None for none.
        is_left: whether undo or redo leaves other maps than these.
        is_undone: whether undo has led to these.
    """

    def __init__(self) -> None:
        self.islands: list[_Island] = []
        self.former: dict[Identity, np.ndarray | None] = {}
        self.is_left = False
        self.is_undone = False
        self.lines: list[tuple[str, str]] = []
        self.problem = ""
        self.selecting: tuple[str, ...] = ()


def _last() -> _LastResult:
    return session.of(_LastResult)


def show(
    edit_meshes: Sequence[EditMesh],
    solutions: Sequence[Solution],
    of_all: ChartsOfAll,
    reports: Sequence[tuple[str, str]],
    others_stay: bool = False,
    selecting: Sequence[str] = (),
) -> None:
    """Make these solutions, with the charts `of_all` and their reports as (level, text), the last result.

    With `others_stay` islands of other faces, which have not been unwrapped again, stay in the list. `selecting` are
    the kinds of faces that the reports warn of, as Select knows them.
    """
    _last().lines, _last().selecting, _last().problem = list(reports), tuple(selecting), ""
    if not others_stay:
        _last().former = {}
    for each in edit_meshes:
        _last().former[identity.of(each.mesh)] = each.polygons.uv
    _last().is_undone = False
    charts = [solution.charts for solution in solutions]
    others = []
    if others_stay:
        others = _others(edit_meshes, [edit_mesh.polygons.selected_faces for edit_mesh in edit_meshes])
    _fill([*others, *_islands_of(edit_meshes, charts, of_all)])


def update(edit_mesh: EditMesh, charts: Sequence[Any]) -> None:
    """Update islands of the list that were solved again, given their charts."""
    solved = np.zeros(len(edit_mesh.polygons.selected_faces), dtype=bool)
    for chart in charts:
        solved[chart.faces] = True
    others = _others([edit_mesh], [solved])
    if len(others) < len(_last().islands):
        _fill([*others, *_islands_of([edit_mesh], [charts], ChartsOfAll([charts]))])


def _islands_of(edit_meshes: Sequence[EditMesh], charts: Sequence[Sequence[Any]], of_all: ChartsOfAll) -> list[_Island]:
    """Return the worst islands of all these meshes, at most as many as the list shows."""
    columns = [of_all.solved, *map(of_all.column, _Measures._fields[1:])]
    worst = _worst_first(columns)
    starts = np.cumsum([0, *map(len, charts)])
    owners = np.searchsorted(starts, worst, side="right") - 1
    meshes = {k: identity.of(edit_meshes[k].mesh) for k in np.unique(owners).tolist()}
    measures = map(_Measures, *(column[worst].tolist() for column in columns))
    return [
        _Island(meshes[k], edit_meshes[k].polygons.topology, edit_meshes[k].polygons.selected_faces, charts[k], *rest)
        for k, *rest in zip(owners.tolist(), (worst - starts[owners]).tolist(), measures)
    ]


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
    measures = np.array([island.measures for island in islands], dtype=np.float64).reshape(-1, len(_Measures._fields))
    _last().islands = [islands[place] for place in _worst_first(measures.T).tolist()]
    _show_rows(_last().islands)


def _show_rows(islands: Sequence[_Island]) -> None:
    window_manager = bpy.context.window_manager
    rows = getattr(window_manager, names.ISLANDS_PROPERTY)
    rows.clear()
    for island in islands:
        rows.add().name = _text(island.measures)
    setattr(window_manager, names.ACTIVE_ISLAND_PROPERTY, -1)


def is_bad(index: int) -> bool:
    """Return whether an island of the list failed, or has flipped or overlapping faces."""
    measures = _last().islands[index].measures
    return not measures.is_solved or bool(measures.flipped or measures.overlapping)


def leave() -> None:
    """Before undo or redo: note whether the maps are other ones than before the result."""
    _last().is_left = not _has_former_maps()


def look_back() -> None:
    """After undo or redo: hide the result while the maps are those before it."""
    last = _last()
    is_undone = (last.is_left or last.is_undone) and _has_former_maps()
    if is_undone != last.is_undone:
        last.is_undone = is_undone
        _show_rows([] if is_undone else last.islands)


def _has_former_maps() -> bool:
    meshes = [(bpy.data.meshes.get(found.name), before) for found, before in _last().former.items()]
    return all(mesh is None or _has_map(mesh, before) for mesh, before in meshes)


def _has_map(mesh: bpy.types.Mesh, uv: np.ndarray | None) -> bool:
    """Return whether a mesh in any mode has this active UV map, (C, 2), or with None no map."""
    with out_of_edit_mode(mesh) as found:
        if uv is None or found.uv_layers.active is None:
            return uv is None and found.uv_layers.active is None
        return np.array_equal(compatibility.corner_uv(found), uv, equal_nan=True)


def lines() -> list[tuple[str, str]]:
    """Return the reports of the last result, and what has gone wrong since, as (level, text); none if it is undone."""
    if _last().is_undone:
        return []
    return [*_last().lines, *([("WARNING", _last().problem)] if _last().problem else [])]


def note(problem: str) -> None:
    """Show what has gone wrong since the last result; empty for nothing."""
    _last().problem = problem


def selecting() -> tuple[str, ...]:
    """Return the kinds of faces that the reports of the last result warn of, as Select knows them."""
    return () if _last().is_undone else _last().selecting


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
        edit_mesh = read_mesh(edit_object, Reading(all_visible=True))
        if not island.is_one_of(edit_mesh.polygons):
            break
        faces = np.zeros(len(edit_mesh.polygons.selected_faces), dtype=bool)
        faces[island.chart.faces] = True
        selection.select_island(context, edit_mesh.mesh, faces & edit_mesh.polygons.selected_faces)
        return
    note(translate(texts.ISLAND_GONE))


def _worst_first(measures: Sequence[np.ndarray]) -> np.ndarray:
    """Return the places of the worst islands: failed ones, those with flipped or overlapping faces, by worst face.

    `measures` are those of all, field by field, (number of islands,) each.
    """
    is_solved, n_faces, _, max_qc, flipped, overlapping = measures
    number = np.where(is_solved, flipped + overlapping, n_faces)
    return np.lexsort([np.where(is_solved, -max_qc, 0.0), -number, is_solved])[:_MAX_ROWS]


def _text(measures: _Measures) -> str:
    if not measures.is_solved:
        return translate("Not unwrapped   {n} f.").format(n=measures.n_faces)
    return texts.island_row(*measures[1:])
