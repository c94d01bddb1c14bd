"""For programs that display a mesh and unwrap it repeatedly, such as the Blender add-on.

Charts before any solve, a cache of maps between calls of `unwrap`, the triangles that Blender draws for faces, a packer
of boxes, and the steps of solves in words of any language.
"""

from ._charts import chart_of_face
from ._kept_maps import KeptMaps
from ._messages import describe, message_templates
from ._packing import pack_boxes
from ._quality import face_triangles

__all__ = ["KeptMaps", "chart_of_face", "describe", "face_triangles", "message_templates", "pack_boxes"]
