"""Checks and conversions of arrays and numbers: a wrong type is a TypeError, any other unusable value a ValueError.

Arrays are copied once, and the copies are checked. The native module works without the GIL and reads some arrays again
in later solves, so changes to the caller's arrays by other threads and progress functions must not reach it.
"""

from __future__ import annotations

import numbers
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Literal, Optional, Union, cast, overload

import numpy as np
import numpy.typing as npt

from . import _native

Pins = Mapping[int, "tuple[float, float]"]
Extenders = Iterable["tuple[int, int, float] | tuple[int, int, float, float]"]
"""(vertex, vertex, strength): a soft constraint of section 4.2 that pushes two vertices apart or, with a negative
strength, pulls them together. The strength is a fraction of the boundary's total mass. A fourth number, `half`, is the
unit of strengths in maps that pins or coordinates hold, 1 by default; see `parameterize`."""
Faces = Union[npt.ArrayLike, Sequence[Sequence[int]]]
"""The faces of a polygon mesh: their vertices, as (F, n) or a list of polygons; or, with `corner_vertices`, offsets."""
Progress = Callable[[float, str], Optional[bool]]
"""Called with the fraction done (0 to 1) and the name of the phase. Returning False cancels: `Cancelled` is raised. Any
other value goes on, also 0 or an empty list."""

# Beyond this limit, the negative end of the spectrum costs the wanted eigenvalue its digits.
STRENGTH_LIMIT = 1e4
_INDEX_LIMIT = np.iinfo(np.int32).max
_SIZE_LIMIT = _native.SIZE_LIMIT
# Rows copied at a time: they fit into the processor's caches, so the memory is reused.
_ROWS_AT_ONCE = 1 << 14


def checked_faces(
    faces: Faces, corner_vertices: npt.ArrayLike | None, n_vertices: int = _INDEX_LIMIT + 1
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Return the first corner of each face, (F + 1,), and the vertex of each corner, (C,)."""
    if corner_vertices is None:
        offsets, corner_vertices = _corners_of(faces)
        name = "faces"
    else:
        offsets, name = checked_index_vector(faces, "faces, as offsets,"), "corner_vertices"
    corners = checked_indices(corner_vertices, name, None, n_vertices)
    _check_rising(offsets, len(corners))
    return offsets, corners


def _corners_of(faces: Faces) -> tuple[npt.NDArray[np.int32], npt.ArrayLike]:
    """Return the offsets and the vertices of faces given as vertices, (F, n) or polygon by polygon."""
    if not isinstance(faces, np.ndarray) and not hasattr(faces, "__array__"):
        polygons = cast("Sequence[Sequence[int]]", faces)
        try:
            counts = [len(polygon) for polygon in polygons]
        except TypeError as error:
            raise TypeError(
                "faces must be vertices, (F, n) or a list of polygons, or offsets with corner_vertices."
            ) from error
        if len(set(counts)) > 1:
            offsets = np.concatenate([[0], np.cumsum(counts)])
            try:
                corners = np.concatenate([np.asarray(polygon) for polygon in polygons if len(polygon)])
            except ValueError as error:
                raise TypeError("Each of faces must be a list of vertex indices.") from error
            return checked_index_vector(offsets, "faces"), corners
    array = checked_integers(faces, "faces")
    if array.shape[:1] == (0,):
        return np.zeros(1, np.int32), np.zeros(0, np.int32)
    if array.ndim != 2:
        raise ValueError(f"faces must have the shape (F, n), not {array.shape}; offsets need corner_vertices.")
    if array.size > _SIZE_LIMIT:
        raise ValueError(f"faces has {array.size} entries; at most {_SIZE_LIMIT} can be numbered. Split the mesh.")
    return np.arange(len(array) + 1, dtype=np.int32) * np.int32(array.shape[1]), array.ravel()


def _check_rising(offsets: npt.NDArray[np.int32], n_corners: int) -> None:
    if len(offsets) == 0:
        raise ValueError("faces is empty; as offsets it needs one entry more than there are faces.")
    if offsets[0] != 0 or offsets[-1] != n_corners or (offsets[1:] < offsets[:-1]).any():
        raise ValueError(f"faces, as offsets, must rise from 0 to the number of corners, {n_corners}.")


def checked_face_selection(selected_faces: npt.ArrayLike | None, n_faces: int) -> npt.NDArray[np.bool_] | None:
    return None if selected_faces is None else checked_flags(selected_faces, "selected_faces", n_faces, "face")


def checked_flags(values: npt.ArrayLike, name: str, n: int, item: str) -> npt.NDArray[np.bool_]:
    array = checked_array(values, name)
    if array.size and array.dtype != np.bool_:
        raise TypeError(f"{name} must be {n} booleans, one per {item}, not {array.dtype}.")
    if array.shape != (n,):
        raise ValueError(f"{name} must be {n} booleans, one per {item}, not an array of shape {array.shape}.")
    # To NumPy any nonzero byte is true; a compiler expects 0 or 1.
    return array.view(np.uint8) != 0


def real(value: object, name: str, what: str = "a number") -> float:
    """Return a number as a float; True, False and text are not numbers."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be {what}, not {value!r}.")
    try:
        return float(value)
    except OverflowError as error:
        raise ValueError(f"{name} is too large for a floating-point number.") from error


