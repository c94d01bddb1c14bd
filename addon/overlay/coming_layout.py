# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout that unwrapping would give, drawn in the UV editors before anything is written."""

from collections.abc import Sequence

import bpy
import gpu
import numpy as np

from ..core.mesh.polygon_mesh import PolygonMesh
from . import lines
from .draw_handlers import Preview

# The color of suggested seams in the 3D viewport, less opaque, because every edge of every face is drawn.
_COLOR = (0.1, 1.0, 0.55, 0.5)
_WIDTH = 1.0


def outline(mesh: PolygonMesh, uv: np.ndarray, solved_corners: np.ndarray) -> np.ndarray:
    """Return the edges of the mapped faces as pairs of points, (2 n, 3) float32, given the UVs, (C, 2), of corners."""
    flat = np.column_stack([uv, np.zeros(len(uv))]).astype(np.float32)
    ends = np.stack([flat, flat[mesh.next_corner()]], axis=1)
    return ends[solved_corners].reshape(-1, 3)


def _shows_uvs(context: bpy.types.Context) -> bool:
    """Return whether a UV editor shows UVs, or would if the active mesh had a map, which the unwrap will add."""
    space = context.space_data
    if context.mode != "EDIT_MESH" or space.show_uvedit:
        return context.mode == "EDIT_MESH"
    is_render = space.image is not None and space.image.type in {"RENDER_RESULT", "COMPOSITING"}
    return space.mode == "UV" and not context.edit_object.data.uv_layers and not is_render


class ComingLayout(Preview):
    """The edges of a layout in all UV editors."""

    def __init__(self) -> None:
        """Show nothing yet."""
        super().__init__()
        self._lines: Sequence[np.ndarray] = ()
        self._batches: list[tuple] | None = None

    def show(self, context: bpy.types.Context, layout: Sequence[np.ndarray]) -> None:
        """Draw these pairs of points, (2 n, 3) each."""
        self._lines, self._batches = layout, None
        self.draw_in(context, bpy.types.SpaceImageEditor)

    def _draw(self, context: bpy.types.Context) -> None:
        if not _shows_uvs(context):
            return
        if self._batches is None:
            self._batches = [(lines.batch(each), _COLOR, _WIDTH) for each in self._lines if len(each)]
        gpu.state.blend_set("ALPHA")
        try:
            lines.draw(context, self._batches)
        finally:
            gpu.state.blend_set("NONE")
