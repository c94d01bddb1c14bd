# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: a click makes a new map with its textures in edit mode; one undo takes it back."""

import bpy

from tests.interface import driving as drive
from tests.interface import extender_sidebar as sidebar
from tests.interface.drive_tasks import edit
from tests.interface.session import point_at, screenshot, xdotool


def ball():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    image = bpy.data.images.new("Picture", 512, 512)
    image.generated_type = "COLOR_GRID"
    material = bpy.data.materials.new("Painted")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.name, node.image = "Picture", image
    shader = next(each for each in tree.nodes if each.type == "BSDF_PRINCIPLED")
    tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    bpy.context.object.data.materials.append(material)


def state():
    """Return the maps of the mesh, the image that its material shows, and the mode."""
    edited = bpy.context.view_layer.objects.active
    node = edited.active_material.node_tree.nodes["Picture"]
    return list(edited.data.uv_layers.keys()), node.image.name, bpy.context.mode


def steps():
    yield from edit(ball)
    drive.area_of("VIEW_3D").spaces.active.shading.type = "MATERIAL"
    yield from sidebar.open_sidebar()
    screenshot("textures_before")
    before = state()
    assert before == (["UVMap"], "Picture", "EDIT_MESH"), before
    yield from sidebar.click_sidebar(sidebar.NEW_TEXTURES)
    yield from drive.until(lambda: state()[1] != "Picture")
    for _ in range(4):
        yield
    after = state()
    assert after == (["UVMap", "UVMap.001"], "Picture rebaked", "EDIT_MESH"), after
    screenshot("textures_after")
    point_at("VIEW_3D", 0.3, 0.3)
    yield
    xdotool("key", "ctrl+z")
    yield from drive.until(lambda: state() == before)
    yield
    xdotool("key", "ctrl+shift+z")
    yield from drive.until(lambda: state()[:2] == after[:2])


if __name__ == "__main__":
    drive.run(steps)
