# SPDX-License-Identifier: GPL-3.0-or-later
"""The relaxation of the maps of several meshes, a few steps at a time.

A point is a vertex of the mesh at one position in the map, whichever faces have it there. The points of faces that are
not selected are held, and so are pins. Constraints that the map meets are kept; the points of others are held. Faces
around the selection take part, so that it does not overlap them.
"""

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import native
from ..mesh.charts import chart_of_face, twins
from ..mesh.polygon_mesh import PolygonMesh, face_areas
from .progress import Progress, part

# Share of an energy that angles off by 0.05 % add: reports round less to 0.0 %, and single precision is as coarse.
_INVISIBLE = 0.0005**2
# Relative to the largest coordinate, by which a map may miss an equation: a tenth of a pixel of 8192.
_MET = 0.1 / 8192


@dataclass(frozen=True)
class RelaxOptions:
    """Options of a relaxation.

    Attributes:
        sizes: from 0, angles alone, to 1; as in `spectral_conformal.relax`.
        border: what the points on the border of islands do, as there: "free", "sliding" or "held".
        fold_free: first remove flips and overlaps.
    """

    sizes: float = 0.5
    border: str = "free"
    fold_free: bool = False


class RelaxingMap:
    """The map of one mesh.

    Attributes:
        corners: (C,) bool, the corners that may move.
        area: area in object space of the triangles that may move, in proportion.
        energy_before: their mean energy at the start; see `spectral_conformal.relax`.
        has_unmet: whether the points of constraints are held because the map does not meet these.
    """

    def __init__(self, mesh: PolygonMesh, options: RelaxOptions, progress: Progress | None = None) -> None:
        """Begin with the `uv` of a mesh.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            spectral_conformal.Cancelled: `progress` returned False.
        """
        self._mesh = mesh
        uv = mesh.isotropic_uv()
        face_of_corner = mesh.face_of_corner()
        faces = np.isfinite(uv).all(axis=1) & np.isfinite(mesh.vertices[mesh.corner_vertices]).all(axis=1)
        faces = np.logical_and.reduceat(faces, mesh.face_offsets[:-1]) & (np.diff(mesh.face_offsets) >= 3)
        used = faces[face_of_corner]
        # Of all corners, so that faces that are left out stay attached.
        self._point, corner_of_point = native.spectral_conformal("_mesh").points_of(mesh.with_map(uv))
        triangles = self._point[_triangles(mesh, uv, faces)]
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (c != a)]
        equations, unmet = _met_equations(mesh, uv, self._point)
        held_corners = ~(used & mesh.selected_faces[face_of_corner]) | unmet
        self.has_unmet = bool((unmet & mesh.selected_faces[face_of_corner]).any())
        if mesh.pinned_corners is not None:
            held_corners |= mesh.pinned_corners
        fixed = np.zeros(len(corner_of_point), dtype=bool)
        fixed[self._point[held_corners]] = True
        vertices = mesh.vertices[mesh.corner_vertices[corner_of_point]]
        vertices[~np.isfinite(vertices).all(axis=1)] = 0.0
        points = uv[corner_of_point]
        points[~np.isfinite(points).all(axis=1)] = 0.0
        self._start = points
        if options.fold_free and options.border == "free":
            bound = fixed.copy()
            bound[self._point[mesh.constrained_corners()]] = True
            points = _embedded(vertices, triangles, points, bound, progress)
        module = native.spectral_conformal()
        self._points, self._corner_points = points, triangles.ravel()
        self._relaxation = module.Relaxation(
            module.Mesh(vertices, triangles, points[triangles]),
            sizes=options.sizes,
            fixed=fixed[triangles],
            constraints=module.Constraints(equations=equations),
            border=options.border,
            fold_free=options.fold_free,
            progress=progress,
        )
        fixed[triangles] |= self._relaxation.fixed.reshape(-1, 3)
        self.corners = ~fixed[self._point] & used
        sides = vertices[triangles]
        areas = np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
        self.area = float(areas[~fixed[triangles].all(axis=1)].sum())
        self.energy_before = self._relaxation.result.energy_before

    @property
    def can_move(self) -> bool:
        """Whether any corner may move and has a surface beside it."""
        return self.area > 0.0 and bool(self.corners.any())

    def now(self) -> tuple[np.ndarray, float]:
        """Return the present points, for `uv`, and their mean energy."""
        found = self._relaxation.result
        points = self._points.copy()
        points[self._corner_points] = found.uv
        return points, found.energy

    def step(self, n: int, progress: Progress | None = None) -> bool:
        """Take up to `n` steps; return whether there may be more."""
        return self._relaxation.step(n, progress=progress)

    def uv(self, points: np.ndarray) -> np.ndarray:
        """Return the map, (C, 2), of points from `now`; what has not moved is the same to the last bit."""
        moved = (points != self._start).any(axis=1)[self._point]
        found = self._mesh.uv.copy()
        found[moved] = self._mesh.from_isotropic_uv(points[self._point[moved]])
        return found


@dataclass(frozen=True)
class Relaxed:
    """Maps after some steps.

    Attributes:
        steps: number of steps.
        gain: fraction of the distortion, above that of an isometry or a similarity, that is gone.
        points: of every mesh.
        meshes: whose points they are.
    """

    steps: int
    gain: float
    points: Sequence[np.ndarray]
    meshes: Sequence[RelaxingMap]

    @functools.cached_property
    def maps(self) -> list[np.ndarray]:
        """The map of every mesh, (C, 2)."""
        return [mesh.uv(points) for mesh, points in zip(self.meshes, self.points)]


