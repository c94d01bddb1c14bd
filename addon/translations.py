# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the tables of `locale` with Blender, and Blender's translation function with `core`."""

import bpy

from . import compatibility, names
from .core.words import translation
from .locale import LANGUAGES, table

# Blender translates labels of operators, their buttons and undo steps in a context of their own, everything else in the
# default one ("*"). Most labels appear in both.
_CONTEXTS = ("*", "Operator")


def register() -> None:
    """Let Blender and the add-on find the translations."""
    entries = {
        language: {(context, text): translated for text, translated in table(language).items() for context in _CONTEXTS}
        for language in LANGUAGES
    }
    bpy.app.translations.register(names.PACKAGE, entries)
    translation.use(compatibility.translated)


def unregister() -> None:
    """Leave texts in English."""
    translation.use(None)
    bpy.app.translations.unregister(names.PACKAGE)
