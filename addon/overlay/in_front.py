# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing on the faces of a mesh without z-fighting."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import gpu
from mathutils import Matrix

# Drawings on faces move this fraction of the distance toward the viewer.
_NEARER = 0.003


@contextmanager
def in_front_of_faces(view: bpy.types.RegionView3D, nearer: float = _NEARER) -> Iterator[None]:
    """Draw with blending, without writing depth, and in front of faces at the same depth, within the context."""
    if view.is_perspective:
        shift = Matrix.Scale(1.0 - nearer, 4)
        shift[3][3] = 1.0
    else:
        shift = Matrix.Translation((0.0, 0.0, nearer * view.view_distance))
    writes_depth = gpu.state.depth_mask_get()
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)
    try:
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(shift @ gpu.matrix.get_model_view_matrix())
            yield
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(writes_depth)
        gpu.state.blend_set("NONE")
