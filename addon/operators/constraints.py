# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that make edges straight, islands rectangles, quads grids and halves symmetric, and keep them so."""

import math
from typing import NamedTuple

import bmesh
import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, StringProperty

from .. import compatibility, editors, names
from ..core.constraints import marks
from ..core.constraints.equations import BY_LENGTH, EVEN, FREE
from ..core.constraints.mirror_axis import mirror_axes, mirrored_pairs
from ..core.errors import ReadableError
from ..core.layout import alignment
from ..core.mesh.charts import faces_of_charts_with_corners
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import constraints as storage
from ..edit_mesh import selection
from ..edit_mesh.constraints import Constraint
from ..edit_mesh.read import read_mesh
from ..edit_mesh.write import write_uv
from ..live import constraints as live
from ..live import following
from .reporting_operator import ReportingOperator

# This many selected vertices are the corners of a rectangle.
_N_CORNERS = 4
_FOR_ONE_CALL = {"HIDDEN", "SKIP_SAVE"}
_DIRECTIONS = {"HORIZONTAL": marks.HORIZONTAL, "VERTICAL": marks.VERTICAL, "NEAREST": None}
_AXES = {"X": 0, "Y": 1, "Z": 2}
_SPACINGS = {"FREE": FREE, "EVEN": EVEN, "LENGTH": BY_LENGTH}
# A constraint and its marks, by the vertices of edges.
_Found = list[tuple[Constraint, marks.Marks]]


