# SPDX-License-Identifier: GPL-3.0-or-later
"""From marked edges to the equations of `spectral_conformal.Constraints`, on the corners of a mesh.

Equations on corners apply to whichever chart has these corners, so seams need no special treatment: a mark applies to
both sides, but for a border that is marked all around: a closed loop cannot be straight. So the caps of a cylinder stay
free when its side becomes a rectangle.
"""

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from .. import native
from ..mesh.charts import corner_edge_keys, twins
from ..mesh.polygon_mesh import PolygonMesh
from .marks import AXIS, CROSSING, HORIZONTAL, SLANTED, VERTICAL

# Spacings of a grid.
FREE = 0
EVEN = 1
BY_LENGTH = 2


@dataclass(frozen=True)
class Marked:
    """The edges that one constraint marks.

    Attributes:
        marks: (C,) the mark of the edge from every corner to the next one, 0 for none.
        angle: of slanted edges, in radians.
        spacing: of the rows and columns of quads with four marked edges.
    """

    marks: np.ndarray
    angle: float = 0.0
    spacing: int = FREE


def equations(mesh: PolygonMesh, constraints: Iterable[Marked]) -> np.ndarray | None:
    """Return the equations of all constraints, (E, 4, 2) float64 as `Constraints.equations`; None for none."""
    following, loop = mesh.next_corner(), _border_loops(mesh)
    edge = np.unique(corner_edge_keys(mesh), return_inverse=True)[1].ravel()
    rows = [np.empty((0, 4, 2))]
    for each in constraints:
        each = replace(each, marks=np.where(_freed(each.marks, loop, edge), 0, each.marks))
        for mark, axis in ((HORIZONTAL, 1), (VERTICAL, 0)):
            corner = np.flatnonzero(each.marks == mark)
            rows.append(_rows((2 * corner + axis, 1.0), (2 * following[corner] + axis, -1.0)))
        corner = np.flatnonzero(each.marks == SLANTED)
        across = (-np.sin(each.angle), np.cos(each.angle))
        terms = [(2 * k + axis, sign * across[axis]) for axis in (0, 1) for k, sign in _ends(corner, following)]
        rows.append(_rows(*terms))
        if (each.marks >= AXIS).any():
            rows += _mirrored(mesh, each.marks == AXIS, each.marks == CROSSING)
        if each.spacing != FREE:
            rows.append(_spaced(mesh, each.marks, each.spacing == BY_LENGTH))
    result = np.concatenate(rows)
    return result if len(result) else None


def _border_loops(mesh: PolygonMesh) -> np.ndarray:
    """Return the number of the border loop of every corner's edge, (C,), below C; -1 inside of charts."""
    twin, following = twins(mesh), mesh.next_corner()
    border = np.flatnonzero((twin < 0) & mesh.selected_faces[mesh.face_of_corner()])
    after = following[border]
    while (inner := twin[after] >= 0).any():
        after[inner] = following[twin[after[inner]]]
    after = np.searchsorted(border, after)
    # The lowest of every loop, in steps that double.
    lowest = np.arange(len(border))
    for _ in range(len(border).bit_length()):
        lowest, after = np.minimum(lowest, lowest[after]), after[after]
    result = np.full(len(twin), -1)
    result[border] = lowest
    return result


def _freed(marks: np.ndarray, loop: np.ndarray, edge: np.ndarray) -> np.ndarray:
    """Return which corners, (C,) bool, are in a border loop of one mark whose edges all keep it on another side.

    `loop` (C,) is that of `_border_loops`, `edge` (C,) the number of every corner's edge.
    """
    corner = np.flatnonzero(loop >= 0)
    low, high = np.full(len(loop), AXIS), np.zeros(len(loop), dtype=marks.dtype)
    np.minimum.at(low, loop[corner], marks[corner])
    np.maximum.at(high, loop[corner], marks[corner])
    around = (loop >= 0) & ((low == high) & (low > 0) & (low < AXIS))[loop]
    alone = around & (np.bincount(edge[~around], minlength=len(loop))[edge] == 0)
    return around & ~np.isin(loop, loop[alone])


def _ends(corner: np.ndarray, following: np.ndarray) -> list[tuple[np.ndarray, float]]:
    return [(corner, 1.0), (following[corner], -1.0)]


def _rows(*terms: tuple[np.ndarray, "np.ndarray | float"]) -> np.ndarray:
    """Return equations of the same number of terms, each given as coordinates (E,) and coefficients."""
    result = np.zeros((len(terms[0][0]), 4, 2))
    for k, (coordinate, coefficient) in enumerate(terms):
        result[:, k, 0], result[:, k, 1] = coordinate, coefficient
    return result


