# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that changes an extender's strength while its island follows."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
from bpy.props import FloatProperty, IntProperty

from .. import editors, names
from ..core.extenders.adjustment import AdjustmentError
from ..core.extenders.typed_number import TypedNumber
from ..core.words import texts
from ..core.words.translation import translate
from ..extenders.strength import STRENGTH, STRENGTH_LIMIT
from ..live.adjusted_map import AdjustedMap
from ..ui import progress
from .extender_list import INDEX, ExtenderOperator

# Change of strength per pixel: 100 pixels make 1, the strength that counts like the whole border.
_STEP = 0.01
# What Shift makes of it, as in Blender's own transforms.
_PRECISION = 0.1


class MESH_OT_spectral_extender_adjust(ExtenderOperator, bpy.types.Operator):
    """Change the strength of an extender, and the map of its island with it."""

    bl_idname = names.ADJUST_EXTENDER_OPERATOR
    bl_label = texts.ADJUST_EXTENDER_LABEL
    bl_description = texts.ADJUST_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    index: IntProperty(**INDEX)
    strength: FloatProperty(**STRENGTH)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Set the strength and solve the island again."""
        return self._keep(self._adjusted(context))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin to drag at the strength that the extender has; where nobody can drag, set the strength at once."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.reporting(self._begin, context, event)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Drag, type, confirm or cancel; view navigation goes on."""
        return self.reporting(self._handle, context, event)

    def cancel(self, context: bpy.types.Context) -> None:
        """Give map and strength back as they were. Blender calls it on closing, too."""
        self._end(context)
        if self._map.is_shown:
            self._map.restore()

    def _begin(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._map = self._adjusted(context)
        self._dragged = self.strength = self._map.start
        self._mouse_x = event.mouse_x
        self._typed = TypedNumber()
        self._problem = ""
        with self._restored_on_error(context):
            self._show(context)
            context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        is_over = context.mode != "EDIT_MESH" or not self._map.is_shown or not self._map.is_valid
        if is_over or (event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"):
            self.cancel(context)
            return {"CANCELLED"}
        with self._restored_on_error(context):
            if event.type == "MOUSEMOVE":
                self._drag(context, event)
            elif event.type in {"LEFTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS":
                self._end(context)
                return self._keep(self._map)
            elif event.value == "PRESS" and self._type(event):
                self._show(context)
            elif progress.moves_view(event):
                return {"PASS_THROUGH"}
        return {"RUNNING_MODAL"}

    @contextmanager
    def _restored_on_error(self, context: bpy.types.Context) -> Iterator[None]:
        try:
            yield
        except BaseException:
            self.cancel(context)
            raise

    def _adjusted(self, context: bpy.types.Context) -> AdjustedMap:
        """Return the map to adjust.

        Raises:
            ReadableError: there is none.
        """
        adjusted = AdjustedMap(context, self.chosen(context.edit_object.data))
        if adjusted.note:
            self.report({"INFO"}, adjusted.note)
        return adjusted

    def _drag(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        moved, self._mouse_x = event.mouse_x - self._mouse_x, event.mouse_x
        limit = STRENGTH_LIMIT
        step = _STEP * (_PRECISION if event.shift else 1.0)
        self._dragged = min(max(self._dragged + step * moved, -limit), limit)
        if moved and not self._typed.text:
            self.strength = self._dragged
            self._show(context)

    def _type(self, event: bpy.types.Event) -> bool:
        """Take a key of a typed number; return whether it was one."""
        if event.type == "BACK_SPACE":
            self._typed.erase()
        elif not (event.ascii and self._typed.type(event.ascii)):
            return False
        # The property bounds it.
        self.strength = self._dragged if self._typed.value is None else self._typed.value
        return True

    def _show(self, context: bpy.types.Context) -> None:
        """Let the map follow the strength; where it cannot, it stays as it was and the status bar says why."""
        try:
            self._map.show(self.strength)
            self._problem = ""
        except AdjustmentError as error:
            self._problem = str(error)
        number = f"[{self._typed.text}|]" if self._typed.text else f"{self.strength:.3f}"
        note = self._problem or translate(texts.ADJUST_EXTENDER_KEYS)
        progress.show_status(context, texts.adjusting(number, note))
        editors.redraw(context)

    def _keep(self, adjusted: AdjustedMap) -> set[str]:
        """Write the map of the strength in full precision and store the strength.

        Raises:
            AdjustmentError: an island could not be solved; everything is as it was.
        """
        try:
            adjusted.show(self.strength, is_final=True)
            adjusted.keep(self.strength)
        except BaseException:
            adjusted.restore()
            raise
        return {"FINISHED"}

    def _end(self, context: bpy.types.Context) -> None:
        progress.clear_status(context)
