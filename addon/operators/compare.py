# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that unwraps the same faces by several methods and shows what came out."""

import time
from collections.abc import Sequence

import bpy

from .. import names
from ..core import texts
from ..core.progress import Progress, part
from ..core.translation import translate
from ..live import following
from ..overlay.comparison import ComparisonView
from ..ui import progress
from ..unwrapping import comparison, steps
from ..unwrapping.comparison import Candidate, Tried
from ..unwrapping.last_settings import last_settings
from .job_operator import Job, JobOperator, Work

_CLOSE = {"ESC", "RIGHTMOUSE", "LEFTMOUSE", "RET", "NUMPAD_ENTER"}


class UV_OT_spectral_compare(JobOperator, bpy.types.Operator):
    """Unwrap by this and by Blender's own methods, and show the maps side by side; the UVs stay as they are."""

    bl_idname = names.COMPARE_OPERATOR
    bl_label = texts.COMPARE_LABEL
    bl_description = texts.COMPARE_DESCRIPTION
    bl_options = {"REGISTER"}

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Solve in a thread, then let Blender unwrap by one method after the other, measuring each, and show it."""
        settings, start = last_settings(), time.perf_counter()
        edit_meshes = steps.read(context, settings)
        if not edit_meshes:
            self.report({"WARNING"}, translate(texts.NOTHING_SELECTED))
            return {"CANCELLED"}
        methods, read, found = comparison.methods(), edit_meshes, []
        stages = len(methods) + 1
        done = yield lambda report_progress: steps.solve(read, settings, part(report_progress, 0.0, 1.0 / stages))
        solutions, seconds = done.result, time.perf_counter() - start
        for index, method in enumerate(methods):
            if done.is_late:
                edit_meshes = steps.read_again(done.context, settings, edit_meshes)
                if edit_meshes is None:
                    self.report({"WARNING"}, translate(texts.MESHES_CHANGED))
                    return {"CANCELLED"}
            if method == texts.OURS:
                tried = comparison.ours(settings, edit_meshes, solutions, seconds, following.not_following)
            else:
                tried = comparison.theirs(done.context, settings, edit_meshes, method, following.not_following)
            # While it is measured the window lives, says what comes next, and can cancel.
            coming = next(iter(methods[index + 1 :]), "")
            done = yield _measuring(tried, (index + 1) / stages, coming)
            found.append(done.result)
        comparison.remember(found)
        best = comparison.best(found)
        if best is None:
            self.report({"WARNING"}, translate(texts.NOT_COMPARED))
            return {"CANCELLED"}
        self.report({"INFO"}, texts.compared(texts.COMPARED_METHODS[best.method], len(found)))
        area = done.context.area
        if is_interactive and area is not None and area.type in {"VIEW_3D", "IMAGE_EDITOR"}:
            yield _Shown(found, found.index(best), area)
        return {"FINISHED"}


def _measuring(tried: Tried, fraction: float, coming: str) -> Work:
    """Return the work of measuring a map, when that `fraction` of all is done and the method `coming` is next."""
    phase = translate(texts.COMPARED_METHODS[coming]) if coming else ""

    def work(report_progress: Progress) -> Candidate:
        report_progress(fraction, phase)
        return comparison.measured(tried)

    return work


class _Shown:
    """Shows the comparison until it is closed; a `job_operator.Choice` without an answer."""

    answer = None

    def __init__(self, found: Sequence[Candidate], best: int, area: bpy.types.Area) -> None:
        rows = [texts.comparison_row(texts.COMPARED_METHODS[each.method], each.numbers, each.seconds) for each in found]
        self._view = ComparisonView(rows, best, [each.views for each in found])
        self._area = area

    def begin(self, context: bpy.types.Context) -> None:
        """Draw it."""
        self._view.show(self._area)
        progress.show_status(context, translate(texts.COMPARISON_KEYS))

    def handle(self, _context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """End it by Esc, Enter or a click."""
        return {"FINISHED"} if event.type in _CLOSE and event.value == "PRESS" else {"PASS_THROUGH"}

    def update(self, context: bpy.types.Context) -> None:
        """Nothing changes."""

    def end(self, context: bpy.types.Context) -> None:
        """Draw nothing any more."""
        self._view.remove()
        progress.clear_status(context)
