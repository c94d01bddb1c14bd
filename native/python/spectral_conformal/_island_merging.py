"""Join the islands of a map along their borders while distortion allows: seams taken back, none added.

In rounds: islands are matched with neighbors, those first that share the largest part of a border, and each pair is
unwrapped as one. All pairs of a round are one call of `unwrap`, which solves them in parallel. Islands grow by pairs,
so that a face is solved about as often as islands double; a pair that failed is tried again once one of the two has
grown.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _native
from ._arguments import Progress
from ._charts import chart_of_face
from ._measuring import edge_keys, next_corner
from ._mesh import Mesh, Polygons
from ._options import SeamOptions

_Integers = npt.NDArray[np.int64]
_Floats = npt.NDArray[np.float64]

# Of the area of an island, as for `scale_limit`.
_COUNTED = 0.95
# Of its smallest rectangle: as much as any triangle fills. Two shapes that fill less, such as rings and spirals, leave
# more of a texture empty between them.
_LEAST_FILL = 0.5
# Of the smaller island's border: a shorter joint saves little, and the islands that it hinges together pack badly.
_LEAST_JOINT = 0.1


@dataclass(frozen=True)
class _Measures:
    """The distortion of islands, (n,) each; infinite where there is no map, or one with flips or overlaps."""

    qc: _Floats
    scale: _Floats
    """log2 of the factor of the median within which most of the area has its scale."""
    area: _Floats
    fill: _Floats
    """Of the smallest rectangle around the map of each."""

    def of(self, islands: _Integers) -> _Measures:
        """Return those of some islands, any shape."""
        return _Measures(self.qc[islands], self.scale[islands], self.area[islands], self.fill[islands])


def kept_seams(
    polygons: Polygons, start: npt.NDArray[np.integer], options: SeamOptions, progress: Progress | None
) -> npt.NDArray[np.int32]:
    """Return which of the `start` edges (n, 2) stay seams, so that no limit of the `options` is exceeded further.

    Args:
        polygons: the mesh, with seams that all stay.
        start: seams to begin with.
        options: `qc_limit` and `scale_limit` count, for each island, and how maps are made.
        progress: gets the fraction of the borders' length that is settled.
    """
    # Positions may be far too large, or no numbers: then faces have no measures, and islands no maps.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        return _Merging(polygons, start, options, progress).run()


class _Merging:
    def __init__(
        self, polygons: Polygons, start: npt.NDArray[np.integer], options: SeamOptions, progress: Progress | None
    ) -> None:
        vertices, offsets, corners, seams, selected = polygons
        # By a power of two, which rounds nothing: squares stay within range.
        extent = np.abs(vertices).max(initial=0.0, where=np.isfinite(vertices))
        vertices = np.ldexp(vertices, -int(np.frexp(extent)[1]))
        self._mesh = Mesh(vertices, offsets, corner_vertices=corners)
        self._fixed = np.zeros((0, 2), np.int32) if seams is None else seams
        self._options, self._progress = options, progress
        n = len(vertices)
        ends = np.stack([corners, corners[next_corner(offsets)]], axis=1)
        keys, face = edge_keys(ends, n), np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
        self._start = np.unique(np.sort(start.astype(np.int32).reshape(-1, 2), axis=1), axis=0)
        own = edge_keys(self._start, n)
        # Corners of one vertex in a row make no edge.
        is_edge = np.isin(own, keys) & (self._start[:, 0] != self._start[:, 1])
        self._start = self._start[is_edge & ~np.isin(own, edge_keys(self._fixed, n))]
        chart = chart_of_face(
            self._mesh, seam_edges=np.concatenate([self._fixed, self._start]), selected_faces=selected
        ).astype(np.int64)
        self._island = chart
        """(F,) of each face; -1 for none."""
        # Edges between two faces, each once, with both.
        order = np.argsort(keys, kind="stable")
        firsts = np.flatnonzero(np.diff(keys[order], prepend=-1))
        counts = np.diff(np.append(firsts, len(keys)))
        length = np.nan_to_num(np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1))
        self._perimeter = np.zeros(2 * int(chart.max(initial=-1)) + 2)
        is_open = np.repeat(counts != 2, counts) | np.isin(keys[order], edge_keys(self._fixed, n))
        at_border = order[is_open & (chart[face[order]] >= 0)]
        np.add.at(self._perimeter, chart[face[at_border]], length[at_border])
        twice = firsts[counts == 2]
        twice = twice[np.isin(keys[order[twice]], edge_keys(self._start, n)) & ~is_open[twice]]
        pairs = face[np.stack([order[twice], order[twice + 1]], axis=1)]
        mapped = (chart[pairs] >= 0).all(axis=1)
        self._faces = pairs[mapped]
        """(E, 2) of each edge that may be taken back."""
        self._edges = np.sort(ends[order[twice[mapped]]], axis=1)
        self._keys = keys[order[twice[mapped]]]
        self._length = length[order[twice[mapped]]]
        self._is_seam = np.ones(len(self._edges), bool)
        for side in (0, 1):
            np.add.at(self._perimeter, chart[self._faces[:, side]], self._length)
        self._n_islands = int(chart.max(initial=-1)) + 1
        self._area = np.nan_to_num(_face_areas(vertices, corners, offsets))
        self._tried: dict[tuple[int, int], _Integers] = {}
        self._settled = 0.0

    def run(self) -> npt.NDArray[np.int32]:
        if len(self._edges):
            self._known = self._measured(self._n_islands, self._island)
            while self._round():
                pass
            self._close_slits()
        back = self._keys[~self._is_seam]
        n = len(self._mesh.vertices)
        return self._start[~np.isin(edge_keys(self._start, n), back)]

    def _round(self) -> bool:
        """Match islands and join those pairs that may be; return whether there was any to try."""
        islands = np.sort(self._island[self._faces], axis=1)
        between = self._is_seam & (islands[:, 0] != islands[:, 1])
        code = islands[:, 0] * (2 * self._n_islands) + islands[:, 1]
        codes, pair_of_edge = np.unique(code[between], return_inverse=True)
        low, high = np.divmod(codes, 2 * self._n_islands)
        shared = np.bincount(pair_of_edge, self._length[between], len(codes))
        score = shared / np.minimum(self._perimeter[low], self._perimeter[high])
        edges = np.flatnonzero(between)
        by_pair = np.split(
            edges[np.argsort(pair_of_edge, kind="stable")], np.cumsum(np.bincount(pair_of_edge, minlength=len(codes)))
        )
        taken: set[int] = set()
        chosen: list[tuple[int, int, _Integers]] = []
        for number in np.lexsort((codes, -score)).tolist():
            one, two = int(low[number]), int(high[number])
            if one in taken or two in taken:
                continue
            removed = self._next_to_try(one, two, by_pair[number])
            if removed is not None:
                taken |= {one, two}
                chosen.append((one, two, removed))
        if chosen:
            self._join(chosen)
            total = float(self._length.sum())
            self._settled = 1.0 - float(self._length[self._is_seam].sum()) / total if total else 1.0
        return bool(chosen)

    def _next_to_try(self, one: int, two: int, edges: _Integers) -> _Integers | None:
        """Return the edges whose removal joins two islands, fewer with every try; None if none are left to try.

        First the whole border, then its longest part, since several would close a ring, then half of that and so on:
        halves leave out vertices around which the surface is curved.
        """
        least = _LEAST_JOINT * min(self._perimeter[one], self._perimeter[two])
        tried = self._tried.get((one, two))
        if tried is None:
            part = edges
        elif len(tried) < 2:
            return None
        else:
            part = self._longest_part(tried)
            part = self._half(part) if len(part) == len(tried) else part
        self._tried[one, two] = part
        return part if self._length[part].sum() >= least else None

    def _longest_part(self, edges: _Integers) -> _Integers:
        """Return the longest connected part of some edges."""
        parts = _connected(self._edges[edges].tolist())
        lengths = np.bincount(parts, self._length[edges])
        return edges[parts == int(lengths.argmax())]

    def _half(self, edges: _Integers) -> _Integers:
        """Return about half of some connected edges: those nearest to one end."""
        order = edges[_from_end(self._edges[edges])]
        before = np.cumsum(self._length[order]) - self._length[order]
        return order[before < 0.5 * self._length[order].sum()][: len(order) - 1]

    def _join(self, chosen: list[tuple[int, int, _Integers]]) -> None:
        """Unwrap the pairs without these edges, and join those that are as good as wanted."""
        removed = np.concatenate([edges for _, _, edges in chosen])
        self._is_seam[removed] = False
        pairs = np.array([pair[:2] for pair in chosen])
        pair_of = np.full(len(self._perimeter), -1)
        pair_of[pairs] = np.arange(len(pairs))[:, None]
        found = self._measured(len(pairs), np.where(self._island >= 0, pair_of[self._island], -1))
        good = self._is_allowed(found, self._known.of(pairs))
        for number, (_, _, edges) in enumerate(chosen):
            if not good[number]:
                self._is_seam[edges] = True
        joined = np.flatnonzero(good)
        new = len(self._known.qc) + np.arange(len(joined))
        renamed = np.arange(len(self._perimeter))
        renamed[pairs[joined]] = new[:, None]
        shared = np.array([self._length[chosen[number][2]].sum() for number in joined])
        self._perimeter[new] = self._perimeter[pairs[joined]].sum(axis=1) - 2.0 * shared
        self._island = np.where(self._island >= 0, renamed[self._island], -1)
        # The new numbers follow the known ones.
        columns = zip(*(vars(each).values() for each in (self._known, found.of(joined))))
        self._known = _Measures(*map(np.concatenate, columns))

    def _close_slits(self) -> None:
        """Take back what is left of borders between the same island, where all of an island's may be."""
        islands = self._island[self._faces]
        inside = self._is_seam & (islands[:, 0] == islands[:, 1])
        numbers = np.unique(islands[inside, 0])
        if not len(numbers):
            return
        self._is_seam[inside] = False
        position = np.searchsorted(numbers, self._island)
        is_one = numbers[np.minimum(position, len(numbers) - 1)] == self._island
        found = self._measured(len(numbers), np.where(is_one, position, -1))
        bad = numbers[~self._is_allowed(found, self._known.of(numbers[:, None]))]
        self._is_seam[inside & np.isin(islands[:, 0], bad)] = True

    def _is_allowed(self, found: _Measures, before: _Measures) -> npt.NDArray[np.bool_]:
        """Return which islands (n,) exceed no limit further than what they are made of, (n, k)."""
        mean, fill = (
            (values * before.area).sum(axis=1) / before.area.sum(axis=1) for values in (before.qc, before.fill)
        )
        qc_limit = np.maximum(self._options.qc_limit, np.where(np.isfinite(mean), mean, 0.0))
        widest = np.where(np.isfinite(before.scale), before.scale, 0.0).max(axis=1)
        scale_limit = np.maximum(np.log2(self._options.scale_limit), widest)
        # Islands without a map fill nothing.
        least_fill = np.minimum(_LEAST_FILL, fill)
        return (found.qc <= qc_limit) & (found.scale <= scale_limit) & (found.fill >= least_fill)

    def _measured(self, n: int, of_face: _Integers) -> _Measures:
        """Unwrap n islands, given that of each face (F,), -1 for none, and measure them."""
        # Here, because that file's users import this one.
        from ._unwrapping import unwrap

        used = of_face >= 0
        seams = np.concatenate([self._fixed, self._edges[self._is_seam].astype(np.int32), self._others()])
        result = unwrap(
            self._mesh,
            seam_edges=seams,
            selected_faces=used,
            weights=self._options.weights,
            boundary=self._options.boundary,
            area_blend=self._options.area_blend,
            factorization=self._options.factorization,
            progress=self._heard(),
        )
        chart = result.chart_of_face
        counted = used & (chart >= 0)
        chart_of = np.full(n, -1)
        chart_of[of_face[counted]] = chart[counted]
        # Of an island in several charts, only one is this.
        is_apart = np.zeros(n, bool)
        is_apart[of_face[counted][chart_of[of_face[counted]] != chart[counted]]] = True
        columns = {
            name: np.asarray(result.charts.column(name)) for name in ("status", "flipped", "overlapping", "mean_qc")
        }
        sound = (columns["status"] == "solved") & (columns["flipped"] == 0) & (columns["overlapping"] == 0)
        is_good = (chart_of >= 0) & ~is_apart & np.append(sound, False)[chart_of]
        area = np.bincount(of_face[used], self._area[used], n).astype(np.float64)
        qc = np.where(is_good, np.append(columns["mean_qc"], np.inf)[chart_of], np.inf)
        corners = np.arange(len(result.uv))
        flat = _face_areas(np.c_[result.uv, np.zeros(len(corners))], corners, self._mesh.face_offsets)
        scale = _spread(self._area[used], flat[used], of_face[used], n)
        fill = _fill(result.uv, flat, of_face, self._mesh.face_offsets, n)
        return _Measures(qc, np.where(is_good, scale, np.inf), area, np.where(is_good, fill, 0.0))

    def _others(self) -> npt.NDArray[np.int32]:
        """Return the seams to begin with that cannot be taken back, such as those at edges of three faces."""
        return self._start[~np.isin(edge_keys(self._start, len(self._mesh.vertices)), self._keys)]

    def _heard(self) -> Progress | None:
        progress = self._progress
        if progress is None:
            return None
        settled = self._settled
        return lambda _fraction, _phase: progress(settled, "seams")


