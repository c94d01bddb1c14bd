"""Progress of a batch: a tqdm bar if tqdm is installed and the output is a terminal, otherwise a line per asset."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Takes the name of an asset, its status and its summary.
Advance = Callable[[str, str, str], None]


@contextmanager
def bar(total: int, quiet: bool) -> Iterator[Advance]:
    """Yield a function to call for every finished asset; with `quiet` it prints only failures."""
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

        def advance(name: str, status: str, summary: str) -> None:
            if status == "failed":
                shown.write(f"{name}: {summary}", file=sys.stderr)
            shown.update()

        yield advance


def say(text: str) -> None:
    """Print a line, above the bar if there is one."""
    tqdm = sys.modules.get("tqdm")
    if tqdm is not None and sys.stderr.isatty():
        tqdm.tqdm.write(text, file=sys.stderr)
    else:
        print(text, file=sys.stderr, flush=True)


def _print_failure(name: str, status: str, summary: str) -> None:
    if status == "failed":
        print(f"{name}: {summary}", file=sys.stderr)


def _lines(total: int) -> Advance:
    start, done = time.monotonic(), 0

    def advance(name: str, _status: str, summary: str) -> None:
        nonlocal done
        done += 1
        left = (time.monotonic() - start) / done * (total - done)
        print(f"[{done}/{total}, {duration(left)} left] {name}: {summary}", file=sys.stderr, flush=True)

    return advance


def duration(seconds: float) -> str:
    """Return a duration as hours:minutes:seconds."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
