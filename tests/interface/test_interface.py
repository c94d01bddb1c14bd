# SPDX-License-Identifier: GPL-3.0-or-later
"""The system's Blender with a window on a virtual screen, driven by mouse and keyboard; screenshots in build/."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.blender import blenders

HERE = Path(__file__).resolve().parent
SCREENSHOTS = HERE.parents[1] / "build" / "interface"
SIZE = (1600, 1000)
SECONDS = 900  # ends what hangs; the longest driver has taken 130 s beside other work


@pytest.fixture
def display():
    """A virtual screen; yields its name."""
    for program, package in {"Xvfb": "xvfb", "xdotool": "xdotool", "import": "imagemagick"}.items():
        assert shutil.which(program), f"{program} is missing: apt-get install {package} (or run build_addon.py test)"
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", "1", "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "+extension", "GLX"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        yield f":{server.stdout.readline().strip()}"
    finally:
        server.terminate()
        server.wait()


# One at a time: each is the only program on its screen, and counts on a pace that two would slow down.
@pytest.mark.parametrize("driver", sorted(path.name for path in HERE.glob("drive_*.py")))
def test_by_mouse_and_keyboard(driver, display, tmp_path):
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    verdict = tmp_path / "verdict.txt"
    environment = blenders.make_profile(tmp_path, bundles_module=True)
    result = subprocess.run(
        [
            *(blenders.system_blender(), "--factory-startup", "--window-geometry", "0", "0", *map(str, SIZE)),
            *("--python", str(HERE / driver), "--", str(SCREENSHOTS), str(verdict)),
        ],
        env={**environment, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=SECONDS,
    )
    outcome = verdict.read_text() if verdict.exists() else "Blender ended without a verdict"
    if outcome != "passed":
        pytest.fail(f"{outcome}\nScreenshots: {SCREENSHOTS}\n{result.stdout}", pytrace=False)
