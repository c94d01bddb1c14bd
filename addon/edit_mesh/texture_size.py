# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of the texture on a face: stated for its material, of its image, or of the scene; how islands are packed."""

import bpy
import numpy as np

from .. import compatibility, names
from ..core.measure.texels import Texels, texels_of
from .image_aspect import active_image


def texels(context: bpy.types.Context) -> Texels:
    """Return how densities are measured: in the scene's units, with its texture size for unknown textures."""
    units, side = context.scene.unit_settings, getattr(context.scene, names.TEXTURE_SIZE_PROPERTY)
    return texels_of(side, units.system, units.length_unit, units.scale_length)


def of_materials(context: bpy.types.Context) -> float:
    """Return the side in pixels of the smallest known texture of the objects in edit mode, 0 if none is known.

    With the smallest, a margin is wide enough in all of them.
    """
    slots = [slot for each in context.objects_in_mode_unique_data for slot in each.material_slots]
    return min((side for side in (side_of(slot.material) for slot in slots) if side > 0.0), default=0.0)


def side(context: bpy.types.Context) -> float:
    """Return the side in pixels of the texture that margins count in."""
    return of_materials(context) or float(getattr(context.scene, names.TEXTURE_SIZE_PROPERTY))


def margin_pixels(context: bpy.types.Context) -> float:
    """Return the scene's margin in pixels."""
    return getattr(context.scene, names.MARGIN_PROPERTY)


def margin(context: bpy.types.Context) -> float:
    """Return the scene's margin as a fraction of the side of the texture."""
    return margin_pixels(context) / side(context)


def rotation(context: bpy.types.Context) -> str:
    """Return how the scene lets packed islands turn, in the module's words."""
    return getattr(context.scene, names.ROTATION_PROPERTY).lower()


def sides(mesh: bpy.types.Mesh, shown: bpy.types.Object) -> np.ndarray | None:
    """Return the side in pixels of the texture on every face of `mesh`, which is not in edit mode, (F,) float64.

    The mesh has the material slots of the object `shown`. A texture that is not square counts as a square
    with as many pixels; 0 stands for unknown. None if all are unknown.
    """
    of_slots = [side_of(slot.material) for slot in shown.material_slots]
    if not any(of_slots):
        return None
    return np.array(of_slots)[compatibility.materials(mesh, len(of_slots))]


def side_of(material: bpy.types.Material | None) -> float:
    """Return the side in pixels of a material's texture, 0 where it is not known."""
    if material is None:
        return 0.0
    stated = getattr(material, names.TEXTURE_SIZE_PROPERTY)
    image = active_image(material.node_tree) if not stated and material.node_tree else None
    return float(stated) if image is None else float(image.size[0] * image.size[1]) ** 0.5