def _connected(edges: Iterable[tuple[int, int]]) -> npt.NDArray[np.int64]:
    """Return for each edge, a pair of vertices, the number of its connected part, from 0 on."""
    root: dict[int, int] = {}

    def find(vertex: int) -> int:
        while root.setdefault(vertex, vertex) != vertex:
            root[vertex] = root[root[vertex]]
            vertex = root[vertex]
        return vertex

    edges = list(edges)
    for one, two in edges:
        root[find(one)] = find(two)
    return np.unique([find(one) for one, _ in edges], return_inverse=True)[1]


def _from_end(edges: npt.NDArray[np.integer]) -> _Integers:
    """Return the order of connected edges (n, 2) by steps from an end of them, or from any vertex of a ring."""
    at: dict[int, list[int]] = {}
    for number, ends in enumerate(edges.tolist()):
        for vertex in ends:
            at.setdefault(vertex, []).append(number)
    reached = {min((len(numbers), vertex) for vertex, numbers in at.items())[1]}
    found: dict[int, None] = {}
    queue = list(reached)
    for vertex in queue:
        for number in at[vertex]:
            found[number] = None
            further = set(edges[number].tolist()) - reached
            reached |= further
            queue += further
    return np.fromiter(found, np.int64, len(edges))


def _face_areas(
    points: npt.NDArray[np.floating], corners: npt.NDArray[np.integer], offsets: npt.NDArray[np.integer]
) -> _Floats:
    """Return the area of each face, (F,), that of its vector area."""
    sizes = np.diff(offsets)
    placed = points[corners].astype(np.float64)
    # Relative to the first corner, which keeps the digits of a small face far from the origin. Faces may have none.
    first = placed[np.minimum(offsets[:-1], max(len(placed) - 1, 0))]
    own = placed - np.repeat(first, sizes, axis=0)
    cross = np.cross(own, own[next_corner(offsets)])
    face = np.repeat(np.arange(len(sizes)), sizes)
    return 0.5 * np.linalg.norm([np.bincount(face, each, len(sizes)) for each in cross.T], axis=0)


