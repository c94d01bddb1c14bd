"""The pattern of a map: the outlines of its islands in true size, and the seams that join them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._measuring import connected, edge_keys, next_corner
from ._mesh import Mesh, double_map_of, given_map, points_of, uv_per_length


@dataclass(frozen=True, eq=False)
class MapBorder:
    """The edges of faces at which the islands of a map end, and those of them that are joined in 3D.

    An edge of a face is inside an island if exactly two faces have its ends, with the same UVs. A seam edge is an edge
    in 3D with two or more such sides in the map.
    """

    corners: npt.NDArray[np.int64]
    """(B,) the corner at which each border edge begins."""
    ends: npt.NDArray[np.int64]
    """(B,) the corner of the same face at which it ends."""
    seam_edge: npt.NDArray[np.int64]
    """(B,) the number of its seam edge, -1 for the border of the mesh."""
    length: npt.NDArray[np.float64]
    """(B,) in 3D."""
    map_length: npt.NDArray[np.float64]
    """(B,) in the map, divided by the map's `uv_per_length`."""

    def seam_errors(self) -> tuple[float, float]:
        """Return how much too long or short the sides of seams are in the map, and by how much they differ.

        With the length l of a seam edge in 3D and l_1, l_2, ... of its sides in the map, divided by the map's scale
        s = sqrt(area in the map / area in 3D):

            error = sum over sides of |l_k - l| / sum over sides of l
            mismatch = sum over edges of (max l_k - min l_k) / sum over edges of l

        Both are 0 without seams that have a length.
        """
        is_seam = self.seam_edge >= 0
        number = self.seam_edge[is_seam]
        length, found = self.length[is_seam], self.map_length[is_seam]
        total = float(length.sum())
        if not total > 0.0:
            return 0.0, 0.0
        low, high, own = np.full(int(number.max()) + 1, np.inf), np.zeros(int(number.max()) + 1), np.bincount(number)
        np.minimum.at(low, number, found)
        np.maximum.at(high, number, found)
        return (
            float(np.abs(found - length).sum()) / total,
            float((high - low).sum() / (length / own[number]).sum()),
        )


@dataclass(frozen=True, eq=False)
class Pattern:
    """The outlines of a map's islands in true size, to be cut, and the seams at which they are joined.

    An outline is a closed line, in the direction of its faces; a side of a seam is a part of one. The N points are in
    the order of the outlines. Lengths are in the unit of the mesh.
    """

    points: npt.NDArray[np.float64]
    """(N, 2)"""
    outlines: npt.NDArray[np.int64]
    """(L + 1,) the first point of each outline, and N."""
    sides: npt.NDArray[np.int64]
    """(S + 1,) the first point of each side, and N; a side ends at the first point of the next one in its outline."""
    seams: npt.NDArray[np.int64]
    """(S,) the seam of each side, from 1 on; sides with one number are joined. 0 where the mesh ends."""
    vertices: npt.NDArray[np.int32]
    """(N,) the vertex of each point: at equal vertices, sides of a seam meet."""
    inward: npt.NDArray[np.float64]
    """(N,) 1 where the island lies to the left of the edge that begins at a point, -1 to the right."""
    lengths: npt.NDArray[np.float64]
    """(S,) of each side in 3D."""
    map_lengths: npt.NDArray[np.float64]
    """(S,) of each side in the pattern."""
    uv_per_length: float
    """UVs per unit of length in the map that it was made of."""

    def ends(self) -> npt.NDArray[np.int64]:
        """Return the index of the next point along the outline of each point, (N,)."""
        return next_corner(self.outlines)

    def side_points(self) -> Iterator[npt.NDArray[np.float64]]:
        """Yield the points of each side, (n, 2), with its end."""
        ends = self.ends()
        for first, end in zip(self.sides[:-1].tolist(), self.sides[1:].tolist()):
            yield np.append(self.points[first:end], self.points[ends[end - 1 : end]], axis=0)


def pattern(mesh: Mesh, *, aspect: float = 1.0) -> Pattern:
    """Return the outlines of a map's islands in true size, as they lie in the map, and the seams that join them.

        flat = sc.pattern(sc.pack(sc.unwrap(sc.suggest_seams(V, F))))

    The pattern is the map over its scale s = sqrt(area in the map / area in 3D), one for all islands; it is exact where
    the surface is developable. `spectral_conformal.assets.drawing` writes it as SVG and DXF.

    Args:
        mesh: with a map in which islands do not overlap; faces with a UV that is not finite are left out.
        aspect: width over height of the texture.

    Raises:
        ValueError: the mesh has no map, or mesh or map have no area.
    """
    given = given_map(mesh)
    aspect = _arguments.checked_at_least(aspect, 0.0, "aspect")
    if not 0.0 < aspect < math.inf:
        raise ValueError(f"aspect must be above 0 and finite, not {aspect!r}.")
    with np.errstate(over="ignore", invalid="ignore"):
        uv = double_map_of(given) * [aspect**0.5, aspect**-0.5]
        finite = np.isfinite(uv).all(axis=1)
        has_map = np.ones(len(given.face_offsets) - 1, bool)
        has_map[np.repeat(np.arange(len(has_map)), np.diff(given.face_offsets))[~finite]] = False
        outlines = _Outlines(given.with_uv(np.where(finite[:, None], uv, 0.0)), has_map)
        if not 0.0 < outlines.scale < math.inf:
            raise ValueError("The map or the mesh has no area, or one beyond double precision: it has no scale.")
        return outlines.pattern()