def checked_between(value: float, low: float, high: float, name: str) -> float:
    number = real(value, name, f"a number between {low:g} and {high:g}")
    if not low <= number <= high:
        raise ValueError(f"{name} must lie between {low:g} and {high:g}, not {value!r}.")
    return number


def checked_at_least(value: float, least: float, name: str) -> float:
    number = real(value, name, what := f"a number of at least {least:g}")
    if not number >= least:
        raise ValueError(f"{name} must be {what}, not {value!r}.")
    return number


def checked_count(value: int, name: str) -> int:
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name} must be a whole number from 0 to 2147483647, not {value!r}.")
    if not 0 <= value < 2**31:
        raise ValueError(f"{name} must be a whole number from 0 to 2147483647, not {value!r}.")
    return int(value)


def checked_choice(value: str, name: str, choices: tuple[str, ...]) -> str:
    """Return one of some names, checked."""
    if not isinstance(value, str):
        raise TypeError(f"{name} must be one of {', '.join(choices)}, not {value!r}.")
    if value not in choices:
        raise ValueError(f"{name} must be one of {', '.join(choices)}, not {value!r}.")
    return value


def checked_direction(value: npt.ArrayLike, name: str) -> tuple[float, float, float]:
    array = np.array(checked_reals(value, name))
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name} must be three finite numbers, not {value!r}.")
    x, y, z = array.tolist()
    return float(x), float(y), float(z)


def checked_preference(values: npt.ArrayLike | None, n_vertices: int) -> npt.NDArray[np.float64] | None:
    if values is None:
        return None
    array = checked_reals(values, "vertex_preference")
    preference = np.array(array, dtype=np.float64) if array.shape == (n_vertices,) else None
    if preference is None or not (np.abs(preference) <= 1).all():
        raise ValueError(f"vertex_preference must be {n_vertices} numbers from -1 to 1, one per vertex.")
    return preference


def checked_marks(
    edges: npt.ArrayLike | None, strengths: npt.ArrayLike | None, n_vertices: int
) -> tuple[npt.NDArray[np.int32] | None, npt.NDArray[np.float64] | None]:
    """Return `preferred_edges`, (P, 2), and `edge_preference`, (P,)."""
    if edges is None:
        if strengths is not None:
            raise ValueError("edge_preference needs preferred_edges.")
        return None, None
    pairs = checked_indices(edges, "preferred_edges", 2, n_vertices)
    if strengths is None:
        return pairs, None
    array = checked_reals(strengths, "edge_preference")
    found = np.array(array, dtype=np.float64) if array.shape == (len(pairs),) else None
    if found is None or not ((found >= 0) & (found <= 1)).all():
        raise ValueError(f"edge_preference must be {len(pairs)} numbers from 0 to 1, one per edge of preferred_edges.")
    return pairs, found


