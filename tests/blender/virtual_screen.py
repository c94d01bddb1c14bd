# SPDX-License-Identifier: GPL-3.0-or-later
"""A virtual screen for Blenders with a window, drawn by Mesa's software renderer."""

import contextlib
import shutil
import subprocess
from collections.abc import Iterator

SIZE = (1600, 1000)
_PROGRAMS = {"Xvfb": "xvfb", "xdotool": "xdotool", "import": "imagemagick"}


@contextlib.contextmanager
def display() -> Iterator[dict[str, str]]:
    """Start a screen of `SIZE`; yields the environment for programs that are to use it."""
    for program, package in _PROGRAMS.items():
        assert shutil.which(program), f"{program} is missing: apt-get install {package} (or run build_addon.py test)"
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", "1", "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "+extension", "GLX"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        yield {"DISPLAY": f":{server.stdout.readline().strip()}", "LIBGL_ALWAYS_SOFTWARE": "1"}
    finally:
        server.terminate()
        server.wait()