class _AddOperator(ReportingOperator):
    """Base of the operators that add constraints where something is selected.

    Attributes:
        refused: the parts of the selection of a mesh that cannot be constrained, None for none; set by `find`.
        alike: the edges of each pair of islands that are unwrapped with it and need no marks; set by `find`.
        nothing_selected: what to say if nothing is selected.
    """

    refused: marks.Refused | None
    alike: list[list[marks.Edge]]
    nothing_selected = texts.NO_EDGES_SELECTED

    unwrap: BoolProperty(**texts.CONSTRAINT_UNWRAP_PROPERTY, default=True)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Find the marks of all meshes, then store them and unwrap the islands."""
        found: dict[bpy.types.Object, _Found] = {}
        refused: dict[bpy.types.Mesh, marks.Refused] = {}
        edges: dict[bpy.types.Mesh, np.ndarray] = {}
        pairs, is_faceless = 0, False
        for edit_object in context.objects_in_mode_unique_data:
            mesh = read_mesh(edit_object, False, True, True).polygons
            self.refused, self.alike = None, []
            made = self.find(mesh, _selected(context, edit_object))
            if self.refused is not None and self.refused.reasons:
                refused[edit_object.data] = self.refused
            of_faces = [(constraint, marks.of_visible_faces(mesh, marked)) for constraint, marked in made]
            is_faceless |= of_faces != made
            if any(marked for _, marked in of_faces):
                found[edit_object] = of_faces
            pairs += len(self.alike)
            changed = {edge for marked in (*(marked for _, marked in of_faces), *self.alike) for edge in marked}
            if changed:
                edges[edit_object.data] = np.array(sorted(changed))
        reasons = "; ".join(dict.fromkeys(reason for each in refused.values() for reason in each.reasons))
        if not edges:
            raise ReadableError(reasons or translate(texts.NO_FACE_AT_EDGES if is_faceless else self.nothing_selected))
        for edit_object, made in found.items():
            for constraint, marked in made:
                if marked:
                    storage.add(edit_object.data, constraint, marked)
        editors.redraw(context)
        if not self.unwrap:
            n = sum(len(marked) for made in found.values() for _, marked in made)
            followed = live.Follow([("INFO", texts.constrained(self.bl_label, n))], {})
        else:
            followed = live.follow(context, edges)
        self.report_all([("INFO", texts.mirrored_pairs(pairs)), *followed.reports])
        if refused:
            parts = sum(len(np.unique(each.part[each.part >= 0])) for each in refused.values())
            self.report({"WARNING"}, texts.refused_parts(reasons, parts))
            selection.select_shown(context, {mesh: each.part >= 0 for mesh, each in refused.items()})
        elif followed.contradicting:
            selection.select_only_edges(context, followed.contradicting)
        return {"FINISHED"}

    def find(self, mesh: PolygonMesh, chosen: "_Selection") -> _Found:
        """Return the constraints to add to a mesh, whose visible faces are selected in the record."""
        raise NotImplementedError


class _Selection(NamedTuple):
    """What is selected in one mesh, in the sense of the editor: edges, faces (F,) bool and vertices."""

    edges: list[marks.Edge]
    faces: np.ndarray
    vertices: list[int]


def _selected(context: bpy.types.Context, edit_object: bpy.types.Object) -> _Selection:
    """Return what is selected in a mesh in edit mode; UVs in the UV editor without sync selection."""
    bm = bmesh.from_edit_mesh(edit_object.data)
    layer, by_uv = bm.loops.layers.uv.active, None
    faces = np.array([face.select and not face.hide for face in bm.faces], dtype=bool)
    if selection.selects_uvs(context) and layer is not None:
        by_uv = compatibility.selected_uv_corners(bm, layer).tolist()
        flags = iter(by_uv)
        faces &= np.array([all([next(flags) for _ in face.loops]) for face in bm.faces], dtype=bool)
    vertices, _ = selection.selected_vertices(context, edit_object.data)
    return _Selection(storage.selected_edges(bm, by_uv), faces, vertices)


class MESH_OT_spectral_straighten(_AddOperator, bpy.types.Operator):
    """Make selected edges straight in the map."""

    bl_idname = names.STRAIGHTEN_OPERATOR
    bl_label = texts.STRAIGHTEN_LABEL
    bl_description = texts.STRAIGHTEN_DESCRIPTION

    direction: EnumProperty(**texts.DIRECTION_PROPERTY, items=texts.DIRECTION_ITEMS)

    def find(self, mesh: PolygonMesh, chosen: _Selection) -> _Found:
        """Mark the selected edges."""
        if self.direction != "OWN":
            return [(Constraint("STRAIGHT"), marks.straight(mesh, chosen.edges, _DIRECTIONS[self.direction]))]
        return [
            (
                Constraint("STRAIGHT", angle=math.degrees(marks.own_angle(mesh, chain))),
                dict.fromkeys(chain, marks.SLANTED),
            )
            for chain in marks.chains(mesh, chosen.edges)
        ]


class MESH_OT_spectral_rectangle(_AddOperator, bpy.types.Operator):
    """Make the islands of the selection rectangles."""

    bl_idname = names.RECTANGLE_OPERATOR
    bl_label = texts.RECTANGLE_LABEL
    bl_description = texts.RECTANGLE_DESCRIPTION
    nothing_selected = texts.NO_RECTANGLE_SELECTED

    def find(self, mesh: PolygonMesh, chosen: _Selection) -> _Found:
        """Mark the borders of selected faces; of islands with selected vertices if no faces are, or only corners."""
        touched = np.isin(mesh.corner_vertices, chosen.vertices)
        if not touched.any():
            return []
        faces = chosen.faces & mesh.selected_faces
        if not faces.any() or len(chosen.vertices) <= _N_CORNERS:
            faces = faces_of_charts_with_corners(mesh, mesh.selected_faces, touched)
        marked, self.refused = marks.rectangles(mesh, faces, chosen.vertices)
        return [(Constraint("RECTANGLE"), marked)]


class MESH_OT_spectral_grid(_AddOperator, bpy.types.Operator):
    """Make selected quads a grid."""

    bl_idname = names.GRID_OPERATOR
    bl_label = texts.GRID_LABEL
    bl_description = texts.GRID_DESCRIPTION
    nothing_selected = texts.NO_QUADS_SELECTED

    spacing: EnumProperty(**texts.SPACING_PROPERTY, items=texts.SPACING_ITEMS)

    def find(self, mesh: PolygonMesh, chosen: _Selection) -> _Found:
        """Mark the edges of the selected quads."""
        faces = chosen.faces & mesh.selected_faces
        if not faces.any():
            return []
        marked, self.refused = marks.grids(mesh, faces)
        return [(Constraint("GRID", spacing=_SPACINGS[self.spacing]), marked)]


class MESH_OT_spectral_symmetric(_AddOperator, bpy.types.Operator):
    """Mirror the halves beside the selected edges in the map."""

    bl_idname = names.SYMMETRIC_OPERATOR
    bl_label = texts.SYMMETRIC_LABEL
    bl_description = texts.SYMMETRIC_DESCRIPTION

    def find(self, mesh: PolygonMesh, chosen: _Selection) -> _Found:
        """Mark the selected edges as the axis, or those on the mirror planes of the islands of selected faces."""
        faces = chosen.faces & mesh.selected_faces
        if not faces.any():
            return [(Constraint("SYMMETRIC"), dict.fromkeys(chosen.edges, marks.AXIS))]
        self.nothing_selected = texts.NO_MIRROR_PLANE
        islands = faces_of_charts_with_corners(mesh, mesh.selected_faces, faces[mesh.face_of_corner()])
        axes = mirror_axes(mesh, islands)
        self.alike = [pair for pair in mirrored_pairs(mesh, islands) if axes.keys().isdisjoint(pair)]
        return [(Constraint("SYMMETRIC"), axes)]


class UV_OT_spectral_align(ReportingOperator, bpy.types.Operator):
    """Turn islands upright."""

    bl_idname = names.ALIGN_OPERATOR
    bl_label = texts.ALIGN_LABEL
    bl_description = texts.ALIGN_DESCRIPTION

    by: EnumProperty(**texts.ALIGN_PROPERTY, items=texts.ALIGN_ITEMS)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Turn the islands with something selected; without a selection, all visible ones."""
        edit_meshes = [read_mesh(each, False, True, True) for each in context.objects_in_mode_unique_data]
        edit_meshes = [each for each in edit_meshes if each.polygons.uv is not None]
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        turned = 0
        for edit_mesh in edit_meshes:
            polygons, chosen = edit_mesh.polygons, _selected(context, edit_mesh.edit_object)
            island = alignment.islands_of_corners(polygons)
            if chosen.vertices:
                touched = island[np.isin(polygons.corner_vertices, chosen.vertices)]
                island[~np.isin(island, touched)] = -1
            axis = _AXES.get(self.by)
            uv, moved = alignment.aligned(polygons, island, chosen.edges if self.by == "EDGES" else None, axis)
            if moved.any():
                with following.not_following():
                    write_uv(edit_mesh, uv, moved)
                turned += len(np.unique(island[moved]))
        self.report({"INFO"}, texts.aligned(turned))
        return {"FINISHED"} if turned else {"CANCELLED"}


