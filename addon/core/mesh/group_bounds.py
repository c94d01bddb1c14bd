# SPDX-License-Identifier: GPL-3.0-or-later
"""The least and largest values of groups, such as the bounding boxes of islands."""

import numpy as np


def group_bounds(values: np.ndarray, group: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the least and the largest of the `values` (N, ...) of each of `count` groups, (count, ...) float64.

    `group` (N,) is the group of each value, -1 for none. A group without values has infinity and minus infinity.
    """
    inside = group >= 0
    low = np.full((count, *values.shape[1:]), np.inf)
    high = np.full_like(low, -np.inf)
    np.minimum.at(low, group[inside], values[inside])
    np.maximum.at(high, group[inside], values[inside])
    return low, high
