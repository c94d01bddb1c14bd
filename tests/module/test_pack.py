# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands packed by their shapes: margins, obstacles, tiles, stacks, and the same result again."""

from types import SimpleNamespace

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import _layout

from tests.module import meshes
from tests.module.apart import distance, segments

SIZE = 256
TILES = range(1001, 1011)


def ring(n, inner):
    """Return the vertices and quads of a ring of n quads, radius 1."""
    angle = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    circle = np.c_[np.cos(angle), np.sin(angle)]
    k, next_k = np.arange(n), np.roll(np.arange(n), -1)
    return np.concatenate([circle, inner * circle]), np.c_[k, next_k, next_k + n, k + n]


def hook():
    """Return the vertices and quads of an island without symmetries."""
    uv = np.array([(0, 0), (1, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3), (0, 1)], float)
    return uv, np.array([(0, 1, 4, 7), (1, 2, 3, 4), (7, 4, 5, 6)])


def joined(*parts):
    """Join (uv, faces) into one map."""
    first = np.cumsum([0] + [len(uv) for uv, _ in parts])
    return np.concatenate([uv for uv, _ in parts]), np.concatenate([f + k for (_, f), k in zip(parts, first)])


def mixed(n=12, seed=1):
    """Return a map of rings and hooks of several sizes, anywhere."""
    rng = np.random.default_rng(seed)
    parts = []
    for k in range(n):
        uv, faces = ring(12, 0.6) if k % 3 == 0 else hook()
        turn = rng.uniform(0.0, 2.0 * np.pi)
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        parts.append((rng.uniform(0.5, 2.0) * uv @ rotation.T + 20.0 * rng.uniform(size=2), faces))
    return joined(*parts)


def covered(uv, faces, size=512, tiles=1):
    """Return how often each pixel's center is covered: (faces' island summed) (size, size * tiles) int."""
    x, y = np.meshgrid((np.arange(size * tiles) + 0.5) / size, (np.arange(size) + 0.5) / size)
    count = np.zeros(x.shape, int)
    for face in faces:
        inside = np.zeros(x.shape, bool)
        for a, b in zip(uv[face], uv[np.roll(face, -1)]):
            crosses = (a[1] > y) != (b[1] > y)
            with np.errstate(divide="ignore", invalid="ignore"):
                inside ^= crosses & (x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
        count += inside
    return count


def assert_apart(packed, faces, margin, size=SIZE, regions=((0.0, 0.0, 1.0, 1.0),)):
    """Assert that islands lie a margin apart and from the border, to a hundredth of a pixel, and none on another."""
    pixels = packed.uv * np.broadcast_to(size, 2)
    edges = [segments(pixels, faces[packed.islands == k]) for k in range(packed.islands.max() + 1)]
    for k, island in enumerate(edges):
        low, high = island.reshape(-1, 2).min(axis=0), island.reshape(-1, 2).max(axis=0)
        sides = np.array(regions) * np.tile(np.broadcast_to(size, 2), 2)
        gaps = np.minimum(low - sides[:, :2], sides[:, 2:] - high).min(axis=1)
        assert gaps.max() >= margin - 0.01
        for j in range(k):
            if packed.stack[j] != packed.stack[k]:
                assert distance(island, edges[j]) >= margin - 0.01
    representatives = np.isin(packed.islands, np.unique(packed.stack))
    assert covered(packed.uv, faces[representatives]).max() == 1


@pytest.mark.parametrize("margin", [0.0, 3.0, 12.5])
def test_islands_are_a_margin_apart(margin):
    uv, faces = mixed()
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=margin, steps=4)
    assert_apart(packed, faces, margin)
    assert packed.has_room.all()
    assert packed.steps == 4
    area = covered(packed.uv, faces).mean()
    assert packed.fill == pytest.approx(area, abs=0.01)


