"""A mesh with its map: what the functions on meshes take and return."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Faces
from ._measuring import edge_keys, next_corner
from ._native import InvalidMeshError

_Mesh = TypeVar("_Mesh", bound="Mesh")
Polygons = tuple[np.ndarray, np.ndarray, np.ndarray, "np.ndarray | None", "np.ndarray | None"]


@dataclass(frozen=True, eq=False, init=False)
class Mesh:
    """A polygon mesh with its seams and its map: `unwrap`, `relax`, `pack` and `suggest_seams` take and return it.

        mesh = sc.pack(sc.relax(sc.unwrap(sc.suggest_seams(sc.Mesh(V, F)))), margin=8)
        mesh.uv

    These functions also take `V, F` for a mesh without a map. A mesh and its arrays never change; `with_uv` returns one
    with another map.
    """

    vertices: npt.NDArray[np.float64]
    """(V, 3)"""
    face_offsets: npt.NDArray[np.int32]
    """(F + 1,) the index of each face's first corner, and C, the number of all corners."""
    corner_vertices: npt.NDArray[np.int32]
    """(C,) the vertex of each corner, face after face."""
    uv: npt.NDArray[np.floating] | None
    """(C, 2) the map, per corner, so that a vertex on a seam may have several UVs; None without one."""
    seam_edges: npt.NDArray[np.int32] | None
    """(S, 2) the vertices of edges where `unwrap` cuts; None for none."""

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: Faces,
        uv: npt.ArrayLike | None = None,
        *,
        corner_vertices: npt.ArrayLike | None = None,
        seam_edges: npt.ArrayLike | None = None,
    ) -> None:
        """Check and copy the arrays.

        Args:
            vertices: (V, 3) positions, any unit.
            faces: (F, n) vertices of each face; a list of polygons, each a list of vertices; or, with
                `corner_vertices`, (F + 1,) offsets as in Blender: face f has the corners from faces[f] up to
                faces[f + 1]. F is the number of faces, C that of their corners, face after face.
            uv: (C, 2) or (F, n, 2) the map per corner; `uv[F]` where it is given per vertex. Single precision stays.
            corner_vertices: (C,) vertex of each corner, if `faces` are offsets.
            seam_edges: (S, 2) vertex pairs in any order where to cut; pairs that are not edges have no effect.

        Raises:
            ValueError: the arrays do not describe a mesh.
            TypeError: an array has the wrong type.
        """
        positions = _arguments.checked_vertices(vertices)
        offsets, corners = _arguments.checked_faces(faces, corner_vertices, len(positions))
        seams = None
        if seam_edges is not None:
            seams = _arguments.checked_indices(seam_edges, "seam_edges", 2, len(positions))
        values = {"vertices": positions, "face_offsets": offsets, "corner_vertices": corners, "seam_edges": seams}
        # The dataclass is frozen.
        self.__dict__.update(values, uv=None if uv is None else _arguments.checked_corner_uv(uv, offsets))
        self.__post_init__()

    def __post_init__(self) -> None:
        """Make the mesh read-only: native code reads it without the GIL, and results share it."""
        for array in (self.vertices, self.face_offsets, self.corner_vertices, self.uv, self.seam_edges):
            if array is not None:
                array.flags.writeable = False

    @property
    def uv_per_length(self) -> float:
        """UVs per unit of length: the root of the area in the map over that in 3D; NaN without them.

        Faces without area in the map do not count. After `unwrap` a unit of the map is a unit of length.

        Raises:
            ValueError: the mesh has no map.
        """
        return uv_per_length(self)

    def with_uv(self: _Mesh, uv: npt.ArrayLike) -> _Mesh:
        """Return a copy with another map, (C, 2) or (F, n, 2).

        Raises:
            ValueError, TypeError: see `Mesh`.
        """
        return self._with(uv=_arguments.checked_corner_uv(uv, self.face_offsets))

    def with_seams(self: _Mesh, seam_edges: npt.ArrayLike | None) -> _Mesh:
        """Return a copy with these seams, (S, 2), instead of its own.

        Raises:
            ValueError, TypeError: see `Mesh`.
        """
        seams = None
        if seam_edges is not None:
            seams = _arguments.checked_indices(seam_edges, "seam_edges", 2, len(self.vertices))
        return self._with(seam_edges=seams)

    def _with(self: _Mesh, **values: npt.NDArray | None) -> _Mesh:
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__, **values)
        other.__post_init__()
        return other

    def split_vertices(self) -> SplitMesh:
        """Return the mesh with one vertex per pair of vertex and UV, as in renderers, xatlas and igl.

        Raises:
            ValueError: the mesh has no map.
        """
        return split_vertices(self.face_offsets, self.corner_vertices, map_of(self))


