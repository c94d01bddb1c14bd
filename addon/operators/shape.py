# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that shape maps: what is straight, rectangular, a grid, symmetric, upright, or pushed and pulled."""

from collections.abc import Collection

import bpy
import numpy as np

from .. import editors, names
from ..core import choices
from ..core.errors import ReadableError
from ..core.extenders.pairs import pairs
from ..core.layout import alignment
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import constraints, extenders, selection, shapes
from ..edit_mesh.elements import marked_edges
from ..edit_mesh.read import Reading, read_mesh
from ..edit_mesh.write import write_uv
from ..live import extenders as live_extenders
from ..live import following
from ..ui import settings
from ..unwrapping.last_settings import settings_for
from ..unwrapping.outcome import Outcome
from . import found_marks
from .found_marks import Found
from .property_kinds import choice, number, push_amount, switch
from .reporting_operator import ReportingOperator

_AXES = {"X": 0, "Y": 1, "Z": 2}
# What belongs to each kind.
_PROPERTIES = {
    choices.SHAPE_STRAIGHT: ("direction", "unwrap"),
    choices.SHAPE_RECTANGLE: ("unwrap",),
    choices.SHAPE_GRID: ("spacing", "unwrap"),
    choices.SHAPE_SYMMETRIC: ("unwrap",),
    choices.SHAPE_UPRIGHT: ("by",),
    choices.SHAPE_EXTENDER: ("amount",),
}


