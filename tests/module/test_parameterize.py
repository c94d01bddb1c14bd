import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference

OPTIONS = [(w, b) for w in ("uniform", "inverse_area") for b in ("length", "vertex")]


@pytest.mark.parametrize(("weights", "boundary"), OPTIONS)
@pytest.mark.parametrize(
    ("n", "holes"), [(100, 0), (400, 5), (3000, 0), (3000, 40), pytest.param(10000, 12, marks=pytest.mark.slow)]
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


@pytest.mark.parametrize(("weights", "boundary"), OPTIONS)
def test_eigenvalue_has_the_units_of_the_input(weights, boundary):
    vertices, triangles = meshes.bumpy_disk(500)
    mass = reference.boundary_masses(1000 * vertices, triangles, boundary)
    matrix = reference.conformal_energy_matrix(1000 * vertices, triangles, weights)
    solution = sc.parameterize(1000 * vertices, triangles, weights=weights, boundary=boundary)
    quotient = reference.rayleigh_quotient(matrix, mass, solution.uv @ [1, 1j])
    assert solution.eigenvalue == pytest.approx(quotient, rel=1e-7)


def test_fiedler_vector_is_that_of_dense_algebra():
    vertices, triangles = meshes.bumpy_disk(300)
    expected, z = reference.smallest_eigenpair(
        reference.conformal_energy_matrix(vertices, triangles), np.ones(len(vertices))
    )
    solution = sc.parameterize(vertices, triangles, method="fiedler")
    assert solution.eigenvalue == pytest.approx(expected, rel=1e-8)
    assert meshes.similarity_deviation(solution.uv, np.c_[z.real, z.imag]) < 1e-7


def test_area_method_minimises_energy_over_area():
    vertices, triangles = meshes.bumpy_disk(800, 3)
    matrix = reference.conformal_energy_matrix(vertices, triangles)
    real_part = matrix.real.astype(complex)
    area_form = (real_part - matrix).tocsr()
    solution = sc.parameterize(vertices, triangles, method="area")
    z = solution.uv @ [1, 1j]
    assert np.linalg.norm(matrix @ z - solution.eigenvalue * (area_form @ z)) < 1e-9 * np.linalg.norm(z)
    for other in ("spectral", "lscm"):
        w = sc.parameterize(vertices, triangles, method=other).uv @ [1, 1j]
        assert solution.eigenvalue <= np.vdot(w, matrix @ w).real / np.vdot(w, area_form @ w).real


@pytest.mark.parametrize("scale", [1e-15, 1e-6, 1, 1e6, 1e15])
@pytest.mark.parametrize("holes", [0, 7])
def test_flat_meshes_come_back(scale, holes):
    flat, triangles = meshes.random_disk(4000, holes)
    vertices = scale * (flat @ meshes.random_rotation(3).T)
    solution = sc.parameterize(vertices, triangles)
    assert sc.distortion(vertices, triangles, solution.uv).max_qc - 1 < 1e-9
    assert meshes.similarity_deviation(solution.uv, flat[:, :2]) < 1e-11
    assert np.ptp(solution.uv, axis=0).max() == pytest.approx(2 * scale, rel=0.01)


def test_flat_mesh_far_from_the_origin():
    flat, triangles = meshes.random_disk(1000)
    vertices = flat + [1e6, -2e6, 3e6]  # keeps ten digits of every coordinate
    solution = sc.parameterize(vertices, triangles)
    assert meshes.similarity_deviation(solution.uv, flat[:, :2]) < 1e-7


def test_map_is_placed():
    vertices, triangles = meshes.bumpy_disk(2000, 4)
    uv = sc.parameterize(vertices, triangles).uv
    z = uv @ [1, 1j]
    edges = z[triangles[:, 1:]] - z[triangles[:, :1]]
    assert (edges[:, 0].conj() * edges[:, 1]).imag.sum() / 2 == pytest.approx(
        reference.gradients(vertices, triangles)[2].sum()
    )
    assert np.abs(uv.mean(0)).max() < 1e-12
    # A disk with bumps is seen from above.
    assert np.corrcoef(uv[:, 1], vertices[:, 1])[0, 1] > np.sqrt(0.5)


def test_orientation_follows_the_majority():
    vertices, triangles = meshes.bumpy_disk(600)
    expected = sc.parameterize(vertices, triangles).uv
    some = triangles.copy()
    some[::7] = some[::7, ::-1]
    solution = sc.parameterize(vertices, some)
    assert np.allclose(solution.uv, expected, atol=1e-9)
    mirrored = sc.parameterize(vertices, triangles[:, ::-1])
    assert mirrored.turning_number == 1
    assert meshes.similarity_deviation(mirrored.uv * [1, -1], expected) < 1e-8


def test_solver_keeps_its_factor():
    vertices, triangles = meshes.bumpy_disk(1500)
    solver = sc.Solver(vertices, triangles, weights="inverse_area", boundary="vertex")
    expected = sc.parameterize(vertices, triangles, weights="inverse_area", boundary="vertex")
    for _ in range(2):
        assert np.array_equal(solver.solve().uv, expected.uv)
    assert np.isfinite(solver.solve(method="lscm").uv).all()


def test_backends_agree():
    if not sc.build_info()["factorization"].startswith("CHOLMOD"):
        pytest.fail("this build has no CHOLMOD: install libsuitesparse-dev and build again")
    vertices, triangles = meshes.bumpy_disk(4000, 3)
    first = sc.parameterize(vertices, triangles, factorization="cholmod")
    second = sc.parameterize(vertices, triangles, factorization="eigen")
    assert first.eigenvalue == pytest.approx(second.eigenvalue, rel=1e-9)
    assert np.abs(first.uv - second.uv).max() < 1e-8


def test_unused_vertices_are_left_at_the_origin():
    vertices, triangles = meshes.bumpy_disk(200)
    extended = np.r_[[[9.0, 9, 9]], vertices, [[np.nan, 0, 0]]]
    solution = sc.parameterize(extended, triangles + 1)
    assert np.array_equal(solution.uv[1:-1], sc.parameterize(vertices, triangles).uv)
    assert (solution.uv[[0, -1]] == 0).all()


def test_degenerate_triangles_do_not_spoil_the_rest():
    flat, triangles = meshes.random_disk(1000)
    # A zero-height triangle on a boundary edge, a point-like one beside it.
    a, b = reference.outer_loop(flat, triangles)[:2]
    vertices = np.r_[flat, [(flat[a] + flat[b]) / 2]]
    middle = len(flat)
    owner = next(i for i, t in enumerate(triangles.tolist()) if a in t and b in t)
    apex = next(v for v in triangles[owner] if v not in (a, b))
    split = np.r_[np.delete(triangles, owner, 0), [[a, b, apex], [b, a, middle]]]
    solution = sc.parameterize(vertices, split)
    assert np.isfinite(solution.uv).all()
    assert meshes.similarity_deviation(solution.uv[:middle], flat[:, :2]) < 1e-6


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


def test_repairs_are_said():
    vertices, triangles = meshes.bumpy_disk(300)
    mixed = triangles.copy()
    mixed[:3] = mixed[:3, ::-1]
    assert sc.parameterize(vertices, mixed).message == "3 faces wound the other way: reoriented."
