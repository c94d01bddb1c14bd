# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's tab in the 3D viewport and in the UV editor, with its panels in the order of work."""

import math

import blf
import bmesh
import bpy

from .. import compatibility, names, user_preferences
from ..core import choices
from ..core.words import texts
from ..edit_mesh import constraints
from ..edit_mesh import extenders as storage
from ..unwrapping import island_list
from . import seam_settings, unwrap_settings
from .icons import draw_operator

# Pixels of a region, times the scale of the interface, beside a line with an icon: icon, tabs and margins.
_BESIDE_LINES = 80.0


class _List:
    """A list of the properties of a data-block."""

    def draw_item(
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        owner: bpy.types.ID,
        item: bpy.types.PropertyGroup,
        _icon: int,
        _active_owner: bpy.types.ID,
        _active_property: str,
        index: int = 0,
        _flag: int = 0,
    ) -> None:
        """Draw one of them."""
        self.draw_row(layout, owner, item, index)


class MESH_UL_spectral_extenders(_List, bpy.types.UIList):
    """The list of extenders."""

    def draw_row(
        self, layout: bpy.types.UILayout, mesh: bpy.types.Mesh, extender: bpy.types.PropertyGroup, index: int
    ) -> None:
        """Draw one extender: which way it acts, or that it is broken; its name; its amount; whether it is on."""
        known = storage.vertices(mesh)
        is_broken = known is not None and None in known[index]
        row = layout.row(align=True)
        content = row.row(align=True)
        content.active = extender.use
        content.alert = is_broken
        split = content.split(factor=0.42 if is_broken else 0.62, align=True)
        way = "FULLSCREEN_ENTER" if extender.strength >= 0.0 else "FULLSCREEN_EXIT"
        split.prop(extender, "name", text="", emboss=False, icon="ERROR" if is_broken else way)
        if is_broken:
            split.label(text=texts.VERTEX_LOST_LABEL)
        else:
            split.prop(extender, "amount", text="", slider=True)
        row.prop(extender, "use", text="")


class UV_UL_spectral_islands(_List, bpy.types.UIList):
    """The list of islands."""

    def draw_row(
        self,
        layout: bpy.types.UILayout,
        _manager: bpy.types.WindowManager,
        island: bpy.types.PropertyGroup,
        _index: int,
    ) -> None:
        """Draw one island: its distortion, its faces and what is wrong with it."""
        layout.label(text=island.name, icon="ERROR" if island.is_bad else "UV_ISLANDSEL")


class _Panel:
    """A panel of the tab; every subclass is registered for the 3D viewport and for the UV editor."""

    bl_region_type = "UI"
    bl_category = texts.SIDEBAR_TAB
    part = ""
    """The last word of the panels' identifiers."""
    parent = ""
    """The last word of the parent panel's identifier."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show the panel where a mesh is in edit mode and, in an image editor, its UVs are shown."""
        return context.mode == "EDIT_MESH" and getattr(context.space_data, "show_uvedit", True)


class _SeamsPanel(_Panel):
    """Seams."""

    bl_label = texts.SEAMS_LABEL
    part = "seams"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the operators that make and clear seams."""
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_REGION_WIN"
        draw_operator(column, names.SUGGEST_SEAMS_OPERATOR)
        row = column.row(align=True)
        row.operator("uv.seams_from_islands", text=texts.SEAMS_FROM_ISLANDS_LABEL)
        row.operator("mesh.mark_seam", text=texts.CLEAR_SEAMS_LABEL).clear = True
        row = column.row(align=True)
        for wish, label, _ in texts.SEAM_WISHES:
            if wish == "CLEAR":
                row.operator(names.SEAM_WISH_OPERATOR, text="", icon="X").wish = wish
            else:
                row.operator(names.SEAM_WISH_OPERATOR, text=label).wish = wish


class _SeamSettingsPanel(_Panel):
    """The settings of the next search for seams; they change the running preview."""

    bl_label = texts.SETTINGS_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "seam_settings", "seams"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings."""
        seam_settings.draw(self.layout, seam_settings.last(), context.edit_object, is_narrow=True)


class _UnwrapPanel(_Panel):
    """Unwrapping."""

    bl_label = texts.UNWRAP_SHORT_LABEL
    # In the default context Blender translates this word as unpacking.
    bl_translation_context = "Operator"
    part = "unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the operators and the live toggle."""
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        column = layout.column(align=True)
        row = column.row(align=True)
        row.operator(names.UNWRAP_OPERATOR, text=texts.UNWRAP_SHORT_LABEL)
        row.operator(names.RELAX_OPERATOR, text=texts.RELAX_SHORT_LABEL)
        row.operator(names.PACK_OPERATOR, text=texts.PACK_SHORT_LABEL)
        row = layout.row(align=True)
        row.prop(context.scene, names.TEXTURE_SIZE_PROPERTY, text=texts.TEXTURE_LABEL)
        row.prop(context.scene, names.MARGIN_PROPERTY)
        layout.prop(context.scene, names.LIVE_UNWRAP_PROPERTY)
        if getattr(context.scene, names.LIVE_UNWRAP_PROPERTY) and _is_too_large_to_follow(context.edit_object):
            column = layout.column(align=True)
            column.label(text=texts.TOO_MANY_FACES_TO_FOLLOW, icon="ERROR")
            column.label(text=texts.LIMIT_IN_PREFERENCES, icon="BLANK1")


