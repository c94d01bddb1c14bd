# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard meshes through the operator: what is written, what stays and what is reported."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, scenes
from tests.module import hard_meshes

options = importlib.import_module("spectral_unwrap.core.solve.options")
steps = importlib.import_module("spectral_unwrap.unwrapping.steps")

REJECTED = ["line", "point", "closed", "empty", "vertices only", "one-sided", "NaN"]


def edited(vertices, faces, name="Hard"):
    new = scenes.new_object(vertices, faces, name=name)
    scenes.edit(new)
    return new


def deviation(uv, reference):
    """Return the greatest distance of `uv` from `reference` moved by the best similarity, relative to the extent."""
    z, w = (points[:, 0] + 1j * points[:, 1] for points in (uv, reference))
    z, w = z - z.mean(), w - w.mean()
    return np.abs(z - np.vdot(w, z) / np.vdot(w, w) * w).max() / np.abs(z).max()


# Alone there is nothing to map; beside others they become a point.
WITHOUT_AREA = {"line", "point"}


@pytest.mark.parametrize("in_one_mesh", [True, False], ids=["in one mesh", "in two objects"])
@pytest.mark.parametrize("name", REJECTED)
def test_the_rest_is_solved(name, in_one_mesh, reports):
    bad, good = hard_meshes.CASES[name].make(), hard_meshes.hill(triangles=False)
    good_corners = 4 * len(good[1])
    if in_one_mesh:
        targets = [edited(*hard_meshes.joined(good, bad))]
    else:
        targets = [scenes.new_object(*mesh, name=name) for mesh, name in ((good, "Good"), (bad, "Bad"))]
        scenes.edit(*targets)
    before, uv = digest.digest(), [digest.active_uv(target.data) for target in targets]
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    # What fails has UVs all over the tile.
    beside = ("packed beside it", "stretched to more than twice")
    told = [(level, text) for level, text in reports() if not any(words in text for words in beside)]
    has_points = name in WITHOUT_AREA
    assert [level for level, _ in told] == ["Info", "Info" if has_points else "Warning"] if bad[1] else ["Info"]
    assert digest.changes(before, digest.digest()) == []
    after = [digest.active_uv(target.data) for target in targets]
    kept = [after[0][good_corners:], *after[1:]]
    if has_points:
        assert all(np.ptp(part, axis=0).max() == 0 for part in kept if len(part))
    else:
        assert [part.tobytes() for part in kept] == [part.tobytes() for part in (uv[0][good_corners:], *uv[1:])]
    alone = edited_alone(good)
    assert deviation(after[0][:good_corners], alone) < 1e-5


def edited_alone(mesh):
    """Return the UVs that the operator gives a mesh by itself."""
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    target = edited(*mesh, name="Alone")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    return scenes.read_uv(target)
