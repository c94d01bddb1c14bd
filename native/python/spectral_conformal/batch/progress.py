"""Progress of a batch: a tqdm bar if tqdm is installed and the output is a terminal, otherwise a line per asset."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Takes the name of an asset, its status, its summary and its seconds, if known.
Advance = Callable[[str, str, str, "float | None"], None]
TEXT, JSON, OPEN_JOB = "text", "json", "openjd"
FORMS = (TEXT, JSON, OPEN_JOB)
_one_line = threading.Lock()


@contextmanager
def bar(total: int, quiet: bool, form: str = TEXT) -> Iterator[Advance]:
    """Yield a function to call for every finished asset; with `quiet` it prints only failures.

    The form "json" prints an object for every asset instead, and "openjd" what Open Job Description reads.
    """
    if form != TEXT:
        yield _objects(total) if form == JSON else _open_job(total)
        return
    if quiet:
        yield _print_failure
        return
    try:
        from tqdm import tqdm
    except ImportError:
        tqdm = None
    if tqdm is None or not sys.stderr.isatty():
        yield _lines(total)
        return
    with tqdm(total=total, unit="asset", file=sys.stderr) as shown:

        def advance(name: str, status: str, summary: str, _seconds: float | None) -> None:
            if status == "failed":
                shown.write(_line(name, summary), file=sys.stderr)
            shown.update()

        yield advance


def event(kind: str, **values: object) -> None:
    """Print an object in a line to the standard output; from any thread."""
    with _one_line:
        print(json.dumps({"event": kind, **values}), flush=True)


def _objects(total: int) -> Advance:
    done = 0
    event("begin", assets=total)

    def advance(name: str, status: str, summary: str, seconds: float | None) -> None:
        nonlocal done
        done += 1
        event("asset", name=name, status=status, summary=summary, seconds=seconds, done=done, assets=total)

    return advance


def _open_job(total: int) -> Advance:
    done = 0

    def advance(name: str, _status: str, summary: str, _seconds: float | None) -> None:
        nonlocal done
        done += 1
        with _one_line:
            print(f"openjd_progress: {100.0 * done / total:.1f}", flush=True)
            print(f"openjd_status: {_line(name, summary)}", flush=True)

    return advance


def say(text: str) -> None:
    """Print a line, above the bar if there is one."""
    tqdm = sys.modules.get("tqdm")
    if tqdm is not None and sys.stderr.isatty():
        tqdm.tqdm.write(text, file=sys.stderr)
    else:
        print(text, file=sys.stderr, flush=True)


def _print_failure(name: str, status: str, summary: str, _seconds: float | None) -> None:
    if status == "failed":
        print(_line(name, summary), file=sys.stderr)


def _lines(total: int) -> Advance:
    start, done = time.monotonic(), 0

    def advance(name: str, _status: str, summary: str, _seconds: float | None) -> None:
        nonlocal done
        done += 1
        left = (time.monotonic() - start) / done * (total - done)
        print(f"[{done}/{total}, {duration(left)} left] {_line(name, summary)}", file=sys.stderr, flush=True)

    return advance


def _line(name: str, summary: str) -> str:
    """Return an asset and its summary in one line: names of files may hold a line's end, or what is no text."""
    shown = "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in name)
    return f"{shown}: {' '.join(summary.split())}"


def duration(seconds: float) -> str:
    """Return a duration as hours:minutes:seconds."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
