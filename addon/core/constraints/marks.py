# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the edges that a constraint marks, from a selection.

A corner stands for the half-edge to the next corner of its face. The mark of an edge applies to both sides.
"""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .. import native
from ..errors import ReadableError
from ..mesh.charts import chart_of_face, corner_edge_keys, edge_keys, twins
from ..mesh.polygon_mesh import PolygonMesh
from ..words import texts
from ..words.translation import translate

# Marks of edges, the values of the attributes.
HORIZONTAL = 1
VERTICAL = 2
SLANTED = 3
AXIS = 4
# Of an edge that is its own mirror image: an axis passes through its middle.
CROSSING = 5

# Less than this, one degree, the eye does not see.
_PARALLEL = np.pi / 180.0

Edge = tuple[int, int]
Marks = dict[Edge, int]


def edges_of_corners(mesh: PolygonMesh) -> np.ndarray:
    """Return the vertices of the edge from every corner to the next, (C, 2), the lower one first."""
    return np.sort(mesh.sides(), axis=1)


def chains(mesh: PolygonMesh, edges: Sequence[Edge]) -> list[list[Edge]]:
    """Return the edges in chains: two that meet at a vertex are in one chain if no face has both."""
    faces_of: dict[Edge, set[int]] = {edge: set() for edge in edges}
    for edge, face in zip(map(tuple, edges_of_corners(mesh).tolist()), mesh.face_of_corner().tolist()):
        if edge in faces_of:
            faces_of[edge].add(face)
    at_vertex: dict[int, list[Edge]] = {}
    for edge in edges:
        for vertex in edge:
            at_vertex.setdefault(vertex, []).append(edge)
    left, result = dict.fromkeys(edges), []
    while left:
        chain = [next(iter(left))]
        del left[chain[0]]
        for edge in chain:
            for vertex in edge:
                for other in at_vertex[vertex]:
                    if other in left and not faces_of[edge] & faces_of[other]:
                        del left[other]
                        chain.append(other)
        result.append(chain)
    return result


def _corners(mesh: PolygonMesh, edges: Sequence[Edge]) -> np.ndarray:
    """Return the corners where the sides of edges begin."""
    return np.flatnonzero(np.isin(corner_edge_keys(mesh), edge_keys(mesh, edges)))


def of_visible_faces(mesh: PolygonMesh, marked: Marks) -> Marks:
    """Return the marks of edges that a selected face of the record has; others would mark nothing in the map."""
    of_faces = corner_edge_keys(mesh)[mesh.selected_faces[mesh.face_of_corner()]]
    has_face = np.isin(edge_keys(mesh, list(marked)), of_faces).tolist()
    return dict(itertools.compress(marked.items(), has_face))


def directions(mesh: PolygonMesh, edges: Sequence[Edge]) -> np.ndarray:
    """Return the sides of the edges in the map as complex numbers; without a map, as seen from the front."""
    chosen = _corners(mesh, edges)
    following = mesh.next_corner()[chosen]
    uv = mesh.isotropic_uv()
    if uv is not None and np.isfinite(uv[chosen]).all() and np.isfinite(uv[following]).all():
        across = uv[following] - uv[chosen]
        if np.abs(across).max(initial=0.0) > 0.0:
            return across[:, 0] + 1j * across[:, 1]
    space = mesh.vertices[mesh.corner_vertices[following]] - mesh.vertices[mesh.corner_vertices[chosen]]
    return np.hypot(space[:, 0], space[:, 1]) + 1j * space[:, 2]


def nearest_direction(mesh: PolygonMesh, chain: Sequence[Edge]) -> int:
    """Return whether a chain lies nearer to horizontal or to vertical."""
    across = directions(mesh, chain)
    return HORIZONTAL if np.abs(across.real).sum() >= np.abs(across.imag).sum() else VERTICAL


def own_angle(mesh: PolygonMesh, chain: Sequence[Edge]) -> float:
    """Return the angle of a chain in radians, -pi/2 to pi/2: of the mean of its sides, without orientation.

    Raises:
        ReadableError: an edge is on a seam, and its sides do not lie at the same angle.
    """
    across = directions(mesh, chain)
    doubled = across**2 / np.maximum(np.abs(across), 1e-300)
    # Sides at an angle add up to less, by its cosine.
    edge = np.unique(corner_edge_keys(mesh)[_corners(mesh, chain)], return_inverse=True)[1].ravel()
    together = np.hypot(np.bincount(edge, doubled.real), np.bincount(edge, doubled.imag))
    if (together < np.cos(_PARALLEL) * np.bincount(edge, np.abs(doubled))).any():
        raise ReadableError(
            translate("Edges on a seam lie at another angle in each island; straighten them horizontally or vertically")
        )
    return float(np.angle(doubled.sum()) / 2.0)


def straight(mesh: PolygonMesh, edges: Sequence[Edge], direction: int | None) -> Marks:
    """Mark edges in one direction; None for the one nearest to each of their chains."""
    if direction is not None:
        return dict.fromkeys(edges, direction)
    return {edge: mark for chain in chains(mesh, edges) for mark in [nearest_direction(mesh, chain)] for edge in chain}


class Refused(NamedTuple):
    """Parts of a selection that get no marks: the number of each face's part, (F,) int, -1 for others; and why."""

    part: np.ndarray
    reasons: tuple[str, ...]