class Relaxing:
    """The maps of several meshes; any thread may call one method at a time.

    Attributes:
        corners: (C,) bool of every mesh, the corners that may move.
        can_move: whether there are any.
    """

    def __init__(self, meshes: Sequence[PolygonMesh], options: RelaxOptions, progress: Progress | None = None) -> None:
        """Begin with the `uv` of the meshes, which must have one.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            spectral_conformal.Cancelled: `progress` returned False.
        """
        self._maps = [RelaxingMap(mesh, options, progress) for mesh in meshes]
        self._steps = 0
        self._least = 2.0 + 2.0 * options.sizes
        self._goes_on = [each.can_move for each in self._maps]
        self.can_move = any(self._goes_on)
        self.corners = [each.corners for each in self._maps]

    def step(self, n: int = 1, progress: Progress | None = None) -> bool:
        """Take up to `n` steps on every mesh; return whether there may be more.

        Raises:
            spectral_conformal.Cancelled: `progress` returned False.
        """
        count = len(self._maps)
        for k, each in enumerate(self._maps):
            if self._goes_on[k]:
                own = None if progress is None else part(progress, k / count, 1.0 / count)
                self._goes_on[k] = each.step(n, own)
        self._steps += n
        return any(self._goes_on)

    def now(self) -> Relaxed:
        """Return the present maps."""
        found = [each.now() for each in self._maps]
        excess = excess_before = 0.0
        for each, (_, energy) in zip(self._maps, found):
            # A mesh all of whose islands are collapsed has no energy.
            if each.can_move and np.isfinite(each.energy_before):
                excess_before += each.area * max(each.energy_before - self._least, 0.0)
                excess += each.area * max(energy - self._least, 0.0)
        area = sum(each.area for each in self._maps if each.can_move)
        has_distortion = excess_before > _INVISIBLE * area * self._least
        gain = 1.0 - excess / excess_before if has_distortion else 0.0
        return Relaxed(self._steps, gain, [points for points, _ in found], self._maps)


def _met_equations(mesh: PolygonMesh, uv: np.ndarray, point: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
    """Return the equations that a map (C, 2) meets, (E, 4, 2), on its points, and the corners (C,) bool of the others.

    A mirror axis may lie anywhere. Of charts that are torn in the map, it meets none.
    """
    unmet = np.zeros(len(uv), dtype=bool)
    if mesh.equations is None:
        return None, unmet
    uv = np.where(np.isfinite(uv), uv, np.nan)
    corner, axis = np.divmod(mesh.equations[..., 0].astype(np.int64), 2)
    factor = mesh.equations[..., 1]
    chart, face = chart_of_face(mesh, mesh.selected_faces), mesh.face_of_corner()
    of_row = chart[face[corner[:, 0]]]
    missed, total, largest = (factor * uv[corner, axis]).sum(axis=1), factor.sum(axis=1), np.abs(factor).sum(axis=1)
    # All equations about an axis must have it at the same place, here that of the chart's first.
    about = np.abs(total) > _MET * largest
    first_of, first = np.unique(of_row[about], return_index=True)
    # The last is for faces without a chart.
    place = np.zeros(int(chart.max(initial=-1)) + 2)
    place[first_of] = (missed[about] / total[about])[first]
    missed = np.abs(missed - np.where(about, total * place[of_row], 0.0))
    twin, following = twins(mesh), mesh.next_corner()
    inner = np.flatnonzero(twin >= 0)
    torn = np.unique(chart[face[inner[point[inner] != point[following[twin[inner]]]]]])
    met = (missed <= _MET * largest * np.abs(np.nan_to_num(uv)).max(initial=0.0)) & ~np.isin(of_row, torn)
    unmet[corner[~met][factor[~met] != 0.0]] = True
    return np.stack([2.0 * point[corner] + axis, factor], axis=2)[met], unmet


def _triangles(mesh: PolygonMesh, uv: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the corners of triangles, (T, 3), that cover these `faces` (F,) in the map: concave quads unfolded."""
    flat = np.column_stack([np.nan_to_num(uv, posinf=0.0, neginf=0.0), np.zeros(len(uv))])
    own = np.arange(len(uv), dtype=np.int32)
    triangles, _ = native.spectral_conformal().hosts.face_triangles(flat, mesh.face_offsets, own, selected_faces=faces)
    return triangles


def _embedded(
    vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray, fixed: np.ndarray, progress: Progress | None
) -> np.ndarray:
    """Return the map in which islands with flips or overlaps, and without fixed points, are mapped anew.

    They get a map without either if there is one, moved, turned and scaled to lie nearest to their former points.
    Mirrored islands stay mirrored.
    """
    module, onto_former = native.spectral_conformal(), native.spectral_conformal("_layout").onto_former
    if not len(triangles):
        return points
    defects = module.map_defects(module.Mesh(vertices, triangles, points[triangles]))
    bad = defects.flipped | defects.overlapping
    if not bad.any():
        return points
    points, island = points.copy(), defects.island_of_face
    for number in np.unique(island[bad]):
        own, others = triangles[island == number], triangles[island != number]
        used, local = np.unique(own, return_inverse=True)
        # An island that touches another one in a point would be torn off.
        if fixed[used].any() or np.isin(others, used).any():
            continue
        try:
            found = module.parameterize(vertices[used], local.reshape(-1, 3), fold_free=True, progress=progress).uv
        except (ValueError, module.SolveError):
            # Closed, or without a surface; what can be unfolded in place still is.
            continue
        if face_areas(points[own].reshape(-1, 2), np.arange(0, own.size + 1, 3)).sum() < 0.0:
            found = found * (1.0, -1.0)
        fitted, is_placed = onto_former(found, points[used], np.zeros(len(used), dtype=np.int64))
        points[used] = np.where(is_placed[:, None], fitted, points[used])
    return points