def map_border(mesh: Mesh, selected_faces: npt.NDArray[np.bool_]) -> MapBorder:
    """Return the border of the islands of a map, finite at the selected faces, (F,); others do not count."""
    return _Outlines(mesh, selected_faces).border


class _Outlines:
    """Border edges of a map, and how they follow one another.

    A `face edge` is the edge from a corner to the next one in its face. Edges between corners with the same vertex and
    UV are left out, and faces with less than three others.
    """

    def __init__(self, mesh: Mesh, selected_faces: npt.NDArray[np.bool_]) -> None:
        self._mesh = mesh
        self.scale = uv_per_length(mesh, selected_faces)
        counts = np.diff(mesh.face_offsets)
        face = np.repeat(np.arange(len(counts)), counts)
        point = points_of(mesh)[0]
        counted = point != point[next_corner(mesh.face_offsets)]
        kept = selected_faces & (np.bincount(face[counted], minlength=len(counts)) >= 3)
        # The corners of face edges, face after face.
        self._corner = np.flatnonzero(counted & kept[face])
        self._face = face[self._corner]
        sizes = np.bincount(self._face, minlength=len(counts))
        self._next = next_corner(np.append(0, np.cumsum(sizes)))
        self._previous = np.empty_like(self._next)
        self._previous[self._next] = np.arange(len(self._next))
        self._point = point[self._corner]
        ends = np.stack([self._point, self._point[self._next]], axis=1)
        self._twin = _twins(edge_keys(ends, int(point.max(initial=0)) + 1))
        self._edges = np.flatnonzero(self._twin < 0)
        self.border = self._border()

    def _border(self) -> MapBorder:
        mesh = self._mesh
        corners, ends = self._corner[self._edges], self._corner[self._next[self._edges]]
        vertices = mesh.corner_vertices[np.stack([corners, ends], axis=1)]
        _, number, count = np.unique(edge_keys(vertices, len(mesh.vertices)), return_inverse=True, return_counts=True)
        number = number.ravel()
        is_seam = count >= 2
        seam = np.where(is_seam, np.cumsum(is_seam) - 1, -1)[number]
        uv = double_map_of(mesh)
        along = uv[ends] - uv[corners]
        length = np.linalg.norm(mesh.vertices[vertices[:, 0]] - mesh.vertices[vertices[:, 1]], axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            return MapBorder(corners, ends, seam, length, np.hypot(along[:, 0], along[:, 1]) / self.scale)

    def _following(self) -> npt.NDArray[np.int64]:
        """Return for each end of each border edge, (2 B,), the end at the same point that continues the outline.

        End 2 k is the begin of border edge k, and 2 k + 1 its end. From one to the other, faces are passed around the
        point, whatever their winding.
        """
        number = np.full(len(self._twin), -1)
        number[self._edges] = np.arange(len(self._edges))
        edge, is_end = np.repeat(self._edges, 2), np.tile([False, True], len(self._edges))
        result = np.full(len(edge), -1)
        moving = np.arange(len(edge))
        while len(moving):
            at_end = is_end[moving]
            here = np.where(at_end, self._next[edge[moving]], self._previous[edge[moving]])
            # It begins at the point where the last one ends, and the other way round.
            is_end[moving] = ~at_end
            edge[moving] = here
            arrived = self._twin[here] < 0
            result[moving[arrived]] = 2 * number[here[arrived]] + is_end[moving[arrived]]
            moving, here = moving[~arrived], here[~arrived]
            point = np.where(is_end[moving], self._point[self._next[here]], self._point[here])
            edge[moving] = self._twin[here]
            is_end[moving] = self._point[edge[moving]] != point
        return result

    def _seams(self, following: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
        """Return the seam of each border edge, (B,), -1 for none, and whether it goes on past each end, (2 B,).

        A seam goes on from one edge to another at a vertex if all of their sides do; the border of the mesh always.
        """
        border = self.border
        of_end = np.repeat(border.seam_edge, 2)
        vertex = self._mesh.corner_vertices[np.stack([border.corners, border.ends], axis=1)].ravel()
        pairs = np.sort(np.stack([of_end, of_end[following]], axis=1), axis=1)
        _, link, count = np.unique(np.c_[pairs, vertex], axis=0, return_inverse=True, return_counts=True)
        n_sides = np.bincount(border.seam_edge[border.seam_edge >= 0], minlength=1)
        # Each link has two ends.
        goes_on = (pairs[:, 0] >= 0) & (pairs[:, 0] != pairs[:, 1])
        goes_on &= (count[link.ravel()][:, None] == 2 * n_sides[pairs]).all(axis=1)
        number = np.arange(len(n_sides))
        joined = pairs[goes_on]
        label = connected(np.arange(0, 2 * len(joined) + 1, 2, dtype=np.int32), joined.ravel(), len(n_sides))
        # Seam edges that stay alone keep numbers of their own.
        number[joined.ravel()] = len(n_sides) + np.repeat(label, 2)
        goes_on |= (pairs == -1).all(axis=1)
        return np.where(border.seam_edge >= 0, number[border.seam_edge], -1), goes_on

    def pattern(self) -> Pattern:
        border, mesh = self.border, self._mesh
        following = self._following()
        seam, goes_on = self._seams(following)
        begins = mesh.corner_vertices[np.stack([border.corners, border.ends], axis=1)].ravel()
        ends, counts = _lines(following, goes_on, begins)
        edge, is_backward = ends // 2, ends % 2 == 1
        sides = np.flatnonzero(~goes_on[ends])
        # Outlines that are one side all around have no other begin.
        outlines = np.append(0, np.cumsum(counts))
        sides = np.union1d(sides, outlines[:-1]).astype(np.int64)
        uv, corner = double_map_of(mesh), np.where(is_backward, border.ends[edge], border.corners[edge])
        # Numbers in the order of the outlines.
        numbers, first, inverse = np.unique(seam[edge[sides]], return_index=True, return_inverse=True)
        rank = np.empty(len(numbers), np.int64)
        rank[np.argsort(np.where(numbers < 0, -1, first), kind="stable")] = np.arange(len(numbers))
        seams = rank[inverse.ravel()] + int(not (numbers < 0).any())
        return Pattern(
            points=uv[corner] / self.scale,
            outlines=outlines,
            sides=np.append(sides, len(edge)),
            seams=seams,
            vertices=mesh.corner_vertices[corner],
            inward=np.where(is_backward, -1.0, 1.0) * self._winding()[self._face[self._edges[edge]]],
            lengths=np.add.reduceat(border.length[edge], sides) if len(sides) else np.zeros(0),
            map_lengths=np.add.reduceat(border.map_length[edge], sides) if len(sides) else np.zeros(0),
            uv_per_length=self.scale,
        )

    def _winding(self) -> npt.NDArray[np.float64]:
        """Return 1 for each face, (F,), that is counterclockwise in the map, -1 for the others."""
        u, v = double_map_of(self._mesh)[self._corner].T
        area = np.bincount(self._face, u * v[self._next] - v * u[self._next], len(self._mesh.face_offsets) - 1)
        return np.where(area < 0.0, -1.0, 1.0)


def _twins(keys: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the index of the other one with the same key, (n,), -1 unless there is exactly one."""
    order = np.argsort(keys, kind="stable")
    begins = np.flatnonzero(np.append(True, keys[order[1:]] != keys[order[:-1]])[: len(keys)])
    counts = np.diff(np.append(begins, len(keys)))
    one, two = (order[begins[counts == 2] + k] for k in (0, 1))
    result = np.full(len(keys), -1)
    result[one], result[two] = two, one
    return result


def _lines(
    following: npt.NDArray[np.int64], goes_on: npt.NDArray[np.bool_], vertex: npt.NDArray[np.integer]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the ends at which the edges of the closed lines begin, in order, (B,), and each line's number of edges.

    Lines begin where a seam ends, or at the lowest vertex, so that both sides of a closed seam begin at one vertex.
    """
    next_of, stays, vertex_of = following.tolist(), goes_on.tolist(), vertex.tolist()
    is_taken = [False] * (len(next_of) // 2)
    found: list[int] = []
    counts = []
    for edge in range(len(is_taken)):
        if is_taken[edge]:
            continue
        line = []
        end = 2 * edge
        while not is_taken[end // 2]:
            is_taken[end // 2] = True
            line.append(end)
            end = next_of[end ^ 1]
        start = min(range(len(line)), key=lambda k: (stays[line[k]], vertex_of[line[k]]))
        found += line[start:] + line[:start]
        counts.append(len(line))
    return np.array(found, np.int64), np.array(counts, np.int64)
