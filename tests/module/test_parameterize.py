import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import igl
import meshes
import numpy as np
import pytest
import reference
import spectral_conformal as sc

OPTIONS = [(w, b) for w in ("uniform", "inverse_area") for b in ("length", "vertex")]


@pytest.mark.parametrize(("weights", "boundary"), OPTIONS)
@pytest.mark.parametrize(("n", "holes"), [(100, 0), (400, 5), (3000, 0), (3000, 40), (10000, 12)])
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
    assert np.ptp(uv[:, 0]) >= np.ptp(uv[:, 1])


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


def test_lscm_holds_pins_exactly_and_minimises():
    vertices, triangles = meshes.bumpy_disk(3000, 5)
    pins = {5: (0.1, 0.7), 10: (100.3, 3.0), 700: (20.0, 44.4)}
    for weights in ("uniform", "inverse_area"):
        uv = sc.parameterize(vertices, triangles, method="lscm", weights=weights, pins=pins).uv
        assert all(tuple(uv[vertex]) == position for vertex, position in pins.items())
        gradient = reference.conformal_energy_matrix(vertices, triangles) @ (uv @ [1, 1j])
        if weights == "uniform":
            free = np.delete(gradient, list(pins))
            assert np.abs(free).max() < 1e-10 * np.ptp(uv, axis=0).max()


def test_lscm_agrees_with_libigl():
    vertices, triangles = meshes.bumpy_disk(2000, 3)
    pins = {3: (0.0, 0.0), 9: (1.0, 0.2)}
    expected, _ = igl.lscm(vertices, triangles, np.array(list(pins)), np.array(list(pins.values())))
    uv = sc.parameterize(vertices, triangles, method="lscm", pins=pins).uv
    assert np.abs(uv - expected).max() < 1e-8 * np.ptp(uv)


def test_lscm_without_pins_takes_far_apart_boundary_vertices():
    t = np.linspace(0, 1, 11)
    x, y = (a.ravel() for a in np.meshgrid(10 * t, t, indexing="ij"))
    vertices = np.c_[x, y, y * np.sin(x)]
    quads = meshes.grid_quads(11, 11)
    triangles = np.r_[quads[:, :3], quads[:, [0, 2, 3]]]
    solution = sc.parameterize(vertices, triangles, method="lscm")
    gradient = np.abs(reference.conformal_energy_matrix(vertices, triangles) @ (solution.uv @ [1, 1j]))
    pinned = np.flatnonzero(gradient > 1e-9)
    assert len(pinned) == 2
    assert np.ptp(x[pinned]) == 10


def test_one_pin_moves_the_free_map():
    vertices, triangles = meshes.bumpy_disk(300)
    free = sc.parameterize(vertices, triangles, method="lscm").uv
    moved = sc.parameterize(vertices, triangles, method="lscm", pins={7: (3.0, 4.0)}).uv
    assert tuple(moved[7]) == (3.0, 4.0)
    assert np.allclose(moved - moved[7], free - free[7], atol=1e-12)


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


