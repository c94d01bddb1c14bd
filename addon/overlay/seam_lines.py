# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested seams before they are marked: lines in the 3D viewport, and what they would bring in the status bar."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix

from .. import compatibility
from ..core import quality, seam_suggestion, texts
from ..core.progress import Progress
from ..core.quality import MapQuality
from ..core.seam_suggestion import Suggestion
from ..core.solve import solve_all
from ..core.worker import Worker
from ..unwrapping.seams import Target

_COLOR = (0.1, 1.0, 0.55)
# Width in pixels and opacity of the cuts shown, and of those left out.
_SHOWN = (4.0, 1.0)
_LEFT_OUT = (1.5, 0.5)
# What is behind the mesh shines through faintly.
_THROUGH_MESH = 0.25
# Lines are drawn this part of the distance nearer than they are, or they would sink into the faces.
_NEARER = 0.003
_TIMER_SECONDS = 0.1
_KEYS = "Wheel, +/-, Page keys: Fewer or more   Enter or click: Apply   Esc or right click: Cancel"


def length_text(context: bpy.types.Context, length: float) -> str:
    """Return a length of object space as the scene shows lengths."""
    units = context.scene.unit_settings
    if units.system == "NONE":
        return f"{length:.3f}"
    return bpy.utils.units.to_string(units.system, "LENGTH", length * units.scale_length, precision=3)


class SeamPreview:
    """Shows the first `count` cuts of a suggestion, until `end` is called; measures in a thread what they bring.

    Attributes:
        count: how many cuts are shown, at least 1.
    """

    def __init__(
        self, context: bpy.types.Context, target: Target, suggestion: Suggestion, count: int, factor: float
    ) -> None:
        """Show the first `count` cuts; `factor` is that of the scale within which the map counts as even."""
        self.count = count
        self._target = target
        self._suggestion = suggestion
        self._factor = factor
        self._measured: dict[int, MapQuality] = {}
        self._measuring: Worker[dict[int, MapQuality]] | None = None
        self._lines = _Lines(target, suggestion)
        self._timer = context.window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        self.change(context, 0)

    def change(self, context: bpy.types.Context, by: int) -> None:
        """Show more cuts, or fewer where `by` is negative, as far as there are."""
        self.count = min(max(self.count + by, 1), len(self._suggestion.cuts))
        if self._measuring is not None:
            self._measuring.cancel()
            self._measuring = None
        self._lines.show(self.count)
        for area in context.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
        self.update(context)

    def update(self, context: bpy.types.Context) -> None:
        """Show in the status bar what is known by now."""
        if self._measuring is not None and self._measuring.wait(0.0):
            self._measured.update(self._measuring.result())
            self._measuring = None
        missing = {0, self.count} - set(self._measured)
        if missing and self._measuring is None:
            self._measuring = Worker(lambda progress: self._measure(sorted(missing), progress))
        length, total = (
            length_text(context, cuts.length) for cuts in (self._suggestion.part(0, self.count), self._suggestion)
        )
        parts = [texts.preview(self.count, len(self._suggestion.cuts), length, total)]
        if not missing:
            parts.append(texts.expected(self._measured[0], self._measured[self.count], self._factor))
        context.workspace.status_text_set(f"{texts.SUGGEST_SEAMS_LABEL}: {'; '.join(parts)}   {_KEYS}")

    def end(self, context: bpy.types.Context) -> None:
        """Remove everything shown."""
        if self._measuring is not None:
            self._measuring.cancel()
        self._lines.remove()
        context.window_manager.event_timer_remove(self._timer)
        # Blender has no workspace and no screen while it closes or loads a file.
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        for area in context.screen.areas if context.screen is not None else ():
            if area.type == "VIEW_3D":
                area.tag_redraw()

    def _measure(self, counts: list[int], progress: Progress) -> dict[int, MapQuality]:
        """Return what the map is like after the first so many cuts; any thread may call it."""
        measured = {}
        for count in counts:
            meshes = seam_suggestion.cut_open(self._target.polygons, self._suggestion.part(0, count))
            solutions = solve_all(meshes, self._target.settings.options, progress)
            measured[count] = quality.measure(meshes, solutions, self._factor)
        return measured


class _Lines:
    """The cuts as lines in all 3D viewports."""

    def __init__(self, target: Target, suggestion: Suggestion) -> None:
        """Show nothing yet."""
        self._target = target
        self._suggestion = suggestion
        self._batches: list[tuple[gpu.types.GPUBatch, float, float]] | None = None
        self._count = 0
        self._problem = ""
        self._handle = None
        # In background mode nothing is drawn.
        if not bpy.app.background:
            self._handle = bpy.types.SpaceView3D.draw_handler_add(self._draw, (), "WINDOW", "POST_VIEW")

    def show(self, count: int) -> None:
        """Draw the first `count` cuts in full, the others fainter, from the next redraw on."""
        self._count, self._batches = count, None

    def remove(self) -> None:
        """Draw nothing any more."""
        if self._handle is not None:
            bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None

    def points(self, start: int, end: int) -> np.ndarray:
        """Return the ends of the edges of cuts `start` to `end` - 1 in world space, (2 n, 3), edge after edge."""
        cuts = self._suggestion.part(start, end)
        parts = [np.empty((0, 3))]
        for index, edit_mesh in enumerate(self._target.edit_meshes):
            world = np.array(edit_mesh.edit_object.matrix_world)
            ends = seam_suggestion.segments(edit_mesh.polygons, cuts.edges(index))
            parts.append(ends @ world[:3, :3].T + world[:3, 3])
        return np.concatenate(parts)

    def _draw(self) -> None:
        try:
            self._fill()
        except Exception as error:  # noqa: BLE001 - an error while drawing would come again with every redraw
            problem = f"{type(error).__name__}: {error}"
            if problem != self._problem:
                self._problem = problem
                print(f"{texts.SUGGEST_SEAMS_LABEL} could not be drawn: {problem}")

    def _fill(self) -> None:
        shader = gpu.shader.from_builtin(compatibility.LINE_SHADER)
        if self._batches is None:
            total = len(self._suggestion.cuts)
            parts = ((self._count, total, *_LEFT_OUT), (0, self._count, *_SHOWN))
            self._batches = [
                (batch_for_shader(shader, "LINES", {"pos": points.astype(np.float32).tolist()}), width, opacity)
                for start, end, width, opacity in parts
                if len(points := self.points(start, end))
            ]
        scale = bpy.context.preferences.system.ui_scale
        shader.bind()
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        with _in_front_of_faces(bpy.context.region_data):
            for depth_test, visibility in (("NONE", _THROUGH_MESH), ("LESS_EQUAL", 1.0)):
                gpu.state.depth_test_set(depth_test)
                for batch, width, opacity in self._batches:
                    shader.uniform_float("lineWidth", width * scale)
                    shader.uniform_float("color", (*_COLOR, opacity * visibility))
                    batch.draw(shader)


@contextmanager
def _in_front_of_faces(view: bpy.types.RegionView3D) -> Iterator[None]:
    """Within, what is drawn blends, hides nothing, and wins over faces that it lies on."""
    if view.is_perspective:
        nearer = Matrix.Scale(1.0 - _NEARER, 4)
        nearer[3][3] = 1.0
    else:
        nearer = Matrix.Translation((0.0, 0.0, _NEARER * view.view_distance))
    writes_depth = gpu.state.depth_mask_get()
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)
    try:
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(nearer @ gpu.matrix.get_model_view_matrix())
            yield
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(writes_depth)
        gpu.state.blend_set("NONE")
