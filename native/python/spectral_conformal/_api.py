"""The public functions: they check and convert their arguments, call the native module and wrap what it returns."""

from __future__ import annotations

import numbers
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Optional, get_args

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import InvalidMeshError

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
_OPTIONS = {
    "method": get_args(Method),
    "weights": get_args(Weights),
    "boundary": get_args(Boundary),
    "factorization": get_args(Factorization),
}

DEFAULT_TOLERANCE = 1e-8
# Beyond, the negative end of the spectrum takes the digits of the eigenvalue that is sought.
SOFT_PINS_LIMIT = 1e4
EXTENDER_LIMIT = 1e4
HOLE_RIGIDITY_LIMIT = 1e4
_RATIO_LIMIT = 1e4
_INDEX_LIMIT = np.iinfo(np.int32).max


@dataclass(frozen=True)
class Parameterization:
    """A map of one patch to the plane."""

    uv: npt.NDArray[np.float64]
    """(V, 2), in the units of the vertices; (0, 0) for vertices that no triangle uses."""
    eigenvalue: float
    """lambda of L z = lambda B z (Eq. 5) for the given vertices. For "lscm" z*Lz / z*Bz; for "area" B = A."""
    residual: float
    """|L z - lambda B z| / (largest diagonal entry of L x |z|). For "lscm" |L z| over the free vertices / (largest
    diagonal entry x extent of the map); for "area" the last relative change of the inverse iteration."""
    iterations: int
    """Solves with the factor."""
    turning_number: int
    """Of the longest boundary loop: 1 for a map that does not wind round itself, -1 if that loop is a hole of it."""
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


class Solver:
    """One patch, factored once, solved as often as wanted. Several threads may share it; they take turns."""

    def __init__(
        self,
        vertices: npt.ArrayLike,
        triangles: npt.ArrayLike,
        *,
        weights: Weights = "uniform",
        boundary: Boundary = "length",
        fill_holes: bool = False,
        metric: npt.ArrayLike | None = None,
        area_blend: float = 0.0,
        factorization: Factorization = "auto",
        progress: Progress | None = None,
    ) -> None:
        """Assemble and factor the conformal energy of one patch.

        Arguments and errors are those of `parameterize`.
        """
        options = _patch_options(weights, boundary, factorization, fill_holes, area_blend)
        self._n_vertices, self._native = _assemble(vertices, triangles, metric, options)
        self._native.factorize(_progress(progress))

    def solve(
        self,
        *,
        method: Method = "spectral",
        pins: Pins | None = None,
        soft_pins: float = 0.0,
        extenders: Extenders | None = None,
        hole_rigidity: float = 0.0,
        tolerance: float = DEFAULT_TOLERANCE,
        progress: Progress | None = None,
    ) -> Parameterization:
        """Solve with the kept factor ("lscm" and "fiedler" make one of their own). See `parameterize`.

        Extenders and hole rigidity change the form B only. A solve with them starts from the earlier maps, so that a
        small change of strength costs a few solves; the result agrees with a fresh one to the tolerance.
        """
        return _solve(
            self._native, self._n_vertices, method, pins, soft_pins, extenders, hole_rigidity, tolerance, progress
        )


