# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve the islands of added, changed or removed constraints again, in place."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import bpy
import numpy as np

from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from . import following, seams


class Followed(NamedTuple):
    """What has followed.

    Attributes:
        reports: to the user, as (level, text) pairs.
        contradicting: the edges of each mesh whose constraints contradict each other, by their vertices.
        is_solved: whether any island was unwrapped.
    """

    reports: Sequence[tuple[str, str]]
    contradicting: dict[bpy.types.Mesh, list[tuple[int, int]]]
    is_solved: bool


def follow(context: bpy.types.Context, changed: Mapping[bpy.types.Mesh, np.ndarray], settings: Settings) -> Followed:
    """Unwrap the islands at the `changed` edges (N, 2) of each mesh with these settings, but in place.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    solving = seams.Follow(context, changed, settings, in_place=True)
    with following.not_following():
        result = solving.write()
    if result is None:
        return Followed([("WARNING", translate(texts.NO_FACE_AT_EDGES))], {}, is_solved=False)
    return Followed(result.reports, solving.contradicting, result.is_solved)
