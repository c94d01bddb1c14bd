"""Patches without a conformal map to the plane, and wrong maps: errors, never results."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import hard_meshes, meshes


def square():
    return np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


TETRAHEDRON = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]


# A ring of six triangles around the square that touches itself in vertex 0.
BOW_TIE = np.array([[0, 0, 0], [2, -1, 0], [3, 0, 0], [2, 1, 0], [1, -2, 0], [4, 0, 0], [1, 2, 0.0]])


@pytest.mark.parametrize(
    ("vertices", "triangles", "said"),
    [
        (square(), [], "no faces"),
        (square(), [[0, 1, 1]], "fewer than three different vertices"),
        (np.eye(4, 3), TETRAHEDRON, "closed"),
        (*hard_meshes.moebius(), "non-orientable"),
        (*hard_meshes.CASES["torus with one face less"].make(), "handle"),
        (np.r_[square(), square() + 5], [[0, 1, 2], [4, 5, 6]], "2 separate components"),
        (np.r_[square(), [[0, 0, 1]]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]], "three or more faces: 1"),
        (np.r_[square(), [[2, 2, 0], [2, 1, 0]]], [[0, 1, 2], [2, 4, 5]], "components"),
        (square() * [1, 0, 0], [[0, 1, 2], [0, 2, 3]], "no area"),
        (square() * 0, [[0, 1, 2]], "no extent"),
        (np.full((4, 3), np.nan), [[0, 1, 2]], "not finite"),
        (np.full((4, 3), np.inf), [[0, 1, 2]], "not finite"),
        (BOW_TIE, [[0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [3, 5, 6], [0, 3, 6]], "bow ties"),
    ],
)
def test_what_is_no_disk_is_refused(vertices, triangles, said):
    with pytest.raises(sc.InvalidMeshError, match=said):
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
