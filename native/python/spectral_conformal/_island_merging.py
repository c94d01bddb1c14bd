"""Join the islands of a map along their borders while distortion allows: seams taken back, none added.

In rounds: islands are matched with neighbors, those first that share the largest part of a border, and each pair is
unwrapped as one. All pairs of a round are one call of `unwrap`, which solves them in parallel. Islands grow by pairs,
so that a face is solved about as often as islands double; a pair that failed is tried again once one of the two has
grown.

On a noisy surface, no map has little distortion: the angles around a vertex do not add up to a full turn. As this
cannot be avoided without a seam through that vertex, `_stretch_of_cones` does not count against an island.

Noise also folds maps in a few faces. To unfold them takes several times as long as the map itself, and would be done
again whenever an island grows, so it is done at the end; then islands that exceed a limit are taken apart again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arguments import Progress
from ._charts import chart_of_face
from ._measuring import edge_keys, next_corner
from ._mesh import Mesh, Polygons
from ._options import SHARED, SeamOptions
from .defaults import MAPS

_Integers = npt.NDArray[np.int64]
_Floats = npt.NDArray[np.float64]

# Of the area of an island, as for `scale_limit`.
_COUNTED = 0.95
# Of its smallest rectangle: as much as any triangle fills. Two shapes that fill less, such as rings and spirals, leave
# more of a texture empty between them.
_LEAST_FILL = 0.5
# Of the smaller island's border: a shorter joint saves little, and the islands that it hinges together pack badly.
_LEAST_JOINT = 0.1
# Edges: along a longer joint, single vertices count little, and a half is as good as the whole.
_MOST_HALVED = 8
# Of the faces of an island. Fewer that flip or overlap are unfolded at the end: that moves their neighbors only, so
# that what is measured over the island stays about the same.
_FEW_FOLDED = 0.01
# An island is unwrapped at most this often until its area has doubled: smaller ones, one by one, gain little.
_MOST_SOLVED = 8


@dataclass(frozen=True)
class _Measures:
    """The distortion of islands, (n,) each; infinite where there is no map, or one that folds too much."""

    area: _Floats
    floor: _Floats
    """What `_stretch_of_cones` adds to the QC of any map with these borders."""
    folded: _Floats
    """Of the faces, the fraction that flip or overlap."""
    qc: _Floats
    scale: _Floats
    """log2 of the factor of the median within which most of the area has its scale."""
    fill: _Floats
    """Of the smallest rectangle around the map of each."""

    def of(self, islands: npt.NDArray[Any]) -> _Measures:
        """Return those of some islands, any shape."""
        return _Measures(*(values[islands] for values in vars(self).values()))

    def with_changed(self, islands: npt.NDArray[np.bool_], changed: _Measures) -> _Measures:
        """Return them with those of the marked islands replaced."""
        columns = {name: values.copy() for name, values in vars(self).items()}
        for name, values in columns.items():
            values[islands] = vars(changed)[name]
        return _Measures(**columns)


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
        # Numbers for islands that join, and for those that lose their slits.
        self._perimeter = np.zeros(3 * int(chart.max(initial=-1)) + 3)
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
        self._at_rim = np.zeros(n, bool)
        self._at_rim[ends[order[np.repeat(counts != 2, counts)]]] = True
        self._weight = self._area[face]
        """(C,) the area of the face of each corner."""
        self._stretch = self._weight * _stretch_of_cones(vertices, offsets, corners)[corners]
        """(C,) of that face by the corner's vertex, times the area."""
        self._was_inside = self._inside()
        shared = {name: getattr(options, name) for name in SHARED}
        self._maps = replace(MAPS, **shared)
        self._n_solved = np.zeros(len(self._perimeter), np.int64)
        """Of each island, since its area was `_area_then`."""
        self._area_then = np.zeros(len(self._perimeter))
        self._tried: dict[tuple[int, int], _Integers] = {}
        self._parts: dict[int, tuple[int, int, _Integers]] = {}
        """Of islands that were joined: what they were made of, and the edges that were taken back."""
        self._selected = selected
        self._one_face = np.zeros(len(self._perimeter), np.int64)
        """A face of each island."""
        mapped = np.flatnonzero(chart >= 0)
        self._one_face[chart[mapped]] = mapped
        self._settled = 0.0

    def run(self) -> npt.NDArray[np.int32]:
        if len(self._edges):
            self._known = self._measured(self._n_islands, self._island)
            self._area_then[: self._n_islands] = self._known.area
            while self._round():
                pass
            self._close_slits()
            self._unfold()
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
        area = self._known.area
        taken: set[int] = set()
        chosen: list[tuple[int, int, _Integers]] = []
        for number in np.lexsort((codes, -score)).tolist():
            one, two = int(low[number]), int(high[number])
            larger = one if area[one] > area[two] else two
            if one in taken or two in taken or self._n_solved[larger] >= _MOST_SOLVED:
                continue
            removed = self._next_to_try(one, two, by_pair[number])
            if len(removed):
                taken |= {one, two}
                self._n_solved[larger] += 1
                chosen.append((one, two, removed))
        if chosen:
            self._join(chosen)
            total = float(self._length.sum())
            self._settled = 1.0 - float(self._length[self._is_seam].sum()) / total if total else 1.0
        return bool(chosen)

    def _next_to_try(self, one: int, two: int, edges: _Integers) -> _Integers:
        """Return the edges whose removal joins two islands, fewer with every try; none if none are left to try.

        First the whole border, then its longest part, since several would close a ring, then half of a short one and
        so on: halves leave out vertices around which the surface is curved.
        """
        least = _LEAST_JOINT * min(self._perimeter[one], self._perimeter[two])
        tried = self._tried.get((one, two))
        if tried is not None:
            edges = self._longest_part(tried)
            if len(edges) == len(tried):
                edges = self._half(edges) if 1 < len(edges) <= _MOST_HALVED else edges[:0]
        self._tried[one, two] = edges
        return edges if self._length[edges].sum() >= least else edges[:0]

    def _longest_part(self, edges: _Integers) -> _Integers:
        """Return the longest connected part of some edges."""
        if not len(edges):
            return edges
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
        before = self._known.of(pairs)
        found = self._measured(len(pairs), np.where(self._island >= 0, pair_of[self._island], -1), before)
        good = self._is_allowed(found, before)
        for number, (_, _, edges) in enumerate(chosen):
            if not good[number]:
                self._is_seam[edges] = True
        joined = np.flatnonzero(good)
        new = self._renamed(pairs[joined], [chosen[number][2] for number in joined], found.of(joined))
        shared = np.array([self._length[chosen[number][2]].sum() for number in joined])
        self._perimeter[new] = self._perimeter[pairs[joined]].sum(axis=1) - 2.0 * shared
        larger = pairs[joined, before.area[joined].argmax(axis=1)]
        has_doubled = found.area[joined] >= 2.0 * self._area_then[larger]
        self._area_then[new] = np.where(has_doubled, found.area[joined], self._area_then[larger])
        self._n_solved[new] = np.where(has_doubled, 0, self._n_solved[larger])

    def _renamed(self, pairs: _Integers, edges: Sequence[_Integers], found: _Measures) -> _Integers:
        """Make a new island of each of these pairs (n, 2), given its edges that are no seams now; return their numbers.

        They follow the known ones. Of an island that loses slits, both of a pair are that one.
        """
        new = len(self._known.qc) + np.arange(len(pairs))
        renamed = np.arange(len(self._perimeter))
        renamed[pairs] = new[:, None]
        self._island = np.where(self._island >= 0, renamed[self._island], -1)
        self._one_face[new] = self._one_face[pairs[:, 0]]
        self._parts.update((number, (*pair, own)) for number, pair, own in zip(new.tolist(), pairs.tolist(), edges))
        columns = zip(*(vars(each).values() for each in (self._known, found)))
        self._known = _Measures(*map(np.concatenate, columns))
        return new

    def _close_slits(self) -> None:
        """Take back what is left of borders between the same island, where all of an island's may be."""
        islands = self._island[self._faces]
        inside = self._is_seam & (islands[:, 0] == islands[:, 1])
        numbers = np.unique(islands[inside, 0])
        if not len(numbers):
            return
        self._is_seam[inside] = False
        before = self._known.of(numbers[:, None])
        found = self._measured(len(numbers), self._position_in(numbers), before)
        good = self._is_allowed(found, before)
        self._is_seam[inside & np.isin(islands[:, 0], numbers[~good])] = True
        edges = np.flatnonzero(inside & np.isin(islands[:, 0], numbers[good]))
        edges = edges[np.argsort(islands[edges, 0], kind="stable")]
        own = np.split(edges, np.flatnonzero(np.diff(islands[edges, 0])) + 1)
        self._renamed(np.stack([numbers[good]] * 2, axis=1), own, found.of(good))

    def _unfold(self) -> None:
        """Unfold the maps of islands that fold in few faces; take apart what exceeds limits then."""
        waiting = np.unique(self._island)
        while True:
            waiting = np.array([each for each in waiting.tolist() if each in self._parts], np.int64)
            waiting = waiting[self._known.folded[waiting] > 0.0]
            if not len(waiting):
                return
            before = self._known.of(np.array([self._parts[each][:2] for each in waiting.tolist()]))
            found = self._solved(len(waiting), self._position_in(waiting), fold_free=True)
            bad = waiting[(found.folded > 0.0) | ~self._is_allowed(found, before)]
            for island in bad.tolist():
                self._is_seam[self._parts[island][2]] = True
            parts = np.unique([self._parts[each][:2] for each in bad.tolist()]).astype(np.int64)
            if len(bad):
                chart = chart_of_face(self._mesh, seam_edges=self._seams(), selected_faces=self._selected)
                left = np.setdiff1d(np.append(self._island[self._island >= 0], parts), bad)
                number_of = np.full(int(chart.max(initial=-1)) + 2, -1)
                number_of[chart[self._one_face[left]]] = left
                self._island = number_of[chart]
            waiting = parts

    def _position_in(self, numbers: _Integers) -> _Integers:
        """Return for each face (F,) the position of its island among these, which ascend; -1 for others."""
        position = np.searchsorted(numbers, self._island)
        return np.where(numbers[np.minimum(position, len(numbers) - 1)] == self._island, position, -1)

    def _is_allowed(self, found: _Measures, before: _Measures) -> npt.NDArray[np.bool_]:
        """Return which islands (n,) exceed no limit, or not further than what they are made of, (n, k), on average."""
        weight = before.area / before.area.sum(axis=1, keepdims=True)

        def at_most(limit: npt.ArrayLike, values: _Floats) -> _Floats:
            mean = (weight * values).sum(axis=1)
            return np.maximum(limit, np.where(np.isfinite(mean), mean, -np.inf))

        return (
            (found.qc <= at_most(self._options.qc_limit + found.floor, before.qc))
            & (found.scale <= at_most(np.log2(self._options.scale_limit), before.scale))
            & (-found.fill <= at_most(-_LEAST_FILL, -before.fill))
        )

    def _measured(self, n: int, of_face: _Integers, before: _Measures | None = None) -> _Measures:
        """Unwrap n islands, given that of each face (F,), -1 for none, and measure them.

        Maps that fold are unfolded, which takes long: not those that exceed limits anyway, given what they are made of,
        (n, k), and then not those that fold in few faces.
        """
        found = self._solved(n, of_face, fold_free=False)
        most = 0.0 if before is None else _FEW_FOLDED
        unfolds = found.folded > most
        if before is not None:
            unfolds &= self._is_allowed(found, before)
        if unfolds.any():
            number = np.where(unfolds, np.cumsum(unfolds) - 1, -1)
            of_unfolded = np.append(number, -1)[of_face]
            found = found.with_changed(unfolds, self._solved(int(unfolds.sum()), of_unfolded, fold_free=True))
        bad = found.folded > most
        # Islands without a map fill nothing.
        infinite, nothing = np.full(int(bad.sum()), np.inf), np.zeros(int(bad.sum()))
        return found.with_changed(bad, replace(found.of(bad), qc=infinite, scale=infinite, fill=nothing))

    def _solved(self, n: int, of_face: _Integers, fold_free: bool) -> _Measures:
        # Here, because that file's users import this one.
        from ._unwrapping import unwrap

        used = of_face >= 0
        result = unwrap(
            self._mesh,
            seam_edges=self._seams(),
            selected_faces=used,
            options=replace(self._maps, fold_free=fold_free),
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
        has_map = (chart_of >= 0) & ~is_apart & np.append(columns["status"] == "solved", False)[chart_of]
        n_folded = np.append(columns["flipped"] + columns["overlapping"], 0)[chart_of]
        n_faces = np.maximum(np.bincount(of_face[used], minlength=n), 1)
        area = np.bincount(of_face[used], self._area[used], n).astype(np.float64)
        corners = np.arange(len(result.uv))
        flat = _face_areas(np.c_[result.uv, np.zeros(len(corners))], corners, self._mesh.face_offsets)
        scale = _spread(self._area[used], flat[used], of_face[used], n)
        fill = _fill(result.uv, flat, of_face, self._mesh.face_offsets, n)
        return _Measures(
            area,
            self._floor(of_face, area),
            np.where(has_map, n_folded / n_faces, np.inf),
            np.where(has_map, np.append(columns["mean_qc"], np.inf)[chart_of], np.inf),
            np.where(has_map, scale, np.inf),
            np.where(has_map, fill, 0.0),
        )

    def _floor(self, of_face: _Integers, area: _Floats) -> _Floats:
        """Return for islands (n,) the mean stretch that the vertices inside add to their faces.

        Those inside since the beginning show how large it is: the corners of a box are all at borders, and stay there.
        """
        island = np.repeat(of_face, np.diff(self._mesh.face_offsets))

        def total(values: _Floats, counted: npt.NDArray[np.bool_]) -> _Floats:
            counted = counted & (island >= 0)
            return np.bincount(island[counted], values[counted], len(area)).astype(np.float64)

        shown, inside = total(self._stretch, self._was_inside), total(self._weight, self._was_inside)
        mean = np.divide(shown, inside, out=np.zeros(len(area)), where=inside > 0.0)
        share = np.divide(total(self._weight, self._inside()), area, out=np.zeros(len(area)), where=area > 0.0)
        return mean * share

    def _inside(self) -> npt.NDArray[np.bool_]:
        """Return which corners (C,) are at vertices that lie inside islands."""
        is_inside = ~self._at_rim
        is_inside[self._seams()] = False
        return is_inside[self._mesh.corner_vertices]

    def _seams(self) -> npt.NDArray[np.int32]:
        """Return all that are left; of those to begin with, some cannot be taken back, such as edges of three faces."""
        others = self._start[~np.isin(edge_keys(self._start, len(self._mesh.vertices)), self._keys)]
        return np.concatenate([self._fixed, self._edges[self._is_seam].astype(np.int32), others])

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


def _stretch_of_cones(
    vertices: npt.NDArray[np.floating], offsets: npt.NDArray[np.integer], corners: npt.NDArray[np.integer]
) -> _Floats:
    """Return for each vertex (V,) by how much the angles around it are stretched where it lies inside an island.

    They add up to some t on the surface, and to 2 pi in the map. A cone that is unrolled evenly has a QC of 2 pi / t,
    or of t / 2 pi, which is this far above 1. The three vertices of a triangle add up. Where the surface is smooth, t
    nears 2 pi as faces get smaller; noise has the same angles at any size.
    """
    to_next = vertices[corners[next_corner(offsets)]] - vertices[corners]
    to_last = np.empty_like(to_next)
    to_last[next_corner(offsets)] = -to_next
    angle = np.arctan2(np.linalg.norm(np.cross(to_next, to_last), axis=1), (to_next * to_last).sum(axis=1))
    turns = np.bincount(corners, angle, len(vertices)) / (2.0 * np.pi)
    stretch = np.maximum(turns, 1.0 / turns) - 1.0
    return np.where(np.isfinite(stretch), stretch, 0.0)


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
