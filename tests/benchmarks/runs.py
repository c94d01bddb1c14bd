"""Measurements in separate processes, so that none disturbs another and each has its own peak memory."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tests.benchmarks import generated
from tools import environment

ROOT = Path(__file__).resolve().parents[2]
# The Blender of this environment, or the system's where there is no bpy for its Python.
BLENDER = f"bpy-{environment.BPY[environment.OWN_PYTHON]}" if environment.OWN_PYTHON in environment.BPY else "system"
_MARK = "figures: "
Figures = dict[str, Any]


class NotMeasured(Exception):  # noqa: N818 - no error: what is needed for a measurement is not there
    """Why there is no figure, for the reader of the table."""


def run(
    script: str, measurement: str, arguments: Figures, meshes: Sequence[generated.Mesh] = (), blender: str | None = None
) -> Figures:
    """Run a measurement of a script of this folder, in a Blender where `blender` names one; return its figures.

    Raises:
        NotMeasured: there is no such Blender here.
        RuntimeError: it failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        given = Path(folder) / "given.json"
        if meshes:
            path = Path(folder) / "meshes.npz"
            generated.save(path, meshes)
            arguments = {**arguments, "meshes": str(path)}
        given.write_text(json.dumps([measurement, arguments]))
        try:
            command, environ = _command(Path(__file__).with_name(f"{script}.py"), blender, Path(folder))
            done = subprocess.run(
                [*command, "--measure", str(given)], env=environ, cwd=ROOT, capture_output=True, text=True, check=False
            )
        except FileNotFoundError as missing:
            raise NotMeasured(f"no Blender {blender} here: {missing}") from None
    found = [line for line in done.stdout.splitlines() if line.startswith(_MARK)]
    if not found:
        raise RuntimeError(f"{script} {measurement} {arguments} ended with {done.returncode}:\n{done.stderr[-4000:]}")
    return json.loads(found[0].removeprefix(_MARK))


def _command(script: Path, name: str | None, folder: Path) -> tuple[list[str], dict[str, str]]:
    if name is None:
        return [sys.executable, "-m", f"tests.benchmarks.{script.stem}"], dict(os.environ)
    from tests.blender import blenders

    known = {blender.name: blender for blender in (*blenders.all_blenders(), *blenders.further_blenders())}
    if name not in known:
        raise NotMeasured(f"no Blender {name} here, but {', '.join(known)}")
    blender = known[name]
    separator = [] if blender.python else ["--"]
    return [*blender.script_command(script), *separator], blender.make_profile(folder)


def is_measuring() -> bool:
    """Return whether this process was started by `run`."""
    return "--measure" in sys.argv


def answer(*measurements: Callable[..., Figures]) -> None:
    """In the script that `run` started: call the named measurement and send its figures."""
    name, arguments = json.loads(Path(sys.argv[sys.argv.index("--measure") + 1]).read_text())
    if "meshes" in arguments:
        arguments["meshes"] = generated.load(Path(arguments["meshes"]))
    figures = {measurement.__name__: measurement for measurement in measurements}[name](**arguments)
    print(f"\n{_MARK}{json.dumps(figures)}", flush=True)


def peak_megabytes() -> float:
    """Return the peak memory of this process."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


class Stopwatch:
    """A function that adds up the seconds spent in it; set in place of it with `setattr`."""

    def __init__(self, owner: object, name: str) -> None:
        """Put the stopwatch around `owner.name`."""
        self.seconds = 0.0
        self._function = getattr(owner, name)
        setattr(owner, name, self)

    def __call__(self, *arguments: object, **keywords: object) -> object:
        """Call the function."""
        start = time.perf_counter()
        try:
            return self._function(*arguments, **keywords)
        finally:
            self.seconds += time.perf_counter() - start
