# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of Blender with textures, and renders of a .blend from six sides by Cycles; they need bpy."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from tests.module import textured_assets as made

_SAMPLES = 64
# Of a sphere of radius 1 in the picture.
_WIDTH = 2.04

Tree = Any


@dataclass(frozen=True)
class Sphere:
    """A file with a sphere of radius 1, the map of `textured_assets.sphere`, and one material."""

    build: Callable[[Tree], None]
    """Adds nodes to the material's tree."""

    def save(self, path: Path) -> Path:
        """Write the file and return its path."""
        import bpy

        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        positions, _, uv, triangles = made.sphere()
        # The sides of the cube meet in one vertex.
        points, vertex = np.unique(positions.round(5), axis=0, return_inverse=True)
        mesh = bpy.data.meshes.new("sphere")
        mesh.from_pydata(points.tolist(), [], vertex.ravel()[triangles].tolist())
        layer = mesh.uv_layers.new(name="UVMap")
        # glTF counts v downward.
        layer.data.foreach_set("uv", (uv * (1, -1) + (0, 1))[triangles].astype(np.float32).ravel())
        mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
        item = bpy.data.objects.new("sphere", mesh)
        bpy.context.scene.collection.objects.link(item)
        material = bpy.data.materials.new("skin")
        if material.node_tree is None:
            material.use_nodes = True
        self.build(material.node_tree)
        mesh.materials.append(material)
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        return path


def image_and_bumps(tree: Tree) -> None:
    """Add images for the base color, the roughness and the normals."""
    shader = _shader(tree)
    turn = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(turn.outputs["Normal"], shader.inputs["Normal"])
    for pixels, is_data, socket in (
        (made.painted(256, 384, 3, 41), False, shader.inputs["Base Color"]),
        (made.painted(128, 192, 3, 42), True, shader.inputs["Roughness"]),
        (made.bumps(256, 384, 43), True, turn.inputs["Color"]),
    ):
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = _image(pixels, is_data)
        tree.links.new(node.outputs["Color"], socket)


def procedural(tree: Tree) -> None:
    """Add waves of the UVs for the base color and a bump, and noise for the roughness."""
    shader, coordinates = _shader(tree), tree.nodes.new("ShaderNodeTexCoord")
    waves, colors = tree.nodes.new("ShaderNodeTexWave"), tree.nodes.new("ShaderNodeValToRGB")
    waves.inputs["Scale"].default_value, waves.inputs["Distortion"].default_value = 6.0, 4.0
    colors.color_ramp.elements[0].color = (0.6, 0.1, 0.05, 1.0)
    colors.color_ramp.elements[1].color = (0.1, 0.3, 0.6, 1.0)
    noise, bump = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeBump")
    noise.inputs["Scale"].default_value = 12.0
    bump.inputs["Distance"].default_value, bump.inputs["Strength"].default_value = 0.02, 0.5
    for node in (waves, noise):
        tree.links.new(coordinates.outputs["UV"], node.inputs["Vector"])
    for output, socket in (
        (waves.outputs["Fac"], colors.inputs["Fac"]),
        (colors.outputs["Color"], shader.inputs["Base Color"]),
        (noise.outputs["Fac"], shader.inputs["Roughness"]),
        (waves.outputs["Fac"], bump.inputs["Height"]),
        (bump.outputs["Normal"], shader.inputs["Normal"]),
    ):
        tree.links.new(output, socket)


def _shader(tree: Tree) -> Any:  # noqa: ANN401 - Blender's own type
    return next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")


def _image(pixels: np.ndarray, is_data: bool) -> Any:  # noqa: ANN401 - Blender's own type
    import bpy

    height, width = pixels.shape[:2]
    image = bpy.data.images.new("picture", width, height, is_data=is_data)
    values = np.ones((height, width, 4), np.float32)
    values[:, :, :3] = pixels[::-1] / np.float32(255)
    image.pixels.foreach_set(values.ravel())
    image.update()
    image.pack()
    return image


def render(path: Path, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return how a file looks from six sides, (6, size, size, 3), and what is covered, (6, size, size)."""
    import bpy
    from mathutils import Vector

    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", _SAMPLES
    scene.cycles.seed, scene.cycles.use_denoising, scene.render.film_transparent = 0, False, True
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    lamp = bpy.data.objects.new("light", bpy.data.lights.new("light", "SUN"))
    lamp.data.energy, lamp.data.angle = 2.0, 0.0
    lens = bpy.data.cameras.new("camera")
    lens.type, lens.ortho_scale = "ORTHO", _WIDTH
    camera = bpy.data.objects.new("camera", lens)
    for item in (lamp, camera):
        scene.collection.objects.link(item)
    scene.camera = camera
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "view.png")
        for axis, sign in made.VIEWS:
            direction = Vector(np.roll((sign, 0.0, 0.0), axis).tolist())
            camera.location = 5.0 * direction
            camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()
            # Obliquely from the camera.
            lamp.rotation_euler = (direction + Vector((0.3, 0.4, 0.5))).to_track_quat("Z", "Y").to_euler()
            bpy.ops.render.render(write_still=True)
            pictures.append(np.asarray(Image.open(scene.render.filepath).convert("RGBA"), np.float64))
    found = np.stack(pictures)
    return found[..., :3], found[..., 3] == 255
