"""The types of options and results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, Optional

import numpy as np
import numpy.typing as npt

Method = Literal["spectral", "lscm", "fiedler", "area"]
Weights = Literal["uniform", "inverse_area"]
Boundary = Literal["length", "vertex"]
Factorization = Literal["auto", "cholmod", "eigen"]
Pins = Mapping[int, "tuple[float, float]"]
Extenders = Iterable["tuple[int, int, float]"]
"""(vertex, vertex, strength): a soft force of section 4.2 that pushes the two apart, or pulls them together where the
strength is negative. The strength is a fraction of the boundary's total mass."""
Progress = Callable[[float, str], Optional[bool]]
"""Called with the fraction done (0 to 1) and the name of the phase. Returning False cancels: `Cancelled` is raised."""


@dataclass(frozen=True)
class Parameterization:
    """A map of one patch to the plane."""

    uv: npt.NDArray[np.float64]
    """(V, 2), in the units of the vertices; (0, 0) for vertices that no triangle uses."""
    eigenvalue: float
    """lambda of L z = lambda B z (Eq. 5) for the given vertices, forces included in B. For "lscm" z*Lz / z*Bz; for
    "area" B = A."""
    residual: float
    """|L z - lambda B z| / (largest diagonal entry of L x |z|). For "lscm" |L z| over the free vertices / (largest
    diagonal entry x extent of the map); for "area" and with forces (soft pins, extenders, hole rigidity) the last
    relative change of the map."""
    iterations: int
    """Solves with the factor."""
    turning_number: int
    """Of the longest boundary loop: 1 for a map that does not wind round itself, -1 if that loop is a hole of it."""
    unfolded: int
    """Folded triangles that `fold_free` has unfolded."""
    is_embedding: bool
    """Whether `fold_free` had to replace the map by an embedding."""
    mean_qc_before: float
    """Mean QC of the map that `fold_free` unfolded or replaced; not a number where there was none."""
    message: str
    """Remedies that were needed (the eigenvalue is then of the form and weights named here) and repaired faces; empty
    when there was none."""
    timings: dict[str, float]
    """Seconds per phase, by name."""


@dataclass(frozen=True)
class Distortion:
    """Distortion of a map from 3D to the plane, per triangle and summed up."""

    qc: npt.NDArray[np.float64]
    """(F,) quasi-conformal distortion: larger over smaller singular value of the Jacobian, infinite for a collapsed
    image, 1 for triangles without area in 3D."""
    mean_qc: float
    """Weighted by the area in 3D (section 5 of the paper)."""
    p95_qc: float
    """95th percentile over the triangles."""
    p99_qc: float
    """99th percentile over the triangles."""
    max_qc: float
    log2_scale: npt.NDArray[np.float64]
    """(F,) log2 of the root of image area / area."""
    log2_scale_deviation: float
    """Standard deviation of log2_scale, weighted by the area in 3D."""
    flipped: npt.NDArray[np.bool_]
    """(F,) image wound against the majority (by area) of its connected patch, after orienting the patch."""
    turning_number: int
    """Of the outer boundary loop of the largest patch; 0 for a closed one."""
    overlapping: npt.NDArray[np.bool_]
    """(F,) whether the image covers part of another triangle's."""


@dataclass(frozen=True)
class MapDefects:
    """Faces of a UV map that lie the wrong way round or on others."""

    flipped: npt.NDArray[np.bool_]
    """(faces,) a triangle of the face is wound against the majority (by UV area) of its island, after orienting the
    island's faces consistently; False for faces that are not selected."""
    overlapping: npt.NDArray[np.bool_]
    """(faces,) covers part of another face; False for faces that are not selected."""


@dataclass(frozen=True)
class Chart:
    """What became of one chart of `unwrap`."""

    faces: npt.NDArray[np.int32]
    """Faces of the mesh, ascending."""
    status: Literal["solved", "failed"]
    message: str
    """Why it failed and what to do, or what was repaired to solve it; empty for a clean chart."""
    eigenvalue: float
    """Not a number for a failed chart, like residual, mean_qc and max_qc."""
    residual: float
    iterations: int
    turning_number: int
    mean_qc: float
    """As in `Distortion`, over the chart's triangles; of a convex quad's two splits the less distorted counts."""
    max_qc: float
    flipped: int
    """Faces with a flipped triangle."""
    overlapping: int
    """Faces that cover part of another face of the chart. Of several faces on the same vertices one counts."""
    unfolded: int
    """Folded triangles that `fold_free` has unfolded."""
    is_embedding: bool
    """Whether `fold_free` had to replace the map by an embedding."""
    mean_qc_before: float
    """Mean QC of the map that `fold_free` unfolded or replaced; not a number where there was none."""
    method: Method
    """The one used: "lscm" for a chart with several pins, unless they are soft."""
    n_pins: int
    """Pinned vertices of the chart."""
    n_vertices: int
    """Vertices of the chart; a mesh vertex on a seam counts once for every copy."""
    area: float
    """In 3D."""


@dataclass(frozen=True)
class Unwrap:
    """A polygon mesh unwrapped chart by chart. Charts are not packed: each is centred at the origin, or at its pins."""

    uv: npt.NDArray[np.float64]
    """(C, 2) per face corner, 0 where not solved."""
    solved_corners: npt.NDArray[np.bool_]
    """(C,)"""
    chart_of_face: npt.NDArray[np.int32]
    """(faces,) index into charts, -1 for faces that are not selected."""
    charts: list[Chart]
    unused_extenders: npt.NDArray[np.bool_]
    """(number of extenders,) those without effect: no solved chart has both vertices, or its pins hold it."""
