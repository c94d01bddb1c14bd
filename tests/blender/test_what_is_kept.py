# SPDX-License-Identifier: GPL-3.0-or-later
"""What each format keeps: files with everything go through the batch, and docs/batch.md shows the result."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.blender import blenders
from tests.module import test_assets, test_gltf

ROOT = Path(__file__).resolve().parents[2]
NEWEST = [blender for blender in blenders.all_blenders() if blender.python == sys.executable]
KINDS = (
    *("positions", "normals", "colors", "other UV maps", "materials", "groups and names"),
    *("custom attributes and properties", "shape keys", "skins", "animations", "cameras and lights"),
    *("units, variants, instances", "comments"),
)

pytestmark = pytest.mark.skipif(not NEWEST, reason="no bpy for this Python")

OBJ = """# made by hand
mtllib a.mtl
o Sheet
v 0.1234567890123456 0 0 1 0 0
v 1 0 0 0 1 0
v 1 1 0.5 0 0 1
v 0 1 0 1 1 1
v 2 0 0 1 1 0
v 2 1 0 0 1 1
vn 0 0 1
vn 0 1 0
g left
s 1
usemtl red
f 1//1 2//1 3//2 4//2
g right
usemtl blue
f 2//1 5//1 6//2 3//2
"""


def of_obj(path):
    lines = path.read_text().splitlines()
    words = [line.split() for line in lines]
    corners = [[corner.split("/") for corner in row[1:]] for row in words if row[:1] == ["f"]]
    own = [row for row in words if row and row[0] in ("o", "g", "s", "usemtl", "f")]
    return {
        "positions": ([row[1:4] for row in words if row[:1] == ["v"]], [[c[0] for c in face] for face in corners]),
        "normals": ([row for row in words if row[:1] == ["vn"]], [[c[-1] for c in face] for face in corners]),
        "colors": [row[4:] for row in words if row[:1] == ["v"]],
        "materials": [row[:2] if row[0] == "usemtl" else row[0] for row in own] + [lines[1]],
        "groups and names": [row if row[0] in "ogs" else row[0] for row in own],
        "comments": [line for line in lines if line.startswith("#")],
    }


PLY = {
    "vertex": [
        *((name, "double") for name in "xyz"),
        *((name, "float") for name in ("nx", "ny", "nz")),
        *((name, "uchar") for name in ("red", "green", "blue")),
        ("quality", "short"),
    ],
    "edge": [("vertex1", "int"), ("vertex2", "int")],
    "face": [("label", "uint"), ("vertex_index", "uchar uchar")],
}


def of_ply(path):
    content = path.read_bytes()
    rows = test_assets.rows_of(content)
    # Copies of vertices stand behind all others, so that corners tell.
    corners = [[rows["vertex"][vertex] for vertex in face["vertex_index"]] for face in rows["face"]]

    def each(*names):
        return [[[vertex[name] for name in names] for vertex in face] for face in corners]

    return {
        "positions": each("x", "y", "z"),
        "normals": each("nx", "ny", "nz"),
        "colors": each("red", "green", "blue"),
        "custom attributes and properties": (each("quality"), [face["label"] for face in rows["face"]], rows["edge"]),
        "comments": [line for line in content.split(b"end_header")[0].split(b"\n") if line.startswith(b"comment")],
    }


def of_gltf(path):
    found, others = test_gltf.meaning(path)
    primitives = [primitive for mesh in found["meshes"] for primitive in mesh["primitives"]]

    def attribute(*names):
        return [[primitive["attributes"].get(name) for name in names] for primitive in primitives]

    return {
        "positions": attribute("POSITION"),
        "normals": attribute("NORMAL"),
        "colors": attribute("COLOR_0"),
        "other UV maps": attribute("TEXCOORD_1"),
        "materials": [found[name] for name in ("materials", "textures", "images")]
        + [primitive.get("material") for primitive in primitives],
        "groups and names": [mesh.get("name") for mesh in found["meshes"]],
        "custom attributes and properties": (
            attribute("_FEATURE_ID_0"),
            [primitive.get("extras") for primitive in primitives],
            found["extensions"]["VENDOR_unknown"],
            others,
        ),
        "shape keys": [[primitive.get("targets") for primitive in primitives], found["meshes"][0]["weights"]],
        "skins": (found["skins"], attribute("JOINTS_0", "WEIGHTS_0")),
        "animations": found["animations"],
        "cameras and lights": (found["cameras"], found["extensions"]["KHR_lights_punctual"]),
        "units, variants, instances": (found["nodes"], found["scenes"], found["extensionsUsed"]),
    }


def of_usd(path):
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(str(path))
    sheet, moving = (stage.GetPrimAtPath(f"/World/{name}") for name in ("Mirrored", "Moving"))
    value = lambda prim, name, *time: str(prim.GetAttribute(name).Get(*time))  # noqa: E731
    return {
        "positions": [value(sheet, name) for name in ("points", "faceVertexIndices", "orientation")],
        "other UV maps": value(sheet, "primvars:lightmap"),
        "materials": str(sheet.GetRelationship("material:binding").GetTargets()),
        "groups and names": [str(prim.GetPath()) for prim in stage.TraverseAll()],
        "custom attributes and properties": (value(sheet, "my:number"), str(stage.GetRootLayer().customLayerData)),
        "animations": [value(moving, "points", time) for time in (1.0, 2.0)],
        "units, variants, instances": (
            UsdGeom.GetStageMetersPerUnit(stage),
            str(UsdGeom.GetStageUpAxis(stage)),
            stage.GetPrimAtPath("/World").GetVariantSets().GetNames(),
            [stage.GetPrimAtPath(f"/World/I{k}").IsInstance() for k in (1, 2)],
        ),
    }


# Run in Blender: makes a file, or reads one and prints what it has of every kind.
SCENE = """
import bpy, json, sys
how, path = sys.argv[-2:]
is_fbx = path.endswith("fbx")
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
if how == "make":
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    cube.name = cube.data.name = "Cube"
    cube["owner"] = "props"
    cube.data.uv_layers.new(name="Lightmap")
    for k, corner in enumerate(cube.data.uv_layers["Lightmap"].data):
        corner.uv = (k / 32, 0.5)
    colors = cube.data.color_attributes.new("Tint", "BYTE_COLOR", "CORNER")
    colors.data[0].color = (1, 0, 0, 1)
    for name in ("red", "blue"):
        cube.data.materials.append(bpy.data.materials.new(name))
    cube.data.polygons[2].material_index = 1
    cube.data.normals_split_custom_set([(0, 0, 1)] * 24)
    cube.shape_key_add(name="Basis")
    cube.shape_key_add(name="Smile").data[0].co = (2, 2, 2)
    bpy.ops.object.light_add(type="SUN")
    bpy.ops.object.camera_add()
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    cube.modifiers.new("Armature", "ARMATURE").object = rig
    cube.vertex_groups.new(name="Bone").add(range(8), 1.0, "ADD")
    cube.parent = rig
    rig.location = (0, 0, 1)
    rig.keyframe_insert("location", frame=1)
    rig.location = (0, 0, 2)
    rig.keyframe_insert("location", frame=10)
    if is_fbx:
        bpy.ops.export_scene.fbx(filepath=path, use_custom_props=True, add_leaf_bones=False, colors_type="LINEAR")
    else:
        bpy.context.scene.unit_settings.scale_length = 0.01
        cube.data.attributes.new("mine", "FLOAT", "FACE").data[0].value = 7
        bpy.data.texts.new("notes").write("by hand")
        bpy.ops.wm.save_as_mainfile(filepath=path)
    sys.exit()
