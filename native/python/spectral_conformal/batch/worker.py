"""A process that unwraps one asset after another: it reads requests and writes reports as lines of JSON."""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, TextIO

# Marks a report, since Blender and its importers print other lines.
MARK = "@spectral_conformal "
READY = "ready"
# What a worker says between reports: that an asset's work enters a phase, or with a note, what is known of it.
PHASE = "phase"
# Environment variable: the number of threads of a worker.
THREADS = "SPECTRAL_CONFORMAL_THREADS"
_POLL_SECONDS = 1.0


def main(run: Callable[[str], dict[str, Any]] | None = None) -> int:
    """Serve requests from standard input until it ends; return the exit code.

    `run` returns the report for a request's line; by default it is that of `task`.
    """
    # Other output goes to the log, standard error; only this module writes to the reports' channel.
    channel = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    threading.Thread(target=_end_with_parent, args=(os.getppid(),), daemon=True).start()
    if run is None:
        from .._threads import limit_threads
        from . import task

        limit_threads(int(os.environ[THREADS]))
        tell = lambda phase, note: _send(channel, {"status": PHASE, "phase": phase, "note": note})  # noqa: E731
        run = lambda line: task.answer(line, tell)  # noqa: E731
    _send(channel, {"status": READY})
    for line in sys.stdin:
        _send(channel, run(line))
    return 0


def _send(channel: TextIO, report: dict[str, Any]) -> None:
    channel.write(f"{MARK}{json.dumps(report)}\n")
    channel.flush()


def _end_with_parent(parent: int) -> None:
    """End this process at once when its parent dies, even during a solve."""
    while os.getppid() == parent:
        time.sleep(_POLL_SECONDS)
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
