# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of suggested seams: how many to take, and what they would bring."""

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from .. import editors, user_preferences
from ..core.layout.placement import place
from ..core.measure import quality
from ..core.measure.quality import MapQuality
from ..core.seams import suggestion as seam_suggestion
from ..core.seams.suggestion import Suggestion
from ..core.solve.progress import Progress
from ..core.solve.solution import solve_all
from ..core.solve.worker import Worker
from ..core.words import texts
from ..core.words.translation import translate
from ..overlay import map_overlay, under_mouse
from ..overlay.seam_lines import SeamLines
from ..session import edit_meshes, kept_maps
from ..ui.progress import HeaderText, clear_status, show_status
from ..unwrapping.seams import Target

# Keys that change the number of cuts, as in Blender's Loop Cut, by one or by a tenth of all.
_STEPS = {
    **dict.fromkeys(("WHEELUPMOUSE", "NUMPAD_PLUS", "EQUAL", "UP_ARROW"), 1),
    **dict.fromkeys(("WHEELDOWNMOUSE", "NUMPAD_MINUS", "MINUS", "DOWN_ARROW"), -1),
}
_LEAPS = {"PAGE_UP": 1, "PAGE_DOWN": -1}
_LEAP = 0.1
# Maps kept for the overlay, so that going back is fast and memory stays limited.
_KEPT_MAPS = 8
_SIGNS = {"+": 1, "-": -1}
_APPLY = {"RET", "NUMPAD_ENTER"}
# Keys that the preview answers wherever the mouse is.
_EVERYWHERE = {*_APPLY, "ESC"}
# Keys of the 3D viewport that change the view only: standard views, the pie of views, sidebar and toolbar.
_VIEW_KEYS = {*(f"NUMPAD_{n}" for n in range(10)), "NUMPAD_PERIOD", "ACCENT_GRAVE", "HOME", "N", "T"}
# Pixels, times the scale of the interface: the corner of the viewport with the gizmos that move the view.
_GIZMO_WIDTH, _GIZMO_HEIGHT = 100, 280


def length_text(context: bpy.types.Context, length: float) -> str:
    """Return a length of object space as the scene shows lengths."""
    units = context.scene.unit_settings
    if units.system == "NONE":
        return f"{length:.3f}"
    return bpy.utils.units.to_string(units.system, "LENGTH", length * units.scale_length, precision=3)


