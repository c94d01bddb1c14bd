"""Convert Blender's meshes to arrays, write UVs back, and make meshes from arrays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy
import numpy as np
import numpy.typing as npt
from mathutils import Matrix

from ...assets import AssetError, AssetMesh, UvMap
from ...assets.mesh import offsets_of

# Vertex layers in which the add-on stores extenders, and the attribute of faces with its density factors.
_EXTENDERS = ".spectral"
_DENSITY_FACTORS = "spectral_density_factor"
# The add-on's limits, too.
_MIN_FACTOR, _MAX_FACTOR = 0.01, 100.0


def of_objects() -> Iterator[tuple[bpy.types.Object, bpy.types.Mesh]]:
    """Yield every mesh with faces that an object in any scene of the file uses, with the first such object."""
    seen = set()
    for item in bpy.data.objects:
        if item.type == "MESH" and item.data.polygons and item.data.name_full not in seen:
            seen.add(item.data.name_full)
            yield item, item.data


def read(item: bpy.types.Object, uv_map: str) -> AssetMesh:
    """Return the mesh of an object without modifiers, at the basis of its shape keys, including hidden faces."""
    mesh = item.data
    n_faces, n_corners = len(mesh.polygons), len(mesh.loops)
    sizes = _numbers(mesh.polygons, "loop_total", n_faces, np.int32)
    corners = _numbers(mesh.loops, "vertex_index", n_corners, np.int32)
    edges = _numbers(mesh.edges, "vertices", 2 * len(mesh.edges), np.int32).reshape(-1, 2)
    seams = _numbers(mesh.edges, "use_seam", len(mesh.edges), bool)
    layer = _layer(mesh, uv_map)
    uv = pins = None
    if layer is not None:
        uv = _uv(layer, n_corners)
        pins = _pins(mesh, layer, n_corners)
    material = _materials(item)
    return AssetMesh(
        _numbers(mesh.vertices, "co", 3 * len(mesh.vertices), np.float32).reshape(-1, 3).astype(np.float64),
        offsets_of(sizes),
        corners.astype(np.int64),
        uv,
        mesh.name,
        np.array(item.matrix_world, dtype=np.float64),
        edges[seams].astype(np.int64),
        pins,
        material_of_face=material if (material != material[:1]).any() else None,
        material=int(material[0]) if len(material) else -1,
        density_factors=_density_factors(mesh),
    )


def _materials(item: bpy.types.Object) -> npt.NDArray[np.int64]:
    """Return the number of each face's material within the file, (faces,), -1 for none."""
    numbers = {material.name_full: number for number, material in enumerate(bpy.data.materials)}
    of_slot = [numbers[slot.material.name_full] if slot.material else -1 for slot in item.material_slots] or [-1]
    slots = _numbers(item.data.polygons, "material_index", len(item.data.polygons), np.int32)
    # Blender shows faces of slots that do not exist with the last one.
    return np.array(of_slot, np.int64)[np.minimum(slots, len(of_slot) - 1)]


def _density_factors(mesh: bpy.types.Mesh) -> npt.NDArray[np.float64] | None:
    layer = mesh.attributes.get(_DENSITY_FACTORS)
    if layer is None or layer.domain != "FACE" or layer.data_type != "FLOAT":
        return None
    found = _numbers(layer.data, "value", len(mesh.polygons), np.float32).astype(np.float64)
    # Faces without a factor have 0.
    is_set = np.isfinite(found) & (found > 0.0)
    return np.where(is_set, np.clip(found, _MIN_FACTOR, _MAX_FACTOR), 1.0)


def has_extenders(mesh: bpy.types.Mesh) -> bool:
    """Return whether the add-on has stored extenders in a mesh."""
    return any(each.domain == "POINT" and each.name.startswith(_EXTENDERS) for each in mesh.attributes)


