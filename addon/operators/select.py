# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that selects faces by the result of the unwrap, or by their map."""

import bpy
import numpy as np

from .. import names
from ..core import choices
from ..core.measure import defects
from ..core.measure.map_view import MapView, worst
from ..core.measure.summary import STRAINED_QC
from ..core.words import texts
from ..core.words.percent import qc_of_percent
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..edit_mesh.read import Reading, read_mesh
from ..edit_mesh.read_map import read_map
from ..ui import settings
from ..unwrapping import last_result
from .property_kinds import choice, number, switch
from .reporting_operator import ReportingOperator

# Whether flipped and overlapping faces are meant.
_DEFECTS = {
    choices.SELECT_DEFECTS: (True, True),
    choices.SELECT_FLIPPED: (True, False),
    choices.SELECT_OVERLAPPING: (False, True),
}


class UV_OT_spectral_select(ReportingOperator, bpy.types.Operator):
    """Select the visible faces of one kind."""

    bl_idname = names.SELECT_OPERATOR
    bl_label = "Spectral Select"
    bl_description = "Select faces by the active UV map, or by the last unwrap"
    described_by = "kind"

    kind: choice("Select", "Which of the visible faces to select", texts.SELECT_ITEMS)
    measure: choice(
        "By",
        "How faces are ranked",
        (
            ("ANGLE", "Angle Distortion", "Faces whose angles are off the most"),
            ("SIZE", "Size", "Faces whose size in the map differs most from the median"),
        ),
    )
    amount: number(
        "Amount", "Share of the surface to select, worst faces first", 5.0, (0.01, 100.0), subtype="PERCENTAGE"
    )
    limit: number(
        "Limit",
        "Select everything whose angles are off, or size from the median, by more than this; 0 for a share of the "
        "surface",
        0.0,
        (0.0, 1000.0, None),
        subtype="PERCENTAGE",
    )
    whole_islands: switch("Whole Islands", "Rank islands by their average instead of faces")
    between_islands: switch(
        "Between Islands", "Also select faces that overlap another island, of any mesh in edit mode"
    )
    extend: switch("Extend", "Add to the selection instead of replacing it")

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the kind and what belongs to it."""
        shown = ["kind"]
        if self.kind == choices.SELECT_DISTORTED:
            shown += ["measure", "limit", *(() if self.limit else ("amount",)), "whole_islands"]
        if self.kind in (choices.SELECT_DEFECTS, choices.SELECT_OVERLAPPING):
            shown.append("between_islands")
        if self.kind != choices.SELECT_FAILED:
            shown.append("extend")
        settings.draw(self.layout, self, shown)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Find the faces and select them; in the UV editor, among those shown there."""
        if self.kind == choices.SELECT_FAILED:
            return self._select_failed(context)
        return self._select_defects(context) if self.kind in _DEFECTS else self._select_distorted(context)

    def _select_distorted(self, context: bpy.types.Context) -> set[str]:
        """Measure the maps of all meshes in edit mode together and select the worst faces, or islands."""
        arrays = {each.data: read_map(context, each) for each in context.objects_in_mode_unique_data}
        views = {mesh: MapView(found) for mesh, found in arrays.items() if found is not None}
        if not views:
            return self.canceled(translate(texts.NO_UV_MAP))
        if self.kind == choices.SELECT_STRETCHED:
            # What the report of an unwrap warns of.
            chosen = worst(list(views.values()), choices.LOOK_ANGLE, 0.0, False, STRAINED_QC)
        else:
            # Angles off by 50 % have a distortion of 1.5, and sizes off by as much differ by this factor.
            limit = qc_of_percent(self.limit) if self.limit else None
            chosen = worst(list(views.values()), self.measure, self.amount, self.whole_islands, limit)
        count = sum(int(faces.sum()) for faces in chosen)
        if count:
            selection.select_shown(context, dict(zip(views, chosen)), self.extend)
        self.report({"INFO"}, texts.selected_distorted(count))
        return {"FINISHED"}

    def _select_failed(self, context: bpy.types.Context) -> set[str]:
        """Select the remembered faces, or, if constraints contradict each other, their edges."""
        edited = [item for item in context.objects_in_mode_unique_data if last_result.is_remembered(item.data)]
        if not edited:
            return self.canceled(
                translate("These meshes have not been unwrapped since the file was opened; unwrap first")
            )
        faces, islands, changed = {}, 0, []
        edges = {}
        for edit_object in edited:
            edit_mesh = read_mesh(edit_object, Reading(all_visible=True))
            failed = last_result.failed(edit_mesh)
            if failed is None:
                changed.append(edit_object.name)
                continue
            flags = (failed.islands >= 0) & edit_mesh.polygons.selected_faces
            islands += len(np.unique(failed.islands[flags]))
            faces[edit_mesh.mesh] = flags
            edges[edit_mesh.mesh] = failed.contradicting
        if any(edges.values()):
            self.report({"INFO"}, texts.counted(sum(map(len, edges.values())), texts.SELECTED_CONTRADICTING))
            selection.select_only_edges(context, edges)
            return {"FINISHED"}
        if faces:
            self.report({"INFO"}, texts.selected_failed(islands, sum(int(flags.sum()) for flags in faces.values())))
        if changed:
            self.report(
                {"WARNING"},
                translate("The faces of {names} have changed since the last unwrap; unwrap again").format(
                    names=", ".join(changed)
                ),
            )
        if not islands:
            return {"CANCELLED"}
        selection.select_only(context, faces)
        return {"FINISHED"}

    def _select_defects(self, context: bpy.types.Context) -> set[str]:
        """Select the visible faces with defects; in the UV editor, those shown there."""
        shows_selected = selection.selects_uvs(context)
        edit_meshes = [
            read_mesh(edit_object, Reading(all_visible=not shows_selected))
            for edit_object in context.objects_in_mode_unique_data
        ]
        edit_meshes = [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.uv is not None]
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        found = defects.find([edit_mesh.polygons for edit_mesh in edit_meshes], self.between_islands)
        kinds = _DEFECTS[self.kind]
        chosen = [each.chosen(*kinds) for each in found]
        self.report({"INFO"}, texts.selected_defects(found, *kinds))
        if any(faces.any() for faces in chosen):
            faces = {edit_mesh.mesh: flags for edit_mesh, flags in zip(edit_meshes, chosen)}
            selection.select_shown(context, faces, self.extend)
        # Finished even if there are none, so that the options can be adjusted.
        return {"FINISHED"}
