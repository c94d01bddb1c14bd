# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the islands of added, changed or removed constraints again, in place."""

import time
from collections.abc import Mapping
from dataclasses import replace

import bpy
import numpy as np

from ..unwrapping import outcome, steps
from ..unwrapping.last_settings import last_settings
from . import following


def follow(context: bpy.types.Context, changed: Mapping[bpy.types.Mesh, np.ndarray]) -> list[tuple[str, str]]:
    """Unwrap the islands at the `changed` edges (N, 2) of each mesh, in place; return the reports with their levels.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    start, settings = time.perf_counter(), replace(last_settings(), keep_in_place=True)
    edit_meshes = steps.only_charts_at(steps.read(context, settings, all_visible=True), changed)
    edit_meshes = [each for each in edit_meshes if each.polygons.selected_faces.any()]
    solutions = steps.solve(edit_meshes, settings)
    written = steps.write(settings, edit_meshes, solutions, following.not_following)
    return outcome.finish(written, time.perf_counter() - start, others_stay=True).reports


def follow_if_live(context: bpy.types.Context, changed: Mapping[bpy.types.Mesh, np.ndarray]) -> list[tuple[str, str]]:
    """`follow` where live unwrapping is on."""
    return follow(context, changed) if following.is_on(context.scene) else []
