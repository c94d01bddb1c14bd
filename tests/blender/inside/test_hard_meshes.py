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

# tests/module/test_hard_meshes.py has them all.
SOLVED = ["concave polygon", "isolated vertices", "mixed", "needles", "scale 1e6", "three components", "tube"]
REJECTED = ["line", "point", "closed", "empty", "vertices only", "one-sided", "NaN"]
EITHER = ["three faces at an edge", "too far away"]


def edited(vertices, faces, name="Hard"):
    new = scenes.new_object(vertices, faces, name=name)
    scenes.edit(new)
    return new


def solved_charts():
    """Return what the operator will write: the solution of the only mesh in edit mode."""
    settings = options.Settings()
    (solution,) = steps.solve(steps.read(bpy.context, settings), settings)
    return solution


def deviation(uv, reference):
    """Return the greatest distance of `uv` from `reference` moved by the best similarity, relative to the extent."""
    z, w = (points[:, 0] + 1j * points[:, 1] for points in (uv, reference))
    z, w = z - z.mean(), w - w.mean()
    return np.abs(z - np.vdot(w, z) / np.vdot(w, w) * w).max() / np.abs(z).max()


@pytest.mark.parametrize("name", SOLVED)
def test_solvable_mesh_is_solved(name, reports):
    case = hard_meshes.CASES[name]
    target = edited(*case.make())
    solution, before = solved_charts(), digest.digest()
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    told = [text for level, text in reports() if level in {"Error", "Warning"}]
    # The tube's one end shrinks beyond single precision.
    about_quality = ("stretched to more than twice", "varies in size", "vary in size")
    told = [text for text in told if not any(words in text for words in about_quality)]
    assert [text for text in told if "too small for the precision" not in text] == []
    assert not told or "tube" in name
    assert digest.changes(before, digest.digest()) == []
    uv = scenes.read_uv(target)
    assert np.isfinite(uv).all()
    assert [chart.status for chart in solution.charts] == ["solved"] * case.charts
    assert {abs(chart.turning_number) for chart in solution.charts} == {1}
    assert sum(chart.flipped for chart in solution.charts) <= case.allowed_flips
    for chart in range(case.charts):
        corners = solution.chart_of_corner == chart
        # Single precision: the charts lie in the unit square.
        assert deviation(uv[corners], solution.uv[corners]) < 1e-4


def unwrapped(told):
    """Return the report of the unwrap, which warnings may follow."""
    return next(text for _, text in told if text.startswith("Unwrapped "))


@pytest.mark.parametrize("name", ["Floater, on the limit", "Floater, beyond"])
def test_flips_are_reported(name, reports):
    edited(*hard_meshes.CASES[name].make())
    flips = sum(chart.flipped for chart in solved_charts().charts)
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert (f"; {flips} flipped face" if flips else "; no flipped faces") in unwrapped(reports())


@pytest.mark.parametrize("name", REJECTED)
def test_mesh_without_solution_is_rejected(name, reports):
    vertices, faces = hard_meshes.CASES[name].make()
    target = edited(vertices, faces)
    before, uv = digest.digest(), digest.active_uv(target.data).tobytes()
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    ((level, text),) = reports()
    assert level == "Warning"
    assert ("failed, UVs unchanged: " if faces else "No faces selected") in text or "Not unwrapped: " in text
    assert digest.changes(before, digest.digest()) == []
    assert digest.active_uv(target.data).tobytes() == uv


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


@pytest.mark.parametrize("name", EITHER)
def test_mesh_is_solved_or_rejected(name, reports):
    target = edited(*hard_meshes.CASES[name].make())
    before, uv = digest.digest(), digest.active_uv(target.data)
    reports()
    status = bpy.ops.uv.spectral_unwrap()
    assert digest.changes(before, digest.digest()) == []
    after = digest.active_uv(target.data)
    assert np.isfinite(after).all()
    is_solved = status == {"FINISHED"}
    assert is_solved == (after.tobytes() != uv.tobytes())
    assert is_solved != any("UVs unchanged: " in text for level, text in reports() if level == "Warning")
