# SPDX-License-Identifier: GPL-3.0-or-later
"""Which meshes in edit mode are kept for drawing, which itself never makes a wrapper (`session.edit_meshes`)."""

from collections.abc import Iterable

import bpy

from .. import names
from ..edit_mesh import shapes
from ..session import edit_meshes
from . import map_overlay


def keep(meshes: Iterable[bpy.types.Mesh] | None = None) -> None:
    """Keep those of `meshes`, by default of all, of which the overlay, a shape or a hint for seams will be drawn."""
    overlay_is_on = map_overlay.is_on()
    for mesh in bpy.data.meshes if meshes is None else meshes:
        if mesh.is_editmode and (overlay_is_on or shapes.listed(mesh) or names.SEAM_HINT_ATTRIBUTE in mesh.attributes):
            edit_meshes.keep(mesh)
