# SPDX-License-Identifier: GPL-3.0-or-later
"""The face of the shown maps under the mouse, in the 3D viewport and the UV editor."""

from dataclasses import dataclass

import bpy
from bpy_extras import view3d_utils
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..core.measure.map_view import MapView
from . import map_overlay


@dataclass(frozen=True)
class FaceBelow:
    """A face of the mesh of an object, and the view of its map."""

    shown: bpy.types.Object
    view: MapView
    face: int


def face_below(
    context: bpy.types.Context, area: bpy.types.Area, region: bpy.types.Region, x: float, y: float
) -> FaceBelow | None:
    """Return the face at a point of a region, in pixels from its lower left corner; None for none."""
    if area.type == "IMAGE_EDITOR":
        return _in_uv_editor(context, region.view2d.region_to_view(x, y))
    return _in_viewport(context, area.spaces.active, *ray(area, region, x, y))


def ray(area: bpy.types.Area, region: bpy.types.Region, x: float, y: float) -> tuple[Vector, Vector]:
    """Return the world positions of two points below a point of a 3D viewport, the first the nearer one."""
    # Regions of a quad view have their own view.
    view = area.spaces.active.region_3d
    if area.spaces.active.region_quadviews:
        quads = [each for each in area.regions if each.type == "WINDOW"]
        view = area.spaces.active.region_quadviews[quads.index(region)]
    origin = view3d_utils.region_2d_to_origin_3d(region, view, (x, y))
    return origin, origin + view3d_utils.region_2d_to_vector_3d(region, view, (x, y))


def cast(shown: bpy.types.Object, tree: BVHTree, origin: Vector, toward: Vector) -> tuple[Vector | None, int | None]:
    """Return where a ray, by two points in the world, hits the tree of an object, in its space, and the face hit."""
    if abs(shown.matrix_world.determinant()) < 1e-30:
        return None, None
    inverse = shown.matrix_world.inverted()
    start = inverse @ origin
    hit, _, face, _ = tree.ray_cast(start, inverse @ toward - start)
    return hit, face


def _in_uv_editor(context: bpy.types.Context, place: tuple[float, float]) -> FaceBelow | None:
    for shown, _, view in map_overlay.views(context):
        face = view.face_at(place)
        if face >= 0:
            return FaceBelow(shown, view, face)
    return None


def _in_viewport(
    context: bpy.types.Context, space: bpy.types.SpaceView3D, origin: Vector, toward: Vector
) -> FaceBelow | None:
    nearest, found = float("inf"), None
    for shown, mesh, view in map_overlay.views(context):
        if not shown.visible_in_viewport_get(space):
            continue
        hit, triangle = cast(shown, mesh.tree(), origin, toward)
        if hit is None:
            continue
        distance = (shown.matrix_world @ hit - origin).length
        if distance < nearest:
            nearest, found = distance, FaceBelow(shown, view, int(view.triangles[1][triangle]))
    return found
