# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested seams as lines in the 3D viewports, before they are marked."""

from collections.abc import Sequence

import bpy
import gpu
import numpy as np

from ..core.seams import suggestion as seam_suggestion
from ..core.seams.suggestion import Suggestion
from ..edit_mesh.read import EditMesh
from . import lines
from .draw_handlers import Preview
from .in_front import in_front_of_faces

_COLOR = (0.1, 1.0, 0.55)
# Width in pixels and opacity of the chosen cuts, and of the others.
_SHOWN = (4.0, 1.0)
_LEFT_OUT = (1.5, 0.5)
# Opacity of lines behind the mesh.
_THROUGH_MESH = 0.25


class SeamLines(Preview):
    """The cuts of a suggestion as lines in all 3D viewports."""

    def __init__(self, edit_meshes: Sequence[EditMesh]) -> None:
        """Show nothing yet."""
        super().__init__()
        self._edit_meshes = edit_meshes
        self._suggestion = Suggestion((), ())
        self._batches: list[tuple[gpu.types.GPUBatch, float, float]] | None = None
        self._count = 0

    def show(self, context: bpy.types.Context, suggestion: Suggestion, count: int) -> None:
        """Draw the first `count` cuts in full, the others fainter."""
        self._suggestion, self._count, self._batches = suggestion, count, None
        self.draw_in(context, bpy.types.SpaceView3D)

    def points(self, start: int, end: int) -> np.ndarray:
        """Return the ends of the edges of cuts `start` to `end` - 1 in world space, (2 n, 3), edge after edge."""
        cuts = self._suggestion.part(start, end)
        parts = [np.empty((0, 3))]
        for index, edit_mesh in enumerate(self._edit_meshes):
            world = np.array(edit_mesh.edit_object.matrix_world)
            ends = seam_suggestion.segments(edit_mesh.polygons, cuts.edges(index))
            parts.append(ends @ world[:3, :3].T + world[:3, 3])
        return np.concatenate(parts)

    def _draw(self, context: bpy.types.Context) -> None:
        if self._batches is None:
            total = len(self._suggestion.cuts)
            parts = ((self._count, total, *_LEFT_OUT), (0, self._count, *_SHOWN))
            self._batches = [
                (lines.batch(points), width, opacity)
                for start, end, width, opacity in parts
                if len(points := self.points(start, end))
            ]
        with in_front_of_faces(context.region_data):
            for depth_test, visibility in (("NONE", _THROUGH_MESH), ("LESS_EQUAL", 1.0)):
                gpu.state.depth_test_set(depth_test)
                colored = [(batch, (*_COLOR, opacity * visibility), width) for batch, width, opacity in self._batches]
                lines.draw(context, colored)
