# SPDX-License-Identifier: GPL-3.0-or-later
"""`relax` and `Relaxation`: lower distortion from the present map, without new defects."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

SIZES = [0.0, 0.5, 1.0]


def bumpy(n=12):
    points, quads = meshes.unit_square(n)
    x, y = 2 * points.T - 1
    z = 0.6 * np.exp(-4 * (x**2 + y**2)) + 0.2 * np.sin(3 * x + 1) * y
    return np.c_[x, y, z], meshes.triangles_of(quads)


def flat(n=12):
    vertices, triangles = bumpy(n)
    return vertices * [1, 1, 0], triangles


def border_of(vertices):
    return (np.abs(vertices[:, :2]) > 1 - 1e-9).any(axis=1)


def shaken(uv, free, amount, seed=0):
    moved = uv.copy()
    moved[free] += np.random.default_rng(seed).uniform(-amount, amount, (int(free.sum()), 2))
    return moved


def energy_of(vertices, triangles, uv, sizes):
    """The formula of `relax`, at the scale at which the map has the area of the surface."""
    p = vertices[triangles]
    first, second = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    x1 = np.linalg.norm(first, axis=1)
    x2 = (first * second).sum(axis=1) / x1
    y2 = np.linalg.norm(np.cross(first, second), axis=1) / x1
    q = uv[triangles]
    d1, d2 = q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]
    image_area = 0.5 * (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]).sum()
    by_x = d1 / x1[:, None]
    by_y = (d2 - by_x * x2[:, None]) / y2[:, None]
    s = np.linalg.svd(np.stack([by_x, by_y], axis=2), compute_uv=False) * np.sqrt((0.5 * x1 * y2).sum() / image_area)
    angles = s[:, 0] / s[:, 1] + s[:, 1] / s[:, 0]
    return np.average((1 - sizes) * angles + sizes * (s**2 + s**-2.0).sum(axis=1), weights=x1 * y2)


def ribbon(n, width):
    """n quads in a row, of length 1 in all."""
    vertices = np.array([[i / n, j * width, 0.0] for i in range(n + 1) for j in (0, 1)])
    first = 2 * np.arange(n)
    return vertices, np.r_[np.c_[first, first + 2, first + 3], np.c_[first, first + 3, first + 1]]


@pytest.mark.parametrize(("quads", "width"), [(1, 0.01), (4, 0.002), (20, 0.0002)])
def test_an_isometric_ribbon_stays_whatever_is_near_its_sides(quads, width):
    vertices, triangles = ribbon(quads, width)
    for sizes in SIZES:
        result = meshes.relax(vertices, triangles, vertices[:, :2].copy(), sizes=sizes)
        assert (result.energy_before, result.energy) == pytest.approx((2 + 2 * sizes,) * 2, abs=1e-9)
        assert result.converged
        assert np.abs(result.uv - vertices[:, :2]).max() < 1e-6


def area_of(triangles, uv):
    a, b, c = np.moveaxis(uv[triangles] @ (1, 1j), 1, 0)
    return 0.5 * ((b - a).conj() * (c - a)).imag.sum()


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("held", [False, True])
def test_the_energy_is_the_documented_one_and_of_the_map_alone(sizes, held):
    vertices, triangles = bumpy()
    vertices[:, 2] *= 3
    uv = sc.parameterize(vertices, triangles, fold_free=True).uv
    fixed = np.arange(3) if held else None
    area = area_of(triangles, uv)
    for tolerance in (1e-2, 1e-6):
        relaxation = meshes.Relaxation(vertices, triangles, uv, sizes=sizes, tolerance=tolerance, fixed=fixed)
        energy = relaxation.energy
        while relaxation.step():
            assert relaxation.energy <= energy * (1 + 1e-12)
            energy = relaxation.energy
        result = relaxation.result
        assert result.energy == pytest.approx(energy_of(vertices, triangles, result.uv, sizes), rel=1e-9)
        again = meshes.relax(vertices, triangles, result.uv, sizes=sizes, tolerance=tolerance, fixed=fixed)
        assert again.energy_before == pytest.approx(result.energy, rel=1e-12)
        assert again.energy <= again.energy_before
        if not held:
            assert area_of(triangles, result.uv) == pytest.approx(area, rel=1e-9)


def overlapping(triangles, uv):
    return int(meshes.defects(triangles, None, uv[triangles].reshape(-1, 2)).overlapping.sum())


@pytest.mark.parametrize("power", [-900, -300, 300, 900])
def test_no_unit_of_the_surface_or_of_the_map_matters(power):
    vertices, triangles = bumpy()
    uv = sc.parameterize(vertices, triangles).uv
    both = np.r_[vertices, vertices + [9, 0, 0]], np.r_[triangles, triangles + len(vertices)], np.r_[uv, 2 * uv]
    given = meshes.relax(*both, tolerance=1e-4)
    assert given.converged
    for of_surface, of_map in ((power, 0), (0, power), (power, -power)):
        scaled = meshes.relax(np.ldexp(both[0], of_surface), both[1], np.ldexp(both[2], of_map), tolerance=1e-4)
        np.testing.assert_array_equal(scaled.uv, np.ldexp(given.uv, of_map))
        assert (scaled.energy_before, scaled.energy) == (given.energy_before, given.energy)
        assert (scaled.flipped, scaled.converged) == (0, True)


def disk(radii, n=6):
    """Rings about a middle, each of n vertices."""
    angle = 2 * np.pi / n * np.arange(n)
    rings = np.asarray(radii)[:, None, None] * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    i, j = 1 + np.arange(n), 1 + np.roll(np.arange(n), -1)
    triangles = [np.c_[0 * i, i, j]]
    for k in range(len(radii) - 1):
        a, b, c, d = i + n * k, i + n * (k + 1), j + n * (k + 1), j + n * k
        triangles += [np.c_[a, b, c], np.c_[a, c, d]]
    return np.r_[np.zeros((1, 3)), rings.reshape(-1, 3)], np.concatenate(triangles)


def test_images_too_small_for_double_precision_count_as_collapsed():
    vertices, triangles = disk(1.0 + np.arange(13))
    uv = disk(10.0 ** (8 * np.arange(-12, 1)))[0][:, :2]
    assert not sc.distortion(vertices, triangles, uv).flipped.any()
    result = meshes.relax(vertices, triangles, uv, sizes=1)
    assert (result.energy, result.converged) == (np.inf, False)
    assert 0 < result.flipped < len(triangles)
    np.testing.assert_array_equal(result.uv, uv)


def test_a_shallow_overlap_gets_no_deeper():
    # A ring cut open, whose ends lie on each other by a hundred-millionth; on the surface, by an eighth of a turn.
    columns, rows = 48, 3
    part, radius = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(1, 1.6, rows + 1), indexing="ij")

    def ring(turns):
        angle = turns * 2 * np.pi * part
        return np.c_[(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel(), part.ravel()]

    i = np.arange(part.size).reshape(part.shape)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    triangles = np.r_[np.c_[a, b, c], np.c_[a, c, d]]
    uv = ring(1 + 1e-8)[:, :2]
    assert sc.distortion(ring(1.125), triangles, uv).overlapping.any()
    assert overlapping(triangles, uv) == 0
    assert overlapping(triangles, meshes.relax(ring(1.125), triangles, uv, sizes=1).uv) == 0


@pytest.mark.parametrize("fold_free", [False, True])
def test_starts_with_collapsed_triangles_get_no_more_overlaps(fold_free):
    vertices, triangles = bumpy()
    uv = sc.parameterize(vertices, triangles).uv
    fixed = border_of(vertices)
    inside_at_one_point = np.where(fixed[:, None], uv, 0.0)
    half_at_one_point = np.where(vertices[:, :1] < 0, uv, uv[0])
    for start, held in ((inside_at_one_point, fixed), (half_at_one_point, None)):
        before = overlapping(triangles, start)
        for sizes in SIZES:
            relaxation = meshes.Relaxation(vertices, triangles, start, sizes=sizes, fixed=held, fold_free=fold_free)
            goes_on = True
            while goes_on:
                assert overlapping(triangles, relaxation.uv) <= before
                goes_on = relaxation.step(5)
    for collapsed in (0 * uv, uv * [1, 0]):
        result = meshes.relax(vertices, triangles, collapsed, fold_free=fold_free)
        assert (result.flipped, result.energy, result.converged) == (len(triangles), np.inf, False)
        # Beside another island, only that one counts.
        both = np.r_[vertices, vertices], np.r_[triangles, triangles + len(vertices)], np.r_[collapsed, uv]
        beside, alone = meshes.relax(*both, fold_free=fold_free), meshes.relax(vertices, triangles, uv)
        assert (beside.flipped, beside.converged) == (len(triangles), False)
        assert beside.energy == pytest.approx(alone.energy, rel=1e-9)


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_fixed_border_of_a_similarity_gives_the_similarity_back(sizes, mirrored):
    vertices, triangles = flat()
    turn = 2.5 * np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    similar = vertices[:, :2] * [1, -1 if mirrored else 1] @ turn.T + [30, -1]
    fixed = border_of(vertices)
    start = shaken(similar, ~fixed, 0.1)
    held = np.flatnonzero(fixed) if mirrored else fixed  # either form
    result = meshes.relax(vertices, triangles, start, sizes=sizes, fixed=held, tolerance=1e-10)
    assert np.array_equal(result.uv[fixed], start[fixed])
    assert np.abs(result.uv - similar).max() < 1e-6
    assert result.energy == pytest.approx(2 + 2 * sizes, abs=1e-9)


def test_the_number_of_steps_is_limited():
    vertices, triangles = bumpy()
    uv = sc.parameterize(vertices, triangles).uv
    whole = meshes.relax(vertices, triangles, uv, sizes=1)
    few = meshes.relax(vertices, triangles, uv, sizes=1, max_steps=2)
    assert (few.steps, few.converged) == (2, False)
    assert few.energy > whole.energy


def test_islands_relax_as_each_does_alone():
    vertices, triangles = bumpy()
    uv = sc.parameterize(vertices, triangles).uv
    both = np.r_[vertices, 2 * vertices + [9, 0, 0]], np.r_[triangles, triangles + len(vertices)]
    alone = meshes.relax(vertices, triangles, uv)
    together = meshes.relax(*both, np.r_[uv, uv * [-0.1, 0.1] + [5, 5]])
    assert np.array_equal(together.uv[: len(uv)], alone.uv)
    assert np.abs(together.uv[len(uv) :] - (alone.uv * [-0.1, 0.1] + [5, 5])).max() < 1e-6
    assert together.energy == pytest.approx(alone.energy, rel=1e-6)


@pytest.mark.parametrize("start", ["noise", "ear"])
def test_either_the_energy_or_the_number_of_flips_falls(start):
    vertices, triangles = bumpy(12)
    uv = vertices[:, :2] + (0.1 * np.random.default_rng(2).normal(size=(144, 2)) if start == "noise" else 0)
    if start == "ear":
        # A triangle that shares one vertex with the others, mirrored.
        vertices = np.r_[vertices, [[1.5, 1, 0], [1.2, 1.5, 0]]]
        triangles = np.r_[triangles, [[143, 144, 145]]]
        uv = np.r_[uv, vertices[[145, 144], :2]]
    relaxation = meshes.Relaxation(vertices, triangles, uv)
    before = relaxation.result
    assert before.flipped > 0
    while relaxation.step():
        after = relaxation.result
        assert after.energy <= before.energy or after.flipped < before.flipped
        before = after


def test_the_border_does_not_cover_itself():
    vertices, faces = meshes.spiral_ramp(1.5)
    triangles = meshes.triangles_of(faces)
    apart = sc.parameterize(vertices, triangles, fold_free=True).uv
    assert not sc.distortion(vertices, triangles, apart).overlapping.any()
    relaxed = meshes.relax(vertices, triangles, apart, sizes=1, tolerance=1e-5)
    after = sc.distortion(vertices, triangles, relaxed.uv)
    assert not after.overlapping.any()
    assert relaxed.energy < relaxed.energy_before
    # One that covers itself at the start does so no more than before.
    covering = sc.parameterize(vertices, triangles).uv
    count = sc.distortion(vertices, triangles, covering).overlapping.sum()
    assert count > 0
    relaxed = meshes.relax(vertices, triangles, covering, sizes=1)
    assert sc.distortion(vertices, triangles, relaxed.uv).overlapping.sum() <= count


def test_a_border_that_touches_itself_at_the_start_relaxes_too():
    # A slit whose sides are vertices of their own at the same places.
    vertices, triangles = bumpy(13)
    slit = np.flatnonzero((vertices[:, 0] == 0) & (vertices[:, 1] < 0.1))
    twins = len(vertices) + np.arange(len(slit))
    beyond = vertices[triangles].mean(axis=1)[:, 0] > 0
    # The last vertex of the slit is its end, which both sides share.
    for old, new in zip(slit[:-1], twins[:-1]):
        triangles[beyond] = np.where(triangles[beyond] == old, new, triangles[beyond])
    vertices = np.r_[vertices, vertices[slit]]
    uv = vertices[:, :2].copy()
    relaxed = meshes.relax(vertices, triangles, uv, sizes=1)
    assert np.isfinite((relaxed.energy_before, relaxed.energy)).all()
    assert relaxed.energy < relaxed.energy_before - 0.01
    assert not sc.distortion(vertices, triangles, relaxed.uv).overlapping.any()


def test_what_is_held_far_away_changes_nothing():
    # The same patch with a wide held collar, and with none but its ring; both at the scale of the view from above.
    vertices, triangles = flat(25)
    inside = np.abs(vertices[:, :2]).max(axis=1) < 0.3
    uv = shaken(vertices[:, :2], inside, 0.02)
    whole = meshes.relax(vertices, triangles, uv, fixed=~inside, tolerance=1e-6)
    near = inside[triangles].any(axis=1)
    used, local = np.unique(triangles[near], return_inverse=True)
    # Map and surface have the same area in both.
    part = meshes.relax(vertices[used], local.reshape(-1, 3), uv[used], fixed=~inside[used], tolerance=1e-6)
    np.testing.assert_allclose(whole.uv[used], part.uv, atol=1e-9)
    np.testing.assert_array_equal(whole.uv[~inside], uv[~inside])


def test_weights_draw_the_distortion_elsewhere():
    vertices, triangles = bumpy()
    uv = sc.parameterize(vertices, triangles).uv
    right = vertices[triangles].mean(axis=1)[:, 0] > 0
    plain = meshes.relax(vertices, triangles, uv, sizes=1, tolerance=1e-6).uv
    same = meshes.relax(vertices, triangles, uv, sizes=1, tolerance=1e-6, weights=np.full(len(triangles), 7.0)).uv
    assert np.abs(same - plain).max() < 1e-6
    weighted = meshes.relax(vertices, triangles, uv, sizes=1, tolerance=1e-6, weights=np.where(right, 100.0, 1.0)).uv

    def spread(each):
        return np.std(sc.distortion(vertices, triangles, each).log2_scale[right])

    assert spread(weighted) < spread(plain)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_border_slides_along_itself_and_the_energy_falls_at_every_step(mirrored):
    vertices, triangles = disk(np.arange(1, 7) / 6, 24)
    z = vertices[:, :2] @ (1.0, 1.0j)
    vertices[:, 2] = 2.0 * np.abs(z - 0.3) ** 2
    # Twisted, so that the points on the border are not evenly spaced.
    z = z * np.exp(0.3j * np.sin(3 * np.angle(z) + 0.2) * np.abs(z) ** 2)
    uv = np.stack([-z.real if mirrored else z.real, z.imag], axis=1)
    relaxation = meshes.Relaxation(vertices, triangles, uv, sizes=1.0, border="sliding")
    energy, steps = relaxation.energy, 0
    while relaxation.step():
        assert relaxation.energy <= energy
        energy, steps = relaxation.energy, steps + 1
    assert steps > 2
    found = relaxation.result
    assert found.converged and found.flipped == 0
    outer = np.arange(len(z) - 24, len(z))
    assert (found.uv[outer] != uv[outer]).any(axis=1).all()
    # The curve through 24 points of a circle, at most 25 degrees apart.
    np.testing.assert_allclose(np.linalg.norm(found.uv[outer], axis=1), 1.0, atol=5e-3)
    free, held = (meshes.relax(vertices, triangles, uv, sizes=1.0, border=border) for border in ("free", "held"))
    assert free.energy < found.energy < held.energy - 0.01
    np.testing.assert_array_equal(held.uv[outer], uv[outer])


def test_threads_do_not_matter_and_a_refusal_cancels():
    vertices, triangles = bumpy(100)
    uv = sc.parameterize(vertices, triangles).uv
    free = meshes.relax(vertices, triangles, uv, sizes=1)
    before = sc.limit_threads(1)
    try:
        alone = meshes.relax(vertices, triangles, uv, sizes=1)
    finally:
        sc.limit_threads(before)
    assert np.array_equal(free.uv, alone.uv)
    with pytest.raises(sc.Cancelled):
        meshes.relax(vertices, triangles, uv, progress=lambda fraction, phase: False)
    calls = []
    relaxation = meshes.Relaxation(vertices, triangles, uv, sizes=1)
    with pytest.raises(sc.Cancelled):
        relaxation.step(1000, progress=lambda fraction, phase: calls.append(fraction) or len(calls) < 4)
    assert calls == sorted(calls)
    while relaxation.step():
        pass
    assert relaxation.energy == pytest.approx(free.energy, rel=1e-4)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"uv": np.full((242, 3, 2), np.nan)}, "positions or UVs that are not finite"),
        ({"uv": None}, "The mesh has no map"),
        ({"sizes": 1.5}, "sizes must lie between 0 and 1"),
        ({"tolerance": -1}, "tolerance must lie between 0 and 1"),
        ({"border": "slides"}, "border must be one of free, sliding, held"),
        ({"fixed": np.zeros(3, bool)}, "fixed must be 726 booleans, one per corner"),
        ({"weights": np.zeros(242)}, "weights must be positive and finite"),
        ({"faces": [[0, 0, 1]], "uv": np.zeros((3, 2))}, "Face 0 has a vertex twice"),
    ],
)
def test_what_cannot_be_used_is_named(changes, words):
    vertices, triangles = bumpy()
    given = {"vertices": vertices, "faces": triangles, "uv": vertices[triangles][..., :2], **changes}
    mesh = sc.Mesh(*(given.pop(name) for name in ("vertices", "faces", "uv")))
    with pytest.raises(ValueError, match=words):
        sc.relax(mesh, **given)


def test_a_surface_without_area_or_faces_has_the_map_that_it_had():
    vertices, triangles = bumpy()
    point = meshes.relax(np.zeros((144, 3)), triangles, vertices[:, :2])
    assert np.array_equal(point.uv, vertices[:, :2])
    nothing = meshes.relax(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros((0, 2)))
    assert nothing.uv.shape == (0, 2)


@pytest.mark.parametrize("seed", [7, 20, 47])
def test_one_vertex_may_move_where_no_scale_is_finite(seed):
    vertices, triangles = bumpy(4)
    rng = np.random.default_rng(seed)
    uv = 1e10 * rng.normal(size=(16, 2))
    uv[11] = uv[5]
    result = meshes.relax(
        vertices,
        triangles,
        uv,
        sizes=1.0,
        fixed=np.arange(16) != 13,
        constraints=sc.Constraints(horizontal=[[15, 14, 9]], vertical=[[2, 12, 11, 3]]),
        weights=10 ** rng.uniform(-4, 4, len(triangles)),
        fold_free=True,
        max_steps=9,
    )
    np.testing.assert_array_equal(np.delete(result.uv, 13, axis=0), np.delete(uv, 13, axis=0))
    assert np.isfinite(result.uv).all()
