# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the islands of added, changed or removed constraints again, in place."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ..core.solve.contradictions import contradicting_edges
from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from ..unwrapping import outcome, steps
from . import following


class Follow(NamedTuple):
    """What has followed.

    Attributes:
        reports: to the user, as (level, text) pairs.
        contradicting: the edges of each mesh whose constraints contradict each other, by their vertices.
        is_solved: whether any island was unwrapped.
    """

    reports: Sequence[tuple[str, str]]
    contradicting: dict[bpy.types.Mesh, list[tuple[int, int]]]
    is_solved: bool


def follow(context: bpy.types.Context, changed: Mapping[bpy.types.Mesh, np.ndarray], settings: Settings) -> Follow:
    """Unwrap the islands at the `changed` edges (N, 2) of each mesh with these settings, but in place.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    start, settings = time.perf_counter(), replace(settings, keep_in_place=True)
    edit_meshes = steps.only_charts_at(steps.read(context, settings, all_visible=True), changed)
    edit_meshes = [each for each in edit_meshes if each.polygons.selected_faces.any()]
    if not edit_meshes:
        return Follow([("WARNING", translate(texts.NO_FACE_AT_EDGES))], {}, is_solved=False)
    solved = steps.solve_and_place(edit_meshes, settings)
    with following.not_following():
        steps.write(edit_meshes, solved)
        seconds = time.perf_counter() - start
        result = outcome.finish(settings, edit_meshes, solved, seconds, others_stay=True)
    found = {each.mesh: contradicting_edges(solution) for each, solution in zip(edit_meshes, solved.solutions)}
    return Follow(result.reports, {mesh: edges for mesh, edges in found.items() if edges}, result.is_solved)
