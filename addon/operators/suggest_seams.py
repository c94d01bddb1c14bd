# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that marks the seams that lower the distortion most, and unwraps."""

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import bpy
from bpy.props import StringProperty

from .. import names, session
from ..core import choices
from ..core.measure.summary import summarize
from ..core.seams.suggestion import Options, Search, Suggestion
from ..core.solve.solution import solve_all
from ..core.words import texts
from ..core.words.percent import percent_of_qc, qc_of_percent
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh, unchanged
from ..live import following
from ..session import Remembered
from ..ui import settings as settings_layout
from ..unwrapping import outcome, result_numbers, seams, steps
from ..unwrapping.last_settings import settings_for
from ..unwrapping.seams import Target
from ..unwrapping.steps import Solved
from .job_operator import Done, Job, JobOperator, Work
from .property_kinds import choice, number, share, switch
from .seam_preview import SeamPreview, Sidebar, length_text


class Searched(Remembered):
    """The last search, so that Adjust Last Operation need not repeat it."""

    def __init__(self) -> None:
        """Begin without an answer."""
        self.search = Search()


class UV_OT_spectral_suggest_seams(JobOperator, bpy.types.Operator):
    """Preview and mark the seams that lower the distortion most, and unwrap."""

    bl_idname = names.SUGGEST_SEAMS_OPERATOR
    bl_label = texts.SUGGEST_SEAMS_LABEL
    bl_description = (
        "Mark the seams that lower distortion most and open closed meshes, on the selected faces or, without a "
        "selection, on all visible ones; then unwrap"
    )

    style: choice("Style", "What kind of seams are wanted", texts.SEAM_STYLES)
    sharp_angle: number(
        "Sharp Angle",
        "Edges become seams where the surface bends by at least this angle",
        math.radians(30.0),
        (0.0, math.pi),
        subtype="ANGLE",
    )
    scale_limit: number(
        "Size Variation",
        "Size differences allowed on 95 % of the surface, as a factor; higher needs fewer seams",
        Options().scale_limit,
        (1.01, 8.0, 1e3),
    )
    angle_distortion: number(
        "Angle Distortion",
        "Stretching allowed; higher needs fewer seams. 0 keeps all angles, 10 lets them be off by 10 % on average",
        percent_of_qc(Options().qc_limit),
        (0.1, 100.0, 1e5),
        subtype="PERCENTAGE",
    )
    max_length: number(
        "Maximum Length",
        "Limit on the total length of new seams of a mesh, ignoring the object's scale; 0 for no limit. Cuts that "
        "open closed islands and handles are always made",
        0.0,
        (0.0, None),
        subtype="DISTANCE",
    )
    longest_side: number(
        "Longest Side",
        "Islands that are longer than this many times the side of a square with the surface's area are parted, so "
        "that a strip does not shrink the whole map",
        Options().longest_side,
        (0.5, 1.0, 10.0, 1e6),
    )
    keep_front: share(
        "Keep Front Clear",
        "How far seams keep away from faces toward the front (the object's -Y); 0 treats all sides alike",
        0.5,
    )
    seam_group: StringProperty(
        name="Vertex Group", description="Vertex group whose painted weights attract seams or keep them away"
    )
    seam_group_use: choice(
        "Group Effect",
        "Whether the weights attract seams or keep them away",
        (
            ("AVOID", "No Seams Here", "Seams avoid high weights"),
            ("PREFER", "Seams Here", "Seams prefer high weights"),
        ),
    )
    cuts: number(
        "Cuts", "Number of suggested cuts to mark, most useful first; 0 for all", 0, (0, None), options={"SKIP_SAVE"}
    )
    unwrap: switch(
        texts.UNWRAP_TOO_LABEL, "Afterward, unwrap the faces with the last settings of Spectral Unwrap", True
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        settings_layout.draw_seams(context, self.layout, self)
        if self.style != choices.SEAMS_BY_ANGLE:
            self.layout.prop(self, "cuts")
        self.layout.prop(self, "unwrap")

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Search, let the artist choose how many cuts to take, solve with them, mark and write."""
        target = seams.read(context, settings_for(self))
        if target is None:
            return self.canceled(translate("No visible faces to cut"))

        def search() -> Work:
            return partial(session.of(Searched).search.suggest, target.polygons, _question(self, target))

        suggestion = (yield search()).result
        # If an angle finds nothing, the artist may choose a lower one.
        may_change = is_interactive and self.style == choices.SEAMS_BY_ANGLE
        if suggestion.is_empty and not may_change:
            return (yield from self._report_nothing(target, suggestion))
        total = len(suggestion.cuts)
        count = min(self.cuts or total, total)
        done = None
        if is_interactive:
            done = yield SeamPreview(target, suggestion, count, Sidebar(self, search))
            suggestion, count = done.result
            if suggestion.is_empty:
                return (yield from self._report_nothing(target, suggestion))
            self.cuts = 0 if count == len(suggestion.cuts) else count
        cuts = suggestion.part(0, count)
        start, cut_open, solved = time.perf_counter(), [], None
        if self.unwrap:
            if suggestion.is_hard:
                target = _straightened(target)
                # So that the next Unwrap keeps them, and the artist sees why they are straight.
                settings_layout.last(names.UNWRAP_OPERATOR).straighten |= is_interactive
            if self._has_changed(target, done):
                return {"CANCELLED"}
            cut_open = seams.read_cut_open(target, cuts)
            done = yield lambda progress: steps.solve_and_place(cut_open, target.settings, progress, target.beside)
            solved = done.result
        if self._has_changed(target, done):
            return {"CANCELLED"}
        return self._write(target, cuts, cut_open, solved, start)

    def _has_changed(self, target: Target, done: Done | None) -> bool:
        """Return whether the target has changed meanwhile, with a report."""
        has_changed = done is not None and done.is_late and not unchanged(target.edit_meshes)
        if has_changed:
            self.canceled(translate("The meshes changed meanwhile, so nothing was marked; suggest seams again"))
        return has_changed

    def _write(
        self, target: Target, cuts: Suggestion, cut_open: Sequence[EditMesh], solved: Solved | None, start: float
    ) -> set[str]:
        """Mark the cuts, write the unwrap that began at `start`, if there is one, and report both."""
        of_unwrap, numbers = (), {}
        if solved is None:
            seams.mark(target, cuts)
        else:
            with following.not_following():
                seams.write(target, cuts, cut_open, solved)
                of_unwrap = outcome.finish(target.settings, cut_open, solved, time.perf_counter() - start).reports
            numbers = result_numbers.stored()
        numbers.update(seconds=time.perf_counter() - start, cuts=len(cuts.fixed) + len(cuts.cuts), length=cuts.length)
        result_numbers.store("suggest_seams", **numbers)
        length = length_text(bpy.context, cuts.length)
        reports = [("INFO", texts.marked(len(cuts.cuts), sum(len(cut.edges) for cut in cuts.fixed), length))]
        reports.append(("WARNING", texts.without_suggestion(cuts.errors, target.names)))
        reports.append(("WARNING", texts.counted(cuts.refused_hints, texts.REFUSED_HINTS)))
        reports.append(("INFO", texts.found_style(cuts.styles)))
        # Blender shows the last report in the status bar: warnings come last.
        self.report_all(sorted([*reports, *of_unwrap], key=lambda report: report[0] == "WARNING"))
        return {"FINISHED"}

    def _report_nothing(self, target: Target, suggestion: Suggestion) -> Job:
        """Report that there are no seams, and why islands cannot be unwrapped."""
        if not all(suggestion.errors):
            self.report({"INFO"}, texts.nothing_to_suggest(self.style, self.max_length > 0.0))
        refused = texts.without_suggestion(suggestion.errors, target.names)
        if refused:
            self.report({"WARNING"}, refused)
        options = target.settings.options
        uncut = (yield lambda report_progress: solve_all(target.polygons, options, report_progress)).result
        failures = texts.failures(summarize(uncut, target.names))
        if failures:
            self.report({"WARNING"}, failures)
        return {"CANCELLED"}


def _straightened(target: Target) -> Target:
    """Return the target with borders straightened in the unwrap afterward."""
    settings = target.settings
    return replace(target, settings=replace(settings, options=replace(settings.options, straighten=True)))


def _question(chosen: Any, target: Target) -> Options:  # noqa: ANN401 - the operator
    """Return what to search for with the operator's properties; reads from Blender."""
    options = target.settings.options
    # At 1, edges of faces toward the front count as seven times as long.
    front = (0.0, -6.0 * chosen.keep_front, 0.0) if chosen.keep_front else None
    return Options(
        chosen.scale_limit,
        qc_of_percent(chosen.angle_distortion),
        chosen.max_length or None,
        options.weights,
        options.boundary,
        options.area_blend,
        front,
        style=chosen.style.lower(),
        longest_side=chosen.longest_side,
        sharp_angle=chosen.sharp_angle if chosen.style == choices.SEAMS_BY_ANGLE else 0.0,
        wishes=seams.read_wishes(target, chosen.seam_group, chosen.seam_group_use == "PREFER"),
    )
