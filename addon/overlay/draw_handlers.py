# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that Blender calls whenever it draws an editor."""

from collections.abc import Callable

import bpy

from .. import editors, session
from ..core.words import texts
from ..session import Lifetime, Remembered
from ..session.problems import print_once


class DrawHandler:
    """Draws over the main regions of a kind of editor until it is removed; an error is printed once."""

    def __init__(self, space: type, draw: Callable[[bpy.types.Context], None], when: str, name: str) -> None:
        """Call `draw` from now on.

        Args:
            space: the kind of editor, such as `bpy.types.SpaceView3D`.
            draw: what draws.
            when: "POST_VIEW" to draw in the coordinates of the view, "POST_PIXEL" to draw in pixels.
            name: of what an error says was not drawn.
        """

        def guarded() -> None:
            try:
                draw(bpy.context)
            except Exception as error:  # noqa: BLE001 - it would come again with every redraw
                print_once(error, lambda problem: texts.not_drawn(name, problem))

        self._space = space
        self._handle = space.draw_handler_add(guarded, (), "WINDOW", when)

    def remove(self) -> None:
        """Draw nothing any more."""
        self._space.draw_handler_remove(self._handle, "WINDOW")
        editors.redraw(bpy.context)


class _OfAddon(Remembered):
    """The handlers that draw as long as the add-on is enabled."""

    lifetime = Lifetime.ADDON

    def __init__(self) -> None:
        self.handlers: list[DrawHandler] = []

    def end(self) -> None:
        for handler in self.handlers:
            handler.remove()


def add(space: type, draw: Callable[[bpy.types.Context], None], when: str, name: str) -> None:
    """Draw as a `DrawHandler` does as long as the add-on is enabled; in background mode nothing is drawn."""
    if not bpy.app.background:
        session.of(_OfAddon).handlers.append(DrawHandler(space, draw, when, name))
