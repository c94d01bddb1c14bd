# SPDX-License-Identifier: GPL-3.0-or-later
"""The progress of a solve: at the mouse cursor and in the status bar, or printed in background mode."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext

import bpy

from .. import session
from ..core.solve.progress import Progress
from ..core.words import texts
from ..session import Remembered

# Events that pass during a solve in the background: they move the view, or do nothing.
_VIEW_EVENTS = frozenset(
    {
        *("MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "WINDOW_DEACTIVATE", "NONE"),
        *("MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE", "WHEELOUTMOUSE"),
        *("TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM"),
    }
)
# Seconds between printed lines, and before the first.
_PRINT_SECONDS = 1.0


def moves_view(event: bpy.types.Event) -> bool:
    """Return whether an event may reach the editors during a solve."""
    return event.type in _VIEW_EVENTS or event.type.startswith(("NDOF_", "TIMER"))


class WindowProgress:
    """Progress at the mouse cursor and in the status bar."""

    def __init__(self, context: bpy.types.Context, label: str, fraction: float, phase: str) -> None:
        """Show the progress of the operator with this label."""
        self._label = label
        self._window_manager = context.window_manager
        self._window_manager.progress_begin(0, 100)
        self.update(context, fraction, phase)

    def update(self, context: bpy.types.Context, fraction: float, phase: str) -> None:
        """Show the fraction done and the phase."""
        percent = _percent(fraction)
        self._window_manager.progress_update(percent)
        show_status(context, texts.progress(self._label, percent, phase))

    def end(self, _context: bpy.types.Context) -> None:
        """Remove the progress at the cursor; `clear_status` removes the text."""
        self._window_manager.progress_end()


class _StatusTexts(Remembered):
    """The workspaces whose status bar has a text of the add-on; the user may switch to another meanwhile."""

    def __init__(self) -> None:
        self.shown: list[tuple[bpy.types.WorkSpace, str]] = []

    def end(self) -> None:
        self.clear(bpy.context)

    def clear(self, context: bpy.types.Context) -> None:
        windows = context.window_manager.windows
        while self.shown:
            workspace, _ = self.shown.pop()
            if workspace == context.workspace:
                workspace.status_text_set(None)
            elif _exists(workspace) and len(windows):
                # Blender sets the text in the context's workspace and needs a window; one call with both would take the
                # workspace of the window.
                window = nullcontext() if context.window else context.temp_override(window=windows[0])
                with window, context.temp_override(workspace=workspace):
                    workspace.status_text_set(None)


def show_status(context: bpy.types.Context, text: str) -> None:
    """Show a text in the status bar instead of Blender's, until `clear_status`."""
    known = session.of(_StatusTexts)
    # Blender redraws for every text, even the same one.
    if (context.workspace, text) not in known.shown:
        context.workspace.status_text_set(text)
        others = [each for each in known.shown if each[0] != context.workspace]
        known.shown = [*others, (context.workspace, text)]


def lose_status() -> None:
    """Have the next `show_status` show its text again: another operator may have removed it."""
    known = session.of(_StatusTexts)
    known.shown = [(workspace, "") for workspace, _ in known.shown]


def clear_status(context: bpy.types.Context) -> None:
    """Give the status bar back to Blender in all workspaces, in any context."""
    session.of(_StatusTexts).clear(context)


def _exists(data_block: bpy.types.ID) -> bool:
    try:
        return bool(data_block.name)
    except ReferenceError:
        return False


@contextmanager
def blocking(context: bpy.types.Context, label: str = texts.UNWRAP_LABEL) -> Iterator[Progress]:
    """Yield the progress function of a solve that blocks Blender; `label` is the operator's."""
    if bpy.app.background:
        yield _news(lambda *shown: print(texts.printed_progress(label, *shown), flush=True), _PRINT_SECONDS)
        return
    window_manager = context.window_manager
    window_manager.progress_begin(0, 100)
    try:
        yield _news(lambda percent, _phase: window_manager.progress_update(percent), 0.0)
    finally:
        window_manager.progress_end()


def _news(show: Callable[[int, str], None], seconds: float) -> Progress:
    """Return a progress function that shows the percentage and the phase if the first has grown, after some seconds."""
    shown_at, shown = time.monotonic(), 0

    def progress(fraction: float, phase: str) -> None:
        nonlocal shown_at, shown
        now, percent = time.monotonic(), _percent(fraction)
        if percent > shown and now - shown_at >= seconds:
            show(percent, phase)
            shown_at, shown = now, percent

    return progress


def _percent(fraction: float) -> int:
    return int(100.0 * fraction)
