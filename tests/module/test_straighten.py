# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders that are nearly straight become straight, for little distortion."""

import warnings

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal.assets import AssetMesh
from spectral_conformal.assets.unwrapping import Cutting, cut
from spectral_conformal.batch import settings as batch_settings

SIDE = 24


def sheet(bulge, height=0.0):
    """Return a flat square of quads whose sides bulge by a share of their length, in the middle raised by `height`."""
    s = np.linspace(-1.0, 1.0, SIDE + 1)
    x, y = np.meshgrid(s, s)
    around = np.stack([x * (1.0 + 2.0 * bulge * (1.0 - y**2)), y * (1.0 + 2.0 * bulge * (1.0 - x**2))], axis=-1)
    raised = height * (1.0 - x**2) * (1.0 - y**2)
    n = SIDE + 1
    v = np.arange(n * n).reshape(n, n)
    faces = np.stack([v[:-1, :-1], v[:-1, 1:], v[1:, 1:], v[1:, :-1]], axis=-1).reshape(-1, 4)
    return np.concatenate([around, raised[..., None]], axis=-1).reshape(-1, 3), faces


def disk(n):
    angles = 2.0 * np.pi * np.arange(n) / n
    rings = [
        np.stack([r * np.cos(angles), r * np.sin(angles), 0.3 * r**2 + 0 * angles], axis=1) for r in (0.3, 0.6, 1.0)
    ]
    vertices = np.concatenate([[[0.0, 0.0, 0.0]], *rings])
    k = np.arange(n)
    faces = [[0, 1 + i, 1 + (i + 1) % n] for i in k]
    for ring in (0, 1):
        low, high = 1 + ring * n, 1 + (ring + 1) * n
        faces += [[low + i, high + i, high + (i + 1) % n, low + (i + 1) % n] for i in k]
    return vertices, faces


def off_axes(result, vertices):
    """Return how far vertices of the mesh lie from the nearest line along an axis through all of them."""
    corners = [list(result.corner_vertices).index(v) for v in vertices]
    return np.ptp(result.uv[corners], axis=0).min() / np.ptp(result.uv, axis=0).max()


def sides():
    v = np.arange((SIDE + 1) ** 2).reshape(SIDE + 1, SIDE + 1)
    return v[0], v[-1], v[:, 0], v[:, -1]


def test_a_sheet_whose_sides_bulge_a_little_becomes_a_rectangle():
    mesh = sheet(0.008, 0.4)
    free, straight = (sc.unwrap(*mesh, straighten=share) for share in (0.0, "auto"))
    for side in sides():
        assert off_axes(free, side) > 1e-3
        assert off_axes(straight, side) < 1e-12
    assert straight.charts[0].mean_qc <= 1.02 * free.charts[0].mean_qc
    assert straight.charts[0].flipped == straight.charts[0].overlapping == 0


def test_what_would_cost_more_than_the_share_stays():
    mesh = sheet(0.02)
    free = sc.unwrap(*mesh)
    assert np.array_equal(sc.unwrap(*mesh, straighten=1e-6).uv, free.uv)
    costly = sc.unwrap(*mesh, straighten=0.2)
    assert max(off_axes(costly, side) for side in sides()) < 1e-12
    assert 1e-6 < costly.charts[0].mean_qc / free.charts[0].mean_qc - 1.0 < 0.2


def test_any_share_is_a_share():
    mesh = sheet(0.008)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        most = sc.unwrap(*mesh, straighten=1e308)
    assert np.array_equal(most.uv, sc.unwrap(*mesh, straighten=1e6).uv)


@pytest.mark.parametrize("n", [10, 16, 24, 32, 40, 100])
def test_round_islands_stay_round(n):
    mesh = disk(n)
    border = np.arange(1 + 2 * n, 1 + 3 * n)
    radii = []
    for share in (0.0, "auto"):
        result = sc.unwrap(*mesh, straighten=share)
        uv = np.zeros((len(mesh[0]), 2))
        uv[result.corner_vertices] = result.uv
        radii.append(np.hypot(*(uv[border] - uv[border].mean(axis=0)).T))
    # It may turn.
    np.testing.assert_allclose(radii[1], radii[0], rtol=1e-9)


