# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of a build: one line of progress each, output in a log, a stamp once done."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import re
import subprocess
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
LOGS = BUILD / "logs"
STAMPS = BUILD / "stamps"
TAIL_LINES = 30


class StepError(RuntimeError):
    """A step failed; the message says what to do."""


@contextlib.contextmanager
def progress(title: str) -> Iterator[None]:
    """Print a line at the start of the step, and its duration at the end."""
    print(f"- {title} ...", end=" ", flush=True)
    start = time.monotonic()
    try:
        yield
    except BaseException:
        print("failed", flush=True)
        raise
    print(f"{time.monotonic() - start:.1f} s", flush=True)


def run(title: str, command: Sequence[object], *, log: str, environ: Mapping[str, str] | None = None) -> None:
    """Run a command as a step and append its output to build/logs/<log>.log; raise StepError if it fails."""
    with progress(title):
        run_quietly(title, command, log=log, environ=environ)


def run_quietly(title: str, command: Sequence[object], *, log: str, environ: Mapping[str, str] | None = None) -> None:
    """Do the same without a line of progress, as part of a step."""
    LOGS.mkdir(parents=True, exist_ok=True)
    path = LOGS / f"{log}.log"
    words = [str(word) for word in command]
    with path.open("ab") as output:
        start = output.tell()
        output.write(f"$ {' '.join(words)}\n".encode())
        output.flush()
        try:
            code = subprocess.run(
                words,
                cwd=ROOT,
                env={**os.environ, **(environ or {})},
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                check=False,
            ).returncode
        except FileNotFoundError as error:
            raise StepError(f"{title}: {error.filename} is not installed.") from error
        if code:
            raise StepError(f"{tail(path, start)}\n{title} failed (exit code {code}); the whole output: {path}")


def tail(path: Path, start: int) -> str:
    """Return the last lines of the log after byte `start`."""
    with path.open("rb") as log:
        log.seek(start)
        lines = log.read().decode(errors="replace").splitlines()
    return "\n".join(lines[-TAIL_LINES:])


def digest(parts: Iterable[object]) -> str:
    """Hash strings, files by name and content, and folders with all their files."""
    result = hashlib.sha256()
    for part in parts:
        paths = [part] if isinstance(part, Path) else []
        if paths and part.is_dir():
            paths = source_files(part)
        for path in paths:
            result.update(f"{path.relative_to(ROOT).as_posix()}\0".encode() + path.read_bytes())
        if not paths:
            result.update(f"{part}\0".encode())
    return result.hexdigest()


def source_files(folder: Path) -> list[Path]:
    """Return the files in a folder, sorted, without the caches of Python and other tools."""
    hidden = re.compile(r"\.|__pycache__$")
    files = (path for path in folder.rglob("*") if path.is_file())
    return sorted(path for path in files if not any(map(hidden.match, path.relative_to(folder).parts)))


def is_done(name: str, state: str) -> bool:
    """Return whether the step was completed for this state of its inputs."""
    path = STAMPS / name
    return path.is_file() and path.read_text() == state


def mark_done(name: str, state: str) -> None:
    """Record that the step was completed for this state of its inputs."""
    STAMPS.mkdir(parents=True, exist_ok=True)
    (STAMPS / name).write_text(state)


@contextlib.contextmanager
def exclusive() -> Iterator[None]:
    """Let one process at a time work in build/."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print("- waiting for another build_addon.py in this folder", flush=True)
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield
