"""Spectral conformal parameterization of triangle and polygon meshes.

After P. Mullen, Y. Tong, P. Alliez and M. Desbrun, "Spectral Conformal Parameterization", SGP 2008. Needs NumPy only.

    solution = spectral_conformal.parameterize(vertices, triangles)    # one patch: solution.uv is (V, 2)
    result = spectral_conformal.unwrap(vertices, face_offsets, corner_vertices, seam_edges=seams)   # a polygon mesh

Arguments of any kind or type that cannot be used raise ValueError (InvalidMeshError is one), and a patch whose map
passes no numerical check SolveError; `unwrap` reports both chart by chart. Too little memory raises MemoryError, a
progress function that returns False Cancelled; what it raises itself passes through. Arguments are never changed.
"""

from ._api import Solver, Unwrapper, build_info, distortion, map_defects, parameterize, unwrap
from ._charts import chart_of_face
from ._metric import blend_metric, metric_from_direction, metric_from_uv
from ._native import Cancelled, InvalidMeshError, SolveError
from ._seams import suggest_cuts, suggest_seams
from ._types import Chart, Distortion, Extenders, MapDefects, Parameterization, Progress, Unwrap

__all__ = [
    "Cancelled",
    "Chart",
    "Distortion",
    "Extenders",
    "InvalidMeshError",
    "MapDefects",
    "Parameterization",
    "Progress",
    "SolveError",
    "Solver",
    "Unwrap",
    "Unwrapper",
    "blend_metric",
    "build_info",
    "chart_of_face",
    "distortion",
    "map_defects",
    "metric_from_direction",
    "metric_from_uv",
    "parameterize",
    "suggest_cuts",
    "suggest_seams",
    "unwrap",
]
