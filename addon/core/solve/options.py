# SPDX-License-Identifier: GPL-3.0-or-later
"""What an unwrap is asked to do, apart from Blender."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Options:
    """Options of `spectral_conformal.unwrap`, by the names and values it documents, as far as nothing else is said."""

    method: str = "spectral"
    weights: str = "uniform"
    boundary: str = "length"
    fill_holes: bool = False
    soft_pins: float = 0.0
    hole_rigidity: float = 0.0
    automatic_holes: bool = True
    """Where `hole_rigidity` is 0: let each island have the one that lowers its distortion."""
    area_blend: float = 0.0
    fold_free: bool = False
    polish: bool = True
    stretch: float = 1.0
    """How much longer the map is along `PolygonMesh.stretch_direction` than across it, where the mesh has one."""


@dataclass(frozen=True)
class Margin:
    """Space between islands, and what it is measured by: an identifier of `texts.MARGIN_METHOD_ITEMS`."""

    size: float = 0.001
    method: str = "SCALED"


@dataclass(frozen=True)
class Settings:
    """The operator's settings, apart from Blender.

    Attributes:
        options: what the solver does.
        keep_in_place: fit every island into its former bounds instead of packing all.
        turn_to_pack: lay islands that are higher than wide on their side when packing.
        margin: space between packed islands.
        correct_aspect: map without distortion on the image of the active face, whatever its shape.
        use_subsurf: solve the subdivided mesh of objects whose first modifier is a Subdivision Surface modifier.
    """

    options: Options = Options()
    keep_in_place: bool = False
    turn_to_pack: bool = False
    margin: Margin = Margin()
    correct_aspect: bool = True
    use_subsurf: bool = False
