# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of a mesh, in edit mode or not."""

import bmesh
import bpy
from bmesh.types import BMesh


def elements(mesh: bpy.types.Mesh) -> BMesh:
    """Return the edit mesh of a mesh in edit mode; of any other mesh, a copy."""
    if mesh.is_editmode:
        return bmesh.from_edit_mesh(mesh)
    copy = bmesh.new()
    copy.from_mesh(mesh)
    return copy
