# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that sets where seams are wanted, and where not."""

import bpy

from .. import editors, names
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import seam_hints
from .property_kinds import choice
from .reporting_operator import ReportingOperator

_VALUES = {"CUT": seam_hints.CUT, "NEVER": seam_hints.NEVER, "CLEAR": seam_hints.NONE}


class MESH_OT_spectral_seam_hint(ReportingOperator, bpy.types.Operator):
    """Set the hint of the selected edges of all meshes in edit mode."""

    bl_idname = names.SEAM_HINT_OPERATOR
    bl_label = texts.SEAM_HINT_LABEL
    bl_description = "Tell Suggest Seams to cut the selected edges, or never to cut them"
    described_by = "hint"

    hint: choice("Hint", "What Suggest Seams does with the selected edges", texts.SEAM_HINTS)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Set the hint and report how many edges have it."""
        meshes = [each.data for each in context.objects_in_mode_unique_data]
        count = sum(seam_hints.set_selected(mesh, _VALUES[self.hint]) for mesh in meshes)
        if not count:
            return self.canceled(translate(texts.NO_EDGES_SELECTED))
        editors.redraw(context)
        self.report({"INFO"}, texts.hinted(self.hint, count))
        return {"FINISHED"}
