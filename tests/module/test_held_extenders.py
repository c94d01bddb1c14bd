# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders of maps that pins, held coordinates and constraints hold, against dense algebra on their formula."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference

PUSH, OTHER, PULL = (30, 45, 0.8), (30, 52, 0.4), (12, 60, -1.5)


@pytest.fixture(scope="module")
def disk():
    vertices, triangles = meshes.bumpy_disk(100, 3)
    return vertices, triangles, sc.parameterize(vertices, triangles).uv * [1.2, 0.9]


def problem(kind, vertices, triangles, uv):
    """The options that hold the map x = P w + c, and its L, P and c on the coordinates of every vertex in turn."""
    n = len(vertices)
    matrix = reference.conformal_energy_matrix(vertices, triangles).toarray()
    energy = np.empty((2 * n, 2 * n))
    energy[::2, ::2] = energy[1::2, 1::2] = matrix.real
    energy[1::2, ::2], energy[::2, 1::2] = matrix.imag, -matrix.imag
    chain = [30, 31, 50] if kind == "chain" else []
    if kind == "coordinates":
        rows = np.arange(0, 2 * n, 7)
        options = {"constraints": sc.Constraints(held=np.c_[rows, uv.ravel()[rows]])}
    else:
        rows = np.ravel([[2 * v, 2 * v + 1] for v in (3, 20, 71, 90)])
        options = {"pins": {v: uv[v] for v in (3, 20, 71, 90)}}
    if chain:
        options["constraints"] = sc.Constraints(vertical=[chain])
    p, c = np.eye(2 * n), np.zeros(2 * n)
    p[[2 * v for v in chain], 2 * (chain or [0])[0]] = 1.0
    c[rows] = uv.ravel()[rows]
    return options, energy, np.delete(p, [*rows, *(2 * v for v in chain[1:])], axis=1), c


def stationary(energy, p, c, pulls=(), pushes=()):
    """The map of the documented formula: pulls in the matrix, then the force of each push."""
    matrix, right = p.T @ energy @ p, -p.T @ energy @ c

    def difference(i, j):
        d = np.zeros((2, len(energy)))
        d[[0, 1], [2 * i, 2 * i + 1]], d[[0, 1], [2 * j, 2 * j + 1]] = 1.0, -1.0
        compliance = d @ p @ np.linalg.solve(p.T @ energy @ p, (d @ p).T)
        return d @ p, d @ c, np.linalg.eigvalsh(compliance)[-1]

    for i, j, t in pulls:
        rows, offset, own = difference(i, j)
        matrix, right = matrix - t / own * rows.T @ rows, right + t / own * rows.T @ offset
    w = np.linalg.solve(matrix, right)
    forces = [strength / own * rows.T @ (rows @ w + offset) for i, j, strength in pushes
              for rows, offset, own in [difference(i, j)]]  # fmt: skip
    return (p @ np.linalg.solve(matrix, right + sum(forces, np.zeros_like(w))) + c).reshape(-1, 2)


@pytest.mark.parametrize("kind", ["pins", "chain", "coordinates"])
def test_it_is_the_stationary_map_of_the_dense_problem(disk, kind):
    vertices, triangles, uv = disk
    options, *dense = problem(kind, vertices, triangles, uv)
    solver = sc.Solver(vertices, triangles)
    plain = solver.solve(**options).uv
    i, j, strength = PUSH
    pushed = solver.solve(extenders=[PUSH], **options)
    assert np.abs(pushed.uv - stationary(*dense, pushes=[PUSH])).max() < 1e-10
    halved = solver.solve(extenders=[(i, j, 0.25 * strength, 0.25)], **options)
    assert np.array_equal(halved.uv, pushed.uv)
    if kind == "pins":
        # Also as a reduced stiffness.
        reduced = stationary(*dense, pulls=[(i, j, strength / (1.0 + strength))])
        assert np.abs(pushed.uv - reduced).max() < 1e-10
        assert pushed.uv[i] - pushed.uv[j] == pytest.approx((1.0 + strength) * (plain[i] - plain[j]), rel=1e-10)
        pulled = solver.solve(extenders=[PULL], **options).uv
        assert pulled[12] - pulled[60] == pytest.approx((plain[12] - plain[60]) / 2.5, rel=1e-10)
    together = solver.solve(extenders=[PUSH, PULL, OTHER], **options)
    assert np.abs(together.uv - stationary(*dense, [PULL], [PUSH, OTHER])).max() < 1e-10
    assert (together.method, together.polish_steps) == ("lscm", 0)
    # What is held stays to the bit, the factor serves all, and no strength undoes it.
    work = sc._native.counted_work(lambda: solver.solve(extenders=[(i, j, 2.0)], **options))
    assert (work["analyses"], work["factorizations"]) == (0, 0)
    assert np.array_equal(solver.solve(extenders=[(i, j, 0.0)], **options).uv, plain)
    for v, pin in options.get("pins", {}).items():
        assert (together.uv[v] == pin).all()
    if kind == "chain":
        assert np.ptp(together.uv[[30, 31, 50], 0]) <= 1e-12 * np.ptp(together.uv)


def test_a_unwrapper_follows_with_the_rest_held(disk):
    vertices, triangles, uv = disk
    pins = {v: uv[v] for v in (3, 20, 71, 90)}
    polygons = meshes.polygons(triangles)
    unwrapper = sc.Unwrapper(vertices, *polygons, pins=pins)
    for extenders in ([PUSH], [PULL, OTHER]):
        mapped = unwrapper.solve(extenders=extenders)
        assert not mapped.unused_extenders.any()
        expected = sc.parameterize(vertices, triangles, pins=pins, extenders=extenders).uv
        assert np.abs(mapped.uv - expected[polygons[1]]).max() < 1e-12
