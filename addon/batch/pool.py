# SPDX-License-Identifier: GPL-3.0-or-later
"""Several workers on this machine, each fed by a thread of its own."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator, Sequence
from typing import Any

from .worker_process import Launcher, Limits, StartError, WorkerProcess


def run(lines: Sequence[str], launcher: Launcher, limits: Limits, jobs: int) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the index of every request and its report, as they come; `jobs` are made at once.

    When the caller stops taking them, the workers are ended.

    Raises:
        StartError: no worker gets ready.
    """
    waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
    for index in range(len(lines)):
        waiting.put(index)
    done: queue.SimpleQueue[tuple[int, dict[str, Any]] | StartError] = queue.SimpleQueue()
    stopping = threading.Event()
    workers = [WorkerProcess(launcher, number, limits) for number in range(min(jobs, len(lines)))]

    def serve(worker: WorkerProcess) -> None:
        while not stopping.is_set():
            try:
                index = waiting.get_nowait()
            except queue.Empty:
                return
            try:
                done.put((index, worker.run(lines[index])))
            except StartError as error:
                done.put(error)
                return
            except Exception as error:  # noqa: BLE001 - whatever it is, the asset must be accounted for
                failure = {"kind": "crash", "message": f"{type(error).__name__}: {error}"}
                done.put((index, {"status": "failed", "failure": failure}))

    threads = [threading.Thread(target=serve, args=(worker,), daemon=True) for worker in workers]
    for thread in threads:
        thread.start()
    try:
        for _ in lines:
            found = done.get()
            if isinstance(found, StartError):
                raise found
            yield found
    finally:
        stopping.set()
        for worker in workers:
            worker.close()