class SplitMesh(NamedTuple):
    """A mesh whose vertices have one UV each: vertices on seams have several copies."""

    vmapping: npt.NDArray[np.int32]
    """(N,) the original vertex of each copy, ascending."""
    faces: npt.NDArray[np.int32] | list[npt.NDArray[np.int32]]
    """The faces in terms of the copies, in order: (F, n) if all have n corners, otherwise a list of polygons."""
    uvs: npt.NDArray[np.float64]
    """(N, 2) the UV of each copy."""

    # Not as tuples: the comparison of arrays has no truth value.
    def __eq__(self, other: object) -> bool:
        """Return whether this is the same object."""
        return self is other

    def __ne__(self, other: object) -> bool:
        """Return whether this is another object."""
        return self is not other

    def __hash__(self) -> int:
        """Return the hash of the object."""
        return object.__hash__(self)


def split_vertices(
    face_offsets: npt.NDArray[np.integer],
    corner_vertices: npt.NDArray[np.integer],
    corner_uv: npt.NDArray[np.floating],
) -> SplitMesh:
    """Give each vertex one copy per distinct UV of its corners; the arguments are (F + 1,), (C,) and (C, 2)."""
    u, v = corner_uv.T
    order = np.lexsort((v, u, corner_vertices))
    rows = np.column_stack([corner_vertices, u, v])[order]
    is_new = np.ones(len(order), bool)
    is_new[1:] = (rows[1:] != rows[:-1]).any(axis=1)
    copies = np.empty(len(order), np.int32)
    copies[order] = np.cumsum(is_new, dtype=np.int32) - 1
    firsts = order[is_new]
    counts = np.diff(face_offsets)
    is_uniform = len(counts) > 0 and (counts == counts[0]).all()
    faces = copies.reshape(len(counts), -1) if is_uniform else np.split(copies, face_offsets[1:-1])
    return SplitMesh(corner_vertices[firsts].astype(np.int32), faces, corner_uv[firsts])


def given_mesh(mesh: Mesh | npt.ArrayLike, faces: Faces | None, corner_vertices: npt.ArrayLike | None) -> Mesh:
    """Return the mesh of a function's first arguments: a `Mesh`, or vertices, faces and maybe their corners.

    Raises:
        ValueError, TypeError: they are neither.
    """
    if isinstance(mesh, Mesh):
        if faces is not None or corner_vertices is not None:
            raise TypeError("A Mesh has its own faces; leave out faces and corner_vertices.")
        return mesh
    if faces is None:
        raise TypeError(f"mesh must be a Mesh, or vertices followed by faces, not {type(mesh).__name__}.")
    return Mesh(mesh, faces, corner_vertices=corner_vertices)


def given_map(mesh: Mesh) -> Mesh:
    """Return a mesh with a map.

    Raises:
        TypeError: it is not a `Mesh`.
        ValueError: it has no map.
    """
    if not isinstance(mesh, Mesh):
        raise TypeError(f"mesh must be a Mesh with uv, such as Mesh(V, F, uv[F]), not {type(mesh).__name__}.")
    map_of(mesh)
    return mesh


def map_of(mesh: Mesh) -> npt.NDArray[np.floating]:
    """Return the map of a mesh, (C, 2), in its precision.

    Raises:
        ValueError: it has none.
    """
    if mesh.uv is None:
        raise ValueError("The mesh has no map; give uv, per corner, to Mesh.")
    return mesh.uv


def double_map_of(mesh: Mesh) -> npt.NDArray[np.float64]:
    """Return the map of a mesh in double precision, (C, 2); see `map_of`."""
    return map_of(mesh).astype(np.float64, copy=False)


