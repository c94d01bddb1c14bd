# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap the meshes in edit mode again after seams were marked or cleared."""

import time
from collections.abc import Mapping

import bpy
import numpy as np

from ..unwrapping import outcome, steps
from ..unwrapping.last_settings import last_settings


def follow(context: bpy.types.Context, changed: Mapping[bpy.types.Mesh, np.ndarray]) -> bool:
    """Unwrap and pack all visible faces, as Blender does; with *Keep in Place*, only islands at changed seams.

    `changed` are the edges, (N, 2), whose seam has changed. Returns whether any island was solved.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        MarginError: the margin is not finite; nothing changed.
    """
    start, settings = time.perf_counter(), last_settings()
    edit_meshes = steps.read(context, settings, all_visible=True)
    if settings.keep_in_place:
        edit_meshes = steps.only_charts_at(edit_meshes, changed)
    solutions = steps.solve(edit_meshes, settings)
    written = steps.write(settings, edit_meshes, solutions)
    return outcome.finish(written, time.perf_counter() - start, others_stay=True).is_solved
