# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the last result of an operator, where a script can read them: `window_manager["spectral_result"]`."""

import bpy

from .. import names


def store(operator: str, **numbers: float | None) -> None:
    """Store the numbers of an operator's result; those that are None are not known, and left out."""
    known = {name: number for name, number in numbers.items() if number is not None}
    bpy.context.window_manager[names.RESULT_PROPERTY] = {"operator": operator, **known}


def stored() -> dict[str, float]:
    """Return the numbers of the last result."""
    found = bpy.context.window_manager[names.RESULT_PROPERTY].to_dict()
    return {name: number for name, number in found.items() if name != "operator"}
