# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the extenders of meshes in edit mode as arrows, in the 3D viewport and in the UV editor.

Arrows point outward where an extender repels, inward where it attracts. They have the same size on the screen whatever
the zoom, and stand in front of the mesh. In the UV editor, where a vertex may have several UVs, the nearest two of both
vertices are connected.
"""

from collections.abc import Callable, Iterator

import bpy
import numpy as np
from bmesh.types import BMVert
from bpy_extras import view3d_utils

from ..core.drawing import arrow_shapes
from ..core.drawing.arrow_shapes import ArrowSize
from ..core.words import texts
from ..extenders import storage, tracking
from ..extenders.tracking import Track
from . import draw_handlers
from .fill import fill_triangles

_Point = tuple[float, float]
# A function that returns the places on the screen, in pixels, of two vertices of a mesh; None where one is not shown.
_Places = Callable[[BMVert, BMVert], "tuple[_Point, _Point] | None"]

_REPEL = (1.0, 0.42, 0.12, 1.0)
_ATTRACT = (0.2, 0.66, 1.0, 1.0)
_OUTLINE = (0.0, 0.0, 0.0, 0.7)
_ACTIVE_OUTLINE = (1.0, 1.0, 1.0, 1.0)
_DIMMED = 0.3
_SIZE = ArrowSize()
_OUTLINE_PIXELS = 1.5


def _draw_in_viewport(context: bpy.types.Context) -> None:
    if context.mode == "EDIT_MESH" and context.space_data.overlay.show_overlays:
        _draw(context, _places_in_viewport)


def _draw_in_uv_editor(context: bpy.types.Context) -> None:
    space = context.space_data
    if context.mode == "EDIT_MESH" and space.show_uvedit and space.overlay.show_overlays:
        _draw(context, _places_in_uv_editor)


def _draw(context: bpy.types.Context, places_of: Callable[..., _Places]) -> None:
    """Draw the arrows of all meshes in edit mode; the active one of the active object's mesh last, highlighted."""
    corners, colors = _triangles(context, places_of)
    if len(corners):
        fill_triangles(corners, colors)


def _triangles(context: bpy.types.Context, places_of: Callable[..., _Places]) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners (N, 2) of the triangles to fill, in pixels, and their colours (N, 4)."""
    scale = context.preferences.system.ui_scale
    sizes = [
        ArrowSize(_SIZE.shaft, _SIZE.head_length, _SIZE.head_width, margin).scaled(scale)
        for margin in (_OUTLINE_PIXELS, 0.0)
    ]
    corners, colors = [np.empty((0, 2))], [np.empty((0, 4))]
    for start, end, outward, fill, outline in _arrows(context, places_of):
        for size, color in zip(sizes, (outline, fill)):
            points = arrow_shapes.arrow(start, end, outward, size).reshape(-1, 2)
            corners.append(points)
            colors.append(np.tile(color, (len(points), 1)))
    return np.concatenate(corners), np.concatenate(colors)


def _arrows(context: bpy.types.Context, places_of: Callable[..., _Places]) -> Iterator[tuple]:
    """Yield start, end, whether the arrow points outward, its colour and that of its outline; the active one last."""
    last = []
    for edit_object in context.objects_in_mode_unique_data:
        mesh = edit_object.data
        if not storage.of(mesh):
            continue
        track = tracking.track(mesh)
        if track is None:
            continue
        places = places_of(context, edit_object, track)
        active = storage.active_index(mesh) if edit_object == context.edit_object else -1
        for index, (extender, ends) in enumerate(zip(storage.of(mesh), track.ends)):
            found = places(*ends) if None not in ends else None
            if found is None:
                continue
            arrow = (*found, extender.strength >= 0.0, *_colors(extender, index == active))
            if index == active:
                last.append(arrow)
            else:
                yield arrow
    yield from last


def _colors(extender: bpy.types.PropertyGroup, is_active: bool) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the colour of an arrow and of its outline; those of an extender that is off are dimmed."""
    pair = (_REPEL if extender.strength >= 0.0 else _ATTRACT, _ACTIVE_OUTLINE if is_active else _OUTLINE)
    return tuple(color if extender.use else (*color[:3], color[3] * _DIMMED) for color in pair)


def _places_in_viewport(context: bpy.types.Context, edit_object: bpy.types.Object, _track: Track) -> _Places:
    region, view, world = context.region, context.region_data, edit_object.matrix_world

    def places(first: BMVert, second: BMVert) -> tuple[_Point, _Point] | None:
        if first.hide or second.hide:
            return None
        points = [view3d_utils.location_3d_to_region_2d(region, view, world @ v.co) for v in (first, second)]
        return None if None in points else tuple(map(tuple, points))

    return places


def _places_in_uv_editor(context: bpy.types.Context, _object: bpy.types.Object, track: Track) -> _Places:
    layer = track.bm.loops.layers.uv.active
    view = context.region.view2d

    def copies(vertex: BMVert) -> np.ndarray:
        return np.array([tuple(loop[layer].uv) for loop in vertex.link_loops if not loop.face.hide])

    def places(first: BMVert, second: BMVert) -> tuple[_Point, _Point] | None:
        uvs = [copies(vertex) for vertex in (first, second)] if layer is not None else []
        if not all(map(len, uvs)) or not uvs:
            return None
        nearest = arrow_shapes.nearest_pair(*uvs)
        return tuple(view.view_to_region(*map(float, uv), clip=False) for uv in nearest)

    return places


def add_draw_handlers() -> None:
    """Draw from now on."""
    for space, draw in ((bpy.types.SpaceView3D, _draw_in_viewport), (bpy.types.SpaceImageEditor, _draw_in_uv_editor)):
        draw_handlers.add(space, draw, "POST_PIXEL", texts.EXTENDERS_LABEL)
