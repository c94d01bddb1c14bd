# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that add extenders to meshes in edit mode, change their strength and remove them."""

from collections.abc import Collection
from contextlib import ExitStack, suppress

import bmesh
import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

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

# Panels set these for one click; they are neither remembered nor shown in Adjust Last Operation.
_FOR_ONE_CALL = {"HIDDEN", "SKIP_SAVE"}
# Change of the amount per pixel, in percent: 400 pixels from nothing to the whole effect.
_STEP = 0.25
# Factor with Shift, as in Blender's own transforms.
_PRECISION = 0.1
_CONFIRM = {"LEFTMOUSE", "RET", "NUMPAD_ENTER"}


class _ExtenderOperator(ReportingOperator):
    """Base of the operators on one extender of the active object's mesh."""

    index: IntProperty(**texts.INDEX_PROPERTY, default=-1, min=-1, options=_FOR_ONE_CALL)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has extenders."""
        return super().poll(context) and len(storage.of(context.edit_object.data)) > 0

    def chosen(self, mesh: bpy.types.Mesh) -> int:
        """Return the index of the extender to work on, or raise a `ReadableError`."""
        index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY) if self.index < 0 else self.index
        if not 0 <= index < len(storage.of(mesh)):
            raise ReadableError(translate(texts.NO_SUCH_EXTENDER))
        return index


def _follow(operator: bpy.types.Operator, edit_object: bpy.types.Object, changed: Collection[tuple[int, int]]) -> bool:
    """Let the map follow changed extenders in the operator's undo step; return whether it does, or report why not."""
    note, follows = "", True
    try:
        with following.not_following():
            note = live.follow(edit_object, changed) if changed else ""
    except (ReadableError, MemoryError) as error:
        note = str(error) if isinstance(error, ReadableError) else translate(texts.OUT_OF_MEMORY_TO_FOLLOW)
        follows = False
    if note:
        operator.report({"WARNING"}, note)
    return follows


class MESH_OT_spectral_extender_add(ReportingOperator, bpy.types.Operator):
    """Add extenders between the selected vertices of every mesh in edit mode."""

    bl_idname = names.ADD_EXTENDER_OPERATOR
    bl_label = texts.ADD_EXTENDER_LABEL
    bl_description = texts.ADD_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    # Scripts may set it for all pairs, until someone moves the slider.
    strength: FloatProperty(**storage.STRENGTH, options=_FOR_ONE_CALL)
    amount: FloatProperty(**storage.NEW_AMOUNT, update=lambda self, _context: self.property_unset("strength"))

    def run(self, context: bpy.types.Context) -> set[str]:
        """Find the pairs of all meshes, then add extenders."""
        strength = self.strength if self.properties.is_property_set("strength") else None
        if self.amount != self.amount or strength != strength:
            raise ReadableError(translate(texts.STRENGTH_IS_NO_NUMBER))
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
        correct_aspect = last_settings().correct_aspect
        added = {}
        for each, made in wanted.items():
            polygons = read_mesh(each, all_visible=True, correct_aspect=correct_aspect).polygons
            added[each] = storage.add(each.data, polygons, made, self.amount, strength)
        follows = following.is_on(context.scene)
        if follows and (self.amount if strength is None else strength) != 0.0:
            follows = all([_follow(self, edit_object, made) for edit_object, made in added.items()])
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
        bm = bmesh.from_edit_mesh(mesh)
        acting, *_ = storage.resolve(bm, mesh)
        ends = storage.ends(bm, mesh)
        indices = [k for k, pair in enumerate(ends) if -1 in pair] if self.broken else [self.chosen(mesh)]
        storage.remove(mesh, indices)
        if following.is_on(context.scene):
            _follow(self, context.edit_object, {pair[:2] for pair in acting} & {ends[k] for k in indices})
        if self.broken:
            self.report({"INFO"}, texts.removed_broken(len(indices)))
        return {"FINISHED"} if indices else {"CANCELLED"}


