# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch on formats that only Blender reads: .blend and FBX, renders, and Smart UV Project; in every Blender."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.blender import blenders
from tests.module import batch_assets

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 500
BPY = [blender for blender in blenders.all_blenders() if blender.python and not blender.system]
EVERYWHERE = [blender for blender in blenders.all_blenders() if not blender.system]

pytestmark = pytest.mark.skipif(not BPY, reason="no bpy for this Python")


def run(blender, folder, *arguments):
    """Run the batch of `blender`'s Python, or of this one with that program, on the files in `folder`/in."""
    words = [blender.python or sys.executable, "-m", "spectral_conformal", "batch", folder / "in"]
    words += ["--out", folder / "out", "--jobs", 1, *arguments]
    words += [] if blender.python else ["--blender", blenders.system_blender()]
    environ = {**os.environ, "PYTHONPATH": str(blenders.STARTUP)}
    done = subprocess.run(list(map(str, words)), env=environ, capture_output=True, text=True, timeout=SECONDS)
    return done.returncode, done.stdout + done.stderr


def in_blender(blender, folder, text, *arguments):
    """Run a script in a Blender and return what it prints after RESULT, as JSON has it."""
    script = folder / "script.py"
    script.write_text(text)
    words = [*blender.script_command(script), *([] if blender.python else ["--"]), *map(str, arguments)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS)
    assert done.returncode == 0, done.stdout + done.stderr
    results = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    return json.loads(results[-1].removeprefix("RESULT ")) if results else None


def report_of(folder, name):
    return json.loads((folder / "out" / name / "report.json").read_text())


MAKE = """
import bpy, json, os, sys
folder = sys.argv[-1]
os.makedirs(folder + "/tex", exist_ok=True)

def new(name):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return cube(name)

def cube(name):
    bpy.ops.mesh.primitive_cube_add()
    item = bpy.context.object
    item.name = item.data.name = name
    for corner in item.data.uv_layers[0].data:
        corner.uv = (0.5, 0.5)
    return item

def hidden(item):
    collection = bpy.data.collections.new("C")
    bpy.context.scene.collection.children.link(collection)
    for old in list(item.users_collection):
        old.objects.unlink(item)
    collection.objects.link(item)
    return bpy.context.view_layer.layer_collection.children["C"]

def save(name):
    bpy.ops.wm.save_as_mainfile(filepath=folder + "/" + name + ".blend")

new("A"); b = cube("B"); b.hide_select = True; save("not_selectable")
new("A"); b = cube("B"); hidden(b).exclude = True; save("excluded")
new("A"); b = cube("B"); hidden(b); b.hide_viewport = True; save("hidden")
a = new("A"); [setattr(face, "hide", face.index < 3) for face in a.data.polygons]; save("hidden_faces")
a = new("A"); scene = bpy.data.scenes.new("S"); b = bpy.data.objects.new("B", a.data.copy())
scene.collection.objects.link(b); save("two_scenes")
a = new("A"); a.shape_key_add(name="Basis"); key = a.shape_key_add(name="K")
key.data[0].co = (5, 5, 5); key.value = 1.0; a.active_shape_key_index = 1; save("shape_key")
a = new("A"); bpy.ops.object.mode_set(mode="EDIT"); save("edit_mode")
a = new("A"); bpy.ops.object.armature_add(); bpy.ops.object.mode_set(mode="POSE")
bpy.context.object.hide_set(True); save("pose_mode")
a = new("A"); image = bpy.data.images.new("shown", 4, 4); image.pack()
areas = [area for screen in bpy.data.screens for area in screen.areas]
space = next(space for area in areas for space in area.spaces if space.type == "IMAGE_EDITOR")
space.image = image; assert image.users; save("image_editor")
a = new("A"); second = a.data.uv_layers.new(name="second"); a.data.uv_layers[0].active_render = True; save("two_maps")
a = new("A"); a.scale = (2, 2, 2); b = cube("B"); b.scale = (1, -1, 1); save("scaled")
a = new("A"); a.scale = (1, 1, 3); save("uneven")
a = new("A"); a.data.attributes.new("spectral_density_factor", "FLOAT", "FACE").data[2].value = 2.0; save("factor")
a = new("A"); a.data.vertices[0].co = a.data.vertices[1].co = a.data.vertices[2].co = (0, 0, 0); save("no_area")
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True); save("nothing")
"""

