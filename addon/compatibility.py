# SPDX-License-Identifier: GPL-3.0-or-later
"""All differences between the supported Blender versions (3.4 and later)."""

import ctypes
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from bmesh.types import BMesh, BMFace, BMLayerItem, BMLoop

# From 5.0 the UV selection belongs to the mesh, before to each UV map.
_UV_SELECTION_ON_MESH = hasattr(BMLoop, "uv_select_vert")

# The shader with a `pos` (3D) and a `color` per vertex.
SMOOTH_COLOR_SHADER = "SMOOTH_COLOR" if bpy.app.version >= (4, 0, 0) else "3D_SMOOTH_COLOR"


# The shader of lines of any width between `pos` (3D), in one `color`.
LINE_SHADER = "POLYLINE_UNIFORM_COLOR" if bpy.app.version >= (4, 0, 0) else "3D_POLYLINE_UNIFORM_COLOR"


# The attributes of flags of faces and edges; one is missing if its flag is set nowhere. Known for the tested versions;
# others ask the elements one by one.
_FLAG_ATTRIBUTES = {"hide": ".hide_poly", "select": ".select_poly"} if bpy.app.version < (5, 3) else {}
if (4, 2) <= bpy.app.version < (4, 4):
    _FLAG_ATTRIBUTES["use_seam"] = ".uv_seam"
elif (4, 5) <= bpy.app.version < (5, 3):
    _FLAG_ATTRIBUTES["use_seam"] = "uv_seam"

# Of a mesh.
MAX_UV_MAPS = 8

# Whether the 3D viewport's unwrap menu includes the UV editor's, with entries of add-ons. In 4.3 it does not; 4.4 is
# untested.
VIEWPORT_MENU_HAS_THE_UV_EDITORS = bpy.app.version >= (4, 4, 0)

# Whether Blender itself puts islands into a row, and moves UVs by whole tiles.
HAS_ARRANGE_ISLANDS = "arrange_islands" in dir(bpy.ops.uv)
_HAS_MOVE_ON_AXIS = "move_on_axis" in dir(bpy.ops.uv)


def draw_tile_move(layout: bpy.types.UILayout, axis: str, tiles: int, icon: str) -> None:
    """Draw Blender's operator that moves the selected UVs by UV tiles along the axis, X or Y."""
    if _HAS_MOVE_ON_AXIS:
        move = layout.operator("uv.move_on_axis", text="", icon=icon)
        move.type, move.axis, move.distance = "UDIM", axis, tiles
    else:
        layout.operator("transform.translate", text="", icon=icon).value = [tiles * (axis == each) for each in "XYZ"]


@contextmanager
def data_of_no_file() -> Iterator[bpy.types.BlendData]:
    """Yield data outside the user's file; it is freed with its contents when the context ends.

    Removing anything from the user's file would make Blender rebuild its graph of all objects.
    """
    manager = bpy.data.temp_data()
    data = manager.__enter__()
    # Blender (3.4 to 5.2, `bpy_rna_data_context_enter`) returns the manager's own reference: the object would be freed
    # twice. If a later version returns a new one, this leaks a small object.
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(data))
    try:
        yield data
    finally:
        manager.__exit__(None, None, None)


def label_points(preferences: bpy.types.Preferences) -> float:
    """Return the size of the letters of labels, in points."""
    style = preferences.ui_styles[0]
    # From 5.0 labels are as all widgets.
    return (style.widget_label if hasattr(style, "widget_label") else style.widget).points


def translated(text: str) -> str:
    """Return a text in the user's language if Blender translates reports, else unchanged."""
    # Before 4.1 reports follow the setting of tooltips. Looked up each time: a function of Blender kept in a module
    # would live until Python ends.
    translations = bpy.app.translations
    return (getattr(translations, "pgettext_rpt", None) or translations.pgettext_tip)(text)


def derive_uv_selection(bm: BMesh) -> None:
    """Let sync selection follow a changed mesh selection; 5.0 would go on showing the finer UV selection."""
    if _UV_SELECTION_ON_MESH:
        bm.uv_select_sync_valid = False


