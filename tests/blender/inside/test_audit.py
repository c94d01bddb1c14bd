# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on at work, watched by Python's audit events: no file, network or process is touched.

Python reports what it opens, lists, connects and starts, also on behalf of the modules that it calls. What the import
system does to find the add-on's own modules is not the add-on's doing.
"""

import ctypes
import os
import sys
from pathlib import Path

import bpy  # isort: skip - makes addon_utils importable
import addon_utils
import pytest

from tests.blender.inside import scenes

ADDON = "spectral_unwrap"
WATCHED = (
    *("open", "os.", "socket.", "subprocess.", "shutil.", "urllib.", "http.", "ftplib.", "smtplib.", "ssl."),
    *("ctypes.", "glob.", "pathlib.", "tempfile.", "webbrowser.", "sqlite3.", "mmap.", "pty.", "signal."),
)


class Watch:
    """Collects the events that come from the add-on's files or from the module, while it is on."""

    def __init__(self):
        self.events, self.is_on = [], False
        sys.addaudithook(self)

    def __call__(self, event, arguments):
        # Python's own functions are in the process.
        is_inside = event == "ctypes.dlsym" and arguments[0] is ctypes.pythonapi
        if self.is_on and event.startswith(WATCHED) and not is_inside and is_ours():
            self.events.append((event, repr(arguments)[:200]))

    def __enter__(self):
        self.events, self.is_on = [], True
        return self

    def __exit__(self, *_):
        self.is_on = False


def is_ours():
    """Return whether a function of the add-on or of the module has made the event, with no import in between."""
    frame = sys._getframe(2)
    while frame is not None:
        file = frame.f_code.co_filename
        if "importlib" in file:
            return False
        if ADDON in file or "spectral_conformal" in file:
            return True
        frame = frame.f_back
    return False


# A hook stays for the life of the process.
_watch = Watch()


def work():
    """Use everything that the add-on has."""
    grid, box = scenes.bumpy_grid(8, 6), scenes.cube(name="Box")
    scenes.show_image(grid, 64, 32)
    grid.modifiers.new("Subdivision", "SUBSURF").levels = 1
    scenes.edit(grid, box)
    bpy.context.scene.spectral_unwrap_live = True
    for options in ({}, {"area_blend": 0.5}, {"use_subsurf_data": True}, {"keep_in_place": True, "method": "LSCM"}):
        assert bpy.ops.uv.spectral_unwrap(**options) == {"FINISHED"}
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    scenes.select_vertices(grid, (0, 40))
    scenes.select_vertices(box, ())
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    assert bpy.ops.uv.spectral_extender(amount=60.0) == {"FINISHED"}
    assert bpy.ops.uv.spectral_shape_remove() == {"FINISHED"}


def test_nothing_outside_the_process_is_touched():
    addon_utils.disable(ADDON)
    with _watch as watch:
        assert addon_utils.enable(ADDON, default_set=True) is not None
        work()
        addon_utils.disable(ADDON)
    assert watch.events == []


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="files of the process are listed on Linux only")
def test_no_file_stays_open_and_no_process_is_left():
    work()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable(ADDON, default_set=True)
    # By kind and name: numbers may change.
    before = sorted(open_files())
    work()
    assert sorted(open_files()) == before
    with pytest.raises(ChildProcessError):
        os.waitpid(-1, os.WNOHANG)


def open_files():
    for entry in os.listdir("/proc/self/fd"):  # noqa: PTH208 - one name at a time, since the listing's own is closed
        try:
            target = os.readlink(f"/proc/self/fd/{entry}")  # noqa: PTH115 - a name that need not be a path
        except FileNotFoundError:
            continue
        yield target


CALLS = ("open('/dev/null').close()", "import os; os.listdir('/')", "import socket; socket.socket().close()")


@pytest.mark.parametrize("code", [*CALLS, "import subprocess; subprocess.run(['true'])"])
def test_the_watch_sees_what_is_forbidden(code):
    compiled = compile(code, f"/addons/{ADDON}/bad.py", "exec")
    with _watch as watch:
        exec(compiled, {})
    assert watch.events
