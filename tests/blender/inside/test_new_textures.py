# SPDX-License-Identifier: GPL-3.0-or-later
"""New UV Map and Textures: all looks the same, the old map and images stay, and one undo takes all back."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, jobs, scenes

SIDE = 128


def image(name, seed, is_data=False, is_bumpy=False, is_float=False):
    rng = np.random.default_rng(seed)
    made = bpy.data.images.new(name, SIDE, SIDE, alpha=True, float_buffer=is_float, is_data=is_data)
    u, v = np.meshgrid(*[(np.arange(SIDE) + 0.5) / SIDE] * 2)
    waves = [np.cos(2 * np.pi * (i * u + j * v) + 6 * rng.random()) for i, j in rng.integers(-3, 4, (9, 2))]
    values = np.ones((SIDE, SIDE, 4), np.float32)
    for channel in range(3):
        values[:, :, channel] = 0.5 + 0.15 * sum(waves[3 * channel : 3 * channel + 3])
    if is_bumpy:
        values[:, :, :3] = (values[:, :, :3] - 0.5) * (1, 1, 0) + (0, 0, 1)
        values[:, :, :3] = 0.5 + 0.5 * values[:, :, :3] / np.linalg.norm(values[:, :, :3], axis=2, keepdims=True)
    made.pixels.foreach_set(values.ravel())
    made.update()
    made.pack()
    return made


def image_node(material, picture, target):
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.name = picture, picture.name
    shader = next(each for each in tree.nodes if each.type == "BSDF_PRINCIPLED")
    if target == "Normal":
        turn = tree.nodes.new("ShaderNodeNormalMap")
        tree.links.new(turn.outputs["Normal"], shader.inputs["Normal"])
        tree.links.new(node.outputs["Color"], turn.inputs["Color"])
    elif target:
        tree.links.new(node.outputs["Color"], shader.inputs[target])
    return node


def material_of(*pictures):
    made = bpy.data.materials.new("Painted")
    if made.node_tree is None:
        made.use_nodes = True
    for picture, target in pictures:
        image_node(made, picture, target)
    return made


def ball(material=None):
    """A sphere with the map that Blender makes, and no seams."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    made = bpy.context.object
    made.data.materials.append(material or material_of((image("Color", 1), "Base Color")))
    return made


def arrays(mesh, layer):
    """Return a map (C, 2) and the triangles."""
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers[layer].data.foreach_get("uv", uv)
    mesh.calc_loop_triangles()
    triangles = np.array([tuple(each.loops) for each in mesh.loop_triangles])
    return uv.reshape(-1, 2).astype(np.float64), triangles


def pixels(picture):
    values = np.empty(4 * picture.size[0] * picture.size[1], np.float32)
    picture.pixels.foreach_get(values)
    return values.reshape(picture.size[1], picture.size[0], 4)[::-1]


def seen(picture, uv):
    """Return what a repeated image shows at UVs (n, 2), interpolated."""
    values = pixels(picture)
    height, width = values.shape[:2]
    places = np.c_[(1.0 - uv[:, 1]) * height, uv[:, 0] * width] - 0.5
    first = np.floor(places).astype(int)
    rest = places - first
    total = 0.0
    for down, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
        share = np.prod(np.where((down, right), rest, 1.0 - rest), axis=1)
        total += share[:, None] * values[(first[:, 0] + down) % height, (first[:, 1] + right) % width]
    return total


def difference(mesh, old_layer, old_image, new_layer, new_image):
    """Return the mean difference of colors at points of the surface, of 255."""
    rng = np.random.default_rng(1)
    _, triangles = arrays(mesh, old_layer)
    corners, weights = triangles[rng.integers(0, len(triangles), 20000)], rng.dirichlet([2.0, 2.0, 2.0], 20000)
    old, new = (
        seen(picture, np.einsum("nk,nkd->nd", weights, arrays(mesh, layer)[0][corners]))
        for picture, layer in ((old_image, old_layer), (new_image, new_layer))
    )
    return 255 * np.abs(old - new)[:, :3].mean(axis=0)


def new_textures(**options):
    return bpy.ops.uv.spectral_new_textures(**options)


def node(made, name):
    return made.active_material.node_tree.nodes[name]


def source(image_node):
    """Return the node that a node reads its place from."""
    return image_node.inputs["Vector"].links[0].from_node