def checked_progress(progress: Progress | None) -> Progress | None:
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable or None, not {type(progress).__name__}.")
    return progress


def poll(progress: Progress | None, phase: str) -> None:
    """Report that work begins.

    Raises:
        Cancelled: `progress` returned False.
    """
    if progress is not None:
        heed(progress(0.0, phase))


def heed(answer: object) -> None:
    """Raise `Cancelled` if a function of the caller answered False."""
    if isinstance(answer, (bool, np.bool_)) and not answer:
        raise _native.Cancelled("canceled by the caller")


def _kind_of(error: Exception) -> type[Exception]:
    """Return the kind of error to raise where a conversion raised this one."""
    return TypeError if isinstance(error, TypeError) else ValueError


def checked_array(values: npt.ArrayLike, name: str, may_be_number: bool = False) -> np.ndarray:
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked values; fill them or leave them out.")
    try:
        array = np.asarray(values)
    except (TypeError, ValueError, OverflowError) as error:
        raise _kind_of(error)(f"{name} is not a regular array: {str(error).rstrip('.')}.") from error
    if array.ndim == 0 and not (may_be_number and array.dtype.kind in "biufc"):
        raise TypeError(f"{name} must be an array, not {type(values).__name__}.")
    if array.ndim and len(array) > _SIZE_LIMIT + 1:  # offsets have one more entry
        raise ValueError(
            f"{name} has {len(array)} rows; at most {_SIZE_LIMIT} can be numbered. Split the mesh into several."
        )
    return array


def checked_reals(values: npt.ArrayLike, name: str, may_be_number: bool = False) -> np.ndarray:
    """Return an array of integers or floats."""
    array = checked_array(values, name, may_be_number)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {array.dtype}.")
    return array


def checked_integers(values: npt.ArrayLike, name: str) -> np.ndarray:
    """Return an array of integers; an empty one may come with another type."""
    array = checked_array(values, name)
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"{name} must hold integers, not {array.dtype}.")
    return array if array.size else np.zeros(array.shape, np.int32)


def converted(values: npt.ArrayLike, kind: npt.DTypeLike) -> np.ndarray:
    """Return a copy of values as another type of numbers.

    NumPy would warn of what overflows, which becomes infinite and is reported as such, and of NaNs that signal.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return np.array(values, kind, order="C")


def doubles(values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return a copy of values as doubles; see `converted`."""
    return converted(values, np.float64)


@overload
def _copied_floats(array: np.ndarray, keep_single: Literal[False] = ...) -> npt.NDArray[np.float64]: ...
@overload
def _copied_floats(array: np.ndarray, keep_single: bool) -> npt.NDArray[np.floating]: ...
def _copied_floats(array: np.ndarray, keep_single: bool = False) -> npt.NDArray[np.floating]:
    """Return a copy of the array as float64, or as float32 if it is float32 and `keep_single` is set."""
    return converted(array, np.float32) if keep_single and array.dtype == np.float32 else doubles(array)


@overload
def checked_floats(
    values: npt.ArrayLike, name: str, columns: int, keep_single: Literal[False] = ...
) -> npt.NDArray[np.float64]: ...
@overload
def checked_floats(values: npt.ArrayLike, name: str, columns: int, keep_single: bool) -> npt.NDArray[np.floating]: ...
def checked_floats(
    values: npt.ArrayLike, name: str, columns: int, keep_single: bool = False
) -> npt.NDArray[np.floating]:
    array = checked_reals(values, name)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}.")
    return _copied_floats(array, keep_single)