def uv_per_length(mesh: Mesh, selected_faces: npt.NDArray[np.bool_] | None = None) -> float:
    """Return UVs per unit of length of a map, by default over all faces; see `Mesh`."""
    faces = mesh.face_offsets, mesh.corner_vertices
    found = _native.face_distortion(mesh.vertices, *faces, map_of(mesh), selected_faces)
    image_area = np.abs(found["image_area"])
    with np.errstate(over="ignore", invalid="ignore"):
        area = found["area"][image_area > 0.0].sum()
        return float(np.sqrt(image_area.sum() / area)) if area > 0.0 else float("nan")


def checked_polygons(mesh: Mesh, seam_edges: npt.ArrayLike | None, selected_faces: npt.ArrayLike | None) -> Polygons:
    """Return vertices, offsets, corners, all seams and the selected faces for the native module.

    Raises:
        ValueError, TypeError: the mesh has no faces, or an array is unusable.
    """
    if len(mesh.face_offsets) == 1:
        raise InvalidMeshError("The mesh has no faces; there is nothing to unwrap.")
    selected = _arguments.checked_face_selection(selected_faces, len(mesh.face_offsets) - 1)
    return mesh.vertices, mesh.face_offsets, mesh.corner_vertices, all_seams(mesh, seam_edges), selected


def all_seams(mesh: Mesh, seam_edges: npt.ArrayLike | None) -> npt.NDArray[np.int32] | None:
    """Return the seams of a mesh and these further ones, (S, 2); None for none."""
    if seam_edges is None:
        return mesh.seam_edges
    further = _arguments.checked_indices(seam_edges, "seam_edges", 2, len(mesh.vertices))
    return further if mesh.seam_edges is None else np.concatenate([mesh.seam_edges, further])


def points_of(mesh: Mesh) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Return the point of each corner, (C,), and a corner of each point, (P,).

    Corners of a vertex with the same UV are one point. Points are in the order of their vertices.
    """
    everywhere = np.zeros(len(mesh.corner_vertices), np.int32)
    return _native.weld_corners(mesh.corner_vertices, everywhere, double_map_of(mesh), len(mesh.vertices))


def corner_of_vertices(vertices: npt.NDArray[np.integer], polygons: Polygons) -> npt.NDArray[np.int64]:
    """Return a corner of each of these vertices, (n,), -1 for those in no face; the cuts leave each in one piece.

    Raises:
        ValueError: cuts give one several copies.
    """
    positions, offsets, corners, seams, selected = polygons
    following = next_corner(np.unique(offsets))
    wanted = np.unique(vertices)
    is_wanted = np.zeros(len(positions), bool)
    is_wanted[wanted] = True
    counts = np.ones(len(corners), bool)
    if selected is not None:
        counts = np.repeat(selected, np.diff(offsets))
    pairs = np.stack([corners, corners[following]], axis=1)
    sides = np.flatnonzero(is_wanted[pairs].any(axis=1))
    keys = edge_keys(pairs[sides], len(positions))
    if seams is not None:
        is_kept = ~np.isin(keys, edge_keys(seams, len(positions)))
        sides, keys = sides[is_kept], keys[is_kept]
    _, inverse, count = np.unique(keys, return_inverse=True, return_counts=True)
    order = np.argsort(inverse, kind="stable")
    twins = sides[order[count[inverse[order]] == 2]].reshape(-1, 2)
    group = {int(corner): int(corner) for corner in np.flatnonzero(is_wanted[corners] & counts)}

    def root(corner: int) -> int:
        while group[corner] != corner:
            group[corner] = group[group[corner]]
            corner = group[corner]
        return corner

    for one, other in twins[counts[twins].all(axis=1)].tolist():
        for a in (one, int(following[one])):
            for b in (other, int(following[other])):
                if corners[a] == corners[b] and a in group and b in group:
                    group[root(a)] = root(b)
    corner_of: dict[int, int] = {}
    for corner in group:
        first = corner_of.setdefault(int(corners[corner]), corner)
        if root(first) != root(corner):
            raise ValueError(
                f"Cuts give vertex {corners[corner]} several UVs; say which by its corners: Constraints(of='corners')."
            )
    # Vertices outside the selection are in no chart, where constraints have no effect.
    for corner in np.flatnonzero(is_wanted[corners] & ~counts).tolist():
        corner_of.setdefault(int(corners[corner]), corner)
    return np.array([corner_of.get(vertex, -1) for vertex in vertices.tolist()], dtype=np.int64)
