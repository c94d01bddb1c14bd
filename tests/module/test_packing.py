# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes in a square."""

import numpy as np
import pytest
import spectral_conformal as sc


@pytest.mark.parametrize("sizes", [[[1.0, -1.0]], [[np.nan, 1.0]], [[np.inf, 1.0]], [[1.0, 2.0, 3.0]], [1.0, 2.0]])
def test_sizes_that_are_none(sizes):
    with pytest.raises(ValueError, match="sizes"):
        sc.hosts.pack_boxes(sizes)