def checked_vertices(vertices: npt.ArrayLike) -> npt.NDArray[np.float64]:
    return checked_floats(vertices, "vertices", 3)


def checked_index_vector(values: npt.ArrayLike, name: str) -> npt.NDArray[np.int32]:
    array = checked_integers(values, name)
    if array.ndim != 1:
        raise ValueError(f"{name} must have one dimension, not the shape {array.shape}.")
    indices = np.empty(len(array), np.int32)
    ranges = []
    for begin in range(0, len(array), _ROWS_AT_ONCE):
        rows = np.array(array[begin : begin + _ROWS_AT_ONCE])
        ranges += [int(rows.min()), int(rows.max())]
        indices[begin : begin + len(rows)] = rows
    if ranges and (min(ranges) < 0 or max(ranges) > _INDEX_LIMIT):
        raise ValueError(
            f"{name} must lie between 0 and {_INDEX_LIMIT}, but range from {min(ranges)} to {max(ranges)}."
        )
    return indices


def is_finite_at(points: npt.NDArray[np.float64], indices: npt.NDArray[np.integer]) -> bool:
    """Return whether the points with these indices are finite; usually all points are, which is faster to check."""
    return bool(np.isfinite(points).all() or np.isfinite(points[indices]).all())


def checked_triangle_mesh(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """Return vertices, (V, 3), finite where a triangle uses them, and triangles, (F, 3)."""
    vertices = checked_vertices(vertices)
    triangles = checked_indices(triangles, "triangles", 3, len(vertices))
    if not is_finite_at(vertices, triangles):
        raise ValueError("vertices has values that are not finite; every vertex that a triangle uses needs a position.")
    return vertices, triangles


def checked_triangle_map(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike, uv: npt.ArrayLike
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32], npt.NDArray[np.float64]]:
    """Return a triangle mesh and its map, (V, 2), finite where a triangle uses it."""
    vertices, triangles = checked_triangle_mesh(vertices, triangles)
    uv = checked_floats(uv, "uv", 2)
    if len(uv) != len(vertices):
        raise ValueError(f"uv has {len(uv)} rows, but there are {len(vertices)} vertices.")
    if not is_finite_at(uv, triangles):
        raise ValueError("uv has values that are not finite; every vertex that a triangle uses needs a point.")
    return vertices, triangles, uv


def checked_indices(values: npt.ArrayLike, name: str, columns: int | None, n_vertices: int) -> npt.NDArray[np.int32]:
    array = checked_integers(values, name)
    if array.size > _SIZE_LIMIT:
        raise ValueError(f"{name} has {array.size} entries; at most {_SIZE_LIMIT} can be numbered. Split the mesh.")
    if columns is not None:
        if array.shape[:1] == (0,):
            array = np.zeros((0, columns), np.int32)
        if array.ndim != 2 or array.shape[1] != columns:
            raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}.")
    shape = array.shape
    flat = checked_index_vector(array.ravel() if columns is not None else array, name)
    if flat.size and flat.max() >= n_vertices:
        raise ValueError(f"{name} has the vertex {flat.max()}, but there are {n_vertices} vertices.")
    return flat.reshape(shape) if columns is not None else flat


