"""Models with seams for the benchmarks: made here, or read from a folder; the borders of UV islands become seams.

Needs `bpy`: every model becomes an object in its scene.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy  # isort: skip - first: it puts Blender's own modules on the path

import bmesh
import numpy as np
from mathutils import Vector
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

IMPORTERS: dict[str, Callable[[str], object]] = {
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_import(filepath=path),
    ".fbx": lambda path: bpy.ops.import_scene.fbx(filepath=path),
    ".glb": lambda path: bpy.ops.import_scene.gltf(filepath=path),
    ".gltf": lambda path: bpy.ops.import_scene.gltf(filepath=path),
}
# Seams of hard surfaces: edges where faces meet at more than this angle.
SHARP = math.radians(40)


@dataclass(frozen=True)
class Islands:
    """The islands of an object's mesh that have a map: triangulated manifolds of genus 0 with a boundary.

    Attributes:
        positions: (N, 3) of island vertices, one for every copy at a seam.
        triangles: per island (T, 3) island vertices.
        faces: per island the faces of the mesh.
        corner: (N,) a face corner (loop) of each island vertex.
    """

    positions: np.ndarray
    triangles: list[np.ndarray]
    faces: list[np.ndarray]
    corner: np.ndarray


def empty_scene() -> None:
    """Begin with an empty file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def read(path: Path) -> list[bpy.types.Object]:
    """Import a model; return its objects that have a UV map, whose island borders are then the seams."""
    empty_scene()
    IMPORTERS[path.suffix.lower()](str(path))
    found = [item for item in bpy.context.scene.objects if item.type == "MESH" and item.data.uv_layers]
    for item in found:
        item.data = item.data.copy()  # users of one mesh would be one model
        item.modifiers.clear()
        item.shape_key_clear()
        if path.suffix.lower() in (".glb", ".gltf"):
            merge_vertices(item.data)  # the format splits them where UVs differ
        seams_from_islands(item.data)
    return found


def merge_vertices(mesh: bpy.types.Mesh) -> None:
    """Merge vertices that lie in one place."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    extent = max((vertex.co.length for vertex in bm.verts), default=0.0)
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-6 * extent)
    bm.to_mesh(mesh)
    bm.free()


def array(collection: object, name: str, dtype: type, size: int = 1) -> np.ndarray:
    """Read a property of all items of a Blender collection."""
    values = np.empty(len(collection) * size, dtype=dtype)
    collection.foreach_get(name, values)
    return values.reshape(-1, size) if size > 1 else values


def uv_of(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the active UV map, (loops, 2)."""
    return array(mesh.uv_layers.active.data, "uv", np.float32, 2).astype(float)


def set_seams(mesh: bpy.types.Mesh, seams: np.ndarray) -> None:
    """Mark the edges where `seams`, (edges,), is true, and no others."""
    mesh.edges.foreach_set("use_seam", np.ascontiguousarray(seams, dtype=bool))