if is_fbx:
    bpy.ops.wm.fbx_import(filepath=path)
else:
    bpy.ops.wm.open_mainfile(filepath=path)
(cube,) = [item for item in bpy.data.objects if item.type == "MESH"]
mesh = cube.data
rounded = lambda values: [round(value, 4) for value in values]
curves = [curve for action in bpy.data.actions for layer in action.layers for strip in layer.strips
          for bag in strip.channelbags for curve in bag.fcurves]
found = {
    "positions": [rounded(vertex.co) for vertex in mesh.vertices] + [list(face.vertices) for face in mesh.polygons],
    # Blender keeps custom ones as two numbers of 16 bits.
    "normals": [[round(value, 2) + 0.0 for value in each.vector] for each in mesh.corner_normals],
    "colors": [rounded(each.color) for layer in mesh.color_attributes for each in layer.data],
    "other UV maps": [rounded(each.vector) for each in mesh.uv_layers["Lightmap"].uv],
    "materials": [mesh.materials[face.material_index].name for face in mesh.polygons],
    "groups and names": sorted(item.name for item in bpy.data.objects),
    "custom attributes and properties": [cube["owner"]] + [
        each.value for name in ("mine",) if name in mesh.attributes for each in mesh.attributes[name].data],
    "shape keys": [[key.name, [rounded(point.co) for point in key.data]] for key in mesh.shape_keys.key_blocks],
    "skins": [[group.name for group in cube.vertex_groups], sorted(m.type for m in cube.modifiers),
              [[rounded([each.weight]) for each in vertex.groups] for vertex in mesh.vertices]],
    "animations": sorted([curve.data_path, curve.array_index, len(curve.keyframe_points)] for curve in curves),
    "cameras and lights": sorted(item.type for item in bpy.data.objects if item.type in ("CAMERA", "LIGHT")),
}
if not is_fbx:
    found["units, variants, instances"] = [bpy.context.scene.unit_settings.scale_length]
    found["comments"] = [text.as_string() for text in bpy.data.texts]
