# SPDX-License-Identifier: GPL-3.0-or-later
"""Python's part of Spectral Unwrap stays small: processor time of reading, placing and writing over the solve's.

Both run in one process, so that a busy machine slows both, and the least of several rounds counts. Limits are up to
twice today's shares: these differ between versions of Blender, and grow where other work shares the caches.
"""

import importlib
import time

import bpy
import pytest

from tests.benchmarks import operator_scenes
from tests.benchmarks.generated import Scene
from tests.blender.inside import scenes

steps = importlib.import_module("spectral_unwrap.unwrapping.steps")
write = importlib.import_module("spectral_unwrap.edit_mesh.write")
session = importlib.import_module("spectral_unwrap.session")
kept_maps = importlib.import_module("spectral_unwrap.session.kept_maps")
native = importlib.import_module("spectral_unwrap.core.native")

ROUNDS = 4
# The rows of `tests.benchmarks table` at a small size, and the largest share.
LIMITS = {
    "one patch": (Scene(100), 0.7),
    "many islands": (Scene(8, islands=150), 3.0),
    "large islands": (Scene(30, islands=6), 3.0),
    "objects of many islands": (Scene(8, objects=4, islands=40), 3.5),
    "many objects": (Scene(8, objects=40), 9.0),
}


class Clock:
    """Adds up the processor time spent in a function, which it replaces."""

    def __init__(self, monkeypatch, owner, name):
        self.seconds, self.function = 0.0, getattr(owner, name)
        monkeypatch.setattr(owner, name, self)

    def __call__(self, *arguments, **keywords):
        start = time.process_time()
        try:
            return self.function(*arguments, **keywords)
        finally:
            self.seconds += time.process_time() - start


@pytest.mark.parametrize("name", LIMITS)
def test_reading_placing_and_writing_cost_little_beside_the_solve(name, monkeypatch):
    scene, limit = LIMITS[name]
    objects = [bpy.data.objects.new("Object", operator_scenes.mesh_of(bpy, given)) for given in scene.meshes()]
    for each in objects:
        bpy.context.collection.objects.link(each)
    scenes.edit(*objects)
    around = [Clock(monkeypatch, *each) for each in ((steps, "read"), (steps, "place"), (write, "write_uv"))]
    solve = Clock(monkeypatch, native.spectral_conformal()._native, "unwrap")
    shares = []
    for _ in range(ROUNDS):
        # Kept maps would not be solved again.
        session.drop(kept_maps.KeptMaps)
        for clock in (*around, solve):
            clock.seconds = 0.0
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        shares.append(sum(clock.seconds for clock in around) / solve.seconds)
    assert 0.0 < min(shares) <= limit
