# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that add extenders to meshes in edit mode, change their strength and remove them."""

from collections.abc import Mapping
from contextlib import ExitStack, suppress

import bmesh
import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from .. import editors, names
from ..core.errors import ReadableError
from ..core.extenders.adjustment import AdjustmentError
from ..core.extenders.pairs import SelectionError, pairs
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..extenders import storage
from ..extenders.storage import STRENGTH, STRENGTH_LIMIT
from ..live import following
from ..live.extenders import AdjustedIslands
from ..session import edit_meshes
from ..ui import progress
from .job_operator import Job, JobOperator
from .reporting_operator import ReportingOperator

# Panels set these for one click; they are neither remembered nor shown in Adjust Last Operation.
_FOR_ONE_CALL = {"HIDDEN", "SKIP_SAVE"}
# Change of strength per pixel: 100 pixels make 1, which counts like the whole border.
_STEP = 0.01
# Factor with Shift, as in Blender's own transforms.
_PRECISION = 0.1
_CONFIRM = {"LEFTMOUSE", "RET", "NUMPAD_ENTER"}


class _ExtenderOperator(ReportingOperator):
    """Base of the operators on one extender of the active object's mesh."""

    index: IntProperty(**texts.INDEX_PROPERTY, default=-1, min=-1, options=_FOR_ONE_CALL)

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


def _follow(
    operator: bpy.types.Operator, edit_object: bpy.types.Object, strengths: Mapping[tuple[int, int], float]
) -> bool:
    """Let the map follow changed extenders in the operator's own undo step, or report why it cannot.

    Returns whether it follows.
    """
    follows = True
    try:
        note = following.follow_extenders(edit_object, strengths) if strengths else ""
    except (ReadableError, MemoryError) as error:
        follows = False
        note = str(error) if isinstance(error, ReadableError) else translate(texts.OUT_OF_MEMORY_TO_FOLLOW)
    if note:
        operator.report({"WARNING"}, note)
    return follows


class MESH_OT_spectral_extender_add(ReportingOperator, bpy.types.Operator):
    """Add extenders between the selected vertices of every mesh in edit mode."""

    bl_idname = names.ADD_EXTENDER_OPERATOR
    bl_label = texts.ADD_EXTENDER_LABEL
    bl_description = texts.ADD_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    strength: FloatProperty(**STRENGTH)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode."""
        return context.mode == "EDIT_MESH"

    def run(self, context: bpy.types.Context) -> set[str]:
        """Find the pairs of all meshes, then add extenders."""
        if self.strength != self.strength:
            raise SelectionError(translate(texts.STRENGTH_IS_NO_NUMBER))
        wanted, edited = {}, context.objects_in_mode_unique_data
        for edit_object in edited:
            selected, active = selection.selected_vertices(context, edit_object.data)
            try:
                if selected:
                    wanted[edit_object] = pairs(selected, active)
            except SelectionError as error:
                raise SelectionError(f"{edit_object.name}: {error}" if len(edited) > 1 else str(error)) from error
        if not wanted:
            raise SelectionError(translate(texts.NO_VERTICES_SELECTED))
        added = {each: storage.add(each.data, made, self.strength) for each, made in wanted.items()}
        follows = following.is_on(context.scene)
        if follows and self.strength != 0.0:
            for edit_object, made in added.items():
                follows &= _follow(self, edit_object, dict.fromkeys(made, self.strength))
        count = sum(map(len, added.values()))
        existing = sum(map(len, wanted.values())) - count
        self.report({"INFO" if count else "WARNING"}, texts.added_extenders(count, existing, follows))
        return {"FINISHED"} if count else {"CANCELLED"}


class MESH_OT_spectral_extender_remove(_ExtenderOperator, bpy.types.Operator):
    """Remove one extender, or all broken ones."""

    bl_idname = names.REMOVE_EXTENDER_OPERATOR
    bl_label = texts.REMOVE_EXTENDER_LABEL
    bl_description = texts.REMOVE_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    broken: BoolProperty(**texts.BROKEN_PROPERTY, options=_FOR_ONE_CALL)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what is removed."""
        broken = properties.broken
        return translate(texts.REMOVE_BROKEN_EXTENDERS_DESCRIPTION if broken else texts.REMOVE_EXTENDER_DESCRIPTION)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Remove from the list of the active object's mesh."""
        mesh = context.edit_object.data
        ends, listed = storage.ends(bmesh.from_edit_mesh(mesh), mesh), storage.of(mesh)
        if self.broken:
            indices = [index for index, pair in enumerate(ends) if -1 in pair]
            self.report({"INFO"}, texts.removed_broken(len(indices)))
        else:
            indices = [self.chosen(mesh)]
        if not indices:
            return {"CANCELLED"}
        acting = [ends[k] for k in indices if -1 not in ends[k] and listed[k].use and listed[k].strength != 0.0]
        storage.remove(mesh, indices)
        if following.is_on(context.scene):
            _follow(self, context.edit_object, dict.fromkeys(acting, 0.0))
        return {"FINISHED"}


