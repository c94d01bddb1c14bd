"""Map a polygon mesh to the plane, chart by chart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Extenders, Faces, Pins, Progress
from ._constraints import Constraints, equations
from ._kept_maps import KeptMaps, native_of
from ._options import SHARED, OptionChanges, Options, ResolveChanges, SeamOptions, changed, with_fallbacks
from ._results import Charts, Unwrap
from ._seams import suggest_seams
from ._straightening import AUTOMATIC, AUTOMATIC_SHARE, straightened

if TYPE_CHECKING:
    from typing_extensions import Unpack

_SUGGESTED = "suggested"
_DEFAULTS = Options(fallbacks=True)


def unwrap(
    vertices: npt.ArrayLike,
    faces: Faces,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    options: Options | None = None,
    seam_edges: npt.ArrayLike | Literal["suggested"] | None = None,
    selected_faces: npt.ArrayLike | None = None,
    pins: Pins | None = None,
    fixed: npt.ArrayLike | None = None,
    uv: npt.ArrayLike | None = None,
    pinned_corners: npt.ArrayLike | None = None,
    corner_uv: npt.ArrayLike | None = None,
    extenders: Extenders | None = None,
    constraints: Constraints | None = None,
    straighten: Literal["auto"] | float = 0.0,
    metric: npt.ArrayLike | None = None,
    progress: Progress | None = None,
    kept_maps: KeptMaps | None = None,
    **changes: Unpack[OptionChanges],
) -> Unwrap:
    """Cut a polygon mesh into charts and map each to the plane. A chart that fails does not stop the others.

    Cuts run along seams, the border of the selection and edges with three or more faces, and through bow-tie vertices.
    Each chart is solved as by `parameterize`.

    Args:
        vertices: (V, 3) positions, any unit.
        faces: (F, n) vertices of each face; a list of polygons, each a list of vertices; or, with `corner_vertices`,
            (F + 1,) offsets as in Blender: face f has the corners from faces[f] up to faces[f + 1]. F is the number of
            faces, C the number of their corners, face after face.
        corner_vertices: (C,) vertex of each corner, if `faces` are offsets.
        options: how the maps are made; single fields may be given as keywords, which take precedence.
        seam_edges: (S, 2) vertex pairs in any order; pairs that are not edges have no effect. "suggested" uses the
            seams that `suggest_seams` proposes with its defaults.
        selected_faces: (faces,) bool; by default all faces.
        pins: mesh vertex -> (u, v), for all copies of the vertex, as in `parameterize`; pins outside the selection have
            no effect.
        fixed: further pins: (V,) bool or vertex indices, as in `parameterize`. For vertices on a seam, whose copies
            have different UVs, use `pinned_corners`.
        uv: (V, 2) the positions of the `fixed` vertices; the others are not read.
        pinned_corners: (C,) bool, corners whose `corner_uv` is a pin, any number. A mesh vertex with different pins is
            split, and each of its corners takes the nearest. The pin of a chart's vertex is the mean over its pinned
            corners, and overrides `pins`.
        corner_uv: (C, 2) the current map, finite where pinned; needed with `pinned_corners`.
        extenders: as in `parameterize`, between mesh vertices. An extender acts in every chart that has copies of both
            vertices; if a seam gives a vertex several copies in one chart, it acts on their barycenter. An extender has
            no effect if no chart has both vertices, or if hard pins hold both; `Unwrap.unused_extenders` says which.
            Hole rigidity has no effect in charts that hard pins hold.
        constraints: as in `parameterize`, by corner instead of by vertex. A constraint holds in the chart of its
            corners; across charts it has no effect. A chart with constraints that contradict each other fails.
        straighten: share by which the mean distortion of a chart may rise so that borders that are nearly straight and
            nearly along its axes become exactly so, and nearly rectangular charts rectangles. The distortion is both
            `mean_qc` and the symmetric Dirichlet energy, which sees sizes, too. "auto" is 0.02; 0 leaves the maps as
            they are. Charts with pins stay as they are, and so do all if there are `constraints`.
        metric: (faces, 3, 3) symmetric tensor in 3D for each face, positive definite in the face's plane: a tangent
            vector t gets the squared length t G t, and the map is conformal for these lengths. For triangle meshes also
            (faces, 2, 2), as in `parameterize`.
        progress: as in `parameterize`.
        kept_maps: supplies the maps of charts that earlier calls solved, and keeps those of this call.

    Returns:
        The UVs by corner, and a record of each chart. `packed` lays the charts out in the unit square; `split_vertices`
        gives vertices on seams one copy per UV, as igl and xatlas need.

    Raises:
        ValueError: the arrays do not describe a mesh, or an option is out of range.
        TypeError: an argument has the wrong type, or a keyword is not an option; the message names the closest one.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory for the mesh, or for any of its charts. If it suffices for some charts,
            only the others fail.
    """
    used = with_fallbacks(changed(options, _DEFAULTS, changes, OptionChanges, unwrap), True)
    if isinstance(seam_edges, str):
        if seam_edges != _SUGGESTED:
            raise ValueError(f"seam_edges must be vertex pairs or {_SUGGESTED!r}, not {seam_edges!r}.")
        seam_edges = suggest_seams(
            vertices,
            faces,
            corner_vertices,
            options=SeamOptions(**{name: getattr(used, name) for name in SHARED}),
            selected_faces=selected_faces,
            progress=_part(progress, 0.0, 0.5),
        )
        progress = _part(progress, 0.5, 1.0)
    share = _checked_share(straighten) if constraints is None else 0.0
    if share > 0.0 and kept_maps is None:
        # Charts whose constraints stay the same are solved once.
        kept_maps = KeptMaps()
    if share > 0.0 and extenders is not None:
        extenders = list(extenders)

    def solve(constraints: Constraints | None, begin: float, end: float) -> Unwrap:
        arguments, mesh = _checked_mesh(
            used,
            vertices,
            faces,
            corner_vertices,
            seam_edges,
            selected_faces,
            pins,
            fixed,
            uv,
            pinned_corners,
            corner_uv,
            metric,
            constraints,
        )
        result = _native.unwrap(
            arguments,
            _arguments.checked_extenders(extenders, used.method, len(mesh[0])),
            _arguments.checked_progress(_part(progress, begin, end)),
            native_of(kept_maps),
        )
        return _result(result, mesh)

    return straightened(vertices, solve, share) if share > 0.0 else solve(constraints, 0.0, 1.0)


def _checked_share(straighten: Literal["auto"] | float) -> float:
    """Return the share of the distortion that straight borders may cost."""
    if isinstance(straighten, str):
        if straighten != AUTOMATIC:
            raise ValueError(f"straighten must be a share or {AUTOMATIC!r}, not {straighten!r}.")
        return AUTOMATIC_SHARE
    return _arguments.checked_at_least(straighten, 0.0, "straighten")


def _part(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """Return a progress function for the part of the work from `begin` to `end`."""
    if progress is None or (begin, end) == (0.0, 1.0):
        return progress
    _arguments.checked_progress(progress)
    return lambda fraction, phase: progress(begin + (end - begin) * fraction, phase)


class Unwrapper:
    """`unwrap` for several solves of one mesh that differ in extenders, hole rigidity, tolerance or pin positions.

    It keeps the charts and their factors. Earlier solves affect the result no more than in a `Solver`, and the same
    rules for threads apply.
    """

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: Faces,
        corner_vertices: npt.ArrayLike | None = None,
        *,
        options: Options | None = None,
        seam_edges: npt.ArrayLike | None = None,
        selected_faces: npt.ArrayLike | None = None,
        pins: Pins | None = None,
        fixed: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        pinned_corners: npt.ArrayLike | None = None,
        corner_uv: npt.ArrayLike | None = None,
        constraints: Constraints | None = None,
        metric: npt.ArrayLike | None = None,
        **changes: Unpack[OptionChanges],
    ) -> None:
        """Cut the mesh into charts.

        Arguments and errors are those of `unwrap`. `solve` may override some options.
        """
        self._options = with_fallbacks(changed(options, _DEFAULTS, changes, OptionChanges, Unwrapper.__init__), True)
        arguments, self._mesh = _checked_mesh(
            self._options,
            vertices,
            faces,
            corner_vertices,
            seam_edges,
            selected_faces,
            pins,
            fixed,
            uv,
            pinned_corners,
            corner_uv,
            metric,
            constraints,
        )
        self._has_pinned_corners = pinned_corners is not None
        self._native = _native.Unwrapper(arguments)

    def solve(
        self,
        *,
        extenders: Extenders | None = None,
        corner_uv: npt.ArrayLike | None = None,
        measure: bool = True,
        progress: Progress | None = None,
        **changes: Unpack[ResolveChanges],
    ) -> Unwrap:
        """Solve all charts, with the options of the unwrapper and the changes given here. See `unwrap`.

        Args:
            extenders: see `unwrap`.
            corner_uv: (C, 2) the present positions of the unwrapper's `pinned_corners`; by default the given ones.
                Corners of a vertex that share a pin must keep sharing it. The factor is kept, so such a solve takes a
                fraction of the first one.
            measure: whether to measure the maps, which may take longer than a solve with moved pins. Otherwise
                `mean_qc`, `max_qc` and `image_area` of solved charts are NaN, `flipped` and `overlapping` -1.
            progress: see `unwrap`.
            **changes: options.

        Raises:
            ValueError: there are no `pinned_corners`; or as `unwrap`.
            TypeError: as `unwrap`.
        """
        if corner_uv is not None:
            if not self._has_pinned_corners:
                raise ValueError("corner_uv moves pinned_corners, but this Unwrapper has none.")
            corner_uv = _arguments.checked_corner_uv(corner_uv, len(self._mesh[2]))
        options = changed(self._options, self._options, changes, ResolveChanges, Unwrapper.solve)
        return _result(
            self._native.solve(
                options,
                _arguments.checked_extenders(extenders, options.method, len(self._mesh[0])),
                corner_uv,
                _arguments.checked_flag(measure, "measure"),
                _arguments.checked_progress(progress),
            ),
            self._mesh,
        )


def _checked_mesh(
    options: Options,
    vertices: npt.ArrayLike,
    faces: Faces,
    corner_vertices: npt.ArrayLike | None,
    seam_edges: npt.ArrayLike | None,
    selected_faces: npt.ArrayLike | None,
    pins: Pins | None,
    fixed: npt.ArrayLike | None,
    fixed_uv: npt.ArrayLike | None,
    pinned_corners: npt.ArrayLike | None,
    corner_uv: npt.ArrayLike | None,
    metric: npt.ArrayLike | None,
    constraints: Constraints | None,
) -> tuple[Any, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Check the arguments of `unwrap` and `Unwrapper`; return them for the native module, and the mesh."""
    polygons = _arguments.checked_polygon_mesh(vertices, faces, corner_vertices, seam_edges, selected_faces)
    vertices, offsets, corners = polygons[:3]
    pinned, uv = _arguments.checked_corner_pins(pinned_corners, corner_uv, len(corners))
    all_triangles = metric is not None and bool((np.diff(offsets) == 3).all())
    tensors = _arguments.checked_metric(metric, len(offsets) - 1, (2, 3) if all_triangles else (3,))
    pin_list = _arguments.checked_held(pins, fixed, fixed_uv, len(vertices), corners)
    equated = equations(constraints, len(corners), "corners")
    return _native.UnwrapArguments(*polygons, pin_list, pinned, uv, tensors, equated, options), polygons[:3]


def _result(result: dict[str, Any], mesh: tuple[np.ndarray, np.ndarray, np.ndarray]) -> Unwrap:
    _, offsets, corners = mesh
    return Unwrap(**{**result, "charts": Charts(*result["charts"])}, face_offsets=offsets, corner_vertices=corners)
