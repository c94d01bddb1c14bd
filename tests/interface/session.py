# SPDX-License-Identifier: GPL-3.0-or-later
"""Mouse, keyboard, screenshots and the verdict, for scripts that drive Blender from inside, with a window.

    blender --factory-startup --python drive_....py -- <folder for the screenshots> <file for the verdict>

The steps are a generator; Blender's event loop runs at each `yield`. The verdict is "passed" or a traceback.
"""

import itertools
import subprocess
import sys
import traceback
from pathlib import Path

import bmesh
import bpy
import gpu
import numpy as np

DRIVER = Path(sys.argv[sys.argv.index("--python") + 1])
SCREENSHOTS, VERDICT = (Path(path) for path in sys.argv[sys.argv.index("--") + 1 :][:2])
BACKEND = "".join(sys.argv[sys.argv.index("--") + 3 :])  # "vulkan" or "opengl"; empty where Blender may choose
# Between steps: passes of Blender's loop, each of which handles what was sent and draws, however long that takes; and
# seconds at least, more than lie between the two clicks of a double click.
PASSES, PAUSE = 3, 0.4


def xdotool(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True)


def screenshot(name):
    subprocess.run(["import", "-window", "root", str(SCREENSHOTS / f"{name}.png")], check=True)


def picture(name):
    """Take a screenshot; return its pixels from the lowest row up, (height, width, 3), displayed colors of 0 to 1."""
    screenshot(name)
    image = bpy.data.images.load(str(SCREENSHOTS / f"{name}.png"))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[..., :3]


def area_of(kind):
    return next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == kind)


def override(kind):
    area = area_of(kind)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region)


def point_at(kind, x=0.5, y=0.5):
    """Move the mouse to a place in an editor, `x` to the right and `y` upward, each from 0 to 1."""
    area, window = area_of(kind), bpy.context.window_manager.windows[0]
    xdotool("mousemove", int(area.x + x * area.width), int(window.height - area.y - y * area.height))


def uv():
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    layer = bm.loops.layers.uv.active
    return np.array([loop[layer].uv for face in bm.faces for loop in face.loops])


def run(sequence):
    """Carry out the steps, one after the other, and quit."""
    passes = itertools.count(1)

    def advance():
        if next(passes) % PASSES:
            return PAUSE / PASSES
        try:
            if BACKEND:
                drawn_by = gpu.platform.backend_type_get()
                assert drawn_by == BACKEND.upper(), f"drawn by {drawn_by}: is there no device for {BACKEND}?"
            next(sequence)
            return PAUSE / PASSES
        except StopIteration:
            VERDICT.write_text("passed")
        except BaseException:  # noqa: BLE001 - whatever happened goes to the test that waits for the verdict
            screenshot(f"failed_{DRIVER.stem}")
            VERDICT.write_text(traceback.format_exc())
        bpy.ops.wm.quit_blender()
        return None

    # Blender would draw everything eight times, on the processor.
    bpy.context.preferences.system.viewport_aa = "OFF"
    bpy.app.timers.register(advance, first_interval=3.0, persistent=True)