class MESH_OT_spectral_extender_adjust(JobOperator, _ExtenderOperator, bpy.types.Operator):
    """Change the strength of an extender, and the map of its island."""

    bl_idname = names.ADJUST_EXTENDER_OPERATOR
    bl_label = texts.ADJUST_EXTENDER_LABEL
    bl_description = texts.ADJUST_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    strength: FloatProperty(**STRENGTH)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where there are extenders, one job at a time."""
        return super().poll(context) and _ExtenderOperator.poll(context)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Drag the strength, store it and write the map; any other end restores both."""
        mesh = context.edit_object.data
        index = self.chosen(mesh)
        extender, bm = storage.of(mesh)[index], edit_meshes.keep(mesh).bm
        ends = storage.ends(bm, mesh)[index]
        if -1 in ends:
            raise AdjustmentError(texts.broken_extender(storage.label(extender)))
        islands = AdjustedIslands(context.edit_object, [ends])
        if islands.note:
            self.report({"INFO"}, islands.note)
        with ExitStack() as back:
            back.callback(_give_back, mesh, index, extender.strength, islands)
            if is_interactive:
                self.strength = (yield _Drag(mesh, index, islands)).result
            with following.not_following():
                storage.of(mesh)[index].strength = self.strength
                islands.write([self.strength], is_final=True)
                islands.update_list()
            back.pop_all()
        return {"FINISHED"}


def _give_back(mesh: bpy.types.Mesh, index: int, strength: float, islands: AdjustedIslands) -> None:
    # The mesh may have gone.
    with suppress(ReferenceError), following.not_following():
        if index < len(storage.of(mesh)):
            storage.of(mesh)[index].strength = strength
        islands.restore()


class _Drag:
    """Asks for a strength, by dragging or as a typed number, while the map follows; a `job_operator.Choice`.

    Attributes:
        answer: the strength.
    """

    def __init__(self, mesh: bpy.types.Mesh, index: int, islands: AdjustedIslands) -> None:
        """Begin at the strength that the extender has."""
        self._mesh, self._index, self._islands = mesh, index, islands
        self._bm = edit_meshes.keep(mesh).bm
        strength = storage.of(mesh)[index].strength
        # A file may have a strength that is not finite.
        self.answer = self._dragged = strength if abs(strength) <= STRENGTH_LIMIT else 0.0
        self._typed = ""
        self._mouse_x: int | None = None

    def begin(self, context: bpy.types.Context) -> None:
        """Update the map for the strength; if that fails, it stays and the status bar says why."""
        note = translate(texts.ADJUST_EXTENDER_KEYS)
        try:
            with following.not_following():
                storage.of(self._mesh)[self._index].strength = self.answer
                self._islands.write([self.answer], is_final=False)
        except AdjustmentError as error:
            note = str(error)
        number = f"[{self._typed}|]" if self._typed else f"{self.answer:.3f}"
        progress.show_status(context, texts.adjusting(number, note))
        editors.redraw(context)

    def leaves(self, _context: bpy.types.Context, _event: bpy.types.Event) -> bool:
        """Keep all events: the mouse drags wherever it is."""
        return False

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle mouse movement, slower with Shift, and typed numbers; Enter or a click confirms."""
        if not self._bm.is_valid:
            raise AdjustmentError(texts.cancelled(texts.ADJUST_EXTENDER_LABEL))
        if event.type == "MOUSEMOVE":
            moved = event.mouse_x - (event.mouse_x if self._mouse_x is None else self._mouse_x)
            self._mouse_x = event.mouse_x
            self._dragged += moved * _STEP * (_PRECISION if event.shift else 1.0)
        elif event.value != "PRESS" or not (event.type in _CONFIRM or self._type(event)):
            return {"PASS_THROUGH"}
        elif event.type in _CONFIRM:
            return {"FINISHED"}
        self._dragged = _bounded(self._dragged)
        has_digit = any(map(str.isdigit, self._typed))
        self.answer = _bounded(float(self._typed)) if has_digit else self._dragged
        self.begin(context)
        return {"RUNNING_MODAL"}

    def update(self, context: bpy.types.Context) -> None:
        """Do nothing."""

    def end(self, context: bpy.types.Context) -> None:
        """Restore the status bar."""
        progress.clear_status(context)

    def _type(self, event: bpy.types.Event) -> bool:
        """Handle a key of a typed number, where minus changes the sign as in Blender; return whether it was one."""
        key = "." if event.ascii == "," else event.ascii
        if event.type == "BACK_SPACE":
            self._typed = self._typed[:-1]
        elif key == "-":
            self._typed = self._typed.removeprefix("-") if self._typed.startswith("-") else f"-{self._typed}"
        elif key and (key in "0123456789" or (key == "." and "." not in self._typed)):
            self._typed += key
        else:
            return False
        return True


def _bounded(strength: float) -> float:
    return min(max(strength, -STRENGTH_LIMIT), STRENGTH_LIMIT)
