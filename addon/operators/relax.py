# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that relaxes the existing map."""

import time

import bpy

from .. import names
from ..core.solve.options import Settings
from ..core.solve.relaxing import Relaxing, RelaxOptions
from ..core.words import texts
from ..core.words.translation import translate
from ..ui import settings
from ..unwrapping import relaxing, steps
from ..unwrapping.last_settings import settings_for
from .improving_view import Improvement, improve
from .job_operator import Job, JobOperator
from .property_kinds import choice, number, share, switch


class UV_OT_spectral_relax(JobOperator, bpy.types.Operator):
    """Lower the distortion of the active UV map, step by step in the view."""

    bl_idname = names.RELAX_OPERATOR
    bl_label = texts.RELAX_LABEL
    bl_description = (
        "Even out the existing UV map, without new flips or overlaps. Only selected faces move; "
        "UVs that they share with others stay. Without a selection, all visible faces move"
    )

    sizes: share("Angle to Area", "0 evens out angles only; 1 evens out angles and sizes", 0.5)
    # Not kept for the next call: the view sets it when it ends.
    steps: number(
        "Steps",
        "Maximum number of steps; it stops earlier if no step helps",
        200,
        (1, 500, None),
        options={"SKIP_SAVE"},
    )
    border: choice(
        "Border",
        "What the borders of islands do",
        (
            ("FREE", "Free", "Borders move, too"),
            (
                "SLIDING",
                "Sliding",
                "Vertices of borders move along them, so outlines stay; corners are held",
            ),
            ("HELD", "Held", "Borders stay where they are; only the inside moves"),
        ),
    )
    fold_free: switch(
        "No Overlaps",
        "First remove flipped faces and overlaps, as Unwrap does. Islands that are selected as a "
        "whole and have no pins are unwrapped anew if necessary",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        settings.draw_relax(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, relax and write, in a window step by step; report the outcome."""
        start = time.perf_counter()
        edit_meshes, all_visible = steps.read_selected_or_visible(
            context, Settings(correct_aspect=settings_for(self).correct_aspect)
        )
        if not edit_meshes:
            return self.canceled(translate(texts.NOTHING_SELECTED))
        edit_meshes = [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.uv is not None]
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        options = RelaxOptions(self.sizes, self.border.lower(), self.fold_free)
        meshes = [edit_mesh.polygons for edit_mesh in edit_meshes]
        improvement = Improvement(
            begin=lambda progress: Relaxing(meshes, options, progress),
            status=relaxing.status,
            steps=self.steps,
            max_steps=self.steps,
        )
        whole, found, is_stopped = yield from improve(edit_meshes, improvement, is_interactive)
        if whole is not None and not whole.can_move:
            self.report(
                {"WARNING"},
                translate("Nothing can move: all UVs of these faces are pinned, held or bound by a stored shape"),
            )
        if found is None:
            return {"CANCELLED"}
        if is_stopped:
            # So that Adjust Last Operation stops there, too.
            self.steps = found.steps
        self.report_all(relaxing.reports(context, edit_meshes, found, time.perf_counter() - start, all_visible))
        return {"FINISHED"}
