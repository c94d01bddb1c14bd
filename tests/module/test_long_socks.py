# SPDX-License-Identifier: GPL-3.0-or-later
"""Fold-free maps of limbs so long that a disk holds their ends only below double precision."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import degenerate, meshes

SHAPES = {  # sides, rings, length in widths
    "rings as high as wide": (6, 300, 300),
    "long rings": (6, 100, 300),
    "fine": (8, 500, 300),
    "three sides": (3, 1000, 1000),
    "short": (8, 30, 30),
}


def sock(sides, rings, length, twist=0.0):
    """Return the points and quads of a tube, open at one end, and the triangles that close it at the other.

    twist: by which each ring is turned against the last, in sides.
    """
    angle = 2 * np.pi * np.arange(sides) / sides
    points = [
        np.c_[np.cos(angle + t) / 2, np.sin(angle + t) / 2, np.full(sides, length * r / rings)]
        for r in range(rings)
        for t in [2 * np.pi * twist * r / sides]
    ]
    ring, k = np.arange(rings - 1)[:, None] * sides, np.arange(sides)
    after = (k + 1) % sides
    quads = np.stack([ring + k, ring + after, ring + after + sides, ring + k + sides], axis=-1).reshape(-1, 4)
    last = (rings - 1) * sides
    cap = np.c_[last + k, last + after, np.full(sides, last + sides)]
    return np.vstack([*points, [[0.0, 0.0, length]]]), quads, cap


def check(vertices, triangles, solution):
    measured = sc.distortion(vertices, triangles, solution.uv)
    assert not measured.flipped.any()
    assert measured.turning_number == 1
    assert not measured.overlapping.any()
    assert np.isfinite(measured.mean_qc)
    assert "could not be unfolded" not in solution.message


@pytest.mark.parametrize("twist", [0.0, 0.5])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("method", ["spectral", "lscm"])
def test_a_sock_of_any_length_is_unfolded(method, shape, twist):
    vertices, quads, cap = sock(*SHAPES[shape], twist)
    triangles = np.r_[meshes.triangles_of(quads), cap]
    check(vertices, triangles, sc.parameterize(vertices, triangles, method=method, fold_free=True))


@pytest.mark.parametrize("shape", SHAPES)
def test_of_quads_too(shape):
    vertices, quads, cap = sock(*SHAPES[shape])
    result = sc.unwrap(vertices, *meshes.polygons([*quads.tolist(), *cap.tolist()]), fold_free=True)
    (chart,) = result.charts
    assert (chart.status, chart.flipped, abs(chart.turning_number)) == ("solved", 0, 1)
    assert "could not be unfolded" not in chart.message


def test_a_pinned_energy_that_is_not_resolved_leaves_the_embedding():
    """A strip two million times as long as wide, held at two vertices."""
    rows = np.arange(4001)
    vertices = np.c_[np.repeat(rows, 3), np.tile([0, 1e-3, 2e-3], len(rows)), np.zeros(3 * len(rows))]
    mesh = vertices, meshes.triangles_of(meshes.grid_quads(len(rows), 3))
    with pytest.raises(sc.SolveError, match="does not satisfy its equations"):
        sc.parameterize(*mesh, method="lscm")
    solution = sc.parameterize(*mesh, method="lscm", fold_free=True)
    assert solution.fallback == "tutte_embedding" and abs(solution.turning_number) == 1
    assert np.isfinite(solution.uv).all()


def test_pinned_energies_with_degenerate_triangles_become_embeddings():
    for seed in range(6):
        for ratio in (1e-17, 1e-30):
            mesh = degenerate.nested(*meshes.bumpy_disk(400, seed), ratio, seed=seed)
            solution = sc.parameterize(*mesh, method="lscm", weights="inverse_area", fold_free=True)
            assert np.isfinite(solution.uv).all()
            assert abs(solution.turning_number) == 1
