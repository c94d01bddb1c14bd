# SPDX-License-Identifier: GPL-3.0-or-later
"""Translation into the language of the user, by a function of the Blender layer."""

from collections.abc import Callable


def _as_it_is(text: str) -> str:
    return text


_look_up: Callable[[str], str] = _as_it_is


def translate(text: str) -> str:
    """Return a text of `texts` in the language of the user; a text without a translation stays.

    Call it when the text is shown, because the language may change, and in the main thread only.
    """
    return _look_up(text) if text else text


def use(look_up: Callable[[str], str] | None) -> None:
    """Translate with this function from now on; None leaves texts in English."""
    global _look_up
    _look_up = look_up or _as_it_is