TWO = """
import bpy, sys
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
for add, name in ((bpy.ops.mesh.primitive_plane_add, "Open"), (bpy.ops.mesh.primitive_cube_add, "Closed")):
    add()
    mesh = bpy.context.object.data
    mesh.name = name
    while mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[0])
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1])
"""

READ = """
import bpy, json, sys
bpy.ops.wm.open_mainfile(filepath=sys.argv[-1])
mode = bpy.context.mode
if mode != "OBJECT":
    bpy.ops.object.mode_set(mode="OBJECT")
found = {}
for mesh in bpy.data.meshes:
    for layer in mesh.uv_layers:
        found[mesh.name + "/" + layer.name] = [list(corner.uv) for corner in layer.data]
    found[mesh.name] = [list(vertex.co) for vertex in mesh.vertices]
print("RESULT", json.dumps({"mode": mode, **found}))
"""


@pytest.fixture(scope="module", params=EVERYWHERE, ids=lambda blender: blender.name)
def blend(request, tmp_path_factory):
    """Scenes with content that a user interface leaves out, through the batch of one Blender."""
    folder = tmp_path_factory.mktemp("blend")
    (folder / "in").mkdir()
    in_blender(request.param, folder, MAKE, folder / "in")
    code, told = run(request.param, folder, "--seams", "sharp", "--picture-size", 0)
    return request.param, folder, code, told


def test_what_cannot_be_selected_is_mapped_all_the_same(blend):
    _, folder, code, told = blend
    assert code == 0, told
    for name in ("not_selectable", "excluded", "hidden", "two_scenes"):
        report = report_of(folder, f"{name}.blend")
        assert (report["status"], report["totals"]["islands"], report["totals"]["faces"]) == ("unwrapped", 12, 12), name
        assert report["totals"]["overlaps"] == 0
    # What only an editor shows is no loss, since no windows are read.
    for name in ("hidden_faces", "pose_mode", "image_editor"):
        assert report_of(folder, f"{name}.blend")["totals"]["islands"] == 6, name
    nothing = report_of(folder, "nothing.blend")
    assert nothing["status"] == "skipped"
    assert "no mesh of its own with faces" in nothing["failure"]["message"]


def test_meshes_that_cannot_be_unwrapped_are_named_and_the_others_mapped(blend):
    blender, folder, *_ = blend
    alone = folder / "keep"
    (alone / "in").mkdir(parents=True)
    in_blender(blender, alone, TWO, alone / "in" / "two.blend")
    code, told = run(blender, alone, "--seams", "keep", "--picture-size", 0)
    assert code == 2, told
    report = report_of(alone, "two.blend")
    assert (report["status"], report["totals"]["failed"]) == ("incomplete", 1)
    assert any(warning.startswith("1 island of Closed could not be unwrapped: ") for warning in report["warnings"])
    assert "6 of 7 faces have no UVs." in report["warnings"]


def test_written_files_have_the_map_and_their_state(blend):
    blender, folder, _, told = blend
    found = in_blender(blender, folder, READ, folder / "out" / "edit_mode.blend" / "edit_mode.blend")
    assert found["mode"] == "EDIT_MESH"
    assert np.ptp(found["A/UVMap"], axis=0).min() > 0.5, told
    # The basis counts, and stays, whatever key is active.
    found = in_blender(blender, folder, READ, folder / "out" / "shape_key.blend" / "shape_key.blend")
    assert np.abs(found["A"]).max() == 1.0
    assert report_of(folder, "shape_key.blend")["totals"]["qc_max"] < 1.001
    # The active map is written, the other stays.
    found = in_blender(blender, folder, READ, folder / "out" / "two_maps.blend" / "two_maps.blend")
    both = [np.ptp(found[f"A/{name}"], axis=0).max() for name in ("UVMap", "second")]
    assert sorted(extent > 0.5 for extent in both) == [False, True]