def write_uv(mesh: bpy.types.Mesh, uv_map: str, found: UvMap) -> None:
    """Write a map into the named layer, which is created if missing; without a name, into the active one.

    A mesh without mapped faces and without this layer stays without it.

    Raises:
        AssetError: there is no room for another layer.
    """
    layer = _layer(mesh, uv_map)
    if layer is None and not found.mapped.any():
        return
    old = np.zeros((len(mesh.loops), 2)) if layer is None else _uv(layer, len(mesh.loops))
    if layer is None:
        layer = mesh.uv_layers.new(name=uv_map or "UVMap", do_init=False)
    if layer is None:
        raise AssetError(f"{mesh.name} has no room for another UV map: remove one.")
    corner_mapped = np.repeat(found.mapped, _numbers(mesh.polygons, "loop_total", len(mesh.polygons), np.int32))
    values = np.where(corner_mapped[:, None], found.uv, old).astype(np.float32).ravel()
    if hasattr(layer, "uv"):
        layer.uv.foreach_set("vector", values)
    else:
        layer.data.foreach_set("uv", values)
    mesh.update()


def made(mesh: AssetMesh, name: str) -> bpy.types.Mesh:
    """Return a new Blender mesh, with its UV map if it has one."""
    result = bpy.data.meshes.new(name)
    result.vertices.add(len(mesh.vertices))
    result.vertices.foreach_set("co", mesh.vertices.astype(np.float32).ravel())
    result.loops.add(len(mesh.corner_vertices))
    result.loops.foreach_set("vertex_index", mesh.corner_vertices.astype(np.int32))
    result.polygons.add(len(mesh.face_offsets) - 1)
    result.polygons.foreach_set("loop_start", mesh.face_offsets[:-1].astype(np.int32))
    if bpy.app.version < (4, 0):
        result.polygons.foreach_set("loop_total", np.diff(mesh.face_offsets).astype(np.int32))
    result.update(calc_edges=True)
    if mesh.corner_uv is not None:
        write_uv(result, "", UvMap(mesh.corner_uv, mesh.has_uv()))
    return result


def uv_of(mesh: bpy.types.Mesh) -> npt.NDArray[np.float64]:
    """Return the active UV map of a mesh, which must have one, (C, 2)."""
    return _uv(mesh.uv_layers.active, len(mesh.loops))


def link(meshes: Sequence[AssetMesh], scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Add meshes to a scene, each with its placement in the asset; return the objects."""
    objects = []
    for mesh in meshes:
        item = bpy.data.objects.new("asset", made(mesh, "asset"))
        # Blender takes a list by columns.
        item.matrix_world = Matrix(mesh.placement.tolist())
        scene.collection.objects.link(item)
        objects.append(item)
    return objects


def _layer(mesh: bpy.types.Mesh, uv_map: str) -> bpy.types.MeshUVLoopLayer | None:
    return mesh.uv_layers.get(uv_map) if uv_map else mesh.uv_layers.active


def _uv(layer: bpy.types.MeshUVLoopLayer, n_corners: int) -> npt.NDArray[np.float64]:
    rows, name = (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")
    return _numbers(rows, name, 2 * n_corners, np.float32).reshape(-1, 2).astype(np.float64)


def _pins(mesh: bpy.types.Mesh, layer: bpy.types.MeshUVLoopLayer, n_corners: int) -> npt.NDArray[np.bool_] | None:
    """Return which corners are pinned, None if there are none; pins are an attribute from 3.5 on."""
    if bpy.app.version < (3, 5):
        pins = _numbers(layer.data, "pin_uv", n_corners, bool)
    else:
        found = mesh.attributes.get(f".pn.{layer.name}")
        pins = np.zeros(0, bool) if found is None else _numbers(found.data, "value", n_corners, bool)
    return pins if pins.any() else None


def _numbers(rows: bpy.types.bpy_prop_collection, name: str, count: int, kind: type) -> npt.NDArray:
    result = np.empty(count, dtype=kind)
    rows.foreach_get(name, result)
    return result