def sticky_selection(context: bpy.types.Context) -> str:
    """Return which UVs the UV editor selects together: "DISABLED", "SHARED_LOCATION" or "SHARED_VERTEX"."""
    # Formerly a setting of each UV editor, now of the scene.
    in_scene = getattr(context.scene.tool_settings, "uv_sticky_select_mode", None)
    return in_scene or context.area.spaces.active.uv_editor.sticky_select_mode


def select_uv_corners(bm: BMesh, layer: BMLayerItem, selected: Sequence[bool], among: Sequence[bool]) -> None:
    """Select exactly the `selected` corners, one flag per corner, of the faces `among`, one flag per face.

    Edges and faces between them are selected, too.
    """
    flags = iter(selected)
    for face, is_among in zip(bm.faces, among):
        corners = [next(flags) for _ in face.loops]
        if is_among:
            _select_uv_of_face(face, layer, corners)


def _select_uv_of_face(face: BMFace, layer: BMLayerItem, corners: list[bool]) -> None:
    """Select or deselect the UVs of a face, one flag per corner, and the edges and the face between selected ones."""
    for index, loop in enumerate(face.loops):
        edge = corners[index] and corners[(index + 1) % len(corners)]
        if _UV_SELECTION_ON_MESH:
            loop.uv_select_vert, loop.uv_select_edge = corners[index], edge
        else:
            uv = loop[layer]
            uv.select, uv.select_edge = corners[index], edge
    if _UV_SELECTION_ON_MESH:
        face.uv_select = all(corners)


def selected_uv_corners(bm: BMesh, layer: BMLayerItem) -> np.ndarray:
    """Return which corners are selected in the UV editor without sync selection, (C,) bool."""
    loops = (loop for face in bm.faces for loop in face.loops)
    if _UV_SELECTION_ON_MESH:
        return np.fromiter((loop.uv_select_vert for loop in loops), dtype=bool)
    return np.fromiter((loop[layer].select for loop in loops), dtype=bool)


def all_selected(bm: BMesh, layer: BMLayerItem, loops: Iterable[BMLoop], use_sync: bool) -> bool:
    """Return whether all these corners are selected in the UV editor, with or without sync selection."""
    if use_sync and not (_UV_SELECTION_ON_MESH and bm.uv_select_sync_valid):
        return all(loop.vert.select for loop in loops)
    if _UV_SELECTION_ON_MESH:
        return all(loop.uv_select_vert for loop in loops)
    return all(loop[layer].select for loop in loops)


