# SPDX-License-Identifier: GPL-3.0-or-later
"""If a problem's own solve fails, another problem is solved: fields say which, and it can be forbidden."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import degenerate, meshes, reference

# Surfaces so rough that the boundary of their own map winds around twice or more: (mesh, weights), by what stands in.
CASES = {
    "unfolded": (meshes.rough_grid(10, 4.0, 6), "uniform"),
    "unfolded, from inverse area": (meshes.rough_grid(10, 4.0, 5), "inverse_area"),
    "unfolded, of needles": (degenerate.needles(*meshes.rough_grid(10, 2.0, 4), 1e-5), "inverse_area"),
    "tutte_embedding": (meshes.rough_grid(8, 3.0, 2), "uniform"),
}
OTHER = {"uniform": "inverse_area", "inverse_area": "uniform"}


@pytest.fixture(params=CASES)
def case(request):
    """(vertices, triangles, weights asked for, expected fallback)"""
    (vertices, triangles), weights = CASES[request.param]
    return vertices, triangles, weights, request.param.partition(",")[0]


def mean_qc(vertices, triangles, solution):
    """Mean QC, infinite for a map with flipped triangles."""
    measured = sc.distortion(vertices, triangles, solution.uv)
    return np.inf if measured.flipped.any() else measured.mean_qc


def test_the_fields_say_what_stands_in(case):
    vertices, triangles, weights, fallback = case
    solution = sc.parameterize(vertices, triangles, weights=weights, fallbacks=True)
    assert solution.fallback == fallback
    assert solution.method == "spectral"
    assert solution.weights == weights
    assert solution.boundary == "length"
    assert solution.clamped_triangles == 0
    assert solution.attempts > 2  # two of its own, and those of the fallbacks
    assert abs(solution.turning_number) == 1
    assert solution.unfolded > 0
    assert solution.is_embedding == (fallback == "tutte_embedding")
    assert solution.eigenvalue_of == "map"
    assert "winds around" in solution.message
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles), weights=weights).charts
    for name in ("method", "weights", "boundary", "fallback", "clamped_triangles", "eigenvalue", "eigenvalue_of"):
        assert getattr(chart, name) == getattr(solution, name)
    assert (chart.attempts, chart.unfolded, chart.flipped) == (solution.attempts, solution.unfolded, 0)


@pytest.mark.parametrize("seed", range(40))
def test_of_a_quad_one_split_counts(seed):
    # Among them a surface whose map would pass by one split of its quads and is refused by the other (3 x 3, 45).
    vertices = meshes.rough_grid_points(3 if seed < 20 else 6, 3.0, 36 + seed)
    n = 3 if seed < 20 else 6
    (chart,) = sc.unwrap(vertices, *meshes.polygons(meshes.grid_quads(n, n))).charts
    assert chart.status == "solved"
    if chart.fallback is not None:
        assert chart.flipped == 0
        assert abs(chart.turning_number) == 1


def test_the_eigenvalue_is_that_of_the_map(case):
    vertices, triangles, weights, _ = case
    solution = sc.parameterize(vertices, triangles, weights=weights, fallbacks=True)
    matrix = reference.conformal_energy_matrix(vertices, triangles, solution.weights)
    mass = reference.boundary_masses(vertices, triangles, solution.boundary)
    z = solution.uv @ [1, 1j]
    # Next to the needles' cotangents of 1e5 the reference, which is not summed by triangles, keeps fewer digits.
    digits = 1e-4 if len(vertices) > 100 else 1e-6
    assert solution.eigenvalue == pytest.approx(reference.rayleigh_quotient(matrix, mass, z), rel=digits)


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("weights", OTHER)
@pytest.mark.parametrize(
    "options", [{}, {"area_blend": 0.2}, {"fold_free": True}, {"hole_rigidity": "automatic"}], ids=str
)
def test_no_disk_fails(options, weights, seed):
    mesh = meshes.rough_grid(8, 1.0 + seed % 4, seed)
    solution = sc.parameterize(*mesh, weights=weights, fallbacks=True, **options)
    assert abs(solution.turning_number) == 1
    if solution.fallback in ("unfolded", "tutte_embedding"):
        assert np.isfinite(mean_qc(*mesh, solution))


def test_without_fallbacks_the_failure_is_the_answer(case):
    vertices, triangles, weights, _ = case
    for solve in (
        lambda: sc.parameterize(vertices, triangles, weights=weights),
        lambda: sc.parameterize(vertices, triangles, weights=weights, fallbacks=False),
        lambda: sc.Solver(vertices, triangles, weights=weights).solve(),
        lambda: sc.Solver(vertices, triangles, weights=weights, fallbacks=True).solve(fallbacks=False),
    ):
        with pytest.raises(sc.SolveError, match="winds around . times instead of once"):
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
        assert "winds around" in failed.message
        assert failed.fallback is None


def test_an_area_blend_says_how_its_relaxation_ended():
    vertices, triangles = meshes.bumpy_disk(300)
    assert sc.parameterize(vertices, triangles).relaxation is None
    blended = sc.parameterize(vertices, triangles, area_blend=1.0)
    assert blended.relaxation == "converged"
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles), area_blend=1.0).charts
    assert chart.relaxation == blended.relaxation
