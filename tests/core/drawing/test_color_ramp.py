# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors that stand for values."""

import numpy as np
import pytest
from spectral_conformal.batch import layout_picture
from spectral_unwrap.core.drawing.color_ramp import GOOD_TO_BAD, colors_of, linear

RAMP = ((0.0, 0.0, 1.0), (1.0, 1.0, 0.0), (1.0, 0.0, 0.0))


def test_ends_and_middle():
    colors = colors_of(np.array([1.0, 2.0, 3.0]), 1.0, 3.0, RAMP)
    np.testing.assert_allclose(colors, [[0, 0, 1, 1], [1, 1, 0, 1], [1, 0, 0, 1]], atol=1e-12)


def test_beyond_the_ends_and_what_is_not_finite():
    values = np.array([-5.0, -np.inf, 9.0, np.inf, np.nan])
    colors = colors_of(values, 1.0, 3.0, RAMP)
    np.testing.assert_allclose(colors[:2, :3], [RAMP[0]] * 2)
    np.testing.assert_allclose(colors[2:, :3], [RAMP[2]] * 3)


def test_between_them_it_is_mixed_as_displayed():
    (color,) = colors_of(np.array([2.5]), 1.0, 3.0, RAMP)
    assert color[:3] == pytest.approx([1.0, float(linear(np.array(0.5))), 0.0])
    assert linear(np.array(0.5)) == pytest.approx(0.2140, abs=1e-4)


def test_pictures_of_the_batch_have_the_colors_of_the_overlay():
    """The add-on and the module's command share no file that both could import."""
    assert layout_picture.GOOD_TO_BAD == GOOD_TO_BAD