class _ListOperator(ReportingOperator):
    """Base of the operators on one constraint in the list."""

    layer: StringProperty(**texts.CONSTRAINT_LAYER_PROPERTY, options=_FOR_ONE_CALL)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Change the constraint of the active object's mesh; with Live, its islands follow."""
        mesh = context.edit_object.data
        edges = storage.marked_edges(mesh, self.layer)
        if not edges:
            raise ReadableError(translate(texts.NO_SUCH_CONSTRAINT))
        self.change(mesh, self.layer)
        editors.redraw(context)
        self.report_all(live.follow_if_live(context, {mesh: np.array(sorted(edges))}))
        return {"FINISHED"}

    @staticmethod
    def change(mesh: bpy.types.Mesh, layer: str) -> None:
        """Change the constraint of this layer."""
        raise NotImplementedError


class MESH_OT_spectral_constraint_switch(_ListOperator, bpy.types.Operator):
    """Switch a constraint off, or on again."""

    bl_idname = names.SWITCH_CONSTRAINT_OPERATOR
    bl_label = texts.SWITCH_CONSTRAINT_LABEL
    bl_description = texts.SWITCH_CONSTRAINT_DESCRIPTION
    change = staticmethod(storage.switch)


class MESH_OT_spectral_constraint_remove(_ListOperator, bpy.types.Operator):
    """Remove a constraint."""

    bl_idname = names.REMOVE_CONSTRAINT_OPERATOR
    bl_label = texts.REMOVE_CONSTRAINT_LABEL
    bl_description = texts.REMOVE_CONSTRAINT_DESCRIPTION
    change = staticmethod(storage.remove)
