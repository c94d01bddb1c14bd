"""Spectral conformal parameterization of triangle and polygon meshes.

After P. Mullen, Y. Tong, P. Alliez and M. Desbrun, "Spectral Conformal Parameterization", SGP 2008. Needs NumPy only.

    import spectral_conformal as sc

    uv = sc.parameterize(V, F).uv                      # one patch with a border, per vertex, as in igl
    vmapping, faces, uvs = sc.pack(sc.unwrap(sc.suggest_seams(V, F))).split_vertices()  # any mesh, as in xatlas
    mesh = sc.unwrap(sc.Mesh(V, F, seam_edges=seams))  # step by step: mesh.uv is (C, 2), per corner of the faces
    mesh = sc.pack(sc.relax(mesh, sizes=1), texture_size=2048, margin=8)

`F` holds the vertices of each face: (F, 3), (F, 4) or a list of polygons; see `Mesh` for offsets, as in Blender.
`parameterize` is strict: it raises SolveError if no map passes the numerical checks. `unwrap` is lenient: it reports
invalid patches and failed maps chart by chart, and says where a fallback replaced the requested map.

`Options` says how maps are made. Each of its fields is also a keyword of every function that makes maps. An argument of
the wrong type or an unknown keyword raises TypeError; any other unusable argument raises ValueError, of which
InvalidMeshError is a subclass. Too little memory raises MemoryError. A progress function that returns False raises
Cancelled; its own exceptions pass through. Each call copies its arguments and never changes them, so later changes by a
progress function or another thread have no effect.

Threads: all functions may be called from several threads at once, and release the GIL while they compute. For objects,
see `Solver`. Each call uses up to one thread per core; concurrent calls divide these. `limit_threads` lowers that. No
result depends on the number of threads. If the module uses CHOLMOD on OpenBLAS, each call sets OpenBLAS's number of
threads and restores the previous number when it ends; until then, other users of the same OpenBLAS in the process run
with that number, too. NumPy's wheels bring their own OpenBLAS, which stays untouched; `build_info()["blas"]` names the
one in use.
"""

from . import _messages, _native, defaults, hosts
from ._build import build_info
from ._constraints import Constraints
from ._island_packing import PackedMap, Packer, pack
from ._mesh import Mesh, SplitMesh
from ._messages import SolveError, Step
from ._metric import blend_metric, metric_from_direction, metric_from_uv
from ._native import Cancelled, InvalidMeshError
from ._options import OptionChanges, Options, SeamOptionChanges, SeamOptions
from ._parameterization import Solver, parameterize
from ._pattern import Pattern, pattern
from ._quality import distortion, face_distortion, map_defects
from ._rebaking import BakedTexture, bake_values, rebake
from ._relaxation import Relaxation, RelaxedMap, relax
from ._results import Chart, Charts, Distortion, FaceDistortion, MapDefects, Parameterization, Unwrap
from ._seams import Cuts, suggest_cuts, suggest_seams
from ._tangents import tangents
from ._threads import limit_threads
from ._unwrapping import Unwrapper, unwrap

__version__: str = _native.VERSION

_native.put_errors_into_words(SolveError, _messages.describe_native, _messages.OUT_OF_MEMORY, _messages.REENTERED)

__all__ = [
    "BakedTexture",
    "Cancelled",
    "Chart",
    "Charts",
    "Constraints",
    "Cuts",
    "Distortion",
    "FaceDistortion",
    "InvalidMeshError",
    "MapDefects",
    "Mesh",
    "OptionChanges",
    "Options",
    "PackedMap",
    "Packer",
    "Parameterization",
    "Pattern",
    "Relaxation",
    "RelaxedMap",
    "SeamOptionChanges",
    "SeamOptions",
    "SolveError",
    "Solver",
    "SplitMesh",
    "Step",
    "Unwrap",
    "Unwrapper",
    "bake_values",
    "blend_metric",
    "build_info",
    "defaults",
    "distortion",
    "face_distortion",
    "hosts",
    "limit_threads",
    "map_defects",
    "metric_from_direction",
    "metric_from_uv",
    "pack",
    "parameterize",
    "pattern",
    "rebake",
    "relax",
    "suggest_cuts",
    "suggest_seams",
    "tangents",
    "unwrap",
]
