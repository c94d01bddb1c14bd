# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch draws image textures of .blend and FBX files anew; in every Blender."""

from pathlib import Path

import numpy as np
import pytest

from tests.blender.test_batch_files import EVERYWHERE, in_blender, pytestmark, report_of, run
from tests.module.test_rebake import at, shown

__all__ = ["pytestmark"]

MAKE = """
import bpy, sys, os
import numpy as np
folder = sys.argv[-1]

def image(name, seed, size=(256, 128), data=False, is_float=False, is_bumpy=False):
    rng = np.random.default_rng(seed)
    made = bpy.data.images.new(name, *size, alpha=True, float_buffer=is_float, is_data=data)
    u, v = np.meshgrid((np.arange(size[0]) + 0.5) / size[0], (np.arange(size[1]) + 0.5) / size[1])
    waves = [np.cos(2 * np.pi * (k * u + l * v) + 6 * rng.random()) for k, l in rng.integers(-4, 5, (9, 2))]
    values = np.ones((size[1], size[0], 4), np.float32)
    for c in range(3):
        values[:, :, c] = 0.5 + 0.15 * sum(waves[3 * c : 3 * c + 3])
    if is_bumpy:
        values[:, :, :3] = (values[:, :, :3] - 0.5) * (1, 1, 0) + (0, 0, 1)
        values[:, :, :3] = 0.5 + 0.5 * values[:, :, :3] / np.linalg.norm(values[:, :, :3], axis=2, keepdims=True)
    made.pixels.foreach_set(values.ravel())
    made.update()
    made.pack()
    return made

def textured(item, *nodes):
    material = bpy.data.materials.new("M")
    material.use_nodes = True
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    for picture, target, places in nodes:
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.name = picture, picture.name
        if target == "Normal":
            turn = tree.nodes.new("ShaderNodeNormalMap")
            tree.links.new(turn.outputs["Normal"], shader.inputs["Normal"])
            tree.links.new(node.outputs["Color"], turn.inputs["Color"])
        else:
            tree.links.new(node.outputs["Color"], shader.inputs[target])
        if places:
            mapping, source = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
            mapping.inputs["Scale"].default_value = (*places[0], 1)
            mapping.inputs["Rotation"].default_value = (0, 0, places[1])
            mapping.inputs["Location"].default_value = (*places[2], 0)
            tree.links.new(source.outputs["UV"], mapping.inputs["Vector"])
            tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    item.data.materials.append(material)

def new():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    bpy.context.object.data.name = "Ball"
    return bpy.context.object

item = new()
textured(item, (image("color", 1), "Base Color", None), (image("rough", 2, data=True), "Roughness", None),
         (image("glow", 3, is_float=True), "Metallic", ((2, 1.5), 0.5, (0.3, -0.1))),
         (image("bumps", 4, data=True, is_bumpy=True), "Normal", None))
unused = item.data.materials[0].node_tree.nodes.new("ShaderNodeTexImage")
unused.image = bpy.data.images.new("projected", 8, 8)
unused.projection = "BOX"
bpy.ops.wm.save_as_mainfile(filepath=folder + "/ball.blend")
item = new()
deep = image("deep", 5, is_float=True)
# As 16-bit PNG, whose colors are coded by sRGB.
deep.unpack(method="REMOVE")
deep.filepath_raw, deep.file_format = folder + "/deep.png", "PNG"
bpy.context.scene.render.image_settings.file_format = "PNG"
bpy.context.scene.render.image_settings.color_depth = "16"
bpy.context.scene.view_settings.view_transform = "Standard"
deep.save_render(deep.filepath_raw, scene=bpy.context.scene)
deep = bpy.data.images.load(folder + "/deep.png")
textured(item, (deep, "Base Color", None))
bpy.ops.wm.save_as_mainfile(filepath=folder + "/deep.blend")
item = new()
textured(item)
tree = item.data.materials[0].node_tree
shader, coordinates = (next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"),
                       tree.nodes.new("ShaderNodeTexCoord"))
checker, waves = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeTexGradient")
checker.inputs["Scale"].default_value = 6
checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (0.8, 0.1, 0, 1), (0, 0.2, 0.6, 1)
tree.links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
tree.links.new(checker.outputs["Color"], shader.inputs["Base Color"])
group = bpy.data.node_groups.new("G", "ShaderNodeTree")
if hasattr(group, "interface"):
    group.interface.new_socket("Value", in_out="OUTPUT", socket_type="NodeSocketFloat")
else:
    group.outputs.new("NodeSocketFloat", "Value")
inner, end = group.nodes.new("ShaderNodeUVMap"), group.nodes.new("NodeGroupOutput")
split = group.nodes.new("ShaderNodeSeparateXYZ")
group.links.new(inner.outputs["UV"], split.inputs[0])
group.links.new(split.outputs["X"], end.inputs[0])
grouped = tree.nodes.new("ShaderNodeGroup")
grouped.node_tree = group
tree.links.new(grouped.outputs[0], shader.inputs["Roughness"])
tree.links.new(coordinates.outputs["Generated"], waves.inputs["Vector"])
tree.links.new(waves.outputs["Color"], shader.inputs["Metallic"])
bump = tree.nodes.new("ShaderNodeBump")
bump.inputs["Distance"].default_value = 0.1
tree.links.new(grouped.outputs[0], bump.inputs["Height"])
tree.links.new(bump.outputs["Normal"], shader.inputs["Normal"])
displaced, output = tree.nodes.new("ShaderNodeDisplacement"), tree.get_output_node("ALL")
tree.links.new(grouped.outputs[0], displaced.inputs["Height"])
tree.links.new(displaced.outputs["Displacement"], output.inputs["Displacement"])
bpy.ops.wm.save_as_mainfile(filepath=folder + "/procedural.blend")
item = new()
while item.data.uv_layers:
    item.data.uv_layers.remove(item.data.uv_layers[0])
textured(item)
tree = item.data.materials[0].node_tree
shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
painted = ("Paint", "BYTE_COLOR", "CORNER", "Base Color"), ("Dirt", "FLOAT_COLOR", "POINT", "Roughness")
for name, kind, domain, target in painted:
    colors = item.data.color_attributes.new(name, kind, domain)
    vertices = range(len(item.data.vertices)) if domain == "POINT" else [each.vertex_index for each in item.data.loops]
    for entry, vertex in zip(colors.data, vertices):
        entry.color = (*(0.5 + 0.5 * value for value in item.data.vertices[vertex].co), 1.0)
    reader = tree.nodes.new("ShaderNodeVertexColor" if domain == "CORNER" else "ShaderNodeAttribute")
    setattr(reader, "layer_name" if domain == "CORNER" else "attribute_name", name)
    tree.links.new(reader.outputs["Color"], shader.inputs[target])
bpy.ops.wm.save_as_mainfile(filepath=folder + "/painted.blend")
item = new()
textured(item, (image("color", 1), "Base Color", None))
bpy.ops.export_scene.fbx(filepath=folder + "/ball.fbx", path_mode="COPY", embed_textures=True)
for name, has_material in (("plain", False), ("skin", True)):
    item = new()
    if has_material:
        textured(item)
    colors = item.data.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    for entry, loop in zip(colors.data, item.data.loops):
        entry.color = (*(0.5 + 0.45 * value for value in item.data.vertices[loop.vertex_index].co), 1.0)
    bpy.ops.export_scene.fbx(filepath=folder + f"/{name}.fbx")
item = new()
textured(item, (image("color", 1), "Base Color", None))
skin = item.data.materials[0]
tree, waves, coordinates = skin.node_tree, skin.node_tree.nodes.new("ShaderNodeTexGradient"), None
coordinates = tree.nodes.new("ShaderNodeUVMap")
coordinates.uv_map = item.data.uv_layers[0].name
tree.links.new(coordinates.outputs["UV"], waves.inputs["Vector"])
shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
tree.links.new(waves.outputs["Color"], shader.inputs["Roughness"])
for name in ("Lit", "Alike"):
    other = bpy.data.objects.new(name, item.data.copy())
    bpy.context.scene.collection.objects.link(other)
    if name == "Lit":
        # Its active map is not the one that textures read.
        other.data.uv_layers.active = other.data.uv_layers.new(name="Light")
        other.data.uv_layers[0].active_render = True
curve = bpy.data.curves.new("Wire", "CURVE")
curve.materials.append(skin)
bpy.context.scene.collection.objects.link(bpy.data.objects.new("Wire", curve))
bpy.ops.wm.save_as_mainfile(filepath=folder + "/shared.blend")
item = new()
with bpy.data.libraries.load(folder + "/ball.blend", link=True) as (_, wanted):
    wanted.materials = ["M"]
item.data.materials.append(wanted.materials[0])
bpy.ops.wm.save_as_mainfile(filepath=folder + "/linked.blend")
"""