@pytest.mark.parametrize("rotation", ["free", "quarters", "none"])
def test_islands_keep_their_shape_and_turn_as_asked(rotation):
    uv, faces = mixed()
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=2.0, rotation=rotation)
    assert_apart(packed, faces, 2.0)
    linear = packed.motions[:, :, :2]
    squares = linear @ linear.transpose(0, 2, 1)
    assert squares == pytest.approx(packed.scale**2 * np.tile(np.eye(2), (12, 1, 1)), abs=1e-9)
    assert (np.linalg.det(linear) > 0.0).all()
    angle = np.degrees(np.arctan2(linear[:, 1, 0], linear[:, 0, 0]))
    step = {"free": 1e-9, "quarters": 90.0, "none": 360.0}[rotation]
    assert np.abs(angle - step * np.round(angle / step)).max() < 1e-6
    of_vertex = packed.motions[packed.islands[np.repeat(np.arange(len(faces)), 4)]]
    moved = np.einsum("vij,vj->vi", of_vertex[:, :, :2], uv[faces.ravel()]) + of_vertex[:, :, 2]
    assert moved == pytest.approx(packed.uv[faces.ravel()], abs=1e-9)


def test_shapes_fill_more_than_boxes():
    uv, faces = mixed(30)
    boxes = meshes.pack(uv, faces, texture_size=1024, margin=2.0, rotation="none")
    free = meshes.pack(uv, faces, texture_size=1024, margin=2.0)
    denser = meshes.pack(uv, faces, texture_size=1024, margin=2.0, steps=16)
    assert boxes.fill < free.fill <= denser.fill
    assert free.fill > 0.5


def test_small_islands_lie_in_holes():
    parts = [ring(48, 0.9)] + [(0.2 * hook()[0] + 5.0 * k, hook()[1]) for k in range(1, 4)]
    uv, faces = joined(*parts)
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=2.0)
    assert_apart(packed, faces, 2.0)
    radius = np.linalg.norm(packed.uv[:48] - packed.uv[:48].mean(axis=0), axis=1).max()
    assert radius > 0.45
    assert (np.linalg.norm(packed.uv[96:] - packed.uv[:48].mean(axis=0), axis=1) < radius).any()


def test_faces_that_stay_are_obstacles():
    uv, faces = mixed()
    stays = joined((0.1 * ring(16, 0.5)[0] + 0.5, ring(16, 0.5)[1]))
    uv, faces = joined((uv, faces), stays)
    islands = meshes.pack(uv, faces, texture_size=SIZE).islands
    islands = np.where(islands == islands[-1], -1, islands)
    packed = meshes.pack(uv, faces, islands=islands, texture_size=SIZE, margin=4.0)
    assert packed.uv[-32:].tobytes() == uv[-32:].tobytes()
    assert_apart(packed, faces, 4.0)
    obstacle = segments(packed.uv * SIZE, faces[islands < 0])
    assert min(distance(segments(packed.uv * SIZE, faces[islands == k]), obstacle) for k in range(12)) >= 4.0 - 0.01


def test_tiles_and_regions():
    uv, faces = mixed()
    two = meshes.pack(uv, faces, texture_size=SIZE, margin=2.0, tiles=[1002, 1011])
    regions = [(1.0, 0.0, 2.0, 1.0), (0.0, 1.0, 1.0, 2.0)]
    low = np.floor(two.uv)
    assert {tuple(tile) for tile in low.tolist()} == {(1.0, 0.0), (0.0, 1.0)}
    assert two.scale > meshes.pack(uv, faces, texture_size=SIZE, margin=2.0).scale
    again = meshes.pack(two.uv, faces, texture_size=SIZE, margin=2.0, regions=regions, keep_regions=True)
    assert (np.floor(again.uv) == low).all()
    part = meshes.pack(uv, faces, texture_size=(512, 128), margin=2.0, regions=[(0.25, 0.5, 0.75, 1.0)])
    pixels = part.uv * (512, 128)
    assert pixels.min(axis=0) == pytest.approx((130.0, 66.0), abs=3.0)
    assert (pixels.min(axis=0) >= (130.0 - 0.01, 66.0 - 0.01)).all()
    assert (pixels.max(axis=0) <= (382.0 + 0.01, 126.0 + 0.01)).all()


@pytest.mark.parametrize("scale", [True, False])
@pytest.mark.parametrize("beside", [[], [(2.0, 0.0, 3.0, 1.0)]], ids=["alone", "beside a tile"])
@pytest.mark.parametrize("width", [0.0040, 0.0042, 0.01])
def test_regions_hardly_wider_than_the_margin(width, beside, scale):
    """The first two are narrower than a cell of the search."""
    packed = meshes.pack(*mixed(), regions=[(0.0, 0.0, width, 1.0), *beside], scale=scale)
    assert np.isfinite(packed.uv).all()
    if scale:
        assert (packed.has_room == (bool(beside) or width == 0.01)).all()


