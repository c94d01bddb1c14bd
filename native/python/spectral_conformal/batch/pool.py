"""Several workers on this machine, each fed by its own thread."""

from __future__ import annotations

import functools
import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from .worker_process import Launcher, Limits, StartError, WorkerProcess


def run(
    requests: Sequence[tuple[str, Launcher]],
    limits: Limits,
    jobs: int,
    tell: Callable[[int, str, float, bool, str], None] = lambda index, phase, seconds, begins, note: None,
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the index and the report of every request as they finish; `jobs` of them run at once.

    Each request is a line, with the launcher of its worker; a thread keeps one worker of each kind that it has needed.
    The workers end when the caller stops taking reports. `tell` takes the phases of assets, and signs of life of those
    that take long, from any thread: the index and what `worker_process.Tell` takes.

    Raises:
        StartError: no worker becomes ready.
    """
    waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
    for index in range(len(requests)):
        waiting.put(index)
    done: queue.SimpleQueue[tuple[int, dict[str, Any]] | StartError] = queue.SimpleQueue()
    stopping = threading.Event()
    numbers = range(min(jobs, len(requests)))
    launchers = list(dict.fromkeys(launcher for _, launcher in requests))
    workers: dict[tuple[int, int], WorkerProcess] = {}

    def worker_for(number: int, launcher: Launcher) -> WorkerProcess:
        kind = launchers.index(launcher)
        if (number, kind) not in workers:
            name = f"{number}-{kind}" if kind else str(number)
            workers[number, kind] = WorkerProcess(launcher, name, limits)
        return workers[number, kind]

    def serve(number: int) -> None:
        while not stopping.is_set():
            try:
                index = waiting.get_nowait()
            except queue.Empty:
                return
            try:
                line, launcher = requests[index]
                done.put((index, worker_for(number, launcher).run(line, functools.partial(tell, index))))
            except StartError as error:
                done.put(error)
                return
            except Exception as error:  # noqa: BLE001 - whatever it is, the asset must be accounted for
                failure = {"kind": "crash", "message": f"{type(error).__name__}: {error}"}
                done.put((index, {"status": "failed", "failure": failure}))

    threads = [threading.Thread(target=serve, args=(number,), daemon=True) for number in numbers]
    for thread in threads:
        thread.start()
    try:
        for _ in requests:
            found = done.get()
            if isinstance(found, StartError):
                raise found
            yield found
    finally:
        stopping.set()
        for worker in list(workers.values()):
            worker.close()
