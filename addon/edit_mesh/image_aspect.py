# SPDX-License-Identifier: GPL-3.0-or-later
"""The aspect of the image of the active face, for Correct Aspect as in Blender."""

from collections.abc import Sequence

import bpy
from bmesh.types import BMesh, BMFace

_IMAGE_NODES = frozenset({"TEX_IMAGE", "TEX_ENVIRONMENT"})


def aspect(edit_object: bpy.types.Object, bm: BMesh) -> float:
    """Return width over height of the image of the active face's material; 1 without an image."""
    face = _active_face(bm) if edit_object.material_slots else None
    return 1.0 if face is None else _of_slot(edit_object, face.material_index)


def aspect_in_object_mode(shown: bpy.types.Object) -> float:
    """Return the same for an object that is not in edit mode."""
    polygons = shown.data.polygons
    return _of_slot(shown, polygons[polygons.active].material_index) if 0 <= polygons.active < len(polygons) else 1.0


def _of_slot(shown: bpy.types.Object, index: int) -> float:
    slots = shown.material_slots
    if index >= len(slots) or slots[index].material is None:
        return 1.0
    tree = slots[index].material.node_tree
    image = active_image(tree) if tree else None
    if image is None or min(image.size) < 1:
        return 1.0
    width, height = (size * stretch for size, stretch in zip(image.size, image.display_aspect))
    return width / height


def _active_face(bm: BMesh) -> BMFace | None:
    """Return the active face, else the one selected last, else any selected one, as Blender does; else a visible one.

    Without a selection, all visible faces are unwrapped, and edges alone may be selected.
    """
    if bm.faces.active is not None:
        return bm.faces.active
    history: Sequence[object] = [element for element in list(bm.select_history) if isinstance(element, BMFace)]
    visible = next((face for face in bm.faces if not face.hide), None)
    return history[-1] if history else next((face for face in bm.faces if face.select), visible)


def active_image(tree: bpy.types.NodeTree) -> bpy.types.Image | None:
    """Return the image of the active texture node, else of the displayed one, else of any."""
    nodes = [node for node in tree.nodes if node.type in _IMAGE_NODES]
    active = [node for node in nodes if node == tree.nodes.active]
    shown = [node for node in nodes if getattr(node, "show_texture", False)]
    return next((node.image for node in (*active, *shown, *reversed(nodes))), None)
