# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's operators: thin classes around the functions of the other folders."""

import bpy

from .. import compatibility
from . import (
    arrange,
    extender,
    inspect_map,
    new_textures,
    pack,
    relax,
    seam_hint,
    select,
    shape,
    store_distortion,
    suggest_seams,
    texel_density,
    unwrap,
)

_MODULES = (
    unwrap,
    relax,
    pack,
    *(() if compatibility.HAS_ARRANGE_ISLANDS else (arrange,)),
    new_textures,
    select,
    inspect_map,
    texel_density,
    suggest_seams,
    seam_hint,
    shape,
    extender,
    store_distortion,
)


def _classes() -> list[type]:
    """Return the operators of the modules, in the order in which these define them."""
    found = [each for module in _MODULES for each in vars(module).values() if isinstance(each, type)]
    return [each for each in found if issubclass(each, bpy.types.Operator)]


register, unregister = bpy.utils.register_classes_factory(_classes())
