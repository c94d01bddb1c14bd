# SPDX-License-Identifier: GPL-3.0-or-later
"""All handlers of the add-on: updates, undo and loading, in the right order.

They run often and mostly have nothing to do; then they return as early as possible.
"""

import bpy
from bpy.app.handlers import persistent

from . import editors, session
from .edit_mesh import shapes
from .live import following, undo_steps
from .overlay import drawn_meshes, edge_lines, extender_arrows, map_overlay
from .session import Lifetime, edit_meshes
from .unwrapping import island_list


@persistent
def _on_depsgraph_update(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if depsgraph.mode == "RENDER":
        # In a thread of its own.
        return
    map_overlay.on_update(depsgraph)
    edge_lines.on_update(depsgraph)
    if bpy.context.mode != "EDIT_MESH" and len(bpy.context.window_manager.windows) < 2:
        edit_meshes.let_go_left()
        return
    meshes = _updated(depsgraph)
    if meshes:
        shapes.follow(meshes)
        drawn_meshes.keep(meshes)
        following.on_update(scene, meshes)


@persistent
def _on_frame_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    # A change of the frame causes only this event.
    if depsgraph.mode != "RENDER":
        map_overlay.on_update(depsgraph)


@persistent
def _before_undo(*_arguments: object) -> None:
    undo_steps.leave()
    island_list.leave()
    session.forget(Lifetime.EDIT_MODE)


@persistent
def _before_load(*_arguments: object) -> None:
    session.forget(Lifetime.FILE)


@persistent
def _after_undo(*_arguments: object) -> None:
    undo_steps.arrive(is_undo=True)
    session.begin()


@persistent
def _after_redo(*_arguments: object) -> None:
    undo_steps.arrive(is_undo=False)
    session.begin()


@persistent
def _after_load(*_arguments: object) -> None:
    session.begin()
    # From 5.0, meshes saved in edit mode enter it only after loading.
    _begin_soon()


def _updated(depsgraph: bpy.types.Depsgraph) -> list[bpy.types.Mesh]:
    """Return the meshes in edit mode, each once, with updates of more than the selection."""
    blocks = [update.id.original for update in depsgraph.updates if update.is_updated_geometry]
    data = [block.data if isinstance(block, bpy.types.Object) else block for block in blocks]
    meshes = {block.as_pointer(): block for block in data if isinstance(block, bpy.types.Mesh)}
    return [mesh for mesh in meshes.values() if mesh.is_editmode]


def _redraw() -> None:
    # From 5.0 Blender does not, where an add-on is enabled.
    editors.redraw(bpy.context)


def _begin_soon() -> None:
    """Begin once Blender has finished the current event; never in background mode."""
    _begin_never()
    if not bpy.app.background:
        # Registered again, because a timer that is due would run within the current event.
        bpy.app.timers.register(session.begin, first_interval=0.0, persistent=True)


def _begin_never() -> None:
    """Cancel `_begin_soon`."""
    if bpy.app.timers.is_registered(session.begin):
        bpy.app.timers.unregister(session.begin)


_HANDLERS = (
    ("depsgraph_update_post", _on_depsgraph_update),
    ("frame_change_post", _on_frame_change),
    ("undo_pre", _before_undo),
    ("redo_pre", _before_undo),
    ("undo_post", _after_undo),
    ("redo_post", _after_redo),
    ("load_pre", _before_load),
    ("load_post", _after_load),
    # If a file cannot be read, the former one stays open.
    *([("load_post_fail", _after_load)] if hasattr(bpy.app.handlers, "load_post_fail") else []),
)


def register() -> None:
    """Add the handlers."""
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)
    map_overlay.add_draw_handlers()
    extender_arrows.add_draw_handlers()
    edge_lines.add_draw_handlers()
    session.follow(
        shapes.follow, drawn_meshes.keep, following.begin, map_overlay.edited, island_list.look_back, _redraw
    )
    # While add-ons are being enabled, Blender restricts access to its data.
    _begin_soon()


def unregister() -> None:
    """Remove the handlers, and end and forget everything."""
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    _begin_never()
    session.forget(Lifetime.ADDON)
