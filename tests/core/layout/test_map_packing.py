# SPDX-License-Identifier: GPL-3.0-or-later
"""Which islands of a map are packed, and which stay."""

from dataclasses import replace

import numpy as np
import pytest
from spectral_unwrap.core.errors import ReadableError
from spectral_unwrap.core.layout.map_packing import MapPacking, MapPackOptions
from spectral_unwrap.core.solve.progress import stepped
from spectral_unwrap.core.words.texts import packed

from tests.core.layout.test_shape_packing import raster, squares
from tests.module import meshes

ALL = np.ones(4, dtype=bool)
OPTIONS = MapPackOptions(side=512.0, rotation="free")
TILE = [(0.0, 0.0, 1.0, 1.0)]


def pack(meshes, chosen, options, steps):
    return stepped(MapPacking(meshes, chosen, options), steps)


def four():
    return squares((0.0, 0.0, 0.1, 0.3), (0.2, 0.0, 0.4, 0.2), (0.5, 0.5, 0.8, 0.6), (1.2, 0.0, 1.4, 0.3))


def moved(mesh, packing):
    return (packing.now().maps[0] != mesh.uv).any(axis=1).reshape(-1, 4).any(axis=1).tolist()


def test_islands_with_a_chosen_face_move_and_each_stays_in_its_tile():
    mesh = four()
    packing = pack([mesh], [np.array([True, True, False, True])], OPTIONS, 0)
    assert moved(mesh, packing) == [True, True, False, True]
    assert packing.corners[0].reshape(4, 4).all(axis=1).tolist() == [True, True, False, True]
    found = packing.now().maps[0]
    assert raster(found[:12]).max() == 1 and found[:12].max() <= 1.0
    assert found[12:, 0].min() >= 1.0


def test_pinned_and_hidden_islands_stay():
    mesh = replace(four(), pinned_corners=np.arange(16) == 5, selected_faces=np.array([True, True, True, False]))
    packing = pack([mesh], [np.array([True, True, True, False])], OPTIONS, 0)
    assert (packing.pinned, moved(mesh, packing)) == (1, [True, False, True, False])
    packing = pack([mesh], [ALL], replace(OPTIONS, hold_pinned=False), 0)
    assert (packing.pinned, moved(mesh, packing)) == (0, [True, True, True, False])
    packing = pack([mesh], [np.array([False, True, False, False])], OPTIONS, 5)
    assert (packing.pinned, packing.can_move) == (1, False)


def test_several_maps_fill_the_tiles_that_are_stated():
    meshes = [four(), four()]
    packing = pack(
        meshes, [ALL, ALL], replace(OPTIONS, regions=[(3.0, 1.0, 4.0, 2.0)], rotation="quarters", stacks="APART"), 2
    )
    found = packing.now()
    assert (found.islands, found.without_room) == (8, 0)
    together = np.concatenate(found.maps)
    assert raster(together, (3.0, 1.0)).max() == 1
    assert together.min(axis=0).tolist() >= [3.0, 1.0]
    assert raster(together, (3.0, 1.0)).mean() == pytest.approx(found.fill, abs=0.01)


def test_corners_without_finite_uvs_stay():
    mesh = four()
    mesh.uv[2] = np.nan
    packing = pack([mesh], [ALL], OPTIONS, 0)
    found = packing.now().maps[0]
    np.testing.assert_array_equal(found[:4], mesh.uv[:4])
    assert np.isfinite(found[4:]).all()


def test_a_margin_of_half_the_narrower_side_leaves_no_room():
    mesh = replace(four(), aspect=4.0)
    pack([mesh], [ALL], replace(OPTIONS, margin=127.0, regions=TILE), 0)
    with pytest.raises(ReadableError, match="A margin of 128 px leaves no room within 256 px"):
        pack([mesh], [ALL], replace(OPTIONS, margin=128.0), 0)


def test_packing_again_keeps_what_is_as_dense_and_says_so():
    mesh = four()
    options = replace(OPTIONS, regions=TILE)
    first = pack([mesh], [ALL], options, 40).now()
    # As Blender stores it.
    stored = replace(mesh, uv=first.maps[0].astype(np.float32).astype(np.float64))
    again = pack([stored], [ALL], options, 0).now()
    assert not first.is_kept and again.is_kept
    assert (again.maps[0] == stored.uv).all()
    assert packed(4, 0, 0.5, 1.0, True).startswith("Kept 4 islands as packed; no denser packing found")