def parameterize(
    vertices: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    method: Method = "spectral",
    weights: Weights = "uniform",
    boundary: Boundary = "length",
    pins: Pins | None = None,
    soft_pins: float = 0.0,
    extenders: Extenders | None = None,
    hole_rigidity: float = 0.0,
    fill_holes: bool = False,
    metric: npt.ArrayLike | None = None,
    area_blend: float = 0.0,
    tolerance: float = DEFAULT_TOLERANCE,
    progress: Progress | None = None,
    factorization: Factorization = "auto",
) -> Parameterization:
    """Map one disk-like patch (holes allowed) conformally to the plane.

    Args:
        vertices: (V, 3) positions, any unit. Vertices that no triangle uses are allowed.
        triangles: (F, 3) vertex indices. Faces wound against the majority are turned.
        method: "spectral" (Eq. 5), "lscm" (pinned LSCM / DCP, section 2.2), "fiedler" (Eq. 4) or "area" (B = A).
        weights: of each triangle's energy, "uniform" or "inverse_area" (section 4.1).
        boundary: mass B of a vertex of the outer loop, "length" (half of its two boundary edges) or "vertex" (1, as in
            the paper).
        pins: vertex -> (u, v), for "lscm": two or more are held exactly and the map is returned as solved; with one the
            map is solved free and moved onto it; without any, the two farthest boundary vertices are held. For
            "spectral" together with `soft_pins`.
        soft_pins: for "spectral", strength of a force in B that pulls the pinned vertices towards a similar image of
            their positions, as a fraction of the boundary's total mass; the map then comes with the similarity that
            fits it to the pins. At 1 it is hardly felt, at 1000 the pins are nearly met. 0: no force.
        extenders: for "spectral", (vertex, vertex, strength) triples, see `Extenders`; strength at most 1e4 in size.
        hole_rigidity: for "spectral", 0 to 1e4: how strongly every boundary loop but the longest is kept from shrinking
            to a point, as a force of its own about its barycentre (section 4.2). At 1 a hole counts like the outer
            boundary.
        fill_holes: close every boundary loop but the longest by virtual triangles, which keep the holes' shape. They
            count in the eigenvalue and in no measure of the map.
        metric: (F, 2, 2) symmetric positive definite tensor of each triangle (section 4.3), in its plane: the first
            axis runs from its first to its second corner, the second axis is a quarter turn counter-clockwise from it,
            seen from where the corners run counter-clockwise. A tangent vector t gets the squared length t G t, and the
            map is conformal for these lengths: quasi-conformal. The scale of a tensor is without effect. See
            `metric_from_uv`, `metric_from_direction` and `blend_metric`.
        area_blend: 0 keeps angles; towards 1 the map gives them up for areas: the patch is unfolded conformally,
            relaxed towards an isometry, and solved again with the metric of that map, blended with the identity. On top
            of `metric` where both are given.
        tolerance: relative residual at which the eigenvalue iteration stops, between 1e-14 and 1e-3.
        progress: see `Progress`.
        factorization: "auto" takes CHOLMOD where the module was built with it, otherwise Eigen.

    Returns:
        The map: positively oriented, the mean of its vertices at the origin, its area equal to the area in 3D.

    Raises:
        InvalidMeshError: (a ValueError) the mesh is not one disk-like patch; the message says what it is.
        ValueError: an array or option is not of the kind described here.
        SolveError: no attempt passed the numerical checks.
        Cancelled: `progress` returned False.
    """
    options = _patch_options(weights, boundary, factorization, fill_holes, area_blend)
    n_vertices, solver = _assemble(vertices, triangles, metric, options)
    return _solve(solver, n_vertices, method, pins, soft_pins, extenders, hole_rigidity, tolerance, progress)


def distortion(vertices: npt.ArrayLike, triangles: npt.ArrayLike, uv: npt.ArrayLike) -> Distortion:
    """Measure a map.

    Args:
        vertices: (V, 3) positions, finite where a triangle uses them.
        triangles: (F, 3) vertex indices.
        uv: (V, 2) image of each vertex, finite.

    Raises:
        ValueError: an array is not of the kind described here.
    """
    vertices = _vertices(vertices)
    triangles = _indices(triangles, "triangles", 3, len(vertices))
    if not np.isfinite(vertices[triangles]).all():
        raise ValueError("vertices has values that are not finite; every vertex that a triangle uses needs a position.")
    uv = _floats(uv, "uv", 2)
    if len(uv) != len(vertices):
        raise ValueError(f"uv has {len(uv)} rows, but there are {len(vertices)} vertices.")
    if not np.isfinite(uv).all():
        raise ValueError("uv has values that are not finite.")
    return Distortion(**_native.distortion(vertices, triangles, uv))


