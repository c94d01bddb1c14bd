# SPDX-License-Identifier: GPL-3.0-or-later
"""The Spectral Unwrap operator."""

import time

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .. import names
from ..core import texts
from ..core.translation import translate
from ..extenders.strength import STRENGTH_LIMIT
from ..live import following
from ..ui import unwrap_settings
from ..unwrapping import island_list, steps
from ..unwrapping.last_settings import settings_of
from .job_operator import Job, JobOperator


class UV_OT_spectral_unwrap(JobOperator, bpy.types.Operator):
    """Unwrap the selected faces by Spectral Conformal Parameterization."""

    bl_idname = names.UNWRAP_OPERATOR
    bl_label = texts.UNWRAP_LABEL
    bl_description = texts.UNWRAP_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    method: EnumProperty(**texts.METHOD_PROPERTY, items=texts.METHOD_ITEMS)
    weights: EnumProperty(**texts.WEIGHTS_PROPERTY, items=texts.WEIGHTS_ITEMS)
    boundary: EnumProperty(**texts.BOUNDARY_PROPERTY, items=texts.BOUNDARY_ITEMS)
    placement: EnumProperty(**texts.PLACEMENT_PROPERTY, items=texts.PLACEMENT_ITEMS)
    turn_to_pack: BoolProperty(**texts.TURN_TO_PACK_PROPERTY)
    fill_holes: BoolProperty(**texts.FILL_HOLES_PROPERTY)
    hole_rigidity: FloatProperty(
        **texts.HOLE_RIGIDITY_PROPERTY,
        default=0.0,
        min=0.0,
        soft_max=10.0,
        max=STRENGTH_LIMIT,
    )
    automatic_holes: BoolProperty(**texts.AUTOMATIC_HOLES_PROPERTY, default=True)
    area_blend: FloatProperty(
        **texts.AREA_BLEND_PROPERTY,
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    fold_free: BoolProperty(**texts.FOLD_FREE_PROPERTY)
    polish: BoolProperty(**texts.POLISH_PROPERTY, default=True)
    stretch: FloatProperty(
        **texts.STRETCH_PROPERTY,
        default=1.0,
        min=0.01,
        soft_min=0.25,
        soft_max=4.0,
        max=100.0,
    )
    use_subsurf_data: BoolProperty(**texts.USE_SUBSURF_DATA_PROPERTY)
    soft_pins: BoolProperty(**texts.SOFT_PINS_PROPERTY)
    soft_pin_strength: FloatProperty(
        **texts.SOFT_PIN_STRENGTH_PROPERTY,
        default=100.0,
        min=1e-6,
        soft_min=1.0,
        max=STRENGTH_LIMIT,
        soft_max=STRENGTH_LIMIT,
    )
    correct_aspect: BoolProperty(**texts.CORRECT_ASPECT_PROPERTY, default=True)
    margin_method: EnumProperty(**texts.MARGIN_METHOD_PROPERTY, items=texts.MARGIN_METHOD_ITEMS)
    margin: FloatProperty(**texts.MARGIN_PROPERTY, default=0.001, min=0.0, max=1.0, precision=3, step=0.1)
    show_advanced: BoolProperty(**texts.SHOW_ADVANCED_PROPERTY)

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        unwrap_settings.draw_common(self.layout, self)
        row = self.layout.row()
        row.use_property_split = False
        row.prop(self, "show_advanced", icon="DOWNARROW_HLT" if self.show_advanced else "RIGHTARROW", emboss=False)
        if self.show_advanced:
            unwrap_settings.draw_advanced(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, solve, place, write and pack; report the outcome."""
        start = time.perf_counter()
        settings = settings_of(self)
        edit_meshes = steps.read(context, settings)
        if not edit_meshes:
            self.report({"WARNING"}, translate(texts.NOTHING_SELECTED))
            return {"CANCELLED"}
        read = edit_meshes
        done = yield lambda report_progress: steps.solve(read, settings, report_progress)
        if done.is_late:
            edit_meshes = steps.read_again(done.context, settings, edit_meshes)
            if edit_meshes is None:
                self.report({"WARNING"}, translate(texts.MESHES_CHANGED))
                return {"CANCELLED"}
        outcome = steps.write(done.context, settings, edit_meshes, done.result, following.not_following)
        reports = steps.reports(outcome, time.perf_counter() - start)
        island_list.show(edit_meshes, done.result, reports)
        for level, text in reports:
            self.report({level}, text)
        return {"FINISHED"} if outcome.summary.solved else {"CANCELLED"}