@pytest.mark.parametrize(("margin", "texture_size"), [(0.0, 1024), (4.0, 16384)])
def test_the_only_region_is_narrower_than_a_cell(margin, texture_size):
    """Such islands are packed by their boxes alone."""
    width = (0.1 + 2.2 * margin) / texture_size
    packed = meshes.pack(*mixed(), margin=margin, texture_size=texture_size, regions=[(0.0, 0.0, width, 1.0)])
    assert packed.has_room.all()
    assert packed.scale > 0.0
    assert np.isfinite(packed.uv).all()


def stack_parts():
    uv, faces = hook()
    quarter = uv @ [[0.0, 1.0], [-1.0, 0.0]] + 10.0
    mirrored = uv * (-1.0, 1.0) + (30.0, 3.0)
    return joined((uv, faces), (quarter, faces), (mirrored, faces), (1.3 * uv + 50.0, faces), (uv + 1e-4, faces))


@pytest.mark.parametrize(
    ("stacks", "keep", "expected"),
    [
        ("none", False, [0, 1, 2, 3, 4]),
        ("none", True, [0, 1, 2, 3, 0]),
        ("equal", True, [0, 0, 2, 3, 0]),
        ("mirrored", True, [0, 0, 0, 3, 0]),
    ],
)
def test_equal_islands_lie_on_each_other(stacks, keep, expected):
    uv, faces = stack_parts()
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=2.0, stacks=stacks, keep_stacks=keep)
    groups = [np.flatnonzero(packed.stack == value).tolist() for value in np.unique(packed.stack)]
    assert sorted(groups) == sorted([[k for k in range(5) if expected[k] == e] for e in set(expected)])
    assert_apart(packed, faces, 2.0)
    for group in groups:
        outlines = [packed.uv[8 * k : 8 * k + 8] for k in group]
        for outline in outlines[1:]:
            assert np.abs(np.sort(outline, axis=0) - np.sort(outlines[0], axis=0)).max() < 0.01 * packed.scale * 5.0


def test_of_several_motions_within_the_tolerance_stacks_take_the_best():
    """A quarter turn of the card is within the tolerance, too."""
    card, parts = np.array([(0, 0), (1, 0), (1, 1.008), (0, 1.008)]), []
    for k, turn in enumerate([0.0, 0.2, 0.4, 1.0, 1.3, 2.0, 2.5]):
        rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        parts.append((card @ rotation + (3.0 * k, 0.0), np.array([range(4)])))
    packed = meshes.pack(*joined(*parts), stacks="equal")
    assert (packed.stack == packed.stack[0]).all()
    corners = packed.uv.reshape(-1, 4, 2)
    apart = np.linalg.norm(corners[:, :, None] - corners[packed.stack[0]], axis=3).min(axis=2).max(axis=1)
    assert (apart < 1e-5 * packed.scale).all()


@pytest.mark.parametrize("kept", [[0, 1], [2], [4], [3, 4]])
def test_some_islands_keep_their_turn_also_in_stacks(kept):
    uv, faces = stack_parts()
    keep_turn = np.isin(np.arange(5), kept)
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=2.0, stacks="mirrored", keep_turn=keep_turn)
    # Hooks 0 and 4 coincide, so both keep it.
    assert packed.stack[0] == packed.stack[4]
    assert packed.motions[keep_turn, 1, 0] == pytest.approx(0.0, abs=1e-6)
    assert (np.abs(packed.motions[:, 1, 0]) > 1e-3).any()
    assert_apart(packed, faces, 2.0)


def test_groups_move_as_one():
    uv, faces = joined(hook(), (hook()[0] + 5.0, hook()[1]), ring(8, 0.5))
    packed = meshes.pack(uv, faces, islands=np.repeat([0, 0, 1], [3, 3, 8]), texture_size=SIZE)
    assert packed.uv[8:16] - packed.uv[:8] == pytest.approx(np.tile(packed.uv[8] - packed.uv[0], (8, 1)))


