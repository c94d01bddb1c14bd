# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognizes meshes: after they were renamed, and after undo, which may make a data-block anew."""

from dataclasses import dataclass

import bpy

from .. import session
from . import Remembered


@dataclass(eq=False)
class Identity:
    """Which mesh one is, as long as the file is open.

    Attributes:
        key: Blender's number for it.
        name: the full name that it had when it was seen last.
    """

    key: int
    name: str


class _Identities(Remembered):
    """The meshes seen, by key and by name."""

    def __init__(self) -> None:
        self.by_key: dict[int, Identity] = {}
        self.by_name: dict[str, Identity] = {}


def of(mesh: bpy.types.Mesh) -> Identity:
    """Return which mesh this is, the same object each time; one that redo made anew is found by its name."""
    known = session.of(_Identities)
    key, name = _key(mesh), mesh.name_full
    if key not in known.by_key and name in known.by_name:
        _look_again(known)
    found = known.by_key.setdefault(key, Identity(key, name))
    if found.name != name and known.by_name.get(found.name) is found:
        del known.by_name[found.name]
    found.name = name
    known.by_name[name] = found
    return found


def _look_again(known: _Identities) -> None:
    """Look once at all meshes of the file: those that have gone give way to those that have come with their names."""
    names = {_key(mesh): mesh.name_full for mesh in bpy.data.meshes}
    gone = {found.name: found for key, found in known.by_key.items() if key not in names}
    for key, name in names.items():
        if key in known.by_key:
            known.by_key[key].name = name
        elif name in gone:
            anew = known.by_key[key] = known.by_key.pop(gone.pop(name).key)
            anew.key = key
    known.by_name.clear()
    # Where another mesh has taken a name, the name means the mesh that is there.
    for found in sorted(known.by_key.values(), key=lambda each: each.key in names):
        known.by_name[found.name] = found


def _key(mesh: bpy.types.Mesh) -> int:
    # From 4.2 on Blender has a number for this; before, the address stays except where redo makes the mesh anew.
    return getattr(mesh, "session_uid", 0) or mesh.as_pointer()
