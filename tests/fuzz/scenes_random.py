# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes in edit mode: one generator of random numbers makes one scene, always the same in one Blender."""

import bmesh
import bpy
import numpy as np

from tests.module import hard_meshes

PRIMITIVES = (
    lambda rng: bpy.ops.mesh.primitive_plane_add(),
    lambda rng: bpy.ops.mesh.primitive_cube_add(),
    lambda rng: bpy.ops.mesh.primitive_monkey_add(),
    lambda rng: bpy.ops.mesh.primitive_uv_sphere_add(segments=int(rng.integers(3, 20)), ring_count=4),
    lambda rng: bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=int(rng.integers(1, 4))),
    lambda rng: bpy.ops.mesh.primitive_cylinder_add(
        vertices=int(rng.integers(3, 30)), end_fill_type=str(rng.choice(["NOTHING", "NGON", "TRIFAN"]))
    ),
    lambda rng: bpy.ops.mesh.primitive_cone_add(vertices=int(rng.integers(3, 30)), radius2=float(rng.integers(0, 2))),
    lambda rng: bpy.ops.mesh.primitive_torus_add(major_segments=12, minor_segments=6),
    lambda rng: bpy.ops.mesh.primitive_circle_add(fill_type=str(rng.choice(["NOTHING", "NGON", "TRIFAN"]))),
    lambda rng: bpy.ops.mesh.primitive_grid_add(x_subdivisions=int(rng.integers(1, 20)), y_subdivisions=7),
)
MODIFIERS = ("SUBSURF", "MIRROR", "ARRAY", "BOOLEAN", "DECIMATE", "SOLIDIFY", "BEVEL", "TRIANGULATE")
# Coordinates that are extreme or no numbers.
EXTREMES = (1e20, -1e20, 1e-30, 3e38, np.nan, np.inf)


def make(rng):
    """Make a scene of one to three objects and enter edit mode with some of them; return those."""
    objects = [_object(rng) for _ in range(rng.integers(1, 4))]
    if rng.random() < 0.15 and len(objects) > 1:
        objects = _join(objects)
    for made in objects:
        _dress(rng, made)
    if rng.random() < 0.2:
        objects.append(_linked(objects[0]))
    edited = [made for made in objects if rng.random() < 0.8] or objects[:1]
    bpy.ops.object.select_all(action="DESELECT")
    for made in edited:
        made.select_set(True)
    bpy.context.view_layer.objects.active = edited[0]
    _settings(rng)
    bpy.ops.object.mode_set(mode="EDIT")
    for made in edited:
        _edit(rng, made)
    return edited


def _object(rng):
    """Make an object with a random mesh and apply some changes of its shape."""
    made = _primitive(rng) if rng.random() < 0.65 else _of_arrays(rng)
    changes = ((_boolean, 0.12), (_dissolve, 0.25), (_collapse, 0.15), (_loose, 0.2), (_repeat_faces, 0.12))
    _maybe(rng, made, changes)
    return made


def _maybe(rng, made, changes):
    """Make some of the (change, chance)."""
    for change, chance in changes:
        if rng.random() < chance:
            change(rng, made)


def _primitive(rng):
    PRIMITIVES[rng.integers(len(PRIMITIVES))](rng)
    made = bpy.context.object
    if rng.random() < 0.4:
        while made.data.uv_layers:
            made.data.uv_layers.remove(made.data.uv_layers[0])
    return made


def _of_arrays(rng):
    """Make a hard case, a soup of random faces, or an empty mesh."""
    if rng.random() < 0.6:
        cases = [case for name, case in hard_meshes.GENERATED.items() if name not in ("comb", "helix", "fan", "strip")]
        vertices, faces = cases[rng.integers(len(cases))].make()
    else:
        count = int(rng.integers(0, 30))
        vertices = rng.normal(size=(count, 3))
        sizes = rng.integers(3, 7, size=count)
        faces = [rng.choice(count, size, replace=False).tolist() for size in sizes if size <= count]
    mesh = bpy.data.meshes.new("Arrays")
    mesh.from_pydata(np.asarray(vertices, float).reshape(-1, 3).tolist(), [], [list(map(int, face)) for face in faces])
    made = bpy.data.objects.new("Arrays", mesh)
    bpy.context.collection.objects.link(made)
    return made


