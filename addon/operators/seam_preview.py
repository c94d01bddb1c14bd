# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of suggested seams: how many to take, and what they would bring."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from .. import editors, names, session, user_preferences
from ..core import choices
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
from ..edit_mesh import seam_hints
from ..overlay import map_overlay, under_mouse
from ..overlay.coming_layout import ComingLayout, outline
from ..overlay.seam_lines import SeamLines
from ..session import edit_meshes, identity, kept_maps
from ..ui import settings
from ..ui.progress import lose_status, show_status
from ..unwrapping.seams import Target
from .job_operator import Work

# Keys that change the number of cuts, as in Blender's Loop Cut, by one or by a tenth of all.
_STEPS = {
    **dict.fromkeys(("WHEELUPMOUSE", "NUMPAD_PLUS", "EQUAL", "UP_ARROW"), 1),
    **dict.fromkeys(("WHEELDOWNMOUSE", "NUMPAD_MINUS", "MINUS", "DOWN_ARROW"), -1),
}
_LEAPS = {"PAGE_UP": 1, "PAGE_DOWN": -1}
_LEAP = 0.1
# Degrees by which a leap changes the angle of seams; a step changes it by one.
_LEAP_DEGREES = 10
# Maps kept for the overlay, so that going back is fast and memory stays limited.
_KEPT_MAPS = 8
# Stands for the map without any cuts; 0 has those that are always made.
_UNCUT = -1
_SIGNS = {"+": 1, "-": -1}
_APPLY = {"RET", "NUMPAD_ENTER"}
# Keys that the preview answers wherever the mouse is.
_EVERYWHERE = {*_APPLY, "ESC"}
# Keys of the 3D viewport that change the view only: standard views, the pie of views, sidebar and toolbar.
_VIEW_KEYS = {*(f"NUMPAD_{n}" for n in range(10)), "NUMPAD_PERIOD", "ACCENT_GRAVE", "HOME", "N", "T"}
# Pixels, times the scale of the interface, from the top right corner of the viewport: width and height of the axes and
# of the buttons below them that move the view.
_GIZMOS = ((100, 150), (45, 280))


def length_text(context: bpy.types.Context, length: float) -> str:
    """Return a length of object space as the scene shows lengths."""
    units = context.scene.unit_settings
    if units.system == "NONE":
        return f"{length:.3f}"
    return bpy.utils.units.to_string(units.system, "LENGTH", length * units.scale_length, precision=3)


class Sidebar:
    """The settings of the search in the sidebar, which may change while the preview runs."""

    def __init__(self, operator: Any, search: Callable[[], Work]) -> None:  # noqa: ANN401 - Suggest Seams
        """Show those of the operator in the sidebar; `search` returns the work of searching with its settings."""
        self._operator, self._search = operator, search
        self._shown = settings.last(names.SUGGEST_SEAMS_OPERATOR)
        self._give(operator, self._shown)
        self._values = self._read()

    def changed(self) -> Work | None:
        """Return a new search if the settings or the hints have changed since the last call, else None."""
        values = self._read()
        if values == self._values:
            return None
        self._values = values
        self._give(self._shown, self._operator)
        return self._search()

    @property
    def factor(self) -> float:
        """The allowed factor between scale and median."""
        return self._operator.scale_limit

    @property
    def angle(self) -> float | None:
        """The angle of the seams in degrees; None for seams by distortion."""
        return math.degrees(self._operator.sharp_angle) if self._operator.style == choices.SEAMS_BY_ANGLE else None

    def turn(self, degrees: float) -> None:
        """Change the angle of the seams, in the sidebar, too."""
        angle = math.degrees(self._shown.sharp_angle) + degrees
        self._shown.sharp_angle = math.radians(min(max(round(angle), 0.0), 180.0))

    def _read(self) -> tuple:
        values = (getattr(self._shown, name) for name in settings.OF_SEAMS)
        return (*values, session.of(seam_hints.Changes).count)

    @staticmethod
    def _give(source: Any, target: Any) -> None:  # noqa: ANN401 - as above
        for name in settings.OF_SEAMS:
            if getattr(target, name) != getattr(source, name):
                setattr(target, name, getattr(source, name))


