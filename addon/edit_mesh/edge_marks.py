# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges that a modeler has marked, and along which seams are cheap: creases, bevel weights, sharp edges, materials."""

import bmesh
import bpy
import numpy as np

from .. import compatibility
from ..core import native
from .read import temporary_mesh


def of_edges(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the marked edges of a mesh in edit mode: their vertices, (n, 2) int32, and strengths, (n,) float64.

    The strength of a crease or a bevel weight is its value; that of an edge marked sharp, or between two materials, is
    1. Such an edge may come twice; the larger value counts.
    """
    bm = bmesh.from_edit_mesh(mesh)
    with temporary_mesh() as copy:
        bm.to_mesh(copy)
        strengths = np.maximum(*(compatibility.edge_weights(copy, name) for name in ("crease", "bevel_weight")))
        strengths[compatibility.flags(copy, "edges", "use_edge_sharp")] = 1.0
        edges = compatibility.edge_vertices(copy)[strengths > 0.0]
        borders = native.measuring().edges_between(
            compatibility.materials(copy),
            compatibility.face_offsets(copy),
            compatibility.corner_vertices(copy),
            len(copy.vertices),
        )
    return np.concatenate([edges, borders]), np.append(strengths[strengths > 0.0], np.ones(len(borders)))
