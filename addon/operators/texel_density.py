# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators on the texel density of the selected islands."""

import bpy
import numpy as np

from .. import names
from ..core import choices
from ..core.mesh.density_factors import MAX_FACTOR, MIN_FACTOR
from ..core.words import texts
from ..core.words.translation import translate
from ..ui import settings
from ..unwrapping import texel_density
from ..unwrapping.texel_density import SelectedIslands
from .property_kinds import choice, number
from .reporting_operator import ReportingOperator


class _DensityOperator(ReportingOperator):
    """An operator on the selected islands; without a UV map it warns."""

    def run(self, context: bpy.types.Context) -> set[str]:
        """Measure the islands and do the work on them."""
        islands = texel_density.selected_islands(context)
        if islands is None or not np.isfinite(islands.densities.density).any():
            return self.canceled(
                translate(
                    texts.NO_UV_MAP if islands is None else "The selected islands have no size; unwrap them first"
                )
            )
        self.run_on(context, islands)
        return {"FINISHED"}

    def run_on(self, context: bpy.types.Context, islands: SelectedIslands) -> None:
        """Do the work on islands of which at least one has a density."""
        raise NotImplementedError


class UV_OT_spectral_pick_density(_DensityOperator, bpy.types.Operator):
    """Report the texel density of the selected islands, and make it the one that Set Texel Density sets."""

    bl_idname = names.PICK_DENSITY_OPERATOR
    bl_label = "Pick Texel Density"
    bl_description = (
        "Show how many pixels of the texture the selected islands have per unit of length, and "
        "use that for Set Texel Density"
    )
    bl_options = {"REGISTER"}

    def run_on(self, context: bpy.types.Context, islands: SelectedIslands) -> None:
        """Report the density, and the range if islands differ."""
        found = islands.densities.density[np.isfinite(islands.densities.density)]
        mean = islands.densities.mean()
        context.window_manager.operator_properties_last(names.SET_DENSITY_OPERATOR).density = mean
        self.report({"INFO"}, texts.densities(mean, found.min(), found.max(), len(found), islands.texels.symbol))


class UV_OT_spectral_set_density(_DensityOperator, bpy.types.Operator):
    """Scale the selected islands to a texel density, or to an equal one, or give them a factor of it."""

    bl_idname = names.SET_DENSITY_OPERATOR
    bl_label = "Set Texel Density"
    bl_description = "Scale every selected island about its center to a texel density"
    described_by = "to"

    to: choice("To", "What the islands are scaled to", texts.DENSITY_TO_ITEMS)
    density: number(
        "Density", "Pixels of the texture per unit of length, as the scene displays lengths", 512.0, (1e-3, 1e5, 1e9)
    )
    factor: number(
        "Factor", "Texel density over that of other islands; 1 for the same", 1.5, (MIN_FACTOR, 4.0, MAX_FACTOR)
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the number where it counts."""
        number = {choices.DENSITY_NUMBER: ("density",), choices.DENSITY_FACTOR: ("factor",)}
        settings.draw(self.layout, self, ("to", *number.get(self.to, ())))

    def run(self, context: bpy.types.Context) -> set[str]:
        """Store a factor on all faces of the islands, or scale these."""
        if self.to != choices.DENSITY_FACTOR:
            return super().run(context)
        count = texel_density.store_factor(context, names.DENSITY_FACTOR_ATTRIBUTE, self.factor)
        if not count:
            return self.canceled(translate(texts.NOTHING_SELECTED))
        self.report({"INFO"}, texts.density_factor(self.factor, count))
        return {"FINISHED"}

    def run_on(self, _context: bpy.types.Context, islands: SelectedIslands) -> None:
        """Scale every island about its center; equal ones keep their pixels together."""
        found, is_equal = islands.densities, self.to == choices.DENSITY_EQUAL
        scales = found.equalizing_scales() if is_equal else found.scales_to(self.density)
        texel_density.scale(islands, scales)
        counted = np.isfinite(found.density)
        if not is_equal:
            self.report({"INFO"}, texts.density_set(self.density, int(counted.sum()), islands.texels.symbol))
            return
        common = float((found.density * scales / found.factor)[counted][0])
        has_factors = int((found.factor[counted] != 1.0).sum())
        self.report({"INFO"}, texts.density_equalized(common, int(counted.sum()), has_factors, islands.texels.symbol))