def test_density_is_equal_in_the_scene_and_said_where_it_is_not(blend):
    blender, folder, *_ = blend
    report = report_of(folder, "scaled.blend")
    assert report["totals"]["density_spread"] < 1e-4 and report["warnings"] == []
    assert report_of(folder, "uneven.blend")["warnings"] == [
        "Scaled unevenly in the scene, so that density is an average: A."
    ]
    # Corner by corner, four to a face; the island with the factor 2 has four times the area.
    found = in_blender(blender, folder, READ, folder / "out" / "factor.blend" / "factor.blend")
    x, y = np.reshape(found["A/UVMap"], (6, 4, 2)).transpose(2, 0, 1)
    area = np.abs((x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1))
    assert area / area[0] == pytest.approx([1.0, 1.0, 4.0, 1.0, 1.0, 1.0], rel=1e-4)
    report = report_of(folder, "no_area.blend")
    assert report["status"] == "unwrapped"
    assert f"{report['totals']['degenerate']} of 6 faces have no area." in report["warnings"]


MAKE_LINKED = """
import bpy, os, sys
folder = sys.argv[-1]
for name in ("tex", "lib"):
    os.makedirs(folder + "/" + name, exist_ok=True)
empty = lambda: bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
empty(); bpy.ops.mesh.primitive_cube_add(); bpy.context.object.name = "Linked"
bpy.ops.wm.save_as_mainfile(filepath=folder + "/lib/lib.blend")
empty(); image = bpy.data.images.new("w", 8, 8); image.filepath_raw = folder + "/tex/w.png"; image.save()
empty(); bpy.ops.mesh.primitive_cube_add(); bpy.ops.wm.save_as_mainfile(filepath=folder + "/a.blend")
image = bpy.data.images.load("//tex/w.png"); image.use_fake_user = True
with bpy.data.libraries.load("//lib/lib.blend", link=True, relative=True) as (_, into):
    into.objects = ["Linked"]
bpy.context.collection.objects.link(into.objects[0])
bpy.ops.wm.save_as_mainfile(filepath=folder + "/a.blend")
"""

PATHS = """
import bpy, json, os, sys
bpy.ops.wm.open_mainfile(filepath=sys.argv[-1])
there = [*bpy.data.images, *bpy.data.libraries]
print("RESULT", json.dumps([[each.filepath, os.path.isfile(bpy.path.abspath(each.filepath))] for each in there]))
"""


@pytest.mark.parametrize("blender", EVERYWHERE, ids=lambda blender: blender.name)
def test_relative_paths_hold_from_where_the_file_lies(blender, tmp_path):
    in_blender(blender, tmp_path, MAKE_LINKED, tmp_path / "in")
    for options in ((), ("--overwrite-source",)):
        code, told = run(blender, tmp_path, "--seams", "sharp", "--picture-size", 0, *options)
        assert code == 0, told
        written = tmp_path / "in" / "a.blend" if options else tmp_path / "out" / "a.blend" / "a.blend"
        paths = in_blender(blender, tmp_path, PATHS, written)
        assert len(paths) == 2 and all(path.startswith("//") and is_there for path, is_there in paths), paths
        assert any("they belong to linked files" in warning for warning in report_of(tmp_path, "a.blend")["warnings"])


MAKE_FBX = """
import bpy, sys
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_cube_add()
cube = bpy.context.object
cube["owner"] = "props"
cube.shape_key_add(name="Basis")
cube.shape_key_add(name="Smile").data[0].co = (2, 2, 2)
bpy.ops.object.light_add(type="SUN")
bpy.ops.object.camera_add()
bpy.ops.object.armature_add()
bpy.context.object.keyframe_insert("location", frame=1)
bpy.context.object.location.x = 2
bpy.context.object.keyframe_insert("location", frame=9)
bpy.context.object.animation_data.action.name = "Walk"
bpy.ops.export_scene.fbx(filepath=sys.argv[-1], use_custom_props=True, add_leaf_bones=False)
"""


