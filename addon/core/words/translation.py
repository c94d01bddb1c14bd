# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks texts up in the language of the user, by a function that the Blender layer hands over."""

from collections.abc import Callable


def _as_it_is(text: str) -> str:
    return text


_look_up: Callable[[str], str] = _as_it_is


def translate(text: str) -> str:
    """Return a text of `texts` in the language of the user; texts that are in no table stay as they are.

    To be called when the text is shown, as the language may change, and in the main thread: Blender looks nothing up in
    others.
    """
    return _look_up(text) if text else text


def use(look_up: Callable[[str], str] | None) -> None:
    """Look texts up with this function from now on; None leaves them in English."""
    global _look_up
    _look_up = look_up or _as_it_is