print("RESULT", json.dumps(found))
"""


def of_blender(path):
    done = subprocess.run([sys.executable, "-c", SCENE, "read", path], capture_output=True, text=True, timeout=120)
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")] or [done.stdout + done.stderr]
    return json.loads(line.removeprefix("RESULT "))


FORMATS = {
    "OBJ": ("a.obj", of_obj),
    "PLY": ("a.ply", of_ply),
    "glTF": ("a.glb", of_gltf),
    "USD": ("a.usda", of_usd),
    ".blend": ("a.blend", of_blender),
    "FBX": ("a.fbx", of_blender),
}


def make(folder):
    folder.mkdir()
    (folder / "a.obj").write_text(OBJ)
    (folder / "a.ply").write_bytes(test_assets.ply(PLY, "binary_little_endian"))
    test_gltf.save(folder / "a.glb", test_gltf.everything())
    from tests.module import test_usd

    test_usd.save(folder / "a.usda")
    for name in ("a.blend", "a.fbx"):
        subprocess.run(
            [sys.executable, "-c", SCENE, "make", folder / name], check=True, capture_output=True, timeout=120
        )


def test_the_table_of_what_is_kept_is_that_of_the_document(tmp_path):
    pytest.importorskip("pxr")
    make(tmp_path / "in")
    words = [sys.executable, "-m", "spectral_conformal", "batch", tmp_path / "in", "--out", tmp_path / "out"]
    done = subprocess.run([*words, "--jobs", "1"], env={**os.environ}, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    columns = {}
    for title, (name, read) in FORMATS.items():
        before, after = read(tmp_path / "in" / name), read(tmp_path / "out" / name / name)
        columns[title] = {kind: "kept" if after[kind] == before[kind] else "changed" for kind in before}
        # What is equal is there: nothing is empty.
        assert all(before.values()), title
    rows = [f"| {kind} | {' | '.join(columns[title].get(kind, '') for title in FORMATS)} |" for kind in KINDS]
    table = "\n".join([f"| | {' | '.join(FORMATS)} |", "|---" * (len(FORMATS) + 1) + "|", *rows])
    document = (ROOT / "docs" / "batch.md").read_text(encoding="utf-8")
    assert table in document, table
