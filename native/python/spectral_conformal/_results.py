"""The results: maps and reports on them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, Optional, SupportsIndex, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._mesh import Mesh
from ._messages import Step, describe, steps_of
from ._options import Boundary, Method, Weights

Fallback = Optional[Literal["unfolded", "clamped_triangles", "other_boundary", "other_weights", "tutte_embedding"]]
"""What replaced a map that failed the checks; None for the requested map. "unfolded": that map with flipped
triangles unfolded, so that its boundary winds around once. "clamped_triangles": thin triangles were given a minimal
height in the energy. "other_boundary", "other_weights": the form B with the other `boundary`, the energy L with the
other `weights`. "tutte_embedding": a relaxed Tutte embedding, as a fallback or requested by `fold_free`."""
EigenvalueOf = Literal["eigenvector", "map"]
"""What an eigenvalue belongs to: the "eigenvector" of the solved problem, or another "map" (pinned, unfolded,
replaced), whose quotient z*Lz / z*Bz (Eq. 5) it is."""
BlendEnding = Optional[
    Literal["converged", "factorization_limit", "stalled", "indefinite_form", "no_image_area", "rejected"]
]
"""How the relaxation toward an isometry for `area_blend` ended; None without it. "converged"; "factorization_limit":
more factorizations would change the map further; "stalled": flips or rounding leave no step; "indefinite_form": the
form of the descent is not positive definite in double precision. Nothing was blended if the conformal map has
"no_image_area", or if the relaxed map was "rejected" because it had more flipped triangles or overflowed."""


# The meaning of the codes in the rows of `Charts`, and the rows' fields.
_NAMES: dict[str, tuple[str | None, ...]] = _native.CHART_NAMES
_FIELDS: tuple[str, ...] = _native.CHART_FIELDS
_RECORDS_AT_ONCE = 1000


@dataclass(frozen=True, eq=False)
class _SolveRecord:
    """How the map of a patch was made."""

    method: Method
    """The method used: "lscm" with three or more hard pins."""
    weights: Weights
    """Of the solved energy L: those requested, except with the `fallback` "other_weights"."""
    boundary: Boundary
    """Of the solved form B: the one requested, except with the `fallback` "other_boundary"."""
    fallback: Fallback
    """How the problem or its map was changed because the map failed the checks; None if it passed."""
    clamped_triangles: int
    """Thin triangles that the fallback "clamped_triangles" gave a minimal height in the energy."""
    eigenvalue: float
    """lambda of L z = lambda B z (Eq. 5) for the given vertices, soft constraints included in B, for the method,
    weights and boundary above. For "area" B = A."""
    eigenvalue_of: EigenvalueOf
    """Whether `eigenvalue` belongs to an "eigenvector", or is the quotient z*Lz / z*Bz of another "map"."""
    residual: float
    """|L z - lambda B z| / (largest diagonal entry of L x |z|), of what the map's constraints leave free. For "lscm"
    |L z| over the free vertices / (largest diagonal entry x extent of the map); for "area" and with soft constraints
    (soft pins, extenders, hole rigidity) the last relative change of the map."""
    iterations: int
    """Solves with the factor."""
    attempts: int
    """Eigenproblems, or pinned systems, solved until one passed the checks, fallbacks included."""
    turning_number: int
    """Of the longest boundary loop: 1 if the map does not wind around itself, -1 if that loop is a hole of the map."""
    relaxation: BlendEnding
    """How the relaxation for `area_blend` ended; None without it."""
    scale_deviation_before: float
    """With `area_blend`: `Distortion.log2_scale_deviation` of the conformal map. Otherwise NaN."""
    scale_deviation: float
    """The same for this map. NaN without `area_blend`, except for charts that `unwrap` measured."""
    hole_rigidity: float
    """Of the solved form B: as requested, lowered if that was too high, or as "automatic" chose it."""
    polish_steps: int
    """Steps of `polish` from the eigenvector to this map; 0 if the map is the eigenvector."""
    unfolded: int
    """Number of flipped triangles that `fold_free` unfolded."""
    is_embedding: bool
    """Whether `fold_free` had to replace the map with an embedding."""
    mean_qc_before: float
    """Mean QC of the map that `fold_free` unfolded or replaced; NaN if there was none."""
    steps: tuple[Step, ...]
    """Fallbacks, repaired faces and other remarks on the map, in this order."""

    @property
    def message(self) -> str:
        """The steps in words, see `hosts.describe`; empty if there are none."""
        return describe(self.steps)


@dataclass(frozen=True, eq=False)
class Parameterization(_SolveRecord):
    """A map of one patch to the plane."""

    uv: npt.NDArray[np.float64]
    """(V, 2), in the units of the vertices; (0, 0) for vertices that no triangle uses."""
    timings: dict[str, float]
    """Seconds per phase, by name."""


@dataclass(frozen=True, eq=False)
class Distortion:
    """Distortion of a map from 3D to the plane, per triangle and in summary."""

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
    """(F,) whether the image is wound against the majority (by area) of its connected patch, after orienting the
    patch."""
    turning_number: int
    """Of the outer boundary loop of the largest patch; 0 for a closed one."""
    overlapping: npt.NDArray[np.bool_]
    """(F,) whether the image covers part of another triangle's image."""


