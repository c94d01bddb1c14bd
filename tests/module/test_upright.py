"""How the maps of `unwrap` are turned: mesh Z up, the same for every numbering and rounding of a mesh."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

ROOT_HALF = np.sqrt(0.5)


def tube(axis, away_from_seam, sides=16, rings=12):
    """The quads of an open tube of radius 1 and length 6 from the origin along `axis`, cut along its far side."""
    axis, front = (np.asarray(v, float) / np.linalg.norm(v) for v in (axis, away_from_seam))
    side = np.cross(axis, front)
    angle = np.linspace(-np.pi, np.pi, sides + 1)
    ring = np.cos(angle)[:, None] * front + np.sin(angle)[:, None] * side
    vertices = (
        np.linspace(0, 6, rings + 1)[:, None, None] * axis + (1 - 0.03 * np.arange(rings + 1))[:, None, None] * ring
    )
    # Vertex i (sides + 1) + j; outward, since the angle grows counterclockwise seen from the far end.
    return vertices.reshape(-1, 3), meshes.grid_quads(rings + 1, sides + 1)[:, ::-1]


def flat(columns, rows, x_axis, y_axis):
    """The quads of a flat grid of unit cells along two directions in space."""
    x, y = (a.ravel() for a in np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0), indexing="ij"))
    return np.outer(x, x_axis) + np.outer(y, y_axis), meshes.grid_quads(columns + 1, rows + 1)


def regular_polygon(n):
    """The triangles of a flat regular polygon, around its center."""
    angle = 2 * np.pi * np.arange(n) / n
    vertices = np.vstack([np.c_[np.cos(angle), np.sin(angle), 0 * angle], [[0, 0, 0]]])
    return vertices, np.array([(n, k, (k + 1) % n) for k in range(n)])


def unwrapped(vertices, faces):
    """The map per vertex, (V, 2), of a mesh that is one chart without seams."""
    offsets, corners = meshes.polygons(faces)
    uv = np.full((len(vertices), 2), np.nan)
    uv[corners] = sc.unwrap(vertices, offsets, corners).uv
    return uv


def rise(vertices, uv):
    """The direction, as an angle from up in degrees, in which the height grows in the map."""
    centered = uv - uv.mean(axis=0)
    u, v = np.linalg.lstsq(centered, vertices[:, 2] - vertices[:, 2].mean(), rcond=None)[0]
    return np.degrees(np.arctan2(u, v))


LIMBS = {
    "leg": ((0, 0, -1), (1, 0, 0)),
    "tower": ((0, 0, 1), (0, -1, 0)),
    "arm, hanging to the left": ((ROOT_HALF, 0, -ROOT_HALF), (0, -1, 0)),
    "arm, hanging to the right": ((-ROOT_HALF, 0, -ROOT_HALF), (0, -1, 0)),
}


@pytest.mark.parametrize("limb", LIMBS)
def test_limbs_stand(limb):
    vertices, faces = tube(*LIMBS[limb])
    uv = unwrapped(vertices, faces)
    assert abs(rise(vertices, uv)) < 20
    # The middle line between the seams lies straight up or down.
    middle = uv.reshape(13, 17, 2)[:, 8]
    along = middle[-1] - middle[0]
    assert abs(along[0]) < 1e-6 * abs(along[1])
    assert np.sign(along[1]) == np.sign(vertices[-1, 2] - vertices[0, 2])


def test_level_arm_lies_with_its_upper_side_up():
    vertices, faces = tube((1, 0, 0), (0, -1, 0))
    uv = unwrapped(vertices, faces)
    assert abs(rise(vertices, uv)) < 1
    assert np.ptp(uv, axis=0)[0] < np.ptp(uv, axis=0)[1] * 1.2


SHAPES = {
    "square on the floor": flat(5, 5, (1, 0, 0), (0, 1, 0)),
    "square wall": flat(5, 5, (0, 1, 0), (0, 0, 1)),
    "square wall on its corner": flat(5, 5, (ROOT_HALF, 0, ROOT_HALF), (-ROOT_HALF, 0, ROOT_HALF)),
    "plank at 45 degrees": flat(12, 3, (ROOT_HALF, 0, ROOT_HALF), (-ROOT_HALF, 0, ROOT_HALF)),
    "saddle": meshes.saddle_quads(9),
    "bulge": meshes.bulge(9, 1.0),
    "leg": tube(*LIMBS["leg"]),
    "level arm, seam below": tube((1, 0, 0), (0, 0, 1)),
    **{f"{n} sides": regular_polygon(n) for n in (3, 5, 6, 7, 8, 24)},
}


@pytest.mark.parametrize("shape", SHAPES)
def test_numbering_and_rounding_do_not_turn_the_map(shape):
    vertices, faces = SHAPES[shape]
    expected = unwrapped(vertices, faces)
    rng = np.random.default_rng(7)
    for _ in range(8):
        place = rng.permutation(len(vertices))
        renumbered = np.empty_like(vertices)
        # As noisy as single precision.
        renumbered[place] = vertices + 1e-7 * np.abs(vertices).max() * rng.normal(size=vertices.shape)
        cycled = [np.roll(place[face], rng.integers(len(face))) for face in rng.permutation(faces)]
        uv = unwrapped(renumbered, cycled)[place]
        assert np.abs(uv - expected).max() < 1e-4 * np.ptp(expected, axis=0).max()


def split(quads, diagonals):
    """The two triangles of every quad, along its first diagonal or its second."""
    turned = np.where(np.asarray(diagonals, bool)[:, None], np.roll(quads, -1, axis=1), quads)
    return np.vstack([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


@pytest.mark.parametrize("shape", [lambda s, t: 0.6 * s * t, lambda s, t: 0.4 * np.sin(np.pi * s) * np.sin(np.pi * t)])
def test_a_bent_square_does_not_stand_on_its_corner(shape):
    n = 6
    points, quads = meshes.unit_square(n + 1)
    s, t = points.T
    vertices = np.c_[s, shape(s, t), t]
    for diagonals in (np.zeros(n * n), np.ones(n * n)):
        uv = unwrapped(vertices, split(quads, diagonals))
        side = uv[[0, n, (n + 1) ** 2 - 1, n * (n + 1)]]
        sides = np.abs(np.diff(np.r_[side, side[:1]], axis=0))
        lean = np.degrees(np.arctan2(sides.min(axis=1), sides.max(axis=1)))
        assert lean.max() < 12
        # As much to the one side of the diagonal as to the other.
        assert np.ptp(np.sort(lean).reshape(2, 2), axis=1).max() < 0.01