class _SettingsPanel(_Panel):
    """The settings of the next unwrap; they begin with those of the last one."""

    bl_label = texts.SETTINGS_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "settings", "unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the common settings."""
        properties = context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
        unwrap_settings.draw_common(self.layout, properties, is_narrow=True)


class _AdvancedPanel(_Panel):
    """The rarely used settings."""

    bl_label = texts.ADVANCED_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "advanced", "settings"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the rest of the settings."""
        properties = context.window_manager.operator_properties_last(names.UNWRAP_OPERATOR)
        unwrap_settings.draw_advanced(self.layout, properties, is_narrow=True)


class _ResultPanel(_Panel):
    """The result of the last unwrap."""

    bl_label = texts.RESULT_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "result", "unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the reports, line by line, and the islands, which select their faces."""
        layout, window_manager = self.layout, context.window_manager
        reported = island_list.lines()
        if not reported:
            layout.label(text=texts.NO_RESULT_LABEL)
            return
        column = layout.column(align=True)
        column.scale_y = 0.8
        for level, text in reported:
            for index, line in enumerate(_wrapped(context, text)):
                column.label(text=line, icon=("INFO" if level == "INFO" else "ERROR") if index == 0 else "BLANK1")
        layout.operator_context = "EXEC_REGION_WIN"
        for kind in island_list.selecting():
            draw_operator(layout, names.SELECT_OPERATOR, text=texts.SELECT_LABELS[kind]).kind = kind
        layout.template_list(
            names.ISLAND_LIST,
            "",
            window_manager,
            names.ISLANDS_PROPERTY,
            window_manager,
            names.ACTIVE_ISLAND_PROPERTY,
            rows=4,
        )


def _is_too_large_to_follow(edit_object: bpy.types.Object) -> bool:
    """Return whether live unwrapping skips a mesh in edit mode for its size."""
    most = user_preferences.read("live_max_faces", user_preferences.LIVE_MAX_FACES)
    return len(bmesh.from_edit_mesh(edit_object.data).faces) > most


def _wrapped(context: bpy.types.Context, text: str) -> list[str]:
    """Return a text in lines that fit beside an icon in the region."""
    preferences = context.preferences
    scale = preferences.system.ui_scale
    # Blender may round the size of its letters up.
    blf.size(0, math.ceil(compatibility.label_points(preferences) * scale))
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and blf.dimensions(0, longer)[0] <= context.region.width - _BESIDE_LINES * scale:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