@pytest.mark.parametrize("noise", [0.0, 0.01])
@pytest.mark.parametrize("stacks", ["equal", "mirrored"])
def test_stacks_that_were_packed_stay_at_their_scale(stacks, noise):
    """However many islands lie on each other, exactly or nearly so."""
    for seed in range(4):
        rng = np.random.default_rng(seed)
        parts = []
        for k in range(12):
            uv, faces = hook()
            uv = uv + noise * rng.uniform(-1.0, 1.0, uv.shape) if k < 8 else uv * rng.uniform(0.3, 0.9, 2)
            mirror = (-1.0, 1.0) if stacks == "mirrored" and k % 2 else (1.0, 1.0)
            turn = rng.uniform(0.0, 2.0 * np.pi)
            rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
            parts.append((uv * mirror @ rotation.T + rng.uniform(-9.0, 9.0, 2), faces))
        uv, faces = joined(*parts)
        options = {"texture_size": 1024, "margin": 4, "stacks": stacks}
        first = sc.pack(meshes.flat(uv, faces), **options)
        assert len(np.unique(first.stack)) == 5
        again = sc.pack(first, scale=False, **options)
        assert again.has_room.all()
        assert np.abs(again.uv - first.uv).max() < (1e-2 if noise else 1e-6)


def test_the_same_again_whatever_the_threads():
    uv, faces = mixed(20)
    results = []
    before = sc.limit_threads(0)
    for threads in (1, 2, 5):
        sc.limit_threads(threads)
        results.append(meshes.pack(uv, faces, texture_size=SIZE, steps=12, seed=3).uv.tobytes())
    sc.limit_threads(before)
    assert len(set(results)) == 1


def test_steps_continue_and_a_progress_function_ends_them():
    uv, faces = mixed(20)
    packer = sc.Packer(meshes.flat(uv, faces), texture_size=SIZE)
    fills = [packer.result.fill]
    for _ in range(3):
        assert packer.step(4)
        fills.append(packer.result.fill)
    assert fills == sorted(fills)
    assert packer.result.uv.tobytes() == sc.pack(meshes.flat(uv, faces), texture_size=SIZE, steps=12).uv.tobytes()
    with pytest.raises(sc.Cancelled):
        packer.step(progress=lambda fraction, phase: False)
    assert packer.result.fill >= fills[-1]
    assert packer.step(seconds=0.0)
    with pytest.raises(ValueError, match="step"):
        packer.step()


@pytest.mark.parametrize("steps", [0, 1, 6])
def test_no_more_tries_than_asked_for_and_one_progress_for_all(steps):
    uv, faces = mixed(20)
    fractions = []
    packed = meshes.pack(
        uv, faces, texture_size=SIZE, steps=steps, progress=lambda f, phase: fractions.append(f) or True
    )
    assert packed.steps == steps // 4 * 4
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


def test_tries_left_over_add_to_those_of_the_next_call():
    packer = sc.Packer(meshes.flat(*mixed(20)), texture_size=SIZE)
    done = []
    for _ in range(5):
        assert packer.step(1)
        done.append(packer.result.steps)
    assert done == [0, 0, 0, 4, 4]


@pytest.mark.parametrize("face", [[3, 3, 3], [3, 3, 4], [3]])
def test_faces_of_one_vertex_are_packed(face):
    uv = np.array([[0, 0], [1, 0], [0, 1], [0.2, 0.2], [0.3, 0.3]])
    packed = meshes.pack(uv, [[0, 1, 2], face], texture_size=SIZE)
    assert packed.has_room.all()
    ends = segments(packed.uv * SIZE, np.array([[0, 1, 2]]))
    assert distance(segments(packed.uv * SIZE, np.array([[3, 3 if face != [3, 3, 4] else 4]])), ends) >= 4.0 - 0.01


def test_a_quick_first_packing_is_one_and_the_first_step_makes_the_other():
    uv, faces = mixed(40)
    quick = sc.Packer(meshes.flat(uv, faces), texture_size=SIZE, margin=2.0, quick=True)
    assert_apart(SimpleNamespace(**{**vars(quick.result), "uv": meshes.by_vertex(quick.result, uv)}), faces, 2.0)
    first = sc.Packer(meshes.flat(uv, faces), texture_size=SIZE, margin=2.0).result
    assert quick.step(4)
    assert quick.result.fill == pytest.approx(first.fill)


