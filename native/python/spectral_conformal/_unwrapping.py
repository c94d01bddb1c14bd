"""Map a polygon mesh to the plane, chart by chart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Extenders, Faces, Pins, Progress
from ._constraints import Constraints, Numbers, equations
from ._kept_maps import KeptMaps, native_of
from ._mesh import Mesh, Polygons, checked_polygons, corner_of_vertices, double_map_of, given_mesh
from ._options import OptionChanges, Options, ResolveChanges, changed, with_fallbacks
from ._results import Charts, Unwrap
from ._straightening import AUTOMATIC, AUTOMATIC_SHARE, straightened

if TYPE_CHECKING:
    from typing_extensions import Unpack

_DEFAULTS = Options(fallbacks=True)


def unwrap(
    mesh: Mesh | npt.ArrayLike,
    faces: Faces | None = None,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    options: Options | None = None,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    pins: Pins | None = None,
    fixed: npt.ArrayLike | None = None,
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
        mesh: a `Mesh`; or vertices, followed by `faces` and maybe `corner_vertices`, as `Mesh` takes them.
        faces: see `mesh`.
        corner_vertices: see `mesh`.
        options: how the maps are made; single fields may be given as keywords, which take precedence.
        seam_edges: (S, 2) further cuts beside the seams of the mesh.
        selected_faces: (faces,) bool; by default all faces.
        pins: mesh vertex -> (u, v), for all copies of the vertex, as in `parameterize`; pins outside the selection have
            no effect.
        fixed: (C,) or (F, n) bool, corners that keep the UVs of the mesh as pins do, any number. A vertex whose fixed
            corners have different UVs is split, and each of its corners takes the nearest. The pin of a chart's vertex
            is the mean over its fixed corners, and overrides `pins`.
        extenders: as in `parameterize`, between mesh vertices. An extender acts in every chart that has copies of both
            vertices; if a seam gives a vertex several copies in one chart, it acts on their barycenter. An extender has
            no effect if no chart has both vertices, or if hard pins hold both; `Unwrap.unused_extenders` says which.
            Hole rigidity has no effect in charts that hard pins hold.
        constraints: as in `parameterize`, by vertex or by corner. A constraint holds in the chart of its corners;
            across charts it has no effect. A chart with constraints that contradict each other fails.
        straighten: share by which the mean distortion of a chart may rise so that borders that are nearly straight and
            nearly along its axes become exactly so, and nearly rectangular charts rectangles; in proportion if that is
            a part of the border. The distortion is both `mean_qc` and the symmetric Dirichlet energy, which sees sizes,
            too. "auto" is 0.02; 0 leaves the maps as they are. Charts with pins stay as they are, and so do all with
            `constraints`.
        metric: (faces, 3, 3) symmetric tensor in 3D for each face, positive definite in the face's plane: a tangent
            vector t gets the squared length t G t, and the map is conformal for these lengths. For triangle meshes also
            (faces, 2, 2), as in `parameterize`.
        progress: as in `parameterize`.
        kept_maps: supplies the maps of charts that earlier calls solved, and keeps those of this call.

    Returns:
        The mesh with its map, and a record of each chart. `pack` lays the charts out in the unit square.

    Raises:
        ValueError: the arrays do not describe a mesh, or an option is out of range.
        TypeError: an argument has the wrong type, or a keyword is not an option; the message names the closest one.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory for the mesh, or for any of its charts. If it suffices for some charts,
            only the others fail.
    """
    used = with_fallbacks(changed(options, _DEFAULTS, changes, OptionChanges, unwrap), True)
    given = given_mesh(mesh, faces, corner_vertices)
    share = _checked_share(straighten)
    task = _Task.of(given, used, seam_edges, selected_faces, pins, fixed, metric)
    pairs = _arguments.checked_extenders(extenders, used.method, len(given.vertices))
    if constraints is not None:
        share = 0.0
    if share > 0.0 and kept_maps is None:
        # Charts whose constraints stay the same are solved once.
        kept_maps = KeptMaps()

    def solve(constraints: Constraints | None, begin: float, end: float) -> Unwrap:
        listen = _arguments.checked_progress(_part(progress, begin, end))
        return task.result(_native.unwrap(task.arguments(constraints), pairs, listen, native_of(kept_maps)))

    return straightened(solve, share) if share > 0.0 else solve(constraints, 0.0, 1.0)


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
        mesh: Mesh | npt.ArrayLike,
        faces: Faces | None = None,
        corner_vertices: npt.ArrayLike | None = None,
        *,
        options: Options | None = None,
        seam_edges: npt.ArrayLike | None = None,
        selected_faces: npt.ArrayLike | None = None,
        pins: Pins | None = None,
        fixed: npt.ArrayLike | None = None,
        constraints: Constraints | None = None,
        metric: npt.ArrayLike | None = None,
        **changes: Unpack[OptionChanges],
    ) -> None:
        """Cut the mesh into charts.

        Arguments and errors are those of `unwrap`. `solve` may override some options.
        """
        self._options = with_fallbacks(changed(options, _DEFAULTS, changes, OptionChanges, Unwrapper.__init__), True)
        given = given_mesh(mesh, faces, corner_vertices)
        self._task = _Task.of(given, self._options, seam_edges, selected_faces, pins, fixed, metric)
        self._native = _native.Unwrapper(self._task.arguments(constraints))

    def solve(
        self,
        *,
        extenders: Extenders | None = None,
        uv: npt.ArrayLike | None = None,
        measure: bool = True,
        progress: Progress | None = None,
        **changes: Unpack[ResolveChanges],
    ) -> Unwrap:
        """Solve all charts, with the options of the unwrapper and the changes given here. See `unwrap`.

        Args:
            extenders: see `unwrap`.
            uv: (C, 2) or (F, n, 2), the present positions of the unwrapper's `fixed` corners; by default those of its
                mesh. Corners of a vertex that share a pin must keep sharing it. The factor is kept, so such a solve
                takes a fraction of the first one.
            measure: whether to measure the maps, which may take longer than a solve with moved pins. Otherwise
                `mean_qc`, `max_qc` and `image_area` of solved charts are NaN, `flipped` and `overlapping` -1.
            progress: see `unwrap`.
            **changes: options.

        Raises:
            ValueError: no corners are `fixed`; or as `unwrap`.
            TypeError: as `unwrap`.
        """
        moved = None
        if uv is not None:
            if self._task.fixed is None:
                raise ValueError("uv moves fixed corners, but this Unwrapper has none.")
            moved = _arguments.checked_corner_uv(uv, self._task.mesh.face_offsets).astype(np.float64, copy=False)
        options = changed(self._options, self._options, changes, ResolveChanges, Unwrapper.solve)
        return self._task.result(
            self._native.solve(
                options,
                _arguments.checked_extenders(extenders, options.method, len(self._task.mesh.vertices)),
                moved,
                _arguments.checked_flag(measure, "measure"),
                _arguments.checked_progress(progress),
            )
        )


