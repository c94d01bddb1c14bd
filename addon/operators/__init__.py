# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's operators: thin classes; the work is in the plain functions beside this package."""

import bpy

from .select_failed import UV_OT_spectral_select_failed
from .unwrap import UV_OT_spectral_unwrap

_CLASSES = (
    UV_OT_spectral_unwrap,
    UV_OT_spectral_select_failed,
)


def register() -> None:
    """Register all operators."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Unregister all operators."""
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
