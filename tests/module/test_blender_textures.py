# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels for images of Blender, without Blender."""

import tracemalloc

import numpy as np
from spectral_conformal import _blender_textures


class Image:
    """Keeps what it gets, as Blender's images do."""

    def __init__(self):
        self.pixels = self

    def foreach_set(self, values):
        self.values = values

    def update(self):
        pass

    def pack(self):
        pass


def test_bytes_become_floats_from_the_bottom_and_take_no_further_memory():
    """Of 8192 x 8192 texels, the floats alone are a gigabyte."""
    pixels = np.random.default_rng(1).integers(0, 256, (512, 256, 4)).astype(np.uint8)
    image = Image()
    tracemalloc.start()
    _blender_textures.fill(image, pixels)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    np.testing.assert_array_equal(image.values.reshape(512, 256, 4), (pixels[::-1] / 255).astype(np.float32))
    assert peak < 1.1 * image.values.nbytes
