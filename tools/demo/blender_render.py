# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: render the unwrapped mesh with a checker texture, from the front and from behind."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

# Squares along the longest side of the model.
SQUARES = 40
RESOLUTION = (1400, 700)
SAMPLES = 16
LIGHT_SQUARE = (0.80, 0.76, 0.68, 1)
DARK_SQUARE = (0.02, 0.11, 0.20, 1)
BACKDROP = (0.50, 0.52, 0.54, 1)
# Rotation about the vertical in degrees, and position in units of the model's size, of the two copies.
COPIES = ((24, -0.5), (152, 0.53))


def main() -> None:
    """Render mesh.blend in the job's output folder to checker.png there."""
    output = Path(json.loads(Path(sys.argv[-1]).read_text())["output"])
    bpy.ops.wm.open_mainfile(filepath=str(output / "mesh.blend"))
    target = bpy.context.view_layer.objects.active
    for item in list(bpy.context.scene.objects):
        if item != target:
            bpy.data.objects.remove(item)
    # Importers store the rotation from Y-up to Z-up in the object.
    target.data.transform(target.matrix_world)
    corners = np.array([vertex.co for vertex in target.data.vertices])
    # The picture is wide, so the height of a model counts for more.
    size = float(((corners.max(axis=0) - corners.min(axis=0)) * (1, 1, 1.35)).max())
    center = Vector((corners.max(axis=0) + corners.min(axis=0)) / 2)
    # The mesh itself at unit size about the origin: lights and camera need no scale.
    target.data.transform(Matrix.Scale(1 / size, 4) @ Matrix.Translation(-center))
    target.data.polygons.foreach_set("use_smooth", [True] * len(target.data.polygons))
    target.data.materials.clear()
    target.data.materials.append(checker_material(target.data))
    for angle, place in COPIES:
        copy = bpy.data.objects.new("copy", target.data)
        copy.matrix_world = Matrix.Translation((place, 0, 0)) @ Matrix.Rotation(math.radians(angle), 4, "Z")
        bpy.context.scene.collection.objects.link(copy)
    bpy.data.objects.remove(target)
    floor = min(vertex.co.z for vertex in bpy.context.scene.objects[0].data.vertices)
    add_backdrop(floor - 0.01)
    add_lights()
    add_camera()
    render(output / "checker.png")


def shader_nodes(data: bpy.types.Material | bpy.types.World) -> bpy.types.Nodes:
    """Return the shader nodes of new data, which has them from 5.0 on; Blender 6 removes `use_nodes`."""
    if data.node_tree is None:
        data.use_nodes = True
    return data.node_tree.nodes


def checker_material(mesh: bpy.types.Mesh) -> bpy.types.Material:
    """Return a material with, on average, SQUARES squares along the model's size."""
    material = bpy.data.materials.new("Checker")
    nodes = shader_nodes(material)
    links = material.node_tree.links
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Roughness"].default_value = 0.45
    checker = nodes.new("ShaderNodeTexChecker")
    checker.inputs["Color1"].default_value = LIGHT_SQUARE
    checker.inputs["Color2"].default_value = DARK_SQUARE
    checker.inputs["Scale"].default_value = SQUARES / uv_scale(mesh)
    coordinates = nodes.new("ShaderNodeUVMap")
    coordinates.uv_map = mesh.uv_layers.active.name
    links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
    links.new(checker.outputs["Color"], shader.inputs["Base Color"])
    return material


def uv_scale(mesh: bpy.types.Mesh) -> float:
    """Return the mean length in the active UV map of a unit length on the mesh."""
    mesh.calc_loop_triangles()
    layer = mesh.uv_layers.active.data
    uv = np.empty(2 * len(layer), np.float32)
    layer.foreach_get("uv", uv)
    loops = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    sides = np.diff(uv.reshape(-1, 2)[loops.reshape(-1, 3)], axis=1)
    flat = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum() / 2
    return math.sqrt(flat / sum(triangle.area for triangle in mesh.loop_triangles))


def add_backdrop(height: float) -> None:
    """Add a floor that bends up into a wall behind the model."""
    bend, back, width = 1.2, 2.2, 9.0
    profile = [(-6.0, 0.0), (back - bend, 0.0)]
    profile += [
        (back - bend + bend * math.sin(t), bend - bend * math.cos(t)) for t in np.linspace(0, math.pi / 2, 24)[1:]
    ]
    profile.append((back, 6.0))
    vertices = [(x, y, z + height) for y, z in profile for x in (-width, width)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("Backdrop")
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    material = bpy.data.materials.new("Backdrop")
    shader = next(node for node in shader_nodes(material) if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = BACKDROP
    shader.inputs["Roughness"].default_value = 0.9
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Backdrop", mesh))


def add_lights() -> None:
    """Add a large key light, a weaker fill and a dim sky."""
    for name, place, power, size in (
        ("Key", (-2.2, -2.6, 2.6), 120, 1.2),
        ("Fill", (2.8, -2.2, 1.0), 35, 2.0),
        ("Rim", (0.6, 1.6, 2.6), 45, 1.5),
    ):
        light = bpy.data.lights.new(name, "AREA")
        light.energy, light.size = power, size
        item = bpy.data.objects.new(name, light)
        item.matrix_world = looking_at_origin(Vector(place))
        bpy.context.scene.collection.objects.link(item)
    world = bpy.data.worlds.new("World")
    background = next(node for node in shader_nodes(world) if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.75, 0.82, 0.9, 1)
    background.inputs["Strength"].default_value = 0.25
    bpy.context.scene.world = world


def add_camera() -> None:
    """Add the camera, a little above the models and in front of them."""
    camera = bpy.data.cameras.new("Camera")
    camera.lens = 85
    item = bpy.data.objects.new("Camera", camera)
    item.matrix_world = looking_at_origin(Vector((0, -5.05, 0.72)))
    bpy.context.scene.collection.objects.link(item)
    bpy.context.scene.camera = item


def looking_at_origin(place: Vector) -> Matrix:
    """Return the matrix of an object at a position, with its -Z axis toward the origin."""
    return Matrix.Translation(place) @ (-place).to_track_quat("-Z", "Y").to_matrix().to_4x4()


def render(path: Path) -> None:
    """Render with Cycles on the processor, which needs no screen."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = SAMPLES
    scene.cycles.seed = 1
    scene.cycles.max_bounces = 4
    denoise(scene)
    # The picture shows the true colors of the squares, without a film look.
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = RESOLUTION
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def denoise(scene: bpy.types.Scene) -> None:
    """Turn on the denoiser, if this build of Blender has it (Debian's does not)."""
    try:
        scene.cycles.denoiser = "OPENIMAGEDENOISE"
    except TypeError:
        scene.cycles.use_denoising = False
        scene.cycles.samples = 4 * SAMPLES
    else:
        scene.cycles.use_denoising = True


if __name__ == "__main__":
    main()
