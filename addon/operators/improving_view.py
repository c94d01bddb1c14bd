# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that get better: in the view until the artist ends it, or while Blender waits."""

import functools
import math
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import bpy

from .. import editors, user_preferences
from ..core.errors import ReadableError
from ..core.layout.map_packing import MapPacking
from ..core.layout.shape_packing import Packed
from ..core.solve.progress import Progress, stepped
from ..core.solve.relaxing import Relaxed, Relaxing
from ..core.solve.worker import Worker
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh
from ..edit_mesh.write import ChangingMaps
from ..live import following
from ..ui.progress import show_status
from .job_operator import Choice

_KEEP = {"RET", "NUMPAD_ENTER", "LEFTMOUSE"}
# Keys that are answered wherever the mouse is.
_EVERYWHERE = {"RET", "NUMPAD_ENTER", "ESC"}
# Fraction of the time that drawing large maps may take.
_MAX_LOAD = 0.5


# Maps in progress, and the maps of a moment.
Improving = Relaxing | MapPacking
Improved = Relaxed | Packed


@dataclass(frozen=True)
class Improvement:
    """How maps get better.

    Attributes:
        begin: returns the maps before the first step; runs in the view's thread.
        status: returns the text of the status bar for maps that are drawn; for None, before the first.
        steps: to take while Blender waits.
        is_better_at_once: whether the maps are to be drawn before the first step.
        max_steps: of the view.
        seconds: of the view.
    """

    begin: Callable[[Progress], Improving]
    status: Callable[[Any], str]
    steps: int
    is_better_at_once: bool = False
    max_steps: float = math.inf
    seconds: float = math.inf


class ImprovingView(Choice):
    """Improves maps in a thread and draws their progress.

    Attributes:
        answer: the last drawn maps; None before the first.
        whole: the maps in progress; None until the thread has begun them.
        is_stopped: whether the artist has ended it.
    """

    def __init__(self, edit_meshes: Sequence[EditMesh], improvement: Improvement) -> None:
        """Take meshes with a UV map."""
        self.answer: Improved | None = None
        self.whole: Improving | None = None
        self.is_stopped = False
        self._edit_meshes = edit_meshes
        self._improvement = improvement
        # Handed over by the thread.
        self._latest: Improved | None = None
        self._worker: Worker[None] | None = None
        self._next_drawing = 0.0

    def begin(self, context: bpy.types.Context) -> None:
        """Start the thread, and show the keys in the status bar."""
        self._worker = Worker(self._run, user_preferences.read("threads", 0))
        show_status(context, self._improvement.status(self.answer))

    def leaves(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Keep the events over viewports and UV editors; leave panels, headers and other editors theirs."""
        return event.type not in _EVERYWHERE and editors.region_at(context.screen, event.mouse_x, event.mouse_y) is None

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

    def restore(self) -> None:
        """Write the maps as they were, unless something else has changed them meanwhile."""
        if self.whole is not None:
            self._written.restore()

    def check(self) -> None:
        """Raise a ReadableError if something else has changed the maps since they were read or drawn."""
        if self.whole is not None and not self._written.are_shown():
            raise ReadableError(translate("Something else has changed the map meanwhile, which stays as it is now"))

    @functools.cached_property
    def _written(self) -> ChangingMaps:
        return ChangingMaps(self._edit_meshes, self.whole.corners)

    def _draw(self, context: bpy.types.Context) -> None:
        latest = self._latest
        if latest is None or latest is self.answer:
            return
        self.check()
        self._written.write(latest.maps)
        self.answer = latest
        show_status(context, self._improvement.status(self.answer))

    def _run(self, progress: Progress) -> None:
        """Improve the maps, in the thread."""
        end = time.monotonic() + self._improvement.seconds
        self.whole = whole = self._improvement.begin(progress)
        goes_on, steps = whole.can_move, 0
        if goes_on and self._improvement.is_better_at_once:
            self._latest = whole.now()
        while goes_on and steps < self._improvement.max_steps and time.monotonic() < end:
            goes_on = whole.step(1, progress)
            steps += 1
            self._latest = whole.now()


class Outcome(NamedTuple):
    """What has got better, its last maps, None for none, and whether the artist has ended it."""

    whole: Improving | None
    found: Any
    is_stopped: bool


def improve(
    edit_meshes: Sequence[EditMesh], improvement: Improvement, is_interactive: bool
) -> Generator[Any, Any, Outcome]:
    """Improve and write the maps as part of a job; if the job is canceled, restore the former ones."""
    with following.not_following():
        if not is_interactive:
            whole = (yield lambda progress: stepped(improvement.begin(progress), improvement.steps, progress)).result
            found = whole.now() if whole.can_move else None
            if found is not None:
                ChangingMaps(edit_meshes, whole.corners).write(found.maps)
            return Outcome(whole, found, is_stopped=False)
        view = ImprovingView(edit_meshes, improvement)
        try:
            found = (yield view).result
            view.check()
        except GeneratorExit:
            view.restore()
            raise
        return Outcome(view.whole, found, view.is_stopped)
