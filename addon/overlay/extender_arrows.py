# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the extenders of meshes in edit mode as arrows, in the 3D viewport and in the UV editor.

Arrows point outward if an extender repels, inward if it attracts. Their size on the screen does not depend on the zoom,
and they are in front of the mesh. In the UV editor, where a vertex may have several UVs, they connect the closest two.
"""

from collections.abc import Sequence

import bpy
import gpu
import numpy as np
from bmesh.types import BMVert
from bpy_extras import view3d_utils

from .. import names
from ..core.drawing import arrow_shapes
from ..core.words import texts
from ..edit_mesh import extenders as storage
from ..edit_mesh import shapes
from ..session import edit_meshes
from . import draw_handlers, lines

_REPEL = (1.0, 0.42, 0.12, 1.0)
_ATTRACT = (0.2, 0.66, 1.0, 1.0)
_OUTLINE = (0.0, 0.0, 0.0, 0.7)
_ACTIVE_OUTLINE = (1.0, 1.0, 1.0, 1.0)
_DIMMED = 0.3
# Width of the lines in pixels, and of their outline.
_WIDTH, _OUTLINE_WIDTH = 2.5, 5.5


def _draw(context: bpy.types.Context) -> None:
    """Draw the arrows of all meshes in edit mode."""
    if not lines.is_shown(context):
        return
    gpu.state.blend_set("ALPHA")
    for start, end, outward, fill, outline in _arrows(context):
        ends = arrow_shapes.arrow(start, end, outward, context.preferences.system.ui_scale).reshape(-1, 2)
        batch = lines.batch(np.pad(ends, ((0, 0), (0, 1))))
        lines.draw(context, [(batch, outline, _OUTLINE_WIDTH), (batch, fill, _WIDTH)])
    gpu.state.blend_set("NONE")


def _arrows(context: bpy.types.Context) -> list[tuple]:
    """Return each arrow's start, end, whether it points outward, its color and its outline's; the active one last."""
    arrows = []
    for edit_object in context.objects_in_mode_unique_data:
        mesh = edit_object.data
        index, listed = getattr(mesh, names.ACTIVE_SHAPE_PROPERTY), shapes.listed(mesh)
        is_of_panel = edit_object == context.edit_object and index < len(listed)
        active = listed[index].layer if is_of_panel else ""
        for (layer, extender), ends in zip(storage.of(mesh), storage.vertices(mesh) or ()):
            points = [_on_screen(context, edit_object, vertex) if vertex else [] for vertex in ends]
            if not all(points):
                continue
            repels, dim = extender.strength >= 0.0, 1.0 if extender.use else _DIMMED
            colors = [_REPEL if repels else _ATTRACT, _ACTIVE_OUTLINE if layer == active else _OUTLINE]
            arrow = (*arrow_shapes.nearest_pair(*points), repels, *((*color[:3], color[3] * dim) for color in colors))
            arrows.insert(len(arrows) if layer == active else 0, arrow)
    return arrows


def _on_screen(context: bpy.types.Context, edit_object: bpy.types.Object, vertex: BMVert) -> list[Sequence[float]]:
    """Return the visible positions of a vertex in the region, in pixels: one, or in the UV editor one per corner."""
    region = context.region
    if context.space_data.type == "VIEW_3D":
        world = edit_object.matrix_world @ vertex.co
        point = view3d_utils.location_3d_to_region_2d(region, context.region_data, world)
        return [] if point is None or vertex.hide else [point]
    layer = edit_meshes.kept(edit_object.data).bm.loops.layers.uv.active
    loops = [loop for loop in vertex.link_loops if layer and not loop.face.hide]
    return [region.view2d.view_to_region(*loop[layer].uv, clip=False) for loop in loops]


def add_draw_handlers() -> None:
    """Start drawing."""
    for space in (bpy.types.SpaceView3D, bpy.types.SpaceImageEditor):
        draw_handlers.add(space, _draw, "POST_PIXEL", name=texts.EXTENDERS_LABEL)
