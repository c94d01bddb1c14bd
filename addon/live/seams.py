# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap the meshes in edit mode again after seams or constraints have changed, or vertices have moved."""

import time
from collections.abc import Mapping
from dataclasses import replace

import bpy
import numpy as np

from .. import user_preferences
from ..core.solve.options import Settings
from ..core.solve.worker import Worker
from ..edit_mesh.read import EditMesh, unchanged
from ..unwrapping import outcome, steps


class Follow:
    """An unwrap of all visible faces; in place, of islands at changed edges only.

    It runs in a thread, because packing may take a second.

    Attributes:
        changed: the edges, (N, 2), of each mesh whose seam or constraint has changed, or whose ends have moved.
        settings: of the unwrap.
        in_place: whether it is in place although the settings may not be.
        scene: the scene in which they are edited.
    """

    def __init__(
        self,
        context: bpy.types.Context,
        changed: Mapping[bpy.types.Mesh, np.ndarray],
        settings: Settings,
        in_place: bool = False,
    ) -> None:
        """Read the meshes in edit mode, and start.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        self.changed, self.settings, self.in_place, self.scene = changed, settings, in_place, context.scene
        self._start = time.perf_counter()
        self._settings = settings = replace(settings, keep_in_place=settings.keep_in_place or in_place)
        self._read = edit_meshes = self._read_now(context)
        beside = steps.read_beside(context, settings, edit_meshes)
        self._worker = Worker(
            lambda progress: steps.solve_and_place(edit_meshes, settings, progress, beside),
            user_preferences.read("threads", 0),
        )

    def is_done(self, seconds: float) -> bool:
        """Wait up to `seconds` for the end of the work; return whether it has ended."""
        return self._worker.wait(seconds)

    def cancel(self) -> None:
        """Drop the work."""
        self._worker.cancel()

    def write(self) -> outcome.Outcome | None:
        """Wait for the end of the work and write it; return its outcome, None if there are no such faces.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            ReadableError: the margin is not finite; nothing changed.
        """
        solved = self._worker.result()
        if not self._read:
            # The report of the last unwrap stays.
            return None
        steps.write(self._read, solved)
        seconds = time.perf_counter() - self._start
        return outcome.finish(self._settings, self._read, solved, seconds, others_stay=True)

    def again(self, context: bpy.types.Context) -> "Follow | None":
        """Return itself if the meshes are as they were read, else a new start; None if their faces have changed."""
        if context.mode != "EDIT_MESH":
            return None
        if unchanged(self._read):
            return self
        now, before = ([each.polygons.topology for each in meshes] for meshes in (self._read_now(context), self._read))
        return Follow(context, self.changed, self.settings, self.in_place) if now == before else None

    def _read_now(self, context: bpy.types.Context) -> list[EditMesh]:
        edit_meshes = steps.read(context, self._settings, all_visible=True)
        if not self._settings.keep_in_place:
            return edit_meshes
        found = steps.only_charts_at(edit_meshes, self.changed)
        return [each for each in found if each.polygons.selected_faces.any()]
