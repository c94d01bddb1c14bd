"""Patches without a conformal map to the plane, and wrong maps: errors, never results."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


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
        (np.r_[square(), square() + 5], [[0, 1, 2], [4, 5, 6]], "2 separate components"),
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


def test_a_map_that_cannot_be_right_is_never_a_success():
    # Crumpled beyond recognition: whatever comes back is either right or an error, never a success with a boundary that
    # winds several times.
    rng = np.random.default_rng(4)
    failures = 0
    for seed in range(30):
        vertices, triangles = meshes.random_disk(60, seed=seed)
        vertices = vertices + rng.normal(size=vertices.shape) * 1.5
        try:
            solution = sc.parameterize(vertices, triangles)
        except sc.SolveError as failure:
            failures += 1
            assert "winds around" in str(failure)
        else:
            assert solution.turning_number == 1
            assert sc.distortion(vertices, triangles, solution.uv).turning_number == 1
    assert failures