def _fill(uv: _Floats, flat: _Floats, island: _Integers, offsets: npt.NDArray[np.integer], n: int) -> _Floats:
    """Return for n islands the share of the smallest rectangle around each that its map covers; 1 if there is none.

    Args:
        uv: (C, 2)
        flat: (F,) the area of each face in the map.
        island: (F,) of each face, -1 for none.
        offsets: (F + 1,) the first corner of each face.
        n: number of islands.
    """
    of_corner = np.where(np.isfinite(uv).all(axis=1), np.repeat(island, np.diff(offsets)), -1)
    order = np.argsort(of_corner, kind="stable")
    firsts = np.searchsorted(of_corner[order], np.arange(n + 1)).astype(np.int32)
    around = _native.rectangle_areas(uv[order], firsts)
    covered = np.bincount(island[island >= 0], flat[island >= 0], n)
    return np.divide(covered, around, out=np.ones(n), where=around > 0.0)


def _spread(area: _Floats, flat: _Floats, island: _Integers, n: int) -> _Floats:
    """Return for n islands log2 of the factor of the median scale within which `_COUNTED` of their area is.

    Args:
        area: (f,) of faces on the surface.
        flat: (f,) in the map.
        island: (f,) of each face.
        n: number of islands.
    """
    scale = 0.5 * np.log2(flat / area)
    counted = np.isfinite(scale) & (area > 0.0)
    scale, area, island = scale[counted], area[counted], island[counted]
    middle = _weighted_quantile(scale, area, island, n, 0.5)
    return _weighted_quantile(np.abs(scale - middle[island]), area, island, n, _COUNTED)


def _weighted_quantile(values: _Floats, weights: _Floats, group: _Integers, n: int, share: float) -> _Floats:
    """Return a quantile of the values (m,) of each of n groups, by weights; 0 for an empty group."""
    order = np.lexsort((values, group))
    total = np.bincount(group, weights, n)
    before = np.cumsum(total) - total
    reached = np.cumsum(weights[order]) >= (before + share * total)[group[order]]
    result = np.zeros(n)
    # Of several values for one index, the last one stays: the first that reaches the share.
    at = np.flatnonzero(reached)[::-1]
    result[group[order][at]] = values[order][at]
    return result
