# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws maps of the same faces side by side over an editor, coloured by angle distortion, below a table of numbers."""

from collections.abc import Sequence

import bpy
import gpu
import numpy as np
from mathutils import Matrix

from .. import editors
from ..core import free_room, texts
from ..core.errors import PrintOnce
from ..core.map_view import MapView, automatic_range
from . import colored_triangles, covers, legend
from .screen_text import LINE, draw_line, fill_box, fitting_scale, text_width

_BACKGROUND = (0.08, 0.08, 0.08, 1.0)
_TILE = (0.17, 0.17, 0.17, 1.0)
_BEST = (0.55, 0.85, 1.0, 1.0)
_TEXT = (0.92, 0.92, 0.92, 1.0)
# Pixels at a scale of 1.
_PADDING = 14.0
# Between the columns of the table.
_GAP = 18.0


class ComparisonView:
    """The table and the maps, over the main region of one editor."""

    def __init__(self, rows: Sequence[Sequence[str]], best: int, maps: Sequence[Sequence[MapView]]) -> None:
        """Take the rows of the table, of which `best` is the index of one to point out, and their maps."""
        self._rows = rows
        self._best = best
        self._maps = maps
        measured = [view for views in maps for view in views]
        self._range = automatic_range(measured, texts.LOOK_ANGLE) if measured else (1.0, 2.0)
        self._batches: list[list[gpu.types.GPUBatch]] | None = None
        self._area: bpy.types.Area | None = None
        self._space: type | None = None
        self._handle: object = None
        self._print = PrintOnce(lambda problem: texts.not_drawn(texts.COMPARE_LABEL, problem))

    def show(self, area: bpy.types.Area) -> None:
        """Draw over this editor, a 3D viewport or an image editor."""
        self._area = area
        self._space = bpy.types.SpaceView3D if area.type == "VIEW_3D" else bpy.types.SpaceImageEditor
        self._handle = self._space.draw_handler_add(self._draw, (), "WINDOW", "POST_PIXEL")
        area.tag_redraw()

    def remove(self) -> None:
        """Draw nothing any more."""
        if self._handle is not None:
            self._space.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None
            # The editor itself may be gone.
            editors.redraw(bpy.context)

    def _draw(self) -> None:
        if bpy.context.area != self._area:
            return
        try:
            self._fill(bpy.context)
        except Exception as error:  # noqa: BLE001 - an error while drawing would come again with every redraw
            self._print(error)

    def _fill(self, context: bpy.types.Context) -> None:
        region, scale = context.region, context.preferences.system.ui_scale
        size = (float(region.width), float(region.height))
        fill_box((0.0, 0.0, *size), (_BACKGROUND,) * 4)
        room = free_room.largest(size, covers.of(context.area, region))
        padding = _PADDING * scale
        if room is None or min(room[2] - room[0], room[3] - room[1]) <= 2.0 * padding:
            return
        left, bottom, right, top = room[0] + padding, room[1] + padding, room[2] - padding, room[3] - padding
        y = self._table((left, bottom, right, top), scale)
        self._draw_maps((left, bottom, right, y - padding), scale)

    def _table(self, box: tuple[float, float, float, float], scale: float) -> float:
        """Draw the table from the top of a box, no wider or higher than that, and return where it ends."""
        left, bottom, right, top = box
        rows = (texts.comparison_header(), *self._rows)
        widths = [max(text_width(row[k], scale) for row in rows) for k in range(len(rows[0]))]
        width, height = sum(widths) + _GAP * scale * (len(widths) - 1), LINE * scale * len(rows)
        fit = min(1.0, (right - left) / width, (top - bottom) / height)
        places = [left + fit * (sum(widths[:k]) + k * _GAP * scale) for k in range(len(widths))]
        for index, row in enumerate(rows):
            color = _BEST if index == self._best + 1 else _TEXT
            for place, cell in zip(places, row):
                draw_line(cell, place, top, fit * scale, color)
            top -= LINE * fit * scale
        return top

    def _draw_maps(self, box: tuple[float, float, float, float], scale: float) -> None:
        left, bottom, right, top = box
        n = len(self._maps)
        line = LINE * scale
        # As many columns as make the squares largest.
        sizes = {
            columns: min((right - left) / columns, (top - bottom) / -(-n // columns) - line)
            for columns in range(1, n + 1)
        }
        columns = max(sizes, key=lambda each: sizes[each])
        size = sizes[columns] - 0.5 * line
        if size < line:
            return
        for index, row in enumerate(self._rows):
            x = left + (index % columns) * sizes[columns]
            y = top - (index // columns) * (sizes[columns] + line)
            draw_line(row[0], x, y, fitting_scale(row[0], size, scale), _BEST if index == self._best else _TEXT)
            y -= line + size
            fill_box((x, y, x + size, y + size), (_TILE,) * 4)
            self._draw_map(index, x, y, size)

    def _draw_map(self, index: int, x: float, y: float, size: float) -> None:
        if self._batches is None:
            self._batches = [[_triangles(view) for view in views if view.qc.size] for views in self._maps]
        low, extent = _bounds(self._maps[index])
        shader = colored_triangles.shader(is_flat=True)
        with gpu.matrix.push_pop():
            gpu.matrix.translate((x, y))
            gpu.matrix.multiply_matrix(Matrix.Diagonal((size / extent, size / extent, 1.0, 1.0)))
            gpu.matrix.translate((-low[0], -low[1]))
            for batch in self._batches[index]:
                colored_triangles.draw(batch, shader, legend.colors_of(texts.LOOK_ANGLE, 1.0), *self._range)


def _triangles(view: MapView) -> gpu.types.GPUBatch:
    places = colored_triangles.places(view.triangle_positions())
    return colored_triangles.batch(places, *view.triangle_map(texts.LOOK_ANGLE))


def _bounds(views: Sequence[MapView]) -> tuple[np.ndarray, float]:
    """Return the lower corner and the extent of the square that holds the maps; at least the tile from 0 to 1."""
    low, high = np.zeros(2), np.ones(2)
    for view in views:
        used = np.repeat(view.arrays.visible_faces, np.diff(view.arrays.face_offsets))
        uv = view.arrays.uv[used & np.isfinite(view.arrays.uv).all(axis=1)]
        if len(uv):
            low, high = np.minimum(low, uv.min(axis=0)), np.maximum(high, uv.max(axis=0))
    return low, float((high - low).max())
