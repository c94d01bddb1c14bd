# SPDX-License-Identifier: GPL-3.0-or-later
"""The relaxation that runs in the view until the artist ends it."""

import time
from collections.abc import Sequence

import bpy

from .. import user_preferences
from ..core.solve.progress import Progress
from ..core.solve.relaxing import Relaxed, Relaxing, RelaxOptions
from ..core.solve.worker import Worker
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh
from ..ui.progress import HeaderText, clear_status, show_status
from ..unwrapping import relaxing

_KEEP = {"RET", "NUMPAD_ENTER", "LEFTMOUSE"}
# Fraction of the time that drawing large maps may take.
_MAX_LOAD = 0.5


class RelaxView:
    """Relaxes maps in a thread and draws them on their way. A `job_operator.Choice`.

    Attributes:
        answer: the last drawn maps; None before the first.
        is_stopped: whether the artist has ended it.
        can_move: whether anything may move; True until that is known.
    """

    def __init__(self, edit_meshes: Sequence[EditMesh], options: RelaxOptions, max_steps: int) -> None:
        """Take meshes with a UV map."""
        self.answer: Relaxed | None = None
        self.is_stopped = False
        self.can_move = True
        self._edit_meshes = edit_meshes
        self._options = options
        self._max_steps = max_steps
        # What the thread hands over: the relaxation once it has begun, and its last maps.
        self._relaxing: Relaxing | None = None
        self._latest: Relaxed | None = None
        self._worker: Worker[None] | None = None
        self._keys: HeaderText | None = None
        self._next_drawing = 0.0

    def begin(self, context: bpy.types.Context) -> None:
        """Start the thread, and show the keys in the header of the editor."""
        self._keys = HeaderText(context, translate(texts.RELAX_KEYS))
        self._worker = Worker(self._run, user_preferences.read("threads", 0))
        show_status(context, texts.relax_status(0.0, 0))

    def leaves(self, _context: bpy.types.Context, _event: bpy.types.Event) -> bool:
        """Keep all events."""
        return False

    def handle(self, _context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """End by Enter or a click, with the map as it is drawn."""
        if event.type in _KEEP and event.value == "PRESS":
            self.is_stopped = True
            return {"FINISHED"}
        return {"PASS_THROUGH"}

    def update(self, context: bpy.types.Context) -> bool:
        """Draw what is new; return whether the relaxation has ended."""
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

    def end(self, context: bpy.types.Context) -> None:
        """Stop the thread and remove everything shown but the map."""
        self._worker.cancel()
        self._keys.end()
        clear_status(context)

    def restore(self) -> None:
        """Write the maps as they were; nothing if edit mode has ended meanwhile."""
        if self.answer is not None and relaxing.are_there(bpy.context, self._edit_meshes):
            before = [edit_mesh.polygons.uv for edit_mesh in self._edit_meshes]
            relaxing.write(self._edit_meshes, before, self._relaxing.corners)

    def _draw(self, context: bpy.types.Context) -> None:
        latest = self._latest
        if latest is None or latest is self.answer or not relaxing.are_there(context, self._edit_meshes):
            return
        relaxing.write(self._edit_meshes, latest.maps, self._relaxing.corners)
        self.answer = latest
        show_status(context, texts.relax_status(latest.gain, latest.steps))

    def _run(self, progress: Progress) -> None:
        """Relax; runs in the thread."""
        meshes = [edit_mesh.polygons for edit_mesh in self._edit_meshes]
        self._relaxing = Relaxing(meshes, self._options, progress)
        self.can_move = self._relaxing.can_move
        steps, goes_on = 0, self.can_move
        while goes_on and steps < self._max_steps:
            goes_on = self._relaxing.step(1, progress)
            steps += 1
            self._latest = self._relaxing.now()
