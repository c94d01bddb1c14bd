# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an artist wants seams, and where not: an integer attribute of the edges, saved with the mesh."""

import bmesh
import bpy
import numpy as np

from .. import names, session
from ..session import Remembered
from .elements import marked_edges

NONE = 0
CUT = 1
NEVER = 2


class Changes(Remembered):
    """How often hints have changed, so that a running preview notices."""

    def __init__(self) -> None:
        """Begin to count."""
        self.count = 0


def of_edges(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of a mesh in edit mode with a hint: their vertices, (n, 2) int32, and their hints, (n,)."""
    hints = marked_edges(mesh, names.SEAM_HINT_ATTRIBUTE)
    found = {edge: hint for edge, hint in hints.items() if hint in (CUT, NEVER)}
    return np.array(list(found), np.int32).reshape(-1, 2), np.array(list(found.values()), np.int32)


def set_selected(mesh: bpy.types.Mesh, hint: int) -> int:
    """Set the hint of the selected visible edges of a mesh in edit mode; return their number."""
    bm = bmesh.from_edit_mesh(mesh)
    if not any(edge.select and not edge.hide for edge in bm.edges):
        return 0
    layers = bm.edges.layers.int
    # A new layer invalidates edges that were read before.
    layer = layers.get(names.SEAM_HINT_ATTRIBUTE) or layers.new(names.SEAM_HINT_ATTRIBUTE)
    selected = [edge for edge in bm.edges if edge.select and not edge.hide]
    for edge in selected:
        edge[layer] = hint
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    session.of(Changes).count += 1
    return len(selected)
