# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the wishes for seams on the edges of meshes in edit mode: where to cut, and where never."""

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from .. import compatibility, session
from ..core.words import texts
from ..edit_mesh import seam_wishes
from ..session import Lifetime, Remembered, edit_meshes
from . import draw_handlers
from .in_front import in_front_of_faces

# Neither that of seams (red), of sharp edges (cyan), of suggested seams (green), nor of selected edges (orange).
_COLORS = {seam_wishes.CUT: (1.0, 0.92, 0.1, 1.0), seam_wishes.NEVER: (0.75, 0.3, 1.0, 1.0)}
_WIDTH = 5.0


class WishLines(Remembered):
    """The lines read last: batches with their colors, by the full names of objects."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        """Read nothing yet."""
        self.batches: dict[str, list[tuple[gpu.types.GPUBatch, tuple[float, ...]]]] = {}


def on_update(depsgraph: bpy.types.Depsgraph) -> None:
    """Read the wishes again when they are drawn next, if Blender has updated a geometry."""
    read = session.of(WishLines).batches
    if read and any(update.is_updated_geometry for update in depsgraph.updates):
        read.clear()


def segments(mesh: bpy.types.Mesh) -> dict[int, np.ndarray]:
    """Return the ends of the visible edges with a wish, by wish: (2 n, 3) float32 in object space, edge after edge."""
    edges, wishes = seam_wishes.of_edges(mesh, only_visible=True)
    if not len(edges):
        return {}
    bm = edit_meshes.keep(mesh).bm
    bm.verts.ensure_lookup_table()
    found = {}
    for wish in _COLORS:
        points = [bm.verts[index].co[:] for index in edges[wishes == wish].ravel().tolist()]
        if points:
            found[wish] = np.array(points, dtype=np.float32)
    return found


def _draw(context: bpy.types.Context) -> None:
    if context.mode != "EDIT_MESH" or not context.space_data.overlay.show_overlays:
        return
    shader, known = gpu.shader.from_builtin(compatibility.LINE_SHADER), session.of(WishLines).batches
    shown = []
    for each in context.objects_in_mode_unique_data:
        if each.name_full not in known:
            lines = segments(each.data)
            known[each.name_full] = [
                (batch_for_shader(shader, "LINES", {"pos": points.tolist()}), _COLORS[wish])
                for wish, points in lines.items()
            ]
        if known[each.name_full]:
            shown.append((each.matrix_world, known[each.name_full]))
    if not shown:
        return
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", _WIDTH * context.preferences.system.ui_scale)
    with in_front_of_faces(context.region_data):
        gpu.state.depth_test_set("LESS_EQUAL")
        for matrix, batches in shown:
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(matrix)
                for batch, color in batches:
                    shader.uniform_float("color", color)
                    batch.draw(shader)


def add_draw_handlers() -> None:
    """Start drawing."""
    draw_handlers.add(bpy.types.SpaceView3D, _draw, "POST_VIEW", name=texts.SEAM_WISH_LABEL)
