"""Pins: held by pinned LSCM, one that only moves the map, soft ones; of vertices and of corners."""

import igl
import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


def test_lscm_agrees_with_libigl():
    vertices, triangles = meshes.bumpy_disk(2000, 3)
    pins = {3: (0.0, 0.0), 9: (1.0, 0.2)}
    expected, _ = igl.lscm(vertices, triangles, np.array(list(pins)), np.array(list(pins.values())))
    uv = sc.parameterize(vertices, triangles, method="lscm", pins=pins).uv
    assert np.abs(uv - expected).max() < 1e-8 * np.ptp(uv)


@pytest.mark.parametrize("method", ["spectral", "lscm", "fiedler", "area"])
def test_one_pin_moves_the_free_map(method):
    vertices, triangles = meshes.bumpy_disk(300)
    free = sc.parameterize(vertices, triangles, method=method)
    moved = sc.parameterize(vertices, triangles, method=method, pins={7: (3.0, 4.0)})
    assert moved.method == method
    assert tuple(moved.uv[7]) == pytest.approx((3.0, 4.0), abs=1e-14)
    assert np.allclose(moved.uv - moved.uv[7], free.uv - free.uv[7], atol=1e-12)
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles), method=method, pins={7: (3.0, 4.0)}).charts
    assert (chart.status, chart.method, chart.n_pins) == ("solved", method, 1)


def fixed_corners(vertices, triangles, pins):
    """A mesh, and the argument of `unwrap` that pins the same vertices by all of their corners."""
    uv = np.zeros((len(vertices), 2))
    for vertex, position in pins.items():
        uv[vertex] = position
    return sc.Mesh(vertices, triangles, uv[triangles]), {"fixed": np.isin(triangles, list(pins))}


def test_two_hard_pins_turn_and_scale_the_map_and_bend_nothing():
    vertices, triangles = meshes.bumpy_disk(300)
    pins = {5: (0.1, 0.7), 250: (2.0, 1.0)}
    mesh, corner_pins = fixed_corners(vertices, triangles, pins)
    for options in ({}, {"method": "fiedler"}, {"polish": True}, {"fold_free": True}, {"hole_rigidity": 1.0}):
        free = sc.parameterize(vertices, triangles, **options)
        held = sc.parameterize(vertices, triangles, pins=pins, **options)
        assert (held.method, held.eigenvalue_of, held.polish_steps) == (
            free.method,
            free.eigenvalue_of,
            free.polish_steps,
        )
        assert meshes.similarity_deviation(held.uv, free.uv) < 1e-12
        for vertex, position in pins.items():
            assert tuple(held.uv[vertex]) == position
        for result in (sc.unwrap(mesh, pins=pins, **options), sc.unwrap(mesh, **corner_pins, **options)):
            (chart,) = result.charts
            assert (chart.status, chart.method, chart.n_pins) == ("solved", held.method, 2)
            assert np.abs(result.uv - held.uv[triangles.ravel()]).max() < 1e-12
    pushed = sc.parameterize(vertices, triangles, pins=pins, extenders=[(3, 90, 1.0)])
    assert (
        meshes.similarity_deviation(pushed.uv, sc.parameterize(vertices, triangles, extenders=[(3, 90, 1.0)]).uv)
        < 1e-12
    )


def test_three_hard_pins_are_held_by_lscm_whoever_asks():
    # `pins` raised with "spectral", where `fixed` corners were held.
    vertices, triangles = meshes.bumpy_disk(300)
    pins = {5: (0.1, 0.7), 250: (2.0, 1.0), 120: (1.0, 2.0)}
    expected = sc.parameterize(vertices, triangles, method="lscm", pins=pins)
    mesh, corner_pins = fixed_corners(vertices, triangles, pins)
    for solution in (
        sc.parameterize(vertices, triangles, pins=pins),
        sc.Solver(vertices, triangles).solve(pins=pins),
    ):
        assert (solution.method, solution.eigenvalue_of) == ("lscm", "map")
        assert np.array_equal(solution.uv, expected.uv)
    for result in (
        sc.unwrap(mesh, pins=pins),
        sc.unwrap(mesh, **corner_pins),
        sc.Unwrapper(mesh, pins=pins).solve(),
    ):
        (chart,) = result.charts
        assert (chart.status, chart.method, chart.eigenvalue_of) == ("solved", "lscm", "map")
        assert np.abs(result.uv - expected.uv[triangles.ravel()]).max() < 1e-12


def test_between_hard_pins_an_extender_has_no_effect():
    vertices, triangles = meshes.bumpy_disk(300, 2)
    pins = {5: (0.1, 0.7), 250: (2.0, 1.0), 120: (1.0, 2.0)}
    result = sc.unwrap(vertices, *meshes.polygons(triangles), pins=pins, extenders=[(3, 5, 1.0), (5, 250, 1.0)])
    assert (result.charts[0].method, result.unused_extenders.tolist()) == ("lscm", [False, True])
    held = sc.parameterize(vertices, triangles, pins=pins)
    assert np.array_equal(sc.parameterize(vertices, triangles, pins=pins, extenders=[(5, 250, 1.0)]).uv, held.uv)


def test_pins_hold_all_copies():
    vertices, quads = meshes.saddle_quads(7)
    offsets, corners = meshes.polygons(quads)
    seam = np.c_[21 + np.arange(6), 22 + np.arange(6)]  # cuts the grid in two
    pins = {21: (0.0, 0.0), 27: (1.0, 0.5)}
    result = sc.unwrap(vertices, offsets, corners, seam_edges=seam, method="lscm", pins=pins)
    assert len(result.charts) == 2
    for vertex, position in pins.items():
        assert (result.uv[corners == vertex] == position).all()


def solved_with_pins(pins, **options):
    """The charts and uv of a grid of 9 x 9 vertices, cut in two along vertices 36 to 44, with {corner: uv} pinned."""
    vertices, quads = meshes.saddle_quads(9)
    corners = quads.ravel()
    uv = vertices[corners, :2].copy()
    uv[list(pins)] = list(pins.values())
    seam = np.c_[np.arange(36, 44), np.arange(37, 45)]
    fixed = np.isin(np.arange(len(corners)), list(pins))
    result = sc.unwrap(sc.Mesh(vertices, quads, uv), seam_edges=seam, fixed=fixed, **options)
    return result.charts, result.uv


def test_stronger_soft_pins_come_nearer():
    pins = {0: (-1.3, -1.0), 31: (-1.0, 1.2), 100: (-0.2, -0.6), 127: (0.1, 0.9)}
    distances = []
    for strength in (0.1, 10.0, 100.0, 1000.0, 1e4):
        charts, uv = solved_with_pins(pins, soft_pins=strength)
        assert [(chart.status, chart.method, chart.n_pins) for chart in charts] == [
            ("solved", "spectral", 4),
            ("solved", "spectral", 0),
        ]
        distances.append(np.linalg.norm([uv[corner] - position for corner, position in pins.items()]))
    assert (np.diff(distances) < 0).all()
    assert distances[-1] < 0.02 * distances[0]
