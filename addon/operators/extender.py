# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that drags a Push/Pull of a mesh in edit mode, while the map follows."""

from contextlib import suppress

import bpy

from .. import editors, names
from ..core.errors import ReadableError
from ..core.extenders.pairs import amount_of, strength_of
from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import extenders as storage
from ..edit_mesh import shapes
from ..live import extenders as live
from ..live import following
from ..session import edit_meshes
from ..ui import progress
from ..unwrapping.last_settings import settings_for
from .job_operator import Choice, Job, JobOperator
from .property_kinds import push_amount

# Change of the amount per pixel, in percent: 400 pixels from nothing to the whole effect.
_STEP = 0.25
# Factor with Shift, as in Blender's own transforms.
_PRECISION = 0.1
_CONFIRM = {"LEFTMOUSE", "RET", "NUMPAD_ENTER"}


class UV_OT_spectral_extender(JobOperator, bpy.types.Operator):
    """Change the strength of a Push/Pull, and the map of its island."""

    bl_idname = names.EXTENDER_OPERATOR
    bl_label = texts.ADJUST_EXTENDER_LABEL
    bl_description = "Drag to push the two vertices apart or pull them together; their island follows"
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    amount: push_amount()

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has one."""
        return super().poll(context) and len(storage.of(context.edit_object.data)) > 0

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Drag the amount, store it and write the map; any other end restores both."""
        drag = _Drag(context.edit_object, settings_for(self))
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

    def __init__(self, edit_object: bpy.types.Object, settings: Settings) -> None:
        """Begin at the amount that the active extender has."""
        self._mesh, self._index = edit_object.data, shapes.active(edit_object.data)
        self._bm = edit_meshes.keep(self._mesh).bm
        extender = shapes.listed(self._mesh)[self._index]
        if extender.kind != shapes.EXTENDER:
            raise ReadableError(translate("Choose a Push/Pull in the list first"))
        stored = dict(storage.of(self._mesh))
        self._pair = storage.ends(self._mesh)[list(stored).index(extender.layer)]
        if -1 in self._pair:
            raise ReadableError(translate("{name} lost a vertex; remove it and add another").format(name=extender.name))
        self.islands = live.AdjustedIslands(edit_object, [self._pair], settings)
        self._former, self._half, self._mouse_x = extender.strength, stored[extender.layer].half, None
        self.answer = self._wanted = amount_of(self._former, self._half)

    def show(self, amount: float, is_final: bool = False) -> None:
        """Let the map follow an amount, then set it in the list."""
        strength = strength_of(amount, self._half)
        with following.not_following():
            self.islands.write((*self._pair, strength, self._half), is_final)
            shapes.listed(self._mesh)[self._index].strength, self.answer = strength, amount

    def give_back(self) -> None:
        """Restore the map and the strength; the mesh or the extender may have gone."""
        with suppress(ReferenceError, IndexError), following.not_following():
            self.islands.restore()
            shapes.listed(self._mesh)[self._index].strength = self._former

    def begin(self, context: bpy.types.Context) -> None:
        """Update the map for the wanted amount; if that fails, both stay and the status bar says why."""
        note = translate("Enter or click: Confirm   Esc or right click: Cancel   Shift: Precision")
        try:
            self.show(self._wanted)
        except ReadableError as error:
            note = str(error)
        progress.show_status(context, texts.status(texts.ADJUST_EXTENDER_LABEL, f"{self.answer:.1f} %", note))
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