@pytest.mark.parametrize("is_edited", [False, True])
def test_all_looks_the_same_and_the_old_stays(is_edited, reports):
    made = ball(
        material_of(
            (image("Color", 1), "Base Color"),
            (image("Rough", 2, is_data=True), "Roughness"),
            (image("Glow", 3, is_float=True), "Metallic"),
            (image("Bumps", 4, is_data=True, is_bumpy=True), "Normal"),
        )
    )
    mesh, old_pixels = made.data, {each.name: pixels(each).copy() for each in bpy.data.images}
    if is_edited:
        scenes.edit(made)
        scenes.select_faces(made, [0, 5])
    reports()
    # Denser, so that the blur is small.
    assert new_textures(size="SIZE", texture_size=512) == {"FINISHED"}
    assert (bpy.context.mode == "EDIT_MESH") is is_edited
    if is_edited:
        assert [face.index for face in scenes.edit_mesh(made).faces if face.select] == [0, 5]
        bpy.ops.object.editmode_toggle()
    assert [layer.name for layer in mesh.uv_layers] == ["UVMap", "UVMap.001"]
    assert mesh.uv_layers.active.name == "UVMap.001"
    assert mesh.uv_layers["UVMap"].active_render
    for name, values in old_pixels.items():
        np.testing.assert_array_equal(pixels(bpy.data.images[name]), values)
    for name in ("Color", "Rough", "Glow"):
        new = node(made, name).image
        assert new.name == f"{name} rebaked"
        assert new.packed_file
        assert tuple(new.size) == (512, 512)
        assert new.colorspace_settings.name == bpy.data.images[name].colorspace_settings.name
        assert source(node(made, name)).uv_map == "UVMap.001"
        assert difference(mesh, "UVMap", bpy.data.images[name], "UVMap.001", new).max() < 1.0
    bumps = node(made, "Bumps")
    turned = difference(mesh, "UVMap", bpy.data.images["Bumps"], "UVMap.001", bumps.image)
    # Turned in the surface, normals lean as far.
    assert turned[:2].min() > 2.0
    assert turned[2] < 1.0
    assert bumps.outputs["Color"].links[0].to_node.uv_map == "UVMap.001"
    (said,) = reports()
    assert said[0] == "Info"
    assert said[1].startswith("New UV map UVMap.001 with ")
    assert "; 4 textures drawn for it; " in said[1]


def state():
    """What undo must bring back, by the names of the nodes' images and all else."""
    nodes = [
        (material.name, each.name, each.image.name, each.inputs["Vector"].is_linked)
        for material in bpy.data.materials
        for each in material.node_tree.nodes
        if each.type == "TEX_IMAGE"
    ]
    return nodes, sorted(bpy.data.images.keys()), [mesh.uv_layers.keys() for mesh in bpy.data.meshes]


@pytest.mark.parametrize("is_edited", [False, True])
def test_one_undo_takes_all_back(is_edited):
    made = ball()
    bpy.ops.ed.undo_push(message="Made")
    if is_edited:
        scenes.edit(made)
        bpy.ops.ed.undo_push(message="Edit")
    before = state()
    assert new_textures() == {"FINISHED"}
    after = state()
    assert after != before
    bpy.ops.ed.undo()
    assert state() == before
    assert (bpy.context.mode == "EDIT_MESH") is is_edited
    bpy.ops.ed.redo()
    assert state() == after


def test_selected_objects_share_one_layout_and_textures():
    first, second = ball(), None
    second = ball(first.active_material)
    second.location.x = 3.0
    first.select_set(True)
    assert new_textures(size="SIZE", texture_size=256) == {"FINISHED"}
    assert first.active_material == second.active_material
    new = node(first, "Color").image
    for each in (first, second):
        assert difference(each.data, "UVMap", bpy.data.images["Color"], "UVMap.001", new).max() < 2.0
    # Not on each other.
    (uv, _), (other, _) = (arrays(each.data, "UVMap.001") for each in (first, second))
    touched = [set(map(tuple, np.floor(32 * each).astype(int).tolist())) for each in (uv, other)]
    assert len(touched[0] & touched[1]) < 0.2 * len(touched[0] | touched[1])


def test_the_same_objects_are_in_edit_mode_afterward():
    first, second, third = ball(), ball(), ball()
    scenes.edit(first, second)
    second.select_set(False)
    third.select_set(True)
    assert new_textures() == {"FINISHED"}
    assert [each.mode for each in (first, second, third)] == ["EDIT", "EDIT", "OBJECT"]
    assert bpy.context.selected_objects == [first, third]
    assert [len(each.data.uv_layers) for each in (first, second, third)] == [2, 2, 1]


def test_objects_that_are_not_selected_keep_their_material(reports):
    first = ball()
    other = ball(first.active_material)
    bpy.ops.object.select_all(action="DESELECT")
    first.select_set(True)
    bpy.context.view_layer.objects.active = first
    assert new_textures() == {"FINISHED"}
    assert first.active_material != other.active_material
    assert node(other, "Color").image.name == "Color"
    assert node(first, "Color").image.name == "Color rebaked"
    assert len(other.data.uv_layers) == 1
    assert ("Info", "Copied, because other objects have these materials, too: Painted") in reports()


