# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that fits the colors of the overlay to the shown maps."""

import bpy

from .. import names
from ..core.words import texts
from ..overlay import map_overlay
from .reporting_operator import ReportingOperator


class UV_OT_spectral_fit_range(ReportingOperator, bpy.types.Operator):
    """Make the range of most of the surface of the shown maps the custom range."""

    bl_idname = names.FIT_RANGE_OPERATOR
    bl_label = texts.FIT_RANGE_LABEL
    bl_description = texts.FIT_RANGE_DESCRIPTION
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the overlay shows maps."""
        return context.mode in {"EDIT_MESH", "OBJECT"} and map_overlay.is_on()

    def run(self, context: bpy.types.Context) -> set[str]:
        """Set the range; it stays while the maps change."""
        map_overlay.settings().use_range = True
        map_overlay.set_range(map_overlay.automatic(context))
        return {"FINISHED"}
