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

LIVE_UNWRAP_PROPERTY = "spectral_unwrap_live"
LIVE_UNWRAP_LABEL = "Live Spectral Unwrap"
LIVE_UNWRAP_DESCRIPTION = "Let islands follow while their pins are moved, and unwrap again when seams are changed"

# Operators after which changed seams lie along the islands of the map as it is.
OPERATORS_THAT_MARK_SEAMS_OF_A_MAP = ("UV_OT_seams_from_islands", "UV_OT_spectral_unwrap")

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
