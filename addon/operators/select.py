# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that select faces by the result of the unwrap, or by their map."""

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .. import names
from ..core.choices import LOOK_ANGLE
from ..core.measure import defects
from ..core.measure.map_view import MapView, worst
from ..core.measure.summary import STRAINED_QC
from ..core.words import texts
from ..core.words.percent import qc_of_percent
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..edit_mesh.read import read_mesh
from ..edit_mesh.read_map import read_map
from ..ui import settings_layout
from ..unwrapping import last_result
from .reporting_operator import ReportingOperator


class UV_OT_spectral_select_distorted(ReportingOperator, bpy.types.Operator):
    """Select the visible faces that the active UV map distorts most."""

    bl_idname = names.SELECT_DISTORTED_OPERATOR
    bl_label = texts.SELECT_DISTORTED_LABEL
    bl_description = texts.SELECT_DISTORTED_DESCRIPTION

    measure: EnumProperty(**texts.MEASURE_PROPERTY, items=texts.MEASURE_ITEMS)
    amount: FloatProperty(**texts.AMOUNT_PROPERTY, default=5.0, min=0.01, max=100.0, subtype="PERCENTAGE")
    use_limit: BoolProperty(**texts.USE_LIMIT_PROPERTY)
    angle_limit: FloatProperty(
        **texts.ANGLE_LIMIT_PROPERTY, default=50.0, min=0.0, soft_max=1000.0, subtype="PERCENTAGE"
    )
    size_limit: FloatProperty(**texts.SIZE_LIMIT_PROPERTY, default=1.5, min=1.0, soft_max=10.0)
    whole_islands: BoolProperty(**texts.WHOLE_ISLANDS_PROPERTY)
    extend: BoolProperty(**texts.EXTEND_PROPERTY)

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the amount or the limit, whichever applies."""
        limit = "angle_limit" if self.measure == LOOK_ANGLE else "size_limit"
        how_many = limit if self.use_limit else "amount"
        settings_layout.draw(self.layout, self, ("measure", "use_limit", how_many, "whole_islands", "extend"))

    def run(self, context: bpy.types.Context) -> set[str]:
        """Measure the maps of all meshes in edit mode together and select the worst faces, or islands."""
        views = _views(context)
        if not views:
            return self.canceled(translate(texts.NO_UV_MAP))
        limit = qc_of_percent(self.angle_limit) if self.measure == LOOK_ANGLE else self.size_limit
        limit = limit if self.use_limit else None
        chosen = worst(list(views.values()), self.measure, self.amount, self.whole_islands, limit)
        selection.select_shown(context, dict(zip(views, chosen)), self.extend)
        self.report({"INFO"}, texts.selected_worst(sum(int(faces.sum()) for faces in chosen)))
        return {"FINISHED"}


class UV_OT_spectral_select_stretched(ReportingOperator, bpy.types.Operator):
    """Select the visible faces that the report of an unwrap warns of."""

    bl_idname = names.SELECT_STRETCHED_OPERATOR
    bl_label = texts.SELECT_STRETCHED_LABEL
    bl_description = texts.SELECT_STRETCHED_DESCRIPTION

    extend: BoolProperty(**texts.EXTEND_PROPERTY)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Measure the maps of all meshes in edit mode and select faces beyond the limit of the warning."""
        views = _views(context)
        if not views:
            return self.canceled(translate(texts.NO_UV_MAP))
        chosen = worst(list(views.values()), LOOK_ANGLE, 0.0, False, STRAINED_QC)
        count = sum(int(faces.sum()) for faces in chosen)
        if count:
            selection.select_shown(context, dict(zip(views, chosen)), self.extend)
        self.report({"INFO"}, texts.selected_stretched(count))
        return {"FINISHED"}


def _views(context: bpy.types.Context) -> dict[bpy.types.Mesh, MapView]:
    """Return the maps of the meshes in edit mode that have one."""
    arrays = {each.data: read_map(context, each) for each in context.objects_in_mode_unique_data}
    return {mesh: MapView(found) for mesh, found in arrays.items() if found is not None}


