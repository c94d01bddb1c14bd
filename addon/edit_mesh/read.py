# SPDX-License-Identifier: GPL-3.0-or-later
"""Read meshes to arrays."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import bmesh
import bpy
import numpy as np
from bmesh.types import BMEdge, BMesh, BMLayerItem

from .. import compatibility, names
from ..core.constraints.equations import equations
from ..core.mesh.island_parts import shared_corners, with_rest_held
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.mesh.world_scale import metric_of
from ..core.solve.subdivision import Subdivision, subdivision
from . import constraints, image_aspect, subsurf
from . import extenders as storage


@dataclass(frozen=True)
class InPlace:
    """How to read for work in place.

    Attributes:
        whole_faces: with a UV selection, take only faces whose UVs are all selected, as the UV editor's face selection
            shows them; else the selected UVs are free, and all others of their faces are pins.
        cut_at_seams: as a solve needs: UVs on both sides of a seam are separate, even at the same point, and held ones
            become pins. Otherwise faces share UVs across seams, and none become pins.
    """

    whole_faces: bool = False
    cut_at_seams: bool = True


@dataclass
class EditMesh:
    """A mesh in edit mode and its arrays; with `subdivision`, the subdivided mesh is solved instead.

    `layer` is the name of the active UV map, if there is one. `broken_extenders` are the names of those that lost a
    vertex. `shared` (C,) bool are the corners of the faces to solve whose UV another face shares (`island_parts`); None
    unless read for work in place.
    """

    edit_object: bpy.types.Object
    mesh: bpy.types.Mesh
    polygons: PolygonMesh
    layer: str | None = None
    subdivision: Subdivision | None = None
    broken_extenders: tuple[str, ...] = ()
    shared: np.ndarray | None = None


def read_mesh(
    edit_object: bpy.types.Object,
    by_uv_selection: bool = False,
    all_visible: bool = False,
    correct_aspect: bool = False,
) -> EditMesh:
    """Read the mesh of an object in edit mode, as `read_meshes` does."""
    return read_meshes([edit_object], by_uv_selection, all_visible, correct_aspect)[0]


def read_meshes(
    edit_objects: Sequence[bpy.types.Object],
    by_uv_selection: bool = False,
    all_visible: bool = False,
    correct_aspect: bool = False,
    use_subsurf: bool = False,
    in_place: InPlace | None = None,
) -> list[EditMesh]:
    """Read the meshes of objects in edit mode. The faces to unwrap are the selected visible ones.

    Args:
        edit_objects: the objects.
        by_uv_selection: unwrap only faces with a selected UV; their unselected UVs are pins.
        all_visible: unwrap all visible faces, selected or not.
        correct_aspect: use the aspect of the image that the active face shows.
        use_subsurf: subdivide as the object's first modifier does, if that is a Subdivision Surface modifier.
        in_place: for work on the existing map, find the UVs to hold.
    """
    with temporary_mesh() as copy:
        return [
            _read(edit_object, copy, by_uv_selection, all_visible, correct_aspect, use_subsurf, in_place)
            for edit_object in edit_objects
        ]


def _read(
    edit_object: bpy.types.Object,
    copy: bpy.types.Mesh,
    by_uv_selection: bool,
    all_visible: bool,
    correct_aspect: bool,
    use_subsurf: bool,
    in_place: InPlace | None,
) -> EditMesh:
    """Read one of `read_meshes`; `copy` is overwritten."""
    mesh = edit_object.data
    bm = bmesh.from_edit_mesh(mesh)
    bm.to_mesh(copy)
    layer = bm.loops.layers.uv.active
    has_map = layer is not None and len(bm.faces) > 0
    forces, broken = storage.resolve(mesh)
    polygons = read_arrays(
        copy,
        all_visible,
        pinned_corners=compatibility.pinned_corners(copy) if has_map else None,
        aspect=image_aspect.aspect(edit_object, bm) if correct_aspect else 1.0,
        extenders=tuple(forces),
        stretch_direction=_active_edge(bm),
        world_metric=metric_of(edit_object.matrix_world),
    )
    marked = constraints.read(mesh, copy, polygons)
    if marked:
        polygons = replace(polygons, equations=equations(polygons, marked))
    if has_map and by_uv_selection:
        selected = compatibility.selected_uv_corners(bm, layer)
        whole_faces = in_place is not None and in_place.whole_faces
        _restrict_to_selected_uvs(polygons, polygons.pinned_corners, selected, whole_faces)
    shared = None
    if has_map and in_place is not None:
        shared = shared_corners(polygons, polygons.selected_faces, in_place.cut_at_seams)
        if in_place.cut_at_seams:
            polygons = with_rest_held(polygons, shared)
    subdivided = _subdivide(bm, edit_object, polygons) if use_subsurf else None
    return EditMesh(edit_object, mesh, polygons, layer and layer.name, subdivided, tuple(broken), shared)


@contextmanager
def temporary_mesh() -> Iterator[bpy.types.Mesh]:
    """Yield a mesh outside the file to copy edit meshes to: arrays are read five times as fast as bmesh elements."""
    with compatibility.data_of_no_file() as data:
        yield data.meshes.new(names.TEMPORARY_MESH)


def _active_edge(bm: BMesh) -> np.ndarray | None:
    """Return the direction of the active edge, (3,); None if there is none or it has no length."""
    active = bm.select_history.active
    if not isinstance(active, BMEdge):
        return None
    direction = np.array(active.verts[1].co - active.verts[0].co, dtype=np.float64)
    length = np.linalg.norm(direction)
    return direction / length if np.isfinite(length) and length > 0.0 else None


def _restrict_to_selected_uvs(
    polygons: PolygonMesh, pinned: np.ndarray, selected_corners: np.ndarray, whole_faces: bool
) -> None:
    """Select only faces with a selected UV, and pin their unselected UVs; or only `whole_faces`."""
    combined = np.logical_and if whole_faces else np.logical_or
    polygons.selected_faces[:] &= combined.reduceat(selected_corners, polygons.face_offsets[:-1])
    if not whole_faces:
        pinned |= ~selected_corners


def _subdivide(bm: BMesh, edit_object: bpy.types.Object, polygons: PolygonMesh) -> Subdivision | None:
    """Subdivide the mesh of `polygons`; None if the object has no leading Subdivision Surface modifier."""
    modifier = subsurf.leading_modifier(edit_object)
    if modifier is None or not polygons.selected_faces.any():
        return None
    with subsurf.subdivided(bm, modifier) as (mesh, face_of_face):
        return subdivision(polygons, read_arrays(mesh), face_of_face)


def read_arrays(
    mesh: bpy.types.Mesh,
    all_visible: bool = False,
    before: PolygonMesh | None = None,
    **others: Any,  # noqa: ANN401 - further fields
) -> PolygonMesh:
    """Read a mesh that is not in edit mode, with its selected visible faces or `all_visible` ones.

    The face offsets read `before` are reused if there are as many faces with the same corners in the same order; that
    other faces match is very unlikely, but possible.
    """
    seams = compatibility.flags(mesh, "edges", "use_seam")
    visible = ~compatibility.flags(mesh, "polygons", "hide")
    corner_vertices = compatibility.corner_vertices(mesh)
    # Blender has no fast way to read offsets: they take as long as all the rest.
    has_same_faces = (
        before is not None
        and len(before.selected_faces) == len(visible)
        and np.array_equal(before.corner_vertices, corner_vertices)
    )
    return PolygonMesh(
        vertices=compatibility.positions(mesh).astype(np.float64),
        face_offsets=before.face_offsets if has_same_faces else compatibility.face_offsets(mesh),
        corner_vertices=corner_vertices,
        seam_edges=compatibility.edge_vertices(mesh)[seams] if seams.any() else np.empty((0, 2), dtype=np.int32),
        selected_faces=visible if all_visible else compatibility.flags(mesh, "polygons", "select") & visible,
        uv=None if mesh.uv_layers.active is None else compatibility.corner_uv(mesh).astype(np.float64),
        density_factors=compatibility.face_values(mesh, names.DENSITY_FACTOR_ATTRIBUTE),
        **others,
    )


def active_uv_layer(mesh: bpy.types.Mesh) -> tuple[BMesh, BMLayerItem]:
    """Return the edit mesh of a mesh in edit mode with a UV map, and the active UV layer in it."""
    bm = bmesh.from_edit_mesh(mesh)
    return bm, bm.loops.layers.uv.active