class UV_OT_spectral_shape(ReportingOperator, bpy.types.Operator):
    """Shape the map where something is selected; all but upright islands is stored with the mesh."""

    bl_idname = names.SHAPE_OPERATOR
    bl_label = "Spectral Shape"
    bl_description = "Make the selected part of the map straight, rectangular, a grid, symmetric or upright, or push it"
    described_by = "kind"

    kind: choice("Shape", "What the selection becomes", texts.SHAPE_ITEMS)
    direction: choice(
        "Direction",
        "How the edges lie in the map",
        (
            ("NEAREST", "Nearest", "Horizontal or vertical, as each chain of edges lies now"),
            ("HORIZONTAL", "Horizontal", "All horizontal"),
            ("VERTICAL", "Vertical", "All vertical"),
            ("OWN", "As It Lies", "Each chain of edges keeps its angle"),
        ),
    )
    spacing: choice(
        "Spacing",
        "The widths of the columns and the heights of the rows",
        (
            ("FREE", "Least Distortion", "The unwrap chooses them"),
            ("LENGTH", "By Length", "Proportional to the lengths of the edges on the mesh"),
            ("EVEN", "Even", "All columns equally wide, and all rows equally high"),
        ),
    )
    by: choice(
        "By",
        "What islands are turned by",
        (
            ("MOST", "Most Edges", "Most edges become horizontal or vertical, whichever is nearer"),
            ("EDGES", "Selected Edges", "The selected edges become horizontal or vertical, whichever is nearer"),
            ("Z", "Mesh Z", "What is higher on the mesh is higher in the map"),
            ("Y", "Mesh Y", "What is farther along Y is higher in the map"),
            ("X", "Mesh X", "What is farther along X is higher in the map"),
        ),
    )
    amount: push_amount()
    unwrap: switch(texts.UNWRAP_TOO_LABEL, "Unwrap the islands at once, in place", True)

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the kind and what belongs to it."""
        settings.draw(self.layout, self, ("kind", *_PROPERTIES[self.kind]))

    def run(self, context: bpy.types.Context) -> set[str]:
        """Shape the islands of the selection."""
        if self.kind == choices.SHAPE_UPRIGHT:
            return self._turn(context)
        return self._push(context) if self.kind == choices.SHAPE_EXTENDER else self._constrain(context)

    def _constrain(self, context: bpy.types.Context) -> set[str]:
        """Find the marks of all meshes, then store them and unwrap the islands; store nothing if none is unwrapped."""
        found: dict[bpy.types.Mesh, Found] = {}
        edges: dict[bpy.types.Mesh, np.ndarray] = {}
        for edit_object in context.objects_in_mode_unique_data:
            mesh = read_mesh(edit_object, Reading(all_visible=True, correct_aspect=True)).polygons
            made = found_marks.find(self, mesh, selection.selected(context, edit_object.data))
            found[edit_object.data] = made
            if changed := made.edges:
                edges[edit_object.data] = np.array(sorted(changed))
        refused = {mesh: each.refused for mesh, each in found.items() if each.refused is not None}
        reasons = "; ".join(dict.fromkeys(reason for each in refused.values() for reason in each.reasons))
        if not edges:
            is_faceless = any(each.is_faceless for each in found.values())
            missing = next((each.missing for each in found.values() if each.missing), "")
            missing = missing or translate(texts.NO_EDGES_SELECTED)
            raise ReadableError(reasons or (translate(texts.NO_FACE_AT_EDGES) if is_faceless else missing))
        layers = [
            (mesh, constraints.add(mesh, constraint, marked))
            for mesh, each in found.items()
            for constraint, marked in each.made
            if marked
        ]
        editors.redraw(context)
        n = sum(len(marked) for each in found.values() for _, marked in each.made)
        label = next(item[1] for item in texts.SHAPE_ITEMS if item[0] == self.kind)
        followed = Outcome(is_solved=True, reports=[("INFO", texts.constrained(label, n))])
        if self.unwrap:
            followed = following.unwrap_at(context, edges, settings_for(self))
            if not (followed.is_solved or followed.contradicting):
                for mesh, layer in layers:
                    mesh.attributes.remove(mesh.attributes[layer])
                    shapes.sync(mesh)
                self.report_all(followed.reports)
                return self.canceled(translate("Nothing was unwrapped, so nothing was stored"))
        alike = sum(len(each.alike) for each in found.values())
        self.report_all([("INFO", texts.counted(alike, texts.MIRRORED_PAIRS))])
        self.report_all(followed.reports)
        if refused:
            parts = sum(len(np.unique(each.part[each.part >= 0])) for each in refused.values())
            self.report({"WARNING"}, texts.counted(parts, texts.REFUSED_PARTS, problem=reasons))
            selection.select_shown(context, {mesh: each.part >= 0 for mesh, each in refused.items()})
        elif followed.contradicting:
            selection.select_only_edges(context, followed.contradicting)
        return {"FINISHED"}

    def _turn(self, context: bpy.types.Context) -> set[str]:
        """Turn the islands with something selected upright; without a selection, all visible ones."""
        edit_meshes = [
            read_mesh(each, Reading(all_visible=True, correct_aspect=True))
            for each in context.objects_in_mode_unique_data
        ]
        edit_meshes = [each for each in edit_meshes if each.polygons.uv is not None]
        if not edit_meshes:
            return self.canceled(translate(texts.NO_UV_MAP))
        turned = 0
        for edit_mesh in edit_meshes:
            polygons, chosen = edit_mesh.polygons, selection.selected(context, edit_mesh.mesh)
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

    def _push(self, context: bpy.types.Context) -> set[str]:
        """Find the pairs of selected vertices of all meshes, then push them apart, or pull them together."""
        wanted, edited = {}, context.objects_in_mode_unique_data
        for edit_object in edited:
            chosen = selection.selected(context, edit_object.data)
            try:
                if chosen.vertices:
                    wanted[edit_object] = pairs(chosen.vertices, chosen.active)
            except ReadableError as error:
                raise ReadableError(f"{edit_object.name}: {error}" if len(edited) > 1 else str(error)) from error
        if not wanted:
            raise ReadableError(translate("No vertices selected; select the vertices to connect, one after the other"))
        reading = Reading(all_visible=True, correct_aspect=settings_for(self).correct_aspect)
        meshes = {each: read_mesh(each, reading).polygons for each in wanted}
        for each, mesh in meshes.items():
            in_map = mesh.corner_vertices[mesh.selected_faces[mesh.face_of_corner()]]
            if not np.isin(wanted[each], in_map).all():
                raise ReadableError(translate("No visible face has these vertices; select others"))
        added = {each: extenders.add(each.data, mesh, wanted[each], self.amount) for each, mesh in meshes.items()}
        follows = following.is_on(context.scene)
        if follows and self.amount != 0.0:
            follows = all([_follow_pairs(self, edit_object, made) for edit_object, made in added.items()])
        count = sum(map(len, added.values()))
        existing = sum(map(len, wanted.values())) - count
        self.report({"INFO" if count else "WARNING"}, texts.added_extenders(count, existing, follows))
        return {"FINISHED"} if count else {"CANCELLED"}


class UV_OT_spectral_shape_remove(ReportingOperator, bpy.types.Operator):
    """Remove a stored shape."""

    bl_idname = names.REMOVE_SHAPE_OPERATOR
    bl_label = "Remove Shape"
    bl_description = "Remove this shape from the list, which no longer binds the map"

    index: number("Index", "Place in the list; -1 for the active one", -1, (-1, None), options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator where the active mesh in edit mode has shapes."""
        return super().poll(context) and len(shapes.listed(context.edit_object.data)) > 0

    def run(self, context: bpy.types.Context) -> set[str]:
        """Remove from the list of the active object's mesh; with Live, its islands follow."""
        mesh = context.edit_object.data
        index = shapes.active(mesh) if self.index < 0 else shapes.checked(mesh, self.index)
        layer, kind = shapes.listed(mesh)[index].layer, shapes.listed(mesh)[index].kind
        edges = {} if kind == shapes.EXTENDER else marked_edges(mesh, layer)
        before, _ = extenders.resolve(mesh)
        shapes.remove(mesh, index)
        after, _ = extenders.resolve(mesh)
        editors.redraw(context)
        if following.is_on(context.scene):
            if edges:
                changed = {mesh: np.array(sorted(edges))}
                self.report_all(following.unwrap_at(context, changed, settings_for(self)).reports)
            _follow_pairs(self, context.edit_object, {each[:2] for each in set(before) - set(after)})
        return {"FINISHED"}


def _follow_pairs(
    operator: bpy.types.Operator, edit_object: bpy.types.Object, changed: Collection[tuple[int, int]]
) -> bool:
    """Let the map follow changed pairs in the operator's undo step; return whether it does, or report why not."""
    try:
        with following.not_following():
            note = live_extenders.follow(edit_object, changed, settings_for(operator)) if changed else ""
            follows = True
    except (ReadableError, MemoryError) as error:
        is_readable = isinstance(error, ReadableError)
        note, follows = (
            str(error)
            if is_readable
            else translate("Not enough memory to update the map; close other programs, or add seams"),
            False,
        )
    if note:
        operator.report({"WARNING"}, note)
    return follows
