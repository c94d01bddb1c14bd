# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that wait for work in a thread: timer, progress, cancellation and cleanup."""

import time
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from typing import Any, Protocol

import bpy

from .. import session, user_preferences
from ..core.solve.progress import Progress
from ..core.solve.worker import Worker
from ..core.words import texts
from ..core.words.translation import translate
from ..session import Lifetime, Remembered
from ..ui import progress
from ..ui.progress import WindowProgress
from .reporting_operator import ReportingOperator

# Shorter work ends within the click that started it, without a flash of progress.
_SECONDS_BEFORE_MODAL = 0.25
# Twenty times a second: fast enough, and cheap.
_TIMER_SECONDS = 0.05

# Runs in a thread; must not touch Blender.
Work = Callable[[Progress], Any]


class Choice(Protocol):
    """A question to the artist in the middle of a job.

    Attributes:
        answer: the current answer.
    """

    answer: object

    def begin(self, context: bpy.types.Context) -> None:
        """Show the choice."""

    def leaves(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Return whether an event is for another part of the window, which then receives it."""

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Return {"FINISHED"} with an answer, {"RUNNING_MODAL"} for a handled event, else {"PASS_THROUGH"}."""

    def update(self, context: bpy.types.Context) -> bool | None:
        """Update what is shown; called by a timer. Return True if the answer is there without the artist."""

    def end(self, context: bpy.types.Context) -> None:
        """Remove everything shown but the text of the status bar."""


@dataclass(frozen=True)
class Done:
    """The result of a `Work` or `Choice`.

    Attributes:
        result: what the work returned, or the answer.
        is_late: whether Blender ran meanwhile, so that the meshes may have changed.
    """

    result: Any
    is_late: bool


# Not typing.Union: its cache keeps this module alive until exit, where bpy 4.2 and 4.5 then crash.
Job = Generator[Work | Choice, Done, "set[str]"]


class _Running:
    """A job that a window waits for. `end` removes everything that belongs to it, once."""

    def __init__(self, label: str, job: Job, mode: str) -> None:
        self.label = label
        self.job = job
        self.mode = mode
        self.is_late = False
        self.is_ended = False
        self.worker: Worker | None = None
        self.choice: Choice | None = None
        self._progress: WindowProgress | None = None
        self._timer: bpy.types.Timer | None = None
        self._window_manager: bpy.types.WindowManager | None = None

    @property
    def is_wanted(self) -> bool:
        """Whether the thread is neither finished nor canceled."""
        return self.worker is not None and self.worker.is_wanted

    def wait(self, context: bpy.types.Context, worker: Worker) -> None:
        """Show the worker's progress, and start the timer of the operator."""
        self.worker = worker
        self._progress = WindowProgress(context, self.label, worker.fraction, worker.phase)
        self._keep_awake(context)

    def ask(self, context: bpy.types.Context, choice: Choice) -> None:
        """Ask the artist, and start the timer of the operator."""
        self.choice = choice
        choice.begin(context)
        self._keep_awake(context)

    def update(self, context: bpy.types.Context) -> bool:
        """Update the progress; return whether the choice has answered itself."""
        if self._progress is not None:
            self._progress.update(context, self.worker.fraction, self.worker.phase)
        return self.choice is not None and bool(self.choice.update(context))

    def hide(self, context: bpy.types.Context) -> None:
        """Stop waiting for the worker or the artist."""
        if self.worker is not None:
            self.worker.cancel()
        for shown in (self._progress, self.choice):
            if shown is not None:
                shown.end(context)
        progress.clear_status(context)
        self.worker = self.choice = self._progress = None

    def end(self, context: bpy.types.Context) -> None:
        """End the job: cancel the thread and remove everything shown."""
        if self.is_ended:
            return
        self.is_ended = True
        jobs = session.of(_Jobs)
        if jobs.running is self:
            jobs.running = None
        try:
            self.hide(context)
        finally:
            if self._timer is not None:
                self._window_manager.event_timer_remove(self._timer)
            self.job.close()

    def _keep_awake(self, context: bpy.types.Context) -> None:
        self.is_late = True
        if self._timer is None:
            self._window_manager = context.window_manager
            self._timer = self._window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)