def pairs_of_loops(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges with two faces, (P,), and the two loops that begin each, (P, 2)."""
    edge = array(mesh.loops, "edge_index", np.int32)
    order = np.argsort(edge, kind="stable")
    counts = np.bincount(edge, minlength=len(mesh.edges))
    starts = np.cumsum(counts) - counts
    paired = np.flatnonzero(counts == 2)
    return paired, np.stack([order[starts[paired]], order[starts[paired] + 1]], axis=1)


def next_loops(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return for every loop the next of its face, (loops,)."""
    start = array(mesh.polygons, "loop_start", np.int32)
    total = array(mesh.polygons, "loop_total", np.int32)
    following = np.arange(1, len(mesh.loops) + 1)
    following[start + total - 1] = start
    return following


def seams_from_islands(mesh: bpy.types.Mesh) -> None:
    """Mark the borders of the UV islands."""
    uv = uv_of(mesh)
    following = next_loops(mesh)
    edges, loops = pairs_of_loops(mesh)
    a, b = loops.T
    # Two faces of one orientation run along their edge in opposite directions.
    vertex = array(mesh.loops, "vertex_index", np.int32)
    same_direction = vertex[a] == vertex[b]
    begins, ends = np.where(same_direction, b, following[b]), np.where(same_direction, following[b], b)
    torn = np.abs(uv[a] - uv[begins]).max(axis=1, initial=0) > 1e-6
    torn |= np.abs(uv[following[a]] - uv[ends]).max(axis=1, initial=0) > 1e-6
    seams = np.zeros(len(mesh.edges), dtype=bool)
    seams[edges[torn]] = True
    set_seams(mesh, seams)


def islands(mesh: bpy.types.Mesh) -> Islands:
    """Return the islands between seams, those with more than eight triangles that have a map."""
    import spectral_conformal as sc

    vertex = array(mesh.loops, "vertex_index", np.int32)
    start = array(mesh.polygons, "loop_start", np.int32)
    face_of_loop = np.repeat(np.arange(len(mesh.polygons)), array(mesh.polygons, "loop_total", np.int32))
    following = next_loops(mesh)
    edges, loops = pairs_of_loops(mesh)
    joined = ~array(mesh.edges, "use_seam", bool)[edges]
    a, b = loops[joined].T
    opposite = vertex[a] != vertex[b]
    glued = (
        np.concatenate([a, following[a]]),
        np.concatenate([np.where(opposite, following[b], b), np.where(opposite, b, following[b])]),
    )
    n = len(mesh.loops)
    n_copies, copy = connected_components(coo_array((np.ones(len(glued[0])), glued), shape=(n, n)))
    faces = (face_of_loop[a], face_of_loop[b])
    n_faces = len(mesh.polygons)
    n_islands, island = connected_components(coo_array((np.ones(len(a)), faces), shape=(n_faces, n_faces)))
    corner = np.zeros(n_copies, dtype=int)
    corner[copy] = np.arange(n)
    positions = array(mesh.vertices, "co", np.float32, 3).astype(float)[vertex[corner]]
    mesh.calc_loop_triangles()
    triangles = copy[array(mesh.loop_triangles, "loops", np.int32, 3)]
    island_of_triangle = island[array(mesh.loop_triangles, "polygon_index", np.int32)]
    found = Islands(positions, [], [], corner)
    for i in range(n_islands):
        own = triangles[island_of_triangle == i]
        if len(own) <= 8:
            continue
        used, local = np.unique(own, return_inverse=True)
        try:
            sc.Solver(positions[used], local.reshape(own.shape))
        except sc.InvalidMeshError:
            continue  # closed, not manifold, not orientable, or of higher genus
        found.triangles.append(own)
        found.faces.append(np.flatnonzero(island == i))
    assert len(start) == n_faces
    return found


def generated() -> Iterator[tuple[str, bpy.types.Object]]:
    """Make the models one by one, each alone in its scene."""
    for name, make in GENERATED.items():
        empty_scene()
        made = make()
        made.name = name
        yield name, made


def face_centers(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the centers of all faces, (F, 3)."""
    return array(mesh.polygons, "center", np.float32, 3).astype(float)


def seams_between(mesh: bpy.types.Mesh, differ: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> None:
    """Mark the edges for whose two faces `differ` is true."""
    face_of_loop = np.repeat(np.arange(len(mesh.polygons)), array(mesh.polygons, "loop_total", np.int32))
    edges, loops = pairs_of_loops(mesh)
    first, second = face_of_loop[loops].T
    seams = np.zeros(len(mesh.edges), dtype=bool)
    seams[edges[differ(first, second)]] = True
    set_seams(mesh, seams)


def seams_at_sharp_edges(made: bpy.types.Object) -> bpy.types.Object:
    """Cut a hard surface where its faces meet at an angle."""
    normals = array(made.data.polygons, "normal", np.float32, 3).astype(float)
    seams_between(made.data, lambda a, b: np.einsum("ij,ij->i", normals[a], normals[b]) < math.cos(SHARP))
    return made


def seams_by_direction(made: bpy.types.Object) -> bpy.types.Object:
    """Cut a surface into patches that face one of six directions."""
    normals = array(made.data.polygons, "normal", np.float32, 3).astype(float)
    axis = np.abs(normals).argmax(axis=1)
    label = 2 * axis + (normals[np.arange(len(normals)), axis] > 0)
    seams_between(made.data, lambda a, b: label[a] != label[b])
    return made


def applied(made: bpy.types.Object) -> bpy.types.Object:
    """Apply all modifiers."""
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(made.evaluated_get(graph))
    made.modifiers.clear()
    made.data = mesh
    return made


def modified(made: bpy.types.Object, kind: str, **settings: object) -> bpy.types.Object:
    """Add a modifier."""
    modifier = made.modifiers.new(kind, kind)
    for name, value in settings.items():
        setattr(modifier, name, value)
    return made


def roughened(made: bpy.types.Object, amount: float, waves: float, seed: int) -> bpy.types.Object:
    """Move all vertices along their normals by a smooth noise."""
    random = np.random.default_rng(seed)
    position = array(made.data.vertices, "co", np.float32, 3).astype(float)
    normal = array(made.data.vertices, "normal", np.float32, 3).astype(float)
    offset = np.zeros(len(position))
    for octave in range(4):
        direction = random.normal(size=(6, 3)) * waves * 2**octave
        phase = random.uniform(0, 2 * np.pi, 6)
        offset += np.sin(position @ direction.T + phase).sum(axis=1) / 6 / 2**octave
    made.data.vertices.foreach_set("co", (position + amount * offset[:, None] * normal).astype(np.float32).ravel())
    made.data.update()
    return made


# Joints of a figure by name, and its bones with the radius at their end.
JOINTS = {
    "hip": (0, 0, 1.0),
    "chest": (0, 0, 1.6),
    "neck": (0, 0, 1.85),
    "crown": (0, -0.03, 2.15),
    **{f"shoulder{side}": (0.25 * sign, 0, 1.65) for side, sign in (("L", 1), ("R", -1))},
    **{f"hand{side}": (0.9 * sign, -0.1, 1.4) for side, sign in (("L", 1), ("R", -1))},
    **{f"foot{side}": (0.2 * sign, 0, 0.0) for side, sign in (("L", 1), ("R", -1))},
}
BONES = {
    "chest": ("hip", 0.22),
    "neck": ("chest", 0.1),
    "crown": ("neck", 0.16),
    **{f"shoulder{side}": ("chest", 0.12) for side in "LR"},
    **{f"hand{side}": (f"shoulder{side}", 0.06) for side in "LR"},
    **{f"foot{side}": ("hip", 0.08) for side in "LR"},
}


def figure(levels: int, is_triangulated: bool = False) -> bpy.types.Object:
    """Return a body with limbs, cut as artists do: around the root of every limb, and along its back or inside."""
    names = list(JOINTS)
    mesh = bpy.data.meshes.new("figure")
    mesh.from_pydata(list(JOINTS.values()), [(names.index(a), names.index(b)) for b, (a, _) in BONES.items()], [])
    made = bpy.data.objects.new("figure", mesh)
    bpy.context.scene.collection.objects.link(made)
    modified(made, "SKIN")
    for name, layer in zip(names, mesh.skin_vertices[0].data, strict=True):
        layer.radius = (BONES.get(name, ("", 0.2))[1],) * 2
    modified(made, "SUBSURF", levels=levels)
    if is_triangulated:
        modified(made, "TRIANGULATE")
    applied(made)
    centers = face_centers(made.data)
    joint = {name: np.array(place) for name, place in JOINTS.items()}
    distance, angle = [], []
    for end, (begin, _) in BONES.items():
        axis = joint[end] - joint[begin]
        along = np.clip((centers - joint[begin]) @ axis / (axis @ axis), 0, 1)
        away = centers - joint[begin] - along[:, None] * axis
        distance.append(np.linalg.norm(away, axis=1))
        axis /= np.linalg.norm(axis)
        front = np.array([0.0, -1.0, 0.0])
        front -= (front @ axis) * axis
        angle.append(np.arctan2(away @ np.cross(axis, front), away @ front))
    bone = np.argmin(distance, axis=0)
    angle = np.array(angle)[bone, np.arange(len(bone))]
    # The torso is one piece with the shoulders.
    torso = [k for k, name in enumerate(BONES) if name == "chest" or name.startswith("shoulder")]
    label = np.where(np.isin(bone, torso), -1, bone)
    seams_between(made.data, lambda a, b: (label[a] != label[b]) | (np.abs(angle[a] - angle[b]) > np.pi))
    return made


def monkey(levels: int) -> bpy.types.Object:
    """Return Suzanne with the islands of its own UV map."""
    bpy.ops.mesh.primitive_monkey_add(calc_uvs=True)
    made = bpy.context.object
    if levels:
        applied(modified(made, "SUBSURF", levels=levels))
    seams_from_islands(made.data)
    return made


def box(bevel_segments: int) -> bpy.types.Object:
    """Return a beveled box with a hole drilled through, in n-gons."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=0.4, depth=4)
    drill = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(size=2)
    made = bpy.context.object
    modified(made, "BEVEL", width=0.15, segments=bevel_segments, limit_method="ANGLE")
    modified(made, "BOOLEAN", object=drill, operation="DIFFERENCE")
    applied(made)
    bpy.data.objects.remove(drill)
    return seams_at_sharp_edges(made)


def screw() -> bpy.types.Object:
    """Return a helical band, long and narrow."""
    mesh = bpy.data.meshes.new("screw")
    turns, width, n = 5, 6, 400
    s = np.linspace(0, 2 * np.pi * turns, n)
    radius = np.linspace(0.6, 1.0, width)
    points = np.stack(
        [radius[:, None] * np.cos(s), radius[:, None] * np.sin(s), np.broadcast_to(0.1 * s, (width, n))], axis=-1
    )
    faces = [
        (i * n + j, i * n + j + 1, (i + 1) * n + j + 1, (i + 1) * n + j) for i in range(width - 1) for j in range(n - 1)
    ]
    mesh.from_pydata(points.reshape(-1, 3).tolist(), [], faces)
    made = bpy.data.objects.new("screw", mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def pipe(bends: int, resolution: int) -> bpy.types.Object:
    """Return a bent tube, open at both ends, cut along its inside."""
    t = np.linspace(0, 1, 40 * resolution)
    center = np.stack([3 * t, 0.5 * np.sin(2 * np.pi * bends * t), 0.2 * np.cos(3 * np.pi * bends * t)], axis=1)
    tangent = np.gradient(center, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    side = np.cross(tangent, [0, 0, 1])
    side /= np.linalg.norm(side, axis=1)[:, None]
    upward = np.cross(side, tangent)
    n = 12 * resolution
    phi = 2 * np.pi * np.arange(n) / n
    ring = np.cos(phi)[None, :, None] * side[:, None] + np.sin(phi)[None, :, None] * upward[:, None]
    points = center[:, None] + 0.15 * ring
    faces = [
        (i * n + j, (i + 1) * n + j, (i + 1) * n + (j + 1) % n, i * n + (j + 1) % n)
        for i in range(len(t) - 1)
        for j in range(n)
    ]
    mesh = bpy.data.meshes.new("pipe")
    mesh.from_pydata(points.reshape(-1, 3).tolist(), [], faces)
    made = bpy.data.objects.new("pipe", mesh)
    bpy.context.scene.collection.objects.link(made)
    column = np.arange(len(faces)) % n
    seams_between(mesh, lambda a, b: np.abs(column[a] - column[b]) == n - 1)
    return made


def plate(holes: int, side: int, height: float) -> bpy.types.Object:
    """Return a wavy plate with round holes."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=2)
    made = bpy.context.object
    bm = bmesh.new()
    bm.from_mesh(made.data)
    centers = [(-0.6 + 1.2 * (k % 3) / 2, -0.6 + 1.2 * (k // 3) / 2) for k in range(holes)]
    inside = [
        face
        for face in bm.faces
        if any((face.calc_center_median().xy - Vector(center)).length < 0.22 for center in centers)
    ]
    bmesh.ops.delete(bm, geom=inside, context="FACES")
    for vertex in bm.verts:
        vertex.co.z = height * math.sin(4 * vertex.co.x) * math.cos(3 * vertex.co.y)
    bm.to_mesh(made.data)
    bm.free()
    return made


def ball(cut: str, levels: int) -> bpy.types.Object:
    """Return a rough ball: cut into six, or into two like a tennis ball, along paths of edges that zigzag."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=levels)
    made = roughened(bpy.context.object, 0.15, 1.5, levels)
    if cut == "six":
        return seams_by_direction(made)
    x, y, z = face_centers(made.data).T
    label = z > 0.9 * np.cos(2 * np.arctan2(y, x)) * np.hypot(x, y)
    seams_between(made.data, lambda a, b: label[a] != label[b])
    return made


def decimated(made: bpy.types.Object, ratio: float) -> bpy.types.Object:
    """Return a model with fewer and uneven triangles; its seams stay."""
    return applied(modified(made, "DECIMATE", ratio=ratio, delimit={"SEAM"}))


def dissolved(made: bpy.types.Object) -> bpy.types.Object:
    """Return a model whose nearly flat parts between seams are n-gons."""
    return applied(modified(made, "DECIMATE", decimate_type="DISSOLVE", angle_limit=math.radians(8), delimit={"SEAM"}))


def terrain(side: int) -> bpy.types.Object:
    """Return steep hills."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=2)
    return roughened(bpy.context.object, 0.35, 1.5, side)


def wheel() -> bpy.types.Object:
    """Return a torus cut around and through."""
    bpy.ops.mesh.primitive_torus_add(major_segments=64, minor_segments=24, minor_radius=0.4)
    made = bpy.context.object
    x, y, z = face_centers(made.data).T
    around = np.arctan2(y, x)
    through = np.arctan2(z, np.hypot(x, y) - 1)
    seams_between(
        made.data,
        lambda a, b: (np.abs(around[a] - around[b]) > np.pi) | (np.abs(through[a] - through[b]) > np.pi),
    )
    return made


def turned(profile: list[tuple[float, float]], segments: int) -> bpy.types.Object:
    """Return a turned vessel: radius and height of its profile; cut at sharp edges and along one side."""
    r, h = np.array(profile).T
    phi = 2 * np.pi * np.arange(segments) / segments
    points = np.stack([np.outer(r, np.cos(phi)), np.outer(r, np.sin(phi)), np.outer(h, np.ones(segments))], axis=-1)
    n = segments
    faces = [
        (i * n + j, i * n + (j + 1) % n, (i + 1) * n + (j + 1) % n, (i + 1) * n + j)
        for i in range(len(profile) - 1)
        for j in range(n)
    ]
    mesh = bpy.data.meshes.new("vessel")
    mesh.from_pydata(points.reshape(-1, 3).tolist(), [], [tuple(range(n - 1, -1, -1)), *faces])
    made = bpy.data.objects.new("vessel", mesh)
    bpy.context.scene.collection.objects.link(made)
    normals = array(mesh.polygons, "normal", np.float32, 3).astype(float)
    column = np.concatenate([[0], np.arange(len(faces)) % n])
    is_side = np.concatenate([[False], np.ones(len(faces), dtype=bool)])
    seams_between(
        mesh,
        lambda a, b: (
            (np.einsum("ij,ij->i", normals[a], normals[b]) < math.cos(SHARP))
            | (is_side[a] & is_side[b] & (np.abs(column[a] - column[b]) == n - 1))
        ),
    )
    return made


VASE = [(0.5, 0), (0.7, 0.2), (0.8, 0.5), (0.6, 0.9), (0.35, 1.2), (0.3, 1.4), (0.45, 1.6), (0.5, 1.62)]
GENERATED: dict[str, Callable[[], bpy.types.Object]] = {
    "figure": lambda: figure(2),
    "figure dense": lambda: figure(4),
    "figure triangles": lambda: figure(3, is_triangulated=True),
    "figure n-gons": lambda: dissolved(figure(3)),
    "figure decimated": lambda: decimated(figure(4), 0.1),
    "head": lambda: monkey(0),
    "head dense": lambda: monkey(3),
    "box": lambda: box(2),
    "box round": lambda: box(8),
    "screw": screw,
    "pipe": lambda: pipe(2, 1),
    "pipe dense": lambda: pipe(3, 4),
    "plate": lambda: plate(0, 40, 0.3),
    "plate with holes": lambda: plate(9, 60, 0.2),
    "plate with one hole": lambda: plate(1, 120, 0.4),
    "ball in six": lambda: ball("six", 5),
    "ball in two": lambda: ball("tennis", 6),
    "ball decimated": lambda: decimated(ball("six", 6), 0.05),
    "terrain": lambda: terrain(100),
    "wheel": wheel,
    "vase": lambda: turned(VASE, 32),
    "vase smooth": lambda: turned(
        [(0.5 + 0.3 * math.sin(5 * t) * (1 - t / 2), 2 * t) for t in np.linspace(0, 1, 60)], 48
    ),
}
