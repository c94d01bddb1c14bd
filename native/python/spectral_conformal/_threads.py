"""Limit the number of threads."""

from __future__ import annotations

from . import _arguments, _native


def limit_threads(threads: int) -> int:
    """Limit the threads of later calls from this thread; no result depends on the limit.

    Other threads keep their limits. A thread started later begins without one.

    Args:
        threads: 1 or more, including the calling thread; 0 for one per core, the initial setting. A call never uses
            more threads than there are cores. With 1, or while other calls use all threads, a progress function gets no
            calls during long CHOLMOD phases: reporting them takes a second thread.

    Returns:
        The previous limit, for restoring it.

    Raises:
        ValueError: `threads` is not a whole number from 0 to 2147483647.
    """
    return _native.limit_threads(_arguments.checked_count(threads, "threads"))