def test_islands_of_any_size_and_none():
    uv, faces = mixed()
    packed = meshes.pack(uv, faces, texture_size=SIZE)
    # Powers of two change no digit.
    for factor in (2.0**-600, 2.0**600):
        assert meshes.pack(factor * uv, faces, texture_size=SIZE).uv == pytest.approx(packed.uv, abs=1e-9)
    point = meshes.pack(np.zeros((3, 2)), [[0, 1, 2]], texture_size=SIZE)
    assert np.isfinite(point.uv).all()
    assert meshes.pack(np.empty((0, 2)), []).uv.shape == (0, 2)
    crowded = meshes.pack(uv, faces, texture_size=SIZE, margin=200.0)
    assert not crowded.has_room.any()
    assert crowded.scale == 0.0
    assert crowded.uv.tobytes() == uv.tobytes()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"margin": -1.0}, "margin"),
        ({"margin": 256.0}, "margin"),
        ({"texture_size": 0}, "texture_size"),
        ({"tiles": [1000]}, "tiles"),
        ({"tiles": []}, "tiles"),
        ({"tiles": [1001, 1002, 1001]}, "1001 is repeated"),
        ({"regions": [(0.1, 0.1, 0.5, 0.4), (0.6, 0.0, 1.0, 1.0), (0.3, 0.2, 0.7, 0.9)]}, "0 and 2 do"),
        ({"regions": [(0.0, 0.0, 0.0, 1.0)]}, "regions"),
        ({"rotation": "any"}, "rotation"),
        ({"stacks": "all"}, "stacks"),
        ({"islands": [0, 0, 7]}, "islands"),
        ({"islands": [0, 0]}, "islands"),
        ({"stack_tolerance": 2.0}, "stack_tolerance"),
        ({"min_size": -1.0}, "min_size"),
        ({"min_size": np.inf}, "min_size must be finite"),
        ({"fewest": True}, "fewest needs scale=False"),
        ({"fewest": True, "scale": False, "keep_regions": True}, "fewest needs scale=False"),
    ],
)
def test_arguments_that_are_none(changes, message):
    uv, faces = hook()
    with pytest.raises(ValueError, match=message):
        meshes.pack(uv, faces, **{"texture_size": SIZE, **changes})


def test_tiles_are_a_sequence():
    with pytest.raises(TypeError, match="tiles must be a sequence of UDIM numbers, not 1001"):
        meshes.pack(*hook(), tiles=1001)


def test_an_island_needs_finite_points():
    uv, faces = hook()
    uv[3] = np.nan
    with pytest.raises(ValueError, match="finite"):
        meshes.pack(uv, faces)


def test_a_packed_map_stays_to_the_bit_if_nothing_denser_is_found():
    uv, faces = mixed()
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=2.0, steps=40)
    assert packed.scale > meshes.pack(uv, faces, texture_size=SIZE, margin=2.0).scale
    again = meshes.pack(packed.uv, faces, texture_size=SIZE, margin=2.0)
    assert again.scale == 1.0 and (again.uv == packed.uv).all()
    assert meshes.pack(packed.uv, faces, texture_size=SIZE, margin=3.0).scale < 1.0


def test_corners_of_islands_are_packed_as_their_points():
    # As the batch has them: each corner has a UV of its own, but the outline of an island is its border only.
    side, number = 15, 12
    quads = meshes.grid_quads(side, side)
    points = np.stack(np.divmod(np.arange(side**2), side), axis=1) * [1.0, 0.7]
    uv = np.concatenate([(1.0 + 0.1 * k) * points + [3.0 * side * k, 0.0] for k in range(number)])
    faces = np.concatenate([quads + len(points) * k for k in range(number)])
    islands = np.repeat(np.arange(number), len(quads))
    offsets = np.arange(0, 4 * len(faces) + 1, 4)
    by_points = meshes.pack(uv, faces, islands=islands, margin=2.0, keep_stacks=False)
    by_corners = _layout.packed_by_shape(uv[faces.ravel()], offsets, np.repeat(islands, 4), margin=2.0)
    assert by_corners.fill == by_points.fill
    assert np.array_equal(by_corners.uv, by_points.uv[faces.ravel()])


def crossing():
    """Two hooks that cross each other, one inside of the other's box, and a ring apart."""
    return joined(
        hook(), (hook()[0] * [-1, 1] + (3.5, 0.25), hook()[1][:, ::-1]), (ring(8, 0.5)[0] + 9.0, ring(8, 0.5)[1])
    )


def test_charts_of_an_unwrapping_do_not_overlap():
    """They lie about the origin."""
    charts = sc.pack(sc.unwrap(meshes.flat(*crossing())), keep_overlaps=True)
    assert charts.stack.tolist() == [0, 1, 2]


