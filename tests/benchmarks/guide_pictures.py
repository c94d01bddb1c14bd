# SPDX-License-Identifier: GPL-3.0-or-later
"""Take the guide's pictures of Blender's window, in Debian 12's Blender on a virtual screen.

    build/venv/bin/python -m tests.benchmarks.guide_pictures [picture ...]

Most are screenshots of the tests by mouse (`tests/interface/`), which these take anyway: `--taken` uses those of the
last run. Without names, all are made.
"""

from __future__ import annotations

import argparse
import subprocess
from pathlib import Path
from typing import NamedTuple

from tests.blender import blenders
from tests.interface import test_interface

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
OWN = "guide_scenes.py"
BLENDER = "system"
# The two editors without Blender's outliner and properties, and the width of the picture, in pixels.
EDITORS, WIDTH = "1300x950+0+28", "990"


class Picture(NamedTuple):
    """A picture of the guide: the driver and its screenshot."""

    driver: str
    screenshot: str


PICTURES = {
    "suggest_seams": Picture("drive_suggest_seams.py", "suggest_seams_preview"),
    "progress": Picture("drive_long_solve.py", "solving"),
    "uv_menu": Picture("drive_blender.py", "menu_in_viewport"),
    "adjust_last_operation": Picture("drive_blender.py", "adjust_last_operation"),
    "extender": Picture("drive_adjust_extender.py", "extender_dragged"),
    "live_pin": Picture("drive_live_unwrap.py", "live_pin_dragged"),
    "constraints": Picture("drive_constraints.py", "constraints"),
    "seam_hints": Picture("drive_seam_hints.py", "seam_hints"),
    "select_defects": Picture("drive_select_defects.py", "select_defects"),
    "map_overlay": Picture(OWN, "guide_map_overlay"),
    "stacks": Picture(OWN, "guide_stacks"),
}


def main() -> None:
    """Run the drivers of the wanted pictures, and cut these out of their screenshots."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pictures", nargs="*", choices=[*PICTURES, []], help="by default all")
    parser.add_argument("--taken", action="store_true", help="use the screenshots of the last run")
    options = parser.parse_args()
    wanted = {name: PICTURES[name] for name in options.pictures or PICTURES}
    if not options.taken:
        blender = next(each for each in blenders.blenders_with_window() if each.name == BLENDER)
        for driver in dict.fromkeys(picture.driver for picture in wanted.values()):
            failure = test_interface.drive(driver, blender)
            if failure:
                raise SystemExit(f"{driver}: {failure}")
    for name, picture in wanted.items():
        taken = test_interface.SCREENSHOTS / BLENDER / f"{picture.screenshot}.png"
        path = IMAGES / f"blender_{name}.png"
        # ImageMagick keeps the colors of small legends in a palette, a third of the size.
        options = ["-crop", EDITORS, "+repage", "-resize", WIDTH, "+dither", "-colors", "255", "-strip"]
        subprocess.run(["convert", taken, *options, path], check=True)
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
