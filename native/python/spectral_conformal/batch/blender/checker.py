"""Render meshes with a checker in their UV maps."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Sequence
from math import radians
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

from ...assets import AssetMesh
from ...assets.temporary import temporary_beside
from . import meshes

_CHECKS = 40.0
_SAMPLES = 16
_LENS_DISTANCE = 2.4
# The brightness of a face seen edge-on, relative to one seen face-on.
_EDGE_ON = 0.4


def render(path: Path, size: int, shown: Sequence[AssetMesh], y_is_up: bool) -> None:
    """Render meshes obliquely from above to a PNG of `size` pixels, with Cycles, which needs no graphics card.

    The shading of a face depends only on its angle to the camera, on both sides alike, so there are no shadows.
    Blender's previous data is lost.
    """
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    objects = meshes.link(shown, scene)
    if y_is_up:
        for item in objects:
            item.matrix_world = Matrix.Rotation(radians(90.0), 4, "X") @ item.matrix_world
    corners = [item.matrix_world @ Vector(corner) for item in objects for corner in item.bound_box]
    low, high = (Vector(tuple(pick(corner[axis] for corner in corners) for axis in range(3))) for pick in (min, max))
    center, radius = (low + high) / 2.0, max((high - low).length / 2.0, 1e-6)
    direction = Vector((1.0, -1.5, 0.9)).normalized()
    material = _material(direction)
    for item in objects:
        item.data.materials.append(material)
    camera = bpy.data.cameras.new("checker")
    camera.clip_start, camera.clip_end = radius * 1e-3, radius * 20.0
    holder = bpy.data.objects.new("checker", camera)
    holder.location = center + direction * radius * _LENS_DISTANCE * 1.2
    holder.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(holder)
    world = bpy.data.worlds.new("checker")
    scene.camera, scene.world = holder, world
    # Our own name: Blender interprets braces in the user's names as templates.
    with tempfile.TemporaryDirectory() as folder:
        _set_up(scene, world, Path(folder) / "checker.png", size)
        bpy.ops.render.render(write_still=True)
        partial = temporary_beside(path)
        try:
            shutil.copyfile(scene.render.filepath, partial)
            partial.replace(path)
        finally:
            partial.unlink(missing_ok=True)


def _material(toward_camera: Vector) -> bpy.types.Material:
    material = bpy.data.materials.new("checker")
    nodes = shader_nodes(material)
    links = material.node_tree.links
    nodes.clear()
    output, light = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeEmission")
    facing, both_sides = nodes.new("ShaderNodeVectorMath"), nodes.new("ShaderNodeMath")
    shade, geometry = nodes.new("ShaderNodeMath"), nodes.new("ShaderNodeNewGeometry")
    checks, coordinates = nodes.new("ShaderNodeTexChecker"), nodes.new("ShaderNodeTexCoord")
    checks.inputs["Scale"].default_value = _CHECKS
    checks.inputs["Color1"].default_value = (0.8, 0.8, 0.8, 1.0)
    checks.inputs["Color2"].default_value = (0.1, 0.2, 0.5, 1.0)
    facing.operation, both_sides.operation, shade.operation = "DOT_PRODUCT", "ABSOLUTE", "MULTIPLY_ADD"
    facing.inputs[1].default_value = toward_camera
    shade.inputs[1].default_value, shade.inputs[2].default_value = 1.0 - _EDGE_ON, _EDGE_ON
    links.new(geometry.outputs["Normal"], facing.inputs[0])
    links.new(facing.outputs["Value"], both_sides.inputs[0])
    links.new(both_sides.outputs["Value"], shade.inputs[0])
    links.new(coordinates.outputs["UV"], checks.inputs["Vector"])
    links.new(checks.outputs["Color"], light.inputs["Color"])
    links.new(shade.outputs["Value"], light.inputs["Strength"])
    links.new(light.outputs["Emission"], output.inputs["Surface"])
    return material


def _set_up(scene: bpy.types.Scene, world: bpy.types.World, path: Path, size: int) -> None:
    for node in shader_nodes(world):
        if node.type == "BACKGROUND":
            node.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", _SAMPLES, False
    # Equal maps give equal renders.
    scene.cycles.seed = 0
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)


def shader_nodes(data: bpy.types.Material | bpy.types.World) -> bpy.types.Nodes:
    """Return the shader nodes of new data, which has them from 5.0 on; Blender 6 removes `use_nodes`."""
    if data.node_tree is None:
        data.use_nodes = True
    return data.node_tree.nodes
