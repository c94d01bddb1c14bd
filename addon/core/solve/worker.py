# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in a thread of its own: progress, cancellation, result."""

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from .. import native
from .progress import Progress

Result = TypeVar("Result")


class Worker(Generic[Result]):
    """Runs `work(progress)` in a thread, which starts on construction.

    `progress` takes the fraction done and the name of the phase, and returns False once `cancel` was called. The thread
    is not a daemon: the process waits for it at exit, because native code must not outlive the interpreter.

    Attributes:
        fraction: fraction done, as `work` reported it last.
        phase: name of the phase, as `work` reported it last; empty before the first report.
    """

    def __init__(self, work: Callable[[Progress], Result], threads: int = 0) -> None:
        """Start the thread; `threads` limits those of the solver, 0 for all cores."""
        self.fraction = 0.0
        self.phase = ""
        self._work = work
        self._threads = threads
        self._result: Result | None = None
        self._error: BaseException | None = None
        self._canceled = threading.Event()
        self._finished = threading.Event()
        self._thread = threading.Thread(target=self._run, name="spectral_unwrap")
        self._thread.start()

    @property
    def is_wanted(self) -> bool:
        """Whether the work is neither finished nor canceled."""
        return not (self._canceled.is_set() or self._finished.is_set())

    def wait(self, seconds: float) -> bool:
        """Wait up to `seconds` for the end of the work; return whether it has ended."""
        return self._finished.wait(seconds)

    def cancel(self) -> None:
        """Ask the work to stop at its next report, without waiting; its result and errors are dropped."""
        self._canceled.set()

    def result(self) -> Result:
        """Wait for the end of the work; return its result, or raise its error."""
        self._finished.wait()
        if self._error is not None:
            raise self._error
        return self._result

    def _run(self) -> None:
        try:
            if self._threads:
                native.limit_threads(self._threads)
            self._result = self._work(self._report)
        except BaseException as error:  # noqa: BLE001 - whatever happened goes to the thread that asks for the result
            self._error = error
        finally:
            self._finished.set()

    def _report(self, fraction: float, phase: str) -> bool:
        self.fraction, self.phase = fraction, phase
        return not self._canceled.is_set()
