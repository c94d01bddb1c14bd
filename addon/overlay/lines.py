# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines over the editors, drawn by Blender's shader for them."""

from collections.abc import Iterable

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from .. import compatibility

Color = tuple[float, float, float, float]


def batch(points: np.ndarray) -> gpu.types.GPUBatch:
    """Return lines between pairs of `points`, (2 n, 3)."""
    shader = gpu.shader.from_builtin(compatibility.LINE_SHADER)
    return batch_for_shader(shader, "LINES", {"pos": np.ascontiguousarray(points, dtype=np.float32)})


def draw(context: bpy.types.Context, lines: Iterable[tuple[gpu.types.GPUBatch, Color, float]]) -> None:
    """Draw lines, each with its color and its width in pixels at the usual scale of the interface."""
    shader, scale = gpu.shader.from_builtin(compatibility.LINE_SHADER), context.preferences.system.ui_scale
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    for each, color, width in lines:
        shader.uniform_float("lineWidth", width * scale)
        shader.uniform_float("color", color)
        each.draw(shader)


def is_shown(context: bpy.types.Context) -> bool:
    """Return whether an editor shows meshes in edit mode, or their UVs, with overlays."""
    space = context.space_data
    return context.mode == "EDIT_MESH" and space.overlay.show_overlays and getattr(space, "show_uvedit", True)
