# SPDX-License-Identifier: GPL-3.0-or-later
"""Every identifier by which Blender and scripts know the add-on's parts."""

# The add-on's package; that of an extension differs from that of an add-on before 4.2.
PACKAGE = __package__

UNWRAP_OPERATOR = "uv.spectral_unwrap"
RELAX_OPERATOR = "uv.spectral_relax"
PACK_OPERATOR = "uv.spectral_pack"
ARRANGE_OPERATOR = "uv.spectral_arrange"
NEW_TEXTURES_OPERATOR = "uv.spectral_new_textures"
SELECT_OPERATOR = "uv.spectral_select"
INSPECT_OPERATOR = "uv.spectral_inspect"
STORE_OPERATOR = "mesh.spectral_store_distortion"

# Names of stored attributes, by the kind that the overlay shows; colors add a suffix.
ATTRIBUTES = {
    "ANGLE": "spectral_angle_distortion",
    "SIZE": "spectral_size",
    "DENSITY": "spectral_texel_density",
    "DEFECTS": "spectral_defects",
}
COLORS_SUFFIX = "_colors"

SEAM_HINT_OPERATOR = "mesh.spectral_seam_hint"
# Integer attribute of edges: 1 for "cut here", 2 for "never here".
SEAM_HINT_ATTRIBUTE = "spectral_seam_hint"

DENSITY_OPERATOR = "uv.spectral_density"
# Attribute of faces, numbers: their texel density over that of others; 0, the default of new faces, means 1.
DENSITY_FACTOR_ATTRIBUTE = "spectral_density_factor"
# Property of scenes and materials: pixels along a side of the texture; 0 for those of the material's image.
TEXTURE_SIZE_PROPERTY = "spectral_texture_size"
# Property of scenes: pixels between islands.
MARGIN_PROPERTY = "spectral_margin"
# Property of scenes: how packing may turn islands.
ROTATION_PROPERTY = "spectral_rotation"

SUGGEST_SEAMS_OPERATOR = "uv.spectral_suggest_seams"

LIVE_UNWRAP_PROPERTY = "spectral_unwrap_live"

# Property of the window manager: what the overlay of the UV map shows.
MAP_OVERLAY_PROPERTY = "spectral_map_overlay"

# Properties of the window manager: the islands of the last result, and the index of the active one.
ISLANDS_PROPERTY = "spectral_islands"
# Of the window manager, without a definition: the numbers of the last result.
RESULT_PROPERTY = "spectral_result"
ACTIVE_ISLAND_PROPERTY = "spectral_islands_active"

# Starts the name of the edge layer of a constraint; the dot hides it in Blender.
CONSTRAINT_LAYER_PREFIX = ".spectral_constraint:"
# Of the add-on UniV: which edges its unwrap makes horizontal or vertical.
UNIV_CONSTRAINTS_ATTRIBUTE = "univ_constraints"
# Starts the name of the vertex layer of an extender.
EXTENDER_LAYER_PREFIX = ".spectral_extender:"
# Properties of meshes: the list of stored shapes, and the index of the active one.
SHAPES_PROPERTY = "spectral_shapes"
ACTIVE_SHAPE_PROPERTY = "spectral_shapes_active"

SHAPE_OPERATOR = "uv.spectral_shape"
REMOVE_SHAPE_OPERATOR = "uv.spectral_shape_remove"
EXTENDER_OPERATOR = "uv.spectral_extender"

SHAPE_LIST = "MESH_UL_spectral_shapes"
ISLAND_LIST = "UV_UL_spectral_islands"
SUBMENU = "UV_MT_spectral"
# The panels of the sidebar, in the order of work; each exists in the 3D viewport and in the UV editor.
PANEL_PREFIXES = ("VIEW3D_PT_spectral_", "IMAGE_PT_spectral_")

# Operators that mark seams along the islands of the current map.
OPERATORS_THAT_MARK_SEAMS_OF_A_MAP = (
    "UV_OT_seams_from_islands",
    "UV_OT_spectral_unwrap",
    "UV_OT_spectral_suggest_seams",
)

# Blender's menus that get entries. The first two list its unwrap operators.
VIEWPORT_UNWRAP_MENU = "VIEW3D_MT_uv_map"
UV_EDITOR_UNWRAP_MENU = "IMAGE_MT_uvs_unwrap"
UV_EDITOR_MENU = "IMAGE_MT_uvs"
VIEWPORT_EDGE_MENU = "VIEW3D_MT_edit_mesh_edges"
UV_EDITOR_SELECT_MENU = "IMAGE_MT_select"
VIEWPORT_SELECT_BY_TRAIT_MENU = "VIEW3D_MT_edit_mesh_select_by_trait"
VIEWPORT_OBJECT_MENU = "VIEW3D_MT_object"

# Name that Blender itself gives to the first UV map.
DEFAULT_UV_MAP = "UVMap"

# Temporary mesh, object, scene and attribute for reading edit-mode data.
TEMPORARY_MESH = ".spectral_unwrap_temporary"
TEMPORARY_OBJECT = TEMPORARY_MESH
TEMPORARY_SCENE = TEMPORARY_MESH
ORIGINAL_FACE_ATTRIBUTE = ".spectral_unwrap_original_face"
