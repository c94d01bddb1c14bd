# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's tab in the 3D viewport and in the UV editor, with its panels in the order of work."""

import bpy

from .. import compatibility, editors, names, user_preferences
from ..core import choices
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh import extenders as storage
from ..edit_mesh import shapes, texture_size
from ..overlay import map_overlay
from ..session import edit_meshes
from ..unwrapping import island_list, packing
from . import settings, widths
from .icons import OF, OF_SHAPE, draw_operator, draw_shapes

_VERBS = (names.UNWRAP_OPERATOR, names.RELAX_OPERATOR, names.PACK_OPERATOR)
_TILE_MOVES = (("X", -1, "TRIA_LEFT"), ("X", 1, "TRIA_RIGHT"), ("Y", -1, "TRIA_DOWN"), ("Y", 1, "TRIA_UP"))


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


class MESH_UL_spectral_shapes(_List, bpy.types.UIList):
    """The list of stored shapes."""

    def draw_row(
        self, layout: bpy.types.UILayout, mesh: bpy.types.Mesh, shape: bpy.types.PropertyGroup, index: int
    ) -> None:
        """Draw one shape: its kind, or that a vertex is lost; its name; the amount of a push; on or off; remove."""
        is_push = shape.kind == choices.SHAPE_EXTENDER
        is_broken = is_push and storage.is_broken(mesh, shape.layer)
        row = layout.row(align=True)
        content = row.row(align=True)
        content.active = shape.use
        content.alert = is_broken
        icon = "ERROR" if is_broken else OF_SHAPE[shape.kind]
        if not is_push:
            content.label(text=shape.name, translate=False, icon=icon)
        else:
            split = content.split(factor=0.42 if is_broken else 0.62, align=True)
            split.prop(shape, "name", text="", emboss=False, icon=icon)
            if is_broken:
                split.label(text="Vertex lost")
            else:
                split.prop(shape, "amount", text="", slider=True)
        row.prop(shape, "use", text="")
        row.operator(
            names.REMOVE_SHAPE_OPERATOR, text="", icon=OF[names.REMOVE_SHAPE_OPERATOR], emboss=False
        ).index = index


class UV_UL_spectral_islands(_List, bpy.types.UIList):
    """The list of islands."""

    def draw_row(
        self,
        layout: bpy.types.UILayout,
        _manager: bpy.types.WindowManager,
        island: bpy.types.PropertyGroup,
        index: int,
    ) -> None:
        """Draw one island: its distortion, its faces and what is wrong with it."""
        layout.label(text=island.name, icon="ERROR" if island_list.is_bad(index) else "UV_ISLANDSEL")


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


class _MainPanel(_Panel):
    """The four verbs, and the settings that artists change most."""

    bl_label = texts.SIDEBAR_TAB
    part = "main"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw seams, unwrap, relax and pack, and what the next of them goes by."""
        layout, scene = self.layout, context.scene
        layout.operator_context = "INVOKE_REGION_WIN"
        draw_operator(layout, names.SUGGEST_SEAMS_OPERATOR)
        row = layout.row(align=True)
        columns = min(len(texts.VERBS), widths.columns(context, texts.VERBS))
        grid = row.grid_flow(row_major=True, columns=columns, even_columns=True, align=True)
        for operator, label in zip(_VERBS, texts.VERBS):
            grid.operator(operator, text=label)
        # Blender's own: a new map, a copy of the active one.
        row.operator("mesh.uv_texture_add", text="", icon="ADD")
        unwrap = settings.last(names.UNWRAP_OPERATOR)
        column = layout.column(align=True)
        column.prop(unwrap, "area_blend")
        row = column.row(align=True)
        row.prop(unwrap, "fold_free", toggle=True)
        row.prop(unwrap, "keep_in_place", toggle=True)
        column.prop(unwrap, "straighten", toggle=True)
        column.prop(scene, names.LIVE_UNWRAP_PROPERTY, toggle=True)
        if getattr(scene, names.LIVE_UNWRAP_PROPERTY) and _is_too_large_to_follow(context.edit_object):
            column.label(text="Too many faces to follow", icon="ERROR")
            column.label(text=texts.LIMIT_IN_PREFERENCES, icon="BLANK1")
        column = layout.column(align=True)
        row = column.row(align=True)
        row.prop(scene, names.TEXTURE_SIZE_PROPERTY, text="Texture")
        draw_operator(row, names.NEW_TEXTURES_OPERATOR, text="")
        row = column.row(align=True)
        for label, side in texts.TEXTURE_SIZES:
            choice = row.operator("wm.context_set_int", text=label)
            choice.data_path, choice.value = f"scene.{names.TEXTURE_SIZE_PROPERTY}", side
        if known := texture_size.of_materials(context):
            shown = translate("Of the material: {side} px").format(side=format(known, ".0f"))
            column.label(text=shown, translate=False, icon="INFO")
        column.prop(scene, names.MARGIN_PROPERTY)
        row = column.split(factor=0.3, align=True)
        row.label(text="Rotation")
        row.prop(scene, names.ROTATION_PROPERTY, text="")
        column.label(text=texts.last_fill(packing.last_fill()), translate=False)


class _SeamsPanel(_Panel):
    """Seams by hand, hints, and the settings of the next search; these change the running preview."""

    bl_label = texts.SEAMS_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "seams", "main"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the operators that make and clear seams and hints, and the settings."""
        column = self.layout.column(align=True)
        row = column.row(align=True)
        row.operator("uv.seams_from_islands", text="From Islands")
        row.operator("mesh.mark_seam", text="Clear Selected").clear = True
        row = column.row(align=True)
        for hint, label, _ in texts.SEAM_HINTS:
            if hint == "CLEAR":
                row.operator(names.SEAM_HINT_OPERATOR, text="", icon="X").hint = hint
            else:
                row.operator(names.SEAM_HINT_OPERATOR, text=label).hint = hint
        settings.draw_seams(context, self.layout, settings.last(names.SUGGEST_SEAMS_OPERATOR), is_narrow=True)


