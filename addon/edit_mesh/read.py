# SPDX-License-Identifier: GPL-3.0-or-later
"""Read meshes to arrays."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from typing import Any

import bpy
import numpy as np
from bmesh.types import BMEdge, BMesh

from .. import compatibility, names
from ..core.constraints.equations import equations
from ..core.mesh.island_parts import shared_corners, with_rest_held
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.mesh.world_scale import metric_of
from ..core.solve.subdivision import Subdivision, subdivision
from ..session.edit_meshes import keep
from . import constraints, image_aspect, subsurf
from . import extenders as storage
from .elements import elements
from .uv_map import UvMap

# Fields that the artist chooses by the selection, the active face and the place of the object.
_CHOSEN = ("selected_faces", "pinned_corners", "stretch_direction", "aspect", "world_metric")


@dataclass(frozen=True)
class Reading:
    """What to read of a mesh in edit mode. The faces to unwrap are the selected visible ones.

    Attributes:
        by_uv_selection: unwrap only faces with a selected UV; their unselected UVs are pins.
        all_visible: unwrap all visible faces, selected or not.
        correct_aspect: use the aspect of the image that the active face shows.
        use_subsurf: subdivide as the object's first modifier does, if that is a Subdivision Surface modifier.
        in_place: hold the UVs that faces share with the rest of their islands.
        whole_faces: with a UV selection, take only faces whose UVs are all selected, as the UV editor's face selection
            shows them; else the selected UVs are free, and all others of their faces are pins.
    """

    by_uv_selection: bool = False
    all_visible: bool = False
    correct_aspect: bool = False
    use_subsurf: bool = False
    in_place: bool = False
    whole_faces: bool = False


@dataclass
class EditMesh:
    """A mesh in edit mode and its arrays; with `subdivision`, the subdivided mesh is solved instead.

    `uv_map` is the UV map that was active, if there was one. `broken_extenders` are the names of those that lost a
    vertex. `as_it_is` are the arrays without the selection of UVs and what is held in place. `is_edited` tells whether
    the mesh is in edit mode.
    """

    edit_object: bpy.types.Object
    mesh: bpy.types.Mesh
    polygons: PolygonMesh
    as_it_is: PolygonMesh
    reading: Reading
    uv_map: UvMap | None = None
    subdivision: Subdivision | None = None
    broken_extenders: tuple[str, ...] = ()
    is_edited: bool = True


def read_mesh(edit_object: bpy.types.Object, reading: Reading = Reading()) -> EditMesh:
    """Read the mesh of an object in edit mode."""
    return read_meshes([edit_object], reading)[0]


def read_meshes(edit_objects: Sequence[bpy.types.Object], reading: Reading = Reading()) -> list[EditMesh]:
    """Read the meshes of objects, in edit mode or not."""
    with temporary_mesh() as copy:
        return [_read(edit_object, copy, reading) for edit_object in edit_objects]


def _read(
    edit_object: bpy.types.Object, copy: bpy.types.Mesh, reading: Reading, chosen: EditMesh | None = None
) -> EditMesh:
    """Read one of `read_meshes`, or what was `chosen` in an earlier reading; `copy` is overwritten."""
    mesh = edit_object.data
    bm = elements(mesh)
    uv_map = UvMap.active(bm) if chosen is None else chosen.uv_map
    as_it_is, broken = _as_it_is(edit_object, bm, copy, reading, uv_map)
    polygons = as_it_is
    has_map = uv_map is not None and len(bm.faces) > 0
    if chosen is not None:
        polygons = replace(as_it_is, **{name: getattr(chosen.polygons, name) for name in _CHOSEN})
    elif has_map and reading.by_uv_selection:
        polygons = _of_selected_uvs(
            as_it_is, compatibility.selected_uv_corners(bm, uv_map.layer(bm)), reading.whole_faces
        )
    if has_map and reading.in_place:
        polygons = with_rest_held(polygons, shared_corners(polygons, polygons.selected_faces))
    subdivided = _subdivide(bm, edit_object, polygons) if reading.use_subsurf else None
    rest = uv_map, subdivided, tuple(broken), mesh.is_editmode
    return EditMesh(edit_object, mesh, polygons, as_it_is, reading, *rest)


def read_with_same_choice(edit_mesh: EditMesh) -> EditMesh:
    """Read a mesh that is `unchanged` but for its seams, with what was chosen then, not for work in place."""
    with temporary_mesh() as copy:
        return _read(edit_mesh.edit_object, copy, edit_mesh.reading, edit_mesh)


def unchanged(edit_meshes: Sequence[EditMesh]) -> bool:
    """Return whether meshes still have, in the mode of then, what was read of them.

    What was chosen then (the selection, the active edge, the image of the active face) and where the object is may
    have changed, as may the names of object and UV map, and which map is active.
    """
    try:
        with temporary_mesh() as copy:
            return all(each.mesh.is_editmode == each.is_edited and _is_unchanged(each, copy) for each in edit_meshes)
    except ReferenceError:
        # An object is gone.
        return False


def _is_unchanged(edit_mesh: EditMesh, copy: bpy.types.Mesh) -> bool:
    bm = elements(edit_mesh.mesh)
    uv_map = edit_mesh.uv_map or UvMap.active(bm)
    if uv_map is not None and uv_map.layer(bm) is None:
        return False
    now, _ = _as_it_is(edit_mesh.edit_object, bm, copy, edit_mesh.reading, uv_map)
    names = [field.name for field in fields(PolygonMesh) if field.name not in _CHOSEN]
    return now.equals(edit_mesh.as_it_is, [*names, "pinned_corners"])


def _as_it_is(
    edit_object: bpy.types.Object, bm: BMesh, copy: bpy.types.Mesh, reading: Reading, uv_map: UvMap | None
) -> tuple[PolygonMesh, list[str]]:
    """Read a mesh without the selection of UVs, with one of its UV maps; return its broken extenders, too."""
    mesh = edit_object.data
    bm.to_mesh(copy)
    if uv_map is not None:
        copy.uv_layers.active = uv_map.of(copy)
    forces, broken = storage.resolve(mesh)
    polygons = read_arrays(
        copy,
        reading.all_visible,
        pinned_corners=compatibility.pinned_corners(copy) if uv_map is not None and len(bm.faces) else None,
        aspect=image_aspect.aspect(edit_object, bm) if reading.correct_aspect else 1.0,
        extenders=tuple(forces),
        stretch_direction=_active_edge(bm),
        world_metric=metric_of(edit_object.matrix_world),
    )
    marked = constraints.read(mesh, copy, polygons)
    return (replace(polygons, equations=equations(polygons, marked)) if marked else polygons), broken


@contextmanager
def temporary_mesh() -> Iterator[bpy.types.Mesh]:
    """Yield a mesh outside the file to copy edit meshes to: arrays are read five times as fast as bmesh elements."""
    with compatibility.data_of_no_file() as data:
        yield data.meshes.new(names.TEMPORARY_MESH)


@contextmanager
def out_of_edit_mode(mesh: bpy.types.Mesh) -> Iterator[bpy.types.Mesh]:
    """Yield a mesh that is not in edit mode, or a copy of one that is."""
    if not mesh.is_editmode:
        yield mesh
        return
    with temporary_mesh() as copy:
        keep(mesh).bm.to_mesh(copy)
        yield copy


def _active_edge(bm: BMesh) -> np.ndarray | None:
    """Return the direction of the active edge, (3,); None if there is none or it has no length."""
    active = bm.select_history.active
    if not isinstance(active, BMEdge):
        return None
    direction = np.array(active.verts[1].co - active.verts[0].co, dtype=np.float64)
    length = np.linalg.norm(direction)
    return direction / length if np.isfinite(length) and length > 0.0 else None


def _of_selected_uvs(polygons: PolygonMesh, selected_corners: np.ndarray, whole_faces: bool) -> PolygonMesh:
    """Select only faces with a selected UV, and pin their unselected UVs; or only whole faces."""
    combined = np.logical_and if whole_faces else np.logical_or
    faces = polygons.selected_faces & combined.reduceat(selected_corners, polygons.face_offsets[:-1])
    pinned = polygons.pinned_corners if whole_faces else polygons.pinned_corners | ~selected_corners
    return replace(polygons, selected_faces=faces, pinned_corners=pinned)


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
