# SPDX-License-Identifier: GPL-3.0-or-later
"""The one memory of the add-on: whatever a module knows from one call to the next is an object in here.

A module derives a class from `Remembered` and asks for its object by `of`. So forgetting cannot miss anything:
`forget` drops all objects of a lifetime, `begin` lets the parts that follow Blender's data take up what there is now.
"""

from collections.abc import Callable
from contextlib import ExitStack
from enum import IntEnum
from typing import TypeVar


class Lifetime(IntEnum):
    """How long something is remembered; what ends one lifetime ends the shorter ones, too."""

    EDIT_MODE = 0
    """Until undo or redo, which make edit meshes anew."""
    FILE = 1
    """Until another file is loaded."""
    ADDON = 2
    """Until the add-on is disabled."""


class Remembered:
    """Base of everything remembered, made without arguments."""

    lifetime = Lifetime.FILE

    def end(self) -> None:
        """Take back what Blender has of it: timers, drawings, texts, operators that run."""


Kind = TypeVar("Kind", bound=Remembered)

_memory: dict[type[Remembered], Remembered] = {}
_beginnings: list[Callable[[], None]] = []


def of(kind: type[Kind]) -> Kind:
    """Return what is remembered of a kind; made when it is first asked for."""
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
    """Let `begin` call these functions, in this order."""
    _beginnings[:] = beginnings


def begin() -> None:
    """Take up the file as it is: after loading, undo or redo, and when the add-on is enabled."""
    for beginning in _beginnings:
        beginning()


def forget(lifetime: Lifetime) -> None:
    """End and forget everything that is remembered no longer than this, the newest first.

    All of it, also where something raises an error; and what the ends of others have made again.
    """
    # A list: a thread may remember something meanwhile.
    while kinds := [kind for kind in list(_memory) if kind.lifetime <= lifetime]:
        with ExitStack() as ends:
            for kind in kinds:
                ends.callback(drop, kind)
