# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's memory: everything that a module keeps between calls is an object in here.

A module derives a class from `Remembered` and gets its object by `of`. `forget` drops all objects of a lifetime, so
nothing is missed; `begin` lets the parts that follow Blender's data start from its current state.
"""

from collections.abc import Callable
from contextlib import ExitStack
from enum import IntEnum
from typing import TypeVar


class Lifetime(IntEnum):
    """How long something is remembered; the end of a lifetime ends the shorter ones, too."""

    EDIT_MODE = 0
    """Until undo or redo, which replace edit meshes."""
    FILE = 1
    """Until another file is loaded."""
    ADDON = 2
    """Until the add-on is disabled."""


class Remembered:
    """Base of everything remembered, made without arguments."""

    lifetime = Lifetime.FILE

    def end(self) -> None:
        """Remove its timers, drawings, texts and running operators from Blender."""


Kind = TypeVar("Kind", bound=Remembered)

_memory: dict[type[Remembered], Remembered] = {}
_beginnings: list[Callable[[], None]] = []


def of(kind: type[Kind]) -> Kind:
    """Return the object of a kind, made on first use."""
    found = _memory.get(kind)
    if found is None:
        found = _memory[kind] = kind()
    return found


def drop(kind: type[Remembered]) -> None:
    """End and forget one kind."""
    found = _memory.pop(kind, None)
    if found is not None:
        found.end()


def follow(*beginnings: Callable[[], None]) -> None:
    """Set the functions that `begin` calls, in order."""
    _beginnings[:] = beginnings


def begin() -> None:
    """Start from the current file: after loading, undo or redo, and when the add-on is enabled."""
    for beginning in _beginnings:
        beginning()


def forget(lifetime: Lifetime) -> None:
    """End and forget everything of this lifetime or a shorter one, newest first.

    All of it, even after an error, and including objects that are made again meanwhile.
    """
    # A list, because a thread may add to it.
    while kinds := [kind for kind in list(_memory) if kind.lifetime <= lifetime]:
        with ExitStack() as ends:
            for kind in kinds:
                ends.callback(drop, kind)