READ = """
import bpy, json, sys
import numpy as np
path, folder = sys.argv[-2:]
if path.endswith(".fbx"):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    (bpy.ops.wm.fbx_import if bpy.app.version >= (4, 5) else bpy.ops.import_scene.fbx)(filepath=path)
else:
    bpy.ops.wm.open_mainfile(filepath=path)
mesh = next(mesh for mesh in bpy.data.meshes if mesh.users)
arrays = {"uv": np.array([tuple(each.uv) for each in mesh.uv_layers[0].data])} if mesh.uv_layers else {}
arrays["positions"] = np.array([tuple(mesh.vertices[each.vertex_index].co) for each in mesh.loops])
mesh.calc_loop_triangles()
arrays["triangles"] = np.array([tuple(each.loops) for each in mesh.loop_triangles])
sockets = {}
item = next(item for item in bpy.data.objects if item.type == "MESH")
for node in item.material_slots[0].material.node_tree.nodes:
    if node.type == "TEX_IMAGE":
        for link in node.outputs["Color"].links:
            pixels = np.empty(4 * node.image.size[0] * node.image.size[1], np.float32)
            node.image.pixels.foreach_get(pixels)
            arrays[link.to_socket.name] = pixels.reshape(node.image.size[1], node.image.size[0], 4)[::-1]
            sockets[link.to_socket.name] = [node.image.colorspace_settings.name, node.image.is_float,
                                            node.inputs["Vector"].is_linked, bpy.path.abspath(node.image.filepath),
                                            node.image.filepath]
np.savez(folder, **arrays)
print("RESULT", json.dumps(sockets))
"""


