# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that unwraps."""

import time

import bpy

from .. import names
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import unchanged
from ..live import following
from ..ui import settings as settings_layout
from ..unwrapping import outcome, steps
from ..unwrapping.last_settings import settings_of
from .job_operator import Job, JobOperator
from .property_kinds import numbers
from .unwrap_properties import PackingProperties, UnwrapProperties


class UV_OT_spectral_unwrap(UnwrapProperties, PackingProperties, JobOperator, bpy.types.Operator):
    """Unwrap the selected faces by Spectral Conformal Parameterization."""

    bl_idname = names.UNWRAP_OPERATOR
    bl_label = texts.UNWRAP_LABEL
    bl_description = "Unwrap the selected faces with low angle distortion; no pins are needed"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    # Not kept for the next call, which begins with the whole map.
    blend: numbers(
        "Blend",
        "How far U and V go from the map as it was, 0, to the unwrapped one, 1; at 0 for one of them, the other has "
        "the least distortion beside it",
        (1.0, 1.0),
        min=0.0,
        max=1.0,
        options={"SKIP_SAVE"},
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        settings_layout.draw_unwrap(self.layout, self)
        if self.keep_in_place:
            column = self.layout.column(align=True)
            column.prop(self, "blend", index=0, text="Blend U")
            column.prop(self, "blend", index=1, text="Blend V")
        else:
            settings_layout.draw(self.layout, self, ("margin", "texture_size", "rotation"))
        settings_layout.draw_fold(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, solve, place and write; report the outcome."""
        start = time.perf_counter()
        margin, side = self.pixels(context)
        settings = settings_of(self, margin / side, self.turns(context))
        edit_meshes, all_visible = steps.read_selected_or_visible(context, settings, settings.hold_rest)
        if not edit_meshes:
            return self.canceled(translate(texts.NOTHING_SELECTED))
        beside = steps.read_beside(context, settings, edit_meshes)
        done = yield lambda report_progress: steps.solve_and_place(edit_meshes, settings, report_progress, beside)
        if done.is_late and not unchanged(edit_meshes):
            return self.canceled(translate("The meshes changed during the solve, so nothing was written; unwrap again"))
        with following.not_following():
            steps.write(edit_meshes, done.result)
            result = outcome.finish(settings, edit_meshes, done.result, time.perf_counter() - start, all_visible)
        self.report_all(result.reports)
        return {"FINISHED"} if result.is_solved else {"CANCELLED"}
