# SPDX-License-Identifier: GPL-3.0-or-later
"""Blenders with a window on a virtual screen, driven by mouse and keyboard; screenshots in build/interface/."""

import os
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.blender import blenders, virtual_screen
from tools import systems

HERE = Path(__file__).resolve().parent
SCREENSHOTS = HERE.parents[1] / "build" / "interface"
SECONDS = 900  # ends what hangs; the longest driver has taken 130 s beside other work
DRIVERS = sorted(path.name for path in HERE.glob("drive_*.py"))
# Debian unstable's draws with Vulkan, too, on the processor; where there is none, the end of pytest's report says why.
NEWEST = [blender for blender in blenders.blenders_with_window() if blender.system == systems.SID]


def drive(driver, blender, backend=""):
    """Run a driver in a Blender, drawn by `backend` if given; return its failure, an empty text if it passed."""
    screenshots = SCREENSHOTS / blender.name / backend
    screenshots.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, virtual_screen.display() as screen:
        verdict = Path(folder, "verdict.txt")
        environ = {**blender.make_profile(Path(folder)), **screen}
        options = ["--factory-startup", "--python-use-system-env", "--window-geometry", "0", "0", *virtual_screen.SIZE]
        options += ["--gpu-backend", backend] if backend else []
        options += ["--python", HERE / driver, "--", screenshots, verdict, *filter(None, [backend])]
        command = blender.command(*options)
        code, printed = blenders.run(command, environ=environ, folder=Path(folder), seconds=SECONDS)
        if code is None:
            return f"still running after {SECONDS} s:\n{printed}"
        outcome = verdict.read_text() if verdict.exists() else "Blender ended without a verdict"
        if outcome == "passed" and "Traceback" in printed:
            # Blender prints what goes wrong in handlers and timers, and goes on.
            outcome = "an error was printed"
    return "" if outcome == "passed" else f"{outcome}\nScreenshots: {screenshots}\n{printed}"


@pytest.fixture(scope="module")
def runs(request):
    """All selected drivers, begun in their order, as many at once as there are cores: each has a screen of its own."""
    workers = ThreadPoolExecutor(os.cpu_count())
    wanted = [item.callspec.params for item in request.session.items if item.path == Path(__file__)]
    yield {key(**each): workers.submit(drive, **each) for each in wanted}
    workers.shutdown(cancel_futures=True)


@pytest.mark.parametrize("driver", DRIVERS)
@pytest.mark.parametrize("blender", blenders.blenders_with_window(), ids=lambda blender: blender.name)
def test_by_mouse_and_keyboard(driver, blender, runs):
    check(runs[key(driver, blender)].result())


@pytest.mark.parametrize("backend", ["opengl", "vulkan"])
@pytest.mark.parametrize("driver", ["drive_map_overlay.py"])
@pytest.mark.parametrize("blender", NEWEST, ids=lambda blender: blender.name)
def test_overlay_is_drawn_alike(driver, blender, backend, runs):
    check(runs[key(driver, blender, backend)].result())


def key(driver, blender, backend=""):
    return driver, blender.name, backend


def check(wrong):
    if wrong:
        pytest.fail(wrong, pytrace=False)
