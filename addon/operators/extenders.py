# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that add extenders to meshes in edit mode, change their strength and remove them."""

from collections.abc import Collection
from contextlib import suppress

import bpy
from bpy.props import FloatProperty

from .. import editors, names
from ..core.errors import ReadableError
from ..core.extenders.pairs import amount_of, pairs, strength_of
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import extenders as storage
from ..edit_mesh import selection
from ..edit_mesh.read import read_mesh
from ..live import extenders as live
from ..live import following
from ..session import edit_meshes
from ..ui import progress
from ..unwrapping.last_settings import last_settings
from .job_operator import Choice, Job, JobOperator
from .reporting_operator import ReportingOperator

# Change of the amount per pixel, in percent: 400 pixels from nothing to the whole effect.
_STEP = 0.25
# Factor with Shift, as in Blender's own transforms.
_PRECISION = 0.1
_CONFIRM = {"LEFTMOUSE", "RET", "NUMPAD_ENTER"}


class _ExtenderOperator(ReportingOperator):
    """Base of the operators on the active extender of the active object's mesh."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has extenders."""
        return super().poll(context) and len(storage.of(context.edit_object.data)) > 0


def _follow(operator: bpy.types.Operator, edit_object: bpy.types.Object, changed: Collection[tuple[int, int]]) -> bool:
    """Let the map follow changed extenders in the operator's undo step; return whether it does, or report why not."""
    try:
        with following.not_following():
            note, follows = live.follow(edit_object, changed) if changed else "", True
    except (ReadableError, MemoryError) as error:
        is_readable = isinstance(error, ReadableError)
        note, follows = str(error) if is_readable else translate(texts.OUT_OF_MEMORY_TO_FOLLOW), False
    if note:
        operator.report({"WARNING"}, note)
    return follows


class MESH_OT_spectral_extender_add(ReportingOperator, bpy.types.Operator):
    """Add extenders between the selected vertices of every mesh in edit mode."""

    bl_idname = names.ADD_EXTENDER_OPERATOR
    bl_label = texts.ADD_EXTENDER_LABEL
    bl_description = texts.ADD_EXTENDER_DESCRIPTION

    amount: FloatProperty(**storage.AMOUNT, default=50.0)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Find the pairs of all meshes, then add extenders."""
        if self.amount != self.amount:
            raise ReadableError(translate(texts.AMOUNT_IS_NO_NUMBER))
        wanted, edited = {}, context.objects_in_mode_unique_data
        for edit_object in edited:
            selected, active = selection.selected_vertices(context, edit_object.data)
            try:
                if selected:
                    wanted[edit_object] = pairs(selected, active)
            except ReadableError as error:
                raise ReadableError(f"{edit_object.name}: {error}" if len(edited) > 1 else str(error)) from error
        if not wanted:
            raise ReadableError(translate(texts.NO_VERTICES_SELECTED))
        added = {}
        for each, made in wanted.items():
            polygons = read_mesh(each, all_visible=True, correct_aspect=last_settings().correct_aspect).polygons
            added[each] = storage.add(each.data, polygons, made, self.amount)
        follows = following.is_on(context.scene)
        if follows and self.amount != 0.0:
            follows = all([_follow(self, edit_object, made) for edit_object, made in added.items()])
        count = sum(map(len, added.values()))
        existing = sum(map(len, wanted.values())) - count
        self.report({"INFO" if count else "WARNING"}, texts.added_extenders(count, existing, follows))
        return {"FINISHED"} if count else {"CANCELLED"}


class MESH_OT_spectral_extender_remove(_ExtenderOperator, bpy.types.Operator):
    """Remove the active extender."""

    bl_idname = names.REMOVE_EXTENDER_OPERATOR
    bl_label = texts.REMOVE_EXTENDER_LABEL
    bl_description = texts.REMOVE_EXTENDER_DESCRIPTION

    def run(self, context: bpy.types.Context) -> set[str]:
        """Remove from the list of the active object's mesh."""
        mesh = context.edit_object.data
        before, _ = storage.resolve(mesh)
        storage.remove(mesh)
        after, _ = storage.resolve(mesh)
        if following.is_on(context.scene):
            _follow(self, context.edit_object, {each[:2] for each in set(before) - set(after)})
        return {"FINISHED"}


class MESH_OT_spectral_extender_adjust(JobOperator, _ExtenderOperator, bpy.types.Operator):
    """Change the strength of an extender, and the map of its island."""

    bl_idname = names.ADJUST_EXTENDER_OPERATOR
    bl_label = texts.ADJUST_EXTENDER_LABEL
    bl_description = texts.ADJUST_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    amount: FloatProperty(**storage.AMOUNT, default=50.0)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Drag the amount, store it and write the map; any other end restores both."""
        drag = _Drag(context.edit_object)
        if drag.islands.note:
            self.report({"INFO"}, drag.islands.note)
        try:
            if is_interactive:
                self.amount = (yield drag).result
            drag.show(self.amount, is_final=True)
        except BaseException:
            drag.give_back()
            raise
        if folds := drag.islands.folds():
            self.report({"WARNING"}, folds)
        return {"FINISHED"}


class _Drag(Choice):
    """Asks for an amount, by dragging, while the map follows.

    Attributes:
        answer: the last amount that the map could follow.
        islands: the islands that follow.
    """

    def __init__(self, edit_object: bpy.types.Object) -> None:
        """Begin at the amount that the active extender has."""
        self._mesh, self._index = edit_object.data, storage.active(edit_object.data)
        self._bm = edit_meshes.keep(self._mesh).bm
        extender, self._pair = storage.of(self._mesh)[self._index], storage.ends(self._mesh)[self._index]
        if -1 in self._pair:
            raise ReadableError(texts.broken_extender(extender.name))
        self.islands = live.AdjustedIslands(edit_object, [self._pair])
        self.answer = self._wanted = amount_of(extender.strength, extender.half)
        self._former, self._half, self._mouse_x = extender.strength, extender.half, None

    def show(self, amount: float, is_final: bool = False) -> None:
        """Let the map follow an amount, then set it in the list."""
        strength = strength_of(amount, self._half)
        with following.not_following():
            self.islands.write((*self._pair, strength, self._half), is_final)
            storage.of(self._mesh)[self._index].strength, self.answer = strength, amount

    def give_back(self) -> None:
        """Restore the map and the strength; the mesh or the extender may have gone."""
        with suppress(ReferenceError, IndexError), following.not_following():
            self.islands.restore()
            storage.of(self._mesh)[self._index].strength = self._former

    def begin(self, context: bpy.types.Context) -> None:
        """Update the map for the wanted amount; if that fails, both stay and the status bar says why."""
        note = translate(texts.ADJUST_EXTENDER_KEYS)
        try:
            self.show(self._wanted)
        except ReadableError as error:
            note = str(error)
        progress.show_status(context, texts.adjusting(f"{self.answer:.1f}", note))
        editors.redraw(context)

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle mouse movement, slower with Shift; Enter or a click confirms."""
        if not self._bm.is_valid:
            raise ReadableError(texts.canceled(texts.ADJUST_EXTENDER_LABEL))
        if event.type in _CONFIRM and event.value == "PRESS":
            return {"FINISHED"}
        if event.type != "MOUSEMOVE":
            return {"PASS_THROUGH"}
        moved = event.mouse_x - (event.mouse_x if self._mouse_x is None else self._mouse_x)
        self._mouse_x = event.mouse_x
        self._wanted = min(max(self.answer + moved * _STEP * (_PRECISION if event.shift else 1.0), -100.0), 100.0)
        self.begin(context)
        return {"RUNNING_MODAL"}
