# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes to unwrap, and measures of the results."""

import importlib
import sys

import bmesh
import bpy
import numpy as np


def module(name):
    """A module of the enabled add-on."""
    return sys.modules[f"spectral_unwrap.{name}"]


def new_object(vertices, faces, seams=(), name="Object", uv_map=True):
    """Make an object of a polygon mesh; `seams` are vertex pairs, and the UV map, if any, starts as noise."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, vertex)) for vertex in vertices], [], [tuple(map(int, face)) for face in faces])
    seams = {frozenset(map(int, seam)) for seam in seams}
    for edge in mesh.edges:
        edge.use_seam = frozenset(edge.vertices) in seams
    if uv_map:
        layer = mesh.uv_layers.new(name="UVMap")
        uv = np.random.default_rng(0).random(2 * len(mesh.loops), dtype=np.float32)
        layer.data.foreach_set("uv", uv)
    new = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(new)
    return new


def grid(columns, rows, name="Grid", offset=(0.0, 0.0, 0.0), **options):
    """A flat grid of unit squares."""
    x, y = np.meshgrid(np.arange(columns + 1), np.arange(rows + 1))
    vertices = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3) + np.asarray(offset)
    return new_object(vertices, _quads(columns, rows, columns + 1), name=name, **options)


def cylinder(segments=24, rows=6, closed_seam=True, name="Cylinder", **options):
    """An open cylinder of radius 1 and height 2, with a seam from end to end."""
    angle = np.arange(segments) * (2.0 * np.pi / segments)
    vertices = [(np.cos(a), np.sin(a), 2.0 * z / rows) for z in range(rows + 1) for a in angle]
    faces = [
        (
            r * segments + c,
            r * segments + (c + 1) % segments,
            (r + 1) * segments + (c + 1) % segments,
            (r + 1) * segments + c,
        )
        for r in range(rows)
        for c in range(segments)
    ]
    seams = [(r * segments, (r + 1) * segments) for r in range(rows)] if closed_seam else []
    return new_object(vertices, faces, seams, name=name, **options)


CUBE_FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def cube_parts(size=1.0, offset=(0.0, 0.0, 0.0)):
    """Vertices and faces of a closed cube."""
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    return corners * size + np.asarray(offset), np.array(CUBE_FACES)


def cube(size=1.0, offset=(0.0, 0.0, 0.0), all_seams=False, name="Cube", **options):
    """A closed cube; with `all_seams` six separate charts."""
    vertices, faces = cube_parts(size, offset)
    seams = [(face[i - 1], face[i]) for face in faces for i in range(4)] if all_seams else []
    return new_object(vertices, faces, seams, name=name, **options)


def grid_and_cube(name="Grid and cube", **options):
    """A flat 3 x 2 grid, faces 0 to 5, and a closed cube, faces 6 to 11, in one mesh."""
    x, y = np.meshgrid(np.arange(4), np.arange(3))
    flat = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    vertices, faces = cube_parts(offset=(10.0, 0.0, 0.0))
    return new_object(np.vstack([flat, vertices]), [*_quads(3, 2, 4), *(faces + len(flat))], name=name, **options)


def _quads(columns, rows, stride):
    return [
        (r * stride + c, r * stride + c + 1, (r + 1) * stride + c + 1, (r + 1) * stride + c)
        for r in range(rows)
        for c in range(columns)
    ]


def edit(*objects, select=True):
    """Enter edit mode with these objects and select all or none of their faces."""
    bpy.ops.object.select_all(action="DESELECT")
    for edited in objects:
        edited.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.editmode_toggle()
    bpy.ops.mesh.select_mode(type="FACE")
    bpy.ops.mesh.select_all(action="SELECT" if select else "DESELECT")


def edit_mesh(edited):
    """Return the edit mesh with its lookup tables ready."""
    bm = bmesh.from_edit_mesh(edited.data)
    for elements in (bm.verts, bm.edges, bm.faces):
        elements.ensure_lookup_table()
    return bm


def selected_faces(edited):
    return [face.index for face in edit_mesh(edited).faces if face.select]


def seams(edited):
    return {frozenset(vertex.index for vertex in edge.verts) for edge in edit_mesh(edited).edges if edge.seam}


def select_faces(edited, faces):
    """Select exactly these faces."""
    bm = edit_mesh(edited)
    for face in bm.faces:
        face.select = False
    for face in faces:
        bm.faces[face].select = True
    bm.select_flush_mode()
    bmesh.update_edit_mesh(edited.data)


def read_uv(edited, layer_name=None):
    """Return the UVs of all face corners, (C, 2) float64."""
    bm = edit_mesh(edited)
    layers = bm.loops.layers.uv
    layer = layers[layer_name] if layer_name else layers.active
    return np.array([loop[layer].uv for face in bm.faces for loop in face.loops], dtype=np.float64)


def write_uv(edited, uv):
    """Set the UVs of all face corners, (C, 2)."""
    bm = edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    for loop, coordinates in zip((loop for face in bm.faces for loop in face.loops), uv):
        loop[layer].uv = coordinates
    bmesh.update_edit_mesh(edited.data)


def corner_vertices(edited):
    """Return the vertex of every face corner, (C,) int."""
    return np.array([loop.vert.index for face in edit_mesh(edited).faces for loop in face.loops])


def select_vertices(edited, vertices):
    """Select exactly these vertices."""
    for vertex in edit_mesh(edited).verts:
        vertex.select_set(vertex.index in vertices)


def half_of(extender):
    """The strength of 50 % of an entry of the list."""
    return module("edit_mesh.shapes").of_layer(extender.layer).half


def clear_seams(edited):
    for edge in edit_mesh(edited).edges:
        edge.seam = False


def corners_of(edited, faces):
    """Return which corners belong to `faces`, (C,) bool."""
    faces = set(faces)
    return np.array([face.index in faces for face in edit_mesh(edited).faces for _ in face.loops])


def directly_solved(edited, **options):
    """Return the map that the native module makes of the whole mesh; an island of the operator's is similar to it.

    Options that are not given are those that the operator begins with.
    """
    options = {"polish": "angles", "hole_rigidity": "automatic", **options}
    native = importlib.import_module("spectral_unwrap.core.native").spectral_conformal()
    bm = edit_mesh(edited)
    offsets = np.cumsum([0] + [len(face.loops) for face in bm.faces])
    corners = [loop.vert.index for face in bm.faces for loop in face.loops]
    seams = np.array([[vertex.index for vertex in edge.verts] for edge in bm.edges if edge.seam], int).reshape(-1, 2)
    positions = np.array([vertex.co for vertex in bm.verts])
    return native.unwrap(positions, offsets, corners, seam_edges=seams, **options).uv


def normalized(uv):
    """Return a map without its place, size and orientation: its pairwise distances over their root mean square."""
    distance = np.linalg.norm(uv[:, None] - uv[None, :], axis=2)
    return distance / np.sqrt((distance**2).mean())


def corner_positions(edited):
    """Return the 3D position of every face corner, (C, 3)."""
    return np.array([loop.vert.co for face in edit_mesh(edited).faces for loop in face.loops], dtype=np.float64)


def stretches(edited, faces=None):
    """Return UV length over 3D length of every side and diagonal of the quads `faces`, all by default."""
    uv, positions = read_uv(edited), corner_positions(edited)
    first = np.cumsum([0] + [len(face.loops) for face in edit_mesh(edited).faces])
    quads = range(len(first) - 1) if faces is None else faces
    pairs = [(first[q] + i, first[q] + j) for q in quads for i in range(4) for j in range(i)]
    a, b = np.transpose(pairs)
    return np.linalg.norm(uv[a] - uv[b], axis=1) / np.linalg.norm(positions[a] - positions[b], axis=1)


def quasi_conformal(edited):
    """Return QC and 3D area of every triangle of a fan of every face; (T,) each."""
    uv, positions = read_uv(edited), corner_positions(edited)
    triangles, first = [], 0
    for face in edit_mesh(edited).faces:
        triangles += [(first, first + i, first + i + 1) for i in range(1, len(face.loops) - 1)]
        first += len(face.loops)
    a, b, c = np.transpose(triangles)
    e, f = positions[b] - positions[a], positions[c] - positions[a]
    length = np.linalg.norm(e, axis=1)
    x = (e * f).sum(axis=1) / length
    y = np.linalg.norm(np.cross(e, f), axis=1) / length
    frame = np.stack([np.stack([length, x], axis=-1), np.stack([0 * x, y], axis=-1)], axis=1)
    image = np.stack([uv[b] - uv[a], uv[c] - uv[a]], axis=-1)
    singular = np.linalg.svd(image @ np.linalg.inv(frame), compute_uv=False)
    return singular[:, 0] / singular[:, 1], length * y / 2.0


def bounds(uv):
    """Return the lower and upper corner of the bounding box of `uv` (N, 2)."""
    return uv.min(axis=0), uv.max(axis=0)


def overlap(uv_a, uv_b):
    """Return whether the bounding boxes of two sets of UVs overlap by more than single precision."""
    (low_a, high_a), (low_b, high_b) = bounds(uv_a), bounds(uv_b)
    return bool((np.minimum(high_a, high_b) - np.maximum(low_a, low_b) > 1e-6).all())


def overlapping_faces(*edited):
    """Return which faces of the objects overlap another in the map, in their own island or not, (sum of F,) bool."""
    read = importlib.import_module("spectral_unwrap.edit_mesh.read")
    defects = importlib.import_module("spectral_unwrap.core.measure.defects")
    found = defects.find([read.read_mesh(each, read.Reading(all_visible=True)).polygons for each in edited], True)
    return np.concatenate([each.overlapping for each in found])


def uv_flags(edited):
    """Return the UV selection of all corners and faces, however this version stores it."""
    bm = edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    loops = [loop for face in bm.faces for loop in face.loops]
    if hasattr(loops[0], "uv_select_vert"):
        corners = [(loop.uv_select_vert, loop.uv_select_edge) for loop in loops]
        return corners, [face.uv_select for face in bm.faces], bm.uv_select_sync_valid
    return [(loop[layer].select, loop[layer].select_edge) for loop in loops]


def set_uv_flags(edited, corners):
    """Set the UV selection of every corner from `corners`, (C,) bool."""
    bm = edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    for loop, flag in zip((loop for face in bm.faces for loop in face.loops), corners):
        if hasattr(loop, "uv_select_vert"):
            loop.uv_select_vert = loop.uv_select_edge = bool(flag)
        else:
            loop[layer].select = loop[layer].select_edge = bool(flag)
    for face in bm.faces:
        if hasattr(face, "uv_select"):
            face.uv_select = all(loop.uv_select_vert for loop in face.loops)


def pin(edited, corners):
    """Pin exactly these corners, given as indices or (C,) bool, in the active UV map."""
    flags = np.zeros(len(read_uv(edited)), dtype=bool)
    flags[corners] = True
    bm = edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    for loop, flag in zip((loop for face in bm.faces for loop in face.loops), flags.tolist()):
        loop[layer].pin_uv = flag
    bmesh.update_edit_mesh(edited.data)


def pins(edited):
    """Return which corners are pinned, (C,) bool."""
    bm = edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    return np.array([loop[layer].pin_uv for face in bm.faces for loop in face.loops])


def bumpy_grid(columns=6, rows=4, name="Bumpy grid", **options):
    """A grid that is not flat, so that no two methods map it alike."""
    new = grid(columns, rows, name=name, **options)
    for vertex in new.data.vertices:
        vertex.co.z = 0.8 * np.sin(vertex.co.x) * np.cos(0.7 * vertex.co.y)
    return new


def show_image(shown, width, height):
    """Give an object, not in edit mode, a material with an image of this size."""
    material = bpy.data.materials.new("Material")
    # New data has them from 5.0 on; Blender 6 will know no use_nodes.
    if material.node_tree is None:
        material.use_nodes = True
    nodes = material.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.new("Image", width, height)
    nodes.active = texture
    shown.data.materials.append(material)


def state(edited):
    """Return everything that an unwrap must not change: all but the active UV map's coordinates."""
    bm = edit_mesh(edited)
    tool_settings = bpy.context.scene.tool_settings
    return {
        "vertices": [(tuple(v.co), v.select, v.hide) for v in bm.verts],
        "edges": [(e.select, e.hide, e.seam, e.smooth) for e in bm.edges],
        "faces": [(f.select, f.hide, f.smooth, f.material_index) for f in bm.faces],
        "active face": bm.faces.active and bm.faces.active.index,
        "selection history": [(type(element).__name__, element.index) for element in list(bm.select_history)],
        "select mode": bm.select_mode,
        "UV selection": uv_flags(edited),
        "UV maps": [(layer.name, layer.active, layer.active_render) for layer in edited.data.uv_layers],
        "other UV maps": {
            layer.name: read_uv(edited, layer.name).tolist() for layer in edited.data.uv_layers if not layer.active
        },
        "tool settings": {
            name: getattr(tool_settings, name)
            for name in ("use_uv_select_sync", "uv_select_mode", "uv_sticky_select_mode")
        }
        | {"mesh_select_mode": tuple(tool_settings.mesh_select_mode)},
        "vertex groups": [[dict(v[layer].items()) for v in bm.verts] for layer in bm.verts.layers.deform.values()],
        "shape keys": [[tuple(v[layer]) for v in bm.verts] for layer in bm.verts.layers.shape.values()],
        "pins": [pins(edited).tolist()] if edited.data.uv_layers else [],
        "data blocks": {
            kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in ("meshes", "objects", "scenes")
        },
        "view layer": (
            bpy.context.view_layer.objects.active.name,
            sorted(selected.name for selected in bpy.context.selected_objects),
            bpy.context.mode,
        ),
    }
