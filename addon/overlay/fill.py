# SPDX-License-Identifier: GPL-3.0-or-later
"""Filled triangles on a region of the screen."""

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from .. import compatibility


def fill_triangles(corners: np.ndarray, colors: np.ndarray) -> None:
    """Fill triangles, with blending.

    Args:
        corners: (N, 2) in pixels of the region, three for each triangle.
        colors: (N, 4) red, green, blue and opacity of each corner, 0 to 1.
    """
    shader = gpu.shader.from_builtin(compatibility.SMOOTH_COLOR_SHADER)
    points = np.column_stack([corners, np.zeros(len(corners))])
    batch = batch_for_shader(
        shader, "TRIS", {"pos": points.astype(np.float32).tolist(), "color": colors.astype(np.float32).tolist()}
    )
    gpu.state.blend_set("ALPHA")
    try:
        batch.draw(shader)
    finally:
        gpu.state.blend_set("NONE")