def checked_flag(value: object, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True or False, not {value!r}.")
    return bool(value)


def checked_extenders(extenders: Extenders | None, method: str, n_vertices: int) -> list[tuple[int, int, float, float]]:
    result = []
    words = "extenders must be (vertex, vertex, strength) or (vertex, vertex, strength, half), but"
    try:
        given = tuple(() if extenders is None else extenders)
    except TypeError as error:
        raise TypeError(f"{words} are of type {type(extenders).__name__}.") from error
    for k, extender in enumerate(given):
        try:
            first, second, strength, half = extender if len(extender) == 4 else (*extender, 1.0)
            i, j, strength, half = (
                operator.index(first),
                operator.index(second),
                real(strength, "strength"),
                real(half, "half"),
            )
        except (TypeError, ValueError, OverflowError) as error:
            raise _kind_of(error)(f"{words} have {extender!r}.") from error
        if not (0 <= i < n_vertices and 0 <= j < n_vertices):
            raise ValueError(f"Extender {k} joins the vertices {i} and {j}, but there are {n_vertices} vertices.")
        if i == j:
            raise ValueError(f"Extender {k} joins vertex {i} with itself; give it two different vertices.")
        if not abs(strength) <= STRENGTH_LIMIT:
            raise ValueError(
                f"The strength of extender {k} must lie between {-STRENGTH_LIMIT:g} and {STRENGTH_LIMIT:g}, "
                f"not {strength!r}."
            )
        least = 1.0 / STRENGTH_LIMIT
        if not least <= half <= STRENGTH_LIMIT:
            raise ValueError(f"half of extender {k} must lie between {least:g} and {STRENGTH_LIMIT:g}, not {half!r}.")
        result.append((i, j, strength, half))
    if result and method != "spectral":
        raise ValueError(f"extenders need the method 'spectral', not '{method}'.")
    return result


def checked_metric(
    metric: npt.ArrayLike | None, n_faces: int, sizes: tuple[int, ...]
) -> npt.NDArray[np.float64] | None:
    """Check one tensor per face, of one of the sizes; native code checks that it is definite in the face's plane."""
    if metric is None:
        return None
    array = checked_reals(metric, "metric")
    size = array.shape[-1] if array.ndim == 3 and array.shape[-1] in sizes else sizes[0]
    tensors = checked_tensors(array, size)
    if len(tensors) != n_faces:
        raise ValueError(f"metric has {len(tensors)} tensors, but there are {n_faces} faces.")
    return tensors


def checked_tensors(metric: npt.ArrayLike, size: int) -> npt.NDArray[np.float64]:
    array = checked_reals(metric, "metric")
    if array.ndim != 3 or array.shape[1:] != (size, size):
        raise ValueError(f"metric must have the shape (n, {size}, {size}), not {array.shape}.")
    tensors = np.empty(array.shape)
    for begin in range(0, len(array), _ROWS_AT_ONCE):
        rows = tensors[begin : begin + _ROWS_AT_ONCE]
        rows[:] = _copied_floats(array[begin : begin + _ROWS_AT_ONCE])
        if not np.isfinite(rows).all():
            raise ValueError("metric has values that are not finite.")
        size_of = np.abs(rows).max(axis=(1, 2), initial=0.0)
        if (np.abs(rows - rows.transpose(0, 2, 1)).max(axis=(1, 2), initial=0.0) > 1e-9 * size_of).any():
            raise ValueError("metric must be symmetric.")
    if size == 2:
        bad = _native.first_not_positive_definite(tensors)
        if bad >= 0:
            raise ValueError(f"The metric of triangle {bad} is not positive definite: {tensors[bad].tolist()}.")
    return tensors


def checked_broadcast(values: npt.ArrayLike, name: str, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    array = checked_reals(values, name, may_be_number=True)
    try:
        array = np.broadcast_to(array, shape)
    except ValueError as error:
        raise ValueError(f"{name} must have the shape {shape}, not {array.shape}.") from error
    return _copied_floats(array)


def checked_corner_uv(uv: npt.ArrayLike, face_offsets: npt.NDArray[np.integer]) -> npt.NDArray[np.floating]:
    """Return a copy of a map per corner, (C, 2), given that or (F, n, 2); single precision stays."""
    array = _by_corner(checked_reals(uv, "uv"), face_offsets, (2,))
    n = int(face_offsets[-1])
    if array.shape != (n, 2):
        hint = "; give uv[F] where it is given per vertex" if array.ndim == 2 else ""
        raise ValueError(f"uv must have the shape ({n}, 2), one row per corner, not {array.shape}{hint}.")
    return _copied_floats(array, keep_single=True)


def checked_corner_flags(
    flags: npt.ArrayLike, name: str, face_offsets: npt.NDArray[np.integer]
) -> npt.NDArray[np.bool_]:
    """Return flags per corner, (C,), given those or (F, n)."""
    array = _by_corner(checked_array(flags, name), face_offsets, ())
    return checked_flags(array, name, int(face_offsets[-1]), "corner")


def _by_corner(array: np.ndarray, face_offsets: npt.NDArray[np.integer], of_one: tuple[int, ...]) -> np.ndarray:
    """Return (F, n, ...) as (C, ...), and any other array as it is."""
    counts = np.diff(face_offsets)
    is_by_face = array.ndim == 2 + len(of_one) and array.shape[:1] == counts.shape and array.shape[2:] == of_one
    if is_by_face and (counts == array.shape[1]).all():
        return array.reshape(-1, *of_one)
    return array


def checked_vertex_list(vertices: Iterable[int], name: str) -> list[int]:
    """Return vertex indices as a list of int; raise TypeError naming the argument."""
    try:
        return [operator.index(vertex) for vertex in vertices]
    except TypeError as error:
        raise TypeError(f"{name} must hold lists of vertex indices, but has {vertices!r}.") from error


def checked_pins(pins: Pins | None, n_vertices: int) -> list[tuple[int, float, float]]:
    if pins is None:
        return []
    if not isinstance(pins, Mapping):
        raise TypeError(f"pins must map vertices to (u, v), not be of type {type(pins).__name__}.")
    result = []
    for vertex, position in dict(pins).items():
        try:
            index = operator.index(vertex)
            u, v = (real(x, "a coordinate") for x in position)
        except (TypeError, ValueError, OverflowError) as error:
            raise _kind_of(error)(
                f"pins must map vertex indices to (u, v), but has {vertex!r}: {position!r}."
            ) from error
        if not 0 <= index < n_vertices:
            raise ValueError(f"Vertex {index} is pinned, but there are {n_vertices} vertices.")
        if not (np.isfinite(u) and np.isfinite(v)):
            raise ValueError(f"The pin of vertex {index} is not finite: ({u}, {v}).")
        result.append((index, u, v))
    return result


def checked_fixed(fixed: npt.ArrayLike, n_vertices: int) -> npt.NDArray[np.integer]:
    """Return the indices of vertices given as flags, (V,), or as indices in any order."""
    array = checked_array(fixed, "fixed")
    if array.dtype == np.bool_:
        return np.flatnonzero(checked_flags(array, "fixed", n_vertices, "vertex"))
    return np.unique(checked_indices(array.ravel() if array.size == 0 else array, "fixed", None, n_vertices))


def checked_held(
    pins: Pins | None,
    fixed: npt.ArrayLike | None,
    uv: npt.ArrayLike | None,
    n_vertices: int,
    used: npt.NDArray[np.integer],
) -> list[tuple[int, float, float]]:
    """Return the pins, and the fixed vertices that are `used`, at their `uv`, as one list; `pins` take precedence."""
    pin_list = checked_pins(pins, n_vertices)
    if fixed is None:
        return pin_list
    held = checked_fixed(fixed, n_vertices)
    if uv is None:
        raise ValueError("fixed needs uv, the positions at which the vertices are held.")
    positions = checked_floats(uv, "uv", 2)
    if len(positions) != n_vertices:
        raise ValueError(f"uv has {len(positions)} rows, but there are {n_vertices} vertices.")
    held = held[np.isin(held, used)]
    wrong = held[~np.isfinite(positions[held]).all(axis=1)]
    if len(wrong):
        raise ValueError(f"The position of the fixed vertex {wrong[0]} is not finite.")
    pinned = {vertex for vertex, _, _ in pin_list}
    u, v = positions[held].T.tolist()
    return pin_list + [point for point in zip(held.tolist(), u, v) if point[0] not in pinned]
