# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of hard mesh has the expected outcome."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import hard_meshes, meshes

EITHER = [name for name, case in hard_meshes.CASES.items() if case.may_be_either]
REJECTED = [name for name, case in hard_meshes.CASES.items() if case.expect == "reject" and name not in EITHER]
SOLVED = [name for name, case in hard_meshes.CASES.items() if case.expect != "reject" and name not in EITHER]


# Those that the operator begins with, and others.
OPTIONS = {
    "operator": {"polish": True, "hole_rigidity": "automatic"},
    "plain": {},
    "by area and vertex": {"weights": "inverse_area", "boundary": "vertex"},
    "without folds": {"fold_free": True},
}


def unwrapped(mesh, options="operator"):
    vertices, faces = mesh
    return sc.unwrap(vertices, *meshes.polygons(faces), **OPTIONS[options])


@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("name", SOLVED)
def test_solvable_mesh_is_solved(name, options):
    case = hard_meshes.CASES[name]
    result = unwrapped(case.make(), options)
    assert np.isfinite(result.uv).all()
    assert [chart.status for chart in result.charts] == ["solved"] * case.charts
    assert {abs(chart.turning_number) for chart in result.charts} == {1}
    allowed = 0 if options == "without folds" else case.allowed_flips
    assert sum(chart.flipped for chart in result.charts) <= allowed


@pytest.mark.parametrize("name", REJECTED)
def test_mesh_without_solution_is_rejected_and_the_rest_solved(name):
    bad, good = hard_meshes.CASES[name].make(), hard_meshes.hill(triangles=False)
    alone = unwrapped(good)
    both = unwrapped(hard_meshes.joined(good, bad))
    corners = 4 * len(good[1])
    assert both.charts[0].status == "solved"
    assert meshes.similarity_deviation(both.uv[:corners], alone.uv) < 1e-9
    if not bad[1]:
        with pytest.raises(sc.InvalidMeshError, match="no faces"):
            sc.unwrap(bad[0], [0], [])
        return
    for chart in [*unwrapped(bad).charts, *both.charts[1:]]:
        # What has no area becomes a point.
        is_point = chart.status == "solved" and "no area" in chart.message
        assert is_point or (chart.status == "failed" and chart.message)


@pytest.mark.parametrize("name", EITHER)
def test_mesh_is_solved_or_rejected(name):
    result = unwrapped(hard_meshes.CASES[name].make())
    assert np.isfinite(result.uv).all()
    assert all(chart.message for chart in result.charts if chart.status == "failed")


@pytest.mark.parametrize("name", ["scale 1e-6", "scale 1e6", "far away"])
def test_size_and_place_do_not_matter(name):
    expected, found = (unwrapped(hard_meshes.CASES[each].make()).uv for each in ("scale 1", name))
    assert meshes.similarity_deviation(found, expected) < 1e-7