def test_islands_of_a_group_move_as_one():
    mesh = four()
    groups = [np.array([7, 3, 3, 7])]
    packing = pack([mesh], [ALL], replace(OPTIONS, regions=TILE, groups=groups), 0)
    found = packing.now()
    assert (found.islands, found.without_room) == (2, 0)
    for pair in ([0, 3], [1, 2]):
        before, now = (uv.reshape(4, 4, 2)[pair].reshape(8, 2) for uv in (mesh.uv, found.maps[0]))
        assert meshes.similarity_deviation(now, before) < 1e-9
    # A pin holds the whole group.
    pinned = replace(mesh, pinned_corners=np.arange(16) == 5)
    packing = pack([pinned], [ALL], replace(OPTIONS, groups=groups), 0)
    assert (packing.pinned, moved(mesh, packing)) == (1, [True, False, False, True])


def test_the_bounding_box_of_the_islands_is_filled():
    mesh = four()
    options = replace(OPTIONS, regions="BOUNDS")
    found = pack([mesh], [ALL], options, 4).now()
    low, high = found.maps[0].min(axis=0), found.maps[0].max(axis=0)
    assert (low >= -1e-9).all() and (high <= np.array([1.4, 0.6]) + 1e-9).all()
    assert high[0] > 1.1
    assert options.fills_box and not replace(OPTIONS, regions=[*TILE, (1.0, 0.0, 2.0, 1.0)]).fills_box
    flat = squares((0.0, 0.0, 0.1, 0.0), (0.2, 0.0, 0.3, 0.0))
    with pytest.raises(ReadableError, match="within 8 px"):
        pack([flat], [np.ones(2, bool)], options, 0)


def test_only_islands_with_constraints_keep_their_turn():
    mesh = squares((0.0, 0.0, 0.9, 0.3), (0.0, 0.5, 0.3, 1.4))
    bound = replace(mesh, equations=np.array([[[1.0, 1.0], [3.0, -1.0], [0.0, 0.0], [0.0, 0.0]]]))
    second = np.array([False, True])
    for each, chosen, kept in ((mesh, ~second | second, 0), (bound, ~second | second, 1), (bound, second, 0)):
        packing = pack([each], [chosen], replace(OPTIONS, regions=TILE), 10)
        width, height = np.ptp(packing.now().maps[0].reshape(2, 4, 2), axis=1).T
        assert packing.kept_turns == kept
        # The two lie side by side as soon as one may turn.
        assert (width > height)[0] == (width > height)[1] or not chosen.all()
        assert not kept or width[0] > height[0]


@pytest.mark.parametrize("aspect", [1.0, 2.0])
def test_small_islands_are_enlarged_and_borders_get_to_those_of_pixels(aspect):
    """With an image of 1024 x 512 pixels, a square one with as many has a side of 724.1."""
    mesh = replace(
        squares((0.0, 0.0, 0.4, 0.4), (0.2, 0.1, 0.3, 0.6), (0.7, 0.7, 0.701, 0.701), (0.5, 0.0, 0.6, 0.1)),
        aspect=aspect,
    )
    size = np.array([1024.0, 1024.0 / aspect])
    options = replace(OPTIONS, side=float(np.prod(size)) ** 0.5, regions=TILE, rotation="none", min_size=9.0, snap=True)
    pixels = pack([mesh], [ALL], options, 0).now().maps[0] * size
    assert pixels == pytest.approx(np.round(pixels), abs=1e-9)
    assert np.ptp(pixels.reshape(4, 4, 2), axis=1).max(axis=1).min() >= 9.0
    assert np.ptp(pixels[8:12], axis=0).max() <= 10.0


def test_a_margin_that_leaves_room_but_for_whole_pixels_is_an_error_for_people():
    options = replace(OPTIONS, side=16.0, margin=7.0, regions=TILE)
    pack([four()], [ALL], options, 0)
    with pytest.raises(ReadableError, match="leaves no room"):
        pack([four()], [ALL], replace(options, snap=True), 0)