def _mirrored(mesh: PolygonMesh, on_axis: np.ndarray, across: np.ndarray) -> list[np.ndarray]:
    """Return the equations of two halves that mirror each other, given the edges on the axis and those across it.

    They are found face by face, outward from the axis, up to seams and to faces whose images have another number of
    corners.
    """
    twin, following, previous = twins(mesh), mesh.next_corner(), mesh.previous_corner()
    size = np.diff(mesh.face_offsets)[mesh.face_of_corner()]
    image = np.full(len(twin), -1)  # the corner whose edge is the mirror image of this one's
    start = np.flatnonzero(on_axis & (twin >= 0))
    crossed = np.flatnonzero(across).tolist()
    open_pairs = deque([*zip(start.tolist(), twin[start].tolist()), *zip(crossed, crossed)])
    while open_pairs:
        one, other = open_pairs.popleft()
        if image[one] >= 0 or image[other] >= 0 or size[one] != size[other]:
            continue
        for _ in range(size[one]):
            image[one], image[other] = other, one
            if twin[one] >= 0 and twin[other] >= 0 and not on_axis[one]:
                open_pairs.append((int(twin[one]), int(twin[other])))
            # One face runs against the other.
            one, other = int(following[one]), int(previous[other])
    # The image of an edge runs the other way: the image of the corner where the edge starts is the end of that one.
    corner = np.flatnonzero(image >= 0)
    end = following[image[corner]]
    once = corner < end
    one, other = corner[once], end[once]
    both_on_axis = np.flatnonzero(on_axis)
    zero = np.unique(np.concatenate([both_on_axis, following[both_on_axis], corner[corner == end]]))
    return [
        _rows((2 * zero, np.ones(len(zero)))),
        _rows((2 * one, 1.0), (2 * other, 1.0)),
        _rows((2 * one + 1, 1.0), (2 * other + 1, -1.0)),
    ]


def _spaced(mesh: PolygonMesh, marks: np.ndarray, by_length: bool) -> np.ndarray:
    """Return equations that make the widths of columns and heights of rows even, or proportional to lengths in 3D."""
    twin, following, previous = twins(mesh), mesh.next_corner(), mesh.previous_corner()
    face, size = mesh.face_of_corner(), np.diff(mesh.face_offsets)
    counts = [np.bincount(face[marks == mark], minlength=len(size)) for mark in (HORIZONTAL, VERTICAL)]
    in_grid = ((size == 4) & (counts[0] == 2) & (counts[1] == 2))[face]
    points = mesh.vertices[mesh.corner_vertices]
    length = np.linalg.norm(points[following] - points, axis=1)
    rows = []
    for across, along, axis in ((VERTICAL, HORIZONTAL, 0), (HORIZONTAL, VERTICAL, 1)):
        # Neighbors across an edge along the axis have the same extent along it: one column or row.
        sides = in_grid & (marks == along)
        lane = _components(len(size), face, twin, sides)
        mean = np.bincount(lane[face[sides]], length[sides], len(size)) / np.maximum(
            np.bincount(lane[face[sides]], minlength=len(size)), 1
        )
        extent = np.where(mean > 0.0, mean, 1.0) if by_length else np.ones(len(size))
        corner = np.flatnonzero(in_grid & (marks == across) & (twin >= 0))
        corner = corner[in_grid[twin[corner]]]
        pair = lane[face[corner]] * len(size) + lane[face[twin[corner]]]
        _, first = np.unique(pair, return_index=True)
        # Up to the edge in this face, and on from it in the next, along the same line.
        end = corner[first]
        onward = following[twin[end]]
        here, there = extent[lane[face[end]]], extent[lane[face[onward]]]
        rows.append(
            _rows(
                (2 * end + axis, 1.0 / here),
                (2 * previous[end] + axis, -1.0 / here),
                (2 * following[onward] + axis, -1.0 / there),
                (2 * onward + axis, 1.0 / there),
            )
        )
    return np.concatenate(rows)


def _components(n: int, face: np.ndarray, twin: np.ndarray, through: np.ndarray) -> np.ndarray:
    """Return the number of the component of each of `n` faces, connected through the corners' edges."""
    corner = np.flatnonzero(through & (twin >= 0))
    corner = corner[through[twin[corner]]]
    pairs = np.stack([face[corner], face[twin[corner]]], axis=1)
    offsets = np.append(np.arange(n), n + 2 * np.arange(len(pairs) + 1))
    return native.measuring().connected(offsets, np.append(np.arange(n), pairs), n)[:n]
