# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a layout: pixels of triangles, their colors, the legend, the file."""

import numpy as np
import pytest
from spectral_conformal.batch import layout_picture
from spectral_conformal.batch.layout_picture import GOOD_TO_BAD

SIZE = 128
COLORS = np.rint(255.0 * np.array(GOOD_TO_BAD)).astype(int)


def drawn(uv, values, size=SIZE):
    picture = layout_picture.draw(np.array(uv, dtype=float), np.array(values, dtype=float), 1.0, 2.0, size)
    assert picture.shape == (size + 28, size, 3)
    return picture[:size]


def is_of(picture, color):
    return (picture == COLORS[color]).all(axis=2)


@pytest.mark.parametrize("turn", [1, -1])
def test_half_a_tile_is_covered_by_half_of_its_pixels(turn):
    picture = drawn([[(0, 0), (1, 0), (0, 1)][::turn]], [1.0])
    covered = is_of(picture, 0)
    assert covered.mean() == pytest.approx(0.5, abs=1.0 / SIZE)
    # The first row is the upper one.
    assert covered[-1].mean() > 0.95 and covered[0].mean() < 0.05 and covered[:, 0].mean() > 0.95


def test_many_small_triangles_cover_what_a_large_one_does():
    n = 200
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(n)))
    corners = lambda *at: np.stack([np.stack([i + a, j + b], axis=-1) / n for a, b in at], axis=1)  # noqa: E731
    uv = np.concatenate([corners((0, 0), (1, 0), (1, 1)), corners((0, 0), (1, 1), (0, 1))])
    assert is_of(drawn(uv, np.ones(len(uv))), 0).all()


def test_the_worst_is_seen_and_large_values_have_the_last_color():
    square = [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]]
    picture = drawn([*square, *square], [7.0, np.inf, 1.0, 1.0])
    assert is_of(picture, 2).all()
    assert is_of(drawn([*square, *square], [1.5, 1.5, 1.0, 1.0]), 1).all()


def test_what_lies_outside_of_the_tile_is_shown():
    covered = is_of(drawn([[(0, 0), (1, 0), (0, 1)], [(1, 1), (2, 1), (2, 2)]], [1.0, 1.0]), 0)
    assert covered.mean() == pytest.approx(0.25, abs=0.02)
    assert covered[: SIZE // 2, SIZE // 2 :].any()


def test_nothing_to_draw_and_values_that_are_not_finite():
    assert not is_of(drawn(np.empty((0, 3, 2)), []), 0).any()
    assert not is_of(drawn([[(0, 0), (1, 0), (np.nan, 1)]], [1.0]), 0).any()


def test_legend_goes_from_good_to_bad():
    picture = layout_picture.draw(np.empty((0, 3, 2)), np.empty(0), 1.0, 2.0, 512)
    ramp = picture[512 + 14, 64:-64].astype(int)
    assert (ramp[0] == COLORS[0]).all() and (ramp[-1] == COLORS[2]).all()
    bright = (picture[512:] > 200).all(axis=2)
    assert bright[:, :60].any() and bright[:, -60:].any()
    other = layout_picture.draw(np.empty((0, 3, 2)), np.empty(0), 1.0, 3.0, 512)
    assert (other[512:, -60:] != picture[512:, -60:]).any()


def test_file_is_a_png_with_these_pixels(tmp_path):
    from skimage.io import imread

    picture = np.random.default_rng(0).integers(0, 256, (20, 30, 3)).astype(np.uint8)
    path = tmp_path / "a.png"
    path.write_bytes(layout_picture.png(picture))
    assert (imread(path) == picture).all()


def test_thumbnail_is_made_of_means():
    picture = np.zeros((100, 100, 3), dtype=np.uint8)
    picture[:50] = 200
    small = layout_picture.thumbnail(picture, 10)
    assert small.shape == (10, 10, 3)
    assert (small[:5] == 200).all() and (small[5:] == 0).all()