def unwrap(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    method: Method = "spectral",
    weights: Weights = "uniform",
    boundary: Boundary = "length",
    pins: Pins | None = None,
    pinned_corners: npt.ArrayLike | None = None,
    corner_uv: npt.ArrayLike | None = None,
    soft_pins: float = 0.0,
    extenders: Extenders | None = None,
    hole_rigidity: float = 0.0,
    fill_holes: bool = False,
    metric: npt.ArrayLike | None = None,
    area_blend: float = 0.0,
    tolerance: float = DEFAULT_TOLERANCE,
    progress: Progress | None = None,
    factorization: Factorization = "auto",
) -> Unwrap:
    """Cut a polygon mesh into charts and map each to the plane. A chart that cannot be solved does not stop the others.

    Charts are cut at seams, at the border of the selection, at edges with three or more faces and at bow-tie vertices.

    Args:
        vertices: (V, 3) positions, any unit.
        face_offsets: (faces + 1,) the corners of face f are face_offsets[f] to face_offsets[f + 1], as in Blender.
        corner_vertices: (C,) vertex of each corner.
        seam_edges: (S, 2) vertex pairs in any order; pairs that are no edge are without effect.
        selected_faces: (faces,) bool, all faces when left out.
        pins: mesh vertex -> (u, v), held by all copies of the vertex, as in `parameterize`; pins outside the selection
            have no effect.
        pinned_corners: (C,) bool, corners whose `corner_uv` is a pin. A chart with two or more pins is solved by pinned
            LSCM whatever `method` says, and returned as solved; with one it is solved free, with its area in 3D, and
            moved onto the pin. A mesh vertex with different pins is split there: each of its corners goes to the
            nearest. The pin of a chart's vertex is the mean over its pinned corners, and goes before `pins`.
        corner_uv: (C, 2) the map so far, finite where pinned; needed with `pinned_corners`.
        soft_pins: see `parameterize`; charts with pins are then solved by the spectral method.
        extenders: (vertex, vertex, strength) triples of mesh vertices, see `Extenders`. An extender acts in every chart
            that has copies of both vertices; where a seam gives a vertex several copies in one chart, it acts on their
            barycentre. One whose vertices lie in no common chart has no effect, like all in a chart held by hard pins:
            `Unwrap.unused_extenders` tells.
        hole_rigidity: see `parameterize`.
        fill_holes: see `parameterize`.
        metric: (faces, 3, 3) symmetric tensor of space for each face: a tangent vector t gets the squared length t G t
            and the map is conformal for these lengths; positive definite on the face's plane. For a mesh of triangles
            also (faces, 2, 2) as in `parameterize`.
        area_blend: see `parameterize`.
        method: this and the other options as in `parameterize`.
        weights: see `parameterize`.
        boundary: see `parameterize`.
        tolerance: see `parameterize`.
        progress: see `Progress`.
        factorization: see `parameterize`.

    Raises:
        ValueError: the arrays do not describe a mesh.
        Cancelled: `progress` returned False.
    """
    arguments, n_vertices = _unwrap_arguments(
        vertices,
        face_offsets,
        corner_vertices,
        seam_edges=seam_edges,
        selected_faces=selected_faces,
        method=method,
        weights=weights,
        boundary=boundary,
        pins=pins,
        pinned_corners=pinned_corners,
        corner_uv=corner_uv,
        soft_pins=soft_pins,
        fill_holes=fill_holes,
        metric=metric,
        area_blend=area_blend,
        factorization=factorization,
    )
    return _unwrapped(
        _native.unwrap(
            arguments,
            _extenders(extenders, method, n_vertices),
            _hole_rigidity(hole_rigidity, method),
            _tolerance(tolerance),
            _progress(progress),
        )
    )


class Unwrapper:
    """`unwrap` for several solves of one mesh that differ in extenders, hole rigidity and tolerance only.

    Keeps the charts and their factors; every solve starts from the maps of the last. Several threads may share it; they
    take turns.
    """

    def __init__(
        self,
        vertices: npt.ArrayLike,
        face_offsets: npt.ArrayLike,
        corner_vertices: npt.ArrayLike,
        *,
        seam_edges: npt.ArrayLike | None = None,
        selected_faces: npt.ArrayLike | None = None,
        method: Method = "spectral",
        weights: Weights = "uniform",
        boundary: Boundary = "length",
        pins: Pins | None = None,
        pinned_corners: npt.ArrayLike | None = None,
        corner_uv: npt.ArrayLike | None = None,
        soft_pins: float = 0.0,
        fill_holes: bool = False,
        metric: npt.ArrayLike | None = None,
        area_blend: float = 0.0,
        factorization: Factorization = "auto",
    ) -> None:
        """Cut the mesh into charts. Arguments and errors are those of `unwrap`."""
        arguments, self._n_vertices = _unwrap_arguments(
            vertices,
            face_offsets,
            corner_vertices,
            seam_edges=seam_edges,
            selected_faces=selected_faces,
            method=method,
            weights=weights,
            boundary=boundary,
            pins=pins,
            pinned_corners=pinned_corners,
            corner_uv=corner_uv,
            soft_pins=soft_pins,
            fill_holes=fill_holes,
            metric=metric,
            area_blend=area_blend,
            factorization=factorization,
        )
        self._method = method
        self._native = _native.Unwrapper(arguments)

    def solve(
        self,
        *,
        extenders: Extenders | None = None,
        hole_rigidity: float = 0.0,
        tolerance: float = DEFAULT_TOLERANCE,
        progress: Progress | None = None,
    ) -> Unwrap:
        """Solve all charts. See `unwrap`."""
        return _unwrapped(
            self._native.solve(
                _extenders(extenders, self._method, self._n_vertices),
                _hole_rigidity(hole_rigidity, self._method),
                _tolerance(tolerance),
                _progress(progress),
            )
        )