class _AdvancedPanel(_Panel):
    """What an expert needs once a month."""

    bl_label = texts.ADVANCED_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "advanced", "main"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the rest of the settings of each verb."""
        layout = self.layout
        of_verbs = (settings.draw_advanced, settings.draw_relax, settings.draw_pack)
        for operator, label, draw in zip(_VERBS, texts.VERBS, of_verbs):
            # Translated as the buttons are.
            layout.label(text=label, text_ctxt="Operator", icon=OF[operator])
            draw(layout.column(), settings.last(operator), is_narrow=True)
            layout.separator()
        layout.label(text="New Textures", icon=OF[names.NEW_TEXTURES_OPERATOR])
        layout.prop(settings.last(names.NEW_TEXTURES_OPERATOR), "size", text="")


class _ResultPanel(_Panel):
    """The result of the last unwrap."""

    bl_label = "Last Result"
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "result", "main"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the reports, line by line, and the islands, which select their faces."""
        layout, window_manager = self.layout, context.window_manager
        reported = island_list.lines()
        if not reported:
            layout.label(text="Nothing unwrapped yet")
            return
        column = layout.column(align=True)
        column.scale_y = 0.8
        for level, text in reported:
            for index, line in enumerate(widths.wrapped(context, text)):
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
    known = edit_meshes.kept(edit_object.data)
    return known is not None and len(known.bm.faces) > most


class _ShapesPanel(_Panel):
    """What the map is bound to."""

    bl_label = texts.SHAPE_PANEL_LABEL
    part = "shapes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the kinds, and the list of what is stored with the active object's mesh."""
        layout, mesh = self.layout, context.edit_object.data
        layout.operator_context = "EXEC_REGION_WIN"
        columns = min(2, widths.columns(context, [label for _, label, _ in texts.SHAPE_ITEMS], has_icons=True))
        draw_shapes(layout.grid_flow(row_major=True, columns=columns, even_columns=True, align=True))
        if context.space_data.type == "IMAGE_EDITOR":
            _draw_of_islands(layout, context)
        if not shapes.listed(mesh):
            return
        layout.template_list(
            names.SHAPE_LIST, "", mesh, names.SHAPES_PROPERTY, mesh, names.ACTIVE_SHAPE_PROPERTY, rows=3
        )
        if storage.of(mesh):
            layout.operator_context = "INVOKE_REGION_WIN"
            draw_operator(layout, names.EXTENDER_OPERATOR)


