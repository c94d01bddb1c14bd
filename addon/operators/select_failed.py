# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that selects the islands without a solution."""

import bpy

from .. import names
from ..core import summary, texts
from ..core.native import NativeModuleError
from ..core.options import Settings
from ..edit_mesh import selection
from ..unwrapping import steps


class UV_OT_spectral_select_failed(bpy.types.Operator):
    """Select the faces of the islands that Spectral Unwrap cannot solve."""

    bl_idname = names.SELECT_FAILED_OPERATOR
    bl_label = texts.SELECT_FAILED_LABEL
    bl_description = texts.SELECT_FAILED_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Solve without writing anything, and select the faces of failed islands."""
        settings = Settings(correct_aspect=False)
        edit_meshes = steps.read(context, settings) or steps.read(context, settings, True)
        try:
            solutions = steps.solve(edit_meshes, settings)
        except NativeModuleError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        islands, faces = summary.count_failed(solutions)
        self.report({"INFO"}, texts.selected_failed(islands, faces))
        if not faces:
            return {"CANCELLED"}
        selection.select_only(
            context,
            {edit_mesh.mesh: solution.failed_faces for edit_mesh, solution in zip(edit_meshes, solutions)},
        )
        return {"FINISHED"}