class SeamPreview:
    """Asks how many of the suggested cuts to take, shows them, and measures in a thread what they bring.

    A `job_operator.Choice`.

    Attributes:
        count: number of shown cuts; at least 1 if nothing else is suggested.
    """

    def __init__(self, target: Target, suggestion: Suggestion, count: int, sidebar: Sidebar) -> None:
        """Begin with the first `count` cuts."""
        self.count = count
        self._target = target
        self._suggestion = suggestion
        self._sidebar = sidebar
        self._searching: Worker[Suggestion] | None = None
        self._measured: dict[int, _Measured] = {}
        # The counts that the overlay and the UV editors show.
        self._overlaid: int | None = None
        self._laid_out: int | None = None
        self._has_left = False
        self._measuring: Worker[dict[int, _Measured]] | None = None
        # Read now, because the measuring thread must not touch Blender.
        self._keys = [identity.key(edit_mesh.edit_object) for edit_mesh in target.edit_meshes]
        self._lines = SeamLines(target.edit_meshes)
        self._layout = ComingLayout()

    @property
    def answer(self) -> tuple[Suggestion, int]:
        """The suggestion, and how many of its cuts to take."""
        return self._suggestion, self.count

    def begin(self, context: bpy.types.Context) -> None:
        """Show the cuts; the keys stand in the status bar alone, so that all headers can be used."""
        self.change(context, 0)

    def leaves(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Keep events over a 3D viewport except view keys and navigation gizmos; leave panels and editors theirs."""
        if event.type in _EVERYWHERE:
            return False
        is_move = event.type == "MOUSEMOVE"
        if is_move and self._has_left:
            # What has ended, such as the pie of views, may have cleared the status bar.
            lose_status()
        found = _viewport_at(context, event)
        is_key = event.type in _VIEW_KEYS and not (event.ctrl or event.alt)
        leaves = found is None or is_key or (not self._step(event) and _is_on_gizmos(context, *found, event))
        self._has_left = leaves and not is_move
        return leaves

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle the keys that change the number of cuts or end the choice; a click on the mesh applies it."""
        if event.value != "PRESS":
            return {"PASS_THROUGH"}
        if event.type in _APPLY or (event.type == "LEFTMOUSE" and self._is_on_mesh(context, event)):
            # While a search runs, the shown cuts are not those of the settings.
            return {"FINISHED"} if self._searching is None else {"RUNNING_MODAL"}
        step = self._step(event)
        if step and not event.ctrl:
            self.change(context, step)
            return {"RUNNING_MODAL"}
        # Ctrl and the wheel zoom, as the wheel does elsewhere.
        return {"RUNNING_MODAL"} if step and _zoom(context, event, step) else {"PASS_THROUGH"}

    def change(self, context: bpy.types.Context, by: int) -> None:
        """Show more cuts, or fewer if `by` is negative; by angle, lower or raise the angle."""
        if by and self._sidebar.angle is not None:
            self._sidebar.turn(-by)
        else:
            least = 0 if self._suggestion.fixed else 1
            self.count = min(max(self.count + by, least), len(self._suggestion.cuts))
        self._stop_measuring()
        self._lines.show(context, self._suggestion, self.count)
        self.update(context)

    def update(self, context: bpy.types.Context) -> None:
        """Follow the settings, and show in the status bar what is known."""
        threads = user_preferences.read("threads", 0)
        search = self._sidebar.changed()
        if search is not None:
            self._stop_measuring()
            if self._searching is not None:
                self._searching.cancel()
            self._searching = Worker(search, threads)
        if self._searching is not None:
            if not self._searching.wait(0.0):
                self._say(context, translate("Searching ..."))
                return
            self._suggestion, self._searching = self._searching.result(), None
            self.count = len(self._suggestion.cuts)
            self._measured, self._overlaid, self._laid_out = {}, None, None
            self._lines.show(context, self._suggestion, self.count)
        if self._measuring is not None and self._measuring.wait(0.0):
            self._measured.update(self._measuring.result())
            self._measuring = None
        self._show_map(context)
        missing = {_UNCUT, self.count} - set(self._measured)
        if missing and self._measuring is None:
            suggestion, factor = self._suggestion, self._sidebar.factor
            self._measuring = Worker(
                lambda progress: self._measure(suggestion, factor, sorted(missing), progress), threads
            )
        parts = [self._shown_cuts(context)]
        if not missing:
            before, after = self._measured[_UNCUT], self._measured[self.count]
            parts.append(texts.islands(after.islands, after.fill))
            parts.append(texts.expected(before.quality, after.quality))
        parts.append(texts.found_style(self._suggestion.styles))
        parts.append(texts.counted(self._suggestion.refused_hints, texts.REFUSED_HINTS))
        self._say(context, "; ".join(filter(None, parts)))

    @staticmethod
    def _say(context: bpy.types.Context, known: str) -> None:
        show_status(context, texts.status(texts.SUGGEST_SEAMS_LABEL, known, texts.PREVIEW_KEYS))

    def _shown_cuts(self, context: bpy.types.Context) -> str:
        """Return a text about the shown cuts."""
        shown, everything = self._suggestion.part(0, self.count), self._suggestion
        length, total = (length_text(context, cuts.length) for cuts in (shown, everything))
        if self._sidebar.angle is not None:
            edges = sum(len(cut.edges) for cut in shown.fixed)
            return texts.preview_by_angle(self._sidebar.angle, edges, length)
        return texts.preview(self.count, len(everything.cuts), length, total)

    def _stop_measuring(self) -> None:
        if self._measuring is not None:
            self._measuring.cancel()
            self._measuring = None

    def end(self, context: bpy.types.Context) -> None:
        """Remove everything shown."""
        self._stop_measuring()
        if self._searching is not None:
            self._searching.cancel()
        self._lines.remove()
        self._layout.remove()
        map_overlay.preview(context, {})

    def _show_map(self, context: bpy.types.Context) -> None:
        """Show the map that the cuts would bring in the overlay, and its layout in the UV editors."""
        for count in [count for count in self._measured if count != _UNCUT][:-_KEPT_MAPS]:
            if count != self.count:
                del self._measured[count]
        if self.count not in self._measured:
            return
        if self._laid_out != self.count:
            self._laid_out = self.count
            self._layout.show(context, self._measured[self.count].layout)
        if map_overlay.is_on() and self._overlaid != self.count:
            self._overlaid = self.count
            map_overlay.preview(context, self._measured[self.count].maps)

    def _is_on_mesh(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Return whether the mouse is on one of the meshes in a 3D viewport."""
        found = _viewport_at(context, event)
        if found is None:
            return False
        area, region = found
        points = under_mouse.ray(area, region, event.mouse_x - region.x, event.mouse_y - region.y)
        for edited in (edit_mesh.edit_object for edit_mesh in self._target.edit_meshes):
            tree = BVHTree.FromBMesh(edit_meshes.keep(edited.data).bm)
            if under_mouse.cast(edited, tree, *points)[0] is not None:
                return True
        return False

    def _step(self, event: bpy.types.Event) -> int:
        """Return by how many cuts a key changes their number, 0 for other keys."""
        if event.type in _LEAPS:
            if self._sidebar.angle is not None:
                return _LEAPS[event.type] * _LEAP_DEGREES
            return _LEAPS[event.type] * max(1, round(_LEAP * len(self._suggestion.cuts)))
        return _STEPS.get(event.type, _SIGNS.get(event.ascii, 0))

    def _measure(
        self, suggestion: Suggestion, factor: float, counts: list[int], progress: Progress
    ) -> dict[int, "_Measured"]:
        """Measure the maps after the first `counts` cuts each, _UNCUT for none; any thread may call this."""
        measured, polygons, chosen = {}, self._target.polygons, self._target.settings
        for count in counts:
            meshes = polygons
            if count != _UNCUT:
                meshes = seam_suggestion.cut_open(polygons, suggestion.part(0, count))
            solutions = solve_all(meshes, chosen.options, progress, kept_maps.of_session())
            # As it will be written.
            placement = place(polygons, solutions, chosen, progress, self._target.beside)
            placed = placement.uv
            found = quality.measure(meshes, solutions, factor)
            maps = {
                key: np.where(solution.solved_corners[:, None], uv, 0.0)
                for key, uv, solution in zip(self._keys, placed, solutions)
            }
            lines = [
                outline(mesh, uv, solution.solved_corners) for mesh, uv, solution in zip(polygons, placed, solutions)
            ]
            islands = sum(len(solution.charts) for solution in solutions)
            measured[count] = _Measured(found, islands, placement.fill, maps, lines)
        return measured


@dataclass(frozen=True)
class _Measured:
    """A map.

    Attributes:
        quality: of the map.
        islands: their number.
        fill: how much of the tile they fill; None if they are not packed.
        maps: its UVs, (C, 2), by the key of the object.
        layout: the edges of its faces, per mesh.
    """

    quality: MapQuality
    islands: int
    fill: float | None
    maps: dict[int, np.ndarray]
    layout: list[np.ndarray]


def _viewport_at(context: bpy.types.Context, event: bpy.types.Event) -> tuple[bpy.types.Area, bpy.types.Region] | None:
    """Return the 3D viewport under the mouse and its main region; None if there is none."""
    found = editors.region_at(context.screen, event.mouse_x, event.mouse_y)
    return found if found is not None and found[0].type == "VIEW_3D" else None


def _is_on_gizmos(
    context: bpy.types.Context, area: bpy.types.Area, region: bpy.types.Region, event: bpy.types.Event
) -> bool:
    """Return whether the mouse is on the gizmos that move the view."""
    space, scale = area.spaces.active, context.preferences.system.ui_scale
    if not (space.show_gizmo and space.show_gizmo_navigate):
        return False
    # The sidebar covers the viewport's right side, and the gizmos keep left of it.
    right = min([region.x + region.width, *(each.x for each in area.regions if each.type == "UI" and each.width > 1)])
    top = region.y + region.height
    x, y = (right - event.mouse_x) / scale, (top - event.mouse_y) / scale
    return any(x < width and y < height for width, height in _GIZMOS)


def _zoom(context: bpy.types.Context, event: bpy.types.Event, delta: int) -> bool:
    """Zoom the 3D viewport under the mouse, as the wheel does; return whether there is one."""
    found = _viewport_at(context, event)
    if found is None:
        return False
    area, region = found
    with context.temp_override(area=area, region=region):
        bpy.ops.view3d.zoom("EXEC_DEFAULT", delta=delta, use_cursor_init=False)
    return True
