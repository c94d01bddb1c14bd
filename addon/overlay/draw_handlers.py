# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that Blender calls whenever it draws an editor."""

from collections.abc import Callable

import bpy

from .. import editors, session
from ..core.words import texts
from ..session import Lifetime, Remembered
from ..session.problems import print_once


class DrawHandler:
    """Draws over the main regions of a kind of editor until it is removed; each error is printed once."""

    def __init__(self, space: type, draw: Callable[[bpy.types.Context], None], when: str, name: str) -> None:
        """Call `draw` from now on.

        Args:
            space: the kind of editor, such as `bpy.types.SpaceView3D`.
            draw: the function to call.
            when: "POST_VIEW" for coordinates of the view, "POST_PIXEL" for pixels.
            name: of the drawing, for errors.
        """

        def guarded() -> None:
            try:
                draw(bpy.context)
            except Exception as error:  # noqa: BLE001 - it would come again with every redraw
                print_once(error, lambda problem: texts.not_drawn(name, problem))

        self._space = space
        self._handle = space.draw_handler_add(guarded, (), "WINDOW", when)

    def remove(self) -> None:
        """Stop drawing."""
        self._space.draw_handler_remove(self._handle, "WINDOW")
        editors.redraw(bpy.context)


class Preview:
    """What an operator draws in all editors of a kind until it is removed."""

    def __init__(self) -> None:
        """Draw nothing yet."""
        self._handle: DrawHandler | None = None

    def draw_in(self, context: bpy.types.Context, space: type) -> None:
        """Draw in this kind of editor from now on, and again if something has changed."""
        # Background mode draws nothing.
        if self._handle is None and not bpy.app.background:
            self._handle = DrawHandler(space, self._draw, "POST_VIEW", name=texts.SUGGEST_SEAMS_LABEL)
        editors.redraw(context)

    def remove(self) -> None:
        """Stop drawing."""
        if self._handle is not None:
            self._handle.remove()
            self._handle = None

    def _draw(self, context: bpy.types.Context) -> None:
        raise NotImplementedError


class _OfAddon(Remembered):
    """The handlers that draw while the add-on is enabled."""

    lifetime = Lifetime.ADDON

    def __init__(self) -> None:
        self.handlers: list[DrawHandler] = []

    def end(self) -> None:
        for handler in self.handlers:
            handler.remove()


def add(space: type, draw: Callable[[bpy.types.Context], None], when: str, name: str) -> None:
    """Draw as a `DrawHandler` does while the add-on is enabled; not in background mode."""
    if not bpy.app.background:
        session.of(_OfAddon).handlers.append(DrawHandler(space, draw, when, name))
