# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the extenders of meshes in edit mode as arrows, in the 3D viewport and in the UV editor.

Arrows point outward if an extender repels, inward if it attracts. Their size on the screen does not depend on the zoom,
and they are in front of the mesh. In the UV editor, where a vertex may have several UVs, they connect the closest two.
"""

from collections.abc import Callable, Iterator

import bpy
import gpu
import numpy as np
from bmesh.types import BMesh, BMVert
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader

from .. import compatibility
from ..core.drawing import arrow_shapes
from ..core.words import texts
from ..extenders import storage
from ..session import edit_meshes
from . import draw_handlers

_Point = tuple[float, float]
# Returns the positions of two vertices on the screen, in pixels; None if one is not shown.
_Places = Callable[[BMVert, BMVert], "tuple[_Point, _Point] | None"]

_REPEL = (1.0, 0.42, 0.12, 1.0)
_ATTRACT = (0.2, 0.66, 1.0, 1.0)
_OUTLINE = (0.0, 0.0, 0.0, 0.7)
_ACTIVE_OUTLINE = (1.0, 1.0, 1.0, 1.0)
_DIMMED = 0.3
# Width of the lines in pixels, and of their outline.
_WIDTH, _OUTLINE_WIDTH = 2.5, 5.5


def _draw_in_viewport(context: bpy.types.Context) -> None:
    if context.mode == "EDIT_MESH" and context.space_data.overlay.show_overlays:
        _draw(context, _places_in_viewport)


def _draw_in_uv_editor(context: bpy.types.Context) -> None:
    space = context.space_data
    if context.mode == "EDIT_MESH" and space.show_uvedit and space.overlay.show_overlays:
        _draw(context, _places_in_uv_editor)


def _draw(context: bpy.types.Context, places_of: Callable[..., _Places]) -> None:
    """Draw the arrows of all meshes in edit mode; the active one of the active object's mesh last, highlighted."""
    scale, shader = context.preferences.system.ui_scale, gpu.shader.from_builtin(compatibility.LINE_SHADER)
    gpu.state.blend_set("ALPHA")
    for start, end, outward, fill, outline in _arrows(context, places_of):
        lines = arrow_shapes.arrow(start, end, outward, scale).reshape(-1, 2)
        points = np.column_stack([lines, np.zeros(len(lines))]).tolist()
        batch = batch_for_shader(shader, "LINES", {"pos": points})
        shader.bind()
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        for width, color in ((_OUTLINE_WIDTH, outline), (_WIDTH, fill)):
            shader.uniform_float("lineWidth", width * scale)
            shader.uniform_float("color", color)
            batch.draw(shader)
    gpu.state.blend_set("NONE")


def _arrows(context: bpy.types.Context, places_of: Callable[..., _Places]) -> Iterator[tuple]:
    """Yield start, end, whether the arrow points outward, its color and that of its outline; the active one last."""
    last = []
    for edit_object in context.objects_in_mode_unique_data:
        mesh = edit_object.data
        vertices = storage.vertices(mesh) if storage.of(mesh) else None
        if vertices is None:
            continue
        places = places_of(context, edit_object, edit_meshes.kept(mesh).bm)
        active = storage.active_index(mesh) if edit_object == context.edit_object else -1
        for index, (extender, ends) in enumerate(zip(storage.of(mesh), vertices)):
            found = places(*ends) if None not in ends else None
            if found is None:
                continue
            colors = (
                _REPEL if extender.strength >= 0.0 else _ATTRACT,
                _ACTIVE_OUTLINE if index == active else _OUTLINE,
            )
            if not extender.use:
                colors = tuple((*color[:3], color[3] * _DIMMED) for color in colors)
            arrow = (*found, extender.strength >= 0.0, *colors)
            if index == active:
                last.append(arrow)
            else:
                yield arrow
    yield from last


def _places_in_viewport(context: bpy.types.Context, edit_object: bpy.types.Object, _bm: BMesh) -> _Places:
    region, view, world = context.region, context.region_data, edit_object.matrix_world

    def places(first: BMVert, second: BMVert) -> tuple[_Point, _Point] | None:
        if first.hide or second.hide:
            return None
        points = [view3d_utils.location_3d_to_region_2d(region, view, world @ v.co) for v in (first, second)]
        return None if None in points else tuple(map(tuple, points))

    return places


def _places_in_uv_editor(context: bpy.types.Context, _object: bpy.types.Object, bm: BMesh) -> _Places:
    layer, view = bm.loops.layers.uv.active, context.region.view2d

    def copies(vertex: BMVert) -> np.ndarray:
        return np.array([tuple(loop[layer].uv) for loop in vertex.link_loops if not loop.face.hide])

    def places(first: BMVert, second: BMVert) -> tuple[_Point, _Point] | None:
        uvs = [copies(vertex) for vertex in (first, second)] if layer is not None else [()]
        if not all(map(len, uvs)):
            return None
        return tuple(view.view_to_region(*map(float, uv), clip=False) for uv in arrow_shapes.nearest_pair(*uvs))

    return places


def add_draw_handlers() -> None:
    """Start drawing."""
    for space, draw in ((bpy.types.SpaceView3D, _draw_in_viewport), (bpy.types.SpaceImageEditor, _draw_in_uv_editor)):
        draw_handlers.add(space, draw, "POST_PIXEL", name=texts.EXTENDERS_LABEL)
