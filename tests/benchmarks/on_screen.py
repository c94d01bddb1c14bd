"""Runs a script in a Blender with a window, on a virtual screen that Mesa's software renderer draws."""

from __future__ import annotations

import contextlib
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

SECONDS = 300


def names() -> Sequence[str]:
    """Return the names of the Blenders that this machine has with a window; the first is the system's."""
    from tests.blender import blenders

    return [blender.name for blender in blenders.blenders_with_window()]


def run(script: str, *arguments: object, blender: str = "system") -> str:
    """Run a script in a Blender with the add-on installed and return what it writes into its last argument, a file.

    Its arguments are --inside, the `arguments` and the file; it must end Blender.
    """
    from tests.blender import blenders

    (chosen,) = (each for each in blenders.blenders_with_window() if each.name == blender)
    with tempfile.TemporaryDirectory() as folder, _display() as display:
        result = Path(folder) / "result.txt"
        options = ["--factory-startup", "--python-use-system-env", "--window-geometry", "0", "0", "1600", "1000"]
        options += ["--python", script, "--", "--inside", *map(str, arguments), str(result)]
        environ = {**chosen.make_profile(Path(folder)), "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"}
        command = chosen.command(*options)
        code, printed = blenders.run(command, environ=environ, folder=Path(folder), seconds=SECONDS)
        if not result.exists():
            raise RuntimeError(f"Blender ended with {code}, without a result:\n{printed}")
        return result.read_text()


@contextlib.contextmanager
def _display() -> Iterator[str]:
    """A virtual screen; yields its name."""
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", "1", "-screen", "0", "1600x1000x24", "+extension", "GLX"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        yield f":{server.stdout.readline().strip()}"
    finally:
        server.terminate()
        server.wait()