def _draw_of_islands(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw operators for selected UVs that belong to this work: Blender's own, where this version has them."""
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    grid.operator_context = "INVOKE_REGION_WIN"
    # Blender translates these into few languages.
    grid.operator("uv.stitch", text="Stitch")
    grid.operator("uv.weld", text="Weld")
    grid.operator("uv.select_similar", text="Find Similar")
    if compatibility.HAS_ARRANGE_ISLANDS:
        grid.operator("uv.arrange_islands", text="Arrange").margin = texture_size.margin(context)
    else:
        grid.operator(names.ARRANGE_OPERATOR, text="Arrange")
    row = layout.row(align=True)
    row.operator_context = "EXEC_REGION_WIN"
    row.label(text="UV Tile")
    for axis, tiles, icon in _TILE_MOVES:
        compatibility.draw_tile_move(row, axis, tiles, icon)


class _OverlayPanel(_Panel):
    """A panel that also exists in object mode."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show the panel where a mesh can be shown."""
        return context.mode in {"EDIT_MESH", "OBJECT"} and getattr(context.space_data, "show_uvedit", True)


class _MapOverlayPanel(_OverlayPanel):
    """The overlay of the active UV map, on the mesh and in the UV editor."""

    # Short: the number stands beside it.
    bl_label = "Overlay"
    part = "map_overlay"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw the switch of the overlay."""
        self.layout.prop(_overlay(context), "show", text="")

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Draw the number of the shown maps at the other end."""
        self.layout.label(text=map_overlay.figure(context), translate=False)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what is shown, and what is selected by it."""
        layout, overlay = self.layout, _overlay(context)
        row = layout.row(align=True)
        row.active = overlay.show
        row.prop(overlay, "kind", text="")
        if context.mode == "EDIT_MESH":
            row = layout.row(align=True)
            row.operator_context = "EXEC_REGION_WIN"
            row.operator_menu_enum(names.SELECT_OPERATOR, "kind", text="Select")
            row.operator_context = "INVOKE_REGION_WIN"
            draw_operator(row, names.INSPECT_OPERATOR)


class _OverlaySettingsPanel(_OverlayPanel):
    """How the overlay draws."""

    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}
    part, parent = "overlay_settings", "map_overlay"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings of the overlay."""
        layout, overlay = self.layout, _overlay(context)
        layout.active = overlay.show
        if overlay.kind == choices.LOOK_CHECKER:
            layout.prop(overlay, "checks")
        if overlay.kind not in (choices.LOOK_CHECKER, choices.LOOK_DEFECTS, choices.LOOK_STACKS):
            # In the default context Blender's German is too long.
            layout.prop(overlay, "use_range", text="Custom Range", text_ctxt="Operator")
            column = layout.column(align=True)
            column.active = overlay.use_range
            column.prop(overlay, "range", index=0, text="Low")
            column.prop(overlay, "range", index=1, text="High")
        layout.prop(overlay, "opacity")
        layout.prop(overlay, "legend")
        self.layout.operator_context = "INVOKE_REGION_WIN"
        draw_operator(self.layout, names.STORE_OPERATOR)


def _overlay(context: bpy.types.Context) -> bpy.types.PropertyGroup:
    return getattr(context.window_manager, names.MAP_OVERLAY_PROPERTY)


class _DensityPanel(_Panel):
    """The texel density of the selected islands."""

    bl_label = texts.TEXEL_DENSITY_LABEL
    bl_options = {"DEFAULT_CLOSED"}
    part = "density"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the sizes of textures, the density and the factor, each with its operators."""
        layout = self.layout
        material = context.edit_object.active_material
        if material is not None:
            layout.prop(material, names.TEXTURE_SIZE_PROPERTY)
        column = layout.column(align=True)
        # Executed: the fields show what the operators take.
        column.operator_context = "EXEC_REGION_WIN"
        last = settings.last(names.DENSITY_OPERATOR)
        row = column.split(factor=0.7, align=True)
        row.prop(last, "density", text=texts.density_unit(texture_size.texels(context).symbol), translate=False)
        row.operator(names.DENSITY_OPERATOR, text="Pick").kind = choices.DENSITY_PICKED
        row = column.row(align=True)
        apply = row.operator(names.DENSITY_OPERATOR, text=texts.APPLY_LABEL)
        apply.kind, apply.density = choices.DENSITY_NUMBER, last.density
        row.operator(names.DENSITY_OPERATOR, text=texts.EQUALIZE_LABEL).kind = choices.DENSITY_EQUAL
        row = layout.split(factor=0.6, align=True)
        row.operator_context = "EXEC_REGION_WIN"
        row.prop(last, "factor")
        apply = row.operator(names.DENSITY_OPERATOR, text=texts.APPLY_LABEL)
        apply.kind, apply.factor = choices.DENSITY_FACTOR, last.factor


def _panels() -> list[type]:
    """Return all panels, in the order of work, those with parents after these."""
    parts = (
        *(_MainPanel, _SeamsPanel, _AdvancedPanel, _ResultPanel),
        *(_MapOverlayPanel, _OverlaySettingsPanel, _ShapesPanel, _DensityPanel),
    )
    made = []
    for prefix, space in zip(names.PANEL_PREFIXES, editors.KINDS):
        for order, part in enumerate(parts):
            body = {"bl_idname": prefix + part.part, "bl_space_type": space, "bl_order": order, "__doc__": part.__doc__}
            if part.parent:
                body["bl_parent_id"] = prefix + part.parent
            made.append(type(prefix + part.part, (part, bpy.types.Panel), body))
    return made


# The lists and the panels.
register, unregister = bpy.utils.register_classes_factory((MESH_UL_spectral_shapes, UV_UL_spectral_islands, *_panels()))