class MESH_OT_spectral_extender_adjust(JobOperator, _ExtenderOperator, bpy.types.Operator):
    """Change the strength of an extender, and the map of its island."""

    bl_idname = names.ADJUST_EXTENDER_OPERATOR
    bl_label = texts.ADJUST_EXTENDER_LABEL
    bl_description = texts.ADJUST_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    strength: FloatProperty(**storage.STRENGTH, options={"HIDDEN"})
    half: FloatProperty(**storage.HALF_OF_PAIR)
    amount: FloatProperty(**storage.AMOUNT)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Drag the strength, store it and write the map; any other end restores both."""
        drag = _Drag(context.edit_object, self.chosen(context.edit_object.data))
        self.half = drag.half
        if drag.islands.note:
            self.report({"INFO"}, drag.islands.note)
        with ExitStack() as back:
            back.callback(drag.give_back)
            if is_interactive:
                self.strength = (yield drag).result
            drag.show(self.strength, is_final=True)
            back.pop_all()
        return {"FINISHED"}


class _Drag(Choice):
    """Asks for an amount, by dragging or as a typed number, while the map follows.

    Attributes:
        answer: the last strength that the map could follow.
        half: `half` of the extender.
        islands: the islands that follow.
    """

    def __init__(self, edit_object: bpy.types.Object, index: int) -> None:
        """Begin at the strength that the extender of this `index` has."""
        self._mesh, self._index, self._bm = edit_object.data, index, edit_meshes.keep(edit_object.data).bm
        extender, self._pair = storage.of(self._mesh)[index], storage.ends(self._bm, self._mesh)[index]
        if -1 in self._pair:
            raise ReadableError(texts.broken_extender(extender.name))
        self.islands = live.AdjustedIslands(edit_object, [self._pair])
        self.answer = self._wanted = self._former = extender.strength
        self.half = extender.half
        self._typed, self._mouse_x = "", None

    def show(self, strength: float, is_final: bool = False) -> None:
        """Let the map follow a strength, then set it in the list."""
        others = [each for each in self.islands.extenders if each[:2] != self._pair]
        with following.not_following():
            self.islands.write([*others, (*self._pair, strength)], is_final)
            storage.of(self._mesh)[self._index].strength = self.answer = strength

    def give_back(self) -> None:
        """Restore the strength and the map; the mesh may have gone."""
        with suppress(ReferenceError), following.not_following():
            if self._index < len(storage.of(self._mesh)):
                storage.of(self._mesh)[self._index].strength = self._former
            self.islands.restore()

    def begin(self, context: bpy.types.Context) -> None:
        """Update the map for the wanted strength; if that fails, both stay and the status bar says why."""
        note = translate(texts.ADJUST_EXTENDER_KEYS)
        try:
            self.show(self._wanted)
        except ReadableError as error:
            note = str(error)
        amount = f"[{self._typed}|]" if self._typed else f"{amount_of(self.answer, self.half):.1f}"
        progress.show_status(context, texts.adjusting(amount, note))
        editors.redraw(context)

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle mouse movement, slower with Shift, and typed numbers; Enter or a click confirms."""
        if not self._bm.is_valid:
            raise ReadableError(texts.cancelled(texts.ADJUST_EXTENDER_LABEL))
        if event.type == "MOUSEMOVE":
            moved = event.mouse_x - (event.mouse_x if self._mouse_x is None else self._mouse_x)
            self._mouse_x = event.mouse_x
            moved *= _STEP * (_PRECISION if event.shift else 1.0)
            self._wanted = strength_of(amount_of(self.answer, self.half) + moved, self.half)
        elif event.value != "PRESS" or not (event.type in _CONFIRM or self._type(event)):
            return {"PASS_THROUGH"}
        elif event.type in _CONFIRM:
            return {"FINISHED"}
        if any(map(str.isdigit, self._typed)):
            self._wanted = strength_of(float(self._typed), self.half)
        self.begin(context)
        return {"RUNNING_MODAL"}

    def _type(self, event: bpy.types.Event) -> bool:
        """Handle a key of a typed number, where minus changes the sign as in Blender; return whether it was one."""
        key, typed = event.ascii.replace(",", "."), self._typed
        if event.type == "BACK_SPACE":
            self._typed = typed[:-1]
        elif key == "-":
            self._typed = typed[1:] if typed.startswith("-") else f"-{typed}"
        elif key.isdigit() or (key == "." and key not in typed):
            self._typed += key
        else:
            return False
        return True