def test_a_selected_object_that_reads_another_map_keeps_its_material(reports):
    first = ball()
    second = ball(first.active_material)
    second.data.uv_layers.new(name="Light")
    second.data.uv_layers["UVMap"].active_render = True
    second.data.uv_layers.active = second.data.uv_layers["Light"]
    first.select_set(True)
    reports()
    assert new_textures(size="SIZE", texture_size=64) == {"FINISHED"}
    assert node(first, "Color").image.name == "Color rebaked"
    assert node(second, "Color").image.name == "Color"
    assert not node(second, "Color").inputs["Vector"].is_linked


def test_what_cannot_be_drawn_is_said_and_keeps_its_map(reports):
    made = ball()
    tree = made.active_material.node_tree
    moved = image_node(made.active_material, image("Moved", 5), None)
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], moved.inputs["Vector"])
    boxed = image_node(made.active_material, image("Boxed", 6), None)
    boxed.projection = "BOX"
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.nodes.new("ShaderNodeTexImage").image = image("Grouped", 7)
    tree.nodes.new("ShaderNodeGroup").node_tree = group
    reports()
    assert new_textures() == {"FINISHED"}
    said = dict(reports())["Warning"]
    assert "Moved: moved by other nodes" in said
    assert "Boxed: not projected by a UV map alone" in said
    assert "Grouped: in a node group" in said
    assert node(made, "Moved").image.name == "Moved"
    assert made.data.uv_layers["UVMap"].active_render


def test_a_moved_and_repeated_texture_is_drawn_as_it_was_seen():
    made = ball()
    tree, color = made.active_material.node_tree, node(made, "Color")
    mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Scale"].default_value = (2.0, 3.0, 1.0)
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], color.inputs["Vector"])
    assert new_textures(size="SIZE", texture_size=1024) == {"FINISHED"}
    mesh = made.data
    mesh.uv_layers.new(name="Scaled", do_init=False)
    uv, _ = arrays(mesh, "UVMap")
    mesh.uv_layers["Scaled"].data.foreach_set("uv", (uv * (2.0, 3.0)).astype(np.float32).ravel())
    assert source(color).type == "UVMAP"
    assert difference(mesh, "Scaled", bpy.data.images["Color"], "UVMap.001", color.image).max() < 1.5


@pytest.mark.parametrize(("mode", "target"), [("PREMUL", "Alpha"), ("CHANNEL_PACKED", "Roughness")])
def test_colors_with_their_opacity_or_beside_other_data_are_not_weighted(mode, target):
    """Blender holds colors of floats multiplied by their opacity, and packed channels have none."""
    picture = image("Color", 1, is_float=mode == "PREMUL")
    values = pixels(picture).copy()
    values[:, :, 3] = values[:, :, 0] > 0.5
    if mode == "PREMUL":
        values[:, :, :3] *= values[:, :, 3:]
    picture.alpha_mode = mode
    picture.pixels.foreach_set(np.ascontiguousarray(values[::-1]).ravel())
    picture.pack()
    made = ball(material_of((picture, "Base Color")))
    tree = made.active_material.node_tree
    shader = next(each for each in tree.nodes if each.type == "BSDF_PRINCIPLED")
    tree.links.new(node(made, "Color").outputs["Alpha"], shader.inputs[target])
    assert new_textures(size="SIZE", texture_size=512) == {"FINISHED"}
    assert difference(made.data, "UVMap", picture, "UVMap.001", node(made, "Color").image).max() < 1.0


def test_normals_that_are_taken_for_colors_are_turned_too():
    """Where an image is not marked as data, light is what the codes stand for."""
    found = []
    for is_data in (True, False):
        picture = image("Bumps", 4, is_data=is_data, is_bumpy=True)
        values = pixels(picture).copy()
        if not is_data:
            codes = values[:, :, :3]
            values[:, :, :3] = np.where(codes <= 0.0031308, 12.92 * codes, 1.055 * codes ** (1 / 2.4) - 0.055)
            picture.pixels.foreach_set(np.ascontiguousarray(values[::-1]).ravel())
            picture.pack()
        made = ball(material_of((picture, "Normal")))
        # The map must be the same twice, but Blender numbers the corners of a sphere anew each time, and of two turns
        # that are as good the numbering decides.
        assert new_textures(size="SIZE", texture_size=256, rotation="NONE") == {"FINISHED"}
        new = next(each for each in made.active_material.node_tree.nodes if each.type == "TEX_IMAGE").image
        assert new.colorspace_settings.name == picture.colorspace_settings.name
        assert not new.is_float
        found.append(pixels(new)[:, :, :3].astype(float))
    light = np.where(found[1] <= 0.04045, found[1] / 12.92, ((found[1] + 0.055) / 1.055) ** 2.4)
    # Turned in the surface, all but the third component differ.
    assert np.abs(found[0] - light).max() < 0.02


