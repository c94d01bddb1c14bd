# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's menus: our operators beside Blender's own of the same kind."""

from collections.abc import Callable

import bpy

from .. import compatibility, names
from ..core.words import texts
from .icons import OF, draw_operator, draw_shapes


class UV_MT_spectral(bpy.types.Menu):
    """A submenu of the operators that are in no menu of Blender's, so that search finds them."""

    bl_idname = names.SUBMENU
    bl_label = "Spectral"

    def draw(self, context: bpy.types.Context) -> None:
        """List the operators in the order of work."""
        layout, overlay = self.layout, getattr(context.window_manager, names.MAP_OVERLAY_PROPERTY)
        layout.prop(overlay, "show", text=texts.MAP_OVERLAY_LABEL)
        layout.operator_context = "INVOKE_REGION_WIN"
        draw_operator(layout, names.INSPECT_OPERATOR)
        draw_operator(layout, names.STORE_OPERATOR)
        layout.separator()
        layout.operator_context = "EXEC_REGION_WIN"
        _draw_hints(layout)
        layout.separator()
        layout.operator_menu_enum(names.DENSITY_OPERATOR, "kind", icon="TEXTURE")
        layout.separator()
        draw_shapes(layout)
        layout.separator()
        layout.operator_context = "INVOKE_REGION_WIN"
        draw_operator(layout, names.EXTENDER_OPERATOR)
        layout.operator_context = "EXEC_REGION_WIN"
        draw_operator(layout, names.REMOVE_SHAPE_OPERATOR)


def _draw_hints(layout: bpy.types.UILayout) -> None:
    for hint, label, _ in texts.SEAM_HINTS:
        draw_operator(layout, names.SEAM_HINT_OPERATOR, text=label).hint = hint


def _draw_invoked(layout: bpy.types.UILayout, operator: str) -> None:
    """Draw an operator that waits for its work; executed, as in Blender's menus, it would freeze the window."""
    before = layout.operator_context
    layout.operator_context = "INVOKE_REGION_WIN"
    draw_operator(layout, operator)
    # Blender's own entries that follow need the former context.
    layout.operator_context = before


def _draw_unwrap(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    _draw_invoked(self.layout, names.UNWRAP_OPERATOR)


def _draw_suggest_seams(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    _draw_invoked(self.layout, names.SUGGEST_SEAMS_OPERATOR)


def _draw_edges(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    _draw_suggest_seams(self, context)
    _draw_hints(self.layout)


def _draw_work(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    _draw_suggest_seams(self, context)
    _draw_invoked(self.layout, names.RELAX_OPERATOR)
    _draw_invoked(self.layout, names.PACK_OPERATOR)
    _draw_invoked(self.layout, names.NEW_TEXTURES_OPERATOR)
    self.layout.prop(context.scene, names.LIVE_UNWRAP_PROPERTY)
    self.layout.menu(names.SUBMENU)


def _draw_new_textures(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    _draw_invoked(self.layout, names.NEW_TEXTURES_OPERATOR)


def _draw_selectors(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator_menu_enum(names.SELECT_OPERATOR, "kind", icon=OF[names.SELECT_OPERATOR])


def _entries() -> list[tuple[str, str, Callable]]:
    """Return the menus of this Blender version that get entries, at which end, each with its draw function."""
    entries = [
        (names.UV_EDITOR_UNWRAP_MENU, "prepend", _draw_unwrap),
        (names.VIEWPORT_UNWRAP_MENU, "append", _draw_work),
        (names.UV_EDITOR_MENU, "append", _draw_work),
        (names.VIEWPORT_EDGE_MENU, "append", _draw_edges),
        (names.UV_EDITOR_SELECT_MENU, "append", _draw_selectors),
        (names.VIEWPORT_SELECT_BY_TRAIT_MENU, "append", _draw_selectors),
        (names.VIEWPORT_OBJECT_MENU, "append", _draw_new_textures),
    ]
    if not compatibility.VIEWPORT_MENU_HAS_THE_UV_EDITORS:
        entries.append((names.VIEWPORT_UNWRAP_MENU, "prepend", _draw_unwrap))
    return entries


def register() -> None:
    """Add the menu and the entries."""
    bpy.utils.register_class(UV_MT_spectral)
    for menu, end, draw in _entries():
        getattr(getattr(bpy.types, menu), end)(draw)


def unregister() -> None:
    """Remove the entries and the menu."""
    for menu, _end, draw in _entries():
        getattr(bpy.types, menu).remove(draw)
    bpy.utils.unregister_class(UV_MT_spectral)
