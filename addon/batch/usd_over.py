# SPDX-License-Identifier: GPL-3.0-or-later
"""A USD layer with nothing but texture coordinates, over a source that stays untouched."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np

from ..core.errors import ReadableError
from ..core.map_view import MapArrays


class UsdError(ReadableError):
    """The layer cannot be made; the message says why and what to do."""


def write(path: Path, source: Path, target: Path, maps: Sequence[tuple[str, MapArrays]]) -> None:
    """Write the layer to `path`; its reference to the source holds when it is moved to `target`.

    Args:
        path: of the layer, to be written.
        source: the USD file that Blender has read.
        target: where the layer will lie.
        maps: name of the mesh in Blender, which is that of its prim, and its arrays with the faces in the prim's order.

    Raises:
        UsdError: this Blender comes without USD for Python, or a mesh has not one prim of its name and faces.
    """
    # From Blender 4.4 on USD for Python comes along, and is not found before this.
    getattr(bpy.utils, "expose_bundled_modules", lambda: None)()
    try:
        from pxr import Sdf, Usd, UsdGeom
    except ImportError as error:
        raise UsdError(
            "This Blender has no USD for Python (pxr), which comes with 4.4 and later: leave out --usd-over."
        ) from error
    stage = Usd.Stage.Open(str(source))
    if not stage:
        raise UsdError(f"{source.name} is no USD that can be opened.")
    layer = Sdf.Layer.CreateNew(str(path))
    layer.subLayerPaths.append(Path(os.path.relpath(source, target.parent)).as_posix())
    root = stage.GetRootLayer()
    if root.defaultPrim:
        layer.defaultPrim = root.defaultPrim
    layer.pseudoRoot.SetInfo("upAxis", UsdGeom.GetStageUpAxis(stage))
    layer.pseudoRoot.SetInfo("metersPerUnit", UsdGeom.GetStageMetersPerUnit(stage))
    prims = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    over = Usd.Stage.Open(layer)
    for name, arrays in maps:
        prim = _prim_of(name, arrays, prims)
        api = UsdGeom.PrimvarsAPI(over.OverridePrim(prim.GetPath()))
        variable = api.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
        variable.Set([tuple(point) for point in _in_prims_order(prim, arrays).tolist()])
        # Of an earlier map, which would count in its place.
        variable.BlockIndices()
    layer.Save()


def _prim_of(name: str, arrays: MapArrays, prims: Sequence[object]) -> object:
    sizes = np.diff(arrays.face_offsets)
    alike = [prim for prim in prims if np.array_equal(np.asarray(prim.GetFaceVertexCountsAttr().Get()), sizes)]
    named = [prim for prim in alike if name in (prim.GetPrim().GetName(), prim.GetPrim().GetParent().GetName())]
    found = named or alike
    if len(found) != 1:
        raise UsdError(
            f"{len(found)} meshes of the USD have the faces of {name}, and one is needed: leave out --usd-over."
        )
    return found[0]


def _in_prims_order(prim: object, arrays: MapArrays) -> np.ndarray:
    """Return the UVs (C, 2) in the order of the prim's corners, which Blender turns in left-handed meshes."""
    indices = np.asarray(prim.GetFaceVertexIndicesAttr().Get())
    uv, mine, offsets = arrays.uv, arrays.corner_vertices, arrays.face_offsets
    if np.array_equal(indices, mine):
        return uv
    result = np.empty_like(uv)
    for start, end in zip(offsets[:-1], offsets[1:]):
        place = {vertex: corner for corner, vertex in enumerate(mine[start:end], start)}
        if set(place) != set(indices[start:end].tolist()):
            raise UsdError(f"Blender changed the faces of {prim.GetPath()} when it read them: leave out --usd-over.")
        result[start:end] = uv[[place[vertex] for vertex in indices[start:end]]]
    return result
