"""Lower the distortion of a given map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Progress
from ._constraints import Constraints, Numbers, equations
from ._mesh import Mesh, double_map_of, given_map, points_of

Border = Literal["free", "sliding", "held"]


@dataclass(frozen=True, eq=False)
class RelaxedMap(Mesh):
    """The mesh with the map of `relax`."""

    uv: npt.NDArray[np.float64]
    """(C, 2)"""
    energy_before: float
    """The mean energy of the given map, or with `fold_free` of the unfolded one; see `relax`. Islands that collapse to
    a line or a point are left out; infinite if all do."""
    energy: float
    """The mean energy of `uv`, likewise; at least 2 + 2 `sizes`."""
    steps: int
    """Steps taken, of the island with the most."""
    flipped: int
    """Triangles that are flipped or collapsed in `uv`, never more than before. Images too small for double precision
    count as collapsed; without flipped triangles, the energies are finite."""
    converged: bool
    """Whether every island ended at its minimum, to the tolerance; False if one is collapsed."""


class Relaxation:
    """A map that relaxes a few steps at a time, so that a window can show the progress.

        relaxation = sc.Relaxation(mesh, fixed=held)
        while relaxation.step(5):
            draw(relaxation.uv)

    The linear systems are analyzed once; steps continue where the last call ended, with the same map as one long call.
    Threads that share an object take turns; a progress function must not call the object that called it.
    """

    def __init__(
        self,
        mesh: Mesh,
        *,
        sizes: float = 0.5,
        fixed: npt.ArrayLike | None = None,
        weights: npt.ArrayLike | None = None,
        constraints: Constraints | None = None,
        tolerance: float = 1e-3,
        border: Border = "free",
        fold_free: bool = False,
        progress: Progress | None = None,
    ) -> None:
        """Begin with a map. Arguments and errors are those of `relax`."""
        self._mesh = given_map(mesh)
        progress = _arguments.checked_progress(progress)
        _arguments.poll(progress, "relax")
        uv, offsets = double_map_of(mesh), mesh.face_offsets
        corners, face_of = _triangles(mesh)
        self._point, first = points_of(mesh)
        _arguments.poll(progress, "relax")
        triangles, points, vertices = self._point[corners], uv[first], mesh.vertices[mesh.corner_vertices[first]]
        if not (_arguments.is_finite_at(uv, corners) and _arguments.is_finite_at(vertices, triangles)):
            raise ValueError("The mesh has positions or UVs that are not finite; every corner of a face needs both.")
        a, b, c = triangles.T
        twice = np.flatnonzero((a == b) | (b == c) | (c == a))
        if len(twice):
            raise ValueError(f"Face {face_of[twice[0]]} has a vertex twice.")
        held = None
        if fixed is not None:
            held = np.zeros(len(points), bool)
            held[self._point[_arguments.checked_corner_flags(fixed, "fixed", offsets)]] = True
        factors = None
        if weights is not None:
            factors = _arguments.checked_broadcast(weights, "weights", (len(offsets) - 1,))[face_of]
            if not (np.isfinite(factors) & (factors > 0)).all():
                raise ValueError("weights must be positive and finite.")
        equated = equations(
            constraints,
            Numbers(len(mesh.vertices), self._points_of_vertices),
            Numbers(len(self._point), lambda named: self._point[named]),
        )
        self._native = _native.Relaxation(
            vertices,
            triangles,
            points,
            held,
            factors,
            equated,
            _arguments.checked_between(sizes, 0, 1, "sizes"),
            _arguments.checked_between(tolerance, 0, 1, "tolerance"),
            _arguments.checked_choice(border, "border", get_args(Border)),
            _arguments.checked_flag(fold_free, "fold_free"),
            progress,
        )

    def step(self, n: int = 1, *, progress: Progress | None = None) -> bool:
        """Take up to `n` steps on every island. Return whether there may be more.

        Raises:
            Cancelled: `progress` returned False; the map is that of the last whole step.
        """
        return self._native.advance(_arguments.checked_count(n, "n"), _arguments.checked_progress(progress))

    @property
    def uv(self) -> npt.NDArray[np.float64]:
        """(C, 2) the present map, a copy."""
        return self._uv(self._state())

    @property
    def energy(self) -> float:
        """The mean energy of the present map."""
        return self._state()["energy"]

    @property
    def result(self) -> RelaxedMap:
        """The present map with its figures."""
        state, mesh = self._state(), self._mesh
        return RelaxedMap(
            **{**state, "uv": self._uv(state)},
            vertices=mesh.vertices,
            face_offsets=mesh.face_offsets,
            corner_vertices=mesh.corner_vertices,
            seam_edges=mesh.seam_edges,
        )

    @property
    def fixed(self) -> npt.NDArray[np.bool_]:
        """(C,) bool, the corners that do not move: those given, and what `border` holds."""
        return np.array(self._native.fixed(), dtype=bool).take(self._point)

    def _state(self) -> dict[str, Any]:
        return self._native.state()

    def _uv(self, state: dict[str, Any]) -> npt.NDArray[np.float64]:
        return state["uv"].take(self._point, axis=0)

    def _points_of_vertices(self, named: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        """Return the point of each of these vertices, (n,), -1 for none; raise ValueError if one has several."""
        vertex, point = self._mesh.corner_vertices, self._point
        of_vertex = np.full(len(self._mesh.vertices), -1)
        of_vertex[vertex] = point
        several = np.isin(named, vertex[of_vertex[vertex] != point])
        if several.any():
            vertex = named[several.argmax()]
            raise ValueError(f"Vertex {vertex} has several UVs; say which by its corners: Constraints(of='corners').")
        return of_vertex[named]


def _triangles(mesh: Mesh) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the corners of triangles that cover the faces in the map, (T, 3), and the face of each, (T,)."""
    offsets = mesh.face_offsets
    if (np.diff(offsets) == 3).all():
        return np.arange(offsets[-1]).reshape(-1, 3), np.arange(len(offsets) - 1)
    flat = np.column_stack([double_map_of(mesh), np.zeros(offsets[-1])])
    own = np.arange(offsets[-1], dtype=np.int32)
    corners, face = _native.face_triangles(flat, offsets, own, None)
    return corners.astype(np.int64), face.astype(np.int64)


