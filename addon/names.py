# SPDX-License-Identifier: GPL-3.0-or-later
"""Every identifier and label by which Blender, scripts and users know this add-on's parts."""

UNWRAP_OPERATOR = "uv.spectral_unwrap"
UNWRAP_LABEL = "Spectral Unwrap"
UNWRAP_DESCRIPTION = "Unwrap the mesh with low angle distortion and without pins"

SELECT_FAILED_OPERATOR = "uv.spectral_select_failed"
SELECT_FAILED_LABEL = "Select Failed Islands"
SELECT_FAILED_DESCRIPTION = (
    f"Select the faces of the islands that {UNWRAP_LABEL} cannot solve, among the selected faces, or among all visible "
    "ones if none is selected"
)

SELECT_DEFECTS_OPERATOR = "uv.spectral_select_defects"
SELECT_DEFECTS_LABEL = "Select Flipped and Overlapping"
SELECT_DEFECTS_DESCRIPTION = (
    "Select the visible faces whose UVs lie the wrong way round or on those of other faces, in the active UV map"
)

SUGGEST_SEAMS_OPERATOR = "uv.spectral_suggest_seams"
SUGGEST_SEAMS_LABEL = "Suggest Seams"
SUGGEST_SEAMS_DESCRIPTION = (
    "Mark seams that lower the distortion of the map most, and open closed meshes, on the selected faces, or on all "
    "visible ones if none is selected; then unwrap again"
)

LIVE_UNWRAP_PROPERTY = "spectral_unwrap_live"
LIVE_UNWRAP_LABEL = "Live Spectral Unwrap"
LIVE_UNWRAP_DESCRIPTION = "Let islands follow while their pins are moved, and unwrap again when seams are changed"

# Properties of meshes: the list of extenders, the index of the active one, and the name of the vertex layer that tells
# which vertices are theirs. The layer's name is the prefix and a digest of the list; with the dot Blender hides it.
EXTENDERS_PROPERTY = "spectral_extenders"
ACTIVE_EXTENDER_PROPERTY = "spectral_extenders_active"
EXTENDER_LAYER_PROPERTY = "spectral_extenders_layer"
EXTENDER_LAYER_PREFIX = ".spectral_extenders:"
EXTENDER_NAME = "Extender"
EXTENDER_STRENGTH_LIMIT = 1e4
# Arguments of the property, wherever it stands.
EXTENDER_STRENGTH = {
    "name": "Strength",
    "description": (
        "How strongly the two vertices are pushed apart, or below 0 pulled together, as a fraction of the boundary's "
        "total mass"
    ),
    "default": 1.0,
    "min": -EXTENDER_STRENGTH_LIMIT,
    "max": EXTENDER_STRENGTH_LIMIT,
    "soft_min": -10.0,
    "soft_max": 10.0,
}

ADD_EXTENDER_OPERATOR = "mesh.spectral_extender_add"
ADD_EXTENDER_LABEL = "Add Extender"
ADD_EXTENDER_DESCRIPTION = "Add forces that push pairs of selected vertices apart in the map, or pull them together"
REMOVE_EXTENDER_OPERATOR = "mesh.spectral_extender_remove"
REMOVE_EXTENDER_LABEL = "Remove Extender"
REMOVE_EXTENDER_DESCRIPTION = "Remove the active extender"
REMOVE_BROKEN_EXTENDERS_LABEL = "Remove Broken"
REMOVE_BROKEN_EXTENDERS_DESCRIPTION = "Remove all extenders with a vertex that is gone"
ADJUST_EXTENDER_OPERATOR = "mesh.spectral_extender_adjust"
ADJUST_EXTENDER_LABEL = "Adjust Extender"
ADJUST_EXTENDER_DESCRIPTION = "Change the strength of the active extender by dragging, while its island follows"
SELECT_EXTENDER_OPERATOR = "mesh.spectral_extender_select"
SELECT_EXTENDER_LABEL = "Select Extender Vertices"
SELECT_EXTENDER_DESCRIPTION = "Select the two vertices of the active extender"