def metric_from_uv(vertices: npt.ArrayLike, triangles: npt.ArrayLike, uv: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the metric (F, 2, 2) of a map: J^T J. Solved with it, the map comes back up to a similarity.

    Args:
        vertices: (V, 3) positions, finite.
        triangles: (F, 3) vertex indices.
        uv: (V, 2) image of each vertex, finite. Triangles without area in 3D get the identity.

    Raises:
        ValueError: an array is not of the kind described here, or a triangle's image has no area.
    """
    vertices = _vertices(vertices)
    triangles = _indices(triangles, "triangles", 3, len(vertices))
    uv = _floats(uv, "uv", 2)
    if len(uv) != len(vertices):
        raise ValueError(f"uv has {len(uv)} rows, but there are {len(vertices)} vertices.")
    if not (np.isfinite(vertices[triangles]).all() and np.isfinite(uv[triangles]).all()):
        raise ValueError("vertices or uv has values that are not finite where a triangle uses them.")
    metric = _native.metric_from_uv(vertices, triangles, uv)
    bad = _native.first_not_positive_definite(metric)
    if bad >= 0:
        raise ValueError(f"The image of triangle {bad} has no area, so the map has no metric there; unfold it first.")
    return metric


def metric_from_direction(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike, directions: npt.ArrayLike, ratios: npt.ArrayLike
) -> npt.NDArray[np.float64]:
    """Return the metric (F, 2, 2) under which each triangle is `ratio` times as long along a direction.

    Args:
        vertices: (V, 3) positions, finite.
        triangles: (F, 3) vertex indices.
        directions: (F, 3), or (3,) for all: directions in space, of any length, projected into the triangles' planes.
            Where one is perpendicular to its triangle the metric is the identity.
        ratios: (F,), or one for all: positive; above 1 the map gets longer along the direction than across it.

    Raises:
        ValueError: an array is not of the kind described here.
    """
    vertices = _vertices(vertices)
    triangles = _indices(triangles, "triangles", 3, len(vertices))
    if not np.isfinite(vertices[triangles]).all():
        raise ValueError("vertices has values that are not finite; every vertex that a triangle uses needs a position.")
    directions = _broadcast(directions, "directions", (len(triangles), 3))
    ratios = _broadcast(ratios, "ratios", (len(triangles),))
    if not (np.isfinite(directions).all() and directions.any(axis=1).all()):
        raise ValueError("directions must be finite and not zero.")
    if not ((ratios >= 1.0 / _RATIO_LIMIT) & (ratios <= _RATIO_LIMIT)).all():
        raise ValueError(f"ratios must lie between {1.0 / _RATIO_LIMIT:g} and {_RATIO_LIMIT:g}.")
    return _native.metric_from_direction(vertices, triangles, directions, ratios)


def blend_metric(metric: npt.ArrayLike, amount: float) -> npt.NDArray[np.float64]:
    """Return the metric between the identity (amount 0) and `metric` scaled to determinant 1 (amount 1), (F, 2, 2).

    It is the power G^amount, so that half of the way taken twice is the whole way.

    Args:
        metric: (F, 2, 2) symmetric positive definite tensors.
        amount: 0 to 1.

    Raises:
        ValueError: the metric or amount is not of the kind described here.
    """
    array = _tensors(metric, 2)
    return _native.blend_metric(array, _fraction(amount, "amount"))


def suggest_seams(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    max_length: float | None = None,
    scale_limit: float = 2.0,
    qc_limit: float = 1.05,
    weights: Weights = "uniform",
    boundary: Boundary = "length",
    progress: Progress | None = None,
    factorization: Factorization = "auto",
) -> npt.NDArray[np.int32]:
    """Propose seams that lower the distortion of `unwrap` most, beside those that the mesh has.

    Topology comes first: handles are cut open and closed surfaces slit, whatever that takes, because they could not be
    unwrapped otherwise. Then the most distorted places are joined to the seams one after the other, and each cut is
    solved before it is proposed, so that unwrapping with it shows lower distortion. A component gets no more seams once
    `scale_limit` and `qc_limit` are met or nothing helps. Where a plane x, y or z = constant mirrors a component's
    faces onto the mesh's, its seams come in mirrored pairs or lie on the plane if the edges allow that.

    Args:
        vertices: (V, 3) positions, any unit.
        face_offsets: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        seam_edges: (S, 2) seams that stay; the proposed ones complete them.
        selected_faces: (faces,) bool, all faces when left out; only edges between two of them are proposed.
        max_length: limit of the total length of the proposed seams, in the unit of the vertices; none when left out.
            What topology needs counts, but is proposed even beyond the limit.
        scale_limit: a component is good enough when 95 % of its area has a linear scale (root of UV area over 3D area)
            within this factor of the median, and
        qc_limit: when its mean quasi-conformal distortion is not above this.
        weights: of the maps, see `parameterize`.
        boundary: see `parameterize`.
        progress: see `Progress`.
        factorization: see `parameterize`.

    Returns:
        (S, 2) int32 vertex pairs, the smaller vertex first, cut after cut in the order in which they were found: first
        what topology needs, then what lowers the distortion most.

    Raises:
        ValueError: the arrays do not describe a mesh, or an option is out of range.
        Cancelled: `progress` returned False.
    """
    cuts = suggest_cuts(
        vertices,
        face_offsets,
        corner_vertices,
        seam_edges=seam_edges,
        selected_faces=selected_faces,
        max_length=max_length,
        scale_limit=scale_limit,
        qc_limit=qc_limit,
        weights=weights,
        boundary=boundary,
        progress=progress,
        factorization=factorization,
    )
    return np.concatenate([np.zeros((0, 2), np.int32), *cuts])


def suggest_cuts(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    max_length: float | None = None,
    scale_limit: float = 2.0,
    qc_limit: float = 1.05,
    weights: Weights = "uniform",
    boundary: Boundary = "length",
    progress: Progress | None = None,
    factorization: Factorization = "auto",
) -> list[npt.NDArray[np.int32]]:
    """Return the seams of `suggest_seams` cut by cut, each (n, 2): the first few are those that help most.

    A cut and its mirror image are one. Arguments and errors are those of `suggest_seams`.
    """
    polygons = _polygon_mesh(vertices, face_offsets, corner_vertices, seam_edges, selected_faces)
    edges, offsets = _native.suggest_seams(
        *polygons,
        np.inf if max_length is None else _at_least(max_length, 0.0, "max_length"),
        _at_least(scale_limit, 1.0, "scale_limit"),
        _at_least(qc_limit, 1.0, "qc_limit"),
        _patch_options(weights, boundary, factorization, fill_holes=False, area_blend=0.0),
        _progress(progress),
    )
    return np.split(edges, offsets[1:-1]) if len(edges) else []


def build_info() -> dict[str, str]:
    """Return the factorisation library ("factorization") and the BLAS behind it ("blas": file and configuration)."""
    return _native.build_info()


def _patch_options(weights: str, boundary: str, factorization: str, fill_holes: bool, area_blend: float) -> Any:  # noqa: ANN401 - the native class has no stub
    _check_options(weights=weights, boundary=boundary, factorization=factorization)
    fill = _flag(fill_holes, "fill_holes")
    return _native.PatchOptions(weights, boundary, factorization, fill, _fraction(area_blend, "area_blend"))


def _assemble(
    vertices: npt.ArrayLike,
    triangles: npt.ArrayLike,
    metric: npt.ArrayLike | None,
    options: Any,  # noqa: ANN401 - the native class has no stub
) -> tuple[int, Any]:
    vertices = _vertices(vertices)
    triangles = _indices(triangles, "triangles", 3, len(vertices))
    return len(vertices), _native.Solver(vertices, triangles, _metric(metric, len(triangles), (2,)), options)


def _solve(
    solver: Any,  # noqa: ANN401 - the native class has no stub
    n_vertices: int,
    method: str,
    pins: Pins | None,
    soft_pins: float,
    extenders: Extenders | None,
    hole_rigidity: float,
    tolerance: float,
    progress: Progress | None,
) -> Parameterization:
    _check_options(method=method)
    soft = _soft_pins(soft_pins, method)
    solution = solver.solve(
        method,
        _pins(pins, method, soft, n_vertices),
        soft,
        _extenders(extenders, method, n_vertices),
        _hole_rigidity(hole_rigidity, method),
        _tolerance(tolerance),
        _progress(progress),
    )
    return Parameterization(**solution)


def _unwrap_arguments(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    *,
    seam_edges: npt.ArrayLike | None,
    selected_faces: npt.ArrayLike | None,
    method: str,
    weights: str,
    boundary: str,
    pins: Pins | None,
    pinned_corners: npt.ArrayLike | None,
    corner_uv: npt.ArrayLike | None,
    soft_pins: float,
    fill_holes: bool,
    metric: npt.ArrayLike | None,
    area_blend: float,
    factorization: str,
) -> tuple[Any, int]:
    """Check what `unwrap` and `Unwrapper` share; return it for the native module, and the number of vertices."""
    polygons = _polygon_mesh(vertices, face_offsets, corner_vertices, seam_edges, selected_faces)
    vertices, offsets, corners = polygons[:3]
    _check_options(method=method)
    options = _patch_options(weights, boundary, factorization, fill_holes, area_blend)
    pinned, uv = _corner_pins(pinned_corners, corner_uv, len(corners))
    soft = _soft_pins(soft_pins, method)
    all_triangles = bool((np.diff(offsets) == 3).all())
    tensors = _metric(metric, len(offsets) - 1, (2, 3) if all_triangles else (3,))
    pin_list = _pins(pins, method, soft, len(vertices))
    arguments = _native.UnwrapArguments(*polygons, method, pin_list, pinned, uv, soft, tensors, options)
    return arguments, len(vertices)


def _polygon_mesh(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    seam_edges: npt.ArrayLike | None,
    selected_faces: npt.ArrayLike | None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None, np.ndarray | None]:
    vertices = _vertices(vertices)
    offsets = _index_vector(face_offsets, "face_offsets")
    corners = _indices(corner_vertices, "corner_vertices", None, len(vertices))
    if len(offsets) == 0:
        raise ValueError("face_offsets is empty; it needs one entry more than there are faces.")
    if len(offsets) == 1:
        raise InvalidMeshError("The mesh has no faces; there is nothing to unwrap.")
    if offsets[0] != 0 or offsets[-1] != len(corners) or (np.diff(offsets) < 0).any():
        raise ValueError(f"face_offsets must rise from 0 to the number of corners, {len(corners)}, without decreasing.")
    seams = None if seam_edges is None else _indices(seam_edges, "seam_edges", 2, len(vertices))
    selected = None
    if selected_faces is not None:
        selected = np.asarray(selected_faces)
        if selected.dtype != np.bool_ or selected.shape != (len(offsets) - 1,):
            raise ValueError(
                f"selected_faces must be {len(offsets) - 1} booleans, one per face, not {selected.dtype} of shape "
                f"{selected.shape}."
            )
    return vertices, offsets, corners, seams, selected


def _at_least(value: float, least: float, name: str) -> float:
    if not (isinstance(value, numbers.Real) and value >= least):
        raise ValueError(f"{name} must be a number of at least {least:g}, not {value!r}.")
    return float(value)


def _unwrapped(result: dict[str, Any]) -> Unwrap:
    result["charts"] = [Chart(**chart) for chart in result["charts"]]
    return Unwrap(**result)


def _check_options(**options: object) -> None:
    for name, value in options.items():
        if value not in _OPTIONS[name]:
            choices = ", ".join(repr(choice) for choice in _OPTIONS[name])
            raise ValueError(f"{name} must be one of {choices}, not {value!r}.")


def _progress(progress: Progress | None) -> Progress | None:
    if progress is not None and not callable(progress):
        raise ValueError(f"progress must be callable or None, not {type(progress).__name__}.")
    return progress


def _array(values: npt.ArrayLike, name: str) -> np.ndarray:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name} is no regular array: {error}.") from error


def _floats(values: npt.ArrayLike, name: str, columns: int) -> npt.NDArray[np.float64]:
    array = _array(values, name)
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name} must hold real numbers, not {array.dtype}.")
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}.")
    if len(array) > _INDEX_LIMIT:
        raise ValueError(f"{name} has {len(array)} rows; at most {_INDEX_LIMIT} can be handled.")
    return np.ascontiguousarray(array, dtype=np.float64)


def _vertices(vertices: npt.ArrayLike) -> npt.NDArray[np.float64]:
    return _floats(vertices, "vertices", 3)


def _index_vector(values: npt.ArrayLike, name: str) -> npt.NDArray[np.int32]:
    array = _array(values, name)
    if array.size == 0:
        array = array.astype(np.int32)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} must hold integers, not {array.dtype}.")
    if array.ndim != 1:
        raise ValueError(f"{name} must have one dimension, not the shape {array.shape}.")
    if array.size and (array.min() < 0 or array.max() > _INDEX_LIMIT or len(array) > _INDEX_LIMIT):
        raise ValueError(
            f"{name} must lie between 0 and {_INDEX_LIMIT}, but range from {array.min()} to {array.max()}."
        )
    return np.ascontiguousarray(array, dtype=np.int32)


def _indices(values: npt.ArrayLike, name: str, columns: int | None, n_vertices: int) -> npt.NDArray[np.int32]:
    array = _array(values, name)
    if columns is not None:
        if array.size == 0:
            array = np.zeros((0, columns), np.int32)
        if array.ndim != 2 or array.shape[1] != columns:
            raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}.")
    shape = array.shape
    flat = _index_vector(array.ravel() if columns is not None else array, name)
    if flat.size and flat.max() >= n_vertices:
        raise ValueError(f"{name} has the vertex {flat.max()}, but there are {n_vertices} vertices.")
    return flat.reshape(shape) if columns is not None else flat


def _flag(value: object, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} must be True or False, not {value!r}.")
    return bool(value)


def _soft_pins(strength: float, method: str) -> float:
    if not (isinstance(strength, numbers.Real) and 0.0 <= strength <= SOFT_PINS_LIMIT):
        raise ValueError(f"soft_pins must lie between 0 and {SOFT_PINS_LIMIT:g}, not {strength!r}.")
    if strength > 0.0 and method != "spectral":
        raise ValueError(f"soft_pins need the method 'spectral', not '{method}'.")
    return float(strength)


def _hole_rigidity(strength: float, method: str) -> float:
    if not (isinstance(strength, numbers.Real) and 0.0 <= strength <= HOLE_RIGIDITY_LIMIT):
        raise ValueError(f"hole_rigidity must lie between 0 and {HOLE_RIGIDITY_LIMIT:g}, not {strength!r}.")
    if strength > 0.0 and method != "spectral":
        raise ValueError(f"hole_rigidity needs the method 'spectral', not '{method}'.")
    return float(strength)


def _extenders(extenders: Extenders | None, method: str, n_vertices: int) -> list[tuple[int, int, float]]:
    result = []
    for k, extender in enumerate(() if extenders is None else extenders):
        try:
            first, second, strength = extender
            i, j, strength = operator.index(first), operator.index(second), float(strength)
        except (TypeError, ValueError) as error:
            raise ValueError(f"extenders must be (vertex, vertex, strength) triples, but has {extender!r}.") from error
        if not (0 <= i < n_vertices and 0 <= j < n_vertices):
            raise ValueError(f"Extender {k} joins the vertices {i} and {j}, but there are {n_vertices} vertices.")
        if i == j:
            raise ValueError(f"Extender {k} joins vertex {i} with itself; give it two different vertices.")
        if not abs(strength) <= EXTENDER_LIMIT:
            raise ValueError(
                f"The strength of extender {k} must lie between {-EXTENDER_LIMIT:g} and {EXTENDER_LIMIT:g}, "
                f"not {strength!r}."
            )
        result.append((i, j, strength))
    if result and method != "spectral":
        raise ValueError(f"extenders need the method 'spectral', not '{method}'.")
    return result


def _fraction(value: float, name: str) -> float:
    if not (isinstance(value, numbers.Real) and 0.0 <= value <= 1.0):
        raise ValueError(f"{name} must lie between 0 and 1, not {value!r}.")
    return float(value)


def _metric(metric: npt.ArrayLike | None, n_faces: int, sizes: tuple[int, ...]) -> npt.NDArray[np.float64] | None:
    """Check one tensor per face, of one of the sizes; what makes it definite in a face's plane is checked there."""
    if metric is None:
        return None
    array = _array(metric, "metric")
    size = array.shape[-1] if array.ndim == 3 and array.shape[-1] in sizes else sizes[0]
    tensors = _tensors(array, size)
    if len(tensors) != n_faces:
        raise ValueError(f"metric has {len(tensors)} tensors, but there are {n_faces} faces.")
    return tensors


def _tensors(metric: npt.ArrayLike, size: int) -> npt.NDArray[np.float64]:
    array = _array(metric, "metric")
    if array.dtype.kind not in "fiu" or array.ndim != 3 or array.shape[1:] != (size, size):
        raise ValueError(
            f"metric must be real numbers of the shape (n, {size}, {size}), not {array.dtype} {array.shape}."
        )
    tensors = np.ascontiguousarray(array, dtype=np.float64)
    if not np.isfinite(tensors).all():
        raise ValueError("metric has values that are not finite.")
    size_of = np.abs(tensors).max(axis=(1, 2), initial=0.0)
    if (np.abs(tensors - tensors.transpose(0, 2, 1)).max(axis=(1, 2), initial=0.0) > 1e-9 * size_of).any():
        raise ValueError("metric must be symmetric.")
    if size == 2:
        bad = _native.first_not_positive_definite(tensors)
        if bad >= 0:
            raise ValueError(f"The metric of triangle {bad} is not positive definite: {tensors[bad].tolist()}.")
    return tensors


def _broadcast(values: npt.ArrayLike, name: str, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    array = _array(values, name)
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name} must hold real numbers, not {array.dtype}.")
    try:
        return np.ascontiguousarray(np.broadcast_to(array, shape), dtype=np.float64)
    except ValueError as error:
        raise ValueError(f"{name} must have the shape {shape}, not {array.shape}.") from error


def _corner_pins(
    pinned_corners: npt.ArrayLike | None, corner_uv: npt.ArrayLike | None, n_corners: int
) -> tuple[npt.NDArray[np.bool_] | None, npt.NDArray[np.float64] | None]:
    if pinned_corners is None:
        return None, None
    pinned = np.asarray(pinned_corners)
    if pinned.dtype != np.bool_ or pinned.shape != (n_corners,):
        raise ValueError(
            f"pinned_corners must be {n_corners} booleans, one per corner, not {pinned.dtype} of shape {pinned.shape}."
        )
    if not pinned.any():
        return None, None
    if corner_uv is None:
        raise ValueError("pinned_corners need corner_uv, the positions of the pins.")
    uv = _floats(corner_uv, "corner_uv", 2)
    if len(uv) != n_corners:
        raise ValueError(f"corner_uv has {len(uv)} rows, but there are {n_corners} corners.")
    return np.ascontiguousarray(pinned), uv


def _pins(pins: Pins | None, method: str, soft_pins: float, n_vertices: int) -> list[tuple[int, float, float]]:
    if pins is None:
        return []
    if not isinstance(pins, Mapping):
        raise ValueError(f"pins must map vertices to (u, v), not be a {type(pins).__name__}.")
    if pins and method != "lscm" and not soft_pins:
        raise ValueError(f"pins need the method 'lscm', or soft_pins with 'spectral'; '{method}' solves without any.")
    result = []
    for vertex, position in pins.items():
        try:
            index = operator.index(vertex)
            u, v = (float(x) for x in position)
        except (TypeError, ValueError) as error:
            raise ValueError(f"pins must map vertex indices to (u, v), but has {vertex!r}: {position!r}.") from error
        if not 0 <= index < n_vertices:
            raise ValueError(f"Vertex {index} is pinned, but there are {n_vertices} vertices.")
        if not (np.isfinite(u) and np.isfinite(v)):
            raise ValueError(f"The pin of vertex {index} is not finite: ({u}, {v}).")
        result.append((index, u, v))
    return result


def _tolerance(tolerance: float) -> float:
    if not (isinstance(tolerance, numbers.Real) and 1e-14 <= tolerance <= 1e-3):
        raise ValueError(f"tolerance must lie between 1e-14 and 1e-3, not {tolerance!r}.")
    return float(tolerance)