class _ExtendersPanel(_Panel):
    """The extenders of the active object's mesh."""

    bl_label = texts.EXTENDERS_LABEL
    part = "extenders"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list and the operators on it."""
        layout, mesh = self.layout, context.edit_object.data
        layout.operator_context = "EXEC_REGION_WIN"
        draw_operator(layout, names.ADD_EXTENDER_OPERATOR)
        if not storage.of(mesh):
            return
        layout.template_list(
            names.EXTENDER_LIST, "", mesh, names.EXTENDERS_PROPERTY, mesh, names.ACTIVE_EXTENDER_PROPERTY, rows=4
        )
        column = layout.column()
        column.operator_context = "INVOKE_REGION_WIN"
        draw_operator(column, names.ADJUST_EXTENDER_OPERATOR)
        draw_operator(layout, names.REMOVE_EXTENDER_OPERATOR)


class _ConstraintsPanel(_Panel):
    """Straight edges, rectangles, grids and symmetry of the active object's mesh."""

    bl_label = texts.CONSTRAINTS_LABEL
    part = "constraints"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the operators that add to the list, and the list."""
        layout, mesh = self.layout, context.edit_object.data
        layout.operator_context = "EXEC_REGION_WIN"
        column = layout.column(align=True)
        draw_operator(column, names.STRAIGHTEN_OPERATOR)
        draw_operator(column, names.GRID_OPERATOR)
        draw_operator(column, names.RECTANGLE_OPERATOR)
        draw_operator(column, names.SYMMETRIC_OPERATOR)
        draw_operator(column, names.ALIGN_OPERATOR)
        column = layout.column(align=True)
        for layer, constraint in constraints.of(mesh):
            row = column.row(align=True)
            switch = row.operator(
                names.SWITCH_CONSTRAINT_OPERATOR,
                text=texts.constraint_name(constraint.kind, constraint.number),
                translate=False,
                icon="CHECKBOX_HLT" if constraint.use else "CHECKBOX_DEHLT",
            )
            switch.layer = layer
            row.operator(names.REMOVE_CONSTRAINT_OPERATOR, text="", icon="X").layer = layer


class _MapOverlayPanel(_Panel):
    """The overlay of the active UV map, on the mesh and in the UV editor."""

    bl_label = texts.MAP_OVERLAY_LABEL
    part = "map_overlay"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show the panel where a mesh can be shown."""
        return context.mode in {"EDIT_MESH", "OBJECT"} and getattr(context.space_data, "show_uvedit", True)

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw the switch of the overlay."""
        self.layout.prop(getattr(context.window_manager, names.MAP_OVERLAY_PROPERTY), "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings of the overlay."""
        layout, overlay = self.layout, getattr(context.window_manager, names.MAP_OVERLAY_PROPERTY)
        layout.active = overlay.show
        layout.prop(overlay, "kind", text="")
        if overlay.kind == choices.LOOK_CHECKER:
            layout.prop(overlay, "checks")
        if overlay.kind not in (choices.LOOK_CHECKER, choices.LOOK_DEFECTS, choices.LOOK_STACKS):
            # Room for the whole name, also in the narrow sidebar of old versions.
            row = layout.split(factor=0.65, align=True)
            row.prop(overlay, "use_range")
            row.operator(names.FIT_RANGE_OPERATOR, text=texts.AUTO_LABEL)
            column = layout.column(align=True)
            column.active = overlay.use_range
            column.prop(overlay, "range_low")
            column.prop(overlay, "range_high")
        layout.prop(overlay, "opacity")
        layout.prop(overlay, "legend")
        if context.mode == "EDIT_MESH":
            column = self.layout.column(align=True)
            column.operator_context = "INVOKE_REGION_WIN"
            draw_operator(column, names.INSPECT_OPERATOR)
            column.operator_context = "EXEC_REGION_WIN"
            column.operator_menu_enum(names.SELECT_OPERATOR, "kind", text=texts.SELECT_LABEL)
        self.layout.operator_context = "INVOKE_REGION_WIN"
        draw_operator(self.layout, names.STORE_OPERATOR)


class _DensityPanel(_Panel):
    """The texel density of the selected islands."""

    bl_label = texts.TEXEL_DENSITY_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part = "density"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the sizes of textures, the density and the factor, each with its operators."""
        layout = self.layout
        last = context.window_manager.operator_properties_last
        material = context.edit_object.active_material
        if material is not None:
            layout.prop(material, names.TEXTURE_SIZE_PROPERTY)
        layout.prop(context.scene, names.TEXTURE_SIZE_PROPERTY)
        column = layout.column(align=True)
        # Executed: the fields show what the operators take.
        column.operator_context = "EXEC_REGION_WIN"
        settings = last(names.SET_DENSITY_OPERATOR)
        column.prop(settings, "density")
        row = column.row(align=True)
        row.operator(names.PICK_DENSITY_OPERATOR, text=texts.PICK_LABEL)
        apply = row.operator(names.SET_DENSITY_OPERATOR, text=texts.APPLY_LABEL)
        apply.to, apply.density = choices.DENSITY_NUMBER, settings.density
        row.operator(names.SET_DENSITY_OPERATOR, text=texts.EQUALIZE_LABEL).to = choices.DENSITY_EQUAL
        row = layout.split(factor=0.6, align=True)
        row.operator_context = "EXEC_REGION_WIN"
        settings = last(names.DENSITY_FACTOR_OPERATOR)
        row.prop(settings, "factor")
        draw_operator(row, names.DENSITY_FACTOR_OPERATOR, text=texts.APPLY_LABEL).factor = settings.factor


def _panels() -> list[type]:
    """Return all panels, in the order of work, those with parents after these."""
    parts = (
        _SeamsPanel,
        _SeamSettingsPanel,
        _UnwrapPanel,
        _SettingsPanel,
        _AdvancedPanel,
        _ResultPanel,
        _MapOverlayPanel,
        _ExtendersPanel,
        _ConstraintsPanel,
        _DensityPanel,
    )
    made = []
    for prefix, space in zip(names.PANEL_PREFIXES, ("VIEW_3D", "IMAGE_EDITOR")):
        for order, part in enumerate(parts):
            body = {"bl_idname": prefix + part.part, "bl_space_type": space, "bl_order": order, "__doc__": part.__doc__}
            if part.parent:
                body["bl_parent_id"] = prefix + part.parent
            made.append(type(prefix + part.part, (part, bpy.types.Panel), body))
    return made


# The lists and the panels.
register, unregister = bpy.utils.register_classes_factory(
    (MESH_UL_spectral_extenders, UV_UL_spectral_islands, *_panels())
)