SIDEBAR_TAB = "Spectral"
EXTENDERS_LABEL = "Extenders"
EXTENDER_LIST = "MESH_UL_spectral_extenders"
VIEWPORT_PANEL = "VIEW3D_PT_spectral_unwrap"
VIEWPORT_EXTENDERS_PANEL = "VIEW3D_PT_spectral_extenders"
UV_EDITOR_PANEL = "IMAGE_PT_spectral_unwrap"
UV_EDITOR_EXTENDERS_PANEL = "IMAGE_PT_spectral_extenders"

# Operators after which changed seams lie along the islands of the map as it is.
OPERATORS_THAT_MARK_SEAMS_OF_A_MAP = (
    "UV_OT_seams_from_islands",
    "UV_OT_spectral_unwrap",
    "UV_OT_spectral_suggest_seams",
)

# Blender's menus that list the unwrap operators: 3D viewport, UV editor.
VIEWPORT_UNWRAP_MENU = "VIEW3D_MT_uv_map"
UV_EDITOR_UNWRAP_MENU = "IMAGE_MT_uvs_unwrap"
UV_EDITOR_MENU = "IMAGE_MT_uvs"
UV_EDITOR_SELECT_MENU = "IMAGE_MT_select"

# Name that Blender itself gives to the first UV map.
DEFAULT_UV_MAP = "UVMap"

# Temporary mesh, object, scene and attribute through which edit-mode data is read.
TEMPORARY_MESH = ".spectral_unwrap_temporary"
TEMPORARY_OBJECT = TEMPORARY_MESH
TEMPORARY_SCENE = TEMPORARY_MESH
ORIGINAL_FACE_ATTRIBUTE = ".spectral_unwrap_original_face"

# Enumeration items: (identifier, label, description). An identifier in lower case is the value of the same option of
# spectral_conformal.unwrap.
METHOD_ITEMS = (
    ("SPECTRAL", "Spectral", "Least angle distortion with the whole boundary free; no pins"),
    ("LSCM", "Least Squares", "Least squares conformal map, pinned at the two boundary vertices farthest apart"),
    ("FIEDLER", "Fiedler Vector", "Smallest nontrivial eigenvector over all vertices, for comparison"),
    ("AREA", "Area Normalized", "Least angle distortion relative to the area of the map, for comparison"),
)
WEIGHTS_ITEMS = (
    ("UNIFORM", "Uniform", "Every triangle counts by its area"),
    ("INVERSE_AREA", "Inverse Area", "Every triangle counts the same, for irregularly sampled meshes"),
)
BOUNDARY_ITEMS = (
    ("LENGTH", "Length", "Weigh boundary vertices by the length of their boundary edges, whatever the sampling"),
    ("VERTEX", "Vertex", "Weigh all boundary vertices equally, as in the original paper"),
)
MARGIN_METHOD_ITEMS = (
    ("SCALED", "Scaled", "Use scale of existing UVs to multiply margin"),
    ("ADD", "Add", "Just add the margin, ignoring any UV scale"),
    ("FRACTION", "Fraction", "Specify a precise fraction of final UV output"),
)
PACK = "PACK"
KEEP = "KEEP"
PLACEMENT_ITEMS = (
    (PACK, "Pack", "Scale islands by their surface area and pack them into the UV tile"),
    (KEEP, "Keep in Place", "Fit every island into the bounding box that it had before"),
)
PAIRS_IN_ORDER = "IN_ORDER"
PAIRS_TO_ACTIVE = "TO_ACTIVE"
EXTENDER_PAIRS_ITEMS = (
    (
        PAIRS_IN_ORDER,
        "In Order",
        "Connect the two selected vertices, or of several the first with the second, the third with the fourth and so "
        "on, in the order in which they were selected",
    ),
    (PAIRS_TO_ACTIVE, "To Active", "Connect every selected vertex with the active one, which was selected last"),
)
