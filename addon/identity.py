# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes told again later: after they were renamed, and after undo, which may make a data-block anew."""

from dataclasses import dataclass

import bpy


@dataclass(eq=False)
class Identity:
    """Which mesh one is, as long as the file is open.

    Attributes:
        key: what Blender tells it by.
        name: the full name that it had when it was seen last.
    """

    key: int
    name: str


_by_key: dict[int, Identity] = {}
_by_name: dict[str, Identity] = {}


def of(mesh: bpy.types.Mesh) -> Identity:
    """Return which mesh this is, the same object each time; one that redo made anew is told by its name."""
    key, name = _key(mesh), mesh.name_full
    if key not in _by_key and name in _by_name:
        _look_again()
    found = _by_key.setdefault(key, Identity(key, name))
    if found.name != name and _by_name.get(found.name) is found:
        del _by_name[found.name]
    found.name = name
    _by_name[name] = found
    return found


def forget() -> None:
    """Forget all meshes, as another file has others."""
    _by_key.clear()
    _by_name.clear()


def _look_again() -> None:
    """Tell all meshes of the file once: those that have gone give way to those that have come with their names."""
    names = {_key(mesh): mesh.name_full for mesh in bpy.data.meshes}
    gone = {found.name: found for key, found in _by_key.items() if key not in names}
    for key, name in names.items():
        if key in _by_key:
            _by_key[key].name = name
        elif name in gone:
            anew = _by_key[key] = _by_key.pop(gone.pop(name).key)
            anew.key = key
    _by_name.clear()
    # Of a name that another has taken, the one that is there.
    for found in sorted(_by_key.values(), key=lambda each: each.key in names):
        _by_name[found.name] = found


def _key(mesh: bpy.types.Mesh) -> int:
    # From 4.2 on Blender has a number of its own for this; before, the address stays but for what redo makes anew.
    return getattr(mesh, "session_uid", 0) or mesh.as_pointer()
