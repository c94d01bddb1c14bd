"""The memory that a process holds: resident pages, which a machine can run out of. A limit on addresses (RLIMIT_AS)
would stop Blender at once, because it reserves many times what it uses."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import re
import sys
from collections.abc import Callable
from pathlib import Path

_PROC = Path("/proc")
_KIBIBYTE = 1024


def reset_peak() -> None:
    """Release memory that is free, and restart `peak`; where that is impossible, it counts from the process's start."""
    gc.collect()
    # What the C library keeps from an earlier asset would count for the next one. Only glibc has this function.
    with contextlib.suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
    # Not Linux, or a container that forbids it.
    with contextlib.suppress(OSError):
        (_PROC / "self" / "clear_refs").write_text("5")


def peak() -> int | None:
    """Return the maximum number of bytes that this process has held since `reset_peak`; None if unknown."""
    return _status("self", "VmHWM")


def _status(process: object, name: str) -> int | None:
    try:
        text = (_PROC / str(process) / "status").read_text(encoding="ascii", errors="replace")
    except OSError:
        return None
    found = re.search(rf"^{name}:\s+(\d+) kB", text, re.MULTILINE)
    return int(found.group(1)) * _KIBIBYTE if found else None


def resident(process: int) -> int | None:
    """Return the bytes that another process holds; None if it has ended or the number is unknown."""
    if sys.platform == "linux":
        return _status(process, "VmRSS")
    measure = _psutil_measure()
    return measure(process) if measure else None


def is_measurable() -> bool:
    """Return whether `resident` works on this system."""
    return sys.platform == "linux" or _psutil_measure() is not None


def _psutil_measure() -> Callable[[int], int | None] | None:
    try:
        import psutil
    except ImportError:
        return None

    def measure(process: int) -> int | None:
        try:
            return psutil.Process(process).memory_info().rss
        except psutil.Error:
            return None

    return measure
