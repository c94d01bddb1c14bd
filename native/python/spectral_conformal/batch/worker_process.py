"""Control of worker processes: start, feed, limit, end and restart them."""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import memory, worker

_MODULE = "spectral_conformal.batch.worker"
_POLL_SECONDS = 0.05
# Blender on a slow disk may take this long to start.
_START_SECONDS = 300.0
_LOG_LINES = 8
# Between two signs of life of an asset.
_BEAT_SECONDS = 30.0
_THREADS = (worker.THREADS, "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


# Takes what an asset's work is at, the seconds since its begin, whether it gets there now, and what is known of it; if
# neither, it is a sign of life.
Tell = Callable[[str, float, bool, str], None]


class StartError(Exception):
    """There is no program to start, or it does not become ready; the message says what to do."""


@dataclass(frozen=True)
class Limits:
    """Limits of an asset.

    Attributes:
        seconds: until its worker is ended; None for no limit.
        memory: bytes that its worker may hold; None for no limit.
        files: after which a new worker replaces the old one, since Blender's memory grows over many files.
        retries: number of further attempts after a worker crashed or took too much memory.
    """

    seconds: float | None = None
    memory: int | None = None
    files: int = 50
    retries: int = 1


def python_command() -> list[str]:
    """Return the command that starts a worker in this Python."""
    return [sys.executable, "-m", _MODULE]


def blender_command(blender: str | None = None, threads: int = 1) -> list[str]:
    """Return the command that starts a worker with Blender.

    The first of these that exists: the named program, this Python if it has `bpy`, a Blender on the path.

    Raises:
        StartError: none of them exists.
    """
    if blender is None and importlib.util.find_spec("bpy") is not None:
        return python_command()
    return [
        *(blender_program(blender), "--background", "--factory-startup", "--python-use-system-env"),
        *("--python-exit-code", "1", "--threads", str(threads)),
        *("--python-expr", f"import sys, {_MODULE}; sys.exit({_MODULE}.main())"),
    ]


def blender_program(blender: str | None = None) -> str:
    """Return the path of a program, by default of a Blender on the path.

    Raises:
        StartError: there is none.
    """
    found = shutil.which("blender" if blender is None else blender)
    if found is None:
        missing = f"There is no program {blender}." if blender else "There is neither bpy in this Python nor a Blender."
        raise StartError(f"{missing} Install one (pip install bpy), or name one with --blender.")
    return found


class Launcher:
    """The command that starts workers, and its environment."""

    def __init__(self, words: Sequence[str], log_folder: Path, threads: int = 1) -> None:
        """Take the command that starts a worker; its output goes to files in `log_folder`, which must exist."""
        self.words = list(words)
        self.log_folder = log_folder
        self._links: str | None = None
        # Several single-threaded workers are faster than one with several threads, with the same bits everywhere.
        self.environ = {**os.environ, **dict.fromkeys(_THREADS, str(threads))}
        if not _is_python(self.words):
            self._add_module()

    def _add_module(self) -> None:
        """Let a Blender with factory settings find `spectral_conformal`, but not the packages installed beside it."""
        self._links = tempfile.mkdtemp(prefix="spectral_conformal_")
        folder = Path(__file__).resolve().parents[1]
        for path in (folder, folder.with_name(f"{folder.name}.libs")):
            if path.is_dir():
                _link(path, Path(self._links) / path.name)
        paths = [self._links, self.environ.get("PYTHONPATH", "")]
        self.environ["PYTHONPATH"] = os.pathsep.join(filter(None, paths))

    def close(self) -> None:
        """Remove the temporary files."""
        if self._links is not None:
            shutil.rmtree(self._links, ignore_errors=True)


def _is_python(words: Sequence[str]) -> bool:
    return Path(words[0]) == Path(sys.executable)


def _link(path: Path, link: Path) -> None:
    try:
        link.symlink_to(path, target_is_directory=True)
    except OSError:
        # Windows does not let everybody create links.
        shutil.copytree(path, link)


class WorkerProcess:
    """One worker at a time, replaced after it died, was ended, or has processed enough files.

    Another thread may close it while it runs a request, which then fails.
    """

    def __init__(self, launcher: Launcher, name: object, limits: Limits) -> None:
        """Start nothing yet; `name` distinguishes the log files."""
        self._launcher = launcher
        self._limits = limits
        self._log = launcher.log_folder / f"worker-{name}.log"
        self._process: subprocess.Popen[str] | None = None
        self._reports: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self._served = 0
        self._phase, self._note = "begin", ""

    @property
    def pid(self) -> int | None:
        """The process, or None."""
        return self._process.pid if self._process else None

    def run(self, line: str, tell: Tell = lambda phase, seconds, begins, note: None) -> dict[str, Any]:
        """Let a worker process a request within the limits, and return its report; `tell` gets signs of life.

        If the worker exceeds its time, or dies or exceeds its memory, also in `retries` further attempts, the report
        has the status "failed" and a `failure` of the kind "time", "crash" or "memory". `attempts` counts the attempts.

        Raises:
            StartError: no worker becomes ready.
        """
        for attempt in range(1, self._limits.retries + 2):
            report = self._attempt(line, tell)
            report["attempts"] = attempt
            # What takes too long once, takes too long again.
            if report["status"] != "failed" or report["failure"]["kind"] in ("error", "time"):
                break
        return report

    def _attempt(self, line: str, tell: Tell) -> dict[str, Any]:
        process = self._process
        if process is None or process.poll() is not None or self._served >= self._limits.files:
            self.close()
            report = self._start()
            if report["status"] != worker.READY:
                return report
            process = self._process
        self._served += 1
        try:
            if process is None:
                raise BrokenPipeError
            process.stdin.write(f"{line}\n")
            process.stdin.flush()
        except (OSError, ValueError):
            # Ended, or closed by another thread.
            return self._failure("crash", f"the worker had ended{_exit_code(process) if process else ''}")
        return self._await(self._limits.seconds, tell)

    def _start(self) -> dict[str, Any]:
        """Start a worker; return its first report, or its failure if it exceeded the memory limit.

        Raises:
            StartError: it does not become ready.
        """
        self._served = 0
        self._reports = queue.Queue()
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(
                self._launcher.words,
                env=self._launcher.environ,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                encoding="utf-8",
                errors="replace",
                # Ctrl-C is for the batch, which ends its workers itself.
                start_new_session=True,
            )
        threading.Thread(target=_collect, args=(self._process, self._reports), daemon=True).start()
        report = self._await(_START_SECONDS)
        if report["status"] != worker.READY and report["failure"]["kind"] != "memory":
            last = "".join(f"\n  {line}" for line in report["failure"]["log"])
            raise StartError(f"No worker becomes ready: {report['failure']['message']}. Its output:{last}")
        return report

    def _await(self, seconds: float | None, tell: Tell = lambda phase, seconds, begins, note: None) -> dict[str, Any]:
        """Return the next report, or one about the end of the worker."""
        begin = beat = time.monotonic()
        self._phase, self._note = "begin", ""
        end = None if seconds is None else time.monotonic() + seconds
        limit = self._limits.memory
        process = self._process
        if process is None:
            return self._failure("crash", "the worker was ended")
        while True:
            try:
                report = self._reports.get(timeout=_POLL_SECONDS)
            except queue.Empty:
                if time.monotonic() - beat > _BEAT_SECONDS:
                    beat = time.monotonic()
                    tell(self._phase, beat - begin, False, "")
                held = memory.resident(process.pid) if limit else None
                if held is not None and held > limit:
                    _kill(process)
                    found = f"more than {limit >> 20} MiB of memory{self._known()}"
                    return self._failure("memory", found, limit=limit)
                if end is not None and time.monotonic() > end:
                    _kill(process)
                    found = f"more than {seconds:g} seconds, in the phase '{self._phase}'{self._known()}"
                    return self._failure("time", found)
                continue
            if report is not None and report["status"] == worker.PHASE:
                note = report.get("note", "")
                self._phase, self._note = report["phase"], note
                tell(self._phase, time.monotonic() - begin, not note, note)
                continue
            if report is not None:
                return report
            process.wait()
            return self._failure("crash", f"the worker ended{_exit_code(process)}")

    def _known(self) -> str:
        return f": {self._note}" if self._note else ""

    def _failure(self, kind: str, message: str, **further: object) -> dict[str, Any]:
        last = self._last_lines()
        self.close()
        return {"status": "failed", "failure": {"kind": kind, "message": message, "log": last, **further}}

    def _last_lines(self) -> list[str]:
        lines = self._log.read_text(encoding="utf-8", errors="replace").splitlines() if self._log.exists() else []
        return lines[-_LOG_LINES:]

    def close(self) -> None:
        """End the worker, if any."""
        process, self._process = self._process, None
        if process is None:
            return
        _kill(process)
        for stream in (process.stdin, process.stdout):
            # Unwritten data has no receiver any more.
            with contextlib.suppress(OSError):
                stream.close()


def _kill(process: subprocess.Popen[str]) -> None:
    process.kill()
    process.wait()


def _exit_code(process: subprocess.Popen[str]) -> str:
    code = process.poll()
    return "" if code is None else f" by signal {-code}" if code < 0 else f" with exit code {code}"


def _collect(process: subprocess.Popen[str], reports: queue.Queue[dict[str, Any] | None]) -> None:
    """Put every report of a worker into the queue, and None after its end."""
    try:
        for line in process.stdout:
            if line.startswith(worker.MARK):
                reports.put(json.loads(line[len(worker.MARK) :]))
    except ValueError:
        # Closed during the read, or an incomplete line from a worker that died.
        pass
    reports.put(None)
