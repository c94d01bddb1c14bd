# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist does by mouse and keyboard: seams, menu, Adjust Last Operation, search, and long solves."""

import subprocess

import blenders
import pytest
from test_interface import HERE, SCREENSHOTS, SIZE, display  # noqa: F401 - a fixture


@pytest.mark.parametrize("driver", ["drive_seams.py", "drive_long_solve.py"])
def test_artist(driver, display, tmp_path):  # noqa: F811 - the fixture
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    verdict = tmp_path / "verdict.txt"
    result = subprocess.run(
        [
            *(blenders.system_blender(), "--factory-startup", "--window-geometry", "0", "0", *map(str, SIZE)),
            *("--python", str(HERE / driver), "--", str(SCREENSHOTS), str(verdict)),
        ],
        env={
            **blenders.make_profile(tmp_path, bundles_module=True),
            "DISPLAY": display,
            "LIBGL_ALWAYS_SOFTWARE": "1",
        },
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
    )
    outcome = verdict.read_text() if verdict.exists() else "Blender ended without a verdict"
    if outcome != "passed":
        pytest.fail(f"{outcome}\nScreenshots: {SCREENSHOTS}\n{result.stdout}", pytrace=False)
