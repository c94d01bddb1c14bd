# SPDX-License-Identifier: GPL-3.0-or-later
"""What a result lacks is named before anything is replaced, by readers that do not share the writers' code."""

import json
import re
import struct

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.assets.usd import UsdAsset

from tests.module import test_assets, test_gltf

QUADS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
OBJ = f"mtllib a.mtl b.mtl\no One\n{QUADS}usemtl red\nf 1 2 3 4\no Two\ng side\nusemtl blue\nf 2 5 6 3\nl 1 2\n"
USD = """#usda 1.0
(
    defaultPrim = "W"
    endTimeCode = 60
    startTimeCode = 1
    timeCodesPerSecond = 30
)
def Xform "W"
{
    def Mesh "M"
    {
        int[] faceVertexCounts = [4, 4]
        int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 5, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
        rel material:binding = </W/Red>
        asset painted = @tex.png@
    }
    def Xform "Part" ( references = @part.usda@ ) {}
    def Material "Red" {}
}
"""
PART = '#usda 1.0\n( defaultPrim = "P" )\ndef Xform "P"\n{\n    def Sphere "Ball" {}\n}\n'


def maps_of(asset):
    return [
        assets.UvMap(mesh.vertices[mesh.corner_vertices][:, :2] / 4, np.ones(len(mesh.face_offsets) - 1, bool))
        for mesh in asset.meshes
    ]


def save(folder, name):
    """Write a file of a format, with the files that it references."""
    folder.mkdir(exist_ok=True)
    path = folder / name
    if path.suffix == ".obj":
        (folder / "a.mtl").write_text("newmtl red\nmap_Kd -s 2 2 2 my red.png\n")
        (folder / "b.mtl").write_text("newmtl blue\n")
        (folder / "my red.png").write_bytes(test_gltf.PICTURE)
        return test_assets.save(path, OBJ)
    if path.suffix == ".usda":
        (folder / "part.usda").write_text(PART)
        (folder / "tex.png").write_bytes(test_gltf.PICTURE)
        path.write_text(USD)
        return path
    if path.suffix == ".ply":
        layout = next(iter(test_assets.LAYOUTS.values()))
        return test_assets.save(path, test_assets.ply(layout, "ascii").replace(b"\n", b"\ncomment by hand\n", 1))
    return test_gltf.save(path, test_gltf.everything(), *(["embedded"] if path.suffix == ".gltf" else []))


def gltf(change):
    """Return a change of the JSON of a glTF file."""

    def changed(content):
        document = json.loads(content)
        change(document)
        return json.dumps(document).encode()

    return changed


def drop_material(document):
    """Drop the last material, whose faces get the first one: what is left can be read."""
    document["materials"].pop()
    for primitive in (each for mesh in document["meshes"] for each in mesh["primitives"] if "material" in each):
        primitive["material"] = 0


def glb_without_materials(content):
    (length,) = struct.unpack_from("<I", content, 12)
    document = json.loads(content[20 : 20 + length])
    drop_material(document)
    text = json.dumps(document).encode()
    return content[:12] + struct.pack("<I4s", len(text), b"JSON") + text + content[20 + length :]


def sub(pattern, new):
    return lambda content: re.sub(pattern.encode(), new.encode(), content, count=1)


LOSSES = (
    ("m.gltf", gltf(drop_material), "of . materials"),
    ("m.gltf", gltf(lambda d: d["materials"][0].clear()), "values in materials"),
    ("m.gltf", gltf(lambda d: d["nodes"][0].pop("name", d["nodes"][0].pop("mesh", None))), "values in nodes"),
    ("m.gltf", gltf(lambda d: d.pop("animations")), "animations"),
    (
        "m.gltf",
        gltf(lambda d: d["accessors"][d["animations"][0]["samplers"][0]["input"]].update(count=10**6)),
        "accessors",
    ),
    ("m.gltf", gltf(lambda d: d["meshes"][0]["primitives"].pop(0)), "faces"),
    ("m.glb", glb_without_materials, "of . materials"),
    ("m.obj", sub(r"o Two\n", ""), r"1 of 2 objects \(Two\)"),
    ("m.obj", sub(r"usemtl blue\n", ""), r"1 of 2 uses of materials \(blue\)"),
    ("m.obj", sub(r"mtllib a.mtl b.mtl", "mtllib a.mtl"), r"materials \(blue\)"),
    ("m.obj", sub(r"f [^\n]*\nl ", "l "), "1 of 2 faces"),
    ("m.obj", sub(r"l 1 2\n", ""), "lines 'l'"),
    ("m.ply", sub(r"comment by hand\n", ""), r"lines of the header \(comment by hand\)"),
    ("m.usda", sub(r"@part.usda@", "@elsewhere.usda@"), r"part.usda"),
    ("m.usda", sub(r"@tex.png@", "@gone.png@"), r"tex.png"),
    ("m.usda", sub(r"rel material:binding = [^\n]*\n", ""), r"M.material:binding"),
    ("m.usda", sub(r"timeCodesPerSecond = 30", ""), r"metadata of the stage \(timeCodesPerSecond 30"),
    ("m.usda", sub(r"\[4, 4\](\s+\S+ \S+ = \[0, 1, 2, 3), [^\]]*", r"[4]\1"), r"1 of 2 faces \(/W/M\)"),
)


