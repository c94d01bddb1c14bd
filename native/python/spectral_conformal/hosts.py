"""For programs that hold a mesh, show it and unwrap it again and again, such as the Blender add-on.

Charts before anything is solved, maps kept from one `unwrap` to the next, the triangles by which Blender draws faces,
and boxes packed into a square.
"""

from ._charts import chart_of_face
from ._kept_maps import KeptMaps
from ._packing import pack_boxes
from ._quality import face_triangles

__all__ = ["KeptMaps", "chart_of_face", "face_triangles", "pack_boxes"]
