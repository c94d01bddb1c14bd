"""Runs a script in the system's Blender with a window, on a virtual screen that Mesa's software renderer draws."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path


def run(script: str, *arguments: object) -> str:
    """Run a script in Blender with the add-on installed and return what it writes into its last argument, a file.

    Its arguments are --inside, the `arguments` and the file; it must end Blender.
    """
    from tests.blender import blenders

    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "result.txt"
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", "1", "-screen", "0", "1600x1000x24", "+extension", "GLX"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        try:
            display = f":{server.stdout.readline().strip()}"
            subprocess.run(
                [
                    *(blenders.system_blender(), "--factory-startup", "--window-geometry", "0", "0", "1600", "1000"),
                    *("--python", script, "--", "--inside", *map(str, arguments), str(result)),
                ],
                env={
                    **os.environ,
                    **blenders.Blender("system").make_profile(Path(folder)),
                    "DISPLAY": display,
                    "LIBGL_ALWAYS_SOFTWARE": "1",
                },
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=True,
                timeout=300,
            )
        finally:
            server.terminate()
            server.wait()
        return result.read_text()
