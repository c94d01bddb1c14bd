# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that marks seams where they lower the distortion most, and unwraps again."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from .. import names
from ..core import texts
from ..core.native import NativeModuleError
from ..core.progress import Progress
from ..core.seam_suggestion import Options, Search, Suggestion
from ..core.solve import Solution, solve_all
from ..core.summary import summarize
from ..core.worker import Worker
from ..edit_mesh.packing import PackingError
from ..live import following
from ..overlay.seam_lines import SeamPreview, length_text
from ..ui import progress
from ..unwrapping import seams, steps
from ..unwrapping.last_settings import last_settings
from ..unwrapping.seams import Target

# A search or solve shorter than this ends within the click that started it.
_SECONDS_BEFORE_MODAL = 0.25
# Keys that change the number of cuts, as in Blender's Loop Cut, by one or by a tenth of all.
_STEPS = {
    **dict.fromkeys(("WHEELUPMOUSE", "NUMPAD_PLUS", "EQUAL", "UP_ARROW"), 1),
    **dict.fromkeys(("WHEELDOWNMOUSE", "NUMPAD_MINUS", "MINUS", "DOWN_ARROW"), -1),
}
_LEAPS = {"PAGE_UP": 1, "PAGE_DOWN": -1}
_LEAP = 0.1
_SIGNS = {"+": 1, "-": -1}
_APPLY = {"LEFTMOUSE", "RET", "NUMPAD_ENTER"}

# The last search, so that other settings of Adjust Last Operation need no search.
_search = Search()


