# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of operators: the margin of those that pack; the settings of Spectral Unwrap, also for the preferences."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import names
from ..core.extenders.pairs import STRENGTH_LIMIT
from ..core.solve.options import Options
from ..core.words import texts
from ..edit_mesh import texture_size


class PixelProperties:
    """A margin in pixels, and the side of the texture that it counts in; not kept, because the scene has them."""

    margin: FloatProperty(**texture_size.MARGIN, options={"SKIP_SAVE"})
    texture_size: IntProperty(
        name="Texture Size",
        description=(
            "Pixels along one side of the texture, for the margin; 0 takes the size of the "
            "material's texture or, if it has none, the scene's"
        ),
        default=0,
        min=0,
        max=65536,
        soft_max=8192,
        options={"SKIP_SAVE"},
    )

    def pixels(self, context: bpy.types.Context) -> tuple[float, float]:
        """Return the margin, that of the scene unless one is given, and the side of the texture."""
        if not self.properties.is_property_set("margin"):
            self.margin = getattr(context.scene, names.MARGIN_PROPERTY)
        return self.margin, self.texture_size or texture_size.side(context)


class UnwrapProperties:
    """The settings of an unwrap."""

    method: EnumProperty(
        name="Method",
        description="Unwrapping method",
        items=(
            ("SPECTRAL", "Spectral", "Least angle distortion, with a free boundary and without pins"),
            (
                "LSCM",
                "Least Squares",
                "Least squares conformal map, pinned at the two boundary vertices farthest apart",
            ),
        ),
    )
    weights: EnumProperty(
        name="Weights",
        description=(
            "How much each triangle counts: by its area, which may shrink finely divided parts of the map, or all alike"
        ),
        items=(
            ("UNIFORM", "Uniform", "Every triangle counts by its area"),
            ("INVERSE_AREA", "Inverse Area", "Every triangle counts the same; for unevenly divided meshes"),
        ),
    )
    boundary: EnumProperty(
        name="Boundary",
        description=(
            "What pulls the map open: the length of its border, or the number of its vertices, which "
            "widens the map where the border is finely divided"
        ),
        items=(
            ("LENGTH", "Length", "Weight boundary vertices by the length of their boundary edges"),
            ("VERTEX", "Vertex", "Weight all boundary vertices equally, as in the original paper"),
        ),
    )
    hold_rest: BoolProperty(
        name="Hold the Rest",
        description=(
            "If only a part of an island is selected, keep its border with the unselected faces "
            "fixed; when disabled, cut the part off"
        ),
        default=True,
    )
    keep_in_place: BoolProperty(
        name="Keep in Place",
        description="Keep every island in its former bounding box and orientation, instead of packing all",
    )
    turn_to_pack: BoolProperty(
        name="Turn to Pack",
        description="Turn islands to fit best, which wastes less of the texture; otherwise they stand upright",
    )
    fill_holes: BoolProperty(
        name="Fill Holes",
        description="Virtually fill holes in mesh before unwrapping, to better avoid overlaps and preserve symmetry",
    )
    hole_rigidity: FloatProperty(
        name="Hole Rigidity",
        description="Keep holes of the map open instead of letting them shrink; 1 treats them like the outer border",
        default=0.0,
        min=0.0,
        soft_max=10.0,
        max=STRENGTH_LIMIT,
    )
    automatic_holes: BoolProperty(
        name="Automatic Holes",
        description=(
            "Keep the holes of an island from shrinking where that lowers its distortion; Hole "
            "Rigidity above 0 overrides this"
        ),
        default=Options().automatic_holes,
    )
    area_blend: FloatProperty(
        name="Angle to Area",
        description="0 keeps angles, and sizes vary; 1 keeps sizes even, at the cost of angles",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    no_flip: BoolProperty(
        name="No Flip",
        description=(
            "Unfold flipped faces and islands that overlap themselves, at some cost in angles; "
            "difficult islands take longer"
        ),
    )
    straighten: BoolProperty(
        name="Straighten Borders",
        description=(
            "Make borders that are nearly straight exactly so, and nearly rectangular islands rectangles, where that "
            "hardly changes the map; no effect on islands with pins or stored shapes"
        ),
    )
    polish: EnumProperty(
        name="Polish",
        description="Improve the finished map in a few steps",
        items=(
            ("OFF", "Off", "Leave the map as the solver found it"),
            ("ANGLES", "Angles", "Lower the angle distortion as far as it goes"),
            ("BALANCED", "Balanced", "Lower the angle distortion, and spend half of the gain on even sizes"),
        ),
        default=Options().polish.upper(),
    )
    stretch: FloatProperty(
        name="Edge Stretch",
        description="How much longer the map becomes along the active edge than across it",
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
        description="Let pinned UVs attract the map, which gives way, instead of holding it; Spectral method only",
    )
    soft_pin_strength: FloatProperty(
        name="Strength",
        description="How strongly soft pins attract; 1000 comes close to hard pins",
        default=100.0,
        min=1e-6,
        soft_min=1.0,
        max=STRENGTH_LIMIT,
        soft_max=STRENGTH_LIMIT,
    )
    correct_aspect: BoolProperty(
        name="Correct Aspect", description="Map UVs taking image aspect ratio into account", default=True
    )
    show_advanced: BoolProperty(name=texts.ADVANCED_LABEL, description="Show rarely used settings")


def take_as_last(chosen: UnwrapProperties) -> None:
    """Start the operator with these settings the next time an artist calls it; scripts pass theirs."""
    last = bpy.context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
    for name in UnwrapProperties.__annotations__:
        if getattr(last, name) != getattr(chosen, name):
            setattr(last, name, getattr(chosen, name))