@pytest.mark.parametrize(("name", "change", "said"), LOSSES)
def test_a_loss_is_named_and_replaces_nothing(name, change, said, tmp_path, monkeypatch):
    if name.endswith(".usda"):
        pytest.importorskip("pxr")
    asset = assets.read(save(tmp_path / "in", name))
    out = tmp_path / "out" / name
    out.parent.mkdir()
    out.write_bytes(b"as it was")
    whole = type(asset).files
    monkeypatch.setattr(
        type(asset),
        "files",
        lambda *of: {path: [change(b"".join(map(bytes, content)))] for path, content in whole(*of).items()},
    )
    with pytest.raises(assets.AssetError, match=said):
        assets.write(out, asset, maps_of(asset))
    assert out.read_bytes() == b"as it was" and not list(out.parent.glob(".*"))


@pytest.mark.parametrize("name", ["m.gltf", "m.glb", "m.obj", "m.ply", "m.usda"])
def test_what_is_written_lacks_nothing(name, tmp_path):
    if name.endswith(".usda"):
        pytest.importorskip("pxr")
    asset = assets.read(save(tmp_path / "in", name))
    (tmp_path / "out").mkdir()
    assets.write(tmp_path / "out" / name, asset, maps_of(asset))
    left = {path.name for path in (tmp_path / "in").iterdir()} - {path.name for path in (tmp_path / "out").iterdir()}
    assert not left


def test_a_first_map_among_other_attributes_is_no_loss(tmp_path):
    build = test_gltf.sheet(document={"extras": {"attributes": [1], "targets": 2}})
    (primitive,) = build.json["meshes"][0]["primitives"]
    del primitive["attributes"]["TEXCOORD_0"]
    weights = build.accessor(np.ones((10, 4)))
    primitive["attributes"] |= {"WEIGHTS_0": weights, "_PRESSURE": build.accessor(np.ones((10, 1)))}
    primitive["targets"] = [{"POSITION": build.accessor(np.zeros((10, 3)))}]
    build.json["buffers"] = [{"byteLength": len(build.buffer)}]
    asset = assets.read(test_gltf.save(tmp_path / "m.glb", build))
    assert assets.write(tmp_path / "new.glb", asset, maps_of(asset))[1] == []
    assert "TEXCOORD_0" in test_gltf.load(tmp_path / "new.glb")[0]["meshes"][0]["primitives"][0]["attributes"]


def test_libraries_above_the_folder_are_found_from_elsewhere(tmp_path):
    path = save(tmp_path / "in", "m.obj")
    (tmp_path / "in" / "b.mtl").rename(tmp_path / "b.mtl")
    path.write_text(OBJ.replace("b.mtl", "../b.mtl"))
    (tmp_path / "far" / "out").mkdir(parents=True)
    assets.write(tmp_path / "far" / "out" / "m.obj", asset := assets.read(path), maps_of(asset))
    assert "mtllib a.mtl ../../b.mtl" in (tmp_path / "far" / "out" / "m.obj").read_text()


def test_a_layer_over_a_file_keeps_its_time(tmp_path):
    pytest.importorskip("pxr")
    asset = UsdAsset(save(tmp_path / "in", "m.usda"), over=True)
    assets.write(tmp_path / "over.usda", asset, maps_of(asset))
    text = (tmp_path / "over.usda").read_text()
    assert "timeCodesPerSecond = 30" in text and "startTimeCode = 1" in text and "endTimeCode = 60" in text
