"""Extenders and hole rigidity (section 4.2)."""

import numpy as np
import pytest
import scipy.linalg
import spectral_conformal as sc

from tests.module import meshes, reference


def cap(n, height=1.2):
    """A curved square patch on n x n vertices, without symmetry; the same surface for every n."""
    points, quads = meshes.unit_square(n)
    x, y = 2 * points.T - 1
    z = height * np.exp(-3 * ((x - 0.2) ** 2 + (y + 0.1) ** 2)) + 0.2 * np.sin(2 * x + y)
    return np.c_[x, y, z], meshes.triangles_of(quads)


def at(n, x, y):
    """The vertex of `cap` at a place in [-1, 1] x [-1, 1]."""
    i, j = (round((c + 1) / 2 * (n - 1)) for c in (x, y))
    return i * n + j


def distance(uv, i, j):
    return np.linalg.norm(uv[i] - uv[j])


@pytest.mark.parametrize("factorization", ["auto", "eigen"])
def test_strength_zero_changes_nothing(factorization):
    vertices, triangles = meshes.bumpy_disk(600, holes=2)
    plain = sc.parameterize(vertices, triangles, factorization=factorization)
    same = sc.parameterize(
        vertices, triangles, extenders=[(3, 90, 0.0), (7, 50, 0.0)], hole_rigidity=0.0, factorization=factorization
    )
    np.testing.assert_array_equal(same.uv, plain.uv)


@pytest.mark.parametrize("strength", [0.3, 5.0, -0.05])
def test_is_the_eigenvector_of_the_form_with_the_force(strength):
    vertices, triangles = meshes.bumpy_disk(300, holes=2)
    pair, other = (5, 250), (40, 200)
    matrix = reference.conformal_energy_matrix(vertices, triangles).toarray()
    mass = reference.boundary_masses(vertices, triangles)
    form = np.diag(mass) - np.outer(mass, mass) / mass.sum()
    for (i, j), alpha in ((pair, strength), (other, 0.5 * strength)):
        e = np.zeros(len(vertices))
        e[i], e[j] = 1, -1
        form = form + alpha * mass.sum() * np.outer(e, e)
    values, vectors = scipy.linalg.eigh(form, matrix + np.ones_like(matrix))
    expected = np.c_[vectors[:, -1].real, vectors[:, -1].imag]
    solution = sc.parameterize(vertices, triangles, extenders=[(*pair, strength), (*other, 0.5 * strength)])
    assert solution.eigenvalue == pytest.approx(1 / values[-1], rel=1e-7)
    assert meshes.similarity_deviation(solution.uv, expected) < 1e-6


def test_scale_and_sampling_do_not_change_the_effect():
    def effect(n, scale=1.0):
        vertices, triangles = cap(n)
        i, j = at(n, -0.9, -0.7), at(n, 0.5, 0.8)
        solver = sc.Solver(vertices * scale, triangles)
        return distance(solver.solve(extenders=[(i, j, 3.0)]).uv, i, j) / distance(solver.solve().uv, i, j)

    assert effect(41) > 1.02
    assert effect(41, scale=1000.0) == pytest.approx(effect(41), rel=1e-8)
    assert effect(81) == pytest.approx(effect(41), rel=0.05)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"extenders": [(0, 0, 1.0)]}, "joins vertex 0 with itself"),
        ({"extenders": [(0, 9999, 1.0)]}, "there are 600 vertices"),
        ({"extenders": [(0, 1, float("nan"))]}, "must lie between"),
        ({"extenders": [(0, 1, 1e5)]}, "must lie between"),
        ({"extenders": [(0, 1, 1.0, 0.0)]}, "half of extender 0 must lie between"),
        ({"extenders": [(0, 1, 1.0)], "method": "fiedler"}, "method 'spectral'"),
    ],
)
def test_bad_forces_are_named(options, message):
    vertices, triangles = meshes.bumpy_disk(600)
    with pytest.raises(ValueError, match=message):
        sc.parameterize(vertices, triangles, **options)