def grids(mesh: PolygonMesh, faces: np.ndarray) -> tuple[Marks, Refused]:
    """Mark all edges of the quads among `faces` (F,) bool as rows and columns, by the nearest direction.

    Parts of connected quads that cannot form a grid are refused.
    """
    quads = faces & (np.diff(mesh.face_offsets) == 4)
    part = chart_of_face(replace(mesh, seam_edges=mesh.seam_edges[:0]), quads)
    return _by_parts(part, lambda own: _grid(mesh, own))


def _grid(mesh: PolygonMesh, faces: np.ndarray) -> Marks:
    corners = mesh.corner_vertices[mesh.face_offsets[:-1][faces][:, None] + np.arange(4)]
    try:
        found = native.spectral_conformal().Constraints.grid(corners)
    except ValueError as error:
        raise ReadableError(translate(texts.NO_GRID)) from error
    rows, columns = ([tuple(sorted(edge)) for edge in chains] for chains in (found.horizontal, found.vertical))
    along = directions(mesh, rows)
    if np.abs(along.real).sum() < np.abs(along.imag).sum():
        rows, columns = columns, rows
    return {**dict.fromkeys(rows, HORIZONTAL), **dict.fromkeys(columns, VERTICAL)}


def rectangles(mesh: PolygonMesh, faces: np.ndarray, corners: Sequence[int]) -> tuple[Marks, Refused]:
    """Mark the borders of the islands, or blocks inside islands, of `faces` (F,) bool as the sides of rectangles.

    Four of the vertices `corners` on the border of an island become its corners, otherwise those where the surface
    turns most. An island is refused if it has other than one border, or one with less than four vertices, or if a side
    of it already has the other direction in another island or on the other side of a seam.
    """
    twin = twins(mesh)
    return _by_parts(chart_of_face(mesh, faces), lambda own: _rectangle(mesh, twin, own, corners))


def _rectangle(mesh: PolygonMesh, twin: np.ndarray, faces: np.ndarray, corners: Sequence[int]) -> Marks:
    following = mesh.next_corner()
    loop = _border_loop(mesh, twin, faces)
    chosen = np.flatnonzero(np.isin(mesh.corner_vertices[loop], corners))
    if len(chosen) != 4:
        chosen = np.sort(np.argsort(-_turning(mesh, twin, faces, loop), kind="stable")[:4])
    sides = [loop[first:last] for first, last in itertools.pairwise(chosen)]
    sides.append(np.append(loop[chosen[3] :], loop[: chosen[0]]))
    edges = [
        [tuple(sorted(pair)) for pair in zip(mesh.corner_vertices[side], mesh.corner_vertices[following[side]])]
        for side in sides
    ]
    edges = [[(int(a), int(b)) for a, b in side] for side in edges]
    first = nearest_direction(mesh, [*edges[0], *edges[2]])
    marks: Marks = {}
    for index, side in enumerate(edges):
        _merge(marks, dict.fromkeys(side, first if index % 2 == 0 else HORIZONTAL + VERTICAL - first))
    return marks


def _by_parts(part: np.ndarray, find: Callable[[np.ndarray], Marks]) -> tuple[Marks, Refused]:
    """Join what `find` makes of the faces (F,) bool of each part; parts for which it raises are refused."""
    marks: Marks = {}
    refused: dict[int, str] = {}
    for number in range(int(part.max(initial=-1)) + 1):
        try:
            _merge(marks, find(part == number))
        except ReadableError as error:
            refused[number] = str(error)
    faces = np.where(np.isin(part, list(refused)), part, -1)
    return marks, Refused(faces, tuple(dict.fromkeys(refused.values())))


def _merge(marks: Marks, more: Marks) -> None:
    """Add `more` marks; raise a ReadableError if an edge has another mark already."""
    if any(marks.get(edge, mark) != mark for edge, mark in more.items()):
        raise ReadableError(translate(texts.TWO_DIRECTIONS))
    marks.update(more)


def _border_loop(mesh: PolygonMesh, twin: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the corners whose edges are the border of a chart, in order."""
    following, inside = mesh.next_corner(), faces[mesh.face_of_corner()]
    twin = np.where(inside & (twin >= 0) & inside[twin], twin, -1)
    border = np.flatnonzero(inside & (twin < 0))
    loop = [int(border[0])] if len(border) else []
    while loop:
        corner = int(following[loop[-1]])
        while twin[corner] >= 0:
            corner = int(following[twin[corner]])
        if corner == loop[0]:
            break
        loop.append(corner)
    if len(loop) < 4 or len(loop) != len(border):
        raise ReadableError(translate(texts.NO_RECTANGLE))
    return np.array(loop)


def _turning(mesh: PolygonMesh, twin: np.ndarray, faces: np.ndarray, loop: np.ndarray) -> np.ndarray:
    """Return how much the border turns at each corner of its `loop`: pi minus the angles of the faces there."""
    following, previous = mesh.next_corner(), mesh.previous_corner()
    inside = faces[mesh.face_of_corner()]
    here = mesh.vertices[mesh.corner_vertices]
    ahead, back = here[following] - here, here[previous] - here
    lengths = np.linalg.norm(ahead, axis=1) * np.linalg.norm(back, axis=1)
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", ahead, back) / np.maximum(lengths, 1e-300), -1.0, 1.0))
    result = []
    for corner in loop.tolist():
        total, at = angle[corner], corner
        # From the border edge that leaves the vertex to the one that arrives.
        while twin[previous[at]] >= 0 and inside[twin[previous[at]]]:
            at = twin[previous[at]]
            total += angle[at]
        result.append(np.pi - total)
    return np.array(result)