def positions(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the positions of the vertices of `mesh`, which is not in edit mode, (V, 3) float32."""
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    attribute = _attribute(mesh, "position", "FLOAT_VECTOR", len(mesh.vertices))
    _read(attribute, "vector", mesh.vertices, "co", values)
    return values.reshape(-1, 3)


def edge_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the vertices of the edges of `mesh`, which is not in edit mode, (E, 2) int32."""
    values = np.empty(2 * len(mesh.edges), dtype=np.int32)
    _read(_attribute(mesh, ".edge_verts", "INT32_2D", len(mesh.edges)), "value", mesh.edges, "vertices", values)
    return values.reshape(-1, 2)


def corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the vertex of every corner of `mesh`, which is not in edit mode, (C,) int32."""
    values = np.empty(len(mesh.loops), dtype=np.int32)
    _read(_attribute(mesh, ".corner_vert", "INT", len(mesh.loops)), "value", mesh.loops, "vertex_index", values)
    return values


def face_offsets(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the first corner of every face of `mesh`, not in edit mode, and the number of corners, int32."""
    offsets = np.empty(len(mesh.polygons) + 1, dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", offsets[:-1])
    offsets[-1] = len(mesh.loops)
    return offsets


def corner_uv(mesh: bpy.types.Mesh, uv_map: bpy.types.MeshUVLoopLayer | None = None) -> np.ndarray:
    """Return a UV map, by default the active one, of `mesh`, which is not in edit mode, (C, 2) float32."""
    values = np.empty(2 * len(mesh.loops), dtype=np.float32)
    uv_map = uv_map or mesh.uv_layers.active
    # From 3.5 the map is an attribute.
    _read(getattr(uv_map, "uv", None), "vector", uv_map.data, "uv", values)
    return values.reshape(-1, 2)


def flags(mesh: bpy.types.Mesh, elements: str, name: str) -> np.ndarray:
    """Return the flag `name`, such as "hide", of all `elements` of `mesh`, which is not in edit mode.

    `elements` is the name of their collection in the mesh.
    """
    collection = getattr(mesh, elements)
    values = np.zeros(len(collection), dtype=bool)
    stored = _FLAG_ATTRIBUTES.get(name)
    if stored is None or stored in mesh.attributes:
        attribute = stored and _attribute(mesh, stored, "BOOLEAN", len(collection))
        _read(attribute, "value", collection, name, values)
    return values


def face_values(mesh: bpy.types.Mesh, name: str) -> np.ndarray | None:
    """Return a number per face, (F,) float32, of `mesh`, which is not in edit mode; None without such an attribute."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != "FACE":
        return None
    found = _attribute(mesh, name, "FLOAT", len(mesh.polygons))
    if found is None:
        return None
    values = np.empty(len(mesh.polygons), dtype=np.float32)
    found.foreach_get("value", values)
    return values


def edge_weights(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Return the "crease" or "bevel_weight" of every edge of `mesh`, which is not in edit mode, (E,) from 0 to 1.

    float64; 0 for values that are not finite.
    """
    values = np.zeros(len(mesh.edges), dtype=np.float32)
    # Before 4.0 it is a property of the edges.
    stored = _attribute(mesh, f"{name}_edge", "FLOAT", len(values))
    if stored is not None or bpy.app.version < (4, 0, 0):
        _read(stored, "value", mesh.edges, name, values)
    return np.nan_to_num(values.astype(np.float64), nan=0.0).clip(0.0, 1.0)


def materials(mesh: bpy.types.Mesh, slots: int | None = None) -> np.ndarray:
    """Return the material slot of every face of `mesh`, which is not in edit mode, (F,) int32.

    Given the number of `slots`, faces of one that does not exist have the last one, with which Blender shows them.
    """
    values = np.empty(len(mesh.polygons), dtype=np.int32)
    stored = _attribute(mesh, "material_index", "INT", len(values))
    _read(stored, "value", mesh.polygons, "material_index", values)
    return values if slots is None else np.clip(values, 0, slots - 1)


def _attribute(mesh: bpy.types.Mesh, name: str, data_type: str, count: int) -> bpy.types.bpy_prop_collection | None:
    """Return the values of an attribute of `mesh`; None if it has no such attribute, or another number of values."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.data_type != data_type or len(attribute.data) != count:
        return None
    return attribute.data


def _read(
    attribute: bpy.types.bpy_prop_collection | None,
    value: str,
    elements: bpy.types.bpy_prop_collection,
    name: str,
    values: np.ndarray,
) -> None:
    """Fill `values` from an attribute, or from a property of the elements if there is none.

    The first copies memory; the second asks every element, which takes up to five hundred times as long.
    """
    if attribute is None:
        elements.foreach_get(name, values)
    else:
        attribute.foreach_get(value, values)


def pinned_corners(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return which corners are pinned in the active UV map of `mesh`, which is not in edit mode, (C,) bool."""
    pinned = np.zeros(len(mesh.loops), dtype=bool)
    uv_map = mesh.uv_layers.active
    # From 3.5 the pins are an attribute, which is missing if nothing was ever pinned.
    if not hasattr(uv_map, "pin"):
        uv_map.data.foreach_get("pin_uv", pinned)
    elif len(uv_map.pin):
        uv_map.pin.foreach_get("value", pinned)
    return pinned


def has_pins(bm: BMesh, layer: BMLayerItem) -> bool:
    """Return whether any corner of an edit mesh is pinned in a UV map."""
    # From 3.5 the pins are a layer, which is missing if nothing was ever pinned. Scripts can read it from 4.0 on, three
    # times as fast.
    flags = getattr(bm.loops.layers, "bool", None)
    if flags is None:
        return any(loop[layer].pin_uv for face in bm.faces for loop in face.loops)
    pins = flags.get(f".pn.{layer.name}")
    return pins is not None and any(loop[pins] for face in bm.faces for loop in face.loops)
