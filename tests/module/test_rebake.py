# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures drawn for another map, against what the surface shows."""

import numpy as np
import pytest
import spectral_conformal as sc
from scipy import ndimage
from spectral_conformal import _map_change, _texture_levels
from spectral_conformal._map_change import MapChange, joined
from spectral_conformal._rebaking import Target
from spectral_conformal._texture_size import TextureSize
from spectral_conformal.assets import images
from spectral_conformal.assets.shared_textures import Picture, SharedTextures

from tests.module import meshes
from tests.module import textured_assets as made


def sheet(n):
    """(V, 2) a grid on the unit square, and its triangles."""
    points, quads = meshes.unit_square(n + 1)
    return points, meshes.triangles_of(quads)


def smooth(n, channels, seed=1, sigma=4):
    """An image of a repeating pattern, (n, n, channels), from 0 to 1."""
    noise = np.random.default_rng(seed).normal(size=(n, n, channels))
    found = ndimage.gaussian_filter(noise, (sigma, sigma, 0), mode="wrap")
    return (found - found.min()) / np.ptp(found)


def shown(image, uv):
    """(n, channels) what a repeated image shows at UVs, bilinearly."""
    height, width = image.shape[:2]
    rows, columns = (1 - uv[:, 1]) * height - 0.5, uv[:, 0] * width - 0.5
    return np.stack(
        [ndimage.map_coordinates(image[:, :, c].astype(float), [rows, columns], order=1, mode="grid-wrap")
         for c in range(image.shape[2])], axis=1,
    )  # fmt: skip


