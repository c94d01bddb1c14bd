"""Several workers on this machine, each fed by a thread of its own."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator, Sequence
from typing import Any

from .worker_process import Launcher, Limits, StartError, WorkerProcess


def run(requests: Sequence[tuple[str, Launcher]], limits: Limits, jobs: int) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the index of every request and its report, as they come; `jobs` are made at once.

    Requests are lines, each with what starts a worker for it; a thread keeps a worker of each kind that it has had.
    When the caller stops taking reports, the workers are ended.

    Raises:
        StartError: no worker gets ready.
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
                done.put((index, worker_for(number, launcher).run(line)))
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
