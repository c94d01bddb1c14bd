# SPDX-License-Identifier: GPL-3.0-or-later
"""Which UV map of a mesh was read, found again when it is renamed or another one is active."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import bpy
from bmesh.types import BMesh, BMLayerItem


class UvMap(NamedTuple):
    """A UV map of a mesh, as it was read.

    Attributes:
        names: of all UV maps of the mesh then.
        place: of this one among them.
    """

    names: tuple[str, ...]
    place: int

    @classmethod
    def active(cls, bm: BMesh) -> UvMap | None:
        """Return the active UV map of an edit mesh; None if there is none."""
        layers = bm.loops.layers.uv
        found = layers.active
        return None if found is None else cls(tuple(layers.keys()), layers.keys().index(found.name))

    def name(self, names: Sequence[str]) -> str | None:
        """Return the map's name among those of the mesh now; None if it is gone.

        A map that is missing has been renamed if there are as many as before and a new name stands in its place.
        """
        own = self.names[self.place]
        if own in names:
            return own
        if len(names) == len(self.names) and names[self.place] not in self.names:
            return names[self.place]
        return None

    def layer(self, bm: BMesh) -> BMLayerItem | None:
        """Return the map in an edit mesh; None if it is gone."""
        layers = bm.loops.layers.uv
        name = self.name(layers.keys())
        return None if name is None else layers[name]

    def of(self, mesh: bpy.types.Mesh) -> bpy.types.MeshUVLoopLayer | None:
        """Return the map of a mesh that is not in edit mode; None if it is gone."""
        name = self.name(mesh.uv_layers.keys())
        return None if name is None else mesh.uv_layers[name]
