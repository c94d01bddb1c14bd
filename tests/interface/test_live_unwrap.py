# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap by mouse and keyboard, in the system's Blender with a window on a virtual screen."""

import subprocess

import blenders
import pytest
from test_interface import HERE, SCREENSHOTS, SIZE, display  # noqa: F401 - a fixture


def test_map_follows_a_dragged_pin_and_a_marked_seam(display, tmp_path):  # noqa: F811 - the fixture
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    verdict = tmp_path / "verdict.txt"
    environment = blenders.make_profile(tmp_path, bundles_module=True)
    result = subprocess.run(
        [
            *(blenders.system_blender(), "--factory-startup", "--window-geometry", "0", "0", *map(str, SIZE)),
            *("--python", str(HERE / "drive_live_unwrap.py"), "--", str(SCREENSHOTS), str(verdict)),
        ],
        env={**environment, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
    )
    outcome = verdict.read_text() if verdict.exists() else "Blender ended without a verdict"
    if outcome != "passed":
        pytest.fail(f"{outcome}\nScreenshots: {SCREENSHOTS}\n{result.stdout}", pytrace=False)
