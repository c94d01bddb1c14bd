"""Map one disk-like patch of triangles to the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Extenders, Faces, Pins, Progress
from ._constraints import Constraints, Numbers, equations
from ._messages import steps_of
from ._options import OptionChanges, Options, SolveChanges, changed, with_fallbacks
from ._results import Parameterization

if TYPE_CHECKING:
    from typing_extensions import Unpack


def parameterize(
    vertices: npt.ArrayLike,
    faces: Faces,
    *,
    options: Options | None = None,
    pins: Pins | None = None,
    fixed: npt.ArrayLike | None = None,
    uv: npt.ArrayLike | None = None,
    extenders: Extenders | None = None,
    constraints: Constraints | None = None,
    metric: npt.ArrayLike | None = None,
    progress: Progress | None = None,
    **changes: Unpack[OptionChanges],
) -> Parameterization:
    """Map one disk-like patch (holes allowed) conformally to the plane.

    Args:
        vertices: (V, 3) positions, any unit. Vertices that no face uses are allowed.
        faces: (F, n) vertex indices, or a list of polygons, which are split into triangles. Triangles wound against the
            majority are reoriented.
        options: how the map is made; single fields may be given as keywords, which take precedence.
        pins: vertex -> (u, v), met exactly. One pin moves the map; two apply a similarity, which bends nothing. Three
            or more bend the map: of all maps through the pins it has the least conformal energy (pinned LSCM: Levy et
            al., Least Squares Conformal Maps, 2002), `method` is "lscm", and the map is not placed. With `polish` and
            `fold_free` the pins stay. With `soft_pins` they attract the spectral map instead. "lscm" meets two pins
            exactly as well, and without pins holds the two farthest boundary vertices.
        fixed: further pins, any number and set of vertices: (V,) bool, or an array of their indices. Each keeps its
            `uv` to the last bit; `pins` take precedence. Vertices that no triangle uses have no effect.
        uv: (V, 2) the positions of the `fixed` vertices; the others are not read.
        extenders: for "spectral", (vertex, vertex, strength) triples: soft constraints of section 4.2 that push two
            vertices apart or, with a negative strength, pull them together. The strength, at most 1e4 in size, is a
            fraction of the boundary's total mass. Three or more hard pins (with constraints: two), or held coordinates,
            hold the map, which then minimizes z^H L z. There s = strength / half, where `half` is an optional fourth
            number of the tuple, 1 by default. A pair has the difference d z = z_i - z_j and the compliance
            g = d L^-1 d^T, with L^-1 on what is free. Pulls add |s| / g |d z|^2 to z^H L z; pushes then add the force
            s / g d^T (d z) to L z = 0. A single push thus multiplies the distance by 1 + s, and a single pull divides
            it by 1 + |s|. If `half` is the strength with half of the full effect in a free map, the same strengths suit
            both kinds of map. A held map with extenders is not polished.
        constraints: chains that become straight, and mirrored pairs of vertices, for "spectral". The map meets them
            exactly and has the least quotient of Eq. 5 of all that do, also with extenders, soft pins and hole rigidity
            in B; it is not turned. A single pin moves it, more pins hold it, and soft pins attract it. `polish` keeps
            constraints, `fold_free` does not move their vertices, and there is no fallback. See `Constraints`.
        metric: of triangles alone, (F, 2, 2) symmetric positive definite tensor of each (section 4.3), in its plane:
            the first axis points from its first to its second corner; the second axis is a quarter turn
            counterclockwise from it, seen from the side where the corners run counterclockwise. A tangent vector t gets
            the squared length t G t, and the map is conformal for these lengths, hence quasi-conformal. The scale of a
            tensor has no effect. See `metric_from_uv`, `metric_from_direction` and `blend_metric`.
        progress: called with the fraction done (0 to 1) and the name of the phase, in the calling thread, and several
            times a second even if neither changes. Returning False cancels: `Cancelled` is raised. Its own exceptions
            pass through.

    Returns:
        The map. Without pins it is positively oriented, has the mean of its vertices at the origin and the area that
        the patch has in 3D.

    Raises:
        InvalidMeshError: (a ValueError) the mesh is not one disk-like patch, or its pins cannot be met; the message
            names the violated condition and what to do.
        ValueError: an array has the wrong shape, or a value is out of range.
        TypeError: an argument has the wrong type, or a keyword is not an option; the message names the closest one.
        SolveError: no attempt passed the numerical checks, or the map winds around more than once. Weaken extenders and
            hole rigidity, if there are any.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory.
    """
    used = with_fallbacks(changed(options, Options(), changes, OptionChanges, parameterize), False)
    solver = Solver._of(vertices, faces, metric, used, progress)
    return solver._solved(solver._options, pins, fixed, uv, extenders, constraints, progress)


class Solver:
    """One patch, factorized once and solved any number of times.

    Each solver has its own work space. Different solvers may run in different threads at once, with the same results as
    alone. Threads that share a solver take turns: each waits, without the GIL, for the previous solve to end. A
    progress function must not call the solver that called it.
    """

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: Faces,
        *,
        options: Options | None = None,
        metric: npt.ArrayLike | None = None,
        progress: Progress | None = None,
        **changes: Unpack[OptionChanges],
    ) -> None:
        """Assemble and factorize the conformal energy of one patch.

        Arguments and errors are those of `parameterize`. `solve` may override some options.
        """
        used = with_fallbacks(changed(options, Options(), changes, OptionChanges, Solver.__init__), False)
        self._assemble(vertices, faces, metric, used, progress)
        self._native.factorize(_arguments.checked_progress(progress))

    def solve(
        self,
        *,
        pins: Pins | None = None,
        fixed: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        extenders: Extenders | None = None,
        constraints: Constraints | None = None,
        progress: Progress | None = None,
        **changes: Unpack[SolveChanges],
    ) -> Parameterization:
        """Solve with the kept factor ("fiedler" replaces it). See `parameterize`.

        Three or more pins, fixed vertices included, and "lscm" have a factor of their own, kept until other vertices
        are pinned: while the same ones move, each solve is one substitution.

        The options are those of the solver, with the changes given here. The map is that of a fresh solver, to the last
        bit, whatever was solved before. The exception is for drafts: extenders and hole rigidity change the form B
        only, so with a tolerance above 1e-7 a solve with them starts from the earlier maps. A small change of strength
        then costs a few solves, and the map agrees with a fresh one to the tolerance.
        """
        used = with_fallbacks(changed(self._options, self._options, changes, SolveChanges, Solver.solve), False)
        return self._solved(used, pins, fixed, uv, extenders, constraints, progress)

    @classmethod
    def _of(
        cls,
        vertices: npt.ArrayLike,
        faces: Faces,
        metric: npt.ArrayLike | None,
        options: Options,
        progress: Progress | None,
    ) -> Solver:
        """Return a solver without its factor: the first solve computes that, within its own progress."""
        solver = cls.__new__(cls)
        solver._assemble(vertices, faces, metric, options, progress)
        return solver

    def _assemble(
        self,
        vertices: npt.ArrayLike,
        faces: Faces,
        metric: npt.ArrayLike | None,
        options: Options,
        progress: Progress | None,
    ) -> None:
        vertices = _arguments.checked_vertices(vertices)
        offsets, corners = _arguments.checked_faces(faces, None, len(vertices))
        is_triangular = bool((np.diff(offsets) == 3).all())
        if is_triangular:
            triangles = corners.reshape(-1, 3)
        else:
            if metric is not None:
                raise ValueError("metric needs triangles; unwrap takes one for any faces.")
            triangles = corners[_native.face_triangles(vertices, offsets, corners, None)[0]]
        tensors = _arguments.checked_metric(metric, len(triangles), (2,))
        self._options = options
        self._n_vertices = len(vertices)
        self._corners, self._triangles = corners, triangles
        self._native = _native.Solver(vertices, triangles, tensors, options, _arguments.checked_progress(progress))

    def _solved(
        self,
        options: Options,
        pins: Pins | None,
        fixed: npt.ArrayLike | None,
        uv: npt.ArrayLike | None,
        extenders: Extenders | None,
        constraints: Constraints | None,
        progress: Progress | None,
    ) -> Parameterization:
        held = _arguments.checked_held(pins, fixed, uv, self._n_vertices, self._triangles)
        solution = self._native.solve(
            options,
            held,
            _arguments.checked_extenders(extenders, options.method, self._n_vertices),
            equations(
                constraints,
                Numbers(self._n_vertices),
                Numbers(len(self._corners), lambda corners: self._corners[corners]),
            ),
            _arguments.checked_progress(progress),
        )
        return Parameterization(**{**solution, "steps": steps_of(solution["steps"])})
