import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference

OPTIONS = [(w, b) for w in ("uniform", "inverse_area") for b in ("length", "vertex")]


@pytest.mark.parametrize(("weights", "boundary"), OPTIONS)
@pytest.mark.parametrize(
    ("n", "holes"), [(100, 0), (400, 5), (3000, 40), pytest.param(10000, 12, marks=pytest.mark.slow)]
)
def test_eigenvalue_and_vector_are_those_of_dense_algebra(n, holes, weights, boundary):
    vertices, triangles = meshes.bumpy_disk(n, holes)
    matrix = reference.conformal_energy_matrix(vertices, triangles, weights)
    mass = reference.boundary_masses(vertices, triangles, boundary)
    expected, z = reference.smallest_eigenpair(matrix, mass)
    solution = sc.parameterize(vertices, triangles, weights=weights, boundary=boundary)
    # At 10,000 vertices with inverse-area weights the reference itself is good to a few parts in 1e7.
    assert solution.eigenvalue == pytest.approx(expected, rel=1e-6)
    assert meshes.similarity_deviation(solution.uv, np.c_[z.real, z.imag]) < 1e-6
    assert solution.residual < 1e-14
    assert solution.turning_number == 1
    assert solution.message == ""


def test_longest_loop_may_be_a_hole_of_the_map():
    n = 60
    angle = 2 * np.pi * np.arange(n) / n
    radii = [1 + 0 * angle, 0.8 + 0 * angle, 0.6 + 0.15 * (-1) ** np.arange(n)]  # the zigzag is the longest
    flat = np.concatenate([np.c_[r * np.cos(angle), r * np.sin(angle)] for r in radii])
    ring = np.arange(3 * n).reshape(3, n)
    a, b, c, d = ring[:-1], np.roll(ring, -1, 1)[:-1], np.roll(ring, -1, 1)[1:], ring[1:]
    triangles = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((b, a, c), (c, a, d))])
    vertices = np.c_[flat, 0 * flat[:, 0]]
    solution = sc.parameterize(vertices, triangles)
    assert (solution.turning_number, solution.message) == (-1, "")
    assert sc.distortion(vertices, triangles, solution.uv).max_qc - 1 < 1e-9
