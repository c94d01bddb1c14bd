# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of operators: the margin of those that pack; the settings of Spectral Unwrap, also for the preferences."""

import bpy

from .. import names
from ..core.extenders.pairs import STRENGTH_LIMIT
from ..core.solve.options import Options
from ..core.words import texts
from ..edit_mesh import texture_size
from .property_kinds import choice, number, pixel_margin, rotation, share, switch


class PixelProperties:
    """A margin in pixels, and the side of the texture that it counts in; not kept, because the scene has them."""

    margin: pixel_margin(options={"SKIP_SAVE"})
    texture_size: number(
        "Texture Size",
        "Pixels along one side of the texture, for the margin; 0 takes the size of the "
        "material's texture or, if it has none, the scene's",
        0.0,
        (0.0, 8192.0, 65536.0),
        precision=0,
        step=6400,
        options={"SKIP_SAVE"},
    )

    def pixels(self, context: bpy.types.Context) -> tuple[float, float]:
        """Return the margin, that of the scene unless one is given, and the side of the texture.

        Adjust Last Operation then shows both.
        """
        if not self.properties.is_property_set("margin"):
            self.margin = texture_size.margin_pixels(context)
        self.texture_size = self.texture_size or texture_size.side(context)
        return self.margin, self.texture_size


class PackingProperties(PixelProperties):
    """Also how islands may turn, which the scene has, too."""

    rotation: rotation(options={"SKIP_SAVE"})

    def turns(self, context: bpy.types.Context) -> str:
        """Return how islands may turn, as the scene says unless that is given; in the module's words."""
        if not self.properties.is_property_set("rotation"):
            self.rotation = texture_size.rotation(context).upper()
        return self.rotation.lower()


class UnwrapProperties:
    """The settings of an unwrap."""

    method: choice(
        "Method",
        "Unwrapping method",
        (
            ("SPECTRAL", "Spectral", "Least angle distortion, with a free boundary and without pins"),
            (
                "LSCM",
                "Least Squares",
                "Least squares conformal map, pinned at the two boundary vertices farthest apart",
            ),
        ),
    )
    weights: choice(
        "Weights",
        "How much each triangle counts: by its area, which may shrink finely divided parts of the map, or all alike",
        (
            ("UNIFORM", "Uniform", "Every triangle counts by its area"),
            ("INVERSE_AREA", "Inverse Area", "Every triangle counts the same; for unevenly divided meshes"),
        ),
    )
    boundary: choice(
        "Boundary",
        "What pulls the map open: the length of its border, or the number of its vertices, which "
        "widens the map where the border is finely divided",
        (
            ("LENGTH", "Length", "Weight boundary vertices by the length of their boundary edges"),
            ("VERTEX", "Vertex", "Weight all boundary vertices equally, as in the original paper"),
        ),
    )
    hold_rest: switch(
        "Hold the Rest",
        "If only a part of an island is selected, keep its border with the unselected faces "
        "fixed; when disabled, cut the part off",
        True,
    )
    keep_in_place: switch(
        "Keep in Place", "Keep every island in its former bounding box and orientation, instead of packing all"
    )
    fill_holes: switch(
        "Fill Holes", "Virtually fill holes in mesh before unwrapping, to better avoid overlaps and preserve symmetry"
    )
    hole_rigidity: number(
        "Hole Rigidity",
        "Keep holes of the map open instead of letting them shrink; 1 treats them like the outer border",
        0.0,
        (0.0, 10.0, STRENGTH_LIMIT),
    )
    automatic_hole_rigidity: switch(
        "Automatic Holes",
        "Keep the holes of an island from shrinking where that lowers its distortion; Hole "
        "Rigidity above 0 overrides this",
        Options().hole_rigidity == "automatic",
    )
    area_blend: share("Angle to Area", "0 keeps angles, and sizes vary; 1 keeps sizes even, at the cost of angles")
    fold_free: switch(
        "No Overlaps",
        "Unfold flipped faces and islands that overlap themselves, at some cost in angles; "
        "difficult islands take longer",
    )
    straighten: switch(
        "Straighten Borders",
        "Make borders that are nearly straight exactly so, and nearly rectangular islands rectangles, where that "
        "hardly changes the map; no effect on islands with pins or stored shapes",
    )
    polish: choice(
        "Polish",
        "Improve the finished map in a few steps",
        (
            ("OFF", "Off", "Leave the map as the solver found it"),
            ("ANGLES", "Angles", "Lower the angle distortion as far as it goes"),
            ("BALANCED", "Balanced", "Lower the angle distortion, and spend half of the gain on even sizes"),
        ),
        Options().polish.upper(),
    )
    stretch: number(
        "Edge Stretch",
        "How much longer the map becomes along the active edge than across it",
        1.0,
        (0.01, 0.25, 4.0, 100.0),
    )
    use_subsurf_data: switch(
        "Use Subdivision Surface", "Map UVs taking vertex position after Subdivision Surface modifier has been applied"
    )
    soft_pins: number(
        "Soft Pins",
        "How strongly pinned UVs attract the map, which gives way; 0 holds them, and 1000 comes close to that. "
        "Spectral method only",
        0.0,
        (0.0, 1000.0, STRENGTH_LIMIT),
    )
    correct_aspect: switch("Correct Aspect", "Map UVs taking image aspect ratio into account", True)
    show_advanced: switch(texts.ADVANCED_LABEL, "Show rarely used settings")


def take_as_last(chosen: UnwrapProperties) -> None:
    """Start the operator with these settings the next time an artist calls it; scripts pass theirs."""
    last = bpy.context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
    for name in UnwrapProperties.__annotations__:
        if getattr(last, name) != getattr(chosen, name):
            setattr(last, name, getattr(chosen, name))