class _Jobs(Remembered):
    """The job that a window waits for; undo ends it, because it replaces the meshes."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        self.running: _Running | None = None

    def end(self) -> None:
        """End it and remove everything of it."""
        if self.running is not None:
            self.running.end(bpy.context)


def running() -> _Running | None:
    """Return the job that a window waits for."""
    return session.of(_Jobs).running


class JobOperator(ReportingOperator):
    """Mixin of an operator whose work is the generator `job`.

    Executed, it blocks Blender. Invoked in a window, its work runs in a thread, so that Blender's windows stay alive
    and Esc cancels; one job at a time.
    """

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Yield every `Work` and, if `is_interactive`, every `Choice`; receive its `Done`; return the status.

        Raises:
            ReadableError: nothing was changed; the message says why.
        """
        raise NotImplementedError

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator in its modes, one job at a time."""
        current = running()
        if current is not None and current.is_wanted:
            cls.poll_message_set(
                translate("{operator} is running; Esc cancels it").format(operator=translate(current.label))
            )
            return False
        return super().poll(context)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job while Blender waits."""
        with closing(self.job(context, is_interactive=False)) as job:
            done = None
            while True:
                try:
                    work = job.send(done)
                except StopIteration as end:
                    return end.value
                with progress.blocking(context, self.bl_label) as report_progress:
                    done = Done(work(report_progress), is_late=False)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Do the job in a thread, so that Blender's windows stay alive and Esc cancels."""
        # Without a window, as in scripts and application timers, nothing would end the job.
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if running() is not None:
            running().end(context)
        self._job = session.of(_Jobs).running = _Running(
            self.bl_label, self.job(context, is_interactive=True), context.mode
        )
        status = self._ending(context, self._advance, None)
        if "RUNNING_MODAL" in status:
            context.window_manager.modal_handler_add(self)
        return status

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Continue when the work has ended; pass only view navigation through."""
        return self._ending(context, self._handle, event)

    def cancel(self, context: bpy.types.Context) -> None:
        """End the job without result; Blender also calls this when the window is closed."""
        self._job.end(context)

    def _ending(self, context: bpy.types.Context, function: Callable[..., set[str]], argument: object) -> set[str]:
        """Return the status of `function`; the end of the operator ends its job, also by an error."""
        status = {"CANCELLED"}
        try:
            status = self.reporting(function, context, argument)
        finally:
            if not status & {"RUNNING_MODAL", "PASS_THROUGH"}:
                self._job.end(context)
        return status

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        job = self._job
        if job.is_ended:
            return {"CANCELLED"}
        is_left = context.mode != job.mode
        if job.choice is not None and not is_left and event.type != "TIMER":
            if job.choice.leaves(context, event):
                return {"PASS_THROUGH"}
            status = job.choice.handle(context, event)
            if "FINISHED" in status:
                return self._take_answer(context)
            if "RUNNING_MODAL" in status:
                return status
        if is_left or (event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"):
            self.report({"INFO"}, texts.canceled(self.bl_label))
            return {"CANCELLED"}
        if event.type == "TIMER":
            if job.worker is not None and job.worker.wait(0.0):
                worker = job.worker
                job.hide(context)
                return self._advance(context, Done(worker.result(), job.is_late))
            return self._take_answer(context) if job.update(context) else {"PASS_THROUGH"}
        return {"PASS_THROUGH"} if progress.moves_view(event) else {"RUNNING_MODAL"}

    def _take_answer(self, context: bpy.types.Context) -> set[str]:
        """Continue the job with the answer to its choice."""
        job = self._job
        answer = job.choice.answer
        job.hide(context)
        return self._advance(context, Done(answer, job.is_late))

    def _advance(self, context: bpy.types.Context, done: Done | None) -> set[str]:
        """Advance the job, first with None, until it ends or a window has to wait."""
        job, start = self._job, None if done is None else time.monotonic()
        while True:
            try:
                step = job.job.send(done)
            except StopIteration as end:
                return end.value
            if not callable(step):
                job.ask(context, step)
                return {"RUNNING_MODAL"}
            worker = Worker(step, user_preferences.read("threads", 0))
            # The job's own time since its first step counts, too: Blender was blocked meanwhile.
            start = time.monotonic() if start is None else start
            left = _SECONDS_BEFORE_MODAL - (time.monotonic() - start)
            if not worker.wait(max(left, _TIMER_SECONDS)) or left <= 0.0:
                job.wait(context, worker)
                return {"RUNNING_MODAL"}
            done = Done(worker.result(), job.is_late)
