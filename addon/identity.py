# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes told again later: after they were renamed, and after undo, which may make a data-block anew."""

from collections.abc import Iterator
from typing import Any

import bpy


class Identity:
    """Which mesh one is, as long as the file is open."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        """Take the mesh."""
        self._key = _key(mesh)
        self._name = mesh.name_full

    def is_of(self, mesh: bpy.types.Mesh) -> bool:
        """Return whether it is this mesh; one that redo made anew is told by its name."""
        if _key(mesh) != self._key:
            if mesh.name_full != self._name or any(_key(other) == self._key for other in bpy.data.meshes):
                return False
            self._key = _key(mesh)
        self._name = mesh.name_full
        return True


class ByMesh:
    """A value for each of some meshes.

    No generic class: Python keeps those that were given a type, and with them `bpy`, until after Blender has ended.
    """

    def __init__(self) -> None:
        """Hold none."""
        self._values: list[tuple[Identity, Any]] = []

    def get(self, mesh: bpy.types.Mesh) -> Any:  # noqa: ANN401 - whatever was set
        """Return the value of a mesh; None without one."""
        return next(self._of(mesh), None)

    def set(self, mesh: bpy.types.Mesh, value: Any) -> None:  # noqa: ANN401 - of whatever type
        """Give a mesh a value, in place of the one that it has."""
        self._values = [(identity, other) for identity, other in self._values if not identity.is_of(mesh)]
        self._values.append((Identity(mesh), value))

    def clear(self) -> None:
        """Hold none any more."""
        self._values.clear()

    def _of(self, mesh: bpy.types.Mesh) -> Iterator[Any]:
        return (value for identity, value in self._values if identity.is_of(mesh))


def _key(mesh: bpy.types.Mesh) -> int:
    # From 4.2 on Blender has a number of its own for this; before, the address stays but for what redo makes anew.
    return getattr(mesh, "session_uid", 0) or mesh.as_pointer()
