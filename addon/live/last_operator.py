# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that ended last, which decides whether a change is followed.

An operator that still waits for the mouse is not among those that Blender remembers.
"""

import bpy

from .. import names

_TRANSFORMS = "TRANSFORM_OT_"


def address() -> int:
    """Return a number that identifies the last operator that ended; 0 before the first."""
    operator = _last()
    return operator.as_pointer() if operator else 0


def moves_pins(address_before: int) -> bool:
    """Return whether to follow pins moved since `address_before`: by a transform or a script."""
    last = _ended_since(address_before)
    return last is None or last.bl_idname.startswith(_TRANSFORMS)


def changes_seams(address_before: int) -> bool:
    """Return whether to follow seams changed since `address_before`; not those marked along the islands of a map."""
    last = _ended_since(address_before)
    return last is None or last.bl_idname not in names.OPERATORS_THAT_MARK_SEAMS_OF_A_MAP


def moves_vertices(address_before: int) -> bool:
    """Return whether to follow vertices moved since `address_before`: by an operator that has ended.

    While one runs, Blender has pointers to the mesh. In background mode none does.
    """
    return bpy.app.background or _ended_since(address_before) is not None


def transforms() -> bool:
    """Return whether a transform waits for the mouse; Blenders before 4.2 do not say."""
    windows = bpy.context.window_manager.windows
    return any(
        operator.bl_idname.startswith(_TRANSFORMS)
        for window in windows
        for operator in getattr(window, "modal_operators", ())
    )


def _ended_since(address_before: int) -> bpy.types.Operator | None:
    # Blender forgets all operators when one is unregistered.
    last = _last()
    return None if last is None or last.as_pointer() == address_before else last


def _last() -> bpy.types.Operator | None:
    operators = bpy.context.window_manager.operators
    return operators[-1] if operators else None
