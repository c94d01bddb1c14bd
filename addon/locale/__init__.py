# SPDX-License-Identifier: GPL-3.0-or-later
"""The translations of `core/words/texts.py` and of the solver's sentences: one file per language, a dictionary from
English texts.

Words in braces are fields and stay as they are. For texts that Blender translates, such as "Margin", its own
translation is shown.
"""

from . import de

# By Blender's language codes, as in `bpy.app.translations.locales`; the country may be omitted.
TABLES = {"de": de.TEXTS}