@pytest.mark.parametrize("blender", EVERYWHERE, ids=lambda blender: blender.name)
def test_fbx_keeps_what_it_has_or_says_what_is_lost(blender, tmp_path):
    from spectral_conformal.batch.blender import fbx_inventory

    (tmp_path / "in").mkdir()
    in_blender(blender, tmp_path, MAKE_FBX, tmp_path / "in" / "cube.fbx")
    code, told = run(blender, tmp_path, "--seams", "sharp", "--picture-size", 0)
    assert code == 0, told
    report = report_of(tmp_path, "cube.fbx")
    assert (report["totals"]["islands"], report["totals"]["qc_max"] < 1.001) == (6, True)
    before, after = (
        fbx_inventory.count(path.read_bytes())
        for path in (tmp_path / "in" / "cube.fbx", tmp_path / "out" / "cube.fbx" / "cube.fbx")
    )
    assert {"Mesh Geometry", "Light NodeAttribute", "Camera NodeAttribute", "Shape Geometry"} <= set(before)
    told = [warning for warning in report["warnings"] if warning.startswith("FBX through Blender")]
    assert told == fbx_inventory.lost(before, after)
    assert not any(kind in line for line in told for kind in ("Mesh", "Shape", "Light", "Camera", "LimbNode")), told
    # Each clip is there under its name, or said to be gone.
    clips = [kind for kind in before if kind.startswith("clips '")]
    assert clips and all(kind in after or any(kind in line for line in told) for kind in clips)


MAKE_SPHERE = """
import bpy, sys
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_uv_sphere_add()
bpy.ops.export_scene.fbx(filepath=sys.argv[-1])
"""


