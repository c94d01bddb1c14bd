"""Measure a map: its distortion and its defects."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Faces
from ._mesh import Mesh, checked_polygons, double_map_of, given_map, given_mesh, map_of
from ._results import Distortion, FaceDistortion, MapDefects


def distortion(vertices: npt.ArrayLike, triangles: npt.ArrayLike, uv: npt.ArrayLike) -> Distortion:
    """Measure a map.

    Args:
        vertices: (V, 3) positions, finite where a triangle uses them.
        triangles: (F, 3) vertex indices.
        uv: (V, 2) image of each vertex, finite where a triangle uses it.

    Raises:
        ValueError: an array is not as described here.
    """
    vertices, triangles, uv = _arguments.checked_triangle_map(vertices, triangles, uv)
    return Distortion(**_native.distortion(vertices, triangles, uv))


def map_defects(
    mesh: Mesh, *, selected_faces: npt.ArrayLike | None = None, between_islands: bool = False
) -> MapDefects:
    """Find the islands of the UV map of a polygon mesh, and its flipped and overlapping faces.

    Islands are the parts of the selected faces that are connected across edges with exactly two faces and equal UVs on
    both sides. An island has no flipped faces if it is mirrored as a whole, or if its faces are wound inconsistently.
    Polygons are triangulated in the map: a concave one is not flipped, a self-intersecting one is, and one with five or
    more corners that touches itself may be. UVs are treated as single precision: contacts and folds shallower than
    2.5e-7 of the coordinates do not count, so collapsed faces are neither flipped nor overlapping. Of several faces
    with the same vertices and UVs, only the first is examined; faces with fewer than three different corners are not.

    Args:
        mesh: with a map, finite at the corners of selected faces. Its vertices have no effect.
        selected_faces: (faces,) bool; by default all faces. Other faces are ignored.
        between_islands: whether faces that cover a face of another island count as overlapping, too.

    Raises:
        ValueError: the mesh has no map, or a UV is not finite; the message names its corner.
    """
    given = given_map(mesh)
    selected = _arguments.checked_face_selection(selected_faces, len(given.face_offsets) - 1)
    between = _arguments.checked_flag(between_islands, "between_islands")
    faces = given.face_offsets, given.corner_vertices
    return MapDefects(**_native.map_defects(*faces, double_map_of(given), selected, between))


def face_distortion(mesh: Mesh, *, selected_faces: npt.ArrayLike | None = None) -> FaceDistortion:
    """Measure the UV map of a polygon mesh face by face, fast enough to follow edits; islands play no role.

    Args:
        mesh: with a map; positions and UVs may be not finite. Single precision is read without conversion.
        selected_faces: (faces,) bool; by default all faces. Other faces are ignored.

    Raises:
        ValueError: the mesh has no map.
    """
    given = given_map(mesh)
    vertices, offsets, corners, _, selected = checked_polygons(given, None, selected_faces)
    return FaceDistortion(**_native.face_distortion(vertices, offsets, corners, map_of(given), selected))


def face_triangles(
    mesh: Mesh | npt.ArrayLike,
    faces: Faces | None = None,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    selected_faces: npt.ArrayLike | None = None,
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Triangulate the faces of a polygon mesh as Blender draws them, so that an overlay lies on the drawn faces.

    Args:
        mesh: as in `unwrap`, but may have positions that are not finite.
        faces: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        selected_faces: (faces,) bool; by default all faces. Other faces get no triangles.

    Returns:
        (T, 3) corners of the triangles, in the order of the faces, and (T,) the face of each.

    Raises:
        ValueError: the arrays do not describe a mesh, or are not as described here.
    """
    given = given_mesh(mesh, faces, corner_vertices)
    vertices, offsets, corners, _, selected = checked_polygons(given, None, selected_faces)
    return _native.face_triangles(vertices, offsets, corners, selected)
