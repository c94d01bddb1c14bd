# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator on the texel density of the selected islands."""

import bpy
import numpy as np

from .. import names
from ..core import choices
from ..core.mesh.density_factors import MAX_FACTOR, MIN_FACTOR
from ..core.words import texts
from ..core.words.translation import translate
from ..ui import settings
from ..unwrapping import result_numbers, texel_density
from ..unwrapping.texel_density import SelectedIslands
from .property_kinds import choice, number
from .reporting_operator import ReportingOperator


class UV_OT_spectral_density(ReportingOperator, bpy.types.Operator):
    """Scale the selected islands to a texel density, or to an equal one, give them a factor of it, or measure it."""

    bl_idname = names.DENSITY_OPERATOR
    bl_label = texts.TEXEL_DENSITY_LABEL
    bl_description = "Scale every selected island about its center to a texel density"
    described_by = "kind"

    kind: choice("Kind", "What is done with the texel density", texts.DENSITY_ITEMS, options={"SKIP_SAVE"})
    density: number(
        "Density", "Pixels of the texture per unit of length, as the scene displays lengths", 512.0, (1e-3, 1e5, 1e9)
    )
    factor: number(
        "Factor", "Texel density over that of other islands; 1 for the same", 1.5, (MIN_FACTOR, 4.0, MAX_FACTOR)
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the number where it counts."""
        number = {choices.DENSITY_NUMBER: ("density",), choices.DENSITY_FACTOR: ("factor",)}
        settings.draw(self.layout, self, ("kind", *number.get(self.kind, ())))

    def run(self, context: bpy.types.Context) -> set[str]:
        """Store a factor on all faces of the islands, or measure and scale these."""
        if self.kind == choices.DENSITY_FACTOR:
            count = texel_density.store_factor(context, names.DENSITY_FACTOR_ATTRIBUTE, self.factor)
            if not count:
                return self.canceled(translate(texts.NOTHING_SELECTED))
            self.report({"INFO"}, texts.density_factor(self.factor, count))
            return {"FINISHED"}
        islands = texel_density.selected_islands(context)
        if islands is None:
            return self.canceled(translate(texts.NO_UV_MAP))
        if not np.isfinite(islands.densities.density).any():
            return self.canceled(translate("The selected islands have no size; unwrap them first"))
        self.report({"INFO"}, (self._picked if self.kind == choices.DENSITY_PICKED else self._scaled)(islands))
        return {"FINISHED"}

    def _picked(self, islands: SelectedIslands) -> str:
        """Make the density of the islands the number of the next call; return what it is, and the range."""
        found = islands.densities.density[np.isfinite(islands.densities.density)]
        self.density = settings.last(names.DENSITY_OPERATOR).density = islands.densities.mean()
        result_numbers.store("density", density=self.density)
        return texts.densities(self.density, found.min(), found.max(), len(found), islands.texels.symbol)

    def _scaled(self, islands: SelectedIslands) -> str:
        """Scale every island about its center, equal ones so that all keep their pixels; return the report."""
        found, is_equal = islands.densities, self.kind == choices.DENSITY_EQUAL
        scales = found.equalizing_scales() if is_equal else found.scales_to(self.density)
        texel_density.scale(islands, scales)
        counted = np.isfinite(found.density)
        if not is_equal:
            return texts.density_set(self.density, int(counted.sum()), islands.texels.symbol)
        common = float((found.density * scales / found.factor)[counted][0])
        has_factors = int((found.factor[counted] != 1.0).sum())
        return texts.density_equalized(common, int(counted.sum()), has_factors, islands.texels.symbol)