def _boolean(rng, made):
    """Cut a cube out of the object, or add it, for good."""
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=rng.normal(size=3) * 0.5)
    cutter = bpy.context.object
    modifier = made.modifiers.new("Cut", "BOOLEAN")
    modifier.object, modifier.operation = cutter, str(rng.choice(["UNION", "DIFFERENCE", "INTERSECT"]))
    bpy.context.view_layer.objects.active = made
    if _is_finite(made):
        bpy.ops.object.modifier_apply(modifier=modifier.name)
    else:
        made.modifiers.remove(modifier)
    bpy.data.objects.remove(cutter)


def _is_finite(made):
    """Return whether an object has vertices, all with finite positions."""
    places = [vertex.co[:] for vertex in made.data.vertices]
    return bool(places) and bool((np.abs(places) < 1e30).all())


def _with_bmesh(made, change):
    bm = bmesh.new()
    bm.from_mesh(made.data)
    for elements in (bm.verts, bm.edges, bm.faces):
        elements.ensure_lookup_table()
    change(bm)
    bm.to_mesh(made.data)
    bm.free()


def _some(rng, elements, share):
    return [element for element in elements if rng.random() < share]


def _dissolve(rng, made):
    """Join faces to polygons, some of them concave."""

    def change(bm):
        # One at a time and without the vertices: what becomes of the rest depends on where it lies in memory.
        for edge in _some(rng, bm.edges, 0.1):
            if edge.is_valid and len(edge.link_faces) == 2:
                bmesh.ops.dissolve_edges(bm, edges=[edge], use_verts=False)

    _with_bmesh(made, change)


def _collapse(rng, made):
    """Move vertices onto neighbors, so that faces lose their area."""

    def change(bm):
        for edge in _some(rng, bm.edges, 0.05):
            edge.verts[0].co = edge.verts[1].co

    _with_bmesh(made, change)


def _loose(rng, made):
    """Add edges and vertices without faces."""

    def change(bm):
        ends = [bm.verts.new(rng.normal(size=3)) for _ in range(6)]
        bm.edges.new(ends[:2])
        bm.edges.new(ends[1:3])

    _with_bmesh(made, change)


def _repeat_faces(rng, made):
    """Let some faces occur twice, some of them turned around."""
    faces = [list(face.vertices) for face in made.data.polygons]
    more = [face[::-1] if rng.random() < 0.5 else face for face in _some(rng, faces, 0.1)]
    mesh = bpy.data.meshes.new("Repeated")
    mesh.from_pydata([vertex.co[:] for vertex in made.data.vertices], [], faces + more)
    made.data = mesh


def _join(objects):
    bpy.ops.object.select_all(action="DESELECT")
    for made in objects[:2]:
        made.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.join()
    return [objects[0], *objects[2:]]


def _linked(made):
    twin = bpy.data.objects.new("Linked", made.data)
    bpy.context.collection.objects.link(twin)
    return twin


def _dress(rng, made):
    """Give an object what users do: scale, UV maps, seams, keys, groups, materials, modifiers."""
    made.scale = rng.choice([1.0, 1.0, -1.0, 0.0, 3.0, 1e-3], size=3)
    dresses = (
        *((_uv_maps, 0.8), (_extremes, 0.12), (_seams, 0.5), (_attributes, 0.3)),
        *((_groups, 0.2), (_keys, 0.25), (_materials, 0.25), (_modifiers, 0.35)),
    )
    _maybe(rng, made, dresses)


def _uv_maps(rng, made):
    mesh = made.data
    for _ in range(rng.integers(0, 3)):
        layer = mesh.uv_layers.new()
        if layer is None or not len(mesh.loops):
            continue
        uv = rng.random((len(mesh.loops), 2), dtype=np.float32)
        if rng.random() < 0.1:
            uv[rng.random(len(uv)) < 0.2] = np.nan
        mesh.uv_layers[-1].data.foreach_set("uv", uv.ravel())
    if mesh.uv_layers:
        mesh.uv_layers.active_index = int(rng.integers(len(mesh.uv_layers)))


def _extremes(rng, made):
    for vertex in _some(rng, made.data.vertices, 2.0 / (1 + len(made.data.vertices))):
        vertex.co[rng.integers(3)] = float(rng.choice(EXTREMES))


