# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that changes an extender's strength while its island follows."""

import bpy
from bpy.props import FloatProperty, IntProperty

from .. import names
from ..core import texts
from ..core.extender_adjustment import AdjustmentError
from ..core.native import NativeModuleError
from ..core.typed_number import TypedNumber
from ..extenders import storage
from ..extenders.adjusted_map import AdjustedMap
from ..ui import progress

# Change of strength per pixel, and what Shift makes of it.
_STEP = 0.01
_PRECISION = 0.1


class MESH_OT_spectral_extender_adjust(bpy.types.Operator):
    """Change the strength of an extender, and the map of its island with it."""

    bl_idname = names.ADJUST_EXTENDER_OPERATOR
    bl_label = texts.ADJUST_EXTENDER_LABEL
    bl_description = texts.ADJUST_EXTENDER_DESCRIPTION
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    index: IntProperty(name="Index", description="Place in the list, -1 for the active extender", default=-1, min=-1)
    strength: FloatProperty(**names.EXTENDER_STRENGTH)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has extenders."""
        return context.mode == "EDIT_MESH" and len(storage.of(context.edit_object.data)) > 0

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the strength and solve the island again."""
        adjusted = self._adjusted(context)
        return self._keep(adjusted) if adjusted else {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin to drag at the strength that the extender has."""
        adjusted = self._adjusted(context)
        if adjusted is None:
            return {"CANCELLED"}
        self._map = adjusted
        self._dragged = self.strength = adjusted.start
        self._mouse_x = event.mouse_x
        self._typed = TypedNumber()
        self._problem = ""
        self._show(context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Drag, type, confirm or cancel; view navigation goes on."""
        if context.mode != "EDIT_MESH" or not self._map.is_valid:
            self._end(context)
            return {"CANCELLED"}
        if event.type == "MOUSEMOVE":
            self._drag(context, event)
        elif event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        elif event.type in {"LEFTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS":
            self._end(context)
            return self._keep(self._map)
        elif event.value == "PRESS" and self._type(event):
            self._show(context)
        elif progress.moves_view(event):
            return {"PASS_THROUGH"}
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give the map back as it was. Blender calls it on closing, too."""
        self._end(context)
        if self._map.is_valid:
            self._map.restore()

    def _adjusted(self, context: bpy.types.Context) -> AdjustedMap | None:
        """Return the map to adjust; None having reported why there is none."""
        mesh = context.edit_object.data
        index = storage.active_index(mesh) if self.index < 0 else self.index
        if not 0 <= index < len(storage.of(mesh)):
            self.report({"ERROR"}, "No such extender; choose one in the list")
            return None
        try:
            adjusted = AdjustedMap(context, index)
        except (AdjustmentError, NativeModuleError) as error:
            self.report({"ERROR"}, str(error))
            return None
        if adjusted.note:
            self.report({"INFO"}, adjusted.note)
        return adjusted

    def _drag(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        moved, self._mouse_x = event.mouse_x - self._mouse_x, event.mouse_x
        limit = names.EXTENDER_STRENGTH_LIMIT
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
        keys = "Enter or click: Confirm   Esc or right click: Cancel   Shift: Precision   Type a number"
        text = f"{texts.ADJUST_EXTENDER_LABEL}: strength {number}   {self._problem or keys}"
        context.workspace.status_text_set(text)
        for area in context.screen.areas:
            if area.type in {"VIEW_3D", "IMAGE_EDITOR"}:
                area.tag_redraw()

    def _keep(self, adjusted: AdjustedMap) -> set[str]:
        """Write the map of the strength in full precision and store the strength."""
        try:
            adjusted.show(self.strength, is_final=True)
        except AdjustmentError as error:
            adjusted.restore()
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        adjusted.keep(self.strength)
        return {"FINISHED"}

    def _end(self, context: bpy.types.Context) -> None:
        # Blender has no workspace while it closes or loads a file.
        if context.workspace is not None:
            context.workspace.status_text_set(None)
