"""The batch on an existing Dask cluster: each task is an asset, and runs in one of the batch's own worker processes.

Dask's worker itself never loads Blender: its memory would grow, and Blender's crashes or hangs would affect it.
"""

from __future__ import annotations

import dataclasses
import os
import platform
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from .settings import SettingsError
from .worker_process import Launcher, Limits, StartError, WorkerProcess, blender_command, python_command

_CONNECT_SECONDS = 30.0

_own = threading.local()
_started: list[tuple[WorkerProcess, Launcher]] = []


def unwrap(
    line: str, in_blender: bool, limits: Limits, blender: str | None, threads: int, log_folder: str
) -> dict[str, Any]:
    """Return the report of a request. Runs in threads of a Dask worker, which keep their processes."""
    limit = _memory_limit()
    if limit is not None:
        limits = dataclasses.replace(limits, memory=min(limit, limits.memory or limit))
    wanted = (in_blender, limits, blender, threads, log_folder)
    kept = _own.__dict__.setdefault("kept", {})
    if wanted not in kept:
        words = blender_command(blender, threads) if in_blender else python_command()
        launcher = Launcher(words, Path(log_folder), threads)
        name = f"{platform.node()}-{os.getpid()}-{threading.get_ident()}{'-blender' if in_blender else ''}"
        kept[wanted] = WorkerProcess(launcher, name, limits)
        _started.append((kept[wanted], launcher))
    return kept[wanted].run(line)


def _memory_limit() -> int | None:
    """Return the bytes that the current Dask worker grants one thread; None for no limit."""
    import distributed

    try:
        worker = distributed.get_worker()
    except ValueError:
        return None
    limit = worker.memory_manager.memory_limit
    return limit // worker.state.nthreads if limit else None


def _close() -> None:
    while _started:
        process, launcher = _started.pop()
        process.close()
        launcher.close()
    _own.__dict__.clear()


def run(
    requests: Sequence[tuple[str, bool]],
    address: str,
    limits: Limits,
    blender: str | None,
    threads: int,
    log_folder: Path,
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the index and the report of every request as they come from the cluster.

    Each request is a line, with a flag for workers with Blender. Dask replaces a Dask worker that dies, and another one
    starts its asset again. An asset that ran out of memory goes to a worker with more memory, if there is one.

    Raises:
        SettingsError: Dask is not installed, or no scheduler answers at the address.
        StartError: a Dask worker cannot start a worker of the batch.
    """
    try:
        import distributed
    except ImportError as error:
        raise SettingsError("--scheduler needs Dask: pip install distributed.") from error
    try:
        client = distributed.Client(address, timeout=_CONNECT_SECONDS)
    except (OSError, ValueError, TimeoutError) as error:
        raise SettingsError(f"No Dask scheduler answers at {address}: {error}") from error
    with client:
        arguments = (limits, blender, threads, str(log_folder))
        futures = {client.submit(unwrap, *each, *arguments, pure=False): i for i, each in enumerate(requests)}
        running = distributed.as_completed(list(futures))
        tried_again: set[int] = set()
        try:
            for future in running:
                index = futures.pop(future)
                report = _report(future)
                larger = _larger_workers(client, report) if index not in tried_again else []
                if larger:
                    tried_again.add(index)
                    again = client.submit(unwrap, *requests[index], *arguments, pure=False, workers=larger)
                    futures[again] = index
                    running.add(again)
                    continue
                yield index, {**report, "attempts": report.get("attempts", 1) + (index in tried_again)}
        finally:
            client.cancel(list(futures))
            client.run(_close)


def _report(future: Any) -> dict[str, Any]:  # noqa: ANN401 - distributed is not installed everywhere
    """Return the report of a task, even if Dask gave up on it."""
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, StartError):
        raise error
    return {"status": "failed", "failure": {"kind": "crash", "message": f"{type(error).__name__}: {error}"}}


def _larger_workers(client: Any, report: dict[str, Any]) -> list[str]:  # noqa: ANN401 - as above
    """Return the addresses of the Dask workers with more memory than the limit that an asset exceeded."""
    failure = report.get("failure", {})
    if failure.get("kind") != "memory" or "limit" not in failure:
        return []
    workers = client.scheduler_info(n_workers=-1)["workers"]
    granted = {name: worker["memory_limit"] / worker["nthreads"] for name, worker in workers.items()}
    return [name for name, memory in granted.items() if memory == 0 or memory > failure["limit"]]
