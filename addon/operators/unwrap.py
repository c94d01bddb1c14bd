# SPDX-License-Identifier: GPL-3.0-or-later
"""The Spectral Unwrap operator."""

import time

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .. import names
from ..core import texts
from ..core.native import NativeModuleError
from ..edit_mesh.packing import PackingError
from ..live import following
from ..ui import progress
from ..unwrapping import steps
from ..unwrapping.in_thread import UnwrapInThread
from ..unwrapping.last_settings import settings_of
from ..unwrapping.steps import Outcome

# A solve shorter than this ends within the click that started it.
_SECONDS_BEFORE_MODAL = 0.25


class UV_OT_spectral_unwrap(bpy.types.Operator):
    """Unwrap the selected faces by Spectral Conformal Parameterization."""

    bl_idname = names.UNWRAP_OPERATOR
    bl_label = texts.UNWRAP_LABEL
    bl_description = texts.UNWRAP_DESCRIPTION
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(name="Method", description="Unwrapping method", items=texts.METHOD_ITEMS)
    weights: EnumProperty(name="Weights", description="How much each triangle counts", items=texts.WEIGHTS_ITEMS)
    boundary: EnumProperty(
        name="Boundary", description="How much each boundary vertex counts", items=texts.BOUNDARY_ITEMS
    )
    placement: EnumProperty(name="Placement", description="Where the unwrapped islands go", items=texts.PLACEMENT_ITEMS)
    fill_holes: BoolProperty(
        name="Fill Holes",
        description="Virtually fill holes in mesh before unwrapping, to better avoid overlaps and preserve symmetry",
    )
    hole_rigidity: FloatProperty(
        name="Hole Rigidity",
        description="How strongly holes are kept from shrinking to a point, at 1 they count like the island's border",
        default=0.0,
        min=0.0,
        soft_max=10.0,
        max=1e4,
    )
    area_blend: FloatProperty(
        name="Angle to Area",
        description="0 keeps angles, so that sizes vary; towards 1 angles are given up to keep sizes even",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    fold_free: BoolProperty(
        name="Fold-Free",
        description="Leave no flipped faces: unfold those of the conformal map, at some cost in angles. Islands that "
        "cannot be unfolded where they are get another map, which takes longer",
    )
    stretch: FloatProperty(
        name="Edge Stretch",
        description="How much longer the islands get along the direction of the active edge than across it",
        default=1.0,
        min=0.01,
        soft_min=0.25,
        soft_max=4.0,
        max=100.0,
    )
    use_subsurf_data: BoolProperty(
        name="Use Subdivision Surface",
        description="Map UVs taking vertex position after Subdivision Surface modifier has been applied",
    )
    soft_pins: BoolProperty(
        name="Soft Pins",
        description="Let pinned UVs attract the islands of the spectral method instead of holding them",
    )
    soft_pin_strength: FloatProperty(
        name="Strength",
        description="How strongly soft pins attract, 1000 nearly as if they were held",
        default=100.0,
        min=1e-6,
        soft_min=1.0,
        max=1e4,
        soft_max=1e4,
    )
    correct_aspect: BoolProperty(
        name="Correct Aspect", description="Map UVs taking image aspect ratio into account", default=True
    )
    margin_method: EnumProperty(
        name="Margin Method", description="What the margin is measured by", items=texts.MARGIN_METHOD_ITEMS
    )
    margin: FloatProperty(
        name="Margin", description="Space between islands", default=0.001, min=0.0, max=1.0, precision=3, step=0.1
    )

    # The UnwrapInThread that a window waits for. An annotation makes bpy 4.2 and 4.5 crash on leaving Python.
    _running = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where a mesh is in edit mode, one solve at a time."""
        if cls._running is not None and cls._running.worker.is_wanted:
            cls.poll_message_set(f"{texts.UNWRAP_LABEL} is running; Esc cancels it")
            return False
        return context.mode == "EDIT_MESH"

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "method")
        layout.prop(self, "weights")
        row = layout.row()
        row.active = self.method == "SPECTRAL"
        row.prop(self, "boundary")
        layout.prop(self, "fill_holes")
        row = layout.row()
        row.active = self.method == "SPECTRAL"
        row.prop(self, "hole_rigidity")
        layout.separator()
        layout.prop(self, "fold_free")
        layout.prop(self, "area_blend")
        layout.prop(self, "stretch")
        layout.separator()
        layout.prop(self, "use_subsurf_data")
        layout.separator()
        column = layout.column()
        column.active = self.method == "SPECTRAL"
        column.prop(self, "soft_pins")
        row = column.row()
        row.active = self.soft_pins
        row.prop(self, "soft_pin_strength")
        layout.separator()
        layout.prop(self, "correct_aspect")
        layout.prop(self, "placement")
        column = layout.column()
        column.active = self.placement == texts.PACK
        column.prop(self, "margin_method")
        column.prop(self, "margin")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Unwrap with the operator's settings and report the result; Blender waits."""
        start = time.perf_counter()
        try:
            with progress.blocking(context) as report_progress:
                outcome = steps.unwrap(context, settings_of(self), report_progress, following.not_following)
        except (NativeModuleError, PackingError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._report(outcome, time.perf_counter() - start)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Unwrap as `execute` does, but solve in a thread, so that Blender's windows live and Esc cancels."""
        if bpy.app.background:
            return self.execute(context)
        edit_meshes = steps.read(context, settings_of(self))
        if not edit_meshes:
            return self._report(None, 0.0)
        running = UnwrapInThread(settings_of(self), edit_meshes)
        if running.worker.wait(_SECONDS_BEFORE_MODAL):
            return self._write(context, running)
        type(self)._running = running
        self._progress = progress.WindowProgress(context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for the solve; let nothing but view navigation through."""
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, f"{texts.UNWRAP_LABEL}: Cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if progress.moves_view(event) else {"RUNNING_MODAL"}
        running = self._running
        if context.mode == "EDIT_MESH" and not running.worker.wait(0.0):
            self._progress.update(context, running.worker.fraction, running.worker.phase)
            return {"PASS_THROUGH"}
        self.cancel(context)
        if not running.is_current(context):
            self.report({"WARNING"}, "The meshes changed while they were solved, so nothing was written; unwrap again")
            return {"CANCELLED"}
        return self._write(context, running)

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop waiting: the solve ends without result, its progress disappears. Blender calls it on closing, too."""
        self._running.worker.cancel()
        type(self)._running = None
        self._progress.end(context)

    def _write(self, context: bpy.types.Context, solved: UnwrapInThread) -> set[str]:
        """Write what was solved in a thread and report the result."""
        try:
            outcome = solved.write(context, following.not_following)
        except (NativeModuleError, PackingError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._report(outcome, solved.seconds)

    def _report(self, outcome: Outcome | None, seconds: float) -> set[str]:
        """Tell the user what was done in `seconds`; return the operator's status."""
        if outcome is None:
            self.report({"WARNING"}, "Nothing selected; select the faces to unwrap, in the UV editor their UVs")
            return {"CANCELLED"}
        for level, text in steps.reports(outcome, seconds):
            self.report({level}, text)
        return {"FINISHED"} if outcome.summary.solved else {"CANCELLED"}
