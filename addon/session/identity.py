# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognize meshes after renaming, and after undo, which may replace a data-block."""

from dataclasses import dataclass

import bpy

from .. import session
from . import Remembered


@dataclass(eq=False)
class Identity:
    """The identity of a mesh while the file is open.

    Attributes:
        key: Blender's number for it.
        name: its last known full name.
    """

    key: int
    name: str


class _Identities(Remembered):
    """The meshes seen, by key and by name."""

    def __init__(self) -> None:
        self.by_key: dict[int, Identity] = {}
        self.by_name: dict[str, Identity] = {}


def of(mesh: bpy.types.Mesh) -> Identity:
    """Return the identity of a mesh; one that redo replaced is found by its name."""
    known = session.of(_Identities)
    number, name = key(mesh), mesh.name_full
    if number not in known.by_key and name in known.by_name:
        _look_again(known)
    found = known.by_key.setdefault(number, Identity(number, name))
    if found.name != name and known.by_name.get(found.name) is found:
        del known.by_name[found.name]
    found.name = name
    known.by_name[name] = found
    return found


def _look_again(known: _Identities) -> None:
    """Match all meshes of the file: new ones replace missing ones of the same name."""
    names = {key(mesh): mesh.name_full for mesh in bpy.data.meshes}
    gone = {found.name: found for number, found in known.by_key.items() if number not in names}
    for number, name in names.items():
        if number in known.by_key:
            known.by_key[number].name = name
        elif name in gone:
            anew = known.by_key[number] = known.by_key.pop(gone.pop(name).key)
            anew.key = number
    known.by_name.clear()
    # A name means the mesh that has it now.
    for found in sorted(known.by_key.values(), key=lambda each: each.key in names):
        known.by_name[found.name] = found


def key(block: bpy.types.ID) -> int:
    """Return Blender's number of a data-block; before 4.2 its address, which redo may change."""
    return getattr(block, "session_uid", 0) or block.as_pointer()
