# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's unwrap menus."""

from collections.abc import Callable

import bpy

from .. import names
from ..core import texts


class UV_MT_spectral(bpy.types.Menu):
    """What else there is to do with a map, so that it is found by its name, too."""

    bl_idname = names.SUBMENU
    bl_label = texts.SUBMENU_LABEL

    def draw(self, context: bpy.types.Context) -> None:
        """List the operators that stand in no menu of Blender's, in the order of work."""
        layout, overlay = self.layout, getattr(context.window_manager, names.MAP_OVERLAY_PROPERTY)
        layout.prop(overlay, "show", text=texts.MAP_OVERLAY_LABEL)
        layout.operator_context = "INVOKE_REGION_WIN"
        layout.operator(names.INSPECT_OPERATOR)
        layout.operator(names.COMPARE_OPERATOR)
        layout.operator(names.STORE_OPERATOR)
        layout.operator_context = "EXEC_REGION_WIN"
        layout.operator(names.SELECT_DISTORTED_OPERATOR)
        layout.separator()
        layout.operator(names.ADD_EXTENDER_OPERATOR).pairs = texts.PAIRS_IN_ORDER
        layout.operator(names.ADD_EXTENDER_OPERATOR, text=texts.ADD_TO_ACTIVE_LABEL).pairs = texts.PAIRS_TO_ACTIVE
        layout.operator_context = "INVOKE_REGION_WIN"
        layout.operator(names.ADJUST_EXTENDER_OPERATOR).index = -1
        layout.operator_context = "EXEC_REGION_WIN"
        layout.operator(names.SELECT_EXTENDER_OPERATOR).index = -1
        layout.operator(names.REMOVE_EXTENDER_OPERATOR).broken = False


def _draw_unwrap(layout: bpy.types.UILayout) -> None:
    # Blender's menu leaves its layout set to execute operators, which would freeze the window during a long solve.
    layout.operator_context = "INVOKE_REGION_WIN"
    layout.operator(names.UNWRAP_OPERATOR)


def _draw_in_viewport(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.prop(context.scene, names.LIVE_UNWRAP_PROPERTY)
    _draw_unwrap(self.layout)
    self.layout.operator(names.SELECT_FAILED_OPERATOR)
    self.layout.operator(names.SELECT_DEFECTS_OPERATOR)
    self.layout.operator(names.SUGGEST_SEAMS_OPERATOR)
    self.layout.menu(names.SUBMENU)


def _draw_in_uv_editor(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    # Newer versions draw the UV editor's Unwrap menu inside the viewport's menu, which has its own entry.
    if context.area.type == "IMAGE_EDITOR":
        self.layout.separator()
        self.layout.prop(context.scene, names.LIVE_UNWRAP_PROPERTY)
        _draw_unwrap(self.layout)
        self.layout.operator(names.SUGGEST_SEAMS_OPERATOR)
        self.layout.menu(names.SUBMENU)


def _draw_in_select_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(names.SELECT_FAILED_OPERATOR)
    self.layout.operator(names.SELECT_DEFECTS_OPERATOR)
    self.layout.operator(names.SELECT_DISTORTED_OPERATOR)


def _draw_by_trait(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(names.SELECT_DEFECTS_OPERATOR)
    self.layout.operator(names.SELECT_DISTORTED_OPERATOR)


def _entries() -> list[tuple[type, Callable]]:
    """Return the menus of this Blender version that get entries, each with its draw function."""
    uv_editor = getattr(bpy.types, names.UV_EDITOR_UNWRAP_MENU, None) or getattr(bpy.types, names.UV_EDITOR_MENU)
    return [
        (getattr(bpy.types, names.VIEWPORT_UNWRAP_MENU), _draw_in_viewport),
        (uv_editor, _draw_in_uv_editor),
        (getattr(bpy.types, names.UV_EDITOR_SELECT_MENU), _draw_in_select_menu),
        (getattr(bpy.types, names.VIEWPORT_SELECT_BY_TRAIT_MENU), _draw_by_trait),
    ]


def register() -> None:
    """Add the menu and the entries."""
    bpy.utils.register_class(UV_MT_spectral)
    for menu, draw in _entries():
        menu.append(draw)


def unregister() -> None:
    """Remove the entries and the menu."""
    for menu, draw in _entries():
        menu.remove(draw)
    bpy.utils.unregister_class(UV_MT_spectral)