def gear(n_teeth):
    """Return a flat gear with a bore, four quads for each tooth."""
    angle = 2.0 * np.pi * np.arange(4 * n_teeth) / (4 * n_teeth)
    outer = np.where(np.arange(4 * n_teeth) % 4 < 2, 1.0, 0.75)
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), 0.0 * angle], axis=1) for r in (outer, 0.3)]
    k, n = np.arange(4 * n_teeth), 4 * n_teeth
    return np.concatenate(rings), np.stack([k, (k + 1) % n, n + (k + 1) % n, n + k], axis=1)


@pytest.mark.parametrize("n_teeth", [8, 12, 20])
def test_a_gear_is_not_skewed_for_a_few_of_its_teeth(n_teeth):
    for polish in ("off", "angles", "balanced"):
        found = sc.unwrap(*gear(n_teeth), options=sc.Options(polish=polish), straighten="auto")
        assert found.charts[0].max_qc < 1.0 + 1e-9


def test_islands_answer_one_by_one_and_pinned_ones_stay():
    first, faces = sheet(0.008, 0.4)
    second = first + [3.0, 0.0, 0.0]
    round_one, fan = disk(40)
    both = np.concatenate([first, second, round_one + [9.0, 0.0, 0.0]])
    all_faces = [*faces.tolist(), *(faces + len(first)).tolist(), *([[v + 2 * len(first) for v in f] for f in fan])]
    pins = {len(first): (5.0, 5.0), len(first) + SIDE: (7.0, 5.1)}
    result = sc.unwrap(both, all_faces, pins=pins, straighten="auto")
    assert max(off_axes(result, side) for side in sides()) < 1e-12
    assert min(off_axes(result, side + len(first)) for side in sides()) > 1e-4
    free = sc.unwrap(both, all_faces, pins=pins)
    held = result.chart_of_face[np.repeat(np.arange(len(all_faces)), [len(f) for f in all_faces])] > 0
    assert np.array_equal(result.uv[held], free.uv[held])


def test_constraints_of_the_caller_are_kept_alone():
    vertices, faces = sheet(0.008, 0.4)
    constraints = sc.Constraints(horizontal=[[0, 4 * SIDE - 1]])
    given = sc.unwrap(vertices, faces, constraints=constraints)
    assert np.array_equal(sc.unwrap(vertices, faces, constraints=constraints, straighten="auto").uv, given.uv)


@pytest.mark.parametrize("share", [-0.1, float("nan"), "automatic"])
def test_shares_are_checked(share):
    with pytest.raises((TypeError, ValueError), match="straighten"):
        sc.unwrap(*sheet(0.01), straighten=share)


def test_progress_runs_once_from_0_to_1_and_cancels():
    seen = []
    sc.unwrap(*sheet(0.008, 0.4), straighten="auto", progress=lambda fraction, _: seen.append(fraction))
    assert seen == sorted(seen)
    assert seen[-1] <= 1.0
    with pytest.raises(sc.Cancelled):
        sc.unwrap(*sheet(0.008), straighten="auto", progress=lambda fraction, _: fraction < 0.5)


def bent(angle):
    """Return a sheet that is folded along the middle, and the edges of the fold."""
    vertices, faces = sheet(0.0)
    vertices[:, 2] = np.abs(vertices[:, 0]) * np.tan(np.radians(angle) / 2.0)
    middle = np.arange(SIDE // 2, (SIDE + 1) ** 2, SIDE + 1)
    return vertices, faces, np.stack([middle[:-1], middle[1:]], axis=1)


@pytest.mark.parametrize(("angle", "is_hard"), [(80.0, True), (10.0, False)])
def test_the_batch_straightens_on_hard_surfaces_by_their_shape_or_the_style(angle, is_hard):
    vertices, faces, fold = bent(angle)
    mesh = AssetMesh(vertices, 4 * np.arange(len(faces) + 1), faces.ravel(), None, "sheet", np.eye(4), fold)
    found = cut(mesh, Cutting(seams="keep"))

    def straightening(**values):
        return batch_settings.from_values(values).straightening(found)

    assert straightening() == ("auto" if is_hard else 0.0)
    assert straightening(style="hard") == "auto"
    assert straightening(style="organic") == 0.0
    assert straightening(style="organic", straighten=0.01) == 0.01
