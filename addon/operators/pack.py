# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that packs the islands of the existing map."""

import time

import bpy

from .. import names
from ..core import choices
from ..core.layout.map_packing import MapPacking, MapPackOptions
from ..core.words import texts
from ..core.words.translation import translate
from ..ui import settings
from ..unwrapping import packing
from ..unwrapping.last_settings import settings_for
from .improving_view import Improvement, improve
from .job_operator import Job, JobOperator
from .property_kinds import choice, number, numbers, switch
from .unwrap_properties import PackingProperties


class UV_OT_spectral_pack(PackingProperties, JobOperator, bpy.types.Operator):
    """Pack the selected islands by their shapes, denser and denser in the view."""

    bl_idname = names.PACK_OPERATOR
    bl_label = texts.PACK_LABEL
    bl_description = (
        "Pack the selected islands into the UV tile by their true shapes, holes included, around "
        "everything that stays. The packing gets denser in the view until you end it. Without a "
        "selection, all visible islands are packed"
    )

    scale: switch(
        "Scale", "Scale all islands alike to fill the tile; otherwise they keep their size, where there is room", True
    )
    stacks: choice(
        "Stacks",
        "Islands that lie on each other and share their texture",
        (
            (choices.STACKS_APART, "Apart", "All islands lie apart"),
            (choices.STACKS_KEPT, "Keep", "Equal islands that lie on each other stay stacked"),
            (choices.STACKS_OVERLAPPING, "Keep Overlaps", "Islands that overlap stay together, whatever their shapes"),
            (choices.STACKS_EQUAL, "Equal", "Stack equal islands"),
            (
                choices.STACKS_MIRRORED,
                "Equal or Mirrored",
                "Stack equal and mirrored islands; the latter are mirrored to match",
            ),
        ),
        choices.STACKS_KEPT,
    )
    groups: choice(
        "Groups",
        "Islands that move as one and keep their arrangement",
        (
            ("NONE", "None", "Each island moves on its own"),
            ("OBJECT", "By Object", "The islands of an object move as one"),
            ("MATERIAL", "By Material", "Islands with the same material move as one"),
        ),
    )
    min_size: number(
        "Smallest Island",
        "Enlarge islands until their longer side has this many pixels; 0 keeps all at one scale",
        0.0,
        (0.0, 64.0, 4096.0),
        precision=0,
    )
    snap: switch(
        "Whole Pixels",
        "Move straight borders of islands to the borders of pixels, at most half a pixel, for "
        "lightmaps; always while Blender's Round to Pixels is on in the UV editor",
    )
    hold_pinned: switch(
        "Hold Pinned", "Islands with a pinned UV stay where they are, and the others are packed around them", True
    )
    tiles: choice(
        "Pack to",
        "What to fill",
        (
            (choices.TILES_OWN, "Own Tiles", "Each island stays in its UV tile"),
            (
                choices.TILES_ACTIVE,
                "Active Tile",
                "The active UDIM tile of the image in the UV editor, or the first one",
            ),
            (choices.TILES_SEVERAL, "Several Tiles", "A number of UDIM tiles, from the active one on"),
            (
                choices.TILES_AUTO,
                "As Many as Needed",
                "UDIM tiles from the active one on, as few as islands of this size need; islands keep their size",
            ),
            (choices.TILES_BOUNDS, "Bounding Box", "The bounding box of the islands as they are"),
            (choices.TILES_BOX, "Box", "A rectangle of your choice, such as a quarter of the tile"),
        ),
    )
    tile_count: number("Number of Tiles", "UDIM tiles to fill, from the active one on", 2, (1, 10, 100))
    box: numbers(
        "Box",
        "U and V of the lower left corner, then of the upper right",
        (0.0, 0.0, 0.5, 0.5),
        min=-1e3,
        max=1e3,
        step=5,
    )
    seconds: number(
        "Seconds", "How long the search goes on in the view, unless you end it", 10.0, (0.0, 60.0, 3600.0), precision=0
    )
    # Not kept for the next call: the search sets it when it ends.
    steps: number(
        "Steps", "Arrangements to try after the first; the densest is kept", 20, (0, 200, None), options={"SKIP_SAVE"}
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Lay out Adjust Last Operation."""
        settings.draw_pack(self.layout, self)

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, pack and write, in a window step by step; report the outcome."""
        start = time.perf_counter()
        edit_meshes, chosen = packing.read(context, settings_for(self).correct_aspect)
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        margin, side = self.pixels(context)
        options = MapPackOptions(
            side,
            margin,
            self.turns(context),
            self.scale,
            self.stacks,
            self.hold_pinned,
            packing.regions(context, self.tiles, self.tile_count, self.box),
            packing.groups(edit_meshes, self.groups),
            self.tiles == choices.TILES_AUTO,
            self.min_size,
            self.snap or packing.rounds_to_pixels(context),
        )
        meshes = [edit_mesh.polygons for edit_mesh in edit_meshes]
        improvement = Improvement(
            begin=lambda progress: MapPacking(meshes, chosen, options, progress),
            status=lambda found: packing.status(found, options),
            steps=self.steps,
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
