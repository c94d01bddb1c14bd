# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the edges that constraints keep straight, on meshes in edit mode and on their UVs."""

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from .. import compatibility, session
from ..core.constraints import marks
from ..core.words import texts
from ..edit_mesh import constraints
from ..session import Lifetime, Remembered, edit_meshes
from . import draw_handlers
from .in_front import in_front_of_faces

# Apart from those of seams, sharp, selected and wished edges: rows green, columns blue, other lines pale, axes magenta.
_COLORS = {
    marks.HORIZONTAL: (0.35, 0.95, 0.45, 1.0),
    marks.VERTICAL: (0.35, 0.6, 1.0, 1.0),
    marks.SLANTED: (0.9, 0.95, 0.9, 1.0),
    marks.AXIS: (1.0, 0.3, 0.85, 1.0),
}
_WIDTH = 4.0
_Batches = list[tuple[gpu.types.GPUBatch, tuple[float, ...]]]


class ConstraintLines(Remembered):
    """The lines read last: batches with their colors, by the full names of objects, on the mesh and on its UVs."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        """Read nothing yet."""
        self.on_mesh: dict[str, _Batches] = {}
        self.on_map: dict[str, _Batches] = {}


def on_update(depsgraph: bpy.types.Depsgraph) -> None:
    """Read the lines again when they are drawn next, if Blender has updated a geometry."""
    read = session.of(ConstraintLines)
    if (read.on_mesh or read.on_map) and any(update.is_updated_geometry for update in depsgraph.updates):
        read.on_mesh.clear()
        read.on_map.clear()


def segments(mesh: bpy.types.Mesh, in_map: bool) -> dict[int, np.ndarray]:
    """Return the ends of the marked visible edges, by mark: (2 n, 3) float32, in object space or in the map."""
    used = [layer for layer, each in constraints.of(mesh) if each.use]
    if not used:
        return {}
    bm = edit_meshes.keep(mesh).bm
    found: dict[int, list] = {mark: [] for mark in _COLORS}
    uv = bm.loops.layers.uv.active
    for name in used:
        layer = bm.edges.layers.int.get(name)
        for edge in bm.edges if layer is not None else ():
            points = found.get(edge[layer])
            if points is None or edge.hide:
                continue
            if not in_map:
                points += [vertex.co[:] for vertex in edge.verts]
            elif uv is not None:
                for loop in edge.link_loops:
                    if not loop.face.hide:
                        points += [(*loop[uv].uv, 0.0), (*loop.link_loop_next[uv].uv, 0.0)]
    return {mark: np.array(points, dtype=np.float32) for mark, points in found.items() if points}


def _draw(context: bpy.types.Context) -> None:
    space, in_map = context.space_data, context.space_data.type != "VIEW_3D"
    if context.mode != "EDIT_MESH" or not space.overlay.show_overlays or (in_map and not space.show_uvedit):
        return
    read = session.of(ConstraintLines)
    shader, known = gpu.shader.from_builtin(compatibility.LINE_SHADER), read.on_map if in_map else read.on_mesh
    shown = []
    for each in context.objects_in_mode_unique_data:
        if each.name_full not in known:
            known[each.name_full] = [
                (batch_for_shader(shader, "LINES", {"pos": points.tolist()}), _COLORS[mark])
                for mark, points in segments(each.data, in_map).items()
            ]
        shown += [(each.matrix_world, batch, color) for batch, color in known[each.name_full]]
    if not shown:
        return
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", _WIDTH * context.preferences.system.ui_scale)
    if in_map:
        for _, batch, color in shown:
            shader.uniform_float("color", color)
            batch.draw(shader)
        return
    with in_front_of_faces(context.region_data):
        gpu.state.depth_test_set("LESS_EQUAL")
        for matrix, batch, color in shown:
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(matrix)
                shader.uniform_float("color", color)
                batch.draw(shader)


def add_draw_handlers() -> None:
    """Start drawing."""
    for space in (bpy.types.SpaceView3D, bpy.types.SpaceImageEditor):
        draw_handlers.add(space, _draw, "POST_VIEW", name=texts.CONSTRAINTS_LABEL)
