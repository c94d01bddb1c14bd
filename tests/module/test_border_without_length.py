# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands whose whole border lies at one point, such as a sphere that was never welded at a pole.

By length the boundary has no form there; by vertex it has one, and there are maps.
"""

import itertools

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

WEIGHTS = ("uniform", "inverse_area")


def open_pole(n, m, radius=0.0):
    """Return a sphere of m rings of n vertices, the first of this radius and open, the last one closed by a vertex."""
    polar = np.pi * np.arange(m) / m
    polar[0] = radius
    azimuth = 2 * np.pi * np.arange(n) / n
    rings = [np.c_[np.sin(p) * np.cos(azimuth), np.sin(p) * np.sin(azimuth), np.cos(p) + 0 * azimuth] for p in polar]
    vertices = np.vstack([*rings, [[0.0, 0.0, -1.0]]])
    faces = []
    for j, i in itertools.product(range(m - 1), range(n)):
        a, b, c, d = j * n + i, j * n + (i + 1) % n, (j + 1) * n + (i + 1) % n, (j + 1) * n + i
        faces += [[a, d, c], [a, c, b]]
    faces += [[(m - 1) * n + i, m * n, (m - 1) * n + (i + 1) % n] for i in range(n)]
    return vertices, np.array(faces)


def outcome(function, *arguments, **options):
    """Return the map, which must be finite, or the error, which must say something."""
    try:
        result = function(*arguments, **options)
    except (sc.InvalidMeshError, sc.SolveError) as error:
        assert str(error)
        return error
    assert np.isfinite(result.uv).all()
    return result


def pins_of(mesh, size, count=8):
    rng = np.random.default_rng(0)
    chosen = rng.choice(len(mesh[0]), min(count, len(mesh[0]) - 1), replace=False)
    return {int(v): tuple(rng.normal(size=2) * size) for v in chosen}


@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize(("pull", "size"), [(1.0, 1.0), (1.0, 100.0), (1e4, 100.0)])
def test_no_fallback_is_by_length(pull, size, weights):
    mesh = open_pole(12, 8)
    options = {"boundary": "vertex", "weights": weights, "soft_pins": pull, "pins": pins_of(mesh, size)}
    result = outcome(sc.parameterize, *mesh, **options)
    assert isinstance(result, sc.SolveError) or result.boundary == "vertex"
    (chart,) = sc.unwrap(mesh[0], *meshes.polygons(mesh[1]), **options).charts
    assert chart.boundary == "vertex"


def test_by_length_it_is_refused():
    with pytest.raises(sc.InvalidMeshError, match="has no length"):
        sc.parameterize(*open_pole(12, 8))


@pytest.mark.parametrize(("n", "m"), [(3, 2), (4, 3), (12, 8)])
@pytest.mark.parametrize("method", ["spectral", "fiedler", "area", "lscm"])
@pytest.mark.parametrize("weights", WEIGHTS)
def test_without_folds_there_is_a_map(weights, method, n, m):
    mesh = open_pole(n, m)
    result = outcome(sc.parameterize, *mesh, boundary="vertex", weights=weights, method=method, fold_free=True)
    if not isinstance(result, sc.SolveError):
        assert sc.distortion(*mesh, result.uv).turning_number == 1


@pytest.mark.parametrize("radius", [1e-300, 1e-200, 1e-160, 1e-100, 1e-17, 1e-12, 1e-8, 1e-4])
@pytest.mark.parametrize("boundary", ["vertex", "length"])
@pytest.mark.parametrize("options", [{}, {"fold_free": True}, {"method": "lscm", "fold_free": True}], ids=str)
def test_a_border_of_nearly_no_length(options, boundary, radius):
    for n, m in ((3, 2), (12, 8)):
        outcome(sc.parameterize, *open_pole(n, m, radius), boundary=boundary, **options)