def test_a_decal_does_not_continue():
    """An image that is clipped, in the middle of the map."""
    made = ball()
    tree, color = made.active_material.node_tree, node(made, "Color")
    mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Scale"].default_value = (3.0, 3.0, 1.0)
    mapping.inputs["Location"].default_value = (-1.0, -1.0, 0.0)
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], color.inputs["Vector"])
    color.extension = "CLIP"
    assert new_textures(size="SIZE", texture_size=1024) == {"FINISHED"}
    rng = np.random.default_rng(1)
    old, triangles = arrays(made.data, "UVMap")
    new, _ = arrays(made.data, "UVMap.001")
    corners, weights = triangles[rng.integers(0, len(triangles), 20000)], rng.dirichlet([2.0, 2.0, 2.0], 20000)
    places, read_at = (np.einsum("nk,nkd->nd", weights, uv[corners]) for uv in (new, 3.0 * old - 1.0))
    found = seen(color.image, places)
    outside = ((read_at < -0.05) | (read_at > 1.05)).any(axis=1)
    inside = ((read_at > 0.05) & (read_at < 0.95)).all(axis=1)
    assert not found[outside].any()
    assert 255 * np.abs(seen(bpy.data.images["Color"], read_at) - found)[inside].mean() < 1.5


def test_textures_of_another_map_stay():
    made = ball()
    tree = made.active_material.node_tree
    made.data.uv_layers.new(name="Other")
    other = image_node(made.active_material, image("Elsewhere", 8), None)
    named = tree.nodes.new("ShaderNodeUVMap")
    named.uv_map = "Other"
    tree.links.new(named.outputs["UV"], other.inputs["Vector"])
    made.data.uv_layers.active = made.data.uv_layers["UVMap"]
    assert new_textures() == {"FINISHED"}
    assert node(made, "Elsewhere").image.name == "Elsewhere"
    assert node(made, "Color").image.name == "Color rebaked"


def test_sizes():
    made = ball()
    bpy.context.scene.spectral_texture_size = 32
    for size, side in (("SAME", SIDE), ("SIZE", 32), ("AUTO", 256)):
        made.data.uv_layers.active = made.data.uv_layers["UVMap"]
        node(made, "Color").image = bpy.data.images["Color"]
        for link in node(made, "Color").inputs["Vector"].links:
            made.active_material.node_tree.links.remove(link)
        assert new_textures(size=size) == {"FINISHED"}
        assert tuple(node(made, "Color").image.size) == (side, side)


def test_without_an_object_nothing_is_replaced():
    ball()
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    assert new_textures() == {"CANCELLED"}


def test_a_ninth_map_is_refused():
    made = ball()
    while len(made.data.uv_layers) < 8:
        made.data.uv_layers.new()
    before = state()
    with pytest.raises(RuntimeError, match="no room for a new UV map"):
        new_textures()
    assert state() == before


def started(monkeypatch):
    """Invoke the operator; it waits for its thread, however short the work."""
    operator_class = importlib.import_module("spectral_unwrap.operators.new_textures").UV_OT_spectral_new_textures
    properties = jobs.defaults(bpy.ops.uv.spectral_new_textures)
    with monkeypatch.context() as patch:
        patch.setattr(jobs.worker.Worker, "wait", lambda _self, _seconds: False)
        return jobs.Invoked(monkeypatch, operator_class, is_waiting=False, **properties)


@pytest.mark.parametrize("when", ["unwrap", "draw"])
def test_escape_leaves_everything_as_it_was(when, monkeypatch):
    scenes.edit(ball())
    before, everything = state(), digest.digest()
    running = started(monkeypatch)
    if when == "draw":
        with monkeypatch.context() as patch:
            first = running.worker
            first.wait(60.0)
            patch.setattr(jobs.worker.Worker, "wait", lambda self, _seconds: self is first)
            running.send("TIMER", "NOTHING")
        assert running.is_running
    assert running.send("ESC") == {"CANCELLED"}
    assert running.left_nothing()
    assert state() == before
    assert not digest.changes(everything, digest.digest())


def test_a_material_that_changes_meanwhile_stops_it(monkeypatch):
    made = ball()
    scenes.edit(made)
    running = started(monkeypatch)
    node(made, "Color").image = image("Other", 9)
    before = state()
    running.wait()
    assert running.result == {"CANCELLED"}
    assert running.reported[-1][1].startswith("Meshes or materials changed meanwhile")
    assert state() == before
