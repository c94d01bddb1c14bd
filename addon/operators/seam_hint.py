# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that sets where seams are wanted, and where not."""

import bpy
from bpy.props import EnumProperty

from .. import editors, names
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import seam_wishes
from .reporting_operator import ReportingOperator

_VALUES = {"CUT": seam_wishes.CUT, "NEVER": seam_wishes.NEVER, "CLEAR": seam_wishes.NONE}


class MESH_OT_spectral_seam_hint(ReportingOperator, bpy.types.Operator):
    """Set the wish of the selected edges of all meshes in edit mode."""

    bl_idname = names.SEAM_HINT_OPERATOR
    bl_label = texts.SEAM_WISH_LABEL
    bl_description = texts.SEAM_WISH_DESCRIPTION

    hint: EnumProperty(**texts.SEAM_WISH_PROPERTY, items=texts.SEAM_WISHES)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what the wish means."""
        return translate(next(text for identifier, _, text in texts.SEAM_WISHES if identifier == properties.hint))

    def run(self, context: bpy.types.Context) -> set[str]:
        """Set the wish and report how many edges have it."""
        meshes = [each.data for each in context.objects_in_mode_unique_data]
        count = sum(seam_wishes.set_selected(mesh, _VALUES[self.hint]) for mesh in meshes)
        if not count:
            return self.canceled(translate(texts.NO_EDGES_SELECTED))
        editors.redraw(context)
        self.report({"INFO"}, texts.wished(self.hint, count))
        return {"FINISHED"}