class UV_OT_spectral_suggest_seams(bpy.types.Operator):
    """Mark seams that lower the distortion, shown before they are marked, and unwrap again."""

    bl_idname = names.SUGGEST_SEAMS_OPERATOR
    bl_label = texts.SUGGEST_SEAMS_LABEL
    bl_description = texts.SUGGEST_SEAMS_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    size_variation: FloatProperty(
        name="Size Variation",
        description="Factor within which the scale of 95 % of the surface is to lie; a larger one takes fewer seams",
        default=2.0,
        min=1.01,
        soft_max=8.0,
        max=1e3,
    )
    angle_distortion: FloatProperty(
        name="Angle Distortion",
        description="Mean quasi-conformal distortion that is not to be exceeded, 1 where all angles are kept; a larger "
        "one takes fewer seams on coarse meshes",
        default=1.05,
        min=1.001,
        soft_max=2.0,
        max=1e3,
        precision=3,
        step=1,
    )
    max_length: FloatProperty(
        name="Maximum Length",
        description="Limit of the length of all new seams of a mesh, without the object's scale, 0 for none; cuts that "
        "closed islands and handles need are made in any case",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    cuts: IntProperty(
        name="Cuts",
        description="Number of the suggested cuts to mark, the most useful first, 0 for all",
        default=0,
        min=0,
        options={"SKIP_SAVE"},
    )
    unwrap: BoolProperty(
        name="Unwrap",
        description=f"Unwrap the faces afterwards, with the settings with which {texts.UNWRAP_LABEL} was used last",
        default=True,
    )

    # The Worker that a window waits for. An annotation makes bpy 4.2 and 4.5 crash on leaving Python.
    _running = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode, once at a time."""
        if cls._running is not None and cls._running.is_wanted:
            cls.poll_message_set(f"{texts.SUGGEST_SEAMS_LABEL} is running; Esc cancels it")
            return False
        return context.mode == "EDIT_MESH"

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("size_variation", "angle_distortion", "max_length", "cuts", "unwrap"):
            layout.prop(self, name)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Search, mark the cuts and unwrap; Blender waits."""
        target = self._read(context)
        if target is None:
            return {"CANCELLED"}
        try:
            with progress.blocking(context, texts.SUGGEST_SEAMS_LABEL) as report_progress:
                found = _look(target, self._options(target), report_progress)
            if not found.suggestion.cuts:
                return self._report_nothing(target, found)
            cuts = found.suggestion.part(0, self._count(found.suggestion))
            start, solutions = time.perf_counter(), None
            if self.unwrap:
                edit_meshes = seams.read_cut_open(context, target, cuts)
                with progress.blocking(context, texts.SUGGEST_SEAMS_LABEL) as report_progress:
                    solutions = steps.solve(edit_meshes, target.settings, report_progress)
        except NativeModuleError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._write(context, target, cuts, solutions, start)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Search in a thread, so that Blender's windows live and Esc cancels; then show the cuts."""
        if bpy.app.background:
            return self.execute(context)
        self._target = self._read(context)
        if self._target is None:
            return {"CANCELLED"}
        self._cuts = self._preview = self._progress = None
        target, options = self._target, self._options(self._target)
        status = self._wait(context, Worker(lambda report_progress: _look(target, options, report_progress)))
        if "RUNNING_MODAL" in status:
            context.window_manager.modal_handler_add(self)
        return status

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for the search, let the user choose how many cuts to take, wait for the unwrap."""
        try:
            return self._handle(context, event)
        except Exception:
            # Or the lines would stay in the viewport.
            self.cancel(context)
            raise

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop without having changed anything. Blender calls it on closing, too."""
        self._worker.cancel()
        self._hide(context)

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        is_pressed = event.value == "PRESS"
        if context.mode != "EDIT_MESH" or (event.type in {"ESC", "RIGHTMOUSE"} and is_pressed):
            self.cancel(context)
            self.report({"INFO"}, f"{texts.SUGGEST_SEAMS_LABEL}: Cancelled")
            return {"CANCELLED"}
        if event.type == "TIMER":
            return self._advance(context)
        if self._preview is not None and is_pressed:
            if event.type in _APPLY:
                return self._apply(context)
            step = self._step(event)
            if step and not event.ctrl:
                self._preview.change(context, step)
                return {"RUNNING_MODAL"}
            if step and _zoom(context, event, step):
                return {"RUNNING_MODAL"}
        return {"PASS_THROUGH"} if progress.moves_view(event) else {"RUNNING_MODAL"}

    def _step(self, event: bpy.types.Event) -> int:
        """Return by how many cuts a key changes their number, 0 for other keys."""
        if event.type in _LEAPS:
            return _LEAPS[event.type] * max(1, round(_LEAP * len(self._suggestion.cuts)))
        return _STEPS.get(event.type, _SIGNS.get(event.ascii, 0))

    def _advance(self, context: bpy.types.Context) -> set[str]:
        """Show how far the worker is; go on where it has ended."""
        if self._preview is not None:
            self._preview.update(context)
        elif self._worker.wait(0.0):
            self._hide(context)
            return self._go_on(context)
        elif self._progress is not None:
            self._progress.update(context, self._worker.fraction, self._worker.phase)
        return {"PASS_THROUGH"}

    def _wait(self, context: bpy.types.Context, worker: Worker) -> set[str]:
        """Go on with what the worker finds, at once if that takes no time."""
        self._worker = worker
        if worker.wait(_SECONDS_BEFORE_MODAL):
            return self._go_on(context)
        type(self)._running = worker
        self._progress = progress.WindowProgress(context, texts.SUGGEST_SEAMS_LABEL)
        return {"RUNNING_MODAL"}

    def _go_on(self, context: bpy.types.Context) -> set[str]:
        """After the search, show the cuts; after the unwrap, write it."""
        try:
            result = self._worker.result()
        except NativeModuleError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if self._cuts is not None:
            return self._write_if_current(context, result)
        self._suggestion = result.suggestion
        if not self._suggestion.cuts:
            return self._report_nothing(self._target, result)
        count = self._count(self._suggestion)
        self._preview = SeamPreview(context, self._target, self._suggestion, count, self.size_variation)
        return {"RUNNING_MODAL"}

    def _apply(self, context: bpy.types.Context) -> set[str]:
        """Take the cuts that are shown."""
        count, total = self._preview.count, len(self._suggestion.cuts)
        self._hide(context)
        self.cuts = 0 if count == total else count
        self._cuts = self._suggestion.part(0, count)
        self._start = time.perf_counter()
        if not self.unwrap:
            return self._write_if_current(context, None)
        target = seams.read_again(context, self._target)
        if target is None:
            return self._report_change()
        edit_meshes = seams.read_cut_open(context, target, self._cuts)
        return self._wait(
            context,
            Worker(lambda report_progress: steps.solve(edit_meshes, target.settings, report_progress)),
        )

    def _write_if_current(self, context: bpy.types.Context, solutions: list[Solution] | None) -> set[str]:
        target = seams.read_again(context, self._target)
        if target is None:
            return self._report_change()
        return self._write(context, target, self._cuts, solutions, self._start)

    def _write(
        self,
        context: bpy.types.Context,
        target: Target,
        cuts: Suggestion,
        solutions: list[Solution] | None,
        start: float,
    ) -> set[str]:
        """Mark the cuts, write the unwrap that began at `start`, if there is one, and report both."""
        outcome = None
        try:
            if solutions is None:
                seams.mark(target, cuts)
            else:
                outcome = seams.write(context, target, cuts, solutions, following.not_following)
        except PackingError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, texts.marked(len(cuts.cuts), length_text(context, cuts.length)))
        self._report_refused(target, cuts)
        if outcome is not None:
            for level, text in steps.reports(outcome, time.perf_counter() - start):
                self.report({level}, text)
        return {"FINISHED"}

    def _hide(self, context: bpy.types.Context) -> None:
        """Remove everything shown."""
        type(self)._running = None
        for shown in (self._progress, self._preview):
            if shown is not None:
                shown.end(context)
        self._progress = self._preview = None

    def _read(self, context: bpy.types.Context) -> Target | None:
        """Return what is to be cut; None having reported that there is nothing."""
        target = seams.read(context, last_settings())
        if target is None:
            self.report({"WARNING"}, "No visible faces to cut")
        return target

    def _options(self, target: Target) -> Options:
        options = target.settings.options
        return Options(
            self.size_variation, self.angle_distortion, self.max_length or None, options.weights, options.boundary
        )

    def _count(self, suggestion: Suggestion) -> int:
        """Return how many cuts of a suggestion the properties ask for."""
        return min(self.cuts or len(suggestion.cuts), len(suggestion.cuts))

    def _report_nothing(self, target: Target, found: "_Found") -> set[str]:
        if not all(found.suggestion.errors):
            self.report({"INFO"}, texts.nothing_to_suggest(self.max_length > 0.0))
        self._report_refused(target, found.suggestion)
        failures = texts.failures(summarize(found.uncut, target.names))
        if failures:
            self.report({"WARNING"}, failures)
        return {"CANCELLED"}

    def _report_refused(self, target: Target, suggestion: Suggestion) -> None:
        refused = texts.without_suggestion(suggestion.errors, target.names)
        if refused:
            self.report({"WARNING"}, refused)

    def _report_change(self) -> set[str]:
        self.report({"WARNING"}, "The meshes changed meanwhile, so nothing was marked; suggest seams again")
        return {"CANCELLED"}


@dataclass(frozen=True)
class _Found:
    """A suggestion; without cuts also the solutions of the meshes as they are, which tell what cannot be unwrapped."""

    suggestion: Suggestion
    uncut: Sequence[Solution] = ()


def _look(target: Target, options: Options, report_progress: Progress) -> _Found:
    """Search for cuts; any thread may call it."""
    suggestion = _search.suggest(target.polygons, options, report_progress)
    if suggestion.cuts:
        return _Found(suggestion)
    return _Found(suggestion, solve_all(target.polygons, target.settings.options, report_progress))


def _zoom(context: bpy.types.Context, event: bpy.types.Event, delta: int) -> bool:
    """Zoom the 3D viewport under the mouse, as the wheel does by itself; return whether there is one."""
    for area in context.screen.areas:
        for region in area.regions if area.type == "VIEW_3D" else ():
            inside_x = region.x <= event.mouse_x < region.x + region.width
            inside_y = region.y <= event.mouse_y < region.y + region.height
            if region.type == "WINDOW" and inside_x and inside_y:
                with context.temp_override(area=area, region=region):
                    bpy.ops.view3d.zoom("EXEC_DEFAULT", delta=delta, use_cursor_init=False)
                return True
    return False