def box_islands(n=14, seed=3):
    rng = np.random.default_rng(seed)
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    return joined(*[(square * rng.uniform(0.3, 2.0, 2) + 5.0 * k, np.array([range(4)])) for k in range(n)])


@pytest.mark.parametrize("size", [SIZE, (512, 128)])
@pytest.mark.parametrize("margin", [0.0, 2.0])
def test_straight_borders_lie_between_pixels(size, margin):
    uv, faces = joined(box_islands(), (ring(40, 0.6)[0] + 99.0, ring(40, 0.6)[1]))
    packed = meshes.pack(uv, faces, texture_size=size, margin=margin, snap=True)
    corners = packed.uv[: 4 * 14] * np.broadcast_to(size, 2)
    assert (corners == np.round(corners)).all()
    assert_apart(packed, faces, margin, size)
    plain = meshes.pack(uv, faces, texture_size=size, margin=margin + 2**0.5)
    moved = np.abs(packed.uv - plain.uv) * np.broadcast_to(size, 2)
    assert moved.max() <= 0.5 + 1e-9
    assert not sc.map_defects(meshes.flat(packed.uv, faces), between_islands=True).overlapping.any()


def test_stacked_islands_snap_as_one():
    uv, faces = joined(hook(), hook(), (hook()[0] * [-1, 1] + 30.0, hook()[1][:, ::-1]))
    packed = meshes.pack(uv, faces, texture_size=SIZE, stacks="mirrored", snap=True, rotation="quarters")
    assert len(set(packed.stack)) == 1
    first, second, third = np.split(packed.uv, 3)
    assert np.array_equal(first, second)
    assert np.allclose(np.sort(first, axis=0), np.sort(third, axis=0), rtol=0, atol=1e-12)
    assert np.allclose(first * SIZE, np.round(first * SIZE), rtol=0, atol=1e-9)


@pytest.mark.parametrize(("size", "least"), [(0.08, 1), (0.3, 2), (0.5, 4)])
def test_tiles_are_found_for_a_given_size(size, least):
    uv, faces = box_islands()
    packed = meshes.pack(size * uv, faces, texture_size=SIZE, margin=2.0, scale=False, tiles=TILES, fewest=True)
    assert packed.has_room.all()
    area = np.prod([size * uv[4 * k + 2] - size * uv[4 * k] for k in range(14)], axis=1).sum()
    assert max(least, area) <= packed.n_tiles <= 1.5 * area + 1
    assert_apart(packed, faces, 2.0, regions=[(k, 0.0, k + 1.0, 1.0) for k in range(packed.n_tiles)])
    # One tile less has no room, as far as the first packing sees.
    if packed.n_tiles > 1:
        tiles = TILES[: packed.n_tiles - 1]
        fewer = meshes.pack(size * uv, faces, texture_size=SIZE, margin=2.0, scale=False, tiles=tiles)
        assert not fewer.has_room.all()


def test_no_more_tiles_are_filled_than_needed_however_many_islands_are_left_by_the_first():
    """Three islands that fill a tile each, and forty that fit into none of these but together into one more."""
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    sides = [0.9] * 3 + [0.12] * 40
    uv, faces = joined(*[(side * square + 2.0 * k, np.array([range(4)])) for k, side in enumerate(sides)])
    packed = meshes.pack(uv, faces, texture_size=SIZE, margin=1.0, scale=False, tiles=range(1001, 1101), fewest=True)
    assert packed.has_room.all() and packed.n_tiles == 4


def test_tiles_are_not_found_for_an_island_larger_than_one():
    uv, faces = box_islands()
    with pytest.raises(ValueError, match="islands? ha.* no room in a tile"):
        meshes.pack(0.7 * uv, faces, texture_size=SIZE, scale=False, tiles=TILES, fewest=True)
    with pytest.raises(ValueError, match="2 tiles have no room for"):
        meshes.pack(0.5 * uv, faces, texture_size=SIZE, scale=False, tiles=TILES[:2], fewest=True)


def test_the_number_of_tiles_is_told():
    uv, faces = mixed()
    assert meshes.pack(uv, faces).n_tiles == 1
    assert meshes.pack(uv, faces, tiles=[1003, 1011]).n_tiles == 2
    assert meshes.pack(uv, faces, regions=[(0, 0, 1, 1)]).n_tiles == 1