def _seams(rng, made):
    share = rng.random() ** 2
    for edge in made.data.edges:
        edge.use_seam = bool(rng.random() < share)
        edge.use_edge_sharp = bool(rng.random() < 0.1)


def _attributes(rng, made):
    mesh = made.data
    for kind, domain, dtype in (("FLOAT", "POINT", np.float32), ("INT", "FACE", np.int32), ("BOOLEAN", "EDGE", bool)):
        attribute = mesh.attributes.new(f"{kind} of {domain}", kind, domain)
        attribute.data.foreach_set("value", rng.integers(0, 2, len(attribute.data)).astype(dtype))


def _groups(rng, made):
    group = made.vertex_groups.new(name="Group")
    group.add([vertex.index for vertex in _some(rng, made.data.vertices, 0.3)], 0.5, "REPLACE")


def _keys(rng, made):
    # Blender adds and subtracts shape keys where it likes, and infinity less infinity is no number.
    if not _is_finite(made):
        return
    for name in ("Basis", "Key"):
        key = made.shape_key_add(name=name)
    for point in key.data:
        point.co.z += rng.normal()
    key.value = 0.5
    made.active_shape_key_index = int(rng.integers(2))


def _materials(rng, made):
    material = bpy.data.materials.new("Material")
    made.data.materials.append(material)
    made.data.materials.append(None)
    # New data has them from 5.0 on; Blender 6 will know no use_nodes.
    if material.node_tree is None:
        material.use_nodes = True
    nodes = material.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    if rng.random() < 0.7:
        texture.image = bpy.data.images.new("Image", 16, int(rng.choice([1, 16, 48])))
    for face in made.data.polygons:
        face.material_index = int(rng.integers(3))


def _modifiers(rng, made):
    finite = _is_finite(made)
    for kind in rng.choice(MODIFIERS, rng.integers(1, 4)):
        # Blender itself hangs or crashes where it evaluates these for what is no number.
        if finite or kind == "MIRROR":
            made.modifiers.new(str(kind).title(), str(kind))


def _settings(rng):
    tool_settings = bpy.context.scene.tool_settings
    tool_settings.use_uv_select_sync = bool(rng.random() < 0.5)
    modes = rng.random(3) < 0.5
    tool_settings.mesh_select_mode = tuple(map(bool, modes)) if modes.any() else (False, False, True)


def _edit(rng, made):
    """Select, hide, pin; choose the active face and edge."""
    bm = bmesh.from_edit_mesh(made.data)
    for elements in (bm.verts, bm.edges, bm.faces):
        elements.ensure_lookup_table()
    share = rng.choice([0.0, 0.3, 0.9, 1.0], p=[0.08, 0.22, 0.2, 0.5])
    kind = (bm.faces, bm.edges, bm.verts)[rng.choice(3, p=[0.7, 0.15, 0.15])]
    for element in (*bm.verts, *bm.edges, *bm.faces):
        element.select = False
    bm.select_history.clear()
    for element in _some(rng, kind, share):
        element.select_set(True)
    bm.select_flush_mode()
    if rng.random() < 0.25:
        for face in _some(rng, bm.faces, 0.2):
            face.hide_set(True)
    if len(bm.faces) and rng.random() < 0.5:
        bm.faces.active = bm.faces[rng.integers(len(bm.faces))]
    edges = [edge for edge in bm.edges if edge.select]
    if edges and rng.random() < 0.3:
        bm.select_history.add(edges[rng.integers(len(edges))])
    layer = bm.loops.layers.uv.active
    if layer is not None:
        _edit_uvs(rng, bm, layer)
    bmesh.update_edit_mesh(made.data)


def _edit_uvs(rng, bm, layer):
    pinned = rng.choice([0.0, 0.02, 0.3, 1.0], p=[0.7, 0.15, 0.1, 0.05])
    selected = rng.random()
    on_mesh = hasattr(bmesh.types.BMLoop, "uv_select_vert")
    for face in bm.faces:
        for loop in face.loops:
            if pinned and rng.random() < pinned:
                loop[layer].pin_uv = True
            flag = bool(rng.random() < selected)
            if on_mesh:
                loop.uv_select_vert = loop.uv_select_edge = flag
            else:
                loop[layer].select = loop[layer].select_edge = flag
        if on_mesh:
            face.uv_select = all(loop.uv_select_vert for loop in face.loops)
