# SPDX-License-Identifier: GPL-3.0-or-later
"""The Spectral Unwrap operator."""

import time

import bpy
from bpy.props import EnumProperty, FloatProperty

from .. import edit_mode_unwrap, names
from ..core import reporting, unwrapping
from ..core.native import NativeModuleError
from ..packing import PackingError


class UV_OT_spectral_unwrap(bpy.types.Operator):
    """Unwrap the selected faces by Spectral Conformal Parameterization."""

    bl_idname = names.UNWRAP_OPERATOR
    bl_label = names.UNWRAP_LABEL
    bl_description = names.UNWRAP_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(name="Method", description="Unwrapping method", items=names.METHOD_ITEMS)
    weights: EnumProperty(name="Weights", description="How much each triangle counts", items=names.WEIGHTS_ITEMS)
    boundary: EnumProperty(
        name="Boundary", description="How much each boundary vertex counts", items=names.BOUNDARY_ITEMS
    )
    placement: EnumProperty(name="Placement", description="Where the unwrapped islands go", items=names.PLACEMENT_ITEMS)
    margin: FloatProperty(
        name="Margin", description="Space between islands", default=0.001, min=0.0, max=1.0, precision=3, step=0.1
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "method")
        layout.prop(self, "weights")
        row = layout.row()
        row.active = self.method == "SPECTRAL"
        row.prop(self, "boundary")
        layout.separator()
        layout.prop(self, "placement")
        row = layout.row()
        row.active = self.placement == names.PACK
        row.prop(self, "margin")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Unwrap with the operator's settings and report the result."""
        start = time.perf_counter()
        try:
            outcome = edit_mode_unwrap.unwrap(context, self._settings())
        except (NativeModuleError, PackingError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._report(outcome, time.perf_counter() - start)

    def _settings(self) -> edit_mode_unwrap.Settings:
        return edit_mode_unwrap.Settings(
            unwrapping.Options(self.method.lower(), self.weights.lower(), self.boundary.lower()),
            keep_in_place=self.placement == names.KEEP,
            margin=self.margin,
        )

    def _report(self, outcome: edit_mode_unwrap.Outcome | None, seconds: float) -> set[str]:
        """Tell the user what was done in `seconds`; return the operator's status."""
        if outcome is None:
            self.report({"WARNING"}, "Nothing selected; select the faces to unwrap, in the UV editor their UVs")
            return {"CANCELLED"}
        summary = outcome.summary
        # Blender shows the last report in the status bar, all of them in the Info editor.
        reports = (
            ("INFO", reporting.remedies(summary)),
            ("INFO", reporting.information(summary, seconds) if summary.solved else ""),
            ("WARNING", reporting.without_bounds(outcome.without_bounds)),
            ("WARNING", reporting.failures(summary)),
        )
        for level, text in reports:
            if text:
                self.report({level}, text)
        return {"FINISHED"} if summary.solved else {"CANCELLED"}
