"""Linear constraints that a map meets exactly: straight chains, rectangles, grids and mirror symmetry."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._native import InvalidMeshError

Chains = Sequence[Sequence[int]]
Pairs = Sequence[tuple[int, int]]


@dataclass(frozen=True)
class Constraints:
    """What a map must meet exactly, by vertex; see `parameterize`. `+` combines constraints.

    Coordinates that a constraint ties together are one unknown of the eigenproblem (Eq. 5). So there are no weights,
    and the map meets every constraint to rounding.
    """

    horizontal: Chains = ()
    """Chains of vertices with one v each: rows."""
    vertical: Chains = ()
    """Chains of vertices with one u each: columns."""
    mirrored: Pairs = ()
    """Pairs (a, b) with u_a = -u_b and v_a = v_b: mirrored about the upright axis u = 0. (a, a) puts a vertex on it."""

    def __add__(self, other: Constraints) -> Constraints:
        """Return the constraints of both."""
        if not isinstance(other, Constraints):
            return NotImplemented
        return Constraints(
            (*self.horizontal, *other.horizontal),
            (*self.vertical, *other.vertical),
            (*self.mirrored, *other.mirrored),
        )

    @classmethod
    def rectangle(cls, faces: Iterable[Iterable[int]], corners: Sequence[int]) -> Constraints:
        """Return constraints that make a patch with one border a rectangle with a free aspect.

        Args:
            faces: polygons of the patch, wound alike.
            corners: four vertices of its border, in the order of the faces' winding. The sides from the first to the
                second corner and from the third to the fourth become horizontal, the others vertical.

        Raises:
            ValueError: there are not four different corners.
            InvalidMeshError: the border is not one loop, or does not pass the corners in this order.
        """
        if len(set(corners)) != 4:
            raise ValueError(f"corners must be four different vertices, not {list(corners)}.")
        loop = _border_loop([list(map(int, face)) for face in faces])
        missing = [corner for corner in corners if corner not in loop]
        if missing:
            raise InvalidMeshError(f"Vertex {missing[0]} is not on the border; choose corners on the border.")
        start = loop.index(corners[0])
        loop = [*loop[start:], *loop[: start + 1]]
        ends = [0, *(loop.index(corner) for corner in corners[1:]), len(loop) - 1]
        if ends != sorted(ends):
            raise InvalidMeshError(
                f"The border does not pass the corners in the order {list(corners)}; give them in the faces' winding."
            )
        sides = [loop[a : b + 1] for a, b in zip(ends[:-1], ends[1:], strict=True)]
        return cls(horizontal=(sides[0], sides[2]), vertical=(sides[1], sides[3]))

    @classmethod
    def grid(cls, quads: npt.ArrayLike) -> Constraints:
        """Return constraints that make rows and columns of quads straight; the map chooses their spacing.

        Args:
            quads: (Q, 4) vertices of quads connected by edges. The first edge of the first becomes horizontal.

        Raises:
            InvalidMeshError: rows and columns cannot be told apart, as around an inner vertex of three or five quads.
        """
        rows = np.asarray(quads)
        if rows.ndim != 2 or rows.shape[1] != 4:
            raise ValueError(f"quads must have the shape (Q, 4), not {rows.shape}.")
        edges = [[tuple(sorted((int(q[i]), int(q[(i + 1) % 4])))) for i in range(4)] for q in rows]
        quads_at: dict[tuple[int, ...], list[int]] = {}
        for number, around in enumerate(edges):
            for edge in around:
                quads_at.setdefault(edge, []).append(number)
        is_horizontal: dict[tuple[int, ...], bool] = {}
        for first in range(len(edges)):
            if edges[first][0] in is_horizontal:
                continue
            is_horizontal[edges[first][0]] = True
            queue = [first]
            while queue:
                around = edges[queue.pop()]
                known = next(i for i in range(4) if around[i] in is_horizontal)
                for i in range(4):
                    asked = is_horizontal[around[known]] ^ bool((i - known) % 2)
                    if around[i] not in is_horizontal:
                        is_horizontal[around[i]] = asked
                        queue += quads_at[around[i]]
                    elif is_horizontal[around[i]] != asked:
                        a, b = around[i]
                        raise InvalidMeshError(
                            f"The edge from vertex {a} to {b} would be in a row and in a column; leave out quads "
                            "around vertices where other than four meet."
                        )
        return cls(
            horizontal=[edge for edge, flat in is_horizontal.items() if flat],
            vertical=[edge for edge, flat in is_horizontal.items() if not flat],
        )


def _border_loop(faces: list[list[int]]) -> list[int]:
    sides = {(a, b) for face in faces for a, b in zip(face, [*face[1:], face[0]], strict=True)}
    following: dict[int, int] = {}
    for a, b in sides:
        if (b, a) in sides:
            continue
        if a in following:
            raise InvalidMeshError(f"The border touches itself at vertex {a}; choose faces whose border is one loop.")
        following[a] = b
    if not following:
        raise InvalidMeshError("The faces have no border; mark seams, or choose fewer faces.")
    first = min(following)
    loop = [first]
    while (vertex := following.get(loop[-1], first)) != first:
        loop.append(vertex)
    if len(loop) != len(following):
        raise InvalidMeshError("The faces have several borders; a rectangle has one.")
    return loop


def shared_unknowns(
    constraints: Constraints | None, n_vertices: int, triangles: npt.NDArray[np.integer]
) -> tuple[list[int], list[int], int] | None:
    """Return the unknown (2V,) and the sign (2V,) of each coordinate (u and v in turn), and the number of unknowns.

    Coordinates that are 0 have the unknown -1. None without constraints.

    Raises:
        TypeError, ValueError: the constraints are not as described there.
        InvalidMeshError: they contradict each other, so that an edge or a triangle would have no extent.
    """
    if constraints is None:
        return None
    if not isinstance(constraints, Constraints):
        raise TypeError(f"constraints must be Constraints, not a {type(constraints).__name__}.")
    ties = _Ties(2 * n_vertices)
    for name, axis, chains in (("horizontal", 1, constraints.horizontal), ("vertical", 0, constraints.vertical)):
        for chain in chains:
            vertices = _vertices(chain, name, n_vertices)
            for a, b in zip(vertices[:-1], vertices[1:], strict=True):
                ties.tie(2 * a + axis, 2 * b + axis, 1)
    for pair in constraints.mirrored:
        vertices = _vertices(pair, "mirrored", n_vertices)
        if len(vertices) != 2:
            raise ValueError(f"mirrored must hold pairs of vertices, but has {list(pair)}.")
        a, b = vertices
        ties.tie(2 * a, 2 * b, -1)
        ties.tie(2 * a + 1, 2 * b + 1, 1)
    unknown, sign, count = ties.numbered()
    if count == 2 * n_vertices:
        return None
    _check_extent(unknown.reshape(-1, 2), sign.reshape(-1, 2), triangles)
    return unknown.tolist(), sign.tolist(), count


def _vertices(chain: Iterable[int], name: str, n_vertices: int) -> list[int]:
    array = _arguments.checked_vertex_list(chain, name)
    for vertex in array:
        if not 0 <= vertex < n_vertices:
            raise ValueError(f"{name} names vertex {vertex}, but there are {n_vertices} vertices.")
    return array


class _Ties:
    """Coordinates that are equal, opposite or 0: a union-find with signs."""

    def __init__(self, n: int) -> None:
        self._parent = np.arange(n)
        self._sign = np.ones(n, dtype=np.int8)
        self._is_zero = np.zeros(n, dtype=bool)

    def _root(self, i: int) -> tuple[int, int]:
        path = []
        while self._parent[i] != i:
            path.append(i)
            i = int(self._parent[i])
        sign = 1
        for j in reversed(path):
            sign *= int(self._sign[j])
            self._parent[j], self._sign[j] = i, sign
        return i, sign

    def tie(self, i: int, j: int, sign: int) -> None:
        (a, sign_a), (b, sign_b) = self._root(i), self._root(j)
        relative = sign_a * sign_b * sign
        if a == b:
            self._is_zero[a] |= relative < 0
            return
        a, b = min(a, b), max(a, b)
        self._parent[b], self._sign[b] = a, relative
        self._is_zero[a] |= self._is_zero[b]

    def numbered(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int8], int]:
        roots = [self._root(i) for i in range(len(self._parent))]
        root = np.array([r for r, _ in roots])
        sign = np.array([s for _, s in roots], dtype=np.int8)
        free = np.unique(root[~self._is_zero[root]])
        number = np.full(len(root), -1)
        number[free] = np.arange(len(free))
        return number[root], sign, len(free)


def _check_extent(
    unknown: npt.NDArray[np.int64], sign: npt.NDArray[np.int8], triangles: npt.NDArray[np.integer]
) -> None:
    """Raise InvalidMeshError for a triangle whose corners share a coordinate, or two of them both."""
    signed = unknown * 2 + (sign < 0)
    signed[unknown < 0] = -1
    corners = signed[triangles]
    same = [(corners[:, k] == corners[:, (k + 1) % 3]) for k in range(3)]
    for k in range(3):
        collapsed = np.flatnonzero(same[k].all(axis=1))
        if len(collapsed):
            a, b = (int(v) for v in triangles[collapsed[0]][[k, (k + 1) % 3]])
            raise InvalidMeshError(
                f"The constraints give vertices {a} and {b} of one edge the same position; remove one of them."
            )
    flat = np.flatnonzero((same[0] & same[1]).any(axis=1))
    if len(flat):
        a, b, c = (int(v) for v in triangles[flat[0]])
        raise InvalidMeshError(
            f"The constraints put all corners of the triangle of vertices {a}, {b} and {c} on one line; remove one of "
            "them."
        )
