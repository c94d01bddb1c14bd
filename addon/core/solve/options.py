# SPDX-License-Identifier: GPL-3.0-or-later
"""Options and settings of an unwrap, without Blender."""

from dataclasses import dataclass

from .. import choices


@dataclass(frozen=True)
class Options:
    """Options of `spectral_conformal.unwrap`, by the names and values it documents, and two more."""

    method: str = "spectral"
    weights: str = "uniform"
    boundary: str = "length"
    fill_holes: bool = False
    soft_pins: float = 0.0
    hole_rigidity: float | str = "automatic"
    area_blend: float = 0.0
    fold_free: bool = False
    polish: str = "angles"
    straighten: bool = False
    """Straighten borders where that hardly changes the map."""
    stretch: float = 1.0
    """How much longer the map is along `PolygonMesh.stretch_direction` than across it."""


@dataclass(frozen=True)
class Settings:
    """The operator's settings, without Blender.

    Attributes:
        options: what the solver does.
        keep_in_place: fit every island into its former bounds instead of packing all.
        margin: between packed islands, and between them and the border of the tile, as a fraction of its side.
        rotation: of packed islands, as in `spectral_conformal.pack`.
        correct_aspect: take the aspect of the image of the active face into account.
        use_subsurf: solve the subdivided mesh of objects whose first modifier is a Subdivision Surface modifier.
        hold_rest: where a part of an island is selected, hold the UVs that the rest shares, and solve between them.
        blend: how far U and V go from the map as it was, 0, to the solved one, 1.
    """

    options: Options = Options()
    keep_in_place: bool = False
    margin: float = choices.MARGIN / choices.TEXTURE_SIZE
    rotation: str = choices.ROTATION.lower()
    correct_aspect: bool = True
    use_subsurf: bool = False
    hold_rest: bool = True
    blend: tuple[float, float] = (1.0, 1.0)
