# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that add extenders to meshes in edit mode, remove them and select their vertices."""

from collections.abc import Mapping

import bmesh
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import names
from ..core import choices
from ..core.errors import ReadableError
from ..core.extenders.pairs import SelectionError, pairs_in_order, pairs_to_active
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..extenders import storage
from ..extenders.strength import STRENGTH
from ..live import following
from .reporting_operator import ReportingOperator

# Panels set these for one click; the next does not remember them, and Adjust Last Operation does not show them.
FOR_ONE_CALL = {"HIDDEN", "SKIP_SAVE"}
# Arguments of the property of every operator on one extender.
INDEX = {
    **texts.INDEX_PROPERTY,
    "default": -1,
    "min": -1,
    "options": FOR_ONE_CALL,
}


class ExtenderOperator(ReportingOperator):
    """What the operators on extenders of the active object's mesh share."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has extenders."""
        return context.mode == "EDIT_MESH" and len(storage.of(context.edit_object.data)) > 0

    def chosen(self, mesh: bpy.types.Mesh) -> int:
        """Return the index of the extender to work on.

        Raises:
            SelectionError: there is none.
        """
        index = storage.active_index(mesh) if self.index < 0 else self.index
        if not 0 <= index < len(storage.of(mesh)):
            raise SelectionError(translate(texts.NO_SUCH_EXTENDER))
        return index

    def let_follow(self, edit_object: bpy.types.Object, strengths: Mapping[tuple[int, int], float]) -> bool:
        """Let the map follow changed extenders at once, in the operator's own undo step; report where it cannot.

        Returns whether it follows.
        """
        if not strengths:
            return True
        follows = False
        try:
            note = following.follow_extenders(edit_object, strengths)
            follows = True
        except ReadableError as error:
            note = str(error)
        except MemoryError:
            note = translate(texts.OUT_OF_MEMORY_TO_FOLLOW)
        if note:
            self.report({"WARNING"}, note)
        return follows


class MESH_OT_spectral_extender_add(ExtenderOperator, bpy.types.Operator):
    """Add extenders between the selected vertices of every mesh in edit mode."""

    bl_idname = names.ADD_EXTENDER_OPERATOR
    bl_label = texts.ADD_EXTENDER_LABEL
    bl_description = texts.ADD_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    pairs: EnumProperty(**texts.PAIRS_PROPERTY, items=texts.EXTENDER_PAIRS_ITEMS)
    strength: FloatProperty(**STRENGTH)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what one of the two ways to make pairs does."""
        chosen = next(text for identifier, _, text in texts.EXTENDER_PAIRS_ITEMS if identifier == properties.pairs)
        return translate(chosen)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def run(self, context: bpy.types.Context) -> set[str]:
        """Make the pairs of all meshes before any is added."""
        if self.strength != self.strength:
            raise SelectionError(translate(texts.STRENGTH_IS_NO_NUMBER))
        pairs = self._pairs(context)
        added = {edit_object: storage.add(edit_object.data, made, self.strength) for edit_object, made in pairs.items()}
        count = sum(map(len, added.values()))
        existing = sum(map(len, pairs.values())) - count
        follows = following.is_on(context.scene) and count > 0
        if follows:
            # Each of them, also after one that cannot follow.
            follows = all([self.let_follow(edited, dict.fromkeys(new, self.strength)) for edited, new in added.items()])
        self.report({"INFO" if count else "WARNING"}, texts.added_extenders(count, existing, follows))
        return {"FINISHED"} if count else {"CANCELLED"}

    def _pairs(self, context: bpy.types.Context) -> dict[bpy.types.Object, list[tuple[int, int]]]:
        """Return the pairs of vertices of every mesh with a selection, by its object.

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
                if self.pairs == choices.PAIRS_IN_ORDER:
                    made = pairs_in_order(selected.vertices, selected.in_order)
                else:
                    made = pairs_to_active(selected.vertices, selected.active)
            except SelectionError as error:
                raise SelectionError(f"{edit_object.name}: {error}" if len(edited) > 1 else str(error)) from error
            pairs[edit_object] = made
        if not pairs:
            raise SelectionError(translate(texts.NO_VERTICES_SELECTED))
        return pairs


class MESH_OT_spectral_extender_remove(ExtenderOperator, bpy.types.Operator):
    """Remove one extender, or all broken ones."""

    bl_idname = names.REMOVE_EXTENDER_OPERATOR
    bl_label = texts.REMOVE_EXTENDER_LABEL
    bl_description = texts.REMOVE_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(**INDEX)
    broken: BoolProperty(**texts.BROKEN_PROPERTY, options=FOR_ONE_CALL)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what is removed."""
        if properties.broken:
            return translate(texts.REMOVE_BROKEN_EXTENDERS_DESCRIPTION)
        return translate(texts.REMOVE_EXTENDER_DESCRIPTION)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Remove from the list of the active object's mesh."""
        mesh = context.edit_object.data
        if self.broken:
            ends = storage.ends(bmesh.from_edit_mesh(mesh), mesh)
            indices = [index for index, pair in enumerate(ends) if -1 in pair]
            self.report({"INFO"}, texts.removed_broken(len(indices)))
        else:
            indices = [self.chosen(mesh)]
        if not indices:
            return {"CANCELLED"}
        gone = self._acting(mesh, indices)
        storage.remove(mesh, indices)
        if following.is_on(context.scene):
            self.let_follow(context.edit_object, dict.fromkeys(gone, 0.0))
        return {"FINISHED"}

    def _acting(self, mesh: bpy.types.Mesh, indices: list[int]) -> list[tuple[int, int]]:
        """Return the vertices of those of the extenders that act on the map."""
        ends = storage.ends(bmesh.from_edit_mesh(mesh), mesh)
        listed = storage.of(mesh)
        return [ends[k] for k in indices if -1 not in ends[k] and listed[k].use and listed[k].strength != 0.0]


class MESH_OT_spectral_extender_select(ExtenderOperator, bpy.types.Operator):
    """Select the vertices of one extender."""

    bl_idname = names.SELECT_EXTENDER_OPERATOR
    bl_label = texts.SELECT_EXTENDER_LABEL
    bl_description = texts.SELECT_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(**INDEX)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Select what is left of the extender."""
        mesh = context.edit_object.data
        index = self.chosen(mesh)
        name = storage.label(storage.of(mesh)[index])
        bm = bmesh.from_edit_mesh(mesh)
        bm.verts.ensure_lookup_table()
        present = [vertex for vertex in storage.ends(bm, mesh)[index] if vertex >= 0]
        hidden = sum(bm.verts[vertex].hide for vertex in present)
        if len(present) < 2:
            self.report({"WARNING"}, texts.broken_extender_selected(name, 2 - len(present)))
        if hidden:
            self.report({"WARNING"}, texts.hidden_vertices(name, hidden))
        if len(present) == hidden:
            return {"CANCELLED"}
        selection.select_only_vertices(context, mesh, present)
        return {"FINISHED"}
