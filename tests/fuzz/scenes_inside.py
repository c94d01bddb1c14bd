# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: make random scenes, call the operators on them, and look for failures.

`... scenes_inside.py -- SEED FIRST COUNT`. Every scene has a generator of random numbers of its own, made of the seed
and its number. Lines that begin with `@fuzz` are for scenes_run.py, which started this: `@fuzz begin N`,
`@fuzz call ...`, `@fuzz bad N ...`, `@fuzz end N seconds vertices`.
"""

import faulthandler
import sys
import time
import traceback

import bpy

# isort: split
import addon_utils
import numpy as np

from tests.fuzz import scenes_checks, scenes_random

ADDON = "spectral_unwrap"
STEPS = 3
# Beyond, a whole scene counts as hanging; this is no limit of speed.
SECONDS = 120.0


def say(*words):
    """Send a message to scenes_run.py on a line of its own, even if Blender has begun one."""
    print("\n@fuzz", *(str(word).replace("\n", " | ") for word in words), flush=True)


def fresh_blender():
    """Load the empty factory settings and enable the add-on."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if addon_utils.enable(ADDON, default_set=True) is None:
        sys.exit("The add-on could not be enabled; the reason is above")


def run_scene(seed, number):
    """Make one scene and call a few operators on it; return (seconds in operators, vertices).

    Raises:
        AssertionError: something happened that must not.
    """
    fresh_blender()
    edited = scenes_random.make(np.random.default_rng([seed, number]))
    # Another one, so that the calls are the same where Blender's tools do not make exactly the same meshes.
    rng = np.random.default_rng([seed, number, 1])
    # By name: after an undo the objects are others.
    names, vertices = [item.name for item in edited], sum(len(item.data.vertices) for item in edited)
    bpy.context.scene.spectral_unwrap_live = bool(rng.random() < 0.1)
    seconds = 0.0
    for _ in range(rng.integers(1, STEPS + 1)):
        call = scenes_checks.random_call(rng, [bpy.data.objects[name] for name in names])
        say("call", number, call.description)
        start = time.perf_counter()
        scenes_checks.check(rng, call)
        seconds += time.perf_counter() - start
    bpy.ops.object.mode_set(mode="OBJECT")
    return seconds, vertices


def main():
    """Run the scenes that the command line asks for."""
    faulthandler.enable()
    seed, first, count = map(int, sys.argv[sys.argv.index("--") + 1 :])
    for number in range(first, first + count):
        say("begin", number)
        faulthandler.dump_traceback_later(SECONDS, exit=True)
        try:
            seconds, vertices = run_scene(seed, number)
        except Exception:  # noqa: BLE001 - whatever it is, it is what we look for
            say("bad", number, traceback.format_exc())
            seconds, vertices = 0.0, 0
        faulthandler.cancel_dump_traceback_later()
        say("end", number, f"{seconds:.3f}", vertices)


if __name__ == "__main__":
    main()
