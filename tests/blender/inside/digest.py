# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything in a file except the coordinates of active UV maps, as comparable values."""

from collections.abc import Mapping

import bmesh
import bpy
import numpy as np

# Attribute type -> (name of the value, NumPy type, columns).
_ATTRIBUTES = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "QUATERNION": ("value", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "INT16_2D": ("value", np.int32, 2),
}
_ELEMENTS = {
    "vertices": (("co", np.float32, 3), ("select", bool, 1), ("hide", bool, 1)),
    "edges": (
        *(("vertices", np.int32, 2), ("select", bool, 1), ("hide", bool, 1)),
        *(("use_seam", bool, 1), ("use_edge_sharp", bool, 1)),
    ),
    "polygons": (
        *(("loop_start", np.int32, 1), ("loop_total", np.int32, 1), ("material_index", np.int32, 1)),
        *(("select", bool, 1), ("hide", bool, 1), ("use_smooth", bool, 1)),
    ),
    "loops": (("vertex_index", np.int32, 1), ("edge_index", np.int32, 1)),
}
_OWN_LAYER = ".spectral_extender:"


def digest() -> dict[str, object]:
    """Return everything by readable names; equal dictionaries mean that nothing has changed."""
    found = {
        "view layer": (
            getattr(bpy.context.view_layer.objects.active, "name", None),
            sorted(item.name for item in bpy.context.selected_objects),
            bpy.context.mode,
        ),
        "tool settings": _properties(bpy.context.scene.tool_settings),
    }
    for kind in ("meshes", "objects", "scenes", "materials", "images", "node_groups", "texts", "collections"):
        found[f"names of {kind}"] = sorted(block.name for block in getattr(bpy.data, kind))
    for item in bpy.data.objects:
        found |= {f"object {item.name}: {name}": value for name, value in _object(item).items()}
    for mesh in bpy.data.meshes:
        found |= {f"mesh {mesh.name}: {name}": value for name, value in _mesh(mesh).items()}
    return found


def changes(before: Mapping[str, object], after: Mapping[str, object]) -> list[str]:
    """Return the names of what differs between two digests."""
    return sorted(name for name in {*before, *after} if before.get(name) != after.get(name))


def active_uv(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """Return the coordinates of the active UV map of a mesh, (C, 2) float32; None without a map."""
    with _Copy(mesh) as copy:
        layer = copy.uv_layers.active
        return None if layer is None else _values(layer.data, "uv", np.float32, 2)


class _Copy:
    """A temporary copy of a mesh as it is in edit mode; the mesh itself in object mode."""

    def __init__(self, mesh):
        self._mesh = mesh
        self._copy = None

    def __enter__(self):
        if not self._mesh.is_editmode:
            return self._mesh
        self._copy = bpy.data.meshes.new("Digest")
        bmesh.from_edit_mesh(self._mesh).to_mesh(self._copy)
        return self._copy

    def __exit__(self, *_):
        if self._copy is not None:
            bpy.data.meshes.remove(self._copy)


def _values(elements, name, dtype, columns):
    values = np.empty(len(elements) * columns, dtype=dtype)
    elements.foreach_get(name, values)
    return values.reshape(-1, columns)


def _mesh(mesh):
    found = {"data": mesh.name}
    with _Copy(mesh) as copy:
        for kind, fields in _ELEMENTS.items():
            elements = getattr(copy, kind)
            found |= {f"{kind}, {field}": _values(elements, field, *rest).tobytes() for field, *rest in fields}
        maps = {layer.name for layer in copy.uv_layers}
        for attribute in copy.attributes:
            known = not attribute.name.startswith(".") or attribute.name.startswith(_OWN_LAYER)
            if known and attribute.name not in maps and attribute.data_type in _ATTRIBUTES:
                values = _values(attribute.data, *_ATTRIBUTES[attribute.data_type])
                found[f"attribute {attribute.name}"] = (attribute.domain, values.tobytes())
        active = copy.uv_layers.active
        for layer in copy.uv_layers:
            found[f"pins of {layer.name}"] = _pins(copy, layer).tobytes()
            if layer.name != active.name:
                found[f"UV map {layer.name}"] = _values(layer.data, "uv", np.float32, 2).tobytes()
        found["weights"] = repr([[(g.group, g.weight) for g in v.groups] for v in copy.vertices])
    found["UV maps"] = [(layer.name, layer.active, layer.active_render) for layer in mesh.uv_layers]
    found["materials"] = [getattr(material, "name", None) for material in mesh.materials]
    found["shapes"] = repr([(e.name, e.strength, e.use, e.layer) for e in _extenders(mesh)])
    found["shape keys"] = _shape_keys(mesh)
    if mesh.is_editmode:
        found |= _edit_state(bmesh.from_edit_mesh(mesh))
    return found


def _extenders(mesh):
    return getattr(mesh, "spectral_shapes", ())


def _pins(mesh, layer):
    if not hasattr(layer, "pin"):
        return _values(layer.data, "pin_uv", bool, 1)
    # Not through `layer.pin`, which in 4.x makes the attribute and moves all layers in memory.
    attribute = mesh.attributes.get(f".pn.{layer.name}")
    return (
        np.zeros((len(mesh.loops), 1), dtype=bool) if attribute is None else _values(attribute.data, "value", bool, 1)
    )


def _shape_keys(mesh):
    if mesh.shape_keys is None:
        return None
    keys = mesh.shape_keys.key_blocks
    found = [(key.name, key.value, key.relative_key.name, key.mute) for key in keys]
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return found, repr([[tuple(v[layer]) for v in bm.verts] for layer in bm.verts.layers.shape.values()])
    return found, [_values(key.data, "co", np.float32, 3).tobytes() for key in keys]


def _edit_state(bm):
    for elements in (bm.verts, bm.edges, bm.faces):
        elements.index_update()
    layer = bm.loops.layers.uv.active
    loops = [loop for face in bm.faces for loop in face.loops]
    if hasattr(bmesh.types.BMLoop, "uv_select_vert"):
        flags = [(loop.uv_select_vert, loop.uv_select_edge) for loop in loops]
        flags = (flags, [face.uv_select for face in bm.faces], bm.uv_select_sync_valid)
    else:
        flags = layer and [(loop[layer].select, loop[layer].select_edge) for loop in loops]
    return {
        "active face": bm.faces.active and bm.faces.active.index,
        "selection history": [(type(element).__name__, element.index) for element in list(bm.select_history)],
        "select mode": sorted(bm.select_mode),
        "UV selection": flags,
    }


def _object(item):
    return {
        "data": getattr(item.data, "name", None),
        "matrix": repr([tuple(row) for row in item.matrix_world]),
        "visibility": (item.hide_get(), item.hide_viewport, item.select_get()),
        "modifiers": [(modifier.name, modifier.type, _properties(modifier)) for modifier in item.modifiers],
        "material slots": [getattr(slot.material, "name", None) for slot in item.material_slots],
        "vertex groups": [group.name for group in item.vertex_groups],
        "active shape key": item.active_shape_key_index,
    }


def _properties(block):
    """Return the plain properties of a block, as text: NaN equals NaN."""
    kinds = {"BOOLEAN", "INT", "FLOAT", "ENUM", "STRING"}
    return {
        p.identifier: repr(_plain(getattr(block, p.identifier))) for p in block.bl_rna.properties if p.type in kinds
    }


def _plain(value):
    if isinstance(value, set):
        return sorted(value)
    return value if isinstance(value, (bool, int, float, str)) else list(value)
