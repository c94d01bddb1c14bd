# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a problem's own solve fails, another one is solved: fields say which, and it can be forbidden."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import degenerate, meshes, reference

# Surfaces so rough that the boundary of their own map winds round twice: (mesh, weights, fallback that helps).
CASES = {
    "clamped_triangles": (degenerate.needles(*meshes.rough_grid(10, 2.0, 4), 1e-5), "inverse_area"),
    "other_boundary": (meshes.rough_grid(10, 4.0, 6), "uniform"),
    "other_weights": (meshes.rough_grid(10, 2.0, 10), "uniform"),
    "other_weights, from inverse area": (meshes.rough_grid(10, 4.0, 5), "inverse_area"),
}
OTHER = {"uniform": "inverse_area", "inverse_area": "uniform"}


@pytest.fixture(params=CASES)
def case(request):
    """(vertices, triangles, weights asked for, expected fallback)"""
    (vertices, triangles), weights = CASES[request.param]
    return vertices, triangles, weights, request.param.partition(",")[0]


def test_the_fields_say_what_was_solved(case):
    vertices, triangles, weights, fallback = case
    solution = sc.parameterize(vertices, triangles, weights=weights)
    assert solution.fallback == fallback
    assert solution.method == "spectral"
    assert solution.weights == (OTHER[weights] if fallback == "other_weights" else weights)
    assert solution.boundary == ("vertex" if fallback == "other_boundary" else "length")
    assert (solution.clamped_triangles > 0) == (fallback == "clamped_triangles")
    assert solution.attempts > 2  # two of its own, and those of the fallbacks
    assert abs(solution.turning_number) == 1
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles), weights=weights).charts
    for name in ("method", "weights", "boundary", "fallback", "clamped_triangles", "eigenvalue", "eigenvalue_of"):
        assert getattr(chart, name) == getattr(solution, name)
    assert chart.attempts == solution.attempts


def test_the_eigenvalue_is_that_of_what_was_solved(case):
    vertices, triangles, weights, fallback = case
    solution = sc.parameterize(vertices, triangles, weights=weights)
    assert solution.eigenvalue_of == "eigenvector"
    if fallback == "clamped_triangles":
        return  # the energy of other triangles than the mesh's
    matrix = reference.conformal_energy_matrix(vertices, triangles, solution.weights)
    mass = reference.boundary_masses(vertices, triangles, solution.boundary)
    z = solution.uv @ [1, 1j]
    assert solution.eigenvalue == pytest.approx(reference.rayleigh_quotient(matrix, mass, z), rel=1e-6)
    same = sc.parameterize(vertices, triangles, weights=solution.weights, boundary=solution.boundary, fallbacks=False)
    assert (same.fallback, same.eigenvalue) == (None, pytest.approx(solution.eigenvalue, rel=1e-9))
    assert meshes.similarity_deviation(same.uv, solution.uv) < 1e-7


def test_without_fallbacks_the_failure_is_the_answer(case):
    vertices, triangles, weights, _ = case
    for solve in (
        lambda: sc.parameterize(vertices, triangles, weights=weights, fallbacks=False),
        lambda: sc.Solver(vertices, triangles, weights=weights, fallbacks=False).solve(),
        lambda: sc.Solver(vertices, triangles, weights=weights).solve(fallbacks=False),
    ):
        with pytest.raises(sc.SolveError, match="winds round 2 times instead of once"):
            solve()
    more, other = meshes.bumpy_disk(60)
    both = [*triangles.tolist(), *(other + len(vertices)).tolist()]
    mesh = (np.vstack([vertices, more + 50.0]), *meshes.polygons(both))
    for result in (
        sc.unwrap(*mesh, weights=weights, fallbacks=False),
        sc.Unwrapper(*mesh, weights=weights, fallbacks=False).solve(),
    ):
        failed, solved = result.charts
        assert (failed.status, solved.status) == ("failed", "solved")
        assert "winds round 2 times" in failed.message
        assert failed.fallback is None


@pytest.mark.parametrize(("weights", "boundary"), [("uniform", "length"), ("inverse_area", "vertex")])
@pytest.mark.parametrize("method", ["spectral", "fiedler", "area"])
def test_a_solve_that_passes_is_what_was_asked_for(method, weights, boundary):
    vertices, triangles = meshes.bumpy_disk(300, 1)
    options = {"method": method, "weights": weights, "boundary": boundary}
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles), **options).charts
    for record in (sc.parameterize(vertices, triangles, **options), chart):
        assert (record.method, record.weights, record.boundary) == (method, weights, boundary)
        assert (record.fallback, record.clamped_triangles, record.attempts) == (None, 0, 1)
        assert record.eigenvalue_of == "eigenvector"


@pytest.mark.parametrize("fallbacks", [True, False])
def test_the_embedding_of_fold_free_is_named_and_made_either_way(fallbacks):
    vertices, triangles = meshes.floater(-3.0)
    solution = sc.parameterize(vertices, triangles, fold_free=True, fallbacks=fallbacks)
    assert solution.is_embedding
    assert (solution.fallback, solution.eigenvalue_of) == ("tutte_embedding", "map")
    assert np.isfinite(solution.mean_qc_before)


def test_maps_that_are_no_eigenvectors_say_so():
    vertices, triangles = meshes.rough_grid(14, 2.0, 3)
    for options in ({"fold_free": True}, {"method": "lscm"}, {"method": "lscm", "pins": {0: (0, 0), 9: (1, 0)}}):
        solution = sc.parameterize(vertices, triangles, **options)
        assert solution.eigenvalue_of == "map"


def test_an_area_blend_says_how_its_relaxation_ended():
    vertices, triangles = meshes.bumpy_disk(300)
    assert sc.parameterize(vertices, triangles).relaxation is None
    blended = sc.parameterize(vertices, triangles, area_blend=1.0)
    assert blended.relaxation == "converged"
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles), area_blend=1.0).charts
    assert chart.relaxation == blended.relaxation