@pytest.mark.parametrize("blender", EVERYWHERE, ids=lambda blender: blender.name)
def test_damaged_files_are_no_files_without_a_mesh(blender, tmp_path):
    """Importers skip what they cannot read, such as records of zeros."""
    from spectral_conformal.batch.blender import fbx_inventory

    (tmp_path / "in").mkdir()
    whole = tmp_path / "whole.fbx"
    in_blender(blender, tmp_path, MAKE_SPHERE, whole)
    content = whole.read_bytes()
    size = len(content)
    assert fbx_inventory.damage(content) == ""
    damaged = {"head": content[:80] + bytes(size - 80), "cut": content[: size // 2], "no_head": content[:25]}
    # The list of the file's objects seems to end here.
    inside = content.index(b"Objects") + 40
    damaged["inside"] = content[:inside] + bytes(600) + content[inside + 600 :]
    for name, each in damaged.items():
        assert fbx_inventory.damage(each), name
        (tmp_path / "in" / f"{name}.fbx").write_bytes(each)
    code, told = run(blender, tmp_path, "--picture-size", 0)
    assert code == 2, told
    for name in damaged:
        report = report_of(tmp_path, f"{name}.fbx")
        assert (report["status"], report["failure"]["kind"]) == ("failed", "error"), name
        assert report["failure"]["message"].startswith(f"{name}.fbx: is a damaged FBX file: "), report["failure"]


WRONG = """
import bpy, json, pathlib, sys
from spectral_conformal.batch import settings, task
from spectral_conformal.batch.blender import meshes
folder = pathlib.Path(sys.argv[-1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_cube_add()
bpy.ops.wm.save_as_mainfile(filepath=str(folder / "a.blend"))
bpy.ops.export_scene.fbx(filepath=str(folder / "a.fbx"))
write_uv = meshes.write_uv

def wrong(mesh, name, uv_map):
    write_uv(mesh, name, type(uv_map)(uv_map.uv + 0.25, uv_map.mapped))

found = []
for name in ("a.blend", "a.fbx"):
    source = folder / name
    before = source.read_bytes()
    out = folder / f"out_{name}"
    out.mkdir()
    values = settings.from_values({"seams": "sharp", "picture_size": 0}).as_json()
    request = task.Request(name, str(source), str(out), str(source), values)
    meshes.write_uv = wrong
    report = task.run(request)
    left = [path.name for path in folder.iterdir() if "partial" in path.name]
    found.append([report["status"], report["failure"]["message"], source.read_bytes() == before, left])
    meshes.write_uv = write_uv
    found.append(task.run(request)["status"])
print("RESULT", json.dumps(found))
"""


def test_a_source_stays_until_the_result_has_been_read_back(tmp_path):
    blend, _, fbx, _ = found = in_blender(BPY[0], tmp_path, WRONG, tmp_path)
    assert found[1] == found[3] == "unwrapped"
    for (status, message, is_same, left), name in ((blend, "a.blend"), (fbx, "a.fbx")):
        assert (status, is_same, left) == ("failed", True, []), name
        assert message.endswith(f"{name}: does not read back as written; is the disk full?"), message


LOSE = """
import bpy, json, pathlib, sys
from spectral_conformal.batch.blender.files import BlenderAsset
folder = pathlib.Path(sys.argv[-1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_cube_add()
cube = bpy.context.object
cube.name = cube.data.name = "Cube"
cube.data.materials.append(bpy.data.materials.new("Paint"))
cube.modifiers.new("Round", "SUBSURF")
cube["picture"] = image = bpy.data.images.new("Wood", 4, 4)
image.pixels = [0.5] * 64
image.pack()
bpy.ops.wm.save_as_mainfile(filepath=str(folder / "whole.blend"))
whole = BlenderAsset(folder / "whole.blend")
whole.save(folder / "same.blend", [])
bpy.ops.wm.open_mainfile(filepath=str(folder / "whole.blend"))
cube = bpy.data.objects["Cube"]
cube.data.materials.clear()
cube.modifiers.clear()
del cube["picture"]
bpy.ops.wm.save_as_mainfile(filepath=str(folder / "less.blend"))
print("RESULT", json.dumps([whole.lost(BlenderAsset(folder / name)) for name in ("same.blend", "less.blend")]))
"""


def test_what_a_written_blend_lacks_is_listed(tmp_path):
    assert in_blender(BPY[0], tmp_path, LOSE, tmp_path) == [
        [],
        [
            "1 of 1 materials (Paint)",
            "1 of 1 images (Wood)",
            "1 of 1 materials of meshes (Cube: Paint)",
            "1 of 1 modifiers (Cube: Round)",
            "1 of 1 packed images (Wood)",
        ],
    ]


KEEP = """
import bpy, json, pathlib, sys
from spectral_conformal.batch.blender.files import BlenderAsset
folder = pathlib.Path(sys.argv[-1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_cube_add()
bpy.ops.wm.save_as_mainfile(filepath=str(folder / "a.blend"))
opened = BlenderAsset._open

def with_remains(self):
    was_edited = opened(self)
    texture = bpy.data.textures.new("Grain", "IMAGE")
    texture.use_fake_user = False
    texture.image = bpy.data.images.new("Wood", 4, 4)
    texture.image.pack()
    text = bpy.data.texts.new("Notes")
    text.use_fake_user, text.use_extra_user = False, True
    return was_edited

BlenderAsset._open = with_remains
old = BlenderAsset(folder / "a.blend")
old.save(folder / "b.blend", [])
BlenderAsset._open = opened
lost = old.lost(BlenderAsset(folder / "b.blend"))
print("RESULT", json.dumps([lost, [image.name for image in bpy.data.images], [text.name for text in bpy.data.texts]]))
"""


def test_what_an_old_file_has_left_stays(tmp_path):
    """Images of textures that no material of this Blender has, and texts that only a window showed."""
    assert in_blender(BPY[0], tmp_path, KEEP, tmp_path) == [[], ["Wood"], ["Notes"]]


MOVED = """
import bpy, json, pathlib, sys
from spectral_conformal.batch.blender.files import BlenderAsset
folder = pathlib.Path(sys.argv[-1])
said = []
for scale in (1, 4):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.mesh.primitive_cube_add()
    material = bpy.data.materials.new("Paint")
    material.use_nodes = True
    bpy.context.object.data.materials.append(material)
    tree = material.node_tree
    places, moved, image = (tree.nodes.new(f"ShaderNode{name}") for name in ("TexCoord", "Mapping", "TexImage"))
    image.image = bpy.data.images.new("Wood", 4, 4)
    moved.inputs["Scale"].default_value = scale, scale, 1
    tree.links.new(places.outputs["UV"], moved.inputs["Vector"])
    tree.links.new(moved.outputs["Vector"], image.inputs["Vector"])
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "moved.blend"))
    asset = BlenderAsset(folder / "moved.blend")
    asset.save(folder / "again.blend", [])
    said.append([each for each in asset.warnings if "textures" in each])
print("RESULT", json.dumps(said))
"""


def test_a_texture_that_its_material_moves_is_named(tmp_path):
    said = "Materials scale, turn or move textures of the map, which was left."
    assert in_blender(BPY[0], tmp_path, MOVED, tmp_path) == [[], [said]]


MAKE_TEXTURED_FBX = """
import bpy, sys
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_cube_add()
material = bpy.data.materials.new("Paint")
material.use_nodes = True
bpy.context.object.data.materials.append(material)
node = material.node_tree.nodes.new("ShaderNodeTexImage")
node.image = image = bpy.data.images.new("Wood", 4, 4)
image.filepath_raw, image.file_format = sys.argv[-1].replace(".fbx", ".png"), "PNG"
image.save()
shader = next(each for each in material.node_tree.nodes if each.type == "BSDF_PRINCIPLED")
material.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
bpy.ops.export_scene.fbx(filepath=sys.argv[-1], path_mode="COPY", embed_textures=True)
"""


def test_textures_within_an_fbx_file_stay_in_it(tmp_path):
    (tmp_path / "in").mkdir()
    in_blender(BPY[0], tmp_path, MAKE_TEXTURED_FBX, tmp_path / "in" / "cube.fbx")
    (tmp_path / "in" / "cube.png").unlink()
    code, told = run(BPY[0], tmp_path, "--seams", "sharp", "--picture-size", 0)
    assert code == 0, told
    assert b"\x89PNG" in (tmp_path / "out" / "cube.fbx" / "cube.fbx").read_bytes()


TEXT_FBX = """; FBX 7.4.0 project file
FBXHeaderExtension:  {
\tFBXVersion: 7400
}
Objects:  {
\tGeometry: 100, "Geometry::Sheet", "Mesh" {
\t\tVertices: *18 {
\t\t\ta: 0,0,0,1,0,0,1,1,0,0,1,0,2,0,0,2,1,0
\t\t}
\t\tPolygonVertexIndex: *8 {
\t\t\ta: 0,1,2,-4,1,4,5,-3
\t\t}
\t}
\tModel: 200, "Model::Sheet", "Mesh" {
\t}
}
Connections:  {
\tC: "OO",200,0
\tC: "OO",100,200
}
"""


@pytest.mark.parametrize("blender", EVERYWHERE, ids=lambda blender: blender.name)
def test_fbx_as_text_becomes_binary_or_is_named(blender, tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.fbx").write_text(TEXT_FBX)
    code, _ = run(blender, tmp_path, "--picture-size", 0)
    report = report_of(tmp_path, "a.fbx")
    if code == 0:
        assert report["warnings"] == [
            "The file was FBX as text (ASCII), and is binary now; what Blender left out was not counted."
        ]
    else:
        assert "cannot read FBX as text (ASCII): save it as binary FBX" in report["failure"]["message"]


@pytest.mark.parametrize("blender", EVERYWHERE, ids=lambda blender: blender.name)
def test_smart_islands_and_a_checker_are_for_any_format(blender, tmp_path):
    from matplotlib.image import imread

    batch_assets.write_cube(tmp_path)
    code, told = run(blender, tmp_path, "--seams", "smart", "--checker", "--picture-size", 96)
    assert code == 0, told
    report = report_of(tmp_path, "cube.obj")
    assert report["totals"]["islands"] == 6
    assert report["totals"]["seam_length"] == pytest.approx(24.0)
    assert report["versions"]["blender"]
    picture = imread(tmp_path / "out" / "cube.obj" / "checker.png")[..., :3]
    assert picture.shape == (96, 96, 3)
    # Blue and gray fields in turn, seen in a row through the middle.
    blueness = picture[48, 20:-20, 2] - picture[48, 20:-20, 0]
    assert np.count_nonzero(np.diff(blueness > 0.1)) >= 4
    assert 'href="cube.obj/checker.png"' in (tmp_path / "out" / "index.html").read_text()


def test_a_checker_is_as_clear_inside_a_box_as_outside(tmp_path):
    from matplotlib.image import imread

    path = batch_assets.write_cube(tmp_path)
    # Without the face at the end it is open toward the camera.
    lines = path.read_text().strip().split("\n")
    path.write_text("\n".join(lines[:-1]) + "\n")
    # Small islands have large fields.
    options = ("--seams", "sharp", "--checker", "--picture-size", 512, "--margin", 160)
    code, told = run(BPY[0], tmp_path, *options)
    assert code == 0, told
    picture = imread(tmp_path / "out" / "cube.obj" / "checker.png")[..., :3]
    # Flat faces have two colors each, but for the pixels where fields meet. Shadows inside make many more.
    counts = np.unique((picture * 64).astype(int).reshape(-1, 3), axis=0, return_counts=True)[1]
    assert np.sort(counts)[-24:].sum() > 0.85 * 512 * 512


@pytest.mark.parametrize("name", ["chair{0}.obj", "a{.obj", "ch###.obj", "50%.obj", "[1].obj"])
def test_a_checker_is_rendered_whatever_the_asset_is_called(name, tmp_path):
    path = batch_assets.write_cube(tmp_path)
    path.rename(path.with_name(name))
    code, told = run(BPY[0], tmp_path, "--seams", "sharp", "--checker", "--picture-size", 64)
    assert code == 0, told
    assert sorted(each.name for each in (tmp_path / "out" / name).iterdir()) == [
        *sorted(["checker.png", name, "layout.png", "report.json", "thumbnail.png"])
    ]


def test_assets_that_need_a_blender_fail_alone_where_there_is_none(tmp_path):
    batch_assets.write_cube(tmp_path)
    (tmp_path / "in" / "a.blend").write_bytes(b"BLENDER")
    code = (
        "import importlib.util as u, shutil, sys; find = u.find_spec\n"
        "u.find_spec = lambda name, *rest: None if name == 'bpy' else find(name, *rest)\n"
        "shutil.which = lambda name, *rest: None\n"
        "from spectral_conformal.batch import command; sys.exit(command.main(sys.argv[1:]))"
    )
    words = [sys.executable, "-c", code, tmp_path / "in", "--out", tmp_path / "out", "--jobs", 1]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=SECONDS)
    assert done.returncode == 1, done.stderr
    assert report_of(tmp_path, "cube.obj")["status"] == "unwrapped"
    failure = report_of(tmp_path, "a.blend")["failure"]
    assert failure["kind"] == "error" and "neither bpy in this Python nor a Blender" in failure["message"]


SHARED = """
import bpy, sys
folder = sys.argv[-1]
for name in ("one", "other"):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.context.scene.unit_settings.scale_length = 0.01
    bpy.ops.mesh.primitive_cube_add()
    mesh = bpy.context.object.data
    for material in ("first", "second"):
        mesh.materials.append(bpy.data.materials.new(material))
    for face in mesh.polygons:
        face.material_index = face.index % 2
    bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/{name}.blend")
"""


@pytest.mark.parametrize("blender", BPY, ids=lambda blender: blender.name)
def test_materials_units_and_an_atlas_of_blender_files(blender, tmp_path):
    (tmp_path / "in").mkdir()
    in_blender(blender, tmp_path, SHARED, tmp_path / "in")
    code, output = run(blender, tmp_path, "--pack-by", "material", "--seams", "sharp", "--svg")
    assert code == 0, output
    for name in ("one.blend", "other.blend"):
        totals = report_of(tmp_path, name)["totals"]
        assert (totals["islands"], totals["tiles"], totals["overlaps"]) == (6, 2, 0)
        # Sides of 2 units, each a centimeter: three squares in each of two textures.
        drawn = (tmp_path / "out" / name / "pattern.svg").read_text()
        first = drawn.partition('points="')[2].partition('"')[0].split()
        corners = np.array([pair.split(",") for pair in first], float)
        assert np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1) == pytest.approx(
            np.full(4, 20.0), rel=1e-5
        )
    code, output = run(blender, tmp_path, "--atlas", "both", "--seams", "sharp")
    assert code == 0, output
    reports = [report_of(tmp_path, name) for name in ("one.blend", "other.blend")]
    assert [report["atlas"]["assets"] for report in reports] == [["one.blend", "other.blend"]] * 2
    assert [report["totals"]["overlaps"] for report in reports] == [0, 0]
    uv = [in_blender(blender, tmp_path, READ, tmp_path / "out" / name / name) for name in ("one.blend", "other.blend")]
    assert uv[0] != uv[1]
    fills = [report["totals"]["fill"] for report in reports]
    assert fills == pytest.approx([fills[0]] * 2) and sum(fills) > 0.7
