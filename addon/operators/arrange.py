# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that puts islands into a row; Blender has one of its own from 5.0 on."""

import bpy

from .. import names
from ..core.layout.row import in_row
from ..core.layout.shape_packing import isotropy
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.write import write_uv
from ..live import following
from ..unwrapping import packing
from .property_kinds import choice
from .reporting_operator import ReportingOperator
from .unwrap_properties import PixelProperties


class UV_OT_spectral_arrange(PixelProperties, ReportingOperator, bpy.types.Operator):
    """Put the selected islands into a row, sorted by size; without a selection, all visible ones."""

    bl_idname = names.ARRANGE_OPERATOR
    bl_label = "Arrange Islands"
    bl_description = (
        "Put the selected islands side by side, sorted by size, with the margin between them. "
        "Without a selection, all visible islands are arranged"
    )

    axis: choice(
        "Axis",
        "Direction in which the islands follow each other",
        (("X", "Row", "A row along U"), ("Y", "Column", "A column along V")),
    )
    order: choice(
        "Order",
        "Order of the islands, by the area of their bounding boxes",
        (
            ("LARGE_TO_SMALL", "Largest First", "From the largest island to the smallest"),
            ("SMALL_TO_LARGE", "Smallest First", "From the smallest island to the largest"),
        ),
    )

    def run(self, context: bpy.types.Context) -> set[str]:
        """Read, move and write."""
        edit_meshes, chosen = packing.read(context, correct_aspect=True)
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        meshes = [each.polygons for each in edit_meshes]
        margin, side = self.pixels(context)
        largest_first = self.order == "LARGE_TO_SMALL"
        width = margin / side / isotropy(meshes)
        maps, moved, count = in_row(meshes, chosen, "XY".index(self.axis), largest_first, width)
        if not count:
            return self.canceled(translate(texts.NOTHING_SELECTED))
        with following.not_following():
            for edit_mesh, uv, corners in zip(edit_meshes, maps, moved):
                if corners.any():
                    write_uv(edit_mesh, uv, corners)
        self.report({"INFO"}, texts.counted(count, texts.ARRANGED))
        return {"FINISHED"}
