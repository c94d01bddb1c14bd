# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that selects the islands without a solution."""

import bpy

from .. import edit_mode_unwrap, mesh_selection, names
from ..core import reporting
from ..core.native import NativeModuleError


class UV_OT_spectral_select_failed(bpy.types.Operator):
    """Select the faces of the islands that Spectral Unwrap cannot solve."""

    bl_idname = names.SELECT_FAILED_OPERATOR
    bl_label = names.SELECT_FAILED_LABEL
    bl_description = names.SELECT_FAILED_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Solve without writing anything, and select the faces of failed islands."""
        settings = edit_mode_unwrap.Settings(correct_aspect=False)
        edit_meshes = edit_mode_unwrap.read(context, settings) or edit_mode_unwrap.read(context, settings, True)
        try:
            solutions = edit_mode_unwrap.solve(edit_meshes, settings)
        except NativeModuleError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        islands, faces = reporting.count_failed(solutions)
        self.report({"INFO"}, reporting.selected_failed(islands, faces))
        if not faces:
            return {"CANCELLED"}
        mesh_selection.select_only(
            context,
            {edit_mesh.mesh: solution.failed_faces for edit_mesh, solution in zip(edit_meshes, solutions)},
        )
        return {"FINISHED"}
