# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the extenders of meshes in edit mode as arrows, in the 3D viewport and in the UV editor.

Arrows point outward if an extender repels, inward if it attracts. Their size on the screen does not depend on the zoom,
and they are in front of the mesh. In the UV editor, where a vertex may have several UVs, they connect the closest two.
"""

from collections.abc import Callable, Sequence

import bpy
import gpu
import numpy as np
from bmesh.types import BMVert
from bpy_extras import view3d_utils

from .. import names
from ..core.drawing import arrow_shapes
from ..core.words import texts
from ..edit_mesh import extenders as storage
from ..session import edit_meshes
from . import draw_handlers, lines

# Positions of both vertices on the screen, in pixels; None if one is hidden.
_Places = Sequence[Sequence[float]] | None

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
    places = _in_viewport if context.space_data.type == "VIEW_3D" else _in_uv_editor
    gpu.state.blend_set("ALPHA")
    for start, end, outward, fill, outline in _arrows(context, places):
        ends = arrow_shapes.arrow(start, end, outward, context.preferences.system.ui_scale).reshape(-1, 2)
        batch = lines.batch(np.pad(ends, ((0, 0), (0, 1))))
        lines.draw(context, [(batch, outline, _OUTLINE_WIDTH), (batch, fill, _WIDTH)])
    gpu.state.blend_set("NONE")


def _arrows(context: bpy.types.Context, places: Callable[..., _Places]) -> list[tuple]:
    """Return each arrow's start, end, whether it points outward, its color and its outline's; the active one last."""
    arrows = []
    for edit_object in context.objects_in_mode_unique_data:
        mesh = edit_object.data
        active = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY) if edit_object == context.edit_object else -1
        for index, (extender, ends) in enumerate(zip(storage.of(mesh), storage.vertices(mesh) or ())):
            found = None if None in ends else places(context, edit_object, ends)
            if found is None:
                continue
            repels, dim = extender.strength >= 0.0, 1.0 if extender.use else _DIMMED
            colors = [_REPEL if repels else _ATTRACT, _ACTIVE_OUTLINE if index == active else _OUTLINE]
            arrow = (*found, repels, *((*color[:3], color[3] * dim) for color in colors))
            arrows.insert(len(arrows) if index == active else 0, arrow)
    return arrows


def _in_viewport(context: bpy.types.Context, edit_object: bpy.types.Object, ends: Sequence[BMVert]) -> _Places:
    view = context.region, context.region_data
    points = [view3d_utils.location_3d_to_region_2d(*view, edit_object.matrix_world @ vertex.co) for vertex in ends]
    return None if None in points or any(vertex.hide for vertex in ends) else points


def _in_uv_editor(context: bpy.types.Context, edit_object: bpy.types.Object, ends: Sequence[BMVert]) -> _Places:
    layer, view = edit_meshes.kept(edit_object.data).bm.loops.layers.uv.active, context.region.view2d
    loops = [[loop for loop in vertex.link_loops if layer and not loop.face.hide] for vertex in ends]
    if not all(loops):
        return None
    copies = [np.array([loop[layer].uv[:] for loop in of_vertex]) for of_vertex in loops]
    return [view.view_to_region(*map(float, uv), clip=False) for uv in arrow_shapes.nearest_pair(*copies)]


def add_draw_handlers() -> None:
    """Start drawing."""
    for space in (bpy.types.SpaceView3D, bpy.types.SpaceImageEditor):
        draw_handlers.add(space, _draw, "POST_PIXEL", name=texts.EXTENDERS_LABEL)
