"""On a long strip every smooth function along it is nearly conformal: eigenvalues are closer than the factor resolves.

Strips that unroll without distortion have an exact map to compare with.
"""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

LENGTH = 10000  # times the width of a square, of which there are two across


def strip(n):
    """Return a flat strip of n by 2 squares as triangles."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(3.0), indexing="ij")
    quads = meshes.grid_quads(n + 1, 3)
    return np.c_[x.ravel(), y.ravel(), 0 * x.ravel()], meshes.triangles_of(quads)


def bent(flat):
    """Return a strip rolled up along a circular arc: its map is still the flat one."""
    radius = np.ptp(flat[:, 0]) / 5
    angle = flat[:, 0] / radius
    return np.c_[radius * np.sin(angle), flat[:, 1], radius * np.cos(angle)]


def unevenly_sampled(flat):
    """Return a flat strip whose inner vertices have been moved within their plane."""
    moved = flat.copy()
    inner = (flat[:, 1] == 1) & (flat[:, 0] > 0) & (flat[:, 0] < flat[:, 0].max())
    moved[inner, :2] += np.random.default_rng(1).uniform(-0.3, 0.3, (np.count_nonzero(inner), 2))
    return moved


def check_exact(solution, flat):
    assert solution.attempts == 1
    assert solution.fallback is None
    assert solution.message == ""
    # A hundredth of what single precision, in which UVs are stored, resolves.
    assert meshes.similarity_deviation(solution.uv, flat[:, :2]) < 1e-9


@pytest.mark.parametrize(
    "options", [{}, {"boundary": "vertex"}, {"weights": "inverse_area"}, {"method": "fiedler"}, {"method": "area"}]
)
def test_a_strip_comes_out_as_it_is_at_the_first_attempt(options):
    flat, triangles = strip(LENGTH)
    check_exact(sc.parameterize(flat, triangles, **options), flat)


@pytest.mark.parametrize("n", [LENGTH // 2, LENGTH, 2 * LENGTH])
def test_solves_do_not_grow_with_length(n):
    """They were 48, 83 and 158 at these lengths."""
    flat, triangles = strip(n)
    assert sc.parameterize(flat, triangles).iterations <= 16


def test_nor_on_a_zigzag_of_one_polygon():
    """That took 760."""
    x = np.arange(30_000.0)
    low = np.c_[x, x % 2, 0 * x]
    vertices = np.concatenate([low, low[::-1] + [0, 1.5, 0]])
    (chart,) = sc.unwrap(vertices, *meshes.polygons([list(range(len(vertices)))])).charts
    assert chart.attempts == 1
    assert chart.iterations <= 20
    assert chart.mean_qc == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("shape", [bent, unevenly_sampled])
def test_so_does_one_that_is_rolled_up_or_unevenly_sampled(shape):
    flat, triangles = strip(LENGTH)
    points = shape(flat)
    check_exact(sc.parameterize(points, triangles), points if shape is unevenly_sampled else flat)


@pytest.mark.parametrize("strength", [1.0, -0.2])
def test_extenders_on_a_strip_find_the_map_without_distortion(strength):
    flat, triangles = strip(LENGTH)
    # Of energy 0, it has the smallest quotient as long as the form is positive for it.
    check_exact(sc.parameterize(flat, triangles, extenders=[(0, 3 * LENGTH // 2, strength)]), flat)


@pytest.mark.parametrize("n", [LENGTH, 5 * LENGTH])
def test_held_at_two_vertices_a_strip_comes_out_as_it_is(n):
    """Its smallest eigenvalues are near the rounding of the factor, or below."""
    flat, triangles = strip(n)
    check_exact(sc.parameterize(flat, triangles, method="lscm"), flat)
    # Pinned by the user, at another size.
    ends = {0: (0, 0), 3 * n: (1, 0)}
    check_exact(sc.parameterize(flat, triangles, method="lscm", pins=ends), flat)


def test_held_at_its_corners_a_strip_has_a_straight_side():
    flat, triangles = strip(LENGTH)
    corners = [0, 2, 3 * LENGTH, 3 * LENGTH + 2]
    side = np.arange(0, 3 * LENGTH + 1, 3)
    pins = {v: tuple(flat[v, :2]) for v in corners}
    bumpy = flat + np.c_[0 * flat[:, :2], 0.1 * np.sin(0.05 * flat[:, 0])]
    for positions in (flat, bumpy):
        found = sc.parameterize(positions, triangles, pins=pins, constraints=sc.Constraints(horizontal=[side]))
        assert found.message == ""
        assert np.abs(found.uv[side, 1]).max() == 0
        if positions is flat:
            assert np.abs(found.uv - flat[:, :2]).max() < 1e-9 * LENGTH


@pytest.mark.slow
def test_a_strip_of_twice_the_length_and_one_of_polygons_do_too():
    flat, triangles = strip(2 * LENGTH)
    check_exact(sc.parameterize(flat, triangles), flat)
    (chart,) = sc.unwrap(flat, *meshes.polygons(triangles)).charts
    assert chart.attempts == 1
    assert chart.max_qc == pytest.approx(1, abs=1e-9)
