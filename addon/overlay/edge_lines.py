# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the marked edges of meshes in edit mode: constraints, also in the UV editor, and hints for seams."""

from functools import partial

import bpy
import gpu
import numpy as np
from bmesh.types import BMEdge, BMesh

from .. import names, session
from ..core.constraints import marks
from ..core.words import texts
from ..edit_mesh import constraints, seam_hints
from ..session import Lifetime, Remembered, edit_meshes, identity
from . import draw_handlers, lines
from .in_front import in_front_of_faces


class _EdgeLines(Remembered):
    """Base of the lines read last: batches with their colors and widths, by the object's key and whether in UVs.

    Attributes:
        colors: of lines, by marks.
        width: of all lines, in pixels.
    """

    lifetime = Lifetime.EDIT_MODE
    colors: dict[int, lines.Color]
    width: float

    def __init__(self) -> None:
        """Read nothing yet."""
        self.read: dict[tuple[int, bool], list[tuple[gpu.types.GPUBatch, lines.Color, float]]] = {}

    @staticmethod
    def layers(mesh: bpy.types.Mesh) -> list[str]:
        """Return the integer layers of a mesh that have the marks."""
        raise NotImplementedError

    def segments(self, mesh: bpy.types.Mesh, in_map: bool = False) -> dict[int, np.ndarray]:
        """Return the ends of the marked visible edges, by mark: (2 n, 3) float32, in object space or in the map."""
        layers, known = self.layers(mesh), edit_meshes.kept(mesh)
        if not layers or known is None:
            return {}
        bm = known.bm
        found: dict[int, list] = {mark: [] for mark in self.colors}
        for name in layers:
            layer = bm.edges.layers.int.get(name)
            for edge in bm.edges if layer is not None else ():
                if edge[layer] in found and not edge.hide:
                    found[edge[layer]] += _in_map(bm, edge) if in_map else [vertex.co[:] for vertex in edge.verts]
        return {mark: np.array(points, dtype=np.float32) for mark, points in found.items() if points}


def _in_map(bm: BMesh, edge: BMEdge) -> list[tuple[float, float, float]]:
    layer = bm.loops.layers.uv.active
    loops = [loop for loop in edge.link_loops if layer is not None and not loop.face.hide]
    return [(*end[layer].uv, 0.0) for loop in loops for end in (loop, loop.link_loop_next)]


class ConstraintLines(_EdgeLines):
    """The edges that constraints keep straight."""

    # Unlike seams, sharp, selected and hinted edges: rows green, columns blue, other lines pale, axes magenta.
    colors = {
        marks.HORIZONTAL: (0.35, 0.95, 0.45, 1.0),
        marks.VERTICAL: (0.35, 0.6, 1.0, 1.0),
        marks.SLANTED: (0.9, 0.95, 0.9, 1.0),
        marks.AXIS: (1.0, 0.3, 0.85, 1.0),
        marks.CROSSING: (1.0, 0.3, 0.85, 1.0),
    }
    width = 4.0

    @staticmethod
    def layers(mesh: bpy.types.Mesh) -> list[str]:
        """Return those of the constraints in use."""
        return [layer for layer, each in constraints.of(mesh) if each.use]


class HintLines(_EdgeLines):
    """The edges to cut, and those never to cut."""

    # Unlike seams (red), sharp edges (cyan), suggested seams (green) and selected edges (orange).
    colors = {seam_hints.CUT: (1.0, 0.92, 0.1, 1.0), seam_hints.NEVER: (0.75, 0.3, 1.0, 1.0)}
    width = 5.0

    @staticmethod
    def layers(mesh: bpy.types.Mesh) -> list[str]:
        """Return the one of the hints."""
        return [names.SEAM_HINT_ATTRIBUTE]


def on_update(depsgraph: bpy.types.Depsgraph) -> None:
    """Read the lines again when they are drawn next, if Blender has updated a geometry."""
    known = [session.of(kind).read for kind in (ConstraintLines, HintLines)]
    if any(known) and any(update.is_updated_geometry for update in depsgraph.updates):
        for read in known:
            read.clear()


def _draw(kind: type[_EdgeLines], context: bpy.types.Context) -> None:
    if not lines.is_shown(context):
        return
    in_map, of_kind = context.space_data.type != "VIEW_3D", session.of(kind)
    shown = []
    for each in context.objects_in_mode_unique_data:
        key = identity.key(each), in_map
        if key not in of_kind.read:
            segments = of_kind.segments(each.data, in_map)
            of_kind.read[key] = [(lines.batch(ends), kind.colors[mark], kind.width) for mark, ends in segments.items()]
        if of_kind.read[key]:
            shown.append((each.matrix_world, of_kind.read[key]))
    if in_map:
        for _, batches in shown:
            lines.draw(context, batches)
    elif shown:
        with in_front_of_faces(context.region_data):
            gpu.state.depth_test_set("LESS_EQUAL")
            for matrix, batches in shown:
                with gpu.matrix.push_pop():
                    gpu.matrix.multiply_matrix(matrix)
                    lines.draw(context, batches)


def add_draw_handlers() -> None:
    """Start drawing."""
    draw_handlers.add(bpy.types.SpaceView3D, partial(_draw, HintLines), "POST_VIEW", name=texts.SEAM_HINT_LABEL)
    for space in (bpy.types.SpaceView3D, bpy.types.SpaceImageEditor):
        draw_handlers.add(space, partial(_draw, ConstraintLines), "POST_VIEW", name=texts.SHAPE_PANEL_LABEL)