class UV_OT_spectral_select_failed(ReportingOperator, bpy.types.Operator):
    """Select the visible faces of the islands that failed when they were unwrapped last."""

    bl_idname = names.SELECT_FAILED_OPERATOR
    bl_label = texts.SELECT_FAILED_LABEL
    bl_description = texts.SELECT_FAILED_DESCRIPTION

    def run(self, context: bpy.types.Context) -> set[str]:
        """Select the remembered faces, or, if constraints contradict each other, their edges."""
        edited = [item for item in context.objects_in_mode_unique_data if last_result.is_remembered(item.data)]
        if not edited:
            return self.canceled(translate(texts.NO_RESULT_REMEMBERED))
        faces, islands, changed = {}, 0, []
        edges = {}
        for edit_object in edited:
            edit_mesh = read_mesh(edit_object, all_visible=True)
            failed = last_result.failed(edit_mesh)
            if failed is None:
                changed.append(edit_object.name)
                continue
            flags = (failed.islands >= 0) & edit_mesh.polygons.selected_faces
            islands += len(np.unique(failed.islands[flags]))
            faces[edit_mesh.mesh] = flags
            edges[edit_mesh.mesh] = failed.contradicting
        if any(edges.values()):
            self.report({"INFO"}, texts.selected_contradicting(sum(map(len, edges.values()))))
            selection.select_only_edges(context, edges)
            return {"FINISHED"}
        if faces:
            self.report({"INFO"}, texts.selected_failed(islands, sum(int(flags.sum()) for flags in faces.values())))
        if changed:
            self.report({"WARNING"}, texts.changed_since_unwrapped(changed))
        if not islands:
            return {"CANCELLED"}
        selection.select_only(context, faces)
        return {"FINISHED"}


class UV_OT_spectral_select_defects(ReportingOperator, bpy.types.Operator):
    """Select the faces that are flipped or overlap others in the active UV map."""

    bl_idname = names.SELECT_DEFECTS_OPERATOR
    bl_label = texts.SELECT_DEFECTS_LABEL
    bl_description = texts.SELECT_DEFECTS_DESCRIPTION

    flipped: BoolProperty(**texts.FLIPPED_PROPERTY, default=True)
    overlapping: BoolProperty(**texts.OVERLAPPING_PROPERTY, default=True)
    between_islands: BoolProperty(**texts.BETWEEN_ISLANDS_PROPERTY, default=False)
    extend: BoolProperty(**texts.EXTEND_PROPERTY, default=False)

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the options; those of overlaps together."""
        settings_layout.draw(self.layout, self, ("flipped", "overlapping"))
        row = self.layout.row()
        row.enabled = self.overlapping
        row.prop(self, "between_islands")
        self.layout.prop(self, "extend")

    def run(self, context: bpy.types.Context) -> set[str]:
        """Select the visible faces with defects; in the UV editor, those shown there."""
        if not (self.flipped or self.overlapping):
            return self.canceled(translate(texts.NO_DEFECT_CHOSEN))
        shows_selected = selection.selects_uvs(context)
        edit_meshes = [
            read_mesh(edit_object, all_visible=not shows_selected)
            for edit_object in context.objects_in_mode_unique_data
        ]
        edit_meshes = [edit_mesh for edit_mesh in edit_meshes if edit_mesh.polygons.uv is not None]
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        found = defects.find([edit_mesh.polygons for edit_mesh in edit_meshes], self.between_islands)
        chosen = [each.chosen(self.flipped, self.overlapping) for each in found]
        self.report({"INFO"}, texts.selected_defects(found, self.flipped, self.overlapping))
        if any(faces.any() for faces in chosen):
            faces = {edit_mesh.mesh: flags for edit_mesh, flags in zip(edit_meshes, chosen)}
            selection.select_shown(context, faces, self.extend)
        # Finished even if there are none, so that the options can be adjusted.
        return {"FINISHED"}
