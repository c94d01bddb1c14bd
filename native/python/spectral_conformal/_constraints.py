"""Linear constraints that a map meets exactly: straight chains, rectangles, grids and mirror symmetry."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeVar, get_args

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._native import InvalidMeshError

Chains = Sequence[Sequence[int]]
Pairs = Sequence[tuple[int, int]]
Kind = Literal["vertices", "corners"]
_Value = TypeVar("_Value")
_Members = tuple[list[int], list[int], list[float], list[tuple[int, float]]]


@dataclass(frozen=True)
class Constraints:
    """What a map must meet exactly; see `parameterize`. `+` combines constraints of one kind.

    All are linear equations on the coordinates. The map is x = P w, where P spans the solutions of the homogeneous ones
    and w solves the eigenproblem P^T L P w = lambda P^T B P w (Eq. 5). So there are no weights, and the map meets every
    constraint to rounding. Two or more pins or fixed vertices, or `held` coordinates, hold a map x = P w + c exactly,
    which minimizes the conformal energy (LSCM); the other constraints then hold relative to a free origin. Those that
    contradict held coordinates are dropped, and counted by the step "unmet_constraints"; of several values of one
    coordinate, a pin's or the first one holds.

    Numbers are vertices, or with `of="corners"` corners of the mesh, which distinguish the sides of a seam. A function
    on a `Mesh` refuses a vertex to which cuts give several UVs.
    """

    horizontal: Chains = ()
    """Chains of vertices with one v each: rows."""
    vertical: Chains = ()
    """Chains of vertices with one u each: columns."""
    mirrored: Pairs = ()
    """Pairs (a, b) with u_a = -u_b and v_a = v_b: mirrored about the upright axis u = 0. (a, a) puts a vertex on it.
    Two triangles that mirror each other enter L with the geometric mean of their metrics, which distorts both alike,
    and as little as any mirrored map can."""
    slanted: Sequence[tuple[Sequence[int], float]] = ()
    """(chain, angle): the vertices lie on one line with this angle in radians, counterclockwise from the right."""
    equations: npt.ArrayLike | None = None
    """(E, 4, 2): equations sum_k a_k x_k = 0 of up to four terms (coordinate, a_k), where coordinate 2 i is u and
    2 i + 1 is v of vertex i; unused terms have a_k = 0."""
    held: npt.ArrayLike | None = None
    """(H, 2): single coordinates that stay, (coordinate, value), numbered as in `equations`."""
    of: Kind = "vertices"
    """What the numbers are: "vertices" or "corners"."""

    def __post_init__(self) -> None:
        """Check `of`.

        Raises:
            ValueError: it is neither.
        """
        if not isinstance(self.of, str) or self.of not in get_args(Kind):
            raise ValueError(f"of must be 'vertices' or 'corners', not {self.of!r}.")

    def __add__(self, other: Constraints) -> Constraints:
        """Return the constraints of both."""
        if not isinstance(other, Constraints):
            return NotImplemented
        if self.of != other.of:
            raise ValueError(f"Constraints of {self.of} and of {other.of} cannot be combined.")
        return Constraints(
            (*self.horizontal, *other.horizontal),
            (*self.vertical, *other.vertical),
            (*self.mirrored, *other.mirrored),
            (*self.slanted, *other.slanted),
            _joined(self.equations, other.equations),
            _joined(self.held, other.held),
            self.of,
        )

    @classmethod
    def rectangle(cls, faces: Iterable[Iterable[int]], corners: Sequence[int], of: Kind = "vertices") -> Constraints:
        """Return constraints that make a patch with one border a rectangle with a free aspect.

        Args:
            faces: polygons of the patch, wound alike.
            corners: four vertices of its border, in the order of the faces' winding. The sides from the first to the
                second corner and from the third to the fourth become horizontal, the others vertical.
            of: what the numbers in `faces` and `corners` are.

        Raises:
            ValueError: there are not four different corners.
            InvalidMeshError: the border is not one loop, or does not pass the corners in this order.
        """
        corners = _arguments.checked_vertex_list(corners, "corners")
        if len(set(corners)) != 4:
            raise ValueError(f"corners must be four different vertices, not {corners}.")
        loop = _border_loop([_arguments.checked_vertex_list(face, "faces") for face in _iterable(faces, "faces")])
        missing = [corner for corner in corners if corner not in loop]
        if missing:
            raise InvalidMeshError(f"Vertex {missing[0]} is not on the border; choose corners on the border.")
        start = loop.index(corners[0])
        loop = [*loop[start:], *loop[: start + 1]]
        ends = [0, *(loop.index(corner) for corner in corners[1:]), len(loop) - 1]
        if ends != sorted(ends):
            raise InvalidMeshError(
                f"The border does not pass the corners in the order {corners}; give them in the faces' winding."
            )
        sides = [loop[a : b + 1] for a, b in zip(ends[:-1], ends[1:])]
        return cls(horizontal=(sides[0], sides[2]), vertical=(sides[1], sides[3]), of=of)

    @classmethod
    def grid(cls, quads: npt.ArrayLike, of: Kind = "vertices") -> Constraints:
        """Return constraints that make rows and columns of quads straight; the map chooses their spacing.

        Args:
            quads: (Q, 4) vertices of quads connected by edges. The first edge of the first becomes horizontal.
            of: what the numbers are; those of one point must be equal.

        Raises:
            InvalidMeshError: rows and columns are not distinct, as around an inner vertex of three or five quads.
        """
        rows = _arguments.checked_integers(quads, "quads")
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
                    expected = is_horizontal[around[known]] ^ bool((i - known) % 2)
                    if around[i] not in is_horizontal:
                        is_horizontal[around[i]] = expected
                        queue += quads_at[around[i]]
                    elif is_horizontal[around[i]] != expected:
                        a, b = around[i]
                        raise InvalidMeshError(
                            f"The edge from vertex {a} to {b} would be in a row and in a column; leave out quads "
                            "around inner vertices where not exactly four meet."
                        )
        return cls(
            horizontal=[edge for edge, flat in is_horizontal.items() if flat],
            vertical=[edge for edge, flat in is_horizontal.items() if not flat],
            of=of,
        )


def _joined(one: npt.ArrayLike | None, other: npt.ArrayLike | None) -> npt.ArrayLike | None:
    return other if one is None else one if other is None else np.concatenate([np.asarray(one), np.asarray(other)])


def _border_loop(faces: list[list[int]]) -> list[int]:
    sides = {(a, b) for face in faces for a, b in zip(face, [*face[1:], face[0]])}
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


class Numbers(NamedTuple):
    """The vertices, or the corners, of the mesh that a map belongs to.

    Attributes:
        number: how many there are.
        point: the points of the map that these are, (n,) from (n,), -1 for those in no face, whose equations have no
            effect; None if they have the same numbers.
    """

    number: int
    point: Callable[[npt.NDArray[np.int64]], npt.NDArray[np.integer]] | None = None


def equations(constraints: Constraints | None, vertices: Numbers, corners: Numbers) -> _Members | None:
    """Return the members of the native LinearEquations on the coordinates of a map's points; None for none.

    Raises:
        TypeError, ValueError: the constraints are not as described there.
    """
    if constraints is None:
        return None
    if not isinstance(constraints, Constraints):
        raise TypeError(f"constraints must be Constraints, not {type(constraints).__name__}.")
    of = constraints.of
    n, point = vertices if of == "vertices" else corners
    rows, held = _rows_of(constraints, n, of), _checked_held(constraints.held, n, of)
    if point is not None:
        terms = rows[..., 1] != 0
        coordinates = np.concatenate([rows[terms][:, 0], held[:, 0]]).astype(np.int64)
        # Negative without a point.
        moved = 2 * point(coordinates // 2).astype(np.int64) + coordinates % 2
        rows[terms, 0], held[:, 0] = np.split(moved, [int(terms.sum())])
        rows, held = rows[(~terms | (rows[..., 0] >= 0)).all(axis=1)], held[held[:, 0] >= 0]
    return _members(rows, list(zip(held[:, 0].astype(np.int64).tolist(), held[:, 1].tolist())))


def _rows_of(constraints: Constraints, n: int, of: Kind) -> npt.NDArray[np.float64]:
    """Return the homogeneous equations, (E, 4, 2), in the numbers of the constraints."""
    rows: list[npt.NDArray[np.float64]] = []
    for name, axis, chains in (("horizontal", 1, constraints.horizontal), ("vertical", 0, constraints.vertical)):
        steps = _steps(chains, name, n, of)
        own = np.zeros((len(steps), 4, 2))
        own[:, :2, 0] = 2 * steps + axis
        own[:, :2, 1] = 1.0, -1.0
        rows.append(own)
    for each in _iterable(constraints.slanted, "slanted"):
        if not isinstance(each, Sequence) or len(each) != 2:
            raise TypeError(f"slanted must hold pairs of a chain and its angle, but has {each!r}.")
        chain, angle = each
        if not math.isfinite(_arguments.real(angle, "the angle of slanted")):
            raise ValueError(f"slanted needs a finite angle for each chain, not {angle!r}.")
        u, v = -math.sin(angle), math.cos(angle)
        edges = pairwise(_indices(chain, "slanted", n, of))
        rows.append(_rows([[(2 * a, u), (2 * b, -u), (2 * a + 1, v), (2 * b + 1, -v)] for a, b in edges]))
    pairs = []
    for pair in _iterable(constraints.mirrored, "mirrored"):
        both = _indices(pair, "mirrored", n, of)
        if len(both) != 2:
            raise ValueError(f"mirrored must hold pairs of {of}, but has {list(pair)}.")
        pairs.append(both)
    rows.append(_rows([[(2 * a, 1.0), (2 * b, 1.0)] for a, b in pairs]))
    rows.append(_rows([[(2 * a + 1, 1.0), (2 * b + 1, -1.0)] for a, b in pairs if a != b]))
    if constraints.equations is not None:
        rows.append(_checked_equations(constraints.equations, n, of))
    return np.concatenate(rows)


def _rows(terms: list[list[tuple[int, float]]]) -> npt.NDArray[np.float64]:
    """Return equations of at most four terms as (E, 4, 2)."""
    result = np.zeros((len(terms), 4, 2))
    if terms:
        given = np.array(terms, dtype=np.float64)
        result[:, : given.shape[1]] = given
    return result


def _checked_equations(given: npt.ArrayLike, n: int, of: Kind) -> npt.NDArray[np.float64]:
    rows = _arguments.checked_reals(given, "equations")
    if rows.ndim != 3 or rows.shape[1:] != (4, 2):
        raise ValueError(f"equations must have the shape (E, 4, 2), not {rows.shape}.")
    coordinate = rows[..., 0]
    if not np.isfinite(rows).all() or (coordinate != np.floor(coordinate)).any():
        raise ValueError("equations must hold whole coordinates and finite coefficients.")
    if len(rows) and (coordinate.min() < 0 or coordinate.max() >= 2 * n):
        raise ValueError(f"equations name a coordinate that is not one of the 2 x {n} of all {of}.")
    return rows.astype(np.float64)


def _checked_held(given: npt.ArrayLike | None, n: int, of: Kind) -> npt.NDArray[np.float64]:
    rows = np.zeros((0, 2)) if given is None else _arguments.checked_reals(given, "held").astype(np.float64)
    if rows.ndim != 2 or rows.shape[1] != 2:
        raise ValueError(f"held must have the shape (H, 2), not {rows.shape}.")
    if not np.isfinite(rows).all() or (rows[:, 0] != np.floor(rows[:, 0])).any():
        raise ValueError("held must have whole coordinates and finite values.")
    if len(rows) and (rows[:, 0].min() < 0 or rows[:, 0].max() >= 2 * n):
        raise ValueError(f"held names a coordinate that is not one of the 2 x {n} of all {of}.")
    return rows.copy()


def _members(rows: npt.NDArray[np.float64], held: list[tuple[int, float]]) -> _Members | None:
    is_term = rows[..., 1] != 0
    rows, is_term = rows[is_term.any(axis=1)], is_term[is_term.any(axis=1)]
    if not len(rows) and not held:
        return None
    start = np.append(0, np.cumsum(is_term.sum(axis=1)))
    terms = rows[is_term]
    return start.astype(np.int64).tolist(), terms[:, 0].astype(np.int64).tolist(), terms[:, 1].tolist(), held


def pairwise(chain: list[int]) -> list[tuple[int, int]]:
    """Return the pairs of neighbors in a chain; none for a single vertex."""
    return [(a, b) for a, b in zip(chain[:-1], chain[1:]) if a != b]


def _steps(chains: Chains, name: str, n: int, of: Kind) -> npt.NDArray[np.int64]:
    """Return the neighbors in all chains, (S, 2)."""
    # A fast path for the many edges of a grid.
    if isinstance(chains, (list, tuple)) and all(isinstance(each, (list, tuple)) and len(each) == 2 for each in chains):
        edges = np.array(chains)
        if edges.ndim == 2 and edges.dtype.kind == "i" and ((edges >= 0) & (edges < n)).all():
            return edges[edges[:, 0] != edges[:, 1]].astype(np.int64)
    steps = [step for chain in _iterable(chains, name) for step in pairwise(_indices(chain, name, n, of))]
    return np.array(steps, dtype=np.int64).reshape(-1, 2)


def _iterable(values: Iterable[_Value], name: str) -> list[_Value]:
    try:
        return list(values)
    except TypeError as error:
        raise TypeError(f"{name} must be a sequence, not {type(values).__name__}.") from error


def _indices(chain: Iterable[int], name: str, n: int, of: Kind) -> list[int]:
    array = _arguments.checked_vertex_list(chain, name)
    for index in array:
        if not 0 <= index < n:
            raise ValueError(f"{name} names {_SINGULAR[of]} {index}, but there are {n} {of}.")
    return array


_SINGULAR = {"vertices": "vertex", "corners": "corner"}
