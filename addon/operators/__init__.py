# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's operators: thin classes around the functions of the other folders."""

import bpy

from .constraints import (
    MESH_OT_spectral_constraint_remove,
    MESH_OT_spectral_constraint_switch,
    MESH_OT_spectral_grid,
    MESH_OT_spectral_rectangle,
    MESH_OT_spectral_straighten,
    MESH_OT_spectral_symmetric,
    UV_OT_spectral_align,
)
from .extenders import MESH_OT_spectral_extender_add, MESH_OT_spectral_extender_adjust, MESH_OT_spectral_extender_remove
from .fit_range import UV_OT_spectral_fit_range
from .inspect_map import UV_OT_spectral_inspect
from .pack import UV_OT_spectral_pack
from .relax import UV_OT_spectral_relax
from .seam_wish import MESH_OT_spectral_seam_wish
from .select import (
    UV_OT_spectral_select_defects,
    UV_OT_spectral_select_distorted,
    UV_OT_spectral_select_failed,
    UV_OT_spectral_select_stretched,
)
from .store_distortion import MESH_OT_spectral_store_distortion
from .suggest_seams import UV_OT_spectral_suggest_seams
from .texel_density import (
    UV_OT_spectral_density_factor,
    UV_OT_spectral_equalize_density,
    UV_OT_spectral_get_density,
    UV_OT_spectral_set_density,
)
from .unwrap import UV_OT_spectral_unwrap, UV_OT_spectral_unwrap_in_place

_CLASSES = (
    UV_OT_spectral_unwrap,
    UV_OT_spectral_unwrap_in_place,
    UV_OT_spectral_relax,
    UV_OT_spectral_pack,
    UV_OT_spectral_select_failed,
    UV_OT_spectral_select_defects,
    UV_OT_spectral_select_distorted,
    UV_OT_spectral_select_stretched,
    UV_OT_spectral_inspect,
    UV_OT_spectral_fit_range,
    UV_OT_spectral_get_density,
    UV_OT_spectral_set_density,
    UV_OT_spectral_equalize_density,
    UV_OT_spectral_density_factor,
    UV_OT_spectral_suggest_seams,
    MESH_OT_spectral_seam_wish,
    MESH_OT_spectral_straighten,
    MESH_OT_spectral_rectangle,
    MESH_OT_spectral_grid,
    MESH_OT_spectral_symmetric,
    UV_OT_spectral_align,
    MESH_OT_spectral_constraint_switch,
    MESH_OT_spectral_constraint_remove,
    MESH_OT_spectral_store_distortion,
    MESH_OT_spectral_extender_add,
    MESH_OT_spectral_extender_adjust,
    MESH_OT_spectral_extender_remove,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
