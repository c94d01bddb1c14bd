"""Runs a script in a Blender with a window, on a virtual screen drawn by Mesa's software renderer."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
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
    from tests.blender import blenders, virtual_screen

    (chosen,) = (each for each in blenders.blenders_with_window() if each.name == blender)
    with tempfile.TemporaryDirectory() as folder, virtual_screen.display() as screen:
        result = Path(folder) / "result.txt"
        options = ["--factory-startup", "--python-use-system-env", "--window-geometry", "0", "0", *virtual_screen.SIZE]
        options += ["--python", script, "--", "--inside", *map(str, arguments), str(result)]
        environ = {**chosen.make_profile(Path(folder)), **screen}
        command = chosen.command(*options)
        code, printed = blenders.run(command, environ=environ, folder=Path(folder), seconds=SECONDS)
        if not result.exists():
            raise RuntimeError(f"Blender ended with {code}, without a result:\n{printed}")
        return result.read_text()
