# SPDX-License-Identifier: GPL-3.0-or-later
"""The Spectral Unwrap operator."""

import time

import bpy

from .. import names
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..live import following
from ..ui import unwrap_settings
from ..unwrapping import outcome, steps
from ..unwrapping.last_settings import settings_of
from .job_operator import Job, JobOperator
from .unwrap_properties import UnwrapProperties


class UV_OT_spectral_unwrap(UnwrapProperties, JobOperator, bpy.types.Operator):
    """Unwrap the selected faces by Spectral Conformal Parameterization."""

    bl_idname = names.UNWRAP_OPERATOR
    bl_label = texts.UNWRAP_LABEL
    bl_description = texts.UNWRAP_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        unwrap_settings.draw_common(self.layout, self)
        unwrap_settings.draw_fold(self.layout, self)
        if self.show_advanced:
            unwrap_settings.draw_advanced(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, solve, place, write and pack; report the outcome."""
        start = time.perf_counter()
        settings = settings_of(self)
        edit_meshes, all_visible = steps.read(context, settings), False
        # As Suggest Seams does. The UV editor without sync selection shows selected faces only.
        if not edit_meshes and not selection.selects_uvs(context):
            edit_meshes, all_visible = steps.read(context, settings, all_visible=True), True
        if not edit_meshes:
            self.report({"WARNING"}, translate(texts.NOTHING_SELECTED))
            return {"CANCELLED"}
        read = edit_meshes
        done = yield lambda report_progress: steps.solve(read, settings, report_progress)
        if done.is_late:
            edit_meshes = steps.read_again(done.context, settings, edit_meshes, all_visible)
            if edit_meshes is None:
                self.report({"WARNING"}, translate(texts.MESHES_CHANGED))
                return {"CANCELLED"}
        written = steps.write(settings, edit_meshes, done.result, following.not_following)
        result = outcome.finish(written, time.perf_counter() - start, all_visible)
        for level, text in result.reports:
            self.report({level}, text)
        return {"FINISHED"} if result.is_solved else {"CANCELLED"}