def relax(
    mesh: Mesh,
    *,
    sizes: float = 0.5,
    fixed: npt.ArrayLike | None = None,
    weights: npt.ArrayLike | None = None,
    constraints: Constraints | None = None,
    tolerance: float = 1e-3,
    max_steps: int = 1000,
    border: Border = "free",
    fold_free: bool = False,
    progress: Progress | None = None,
) -> RelaxedMap:
    """Lower the distortion of a map: toward angles, sizes or both.

    Minimizes the mean, over the area of the triangles that can move, of

        (1 - sizes) (s1 / s2 + s2 / s1) + sizes (s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2)

    where s1 and s2 are the singular values of a triangle's Jacobian, at the scale at which its island has its area in
    3D. The first part depends on angles alone (Hormann and Greiner 2000, MIPS); the second is the symmetric Dirichlet
    energy (Smith and Schaefer, Bijective Parameterization with Free Boundaries, 2015). The minimum, 2 + 2 `sizes`, is
    an isometry up to scale. A flipped triangle counts with a finite substitute. Every step lowers this mean, up to a
    barrier along the border, or the number of flipped triangles. This function is not part of the paper.

    Corners with the same vertex and UV are one point. Triangles that share points form an island. Each relaxes on its
    own, where it lies; one mirrored as a whole stays mirrored, and one of which nothing is fixed or constrained keeps
    its area. No island gets more flipped or overlapping triangles: triangles with image area keep it, and the border
    does not touch itself unless it did so at the start. Islands may come to overlap each other.

    Directions come from a reweighted Dirichlet form (Rabinovich et al., Scalable Locally Injective Mappings, 2017) with
    L-BFGS steps between factorizations.

    Args:
        mesh: with a map; positions and UVs finite, faces wound alike. Polygons count as triangles that cover them in
            the map.
        sizes: from 0, angles alone, to 1.
        fixed: (C,) or (F, n) bool, corners that keep their UVs to the last bit. By default none.
        weights: (F,) positive factors of the faces' areas.
        constraints: by vertex or by corner, what the displacements meet, so that straight and mirrored parts of the map
            stay so: a map that misses them misses them as far as before. A mirror axis may lie anywhere. What they hold
            stays, whatever its value. Equations across islands are left out, and `fold_free` does not move their
            vertices.
        tolerance: an island ends when a step with a fresh factor removes less than this fraction of its energy above
            the minimum. 0: only `max_steps` and rounding end it.
        max_steps: for each island.
        border: of the islands. "free": it moves, too. "sliding": its vertices move along it, so that the outline stays:
            straight parts exactly, curved ones as a smooth curve through their vertices; those that turn by more than
            35 degrees stay, and so do those on curved parts that `constraints` concern. "held": it stays.
        fold_free: first unfold flipped triangles locally, as the option of that name does. Without it, the descent
            itself pulls them toward their island's orientation. Overlaps are not moved apart.
        progress: as in `parameterize`.

    Raises:
        ValueError: an array is not as described here.
        TypeError: an argument has the wrong type.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory.
    """
    relaxation = Relaxation(
        mesh,
        sizes=sizes,
        fixed=fixed,
        weights=weights,
        constraints=constraints,
        tolerance=tolerance,
        border=border,
        fold_free=fold_free,
        progress=progress,
    )
    relaxation.step(max_steps, progress=progress)
    return relaxation.result