@dataclass(frozen=True)
class _Task:
    """A mesh to unwrap and what holds in all of its maps, checked once."""

    mesh: Mesh
    polygons: Polygons
    pins: list[tuple[int, float, float]]
    fixed: npt.NDArray[np.bool_] | None
    uv: npt.NDArray[np.float64] | None
    metric: npt.NDArray[np.float64] | None
    options: Options

    @classmethod
    def of(
        cls,
        mesh: Mesh,
        options: Options,
        seam_edges: npt.ArrayLike | None,
        selected_faces: npt.ArrayLike | None,
        pins: Pins | None,
        fixed: npt.ArrayLike | None,
        metric: npt.ArrayLike | None,
    ) -> _Task:
        polygons = checked_polygons(mesh, seam_edges, selected_faces)
        offsets = mesh.face_offsets
        flags = uv = None
        if fixed is not None:
            flags = _arguments.checked_corner_flags(fixed, "fixed", offsets)
            if mesh.uv is None:
                raise ValueError("fixed needs a mesh with uv, the positions at which the corners are held.")
            uv = double_map_of(mesh)
        tensors = None
        if metric is not None:
            all_triangles = bool((np.diff(offsets) == 3).all())
            tensors = _arguments.checked_metric(metric, len(offsets) - 1, (2, 3) if all_triangles else (3,))
        return cls(mesh, polygons, _arguments.checked_pins(pins, len(mesh.vertices)), flags, uv, tensors, options)

    def arguments(self, constraints: Constraints | None) -> _native.UnwrapArguments:
        """Return the arguments of the native module."""
        vertices = Numbers(len(self.mesh.vertices), lambda used: corner_of_vertices(used, self.polygons))
        equated = equations(constraints, vertices, Numbers(len(self.mesh.corner_vertices)))
        held = self.fixed is not None and self.fixed.any()
        pinned = (self.fixed, self.uv) if held else (None, None)
        return _native.UnwrapArguments(*self.polygons, self.pins, *pinned, self.metric, equated, self.options)

    def result(self, found: dict[str, Any]) -> Unwrap:
        """Return the mesh with the map that the native module found."""
        mesh = self.mesh
        return Unwrap(
            **{**found, "charts": Charts(*found["charts"])},
            vertices=mesh.vertices,
            face_offsets=mesh.face_offsets,
            corner_vertices=mesh.corner_vertices,
            seam_edges=self.polygons[3],
        )
