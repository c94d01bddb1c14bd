# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that selects flipped and overlapping faces of the UV map."""

import bpy
from bpy.props import BoolProperty

from .. import names
from ..core import defects, texts
from ..core.native import NativeModuleError
from ..edit_mesh import selection
from ..edit_mesh.read import read_mesh


class UV_OT_spectral_select_defects(bpy.types.Operator):
    """Select the faces that are flipped or overlap others in the active UV map."""

    bl_idname = names.SELECT_DEFECTS_OPERATOR
    bl_label = texts.SELECT_DEFECTS_LABEL
    bl_description = texts.SELECT_DEFECTS_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    flipped: BoolProperty(
        name="Flipped",
        description="Select faces that lie the other way round than most of their island",
        default=True,
    )
    overlapping: BoolProperty(
        name="Overlapping",
        description="Select faces that cover part of another face of their island",
        default=True,
    )
    between_islands: BoolProperty(
        name="Between Islands",
        description="Also select faces that cover part of another island, of any mesh in edit mode",
        default=False,
    )
    extend: BoolProperty(name="Extend", description="Add to the selection instead of replacing it", default=False)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the options; those of overlaps together."""
        layout = self.layout
        layout.prop(self, "flipped")
        layout.prop(self, "overlapping")
        row = layout.row()
        row.enabled = self.overlapping
        row.prop(self, "between_islands")
        layout.prop(self, "extend")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Look at the visible faces, in the UV editor at those shown there, and select the ones with defects."""
        if not (self.flipped or self.overlapping):
            self.report({"WARNING"}, texts.NO_DEFECT_CHOSEN)
            return {"CANCELLED"}
        shows_selected = selection.selects_uvs(context)
        edit_meshes = [
            read_mesh(edit_object, all_visible=not shows_selected)
            for edit_object in context.objects_in_mode_unique_data
        ]
        edit_meshes = [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.uv is not None]
        if not edit_meshes:
            self.report({"WARNING"}, texts.NO_UV_MAP)
            return {"CANCELLED"}
        try:
            found = defects.find([edit_mesh.polygons for edit_mesh in edit_meshes], self.between_islands)
        except NativeModuleError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        chosen = [each.chosen(self.flipped, self.overlapping) for each in found]
        self.report({"INFO"}, texts.selected_defects(found, self.flipped, self.overlapping))
        if any(faces.any() for faces in chosen):
            faces = {edit_mesh.mesh: flags for edit_mesh, flags in zip(edit_meshes, chosen)}
            selection.select_shown(context, faces, self.extend)
        # Finished even where there are none, so that the options can be changed.
        return {"FINISHED"}
