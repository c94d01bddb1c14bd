# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of a mesh, in edit mode or not: those of the add-on by name, values of faces, colors of corners."""

from itertools import compress

import bmesh
import bpy
import numpy as np


def integer_layers(mesh: bpy.types.Mesh, prefix: str, domain: str) -> list[str]:
    """Return the integer attributes of a domain whose names start with `prefix`; others are not the add-on's."""
    ours = [each for each in mesh.attributes if each.name.startswith(prefix)]
    return [each.name for each in ours if (each.data_type, each.domain) == ("INT", domain)]


def store_face_values(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    """Write a number per face, (F,), to the attribute of this name, replacing it."""
    if mesh.is_editmode:
        set_face_values(mesh, name, np.ones(len(values), dtype=bool), values)
    else:
        _new_attribute(mesh, name, "FLOAT", "FACE").foreach_set("value", values.astype(np.float32))


def set_face_values(mesh: bpy.types.Mesh, name: str, faces: np.ndarray, values: np.ndarray) -> None:
    """Set numbers (F,) on some `faces`, (F,) bool, of a mesh in edit mode; in a new attribute others have 0."""
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.faces.layers.float.get(name) or bm.faces.layers.float.new(name)
    for face, value in compress(zip(bm.faces, values.tolist()), faces.tolist()):
        face[layer] = value
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def store_corner_colors(mesh: bpy.types.Mesh, name: str, colors: np.ndarray) -> None:
    """Write a linear color per face, (F, 4), to its corners in the color attribute of this name, replacing it."""
    sizes = np.empty(len(mesh.polygons), dtype=np.int32)
    if not mesh.is_editmode:
        mesh.polygons.foreach_get("loop_total", sizes)
        corners = np.repeat(colors.astype(np.float32), sizes, axis=0)
        _new_attribute(mesh, name, "FLOAT_COLOR", "CORNER").foreach_set("color", corners.ravel())
        return
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.loops.layers.float_color.get(name) or bm.loops.layers.float_color.new(name)
    for face, color in zip(bm.faces, colors.tolist()):
        for loop in face.loops:
            loop[layer] = color
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _new_attribute(mesh: bpy.types.Mesh, name: str, kind: str, domain: str) -> bpy.types.bpy_prop_collection:
    old = mesh.attributes.get(name)
    if old is not None:
        mesh.attributes.remove(old)
    return mesh.attributes.new(name, kind, domain).data
