# SPDX-License-Identifier: GPL-3.0-or-later
"""The translations of `core/words/texts.py`: one file per language, a dictionary from every English text to the other.

The words in braces are fields and stay as they are. Where Blender itself translates a text, as it does "Margin", its
own translation is shown.
"""

from . import de

# By Blender's codes of the languages, in preferences and `bpy.app.translations.locales`; the country may be left out.
TABLES = {"de": de.TEXTS}
