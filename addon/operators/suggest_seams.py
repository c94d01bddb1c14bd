# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that marks the seams that lower the distortion most, and unwraps."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import names, session
from ..core.measure.summary import summarize
from ..core.seams.suggestion import Options, Preferences, Search, Suggestion
from ..core.solve.progress import Progress
from ..core.solve.solution import Solution, solve_all
from ..core.words import texts
from ..core.words.translation import translate
from ..live import following
from ..session import Remembered
from ..unwrapping import outcome, seams, steps
from ..unwrapping.last_settings import last_settings
from ..unwrapping.seams import Target
from .job_operator import Done, Job, JobOperator
from .seam_preview import SeamPreview, length_text


class Searched(Remembered):
    """The last search, so that Adjust Last Operation need not repeat it."""

    def __init__(self) -> None:
        """Begin without an answer."""
        self.search = Search()


class UV_OT_spectral_suggest_seams(JobOperator, bpy.types.Operator):
    """Preview and mark the seams that lower the distortion most, and unwrap."""

    bl_idname = names.SUGGEST_SEAMS_OPERATOR
    bl_label = texts.SUGGEST_SEAMS_LABEL
    bl_description = texts.SUGGEST_SEAMS_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    size_variation: FloatProperty(
        **texts.SIZE_VARIATION_PROPERTY,
        default=2.0,
        min=1.01,
        soft_max=8.0,
        max=1e3,
    )
    angle_distortion: FloatProperty(
        **texts.ANGLE_DISTORTION_PROPERTY,
        default=1.1,
        min=1.001,
        soft_max=2.0,
        max=1e3,
        precision=3,
        step=1,
    )
    max_length: FloatProperty(
        **texts.MAX_LENGTH_PROPERTY,
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    keep_front: FloatProperty(
        **texts.FRONT_PROPERTY,
        default=0.5,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    seam_group: StringProperty(
        **texts.SEAM_GROUP_PROPERTY,
        default="",
    )
    seam_group_use: EnumProperty(
        **texts.SEAM_GROUP_USE_PROPERTY,
        items=texts.SEAM_GROUP_USES,
        default="AVOID",
    )
    cuts: IntProperty(
        **texts.CUTS_PROPERTY,
        default=0,
        min=0,
        options={"SKIP_SAVE"},
    )
    unwrap: BoolProperty(
        **texts.UNWRAP_PROPERTY,
        default=True,
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("size_variation", "angle_distortion", "max_length", "keep_front"):
            layout.prop(self, name)
        layout.prop_search(self, "seam_group", context.edit_object, "vertex_groups")
        if self.seam_group:
            layout.prop(self, "seam_group_use")
        for name in ("cuts", "unwrap"):
            layout.prop(self, name)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Search, let the artist choose how many cuts to take, solve with them, mark and write."""
        target = seams.read(context, last_settings())
        if target is None:
            self.report({"WARNING"}, translate(texts.NO_VISIBLE_FACES))
            return {"CANCELLED"}
        options = self._options(target)
        preferences = ()
        if self.seam_group:
            preferences = seams.read_preferences(target, self.seam_group, self.seam_group_use == "PREFER")
        found = (yield lambda report_progress: _find(target, options, preferences, report_progress)).result
        if not found.suggestion.cuts:
            return self._report_nothing(target, found)
        total = len(found.suggestion.cuts)
        count = min(self.cuts or total, total)
        done = None
        if is_interactive:
            done = yield SeamPreview(target, found.suggestion, count, self.size_variation)
            context, count = done.context, done.result
            self.cuts = 0 if count == total else count
        cuts = found.suggestion.part(0, count)
        start, solutions = time.perf_counter(), None
        if self.unwrap:
            target = self._current(context, target, done)
            if target is None:
                return {"CANCELLED"}
            settings, cut_open = target.settings, seams.read_cut_open(context, target, cuts)
            done = yield lambda report_progress: steps.solve(cut_open, settings, report_progress)
            context, solutions = done.context, done.result
        target = self._current(context, target, done)
        if target is None:
            return {"CANCELLED"}
        return self._write(context, target, cuts, solutions, start)

    def _current(self, context: bpy.types.Context, target: Target, done: Done | None) -> Target | None:
        """Return the current target; None, with a report, if it has changed meanwhile."""
        if done is None or not done.is_late:
            return target
        current = seams.read_again(context, target)
        if current is None:
            self.report({"WARNING"}, translate(texts.MESHES_CHANGED_UNMARKED))
        return current

    def _write(
        self,
        context: bpy.types.Context,
        target: Target,
        cuts: Suggestion,
        solutions: list[Solution] | None,
        start: float,
    ) -> set[str]:
        """Mark the cuts, write the unwrap that began at `start`, if there is one, and report both.

        Raises:
            MarginError: the margin is not finite; nothing changed.
        """
        written = None
        if solutions is None:
            seams.mark(target, cuts)
        else:
            written = seams.write(context, target, cuts, solutions, following.not_following)
        self.report({"INFO"}, texts.marked(len(cuts.cuts), length_text(context, cuts.length)))
        self._report_refused(target, cuts)
        if written is not None:
            for level, text in outcome.finish(written, time.perf_counter() - start).reports:
                self.report({level}, text)
        return {"FINISHED"}

    def _options(self, target: Target) -> Options:
        options = target.settings.options
        # At 1, edges of faces toward the front count as seven times as long.
        front = (0.0, -6.0 * self.keep_front, 0.0) if self.keep_front else None
        return Options(
            self.size_variation,
            self.angle_distortion,
            self.max_length or None,
            options.weights,
            options.boundary,
            front,
        )

    def _report_nothing(self, target: Target, found: "_Found") -> set[str]:
        if not all(found.suggestion.errors):
            self.report({"INFO"}, texts.nothing_to_suggest(self.max_length > 0.0))
        self._report_refused(target, found.suggestion)
        failures = texts.failures(summarize(found.uncut, target.names))
        if failures:
            self.report({"WARNING"}, failures)
        return {"CANCELLED"}

    def _report_refused(self, target: Target, suggestion: Suggestion) -> None:
        refused = texts.without_suggestion(suggestion.errors, target.names)
        if refused:
            self.report({"WARNING"}, refused)


@dataclass(frozen=True)
class _Found:
    """A suggestion; without cuts also the solutions of the meshes, for what cannot be unwrapped."""

    suggestion: Suggestion
    uncut: Sequence[Solution] = ()


def _find(target: Target, options: Options, preferences: Preferences, report_progress: Progress) -> _Found:
    """Search for cuts; any thread may call this."""
    suggestion = session.of(Searched).search.suggest(target.polygons, options, report_progress, preferences)
    if suggestion.cuts:
        return _Found(suggestion)
    return _Found(suggestion, solve_all(target.polygons, target.settings.options, report_progress))
