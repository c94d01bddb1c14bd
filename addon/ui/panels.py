# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's tab in the 3D viewport and in the UV editor: unwrapping, and the extenders of the active mesh."""

import bpy

from .. import names
from ..core import texts
from ..extenders import storage, tracking


class MESH_UL_spectral_extenders(bpy.types.UIList):
    """The list of extenders."""

    def draw_item(
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        mesh: bpy.types.Mesh,
        extender: bpy.types.PropertyGroup,
        _icon: int,
        _active_data: bpy.types.Mesh,
        _active_property: str,
        index: int = 0,
        _flag: int = 0,
    ) -> None:
        """Draw one extender: which way it acts, or that it is broken; its name; its strength; whether it is on."""
        is_broken = tracking.broken(mesh)[index]
        row = layout.row(align=True)
        content = row.row(align=True)
        content.active = extender.use
        content.alert = is_broken
        split = content.split(factor=0.42 if is_broken else 0.62, align=True)
        split.prop(extender, "name", text="", emboss=False, icon=_icon_of(extender, is_broken))
        if is_broken:
            split.label(text=texts.VERTEX_GONE_LABEL)
        else:
            split.prop(extender, "strength", text="", slider=True)
        row.prop(extender, "use", text="")


def _icon_of(extender: bpy.types.PropertyGroup, is_broken: bool) -> str:
    if is_broken:
        return "ERROR"
    return "FULLSCREEN_ENTER" if extender.strength >= 0.0 else "FULLSCREEN_EXIT"


class _UnwrapPanel:
    """Unwrapping."""

    bl_region_type = "UI"
    bl_category = texts.SIDEBAR_TAB
    bl_label = texts.UNWRAP_LABEL

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show the panel where a mesh is in edit mode and, in an image editor, its UVs are shown."""
        return context.mode == "EDIT_MESH" and getattr(context.space_data, "show_uvedit", True)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the operators and the live toggle."""
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        layout.operator(names.UNWRAP_OPERATOR)
        layout.operator(names.SUGGEST_SEAMS_OPERATOR)
        layout.prop(context.scene, names.LIVE_UNWRAP_PROPERTY)


class _ExtendersPanel(_UnwrapPanel):
    """The extenders of the active object's mesh."""

    bl_label = texts.EXTENDERS_LABEL

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list and the operators on it."""
        layout, mesh = self.layout, context.edit_object.data
        layout.operator_context = "EXEC_REGION_WIN"
        column = layout.column(align=True)
        column.operator(names.ADD_EXTENDER_OPERATOR, icon="ADD").pairs = texts.PAIRS_IN_ORDER
        column.operator(names.ADD_EXTENDER_OPERATOR, text=texts.ADD_TO_ACTIVE_LABEL).pairs = texts.PAIRS_TO_ACTIVE
        if not storage.of(mesh):
            return
        layout.template_list(
            names.EXTENDER_LIST, "", mesh, names.EXTENDERS_PROPERTY, mesh, names.ACTIVE_EXTENDER_PROPERTY, rows=4
        )
        column = layout.column()
        column.operator_context = "INVOKE_REGION_WIN"
        column.operator(names.ADJUST_EXTENDER_OPERATOR, icon="ARROW_LEFTRIGHT").index = -1
        row = layout.row(align=True)
        row.operator(names.SELECT_EXTENDER_OPERATOR, text=texts.SELECT_LABEL).index = -1
        row.operator(names.REMOVE_EXTENDER_OPERATOR, text=texts.REMOVE_LABEL).broken = False
        if any(tracking.broken(mesh)):
            remove = layout.operator(
                names.REMOVE_EXTENDER_OPERATOR, text=texts.REMOVE_BROKEN_EXTENDERS_LABEL, icon="ERROR"
            )
            remove.broken = True


class VIEW3D_PT_spectral_unwrap(_UnwrapPanel, bpy.types.Panel):
    """Unwrapping, in the 3D viewport."""

    bl_idname = names.VIEWPORT_PANEL
    bl_space_type = "VIEW_3D"


class VIEW3D_PT_spectral_extenders(_ExtendersPanel, bpy.types.Panel):
    """Extenders, in the 3D viewport."""

    bl_idname = names.VIEWPORT_EXTENDERS_PANEL
    bl_space_type = "VIEW_3D"


class IMAGE_PT_spectral_unwrap(_UnwrapPanel, bpy.types.Panel):
    """Unwrapping, in the UV editor."""

    bl_idname = names.UV_EDITOR_PANEL
    bl_space_type = "IMAGE_EDITOR"


class IMAGE_PT_spectral_extenders(_ExtendersPanel, bpy.types.Panel):
    """Extenders, in the UV editor."""

    bl_idname = names.UV_EDITOR_EXTENDERS_PANEL
    bl_space_type = "IMAGE_EDITOR"


_CLASSES = (
    MESH_UL_spectral_extenders,
    VIEW3D_PT_spectral_unwrap,
    VIEW3D_PT_spectral_extenders,
    IMAGE_PT_spectral_unwrap,
    IMAGE_PT_spectral_extenders,
)


def register() -> None:
    """Add the list and the panels."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Remove the list and the panels."""
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
