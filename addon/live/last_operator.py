# SPDX-License-Identifier: GPL-3.0-or-later
"""Which operator has ended last, which tells whether a change is one to follow.

While an operator waits for the mouse, it is not yet among those that Blender remembers.
"""

import bpy

from .. import names

_TRANSFORMS = "TRANSFORM_OT_"


def address() -> int:
    """Return a number for the last operator that ended, 0 before the first; another one makes it another number."""
    operator = _last()
    return operator.as_pointer() if operator else 0


def moves_pins(address_before: int) -> bool:
    """Return whether pins moved since `address_before` are to be followed: by a transform, or by a script."""
    last = _ended_since(address_before)
    return last is None or last.bl_idname.startswith(_TRANSFORMS)


def changes_seams(address_before: int) -> bool:
    """Return whether seams changed since `address_before` are to be followed; those of a map are there to keep it."""
    last = _ended_since(address_before)
    return last is None or last.bl_idname not in names.OPERATORS_THAT_MARK_SEAMS_OF_A_MAP


def _ended_since(address_before: int) -> bpy.types.Operator | None:
    # Blender forgets all operators when one is unregistered.
    last = _last()
    return None if last is None or last.as_pointer() == address_before else last


def _last() -> bpy.types.Operator | None:
    operators = bpy.context.window_manager.operators
    return operators[-1] if operators else None
