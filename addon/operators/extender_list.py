# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that add extenders to meshes in edit mode, remove them and select their vertices."""

import bmesh
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import names
from ..core import texts
from ..core.extender_pairs import SelectionError, pairs_in_order, pairs_to_active
from ..edit_mesh import selection
from ..extenders import storage


class MESH_OT_spectral_extender_add(bpy.types.Operator):
    """Add extenders between the selected vertices of every mesh in edit mode."""

    bl_idname = names.ADD_EXTENDER_OPERATOR
    bl_label = texts.ADD_EXTENDER_LABEL
    bl_description = texts.ADD_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    pairs: EnumProperty(name="Pairs", description="Which vertices make a pair", items=texts.EXTENDER_PAIRS_ITEMS)
    strength: FloatProperty(**names.EXTENDER_STRENGTH)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what one of the two ways to make pairs does."""
        return next(text for identifier, _, text in texts.EXTENDER_PAIRS_ITEMS if identifier == properties.pairs)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make the pairs of all meshes before any is added."""
        if self.strength != self.strength:
            self.report({"ERROR"}, "The strength must be a number, not nan")
            return {"CANCELLED"}
        try:
            pairs = self._pairs(context)
        except SelectionError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        added = sum(storage.add(mesh, mesh_pairs, self.strength) for mesh, mesh_pairs in pairs.items())
        skipped = sum(map(len, pairs.values())) - added
        if skipped:
            self.report({"INFO" if added else "WARNING"}, f"Pairs that have an extender already: {skipped}")
        return {"FINISHED"} if added else {"CANCELLED"}

    def _pairs(self, context: bpy.types.Context) -> dict[bpy.types.Mesh, list[tuple[int, int]]]:
        """Return the pairs of vertices of every mesh with a selection.

        Raises:
            SelectionError: a selection makes no pairs.
        """
        pairs = {}
        edited = context.objects_in_mode_unique_data
        for edit_object in edited:
            selected = selection.selected_vertices(context, edit_object.data)
            if not selected.vertices:
                continue
            try:
                if self.pairs == texts.PAIRS_IN_ORDER:
                    made = pairs_in_order(selected.vertices, selected.in_order)
                else:
                    made = pairs_to_active(selected.vertices, selected.active)
            except SelectionError as error:
                raise SelectionError(f"{edit_object.name}: {error}" if len(edited) > 1 else str(error)) from error
            pairs[edit_object.data] = made
        if not pairs:
            raise SelectionError("Nothing is selected; select the vertices to connect, one after the other")
        return pairs


class _ExtenderOperator:
    """What the operators on one extender of the active object's mesh share."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has extenders."""
        return context.mode == "EDIT_MESH" and len(storage.of(context.edit_object.data)) > 0

    def chosen(self, mesh: bpy.types.Mesh) -> int:
        """Return the index of the extender to work on, -1 having reported that there is none."""
        index = storage.active_index(mesh) if self.index < 0 else self.index
        if not 0 <= index < len(storage.of(mesh)):
            self.report({"ERROR"}, "No such extender; choose one in the list")
            return -1
        return index


class MESH_OT_spectral_extender_remove(_ExtenderOperator, bpy.types.Operator):
    """Remove one extender, or all broken ones."""

    bl_idname = names.REMOVE_EXTENDER_OPERATOR
    bl_label = texts.REMOVE_EXTENDER_LABEL
    bl_description = texts.REMOVE_EXTENDER_DESCRIPTION

    index: IntProperty(name="Index", description="Place in the list, -1 for the active extender", default=-1, min=-1)
    broken: BoolProperty(name="Broken", description="Remove all extenders with a vertex that is gone instead")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what is removed."""
        return texts.REMOVE_BROKEN_EXTENDERS_DESCRIPTION if properties.broken else texts.REMOVE_EXTENDER_DESCRIPTION

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove from the list of the active object's mesh."""
        mesh = context.edit_object.data
        if self.broken:
            ends = storage.ends(bmesh.from_edit_mesh(mesh), mesh)
            indices = [index for index, pair in enumerate(ends) if -1 in pair]
            self.report({"INFO"}, f"Removed broken extenders: {len(indices)}")
        else:
            indices = [index for index in (self.chosen(mesh),) if index >= 0]
        if not indices:
            return {"CANCELLED"}
        storage.remove(mesh, indices)
        return {"FINISHED"}


class MESH_OT_spectral_extender_select(_ExtenderOperator, bpy.types.Operator):
    """Select the vertices of one extender."""

    bl_idname = names.SELECT_EXTENDER_OPERATOR
    bl_label = texts.SELECT_EXTENDER_LABEL
    bl_description = texts.SELECT_EXTENDER_DESCRIPTION

    index: IntProperty(name="Index", description="Place in the list, -1 for the active extender", default=-1, min=-1)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select what is left of the extender."""
        mesh = context.edit_object.data
        index = self.chosen(mesh)
        if index < 0:
            return {"CANCELLED"}
        name = storage.label(storage.of(mesh)[index])
        bm = bmesh.from_edit_mesh(mesh)
        bm.verts.ensure_lookup_table()
        present = [vertex for vertex in storage.ends(bm, mesh)[index] if vertex >= 0]
        hidden = sum(bm.verts[vertex].hide for vertex in present)
        if len(present) < 2:
            self.report({"WARNING"}, f"{name} is broken: {2 - len(present)} of its vertices gone; remove it")
        if hidden:
            self.report({"WARNING"}, f"{name} has hidden vertices: {hidden}; reveal them to select them")
        if len(present) == hidden:
            return {"CANCELLED"}
        selection.select_only_vertices(context, mesh, present)
        return {"FINISHED"}
