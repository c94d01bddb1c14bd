# SPDX-License-Identifier: GPL-3.0-or-later
"""The translations of the add-on's texts and of the solver's sentences: a gettext file for each language.

Words in braces are fields and stay as they are. For texts that Blender translates, such as "Margin", its own
translation is shown.
"""

import json
import re
from pkgutil import get_data

# By Blender's codes, as in `bpy.app.translations.locales`; the country may be omitted.
LANGUAGES = ("de",)

_STRING = r'"(?:[^"\\]|\\.)*"'
_ENTRY = rf"^msgid ((?:{_STRING}\s*)+)^msgstr ((?:{_STRING}\s*)+)"


def table(language: str) -> dict[str, str]:
    """Return the translations into a language, by the English texts."""
    source = get_data(__package__, f"{language}.po").decode()
    found = {_joined(text): _joined(translated) for text, translated in re.findall(_ENTRY, source, re.MULTILINE)}
    # The entry without a text holds facts about the file.
    del found[""]
    return found


def _joined(strings: str) -> str:
    return "".join(map(json.loads, re.findall(_STRING, strings)))
