# SPDX-License-Identifier: GPL-3.0-or-later
"""Any number of fixed vertices: they keep every bit, and the rest follows."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


def similar(uv):
    return uv @ [[1.6, 1.2], [-1.2, 1.6]] + [300.0, -7.0]


@pytest.fixture(scope="module")
def bumpy():
    vertices, triangles = meshes.bumpy_disk(900, 3)
    return vertices, triangles, meshes.border_of(triangles, len(vertices))


def test_a_border_that_is_a_similarity_gives_the_similarity_back(bumpy):
    vertices, triangles, border = bumpy
    free = sc.parameterize(vertices, triangles)
    target = similar(free.uv)
    held = sc.parameterize(vertices, triangles, fixed=border, uv=target)
    # Inside, the eigenvector has L z = 0, as the held map.
    assert np.abs(held.uv - target).max() < 1e-9 * np.ptp(target)
    assert (held.uv[border] == target[border]).all()
    assert (held.method, held.steps) == ("lscm", ())
    # On a flat patch any three vertices suffice.
    flat = vertices * [1.0, 1.0, 0.0]
    for fixed in ([0, 5, 800], np.array([5, 800, 0], np.int16), np.arange(len(flat)) % 7 == 0):
        mapped = sc.parameterize(flat, triangles, fixed=fixed, uv=similar(flat[:, :2]), polish=True)
        assert np.abs(mapped.uv - similar(flat[:, :2])).max() < 1e-9 * np.ptp(target)


@pytest.mark.parametrize("options", [{}, {"polish": True}, {"fold_free": True}, {"polish": True, "fold_free": True}])
def test_fixed_vertices_keep_every_bit_and_any_call_gives_the_same_map(bumpy, options):
    vertices, triangles, border = bumpy
    uv = similar(sc.parameterize(vertices, triangles).uv) * [1.3, 1.0]
    uv[~border] = np.nan
    fixed = border & (uv[:, 0] < np.median(uv[border, 0]))
    held = sc.parameterize(vertices, triangles, fixed=fixed, uv=uv, **options)
    assert 3 < fixed.sum() < border.sum()
    assert (held.uv[fixed] == uv[fixed]).all()
    assert np.isfinite(held.uv).all()
    assert (held.polish_steps > 0) == ("polish" in options)
    pins = dict(zip(np.flatnonzero(fixed).tolist(), uv[fixed].tolist()))
    assert (sc.parameterize(vertices, triangles, pins=pins, **options).uv == held.uv).all()
    solver = sc.Solver(vertices, triangles)
    solver.solve(fixed=border, uv=np.where(border[:, None], uv, 0.0))
    for _ in range(2):
        assert (solver.solve(fixed=fixed, uv=uv, **options).uv == held.uv).all()
    whole = sc.unwrap(sc.Mesh(vertices, triangles, uv[triangles]), fixed=fixed[triangles], **options)
    assert (whole.uv == held.uv[triangles.ravel()]).all()
    assert whole.charts[0].n_pins == fixed.sum()


@pytest.mark.parametrize("options", [{}, {"polish": True}, {"fold_free": True}])
def test_moved_pins_give_the_map_that_they_give_afresh(bumpy, options):
    vertices, triangles, border = bumpy
    corners = triangles.ravel()
    offsets = np.arange(0, len(corners) + 1, 3)
    of_vertices = sc.parameterize(vertices, triangles).uv
    free, turned = of_vertices[corners], similar(of_vertices)[corners]
    pinned = border[corners]
    unwrapper = sc.Unwrapper(sc.Mesh(vertices, offsets, free, corner_vertices=corners), fixed=pinned, **options)
    first = unwrapper.solve().uv
    for moved in (turned, free * [1.2, 0.9], np.where(free[:, :1] > 0, free * [1.5, 1.0], free)):
        again = unwrapper.solve(uv=moved)
        fresh = sc.unwrap(sc.Mesh(vertices, offsets, moved, corner_vertices=corners), fixed=pinned, **options)
        assert (again.uv == fresh.uv).all()
        assert (again.uv[pinned] == moved[pinned]).all()
    not_finite = np.where(np.arange(len(free))[:, None] == np.flatnonzero(pinned)[0], np.nan, free)
    assert not unwrapper.solve(uv=not_finite).solved_corners.any()
    assert (unwrapper.solve().uv == first).all()
    with pytest.raises(ValueError, match="one row per corner"):
        unwrapper.solve(uv=free[:-1])
    with pytest.raises(ValueError, match="uv moves fixed corners"):
        sc.Unwrapper(vertices, offsets, corners).solve(uv=free)


def test_what_is_no_set_of_fixed_vertices_is_named(bumpy):
    vertices, triangles, border = bumpy
    uv = vertices[:, :2]
    for wrong, error, words in (
        ({"fixed": border}, ValueError, "fixed needs uv"),
        ({"fixed": border[:-1], "uv": uv}, ValueError, "booleans, one per vertex"),
        ({"fixed": [0.5], "uv": uv}, TypeError, "integers"),
        ({"fixed": [len(uv)], "uv": uv}, ValueError, "vertices"),
        ({"fixed": border, "uv": uv[:-1]}, ValueError, "rows"),
        ({"fixed": border, "uv": uv * np.nan}, ValueError, "not finite"),
    ):
        with pytest.raises(error, match=words):
            sc.parameterize(vertices, triangles, **wrong)
    mapped = sc.Mesh(vertices, triangles, uv[triangles])
    for mesh, wrong, error, words in (
        (sc.Mesh(vertices, triangles), border[triangles], ValueError, "fixed needs a mesh with uv"),
        # Vertices do not pass for corners.
        (mapped, border, ValueError, "booleans, one per corner"),
        (mapped, np.flatnonzero(border), TypeError, "booleans, one per corner"),
    ):
        with pytest.raises(error, match=words):
            sc.unwrap(mesh, fixed=wrong)
    # A vertex of no triangle has no effect.
    stray = np.r_[vertices, [[0.0, 0.0, 9.0]]]
    mapped = sc.parameterize(stray, triangles, fixed=[len(uv)], uv=np.zeros((len(stray), 2)))
    assert mapped.method == "spectral"


def test_a_fold_by_the_rounding_of_held_coordinates_is_said():
    # Four needles, a billion times as long as wide; two held corners shrink them to the distance of these.
    vertices = [[0.062, 0.124, 0.124], [6.05e7, 3.50e7, -0.259], [-1.35e8, -3.83e8, 0.24], [0.247, -0.279, 0.193]]
    mesh = sc.Mesh([*vertices, [-0.046, 0.258, -0.055]], [[3, 4, 2], [1, 4, 3], [0, 1, 3], [1, 0, 4]])
    fixed, uv = np.zeros(12, bool), np.zeros((12, 2))
    fixed[1:3], uv[1:3] = True, ((0.054, 0.408), (-0.742, -0.644))
    flipped = []
    for shift in np.linspace(0.0, 1.0, 50):
        (chart,) = sc.unwrap(mesh.with_uv(uv + shift), fixed=fixed, fold_free=True).charts
        assert chart.flipped == sum(step.count for step in chart.steps if step.kind == "still_flipped")
        flipped.append(chart.flipped)
    assert any(flipped)