class SeamPreview:
    """Asks how many of the suggested cuts to take, shows them, and measures in a thread what they bring.

    A `job_operator.Choice`.

    Attributes:
        count: number of shown cuts, at least 1.
    """

    def __init__(self, target: Target, suggestion: Suggestion, count: int, factor: float) -> None:
        """Begin with the first `count` cuts; `factor` is the allowed factor between scale and median."""
        self.count = count
        self._target = target
        self._suggestion = suggestion
        self._factor = factor
        self._measured: dict[int, MapQuality] = {}
        # Some of their maps, by object, for the overlay; and the count that it shows.
        self._maps: dict[int, dict[str, np.ndarray]] = {}
        self._overlaid: int | None = None
        self._keys: HeaderText | None = None
        self._measuring: Worker[dict[int, _Measured]] | None = None
        # Read now, because the measuring thread must not touch Blender.
        self._names = [edit_mesh.edit_object.name_full for edit_mesh in target.edit_meshes]
        self._lines = SeamLines(target.edit_meshes, suggestion)

    @property
    def answer(self) -> int:
        """How many cuts to take."""
        return self.count

    def begin(self, context: bpy.types.Context) -> None:
        """Show the cuts, and the keys in the header of the editor."""
        self._keys = HeaderText(context, translate(texts.PREVIEW_KEYS))
        self.change(context, 0)

    def leaves(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Keep what happens over a 3D viewport, but for view keys and navigation gizmos; panels and editors work."""
        if event.type in _EVERYWHERE:
            return False
        found = _viewport_at(context, event)
        if found is None:
            return True
        is_key = event.type in _VIEW_KEYS and not (event.ctrl or event.alt)
        return is_key or _is_on_gizmos(context, *found, event)

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle the keys that change the number of cuts or end the choice; a click on the mesh applies it."""
        if event.value != "PRESS":
            return {"PASS_THROUGH"}
        if event.type in _APPLY or (event.type == "LEFTMOUSE" and self._is_on_mesh(context, event)):
            return {"FINISHED"}
        step = self._step(event)
        if step and not event.ctrl:
            self.change(context, step)
            return {"RUNNING_MODAL"}
        # Ctrl and the wheel zoom, as the wheel does elsewhere.
        return {"RUNNING_MODAL"} if step and _zoom(context, event, step) else {"PASS_THROUGH"}

    def change(self, context: bpy.types.Context, by: int) -> None:
        """Show more cuts, or fewer if `by` is negative."""
        self.count = min(max(self.count + by, 1), len(self._suggestion.cuts))
        if self._measuring is not None:
            self._measuring.cancel()
            self._measuring = None
        self._lines.show(context, self.count)
        self.update(context)

    def update(self, context: bpy.types.Context) -> None:
        """Show in the status bar what is known."""
        if self._measuring is not None and self._measuring.wait(0.0):
            for count, found in self._measuring.result().items():
                self._measured[count], self._maps[count] = found.quality, found.maps
            self._measuring = None
        if map_overlay.is_on():
            self._overlay(context)
        missing = {0, self.count} - set(self._measured)
        if map_overlay.is_on() and self.count not in self._maps:
            missing.add(self.count)
        if missing and self._measuring is None:
            threads = user_preferences.read("threads", 0)
            self._measuring = Worker(lambda progress: self._measure(sorted(missing), progress), threads)
        length, total = (
            length_text(context, cuts.length) for cuts in (self._suggestion.part(0, self.count), self._suggestion)
        )
        parts = [texts.preview(self.count, len(self._suggestion.cuts), length, total)]
        if not missing:
            parts.append(texts.expected(self._measured[0], self._measured[self.count], self._factor))
        show_status(context, texts.preview_status("; ".join(parts)))

    def end(self, context: bpy.types.Context) -> None:
        """Remove everything shown."""
        if self._measuring is not None:
            self._measuring.cancel()
        self._lines.remove()
        map_overlay.preview(context, {})
        if self._keys is not None:
            self._keys.end()
        clear_status(context)

    def _overlay(self, context: bpy.types.Context) -> None:
        """Show the map that the cuts would bring in the overlay."""
        for count in list(self._maps)[:-_KEPT_MAPS]:
            if count != self.count:
                del self._maps[count]
        if self.count in self._maps and self._overlaid != self.count:
            self._overlaid = self.count
            map_overlay.preview(context, self._maps[self.count])

    def _is_on_mesh(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Return whether the mouse is on one of the meshes in a 3D viewport."""
        found = _viewport_at(context, event)
        if found is None:
            return False
        area, region = found
        points = under_mouse.ray(area, region, event.mouse_x - region.x, event.mouse_y - region.y)
        for edit_mesh in self._target.edit_meshes:
            edited = edit_mesh.edit_object
            if abs(edited.matrix_world.determinant()) < 1e-30:
                continue
            inverse = edited.matrix_world.inverted()
            start, end = (inverse @ point for point in points)
            hit, *_ = BVHTree.FromBMesh(edit_meshes.keep(edited.data).bm).ray_cast(start, end - start)
            if hit is not None:
                return True
        return False

    def _step(self, event: bpy.types.Event) -> int:
        """Return by how many cuts a key changes their number, 0 for other keys."""
        if event.type in _LEAPS:
            return _LEAPS[event.type] * max(1, round(_LEAP * len(self._suggestion.cuts)))
        return _STEPS.get(event.type, _SIGNS.get(event.ascii, 0))

    def _measure(self, counts: list[int], progress: Progress) -> dict[int, "_Measured"]:
        """Measure the maps after the first `counts` cuts each; any thread may call this."""
        measured = {}
        for count in counts:
            meshes = seam_suggestion.cut_open(self._target.polygons, self._suggestion.part(0, count))
            solutions = solve_all(meshes, self._target.settings.options, progress, kept_maps.of_session())
            placed = place(self._target.polygons, solutions, False, False).uv
            maps = {
                name: np.where(solution.solved_corners[:, None], uv, 0.0)
                for name, uv, solution in zip(self._names, placed, solutions)
            }
            measured[count] = _Measured(quality.measure(meshes, solutions, self._factor), maps)
        return measured


@dataclass(frozen=True)
class _Measured:
    """The quality of a map, and its UVs, (C, 2), by the full name of the object."""

    quality: MapQuality
    maps: dict[str, np.ndarray]


def _viewport_at(context: bpy.types.Context, event: bpy.types.Event) -> tuple[bpy.types.Area, bpy.types.Region] | None:
    """Return the 3D viewport under the mouse and its main region; None if there is none."""
    found = editors.region_at(context.screen, event.mouse_x, event.mouse_y)
    return found if found is not None and found[0].type == "VIEW_3D" else None


def _is_on_gizmos(
    context: bpy.types.Context, area: bpy.types.Area, region: bpy.types.Region, event: bpy.types.Event
) -> bool:
    """Return whether the mouse is in the corner with the gizmos that move the view."""
    space, scale = area.spaces.active, context.preferences.system.ui_scale
    if not (space.show_gizmo and space.show_gizmo_navigate):
        return False
    # The sidebar covers the viewport's right side, and the gizmos keep left of it.
    right = min([region.x + region.width, *(each.x for each in area.regions if each.type == "UI" and each.width > 1)])
    top = region.y + region.height
    return right - event.mouse_x < _GIZMO_WIDTH * scale and top - event.mouse_y < _GIZMO_HEIGHT * scale


def _zoom(context: bpy.types.Context, event: bpy.types.Event, delta: int) -> bool:
    """Zoom the 3D viewport under the mouse, as the wheel does; return whether there is one."""
    found = _viewport_at(context, event)
    if found is None:
        return False
    area, region = found
    with context.temp_override(area=area, region=region):
        bpy.ops.view3d.zoom("EXEC_DEFAULT", delta=delta, use_cursor_init=False)
    return True
