# SPDX-License-Identifier: GPL-3.0-or-later
"""What live unwrapping needs apart from Blender: the charts around a change, and the map for moving pins.

Edges are vertex pairs in any order; `visible` (F,) bool are the faces that count, the others are as if deleted.
"""

import numpy as np

from . import native
from .mesh import PolygonMesh

# Samples kept of one chart: every pin that moves by itself needs one more.
_MOST_SAMPLES = 12
# Pins are single precision numbers.
_PIN_TOLERANCE = 1e-6


def chart_of_face(mesh: PolygonMesh, visible: np.ndarray) -> np.ndarray:
    """Return the chart of every face, (F,) intp, -1 for faces that are not visible; the numbers have gaps.

    Charts end at seams and at edges that do not have two faces.
    """
    face = mesh.face_of_corner()
    keys = _corner_edges(mesh)
    usable = visible[face] & ~np.isin(keys, _keys(mesh, mesh.seam_edges))
    order = np.flatnonzero(usable)
    order = order[np.argsort(keys[order], kind="stable")]
    _, first, count = np.unique(keys[order], return_index=True, return_counts=True)
    first = first[count == 2]
    a, b = face[order[first]], face[order[first + 1]]
    chart = np.arange(len(visible))
    while True:
        low, high = np.minimum(chart[a], chart[b]), np.maximum(chart[a], chart[b])
        if np.array_equal(low, high):
            return np.where(visible, chart, -1)
        np.minimum.at(chart, high, low)
        while not np.array_equal(chart, chart[chart]):
            chart = chart[chart]


def changed_edges(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return the edges, (N, 2), that stand in one of two edge lists only."""
    edges = np.vstack([np.unique(np.sort(edges, axis=1), axis=0) for edges in (before, after)])
    unique, count = np.unique(edges, axis=0, return_counts=True)
    return unique[count == 1]


def faces_of_charts_at(mesh: PolygonMesh, visible: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return which faces, (F,) bool, belong to a chart that has one of the `edges`."""
    chart = chart_of_face(mesh, visible)
    beside = np.zeros(len(visible), dtype=bool)
    beside[mesh.face_of_corner()[np.isin(_corner_edges(mesh), _keys(mesh, edges))]] = True
    return visible & np.isin(chart, chart[beside & visible])


def _corner_edges(mesh: PolygonMesh) -> np.ndarray:
    """Return the key of the edge from every corner to the next one of its face, (C,)."""
    return _keys(mesh, np.stack([mesh.corner_vertices, mesh.corner_vertices[mesh.next_corner()]], axis=1))


def _keys(mesh: PolygonMesh, edges: np.ndarray) -> np.ndarray:
    ends = np.sort(np.asarray(edges, dtype=np.int64), axis=1)
    return ends[:, 0] * len(mesh.vertices) + ends[:, 1]


class PinnedChart:
    """The maps of one chart with the same pins in changing places.

    The least squares conformal map is a complex linear function of its pins. So maps already solved give, without a
    solve, the map for every place of the pins that is a complex linear combination of theirs: a second and third place
    are enough for all further ones along which the same pins are dragged.

    Attributes:
        corners: (N,) intp, the corners of the chart.
        pinned: (N,) bool, which of them are pinned.
        n_pins: number of pinned points.
    """

    def __init__(self, mesh: PolygonMesh, faces: np.ndarray, pinned: np.ndarray, uv: np.ndarray) -> None:
        """Take the chart of the `faces` (F,) bool, with pins where the corners' flags `pinned` (C,) say so.

        `uv` (C, 2) tells which pinned corners of a vertex are one point.
        """
        self._mesh = mesh
        self._faces = faces
        self.corners = np.flatnonzero(faces[mesh.face_of_corner()])
        self.pinned = pinned[self.corners]
        pins = self.corners[self.pinned]
        points = np.column_stack([mesh.corner_vertices[pins], uv[pins]])
        self.n_pins = len(np.unique(points, axis=0))
        self._isotropy = 1.0 / mesh.from_isotropic_uv(np.ones((1, 2)))
        self._places: list[np.ndarray] = []
        self._maps: list[np.ndarray] = []

    def map(self, start: np.ndarray, now: np.ndarray) -> np.ndarray | None:
        """Return the map, (N, 2) at `corners`, for the pins as they stand in `now` (C, 2); None if there is none.

        Pins back where they are in `start`, (C, 2), give `start` back. One pin alone takes its chart along.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        start, places = start[self.corners], now[self.corners][self.pinned]
        if np.array_equal(places, start[self.pinned]):
            return start
        # A script may move a pin to a place that is none, which no map can have.
        if not (np.isfinite(places).all() and np.isfinite(start[self.pinned]).all()):
            return None
        if self.n_pins == 1:
            return start + (places[0] - start[self.pinned][0])
        found = self._combined(places)
        if found is None:
            found = self._solved(now)
        if found is not None:
            found[self.pinned] = places
        return found

    def _combined(self, places: np.ndarray) -> np.ndarray | None:
        """Return the map as a combination of those known, None if the `places` of the pins are not one of theirs."""
        if not self._places:
            return None
        target = _complex(places * self._isotropy)
        # With all pins in one place the whole map is there.
        basis = np.stack([*self._places, np.ones_like(target)], axis=1)
        factors = np.linalg.lstsq(basis, target, rcond=_PIN_TOLERANCE)[0]
        if np.abs(basis @ factors - target).max() > _PIN_TOLERANCE * np.abs(target).max():
            return None
        points = np.stack([*self._maps, np.ones_like(self._maps[0])], axis=1) @ factors
        return np.stack([points.real, points.imag], axis=1) / self._isotropy

    def _solved(self, now: np.ndarray) -> np.ndarray | None:
        pins = self.corners[self.pinned]
        places = now[pins] * self._isotropy
        corners = len(self._mesh.corner_vertices)
        corner_uv, pinned = np.zeros((corners, 2)), np.zeros(corners, dtype=bool)
        corner_uv[pins], pinned[pins] = places, True
        try:
            result = native.spectral_conformal().unwrap(
                self._mesh.vertices,
                self._mesh.face_offsets,
                self._mesh.corner_vertices,
                seam_edges=self._mesh.seam_edges,
                selected_faces=self._faces,
                corner_uv=corner_uv,
                pinned_corners=pinned,
            )
        except ValueError:
            return None
        if not result.solved_corners[self.corners].all() or len(result.charts) != 1:
            return None
        uv = result.uv[self.corners].astype(np.float64)
        self._places = [*self._places, _complex(places)][-_MOST_SAMPLES:]
        self._maps = [*self._maps, _complex(uv)][-_MOST_SAMPLES:]
        return uv / self._isotropy


def _complex(points: np.ndarray) -> np.ndarray:
    return points[:, 0] + 1j * points[:, 1]
