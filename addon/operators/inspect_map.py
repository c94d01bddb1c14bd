# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that shows the numbers of the map under the mouse."""

import bpy

from .. import editors, names
from ..core.words.translation import translate
from ..edit_mesh import selection
from ..overlay import map_overlay, under_mouse
from ..overlay.under_mouse import FaceBelow
from ..session import identity
from ..ui import progress

_ENDS = {"ESC", "RIGHTMOUSE", "RET", "NUMPAD_ENTER"}


class UV_OT_spectral_inspect(bpy.types.Operator):
    """Show the numbers of the face under the mouse, and select its island with a click, until Esc."""

    bl_idname = names.INSPECT_OPERATOR
    bl_label = "Inspect Map"
    bl_description = "Show the numbers of the face under the mouse; click to select its island"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the overlay can be seen."""
        return context.mode in {"EDIT_MESH", "OBJECT"} and context.window is not None and not bpy.app.background

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Turn the overlay and its legend on, and follow the mouse."""
        overlay = map_overlay.settings()
        overlay.legend = True
        if not overlay.show:
            overlay.show = True
        context.window_manager.modal_handler_add(self)
        progress.show_status(context, translate("Click: Select island   Shift click: Add it   Esc or right click: End"))
        self._follow(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Follow the mouse; leave clicks outside the meshes to Blender."""
        if not map_overlay.is_on() or context.mode not in {"EDIT_MESH", "OBJECT"}:
            return self._end(context)
        if event.type in _ENDS and event.value == "PRESS":
            return self._end(context)
        if event.type == "MOUSEMOVE":
            self._follow(context, event)
        if event.type == "LEFTMOUSE" and event.value == "PRESS" and context.mode == "EDIT_MESH":
            found = self._below(context, event)
            if found is not None:
                island = found.view.island_of_face
                faces = (island == island[found.face]) & found.view.mesh.selected_faces
                selection.select_island(context, found.shown.data, faces, event.shift)
                return {"RUNNING_MODAL"}
            return {"PASS_THROUGH"}
        # The view can be moved and the sidebar used, but the mesh not changed.
        is_in_view = editors.region_at(context.screen, event.mouse_x, event.mouse_y) is not None
        return {"RUNNING_MODAL"} if is_in_view and not progress.moves_view(event) else {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Remove everything shown; Blender calls this when the window is closed."""
        self._end(context)

    def _below(self, context: bpy.types.Context, event: bpy.types.Event) -> FaceBelow | None:
        found = editors.region_at(context.screen, event.mouse_x, event.mouse_y)
        if found is None:
            return None
        area, region = found
        return under_mouse.face_below(context, area, region, event.mouse_x - region.x, event.mouse_y - region.y)

    def _follow(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        found = self._below(context, event)
        map_overlay.point_at(context, None if found is None else (identity.key(found.shown), found.face))

    def _end(self, context: bpy.types.Context) -> set[str]:
        map_overlay.point_at(context, None)
        progress.clear_status(context)
        return {"FINISHED"}
