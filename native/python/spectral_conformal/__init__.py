"""Spectral conformal parameterization of triangle and polygon meshes.

After P. Mullen, Y. Tong, P. Alliez and M. Desbrun, "Spectral Conformal Parameterization", SGP 2008. Needs NumPy only.

    solution = spectral_conformal.parameterize(vertices, triangles)    # one patch: solution.uv is (V, 2)
    result = spectral_conformal.unwrap(vertices, face_offsets, corner_vertices, seam_edges=seams)   # a polygon mesh

How maps are made is said by `Options`, whose fields are keywords of all functions that make maps, too. Arguments of any
kind or type that cannot be used raise ValueError (InvalidMeshError is one), a keyword that is no option raises
TypeError, and a patch whose map passes no numerical check SolveError; `unwrap` reports invalid patches and failed maps
chart by chart. Too little memory raises MemoryError, a progress function that returns False Cancelled; what it raises
itself passes through. Arguments are never changed. They are copied at the call: what a progress function or another
thread does to them afterwards has no effect on the result, nor on the later solves of an object.

Threads: all functions may be called from several threads at once, and let Python's other threads run while they
compute. Of the objects, see `Solver`. Each call shares its work among as many threads as the machine has cores,
which calls at once divide; `limit_threads` lowers that. Where the module works with CHOLMOD on OpenBLAS, each call into
them sets that OpenBLAS's number of threads, so that no result depends on it, and puts the process's own number back
when it ends: for that moment, other users of the same OpenBLAS in the process run with that number, too. NumPy's wheels
bring an OpenBLAS of their own, which is not touched; `build_info()["blas"]` names the one that is.
`OPENBLAS_NUM_THREADS` has no effect on results.
"""

from ._arguments import Extenders, Pins, Progress
from ._build import build_info
from ._charts import chart_of_face
from ._kept_maps import KeptMaps
from ._metric import blend_metric, metric_from_direction, metric_from_uv
from ._native import Cancelled, InvalidMeshError, SolveError
from ._options import OptionChanges, Options, SeamOptionChanges, SeamOptions
from ._packing import pack_boxes
from ._parameterization import Solver, parameterize
from ._quality import distortion, face_distortion, face_triangles, map_defects
from ._results import Chart, Charts, Distortion, FaceDistortion, MapDefects, Parameterization, Unwrap
from ._seams import Cuts, suggest_cuts, suggest_seams
from ._threads import limit_threads
from ._unwrapping import Unwrapper, unwrap

__all__ = [
    "Cancelled",
    "Chart",
    "Charts",
    "Cuts",
    "Distortion",
    "Extenders",
    "FaceDistortion",
    "InvalidMeshError",
    "KeptMaps",
    "MapDefects",
    "OptionChanges",
    "Options",
    "Parameterization",
    "Pins",
    "Progress",
    "SeamOptionChanges",
    "SeamOptions",
    "SolveError",
    "Solver",
    "Unwrap",
    "Unwrapper",
    "blend_metric",
    "build_info",
    "chart_of_face",
    "distortion",
    "face_distortion",
    "face_triangles",
    "limit_threads",
    "map_defects",
    "metric_from_direction",
    "metric_from_uv",
    "pack_boxes",
    "parameterize",
    "suggest_cuts",
    "suggest_seams",
    "unwrap",
]
