# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that get better in the view until the artist ends it."""

import time
from collections.abc import Generator, Sequence
from typing import Any, Protocol

import bpy
import numpy as np

from .. import user_preferences
from ..core.solve.progress import Progress
from ..core.solve.worker import Worker
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh
from ..live import following
from ..ui.progress import HeaderText, show_status
from ..unwrapping import relaxing

_KEEP = {"RET", "NUMPAD_ENTER", "LEFTMOUSE"}
# Fraction of the time that drawing large maps may take.
_MAX_LOAD = 0.5


class Improved(Protocol):
    """Maps in progress, (C, 2) each."""

    maps: Sequence[np.ndarray]


class ImprovingView:
    """Improves maps in a thread and draws their progress. A `job_operator.Choice`.

    Attributes:
        answer: the last drawn maps; None before the first.
        is_stopped: whether the artist has ended it.
    """

    def __init__(self, edit_meshes: Sequence[EditMesh]) -> None:
        """Take meshes with a UV map."""
        self.answer: Improved | None = None
        self.is_stopped = False
        self._edit_meshes = edit_meshes
        # What the thread hands over: the corners that may move, (C,) bool each, and the last maps.
        self._corners: Sequence[np.ndarray] = ()
        self._latest: Improved | None = None
        self._worker: Worker[None] | None = None
        self._keys: HeaderText | None = None
        self._next_drawing = 0.0

    def begin(self, context: bpy.types.Context) -> None:
        """Start the thread, and show the keys in the header of the editor."""
        self._keys = HeaderText(context, translate(texts.IMPROVING_KEYS))
        self._worker = Worker(self._run, user_preferences.read("threads", 0))
        show_status(context, self._status())

    def leaves(self, _context: bpy.types.Context, _event: bpy.types.Event) -> bool:
        """Keep all events."""
        return False

    def handle(self, _context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """End at Enter or a click, with the map as it is drawn."""
        if event.type in _KEEP and event.value == "PRESS":
            self.is_stopped = True
            return {"FINISHED"}
        return {"PASS_THROUGH"}

    def update(self, context: bpy.types.Context) -> bool:
        """Draw what is new; return whether the work has ended."""
        # Asked first, because the thread hands over its last maps before it ends.
        has_ended = self._worker.wait(0.0)
        start = time.monotonic()
        if has_ended or start >= self._next_drawing:
            self._draw(context)
            end = time.monotonic()
            self._next_drawing = end + (end - start) * (1.0 / _MAX_LOAD - 1.0)
        if has_ended:
            self._worker.result()
        return has_ended

    def end(self, _context: bpy.types.Context) -> None:
        """Stop the thread and remove everything shown but the map."""
        self._worker.cancel()
        self._keys.end()

    def restore(self) -> None:
        """Write the maps as they were."""
        if self.answer is not None:
            relaxing.restore(self._edit_meshes, self._corners)

    def _draw(self, context: bpy.types.Context) -> None:
        latest = self._latest
        if latest is None or latest is self.answer or not relaxing.are_there(self._edit_meshes):
            return
        relaxing.write(self._edit_meshes, latest.maps, self._corners)
        self.answer = latest
        show_status(context, self._status())

    def _run(self, progress: Progress) -> None:
        """Improve the maps; set `_corners` once and `_latest` repeatedly; runs in the thread."""
        raise NotImplementedError

    def _status(self) -> str:
        """Return the text of the status bar for the `answer`."""
        raise NotImplementedError


def improve(view: ImprovingView) -> Generator[ImprovingView, Any, Any]:
    """Run a view as part of a job and return its last maps; if the job is cancelled, restore the former ones."""
    with following.not_following():
        try:
            return (yield view).result
        except GeneratorExit:
            view.restore()
            raise
