# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that packs the islands of the existing map."""

import time

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

from .. import names
from ..core import choices
from ..core.layout.map_packing import MapPacking, MapPackOptions, pack
from ..core.words import texts
from ..core.words.translation import translate
from ..ui import settings
from ..unwrapping import packing
from .improving_view import Improvement, improve
from .job_operator import Job, JobOperator
from .unwrap_properties import PixelProperties


class UV_OT_spectral_pack(PixelProperties, JobOperator, bpy.types.Operator):
    """Pack the selected islands by their shapes, denser and denser in the view."""

    bl_idname = names.PACK_OPERATOR
    bl_label = texts.PACK_LABEL
    bl_description = texts.PACK_DESCRIPTION

    rotation: EnumProperty(**texts.ROTATION_PROPERTY, items=texts.ROTATION_ITEMS, default=choices.ROTATION)
    scale: BoolProperty(**texts.PACK_SCALE_PROPERTY, default=True)
    stacks: EnumProperty(**texts.STACKS_PROPERTY, items=texts.STACKS_ITEMS, default=choices.STACKS_KEPT)
    groups: EnumProperty(**texts.GROUPS_PROPERTY, items=texts.GROUPS_ITEMS)
    min_size: FloatProperty(**texts.MIN_SIZE_PROPERTY, default=0.0, min=0.0, soft_max=64.0, max=4096.0, precision=0)
    whole_pixels: BoolProperty(**texts.WHOLE_PIXELS_PROPERTY, default=False)
    hold_pinned: BoolProperty(**texts.HOLD_PINNED_PROPERTY, default=True)
    tiles: EnumProperty(**texts.TILES_PROPERTY, items=texts.TILES_ITEMS)
    tile_count: IntProperty(**texts.TILE_COUNT_PROPERTY, default=2, min=1, max=100, soft_max=10)
    box_low: FloatVectorProperty(**texts.BOX_LOW_PROPERTY, size=2, default=(0.0, 0.0), min=-1e3, max=1e3, step=5)
    box_high: FloatVectorProperty(**texts.BOX_HIGH_PROPERTY, size=2, default=(0.5, 0.5), min=-1e3, max=1e3, step=5)
    correct_aspect: BoolProperty(**texts.CORRECT_ASPECT_PROPERTY, default=True)
    seconds: FloatProperty(**texts.PACK_SECONDS_PROPERTY, default=10.0, min=0.0, soft_max=60.0, max=3600.0, precision=0)
    # Not kept for the next call: the search sets it when it ends.
    steps: IntProperty(**texts.PACK_STEPS_PROPERTY, default=20, min=0, soft_max=200, options={"SKIP_SAVE"})

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        settings.draw_pack(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, pack and write, in a window step by step; report the outcome."""
        start = time.perf_counter()
        edit_meshes, chosen = packing.read(context, self.correct_aspect)
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        margin, side = self.pixels(context)
        options = MapPackOptions(
            side,
            margin,
            self.rotation.lower(),
            self.scale,
            self.stacks,
            self.hold_pinned,
            packing.regions(context, self.tiles, self.tile_count, self.box_low, self.box_high),
            packing.groups(edit_meshes, self.groups),
            self.tiles == choices.TILES_AUTO,
            self.min_size,
            self.whole_pixels or packing.rounds_to_pixels(context),
        )
        meshes = [edit_mesh.polygons for edit_mesh in edit_meshes]
        improvement = Improvement(
            begin=lambda progress: MapPacking(meshes, chosen, options, progress),
            finish=lambda progress: pack(meshes, chosen, options, self.steps, progress),
            status=lambda found: packing.status(found, options),
            is_better_at_once=True,
            seconds=self.seconds,
        )
        whole, found, _ = yield from improve(edit_meshes, improvement, is_interactive)
        if found is None:
            if whole is not None:
                self.report({"WARNING"}, packing.nothing_to_pack(whole.pinned))
            return {"CANCELLED"}
        if is_interactive:
            # So that Adjust Last Operation stops there, too.
            self.steps = found.steps
        self.report_all(packing.reports(context, found, whole, options, time.perf_counter() - start))
        return {"FINISHED"}