@dataclass(frozen=True, eq=False)
class FaceDistortion:
    """Distortion of a UV map for each face of a polygon mesh.

    A face that is not selected, or has no area in 3D, has `qc` 1, `log2_scale` 0 and zero areas. If its image has no
    area, `qc` is infinite and `log2_scale` minus infinity. If a position or UV is not finite, `qc` and `log2_scale` are
    NaN, and the areas zero.
    """

    qc: npt.NDArray[np.float64]
    """(faces,) quasi-conformal distortion (section 5): larger over smaller singular value, averaged over the face's
    triangles by their area in 3D."""
    log2_scale: npt.NDArray[np.float64]
    """(faces,) log2 of the root of (area in the map / area in 3D)."""
    area: npt.NDArray[np.float64]
    """(faces,) in 3D, in squares of the vertices' unit."""
    image_area: npt.NDArray[np.float64]
    """(faces,) in the map, signed: counterclockwise positive."""


@dataclass(frozen=True, eq=False)
class MapDefects:
    """The islands of a UV map, and its flipped and overlapping faces."""

    island_of_face: npt.NDArray[np.int32]
    """(faces,) the island of every face; islands are numbered in the order of their first face. -1 for faces that are
    not selected or have fewer than three different corners."""
    flipped: npt.NDArray[np.bool_]
    """(faces,) whether a triangle of the face is wound against the majority (by UV area) of its island, after orienting
    the island's faces consistently; False for faces that are not selected."""
    overlapping: npt.NDArray[np.bool_]
    """(faces,) whether the face covers part of another one; False for faces that are not selected."""


@dataclass(frozen=True, eq=False)
class Chart(_SolveRecord):
    """The result for one chart of `unwrap`.

    A failed chart has the method, weights and boundary that were requested, a message that says why it failed and what
    to do, and NaN for eigenvalue, residual, mean_qc, max_qc, image_area and the bounding box.
    """

    faces: npt.NDArray[np.int32]
    """Faces of the mesh, ascending."""
    status: Literal["solved", "failed"]
    mean_qc: float
    """As in `Distortion`, over the chart's triangles; a quad is split so that its smaller triangle is as large as
    possible."""
    max_qc: float
    """The largest value of a face, as in `FaceDistortion`."""
    flipped: int
    """Faces with a flipped triangle; -1 if `Unwrapper.solve` did not measure the map."""
    overlapping: int
    """Faces that cover part of another face of the chart. Several faces with the same vertices count once. -1 if
    `Unwrapper.solve` did not measure the map."""
    n_pins: int
    """Pinned vertices of the chart."""
    n_vertices: int
    """Vertices of the chart; a mesh vertex on a seam counts once per copy."""
    area: float
    """In 3D."""
    image_area: float
    """Sum of the unsigned areas of its faces in the map. Several faces with the same vertices count once."""
    low_u: float
    """`low_u`, `low_v`, `high_u` and `high_v` are the bounding box of the map."""
    low_v: float
    high_u: float
    high_v: float
    reused: bool
    """Whether the map comes from the `kept_maps` of `unwrap` instead of a solve."""


