# SPDX-License-Identifier: GPL-3.0-or-later
"""Distortion and length of suggested seams, and the island borders of Blender's Smart UV Project as their yardstick."""

from dataclasses import dataclass

import bmesh
import bpy
import numpy as np


@dataclass(frozen=True)
class Measures:
    mean_qc: float
    within: float
    """Share of the area in 3D whose linear scale lies within a factor 2 of the median."""
    islands: int
    unsolved: int


def monkey(levels=0):
    """Suzanne, subdivided `levels` times, as the only selected object."""
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    if levels:
        suzanne.modifiers.new("Subdivision", "SUBSURF").levels = levels
        bpy.ops.object.modifier_apply(modifier="Subdivision")
    return suzanne


def arrays(solid):
    """(vertices, face_offsets, corner_vertices) of an object's mesh."""
    mesh = solid.data
    vertices = np.array([vertex.co[:] for vertex in mesh.vertices], dtype=np.float64)
    faces = [list(polygon.vertices) for polygon in mesh.polygons]
    return vertices, np.r_[0, np.cumsum([len(face) for face in faces])], np.concatenate(faces)


def length(vertices, edges):
    return float(np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).sum())


def smart_project_border(solid):
    """Length of the edges, each once, along which Smart UV Project with its default settings parts islands."""
    bpy.ops.object.select_all(action="DESELECT")
    solid.select_set(True)
    bpy.context.view_layer.objects.active = solid
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project()
    bm = bmesh.from_edit_mesh(solid.data)
    layer = bm.loops.layers.uv.active
    border = 0.0
    for edge in bm.edges:
        sides = [{corner.vert: corner[layer].uv.copy() for corner in (c, c.link_loop_next)} for c in edge.link_loops]
        if len(sides) == 2 and any((sides[0][v] - sides[1][v]).length > 1e-6 for v in edge.verts):
            border += edge.calc_length()
    bpy.ops.object.mode_set(mode="OBJECT")
    return border


def measure(native, mesh, seams):
    """Unwrap with these seams and measure the result face by face; each island has its area in 3D."""
    vertices, offsets, corners = mesh
    result = native.unwrap(vertices, offsets, corners, seam_edges=seams)
    uv = np.c_[result.uv, np.zeros(len(result.uv))]
    area, image = (np.linalg.norm(_vector_areas(points, offsets), axis=1) for points in (vertices[corners], uv))
    solved = np.array([chart.status == "solved" for chart in result.charts])[result.chart_of_face] & (area > 0)
    scale = np.log2(np.maximum(image[solved], 1e-300) / area[solved]) / 2
    order = np.argsort(scale)
    summed = np.cumsum(area[solved][order])
    median = scale[order][np.searchsorted(summed, summed[-1] / 2)] if len(summed) else 0.0
    charts = [chart for chart in result.charts if chart.status == "solved"]
    return Measures(
        mean_qc=float(np.average([c.mean_qc for c in charts], weights=[c.area for c in charts])) if charts else np.nan,
        within=float(area[solved][np.abs(scale - median) <= 1].sum() / area.sum()),
        islands=len(result.charts),
        unsolved=len(result.charts) - len(charts),
    )


def _vector_areas(points, offsets):
    """(faces, 3) vector area of each polygon from the positions of its corners."""
    sizes = np.diff(offsets)
    face = np.repeat(np.arange(len(sizes)), sizes)
    following = np.arange(len(points)) + 1
    following[offsets[1:] - 1] = offsets[:-1]
    origin = points[offsets[:-1]][face]
    result = np.zeros((len(sizes), 3))
    np.add.at(result, face, np.cross(points - origin, points[following] - origin) / 2)
    return result