def test_result_does_not_depend_on_the_thread_count():
    code = (
        "import hashlib, meshes, spectral_conformal as sc\n"
        "solution = sc.parameterize(*meshes.bumpy_disk(120000, 3))\n"
        "print(hashlib.sha256(solution.uv.tobytes()).hexdigest(), solution.eigenvalue)"
    )
    outputs = set()
    for threads in ("1", "2", "5"):
        path = os.pathsep.join([str(Path(meshes.__file__).parent), os.environ.get("PYTHONPATH", "")])
        limits = {"OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads, "PYTHONPATH": path}
        command = [sys.executable, "-c", code]
        outputs.add(subprocess.run(command, env={**os.environ, **limits}, capture_output=True, check=True).stdout)
    assert len(outputs) == 1


def test_blas_is_openblas():
    assert "openblas" in sc.build_info()["blas"].lower()


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


def test_timings_and_progress():
    vertices, triangles = meshes.bumpy_disk(500)
    calls = []
    solution = sc.parameterize(vertices, triangles, progress=lambda fraction, phase: calls.append((fraction, phase)))
    assert {"charts", "assembly", "factorization", "eigenproblem"} <= set(solution.timings)
    assert all(seconds >= 0 for seconds in solution.timings.values())
    fractions = [fraction for fraction, _ in calls]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1


@pytest.mark.parametrize("stop_at", range(5))
def test_cancelling(stop_at):
    vertices, triangles = meshes.bumpy_disk(500)
    calls = []

    def progress(fraction, phase):
        calls.append(phase)
        return np.bool_(len(calls) <= stop_at)

    with pytest.raises(sc.Cancelled):
        sc.parameterize(vertices, triangles, progress=progress)
    assert len(calls) == stop_at + 1


def test_exceptions_of_the_progress_function_pass_through():
    vertices, triangles = meshes.bumpy_disk(100)

    def progress(fraction, phase):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        sc.parameterize(vertices, triangles, progress=progress)


def test_the_solve_releases_the_interpreter_lock():
    vertices, triangles = meshes.bumpy_disk(30000)
    ticks = []
    worker = threading.Thread(target=lambda: sc.parameterize(vertices, triangles))
    worker.start()
    while worker.is_alive():
        ticks.append(time.perf_counter())
        time.sleep(0.001)
    # Holding the lock through factorisation or solve would leave a handful of ticks.
    assert len(ticks) > 20


def test_two_solves_at_once_equal_two_in_a_row():
    # Found out a serial OpenBLAS, whose buffers two threads overwrite for each other.
    cases = [meshes.bumpy_disk(5000, 2, seed=1), meshes.bumpy_disk(6000, 0, seed=2)]
    expected = [sc.parameterize(*case).uv for case in cases]
    results = [[], []]

    def solve(i):
        results[i] = [sc.parameterize(*cases[i]).uv for _ in range(10)]

    threads = [threading.Thread(target=solve, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for uvs, uv in zip(results, expected):
        assert len(uvs) == 10
        assert all(np.array_equal(other, uv) for other in uvs)


def test_a_shared_solver_takes_turns():
    vertices, triangles = meshes.bumpy_disk(4000)
    solver = sc.Solver(vertices, triangles)
    expected = solver.solve().uv
    results = []
    threads = [threading.Thread(target=lambda: results.extend(solver.solve().uv for _ in range(6))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 18
    assert all(np.array_equal(uv, expected) for uv in results)


def test_a_solver_is_not_called_by_its_own_progress_function():
    solver = sc.Solver(*meshes.bumpy_disk(500))
    with pytest.raises(RuntimeError, match="solving already"):
        solver.solve(progress=lambda fraction, phase: solver.solve())
    assert solver.solve().turning_number == 1


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


@pytest.mark.parametrize("unit", [1e-300, 1e-170, 1e12, 1e160])
def test_pins_of_any_magnitude(unit):
    vertices, triangles = meshes.bumpy_disk(400)
    expected = sc.parameterize(vertices, triangles, method="lscm", pins={0: (0, 0), 7: (1, 0.5)})
    scaled = sc.parameterize(vertices, triangles, method="lscm", pins={0: (0, 0), 7: (unit, 0.5 * unit)})
    assert tuple(scaled.uv[7]) == (unit, 0.5 * unit)
    assert np.allclose(scaled.uv / unit, expected.uv, atol=1e-9)
    assert scaled.turning_number == expected.turning_number == 1
    assert scaled.eigenvalue == pytest.approx(expected.eigenvalue)


def test_repairs_are_said():
    vertices, triangles = meshes.bumpy_disk(300)
    mixed = triangles.copy()
    mixed[:3] = mixed[:3, ::-1]
    assert sc.parameterize(vertices, mixed).message == "3 faces wound the other way: turned."


def square():
    return np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


TETRAHEDRON = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]


def moebius():
    n = 12
    angle = 2 * np.pi * np.arange(n) / n
    rows = [
        np.c_[np.cos(angle), np.sin(angle), 0 * angle]
        + t * np.c_[np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)]
        for t in (-0.3, 0.3)
    ]
    triangles = []
    for i in range(n):
        a, b = i, i + n
        c, d = (i + 1, i + 1 + n) if i + 1 < n else (n, 0)
        triangles += [[a, c, b], [b, c, d]]
    return np.concatenate(rows), np.array(triangles)


def punctured_torus():
    n, m = 10, 8
    u, v = (a.ravel() for a in np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij"))
    vertices = np.c_[(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)]
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    corner = [((i + di) % n * m + (j + dj) % m).ravel() for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = np.r_[np.c_[corner[0], corner[1], corner[2]], np.c_[corner[0], corner[2], corner[3]]]
    return vertices, triangles[1:]


@pytest.mark.parametrize(
    ("vertices", "triangles", "said"),
    [
        (square(), [], "no faces"),
        (square(), [[0, 1, 1]], "fewer than three different vertices"),
        (np.eye(4, 3), TETRAHEDRON, "closed"),
        (*moebius(), "non-orientable"),
        (*punctured_torus(), "handle"),
        (np.r_[square(), square() + 5], [[0, 1, 2], [4, 5, 6]], "2 components"),
        (np.r_[square(), [[0, 0, 1]]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]], "three or more faces: 1"),
        (np.r_[square(), [[2, 2, 0], [2, 1, 0]]], [[0, 1, 2], [2, 4, 5]], "components"),
        (square() * [1, 0, 0], [[0, 1, 2], [0, 2, 3]], "no area"),
        (square() * 0, [[0, 1, 2]], "no extent"),
        (np.full((4, 3), np.nan), [[0, 1, 2]], "not finite"),
        (np.full((4, 3), np.inf), [[0, 1, 2]], "not finite"),
    ],
)
def test_what_is_no_disk_is_refused(vertices, triangles, said):
    with pytest.raises(sc.InvalidMeshError, match=said):
        sc.parameterize(vertices, triangles)


def test_bow_tie_within_one_patch_is_refused():
    # A ring of six triangles around the square that touches itself in vertex 0.
    vertices = np.array([[0, 0, 0], [2, -1, 0], [3, 0, 0], [2, 1, 0], [1, -2, 0], [4, 0, 0], [1, 2, 0.0]])
    triangles = [[0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [3, 5, 6], [0, 3, 6]]
    with pytest.raises(sc.InvalidMeshError, match="bow ties"):
        sc.parameterize(vertices, triangles)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"vertices": np.zeros((4, 2))}, "vertices must have the shape"),
        ({"vertices": np.zeros((4, 3), complex)}, "real numbers"),
        ({"vertices": [["a"] * 3] * 4}, "real numbers"),
        ({"triangles": [[0, 1, 4]]}, "has the vertex 4"),
        ({"triangles": [[0, 1, -1]]}, "between 0"),
        ({"triangles": [[0, 1, 2**40]]}, "between 0"),
        ({"triangles": [[0.0, 1.0, 2.0]]}, "integers"),
        ({"triangles": [0, 1, 2]}, "shape"),
        ({"method": "magic"}, "method must be one of"),
        ({"method": None}, "method must be one of"),
        ({"tolerance": "a"}, "tolerance must lie"),
        ({"progress": 3}, "progress must be callable"),
        ({"vertices": [[0, 0, 0], [1, 0]]}, "vertices is no regular array"),
        ({"method": "lscm", "pins": [(0, (0, 0))]}, "pins must map"),
        ({"method": "lscm", "pins": {0.5: (0, 0), 1: (1, 0)}}, "pins must map"),
        ({"method": "lscm", "pins": {0: (0, 0, 0), 1: (1, 0)}}, "pins must map"),
        ({"weights": "magic"}, "weights must be one of"),
        ({"boundary": "magic"}, "boundary must be one of"),
        ({"factorization": "magic"}, "factorization must be one of"),
        ({"tolerance": 0}, "tolerance must lie"),
        ({"tolerance": np.nan}, "tolerance must lie"),
        ({"pins": {0: (0, 0), 1: (1, 0)}}, "pins need the method 'lscm'"),
        ({"method": "lscm", "pins": {0: (0, 0), 9: (1, 0)}}, "Vertex 9 is pinned"),
        ({"method": "lscm", "pins": {0: (0, 0), 1: (np.nan, 0)}}, "not finite"),
        ({"method": "lscm", "pins": {0: (1, 1), 1: (1, 1)}}, "same position"),
    ],
)
def test_bad_arguments_are_named(arguments, said):
    arguments = {"vertices": square(), "triangles": [[0, 1, 2], [0, 2, 3]], **arguments}
    with pytest.raises(ValueError, match=said):
        sc.parameterize(**arguments)


def test_a_map_that_cannot_be_right_is_a_failure():
    # Crumpled beyond recognition: whatever comes back is either right or an error, never a success with a boundary
    # that winds several times.
    rng = np.random.default_rng(4)
    failures = 0
    for seed in range(30):
        vertices, triangles = meshes.random_disk(60, seed=seed)
        vertices = vertices + rng.normal(size=vertices.shape) * 1.5
        try:
            solution = sc.parameterize(vertices, triangles)
        except sc.SolveError as failure:
            failures += 1
            assert "winds round" in str(failure)
        else:
            assert solution.turning_number == 1
            assert sc.distortion(vertices, triangles, solution.uv).turning_number == 1
    assert failures > 0
