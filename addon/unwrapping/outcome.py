# SPDX-License-Identifier: GPL-3.0-or-later
"""The outcome of an unwrap: remembered, listed by island, and reported."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import bpy

from ..core import choices
from ..core.measure.summary import Strain, Unevenness, strain, summarize, unevenness
from ..core.mesh.world_scale import is_uneven
from ..core.solve.in_place import count_covered, count_new_flips, count_parts
from ..core.solve.options import Settings
from ..core.solve.solution import Solution, charts_of
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh
from . import island_list, last_result, packing, parts, result_numbers
from .relaxing import newly_covering
from .steps import Solved


@dataclass(frozen=True)
class Outcome:
    """What has come of an unwrap.

    Attributes:
        is_solved: whether any island was solved.
        reports: to the user, as (level, text) pairs. Blender shows the last one in the status bar, all in the Info
            editor: reports that ask for something come last.
        contradicting: the edges of each mesh whose constraints contradict each other, by their vertices.
    """

    is_solved: bool
    reports: Sequence[tuple[str, str]]
    contradicting: Mapping[bpy.types.Mesh, Sequence[tuple[int, int]]] = field(default_factory=dict)


def finish(
    settings: Settings,
    edit_meshes: Sequence[EditMesh],
    solved: Solved,
    seconds: float,
    all_visible: bool = False,
    others_stay: bool = False,
) -> Outcome:
    """Remember a written unwrap, list its islands, and return its reports.

    Args:
        settings: of the unwrap.
        edit_meshes: what was unwrapped.
        solved: what was written.
        seconds: the time that the unwrap took.
        all_visible: whether all visible faces were unwrapped because none was selected.
        others_stay: whether islands of other faces stay in the list.
    """
    meshes, (solutions, placement) = [edit_mesh.polygons for edit_mesh in edit_meshes], solved
    charts = charts_of(solutions)
    summary = summarize(solutions, [edit_mesh.edit_object.name for edit_mesh in edit_meshes], charts)
    in_place = count_parts(meshes, solutions)
    strained, uneven = Strain(0, 1.0), Unevenness(0, 0.0)
    # Stretching on request strains all islands.
    if settings.options.stretch == 1.0:
        strained, uneven = strain(meshes, solutions, charts), unevenness(charts)
    too_small = sum(solution.too_small_faces for solution in solutions)
    lacks_edge = settings.options.stretch != 1.0 and all(mesh.stretch_direction is None for mesh in meshes)
    lacks_subsurf = settings.use_subsurf and all(edit_mesh.subdivision is None for edit_mesh in edit_meshes)
    broken = [name for each in edit_meshes for name in each.broken_extenders]
    # Packed islands lie apart.
    stays = settings.keep_in_place or in_place.solved > 0
    covering = newly_covering(bpy.context, edit_meshes) if stays and not others_stay else 0
    pairs = (
        ("INFO", translate("Nothing was selected, so all visible faces were used") if all_visible else ""),
        ("INFO", texts.repairs(summary)),
        ("INFO", texts.unfolded(summary)),
        ("INFO", texts.in_place(in_place.solved, in_place.held)),
        ("INFO", texts.pinned(summary) if sum(summary.pinned.values()) > in_place.solved else ""),
        ("INFO", texts.information(summary, seconds, placement.fill, placement.stacked) if summary.solved else ""),
        ("INFO", _average_density(edit_meshes, settings, solutions)),
        ("INFO", _object_scale(edit_meshes)),
        (
            "INFO",
            translate("Subdivision Surface modifier needs to be first to work with unwrap") if lacks_subsurf else "",
        ),
        ("WARNING", texts.counted(len(broken), texts.BROKEN_EXTENDERS, names=", ".join(broken))),
        ("WARNING", texts.counted(too_small, texts.TOO_SMALL)),
        ("WARNING", texts.counted(sum(solution.unused_extenders for solution in solutions), texts.UNUSED_EXTENDERS)),
        (
            "WARNING",
            translate("Nothing was stretched: no edge is active; click the edge to stretch along")
            if lacks_edge
            else "",
        ),
        (
            "WARNING",
            translate("Islands that stay leave too little room in the UV tile, so the others were packed beside it")
            if placement.left_tile
            else "",
        ),
        ("WARNING", texts.counted(in_place.without_free, texts.NOTHING_FREE)),
        (
            "WARNING",
            texts.counted(
                count_new_flips(meshes, solutions, placement.uv) if settings.blend != (1.0, 1.0) else 0,
                texts.FLIPPED_BY_BLENDING,
            ),
        ),
        (
            "WARNING",
            texts.counted(
                count_covered(meshes, solutions, placement.uv) if in_place.solved else 0, texts.COVERED_BY_PARTS
            ),
        ),
        ("WARNING", texts.newly_covering(covering)),
        ("WARNING", texts.counted(placement.without_bounds, texts.WITHOUT_BOUNDS)),
        # Faces that are too small for a UV are the stronger case of the same, with the same help.
        ("WARNING", "" if too_small else texts.uneven(uneven)),
        ("WARNING", texts.strained(strained)),
        ("WARNING", texts.failures(summary)),
    )
    reports = [(level, text) for level, text in pairs if text]
    last_result.remember(edit_meshes, solutions)
    result_numbers.store(
        "unwrap",
        seconds=seconds,
        solved=summary.solved,
        failed=summary.failed,
        mean_qc=summary.mean_qc,
        max_qc=summary.max_qc,
        flipped=summary.flipped,
        overlapping=summary.overlapping,
        fill=placement.fill,
    )
    if summary.solved:
        parts.remember(edit_meshes, solutions)
        if placement.fill is not None:
            packing.note_fill(placement.fill)
    selecting = [
        kind
        for kind, is_warned_of in (
            (choices.SELECT_STRETCHED, strained.faces > 0),
            (choices.SELECT_FAILED, summary.failed > 0),
        )
        if is_warned_of
    ]
    island_list.show(edit_meshes, solutions, charts, reports, others_stay, selecting)
    contradicting = {each.mesh: solution.contradicting_edges() for each, solution in zip(edit_meshes, solutions)}
    return Outcome(summary.solved > 0, reports, {mesh: edges for mesh, edges in contradicting.items() if edges})


def _average_density(edit_meshes: Sequence[EditMesh], settings: Settings, solutions: Sequence[Solution]) -> str:
    """Return the note on unevenly scaled objects whose islands were scaled to those of others."""
    if settings.keep_in_place or sum(len(solution.charts) for solution in solutions) < 2:
        return ""
    uneven = [each.edit_object.name for each in edit_meshes if is_uneven(each.polygons.world_metric)]
    return texts.average_density(uneven)


def _object_scale(edit_meshes: Sequence[EditMesh]) -> str:
    """Return what Blender's own Unwrap would report about the scale of the objects."""
    worlds = [edit_mesh.edit_object.matrix_world for edit_mesh in edit_meshes]
    scales = [tuple(world.to_3x3().col[axis].length for axis in range(3)) for world in worlds]
    return texts.object_scale(scales, [world.is_negative for world in worlds])