class Charts(Sequence[Chart]):
    """The charts of a result, in order: a sequence that makes its records on access.

    It stores arrays, because a record takes some thousand bytes: a million of them would need as much as the solves.
    """

    def __init__(self, rows: npt.NDArray[np.void], faces: npt.NDArray[np.int32], remarks: Mapping[int, tuple]) -> None:
        """Take the native module's arrays: see chart_records.h."""
        self._rows = rows
        self._faces = faces
        self._first_faces = np.cumsum(rows["n_faces"], dtype=np.int64) - rows["n_faces"]
        self._remarks = remarks
        self._numbers = range(len(rows))

    def __len__(self) -> int:
        """Return the number of charts, including failed ones."""
        return len(self._rows)

    @overload
    def __getitem__(self, index: SupportsIndex) -> Chart: ...
    @overload
    def __getitem__(self, index: slice) -> Charts: ...
    def __getitem__(self, index: SupportsIndex | slice) -> Chart | Charts:
        """Return a chart, or a slice that shares the memory of this sequence."""
        if not isinstance(index, slice):
            position = range(len(self))[index]
            return next(self._from(position, position + 1))
        part = object.__new__(Charts)
        part._rows = self._rows[index]
        part._faces = self._faces
        part._first_faces = self._first_faces[index]
        part._remarks = self._remarks
        part._numbers = self._numbers[index]
        return part

    def __iter__(self) -> Iterator[Chart]:
        """Iterate over the charts; a loop that keeps none of them needs memory for a few."""
        for start in range(0, len(self), _RECORDS_AT_ONCE):
            yield from self._from(start, start + _RECORDS_AT_ONCE)

    def __repr__(self) -> str:
        """Return a summary in one line."""
        solved = int(np.count_nonzero(self._rows["status"]))
        return f"<{len(self)} charts, {solved} of them solved>"

    @property
    def n_faces(self) -> npt.NDArray[np.int32]:
        """(number of charts,)"""
        return self._rows["n_faces"].copy()

    def column(self, name: str) -> np.ndarray:
        """Return one field of all charts as an array (number of charts,); any field but `faces`.

        Raises:
            ValueError: charts have no such field.
        """
        if name == "message":
            return np.array([describe(self._remark(number)) for number in self._numbers], object)
        if name == "steps":
            result = np.empty(len(self), object)
            for index, number in enumerate(self._numbers):
                result[index] = self._remark(number)
            return result
        if name in _NAMES:
            return np.array(_NAMES[name], object)[self._rows[name]]
        if name not in _FIELDS:
            raise ValueError(f"Charts have no column {name!r}.")
        return self._rows[name].copy()

    def _remark(self, number: int) -> tuple[Step, ...]:
        """Return the steps of a chart, given its number among all."""
        return steps_of(self._remarks.get(number, ()))

    def _from(self, start: int, end: int) -> Iterator[Chart]:
        first_faces = self._first_faces[start:end].tolist()
        for row, first, number in zip(self._rows[start:end].tolist(), first_faces, self._numbers[start:end]):
            fields = dict(zip(_FIELDS, row))
            fields["faces"] = self._faces[first : first + fields.pop("n_faces")].copy()
            fields["steps"] = self._remark(number)
            for name, names in _NAMES.items():
                fields[name] = names[fields[name]]
            # The constructor of a frozen record sets the fields one by one, which takes ten times as long.
            chart = object.__new__(Chart)
            chart.__dict__.update(fields)
            yield chart


@dataclass(frozen=True, eq=False)
class Unwrap(Mesh):
    """A polygon mesh unwrapped chart by chart. Charts are not packed: each lies around the origin, or at its pins.

    `seam_edges` are all seams that were cut.
    """

    uv: npt.NDArray[np.float64]
    """(C, 2) per face corner, 0 where not solved."""
    solved_corners: npt.NDArray[np.bool_]
    """(C,)"""
    chart_of_face: npt.NDArray[np.int32]
    """(F,) index into charts, -1 for faces that are not selected."""
    vertex_of_corner: npt.NDArray[np.int32]
    """(C,) the chart vertex of each corner, -1 where not solved. They are numbered chart after chart: those of chart k
    begin at the sum of `n_vertices` of the charts before it. Corners with the same one have the same UV."""
    charts: Charts
    unused_extenders: npt.NDArray[np.bool_]
    """(number of extenders,) those without effect: no solved chart has both vertices, or pins hold both."""
    timings: dict[str, float]
    """Seconds per phase, by name, summed over the charts; several charts may be solved at once."""
