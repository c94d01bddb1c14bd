# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that unwrap: Spectral Unwrap, and Unwrap in Place."""

import time
from dataclasses import replace

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .. import names
from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh
from ..live import following
from ..ui import settings_layout, unwrap_settings
from ..unwrapping import outcome, steps
from ..unwrapping.last_settings import last_settings, settings_of
from .job_operator import Job, JobOperator
from .unwrap_properties import UnwrapProperties


class _UnwrapJob(JobOperator):
    """Unwraps the selected faces."""

    def settings(self) -> Settings:
        """Return the settings that the operator's properties stand for."""
        return settings_of(self)

    def read(self, context: bpy.types.Context, settings: Settings) -> tuple[list[EditMesh], bool]:
        """Read the meshes to unwrap, and whether all visible faces are unwrapped because none is selected."""
        return steps.read_selected_or_visible(context, settings, settings.in_place)

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        unwrap_settings.draw_common(self.layout, self)
        unwrap_settings.draw_fold(self.layout, self)
        if self.show_advanced:
            unwrap_settings.draw_advanced(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, solve, place and write; report the outcome."""
        start = time.perf_counter()
        settings = self.settings()
        edit_meshes, all_visible = self.read(context, settings)
        if not edit_meshes:
            return self.canceled(translate(texts.NOTHING_SELECTED))
        read, beside = edit_meshes, steps.read_beside(context, settings, edit_meshes)
        done = yield lambda report_progress: steps.solve_and_place(read, settings, report_progress, beside)
        if done.is_late:
            edit_meshes = steps.read_again(done.context, settings, edit_meshes, all_visible, settings.in_place)
            if edit_meshes is None:
                return self.canceled(translate(texts.MESHES_CHANGED))
        with following.not_following():
            steps.write(edit_meshes, done.result)
            result = outcome.finish(settings, edit_meshes, done.result, time.perf_counter() - start, all_visible)
        self.report_all(result.reports)
        return {"FINISHED"} if result.is_solved else {"CANCELLED"}


class UV_OT_spectral_unwrap(UnwrapProperties, _UnwrapJob, bpy.types.Operator):
    """Unwrap the selected faces by Spectral Conformal Parameterization."""

    bl_idname = names.UNWRAP_OPERATOR
    bl_label = texts.UNWRAP_LABEL
    bl_description = texts.UNWRAP_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "PRESET"}


class UV_OT_spectral_unwrap_in_place(_UnwrapJob, bpy.types.Operator):
    """Unwrap the selected faces again where they lie, with the rest of their islands held."""

    bl_idname = names.UNWRAP_IN_PLACE_OPERATOR
    bl_label = texts.UNWRAP_IN_PLACE_LABEL
    bl_description = texts.UNWRAP_IN_PLACE_DESCRIPTION

    coordinates: EnumProperty(**texts.COORDINATES_PROPERTY, items=texts.COORDINATES_ITEMS)
    blend: FloatProperty(**texts.BLEND_PROPERTY, default=1.0, min=0.0, max=1.0, subtype="FACTOR")
    fold_free: BoolProperty(**texts.FOLD_FREE_PROPERTY)

    def settings(self) -> Settings:
        """Return the last settings of Spectral Unwrap, with the rest held and every island where it is."""
        last = last_settings()
        return replace(
            last,
            options=replace(last.options, fold_free=self.fold_free or last.options.fold_free),
            keep_in_place=True,
            in_place=True,
            amount=tuple(0.0 if self.coordinates == other else self.blend for other in ("V", "U")),
        )

    def read(self, context: bpy.types.Context, settings: Settings) -> tuple[list[EditMesh], bool]:
        """Read the meshes with selected faces."""
        return steps.read(context, settings, in_place=True), False

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        settings_layout.draw(self.layout, self, ("coordinates", "blend", "fold_free"))
