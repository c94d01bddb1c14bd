"""Degenerate triangles that must not disturb the rest, extreme shrinkage, and maps without folds."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import degenerate, meshes

PINS = {0: (0.0, 0.0), 5: (1.0, 0.0)}
KINDS = {"caps": degenerate.caps, "needles": degenerate.needles, "points": degenerate.points}


def unwrapped(vertices, triangles, **options):
    """The map per vertex and the only chart of a triangle mesh."""
    result = sc.unwrap(vertices, np.arange(0, triangles.size + 1, 3), triangles.ravel(), **options)
    (chart,) = result.charts
    uv = np.zeros((len(vertices), 2))
    uv[triangles.ravel()] = result.uv
    return uv, chart


def image_areas(uv, triangles):
    a, b, c = (uv[triangles[:, k]] for k in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


@pytest.fixture(scope="module")
def clean():
    return meshes.bumpy_disk(300)


class TestDegenerateTriangles:
    @pytest.mark.parametrize("height", [0.0, 1e-14, 1e-9])
    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.parametrize(
        "options",
        [{}, {"factorization": "eigen"}, {"method": "area"}, {"area_blend": 1.0}, {"method": "lscm", "pins": PINS}],
    )
    def test_the_rest_does_not_notice(self, clean, kind, height, options):
        vertices, triangles = clean
        reference = degenerate.with_middles(*clean) if kind == "points" else clean
        expected, _ = unwrapped(*reference, **options)
        uv, chart = unwrapped(*KINDS[kind](vertices, triangles, height), **options)
        assert chart.status == "solved"
        assert chart.flipped == 0
        n = len(vertices)
        # A height of 1e-9 is one in the mesh, too. Measured: below 1e-10 without area_blend, 1e-8 with it.
        assert meshes.similarity_deviation(uv[:n], expected[:n]) < (1e-7 if "area_blend" in options else 1e-8)
        # Needles of 1e-9 of an edge may be thinner than 1e-10 of another.
        assert "degenerate" in chart.message or height == 1e-9

    @pytest.mark.parametrize("height", [0.0, 1e-14, 1e-8])
    @pytest.mark.parametrize("kind", KINDS)
    def test_inverse_area_weights_are_kept(self, clean, kind, height):
        vertices, triangles = clean
        reference = degenerate.with_middles(*clean) if kind == "points" else clean
        expected, _ = unwrapped(*reference, weights="inverse_area")
        uv, chart = unwrapped(*KINDS[kind](vertices, triangles, height), weights="inverse_area")
        assert chart.flipped == 0
        assert (chart.fallback, chart.weights) == (None, "inverse_area")
        assert (
            meshes.similarity_deviation(uv[: len(vertices)], expected[: len(vertices)]) < 5e-3
        )  # halved triangles count twice

    @pytest.mark.parametrize("kind", KINDS)
    def test_inverse_area_weights_are_kept_whatever_the_rounding(self, clean, kind):
        # Next to entries of 1e12 the rounding of the factor is as large as the eigenvalue. For some of these meshes
        # whole corrections then lead away from the map; for which depends on the BLAS's kernels.
        for seed in (2, 8, 13, 15):
            for height in (1e-14, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8):
                vertices, triangles = KINDS[kind](*clean, height, seed=seed)
                maps = []
                for factorization in ("auto", "eigen"):
                    uv, chart = unwrapped(vertices, triangles, weights="inverse_area", factorization=factorization)
                    assert (chart.fallback, chart.flipped) == (None, 0), (seed, height, factorization, chart.message)
                    maps.append(uv[: len(clean[0])])
                # Measured: below 1e-7.
                assert meshes.similarity_deviation(*maps) < 1e-6, (seed, height)

    @pytest.mark.parametrize("factorization", ["auto", "eigen"])
    def test_single_precision_far_from_the_origin(self, factorization):
        # Coordinates are multiples of 1/16 there: half of the triangles have no area, half of the vertices coincide.
        points, quads = meshes.unit_square(26)
        x, y = points.T
        vertices, triangles = np.c_[x, y, 0.3 * np.sin(3 * x) * np.cos(2 * y)], meshes.triangles_of(quads)
        rounded = (vertices + 1e6).astype(np.float32).astype(float)
        assert len(np.unique(rounded, axis=0)) < 0.7 * len(vertices)
        uv, chart = unwrapped(rounded, triangles, factorization=factorization)
        assert (chart.status, chart.flipped, chart.turning_number) == ("solved", 0, 1)
        expected, _ = unwrapped(vertices, triangles)
        assert meshes.similarity_deviation(uv, expected) < 0.2  # of what is left of the surface

    @pytest.mark.parametrize("weights", ["uniform", "inverse_area"])
    def test_area_ratios_of_1e12(self, clean, weights):
        uv, chart = unwrapped(*degenerate.nested(*clean, 1e-6), weights=weights)
        assert (chart.status, chart.message, chart.flipped) == ("solved", "", 0)
        coarse, _ = unwrapped(*degenerate.nested(*clean, 1e-2), weights=weights)
        n = len(clean[0])
        # Beyond the third ring or so nothing is added that the map could use.
        assert meshes.similarity_deviation(uv[:n], coarse[:n]) < (1e-5 if weights == "uniform" else 2e-2)


def ring_radii(sides, rings):
    """The radii of the rings of finger's map, relative to the first: the equations of its inner vertices, whose map is
    rho_k exp(2 pi i q / sides), from the tip outward. Each radius is larger than the last: accurate to its own digits.
    """
    vertices, triangles = meshes.finger(sides, 4)
    turn = np.exp(2j * np.pi / sides)
    factor = np.r_[np.tile(turn ** np.arange(sides), 4), 0]

    def coefficients(ring):
        """Of the ring before, the ring itself and the one after, in the equation of its first vertex."""
        row = np.zeros(len(vertices), complex)
        for triangle in triangles[(triangles == ring * sides).any(1)]:
            for k in range(3):
                apex, i, j = np.roll(triangle, -k)
                u, w = vertices[i] - vertices[apex], vertices[j] - vertices[apex]
                cotangent = u.dot(w) / np.linalg.norm(np.cross(u, w))
                for this, other, area in ((i, j, 0.5j), (j, i, -0.5j)):
                    if this == ring * sides:
                        row[this] += cotangent / 2
                        row[other] += -cotangent / 2 + area
        parts = row * factor
        return [parts[(ring + d) * sides : (ring + d + 1) * sides].sum() for d in (-1, 0, 1)]

    before, own, _ = coefficients(3)
    radii = [1.0 + 0j, -own / before]
    before, own, after = coefficients(2)
    while len(radii) < rings:
        radii.append(-(own * radii[-1] + after * radii[-2]) / before)
    radii = np.abs(radii[::-1])
    return radii / radii[0]


class TestExtremeShrinkage:
    @pytest.mark.parametrize("factorization", ["auto", "eigen"])
    @pytest.mark.parametrize("rings", [20, 40, 70])  # scales down to 6e-4, 3e-7 and 2e-12 of the largest
    def test_the_map_is_right_relative_to_itself(self, rings, factorization):
        vertices, triangles = meshes.finger(16, rings)
        solution = sc.parameterize(vertices, triangles, factorization=factorization)
        z = solution.uv @ [1, 1j]
        radii = np.abs(z[:-1] - z[-1]).reshape(rings, 16)
        expected = ring_radii(16, rings)
        assert expected[-1] < 1e-3
        assert np.abs(radii / radii[0] / expected[:, None] - 1).max() < 1e-8
        assert solution.residual < 1e-15
        assert (solution.turning_number, solution.message) == (1, "")

    def test_it_says_where_double_precision_ends(self):
        vertices, triangles = meshes.finger(16, 120)
        solution = sc.parameterize(vertices, triangles)
        assert "below what double precision resolves" in solution.message
        # What can be resolved is right, however little the rest means.
        z = solution.uv @ [1, 1j]
        radii = np.abs(z[:-1] - z[-1]).reshape(120, 16).mean(1)
        expected = ring_radii(16, 120)
        resolved = expected > 1e-12
        assert np.abs(radii / radii[0] / expected - 1)[resolved].max() < 1e-6

    def test_fold_free_ends_the_shrinkage_where_it_must(self):
        vertices, triangles = meshes.finger(16, 120)
        uv, chart = unwrapped(vertices, triangles, fold_free=True)
        assert (image_areas(uv, triangles) > 0).all()
        assert chart.turning_number == 1


class TestFoldFree:
    @pytest.mark.parametrize("seed", range(12))
    def test_rough_surfaces_with_and_without_holes(self, seed):
        vertices, triangles = meshes.rough_grid(
            6 + 3 * seed, (0.5, 1.0, 2.0)[seed % 3], seed, dropped=(0.0, 0.1)[seed % 2]
        )
        result = sc.unwrap(vertices, np.arange(0, triangles.size + 1, 3), triangles.ravel(), fold_free=True)
        for chart in result.charts:
            corners = (3 * chart.faces[:, None] + np.arange(3)).ravel()
            areas = image_areas(result.uv[corners], np.arange(len(corners)).reshape(-1, 3))
            assert (areas > 0).all()
            assert (chart.status, chart.flipped, abs(chart.turning_number)) == ("solved", 0, 1)

    def test_the_rough_surfaces_do_have_folds_otherwise(self):
        assert sum(unwrapped(*meshes.rough_grid(20, 2.0, seed))[1].flipped for seed in range(4)) > 10

    def test_pins_are_held_and_what_they_leave_no_room_for_is_said(self):
        vertices, triangles = meshes.rough_grid(12, 1.5, 5)
        pins = {0: (0.0, 0.0), 143: (1.0, 1.0)}
        solution = sc.parameterize(vertices, triangles, method="lscm", pins=pins, fold_free=True)
        for vertex, position in pins.items():
            assert tuple(solution.uv[vertex]) == position
        assert (image_areas(solution.uv, triangles) > 0).all()
        flat, faces = meshes.random_disk(60)
        folded = {v: (abs(flat[v, 0]), flat[v, 1]) for v in range(len(flat))}
        solution = sc.parameterize(flat, faces, method="lscm", pins=folded, fold_free=True)
        assert "could not be unfolded between the pins" in solution.message
        assert all(tuple(solution.uv[v]) == place for v, place in folded.items())

    def test_pins_that_mirror_the_patch_do_not_fold_it(self):
        vertices, triangles = meshes.random_disk(60)
        mirrored = {v: (-vertices[v, 0], vertices[v, 1]) for v in range(len(vertices))}
        plain, free = (
            sc.parameterize(vertices, triangles, method="lscm", pins=mirrored, fold_free=flag) for flag in (False, True)
        )
        assert (image_areas(free.uv, triangles) < 0).all()
        assert np.array_equal(plain.uv, free.uv)
        assert free.unfolded == 0

    @pytest.mark.parametrize("method", ["spectral", "lscm", "fiedler", "area"])
    @pytest.mark.parametrize("options", [{}, {"fill_holes": True}, {"area_blend": 0.5}, {"boundary": "vertex"}])
    def test_with_every_method_and_option(self, method, options):
        vertices, triangles = meshes.rough_grid(14, 2.0, 9, dropped=0.05)
        uv, chart = unwrapped(vertices, triangles, method=method, fold_free=True, **options)
        assert (chart.status, chart.flipped, abs(chart.turning_number)) == ("solved", 0, 1)
        assert (image_areas(uv, triangles) > 0).all()

    def test_quads_keep_their_first_split(self):
        vertices, faces = meshes.saddle_quads(8)
        vertices = vertices + 0.05 * np.random.default_rng(1).normal(size=vertices.shape)
        offsets, corners = meshes.polygons(faces)
        result = sc.unwrap(vertices, offsets, corners, fold_free=True)
        split = offsets[:-1, None] + [[0, 1, 2, 0, 2, 3]]
        assert (image_areas(result.uv, split.reshape(-1, 3)) > 0).all()
