# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that stores the distortion of faces as attributes."""

import bpy

from .. import names
from ..core.drawing import color_ramp
from ..core.measure.map_view import MapView, fixed_range, median_log2_scale
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import attributes, read_map
from ..edit_mesh.texture_size import texels
from ..overlay import legend, map_overlay
from .property_kinds import choice, switch
from .reporting_operator import ReportingOperator


class MESH_OT_spectral_store_distortion(ReportingOperator, bpy.types.Operator):
    """Store angle distortion, size, texel density or defects of every face as an attribute."""

    bl_idname = names.STORE_OPERATOR
    bl_label = "Store as Attribute"
    bl_description = "Store the distortion of every face as a mesh attribute, for rendering, geometry nodes and scripts"
    modes = frozenset({"EDIT_MESH", "OBJECT"})

    kind: choice("Store", "What to store", tuple(item for item in texts.LOOK_ITEMS if item[0] in names.ATTRIBUTES))
    as_colors: switch("As Colors", "Store the colors of the overlay at face corners instead of one number per face")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Store what the overlay shows, if it has values."""
        shown = map_overlay.settings().kind
        if shown in names.ATTRIBUTES:
            self.kind = shown
        return self.execute(context)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Measure the maps of the meshes that the overlay shows, hidden faces included, and store."""
        views = {}
        for shown in map_overlay.shown_objects(context):
            arrays = read_map.read_own_map(context, shown)
            if arrays is not None and shown.data.library is None:
                views[shown.data] = MapView(arrays)
        if not views:
            return self.without_map(context)
        name, measured = names.ATTRIBUTES[self.kind], texels(context)
        median = median_log2_scale(list(views.values()))
        if self.as_colors:
            name += names.COLORS_SUFFIX
            low, high = fixed_range(list(views.values()), self.kind, measured)
            if map_overlay.settings().kind == self.kind:
                low, high = map_overlay.shown_range(context)
            colors = legend.colors_of(self.kind, 1.0)
            ramp = (colors.low, colors.middle, colors.high)
        for mesh, view in views.items():
            values = view.values(self.kind, measured, median)
            if self.as_colors:
                attributes.store_corner_colors(mesh, name, color_ramp.colors_of(values, low, high, ramp))
            else:
                attributes.store_face_values(mesh, name, values)
        self.report({"INFO"}, translate("Stored as {name}").format(name=name))
        return {"FINISHED"}
