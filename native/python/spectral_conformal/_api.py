"""The public functions: they check and convert their arguments, call the native module and wrap what it returns."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import DEFAULT_TOLERANCE
from ._types import (
    Boundary,
    Chart,
    Distortion,
    Extenders,
    Factorization,
    MapDefects,
    Method,
    Parameterization,
    Pins,
    Progress,
    Unwrap,
    Weights,
)


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
        fold_free: bool = False,
        factorization: Factorization = "auto",
        progress: Progress | None = None,
    ) -> None:
        """Assemble and factor the conformal energy of one patch.

        Arguments and errors are those of `parameterize`.
        """
        options = _arguments.checked_patch_options(
            weights, boundary, factorization, fill_holes=fill_holes, area_blend=area_blend, fold_free=fold_free
        )
        self._n_vertices, self._native = _assemble(vertices, triangles, metric, options)
        self._native.factorize(_arguments.checked_progress(progress))

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
    fold_free: bool = False,
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
        fold_free: end without a flipped triangle and with a turning number of 1 or -1, at some cost in distortion.
            Folded triangles are unfolded where they are; where that leaves some, or the map winds round more than once
            or there is none, an embedding that is one-to-one by theorem is relaxed without folding it. `message` says
            what was done and what it cost, and where several pins leave no room. Triangles without area in 3D have no
            fold; of a quad's two splits the first is kept unfolded.
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
    options = _arguments.checked_patch_options(
        weights, boundary, factorization, fill_holes=fill_holes, area_blend=area_blend, fold_free=fold_free
    )
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
    vertices = _arguments.checked_vertices(vertices)
    triangles = _arguments.checked_indices(triangles, "triangles", 3, len(vertices))
    if not np.isfinite(vertices[triangles]).all():
        raise ValueError("vertices has values that are not finite; every vertex that a triangle uses needs a position.")
    uv = _arguments.checked_floats(uv, "uv", 2)
    if len(uv) != len(vertices):
        raise ValueError(f"uv has {len(uv)} rows, but there are {len(vertices)} vertices.")
    if not np.isfinite(uv).all():
        raise ValueError("uv has values that are not finite.")
    return Distortion(**_native.distortion(vertices, triangles, uv))


def map_defects(
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    corner_uv: npt.ArrayLike,
    *,
    selected_faces: npt.ArrayLike | None = None,
    between_islands: bool = False,
) -> MapDefects:
    """Find flipped and overlapping faces in the UV map of a polygon mesh.

    Islands are the parts of the selected faces that are connected over edges of exactly two faces whose corners' UVs
    are equal. An island that is mirrored as a whole has no flipped faces, nor has one whose faces are wound
    inconsistently. Polygons are triangulated in the map: a concave one is not flipped, one that crosses itself is, and
    one of five corners or more that touches itself may be. UVs are taken to be single precision: contacts and folds
    less deep than 2.5e-7 of the coordinates do not count, so that collapsed faces are neither flipped nor overlapping.
    Of several faces on the same vertices with the same UVs the first is looked at only; faces with fewer than three
    different corners are not looked at.

    Args:
        face_offsets: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        corner_uv: (C, 2) the map, finite at the corners of selected faces.
        selected_faces: (faces,) bool, all faces when left out; others are not looked at.
        between_islands: whether faces that cover a face of another island overlap too.

    Raises:
        ValueError: the arrays do not describe a mesh, or a UV is not finite; the message names its corner.
    """
    corners = _arguments.checked_index_vector(corner_vertices, "corner_vertices")
    offsets = _arguments.checked_face_offsets(face_offsets, len(corners))
    selected = _arguments.checked_face_selection(selected_faces, len(offsets) - 1)
    uv = _arguments.checked_corner_uv(corner_uv, len(corners))
    between = _arguments.checked_flag(between_islands, "between_islands")
    return MapDefects(**_native.map_defects(offsets, corners, uv, selected, between))


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
    fold_free: bool = False,
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
        fold_free: see `parameterize`.
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
        fold_free=fold_free,
        factorization=factorization,
    )
    return _unwrapped(
        _native.unwrap(
            arguments,
            _arguments.checked_extenders(extenders, method, n_vertices),
            _arguments.checked_hole_rigidity(hole_rigidity, method),
            _arguments.checked_tolerance(tolerance),
            _arguments.checked_progress(progress),
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
        fold_free: bool = False,
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
            fold_free=fold_free,
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
                _arguments.checked_extenders(extenders, self._method, self._n_vertices),
                _arguments.checked_hole_rigidity(hole_rigidity, self._method),
                _arguments.checked_tolerance(tolerance),
                _arguments.checked_progress(progress),
            )
        )


def build_info() -> dict[str, str]:
    """Return the factorisation library ("factorization") and the BLAS behind it ("blas": file and configuration)."""
    return _native.build_info()


def _assemble(
    vertices: npt.ArrayLike,
    triangles: npt.ArrayLike,
    metric: npt.ArrayLike | None,
    options: Any,  # noqa: ANN401 - the native class has no stub
) -> tuple[int, Any]:
    vertices = _arguments.checked_vertices(vertices)
    triangles = _arguments.checked_indices(triangles, "triangles", 3, len(vertices))
    return len(vertices), _native.Solver(
        vertices, triangles, _arguments.checked_metric(metric, len(triangles), (2,)), options
    )


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
    _arguments.check_options(method=method)
    soft = _arguments.checked_soft_pins(soft_pins, method)
    solution = solver.solve(
        method,
        _arguments.checked_pins(pins, method, soft, n_vertices),
        soft,
        _arguments.checked_extenders(extenders, method, n_vertices),
        _arguments.checked_hole_rigidity(hole_rigidity, method),
        _arguments.checked_tolerance(tolerance),
        _arguments.checked_progress(progress),
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
    fold_free: bool,
    factorization: str,
) -> tuple[Any, int]:
    """Check what `unwrap` and `Unwrapper` share; return it for the native module, and the number of vertices."""
    polygons = _arguments.checked_polygon_mesh(vertices, face_offsets, corner_vertices, seam_edges, selected_faces)
    vertices, offsets, corners = polygons[:3]
    _arguments.check_options(method=method)
    options = _arguments.checked_patch_options(
        weights, boundary, factorization, fill_holes=fill_holes, area_blend=area_blend, fold_free=fold_free
    )
    pinned, uv = _arguments.checked_corner_pins(pinned_corners, corner_uv, len(corners))
    soft = _arguments.checked_soft_pins(soft_pins, method)
    all_triangles = bool((np.diff(offsets) == 3).all())
    tensors = _arguments.checked_metric(metric, len(offsets) - 1, (2, 3) if all_triangles else (3,))
    pin_list = _arguments.checked_pins(pins, method, soft, len(vertices))
    arguments = _native.UnwrapArguments(*polygons, method, pin_list, pinned, uv, soft, tensors, options)
    return arguments, len(vertices)


def _unwrapped(result: dict[str, Any]) -> Unwrap:
    result["charts"] = [Chart(**chart) for chart in result["charts"]]
    return Unwrap(**result)
