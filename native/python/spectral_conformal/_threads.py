"""How many threads the module's calls share."""

from __future__ import annotations

from . import _arguments, _native


def limit_threads(threads: int) -> int:
    """Let calls made by this thread share at most so many threads from now on; no result depends on it.

    Other threads keep their limits. A thread that the program starts later begins without one.

    Args:
        threads: 1 or more, the calling thread among them; 0 for as many as the machine has cores, as at first. More
            than there are cores are not used. With 1, or where other calls have all threads, what takes long in
            CHOLMOD is not heard by a progress function: that takes a thread of its own, while the calling one waits.

    Returns:
        The limit before, to be put back.

    Raises:
        ValueError: `threads` is no whole number from 0 to 2147483647.
    """
    return _native.limit_threads(_arguments.checked_count(threads, "threads"))
