# SPDX-License-Identifier: GPL-3.0-or-later
"""The editors in which the add-on draws: 3D viewports, and image editors, which show UVs."""

import bpy

_KINDS = ("VIEW_3D", "IMAGE_EDITOR")


def redraw(context: bpy.types.Context, *kinds: str) -> None:
    """Draw these kinds of editors again in all windows; without any, all in which the add-on draws."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in (kinds or _KINDS):
                area.tag_redraw()