IMAGES = """
import bpy, json, sys
bpy.ops.wm.open_mainfile(filepath=sys.argv[-1])
found = {}
for item in bpy.data.objects:
    nodes = [node for node in item.material_slots[0].material.node_tree.nodes if node.type == "TEX_IMAGE"]
    found[item.name] = sorted(node.image.name for node in nodes)
print("RESULT", json.dumps(found))
"""


@pytest.fixture(scope="module", params=EVERYWHERE, ids=lambda blender: blender.name)
def made(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("textures")
    (folder / "in").mkdir()
    in_blender(request.param, folder, MAKE, folder / "in")
    code, told = run(request.param, folder, "--rebake", "--rebake-colors", "--texture-size", 512, "--picture-size", 0)
    assert code == 0, told
    return request.param, folder


def both(made, name):
    blender, folder = made
    found = []
    for k, path in enumerate((folder / "in" / name, folder / "out" / name / name)):
        sockets = in_blender(blender, folder, READ, path, folder / f"{k}.npz")
        found.append((dict(np.load(folder / f"{k}.npz")), sockets))
    return found


def difference(before, after, target, places=lambda uv: uv):
    """Return the mean absolute difference of colors at points of the surface, of 255."""
    rng = np.random.default_rng(1)
    where = rng.integers(0, len(before["triangles"]), 20000), rng.dirichlet([2.0, 2.0, 2.0], 20000)
    old = shown(before[target], places(at(before["uv"], before["triangles"], where)))
    new = shown(after[target], at(after["uv"], after["triangles"], where))
    return 255 * np.abs(old - new)[:, :3].mean(axis=0)


def moved(uv):
    """Return where a Mapping node of MAKE reads."""
    x, y = (uv * (2, 1.5)).T
    cos, sin = np.cos(0.5), np.sin(0.5)
    return np.c_[cos * x - sin * y, sin * x + cos * y] + (0.3, -0.1)


def test_a_blend_shows_the_same(made):
    (before, _), (after, sockets) = both(made, "ball.blend")
    assert not np.allclose(before["uv"], after["uv"])
    assert difference(before, after, "Base Color").max() < 1
    assert difference(before, after, "Roughness").max() < 1
    # Turned in the surface, normals lean as far.
    turned = difference(before, after, "Color")
    assert turned[:2].min() > 5
    assert turned[2] < 1
    assert difference(before, after, "Metallic", moved).max() < 1
    assert sockets["Base Color"][:2] == ["sRGB", False]
    assert sockets["Roughness"][0] == "Non-Color"
    assert sockets["Metallic"][1:3] == [True, True]
    report = report_of(made[1], "ball.blend")
    assert {each["name"] for each in report["textures"]} == {"color", "rough", "glow", "bumps"}
    assert report["warnings"] == []


def test_16_bits_show_the_same_light(made):
    (before, old), (after, new) = both(made, "deep.blend")
    assert old["Base Color"][:2] == ["sRGB", True]
    assert new["Base Color"][1]
    # Floats of Blender are light.
    assert difference(before, after, "Base Color").max() < 1


def test_what_is_procedural_is_baked(made):
    (before, old), (after, sockets) = both(made, "procedural.blend")
    assert old == {}
    assert sockets.keys() == {"Base Color", "Roughness", "Color"}
    assert [sockets[name][0] for name in ("Base Color", "Roughness", "Color")] == ["sRGB", "Non-Color", "Non-Color"]
    rng = np.random.default_rng(1)
    where = rng.integers(0, len(before["triangles"]), 20000), rng.dirichlet([2.0, 2.0, 2.0], 20000)
    uv = at(before["uv"], before["triangles"], where)
    new = {name: shown(after[name], at(after["uv"], after["triangles"], where)) for name in sockets}
    assert np.abs(new["Roughness"][:, 0] - uv[:, 0]).mean() < 0.005
    is_first = np.floor(6 * uv).astype(int).sum(axis=1) % 2 == 1
    light = np.where(is_first[:, None], (0.8, 0.1, 0.0), (0.0, 0.2, 0.6))
    coded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    # But for texels at the borders of squares.
    assert (np.abs(new["Base Color"][:, :3] - coded).max(axis=1) < 0.01).mean() > 0.9
    # The heights lean the surface along u.
    lean = np.linalg.norm(2 * new["Color"][:, :2] - 1, axis=1)
    assert np.median(lean) > 0.01
    report = report_of(made[1], "procedural.blend")
    said = "Displacement of the material M reads the old map: bake it in Blender."
    assert report["warnings"] == [said]
    assert {each["name"] for each in report["textures"]} == {"M Base Color", "M Roughness", "M Normal"}


def test_materials_of_other_files_stay(made):
    report = report_of(made[1], "linked.blend")
    assert report["textures"] == []
    assert sorted(report["warnings"]) == [
        f"The texture {name} stays in the material M, which is linked." for name in ("bumps", "color", "glow", "rough")
    ]


def test_objects_whose_map_stays_keep_a_material_that_they_share(made):
    """Another mesh, whose active map is not the one that the material reads, and a curve."""
    found = in_blender(made[0], made[1], IMAGES, made[1] / "out" / "shared.blend" / "shared.blend")
    assert found["Lit"] == found["Wire"] == ["color"]
    assert found["Sphere"] == found["Alike"] == ["M.001 Roughness", "color rebaked"]
    assert report_of(made[1], "shared.blend")["warnings"] == []


def test_an_fbx_shows_the_same(made):
    (before, _), (after, sockets) = both(made, "ball.fbx")
    assert difference(before, after, "Base Color").max() < 1
    assert sockets["Base Color"][0] == "sRGB"


@pytest.mark.parametrize("name", ["plain", "skin"])
def test_colors_of_an_fbx_become_the_base_color(made, name):
    _, folder = made
    blender, target = made[0], folder / "out" / f"{name}.fbx" / f"{name}.fbx"
    in_blender(blender, folder, READ, target, folder / "colored.npz")
    after = dict(np.load(folder / "colored.npz"))
    rng = np.random.default_rng(1)
    where = rng.integers(0, len(after["triangles"]), 20000), rng.dirichlet([2.0, 2.0, 2.0], 20000)
    points = at(after["positions"], after["triangles"], where)
    colors = 0.5 + 0.45 * points / np.abs(after["positions"]).max()
    coded = shown(after["Base Color"], at(after["uv"], after["triangles"], where))[:, :3]
    light = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
    assert 255 * np.abs(light - colors).mean() < 1
    assert [each["name"] for each in report_of(folder, f"{name}.fbx")["textures"]] == ["Paint"]


def test_color_attributes_become_images(made):
    _, (after, sockets) = both(made, "painted.blend")
    rng = np.random.default_rng(1)
    where = rng.integers(0, len(after["triangles"]), 20000), rng.dirichlet([2.0, 2.0, 2.0], 20000)
    colors = 0.5 + 0.5 * at(after["positions"], after["triangles"], where)
    for socket in ("Base Color", "Roughness"):
        coded = shown(after[socket], at(after["uv"], after["triangles"], where))[:, :3]
        light = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
        assert 255 * np.abs(light - colors).mean() < 1
        assert sockets[socket][0] == "sRGB"
    report = report_of(made[1], "painted.blend")
    assert {each["name"] for each in report["textures"]} == {"Paint", "Dirt"}
    assert report["warnings"] == []


SHARED = """
item = new()
textured(item, (image("color", 11), "Base Color", ((2, 1.5), 0.5, (0.3, -0.1))),
         (image("rough", 12, data=True), "Roughness", None), (image("glow", 13, is_float=True), "Metallic", None),
         (image("bumps", 14, data=True, is_bumpy=True), "Normal", None))
os.makedirs(folder + "/props")
bpy.ops.wm.save_as_mainfile(filepath=folder + "/props/a.blend")
item = new()
textured(item, (image("paint", 15), "Base Color", None))
material = item.data.materials[0]
item.data.materials[0] = None
# A material of the object, not of its mesh.
item.material_slots[0].link = "OBJECT"
item.material_slots[0].material = material
bpy.ops.wm.save_as_mainfile(filepath=folder + "/b.blend")
item = new()
textured(item, (image("color", 16), "Base Color", None))
bpy.data.images["color"].filepath_raw = folder + "/color.png"
bpy.data.images["color"].file_format = "PNG"
bpy.data.images["color"].save()
bpy.data.images["color"].unpack(method="REMOVE")
bpy.data.images["color"].source = "FILE"
bpy.ops.export_scene.fbx(filepath=folder + "/c.fbx")
"""


@pytest.fixture(scope="module", params=EVERYWHERE, ids=lambda blender: blender.name)
def atlas(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("atlas")
    (folder / "in").mkdir()
    in_blender(request.param, folder, MAKE.partition("item = new()")[0] + SHARED, folder / "in")
    arguments = "--atlas", "props", "--rebake", "--texture-size", 512, "--picture-size", 0
    code, told = run(request.param, folder, *arguments)
    assert code == 0, told
    return request.param, folder


@pytest.mark.parametrize("name", ["props/a.blend", "b.blend", "c.fbx"])
def test_assets_of_an_atlas_share_images(name, atlas):
    blender, folder = atlas
    (before, _), (after, sockets) = (
        (dict(np.load(folder / f"{k}.npz")), found)
        for k, path in enumerate((folder / "in" / name, folder / "out" / name / Path(name).name))
        for found in [in_blender(blender, folder, READ, path, folder / f"{k}.npz")]
    )
    report = report_of(folder, name)
    if any("no OpenImageIO" in each for each in report["warnings"]):
        assert difference(before, after, "Base Color", moved if name == "props/a.blend" else lambda uv: uv).max() < 1
        return
    shared = {each.stem.removeprefix("props_"): str(each) for each in (folder / "out").glob("props_*.png")}
    assert shared.keys() == {"base_color", "roughness", "normal"}
    assert Path(sockets["Base Color"][3]).resolve() == Path(shared["base_color"])
    assert sockets["Base Color"][:2] == ["sRGB", False]
    if name != "props/a.blend":
        assert difference(before, after, "Base Color").max() < 1
        assert [each["name"] for each in report["textures"]] == ["props_base_color.png"]
        return
    assert difference(before, after, "Base Color", moved).max() < 1
    assert difference(before, after, "Roughness").max() < 1
    assert difference(before, after, "Color")[2] < 1
    assert difference(before, after, "Metallic").max() < 1
    assert Path(sockets["Roughness"][3]).resolve() == Path(shared["roughness"])
    assert sockets["Roughness"][0] == "Non-Color"
    assert Path(sockets["Color"][3]).resolve() == Path(shared["normal"])
    assert sockets["Metallic"][3] == ""
    assert {each["name"] for each in report["textures"]} == {"glow", *(f"props_{role}.png" for role in shared)}
    assert [each.startswith("The texture glow is not in the atlas") for each in report["warnings"]] == [True]
    assert sockets["Base Color"][4] == "//../../props_base_color.png"