def places(triangles, n, seed=2):
    """Random points of triangles: (n,) triangles, (n, 3) barycentric coordinates."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, len(triangles), n), rng.dirichlet([2.0, 2.0, 2.0], n)


def at(values, triangles, where):
    number, weights = where
    return np.einsum("nk,nkd->nd", weights, values[triangles[number]])


@pytest.mark.parametrize("content", ["data", "color"])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
@pytest.mark.parametrize("channels", [None, 1, 2, 3, 4])
def test_the_same_map_gives_the_same_image(channels, dtype, content):
    rng = np.random.default_rng(3)
    shape = (60, 84) if channels is None else (60, 84, channels)
    image = (
        rng.random(shape).astype(dtype) if dtype == np.float32 else rng.integers(0, np.iinfo(dtype).max, shape, dtype)
    )
    points, triangles = sheet(7)
    baked = sc.rebake(image, points, points, triangles, content=content, opacity=channels in (2, 4))
    assert baked.covered.all()
    assert baked.image.dtype == dtype
    assert baked.image.shape == image.shape
    # Only the opacity is divided by, and that of floats is not a code.
    assert np.abs(baked.image - image.astype(float)).max() <= (1e-6 if dtype == np.float32 else 0)


def test_a_turned_island_shows_the_same():
    image = smooth(256, 3)
    points, triangles = sheet(5)
    cos, sin = np.cos(0.6), np.sin(0.6)
    moved = (points - 0.5) @ np.array([[cos, sin], [-sin, cos]]) * 0.65 + 0.5
    baked = sc.rebake(image, points, moved, triangles, size=512)
    where = places(triangles, 20000)
    before, after = shown(image, at(points, triangles, where)), shown(baked.image, at(moved, triangles, where))
    assert np.abs(before - after).max() < 0.02
    assert np.abs(before - after).mean() < 0.002


def test_what_is_repeated_is_drawn_as_often():
    """The old map reaches far beyond the tile, and its islands overlap."""
    image = smooth(64, 1)
    points, triangles = sheet(4)
    old = 3.5 * points - (7.2, -3.9)
    where = places(triangles, 20000)
    repeated = shown(sc.rebake(image, old, points, triangles, size=512).image, at(points, triangles, where))
    assert np.abs(repeated - shown(image, at(old, triangles, where))).max() < 0.03
    twice = np.r_[image, image[::-1]]
    mirrored = np.concatenate([twice, twice[:, ::-1]], axis=1)
    baked = sc.rebake(image, old, points, triangles, size=512, wrap="mirror")
    # Two tiles of the doubled image are a period; its lower half is the tile itself.
    doubled = shown(np.roll(mirrored, 64, axis=0), at(old, triangles, where) / 2)
    assert np.abs(shown(baked.image, at(points, triangles, where)) - doubled).max() < 0.03
    both = sc.rebake(image, old, points, triangles, size=512, wrap=("clamp", "repeat"))
    # Left of the tile, the first column continues.
    row = sc.rebake(np.repeat(image[:, :1], 64, axis=1), old, points, triangles, size=512)
    assert np.abs(both.image - row.image).max() < 1e-5


def test_nothing_is_left_beyond_a_decal():
    """An image that does not continue, in the middle of the new one, as opacity and colors."""
    image = np.ones((64, 64, 4), np.float32)
    points, triangles = sheet(4)
    baked = sc.rebake(image, 2.0 * points - 0.5, points, triangles, size=128, wrap="black", opacity=True).image
    # Of half of the size, so its border is that of texels.
    assert (baked[33:95, 33:95] == 1).all()
    assert not np.r_[baked[:31], baked[97:]].any()
    assert not np.c_[baked[:, :31], baked[:, 97:]].any()
    across = sc.rebake(image, 2.0 * points - 0.5, points, triangles, size=128, wrap=("clamp", "black")).image
    assert (across[33:95] == 1).all()
    assert not across[:31].any()


def in_levels(image, changes, size, monkeypatch):
    """Draw every other triangle for itself, as those that repeat an image often."""
    monkeypatch.setattr(_map_change, "levels", lambda *_: np.arange(len(changes.triangles)) // 2 % 2)
    monkeypatch.setattr(_map_change, "copies", lambda image, *_: [image, image])
    return _map_change.drawn(image, [changes], TextureSize("size", (size, size)), "data")[0].image


def in_an_atlas(image, changes, size, monkeypatch, folder):
    """Draw both halves as assets of their own."""
    shared = SharedTextures(folder, "props", TextureSize("size", (size, size)))
    for half in np.array_split(changes.triangles, 2):
        shared.add("data", Picture(lambda: image, [changes.part(half)], "data"), "half", pytest.fail)
    shared.draw()
    (texture,) = shared.all()
    return images.read(texture.content, ".png")


@pytest.mark.parametrize("how", ["alone", "levels", "atlas"])
def test_the_surface_shows_the_same_up_to_its_border(how, monkeypatch, tmp_path):
    """Points of a border lie between texels of which some have their centers outside of the island."""

    def turned(uv):
        return 0.55 * uv @ np.array([[0.8, 0.6], [-0.6, 0.8]]) + (0.4, 0.1)

    image = (smooth(64, 3, sigma=2) * 65535).astype(np.uint16)
    points, triangles = sheet(4)
    inside = 0.1 + 0.8 * points
    changes = MapChange(inside, turned(points), triangles, np.c_[points, 0 * points[:, :1]])
    if how == "alone":
        found = sc.rebake(image, inside, turned(points), triangles, size=256).image
    elif how == "levels":
        found = in_levels(image, changes, 256, monkeypatch)
    else:
        found = in_an_atlas(image, changes, 256, monkeypatch, tmp_path)
    along, zero = np.random.default_rng(3).random(2000), np.zeros(2000)
    rim = np.concatenate([np.c_[along, zero], np.c_[along, zero + 1], np.c_[zero, along], np.c_[zero + 1, along]])
    error = np.abs(shown(image, 0.1 + 0.8 * rim) - shown(found, turned(rim))) / 65535
    assert error.max() < 0.02
    assert error.mean() < 0.004


def test_texels_beside_an_island_are_none_of_it():
    points, triangles = sheet(4)
    moved = 0.55 * points @ np.array([[0.8, 0.6], [-0.6, 0.8]]) + (0.4, 0.1)
    baked = sc.rebake(np.ones((4, 4), np.uint8), points, moved, triangles, size=256)
    v, u = ((np.arange(256) + 0.5) / 256 for _ in range(2))
    from_corner = np.stack(np.meshgrid(u, 1 - v), axis=2) - (0.4, 0.1)
    own = from_corner @ np.array([[0.8, -0.6], [0.6, 0.8]]) / 0.55
    assert (baked.covered == ((own > 0) & (own < 1)).all(axis=2)).all()


def test_a_smaller_texture_has_the_means():
    image = np.random.default_rng(5).integers(0, 256, (256, 256, 3)).astype(np.uint8)
    points, triangles = sheet(3)
    baked = sc.rebake(image, points, points, triangles, size=64)
    means = image.reshape(64, 4, 64, 4, 3).mean(axis=(1, 3))
    assert np.abs(baked.image - means).max() <= 0.51
    light = sc.rebake(image, points, points, triangles, size=64, content="color")
    assert light.image.mean() > baked.image.mean() + 10


def test_a_mesh_finer_than_the_texture_counts_as_a_whole():
    """Each triangle covers a sixteenth of a texel, so that most cover no center of one."""
    points, triangles = sheet(96)
    stripes = (np.arange(len(points)) // 97 % 2).astype(float)[:, None]
    values = np.c_[stripes, 1 - stripes]
    baked = sc.bake_values(values, points, triangles, size=24, dtype=np.float32)
    assert baked.covered.all()
    assert np.abs(baked.image - 0.5).max() < 0.01


def on_sphere(n):
    """A sphere by longitude and latitude: positions, (unit) normals, UVs and triangles, split at the date line."""
    points, triangles = sheet(n)
    longitude, latitude = 2 * np.pi * points[:, 0], np.pi * (0.9 * points[:, 1] - 0.45)
    normals = np.c_[np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    return normals, normals, points, triangles


def in_space(image, uv, frames, triangles, where):
    """(n, 3) the normals that a texture gives at points of a surface."""
    normals, tangents = frames
    normal, tangent = (at(each, triangles, where) for each in (normals, tangents[:, :3]))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    tangent -= normal * (normal * tangent).sum(axis=1, keepdims=True)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    sign = at(tangents[:, 3:], triangles, where)
    value = 2 * shown(image, at(uv, triangles, where)) / (255 if image.dtype == np.uint8 else 65535) - 1
    found = value[:, :1] * tangent + value[:, 1:2] * sign * np.cross(normal, tangent) + value[:, 2:3] * normal
    return found / np.linalg.norm(found, axis=1, keepdims=True)


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_normals_stay_on_a_bumpy_sphere(is_mirrored):
    positions, normals, old, triangles = on_sphere(40)
    heights = smooth(512, 1, sigma=8)[:, :, 0]
    slopes = np.gradient(60 * heights, axis=(1, 0))
    bumps = np.stack([-slopes[0], slopes[1], np.ones_like(heights)], axis=2)
    bumps /= np.linalg.norm(bumps, axis=2, keepdims=True)
    assert np.degrees(np.arccos(bumps[:, :, 2])).mean() > 20
    image = np.rint(255 * (bumps + 1) / 2).astype(np.uint8)
    new = sc.parameterize(positions, triangles).uv @ np.array([[0.6, 0.8], [-0.8, 0.6]])
    new = (new - new.min(0)) / np.ptp(new, axis=0).max()
    if is_mirrored:
        new[:, 0] = 1 - new[:, 0]
    old_tangents, new_tangents = (sc.tangents(positions, triangles, uv, normals) for uv in (old, new))
    frames = {"normals": normals, "old_tangents": old_tangents, "new_tangents": new_tangents}
    baked = sc.rebake(image, old, new, triangles, size=1024, content="normals", **frames)
    where = places(triangles, 20000)
    before = in_space(image, old, (normals, old_tangents), triangles, where)
    after = in_space(baked.image, new, (normals, new_tangents), triangles, where)
    angle = np.degrees(np.arccos(np.clip((before * after).sum(axis=1), -1, 1)))
    assert np.percentile(angle, 99.9) < 2
    assert angle.mean() < 0.5
    # Copied without turning, they would be far off.
    copied = sc.rebake(image, old, new, triangles, size=1024)
    wrong = in_space(copied.image, new, (normals, new_tangents), triangles, where)
    assert np.degrees(np.arccos(np.clip((before * wrong).sum(axis=1), -1, 1))).mean() > 10


def test_vertex_colors_become_a_texture():
    vertices, triangles = meshes.bumpy_disk(2000)
    uv = sc.parameterize(vertices, triangles).uv
    uv = (uv - uv.min(0)) / np.ptp(uv, axis=0).max()
    colors = 0.5 + 0.5 * np.sin(vertices * [3, 5, 7] + [0, 1, 2])
    baked = sc.bake_values(np.c_[colors, np.ones(len(colors))], uv, triangles, size=512, dtype=np.uint16)
    where = places(triangles, 20000)
    error = np.abs(shown(baked.image, at(uv, triangles, where))[:, :3] / 65535 - at(colors, triangles, where))
    assert error.mean() < 0.001
    assert error.max() < 0.03
    assert (baked.image[:, :, 3] == 65535).all()


def test_the_result_depends_on_the_arguments_alone_and_can_be_cancelled():
    image = smooth(200, 4)
    points, triangles = sheet(30)
    moved = 0.5 + 0.4 * (points - 0.5) @ np.array([[1, 0.3], [-0.2, 1]])
    results = []
    for threads in (1, 2):
        before = sc.limit_threads(threads)
        results.append(sc.rebake(image, points, moved, triangles, content="color", opacity=True).image.tobytes())
        sc.limit_threads(before)
    assert results[0] == results[1]
    fractions = []
    sc.rebake(image, points, moved, triangles, progress=lambda fraction, phase: fractions.append(fraction))
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    with pytest.raises(sc.Cancelled):
        sc.rebake(image, points, moved, triangles, progress=lambda *_: False)


def test_the_work_follows_the_texels_of_both_textures():
    points, triangles = sheet(100)
    image = np.zeros((512, 512, 3), np.uint8)

    def samples(size):
        return sc._native.counted_work(lambda: sc.rebake(image, points, points, triangles, size=size))["steps"]

    assert samples(1024) == 1024**2
    assert samples(512) == 512**2
    assert samples(128) == 512**2


def repeated_floor(n, content):
    """A floor that shows an image n times along each side, and a strip beside it that shows it once."""
    (floor, first), (strip, second) = sheet(3), sheet(2)
    old = np.r_[n * floor, strip]
    new = np.r_[floor * (0.75, 1), strip * (0.25, 1) + (0.75, 0)]
    change = MapChange(old, new, np.r_[first, second + len(floor)], np.c_[new, 0 * new[:, :1]])
    return joined([change], content)


def lost_by_copies(image, content, footprint, side):
    """Return the mean and the largest error, of 255, of means over a footprint, (rows, columns), from a smaller copy.

    A texel of the copy is the mean of `side` by `side` texels, and interpolation blurs it by as much once more.
    """
    values = made._light(image / 255) if content == "color" else image / 255
    n = len(image) // side
    texels = values.reshape(n, side, n, side, -1).mean(axis=(1, 3)).repeat(side, 0).repeat(side, 1)
    copy = ndimage.uniform_filter(texels, (side, side, 1), mode="wrap")
    exact, found = (ndimage.uniform_filter(each, (*footprint, 1), mode="wrap") for each in (values, copy))
    if content == "color":
        exact, found = made._code(exact), made._code(found)
    elif content == "normals":
        exact, found = ((each - 0.5) / np.linalg.norm(2 * each - 1, axis=2, keepdims=True) for each in (exact, found))
    error = 255 * np.abs(exact - found)
    return error.mean(), error.max()


@pytest.mark.parametrize("content", ["data", "color", "normals"])
def test_what_is_repeated_very_often_shows_smaller_copies(content, monkeypatch):
    """With a bound on the samples the mean stays, and what is not repeated keeps its texels."""
    image = (smooth(128, 3, sigma=2) * 255).astype(np.uint8)
    if content == "normals":
        image[:, :, 2] = 128 + image[:, :, 2] // 2
    changes = repeated_floor(60, content)
    results, work = [], []
    for bound in (1 << 30, 1 << 18):
        monkeypatch.setattr(_texture_levels, "_MAX_SAMPLES", bound)
        target = Target((128, 128, 3), np.uint8)
        work += [sc._native.counted_work(lambda into=target: changes.drawn_onto(into, image, content))["steps"]]
        results.append(target.image.astype(float))
    assert work[0] > 10**7
    # Beside the copies themselves.
    assert work[1] < 2 * (1 << 18) + 128**2
    floor, strip = slice(None, 94), slice(98, None)
    assert np.array_equal(results[0][:, strip], results[1][:, strip])
    difference = np.abs(results[0] - results[1])[:, floor]
    # 16 samples of a texel reach over 80 columns and 60 rows of the image with texels of 32 by 32. Codes are rounded:
    # of both results, and of the copies.
    mean, largest = lost_by_copies(image, content, (60, 80), 32)
    assert difference.mean() < mean + 0.5
    assert difference.max() < largest + 1.5


def test_samples_are_bounded_however_often_an_image_is_repeated():
    points, triangles = sheet(3)
    for n, side in ((1, 4096), (100, 1024), (1e6, 8192)):
        found = _texture_levels.levels(n * points, points, triangles, (side, side), (8192, 8192))
        rate = np.ceil(n * side / 8192 / 2.0 ** found.max())
        assert 8192**2 * rate**2 <= 1.01 * _texture_levels._MAX_SAMPLES or 2 ** found.max() == side
    assert not _texture_levels.levels(points, points, triangles, (4096, 4096), (8192, 8192)).any()


POINTS, TRIANGLES = sheet(2)
GOOD = {"image": np.zeros((4, 4, 3), np.uint8), "old_uv": POINTS, "new_uv": POINTS, "triangles": TRIANGLES}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"image": np.zeros((4, 4, 5), np.uint8)}, "up to 4 channels"),
        ({"image": np.zeros((0, 4, 3), np.uint8)}, "sides from 1 to 65535"),
        ({"image": np.zeros((1, 70000), np.uint8)}, "sides from 1 to 65535"),
        ({"old_uv": POINTS[1:]}, "old_uv has 8 rows"),
        ({"triangles": TRIANGLES + 1}, "triangles has the vertex 9"),
        ({"size": 0}, "size must lie between 1"),
        ({"size": (1, 2, 3)}, "size must be one side"),
        ({"content": "colour"}, "content must be one of data, color, normals"),
        ({"wrap": "never"}, "wrap must be one of repeat, mirror, clamp"),
        ({"wrap": ("repeat",) * 3}, "or two of them"),
        ({"content": "normals"}, "but normals is missing"),
        ({"content": "normals", "normals": np.zeros((3, 3))}, "normals has 3 rows"),
    ],
)
def test_wrong_arguments_are_named(changes, said):
    with pytest.raises(ValueError, match=said):
        sc.rebake(**{**GOOD, **changes})


def test_wrong_types_are_named():
    with pytest.raises(TypeError, match="image must hold bytes, 16-bit numbers or floats, not int64"):
        sc.rebake(**{**GOOD, "image": np.zeros((4, 4), int)})
    with pytest.raises(ValueError, match="dtype must be uint8, uint16 or float32, not int16"):
        sc.bake_values(POINTS, POINTS, TRIANGLES, size=4, dtype=np.int16)
    with pytest.raises(ValueError, match="values has 8 rows"):
        sc.bake_values(POINTS[1:], POINTS, TRIANGLES, size=4)


def test_nothing_to_draw_leaves_zeros():
    baked = sc.rebake(**{**GOOD, "new_uv": POINTS + 5})
    assert not baked.covered.any()
    assert not baked.image.any()


@pytest.mark.parametrize("seed", range(40))
def test_any_maps_give_values_between_those_of_the_image(seed):
    """Huge and tiny UVs, needles, points, triangles on each other and beyond the image, and any sizes."""
    rng = np.random.default_rng(seed)
    dtype, channels = rng.choice([np.uint8, np.uint16, np.float32]), int(rng.integers(1, 5))
    shape = (*rng.integers(1, 40, 2).tolist(), channels)
    image = rng.uniform(0.25, 0.75, shape)
    image = image.astype(dtype) if dtype == np.float32 else (image * np.iinfo(dtype).max).astype(dtype)
    n = int(rng.integers(3, 60))
    old, new = (rng.normal(size=(n, 2)) * 10.0 ** rng.uniform(-6, 6, 2) + rng.normal(size=2) for _ in range(2))
    for uv in (old, new):
        uv[rng.random(n) < 0.1] = rng.choice([np.nan, np.inf, 1e300, 0.0])
        uv[rng.random(n) < 0.2] = 0.5
    arguments = {
        "content": str(rng.choice(["data", "color"])),
        "opacity": bool(rng.random() < 0.5),
        "nearest": bool(rng.random() < 0.3),
        "wrap": tuple(rng.choice(["repeat", "mirror", "clamp", "black"], 2).tolist()),
        "size": tuple(rng.integers(1, 90, 2).tolist()),
    }
    triangles = rng.integers(0, n, (int(rng.integers(0, 60)), 3))
    baked = sc.rebake(image, old, new, triangles, **arguments)
    assert baked.image.shape == (*arguments["size"][::-1], channels)
    if baked.covered.any():
        slack = 1e-4 if dtype == np.float32 else 1
        low, high = (each.astype(float) for each in (image.min(axis=(0, 1)), image.max(axis=(0, 1))))
        low = 0.0 if "black" in arguments["wrap"] else low
        assert (baked.image >= low - slack).all() and (baked.image <= high + slack).all()
    again = sc.rebake(image, old, new, triangles, **arguments)
    assert again.image.tobytes() == baked.image.tobytes()
