# SPDX-License-Identifier: GPL-3.0-or-later
"""Assets with many textures on one map: each would be large, since its faces cover little of the map."""

import json
import re

import numpy as np
import pytest
from spectral_conformal._drawing_plan import DrawingLimits, NewTexture
from spectral_conformal.batch import command, task
from spectral_conformal.batch.settings import from_values

from tests.module import batch_assets
from tests.module import textured_assets as made

N, SIDE, SIZE = 30, 256, 512

pytest.importorskip("OpenImageIO")


def square(k):
    """(4, 3) corners of a square in a row of squares with gaps, and its UVs over all of the texture."""
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    return np.c_[corners + (1.25 * (k % 6), 1.25 * (k // 6)), np.zeros(4)], corners


def write_gltf(path, n=N):
    """Squares, each with a material and a texture of its own."""
    asset = made.Textured()
    for k in range(n):
        points, uv = square(k)
        material = asset.material(
            name=f"m{k}",
            pbrMetallicRoughness={"baseColorTexture": {"index": asset.texture(made.encoded(picture(k)))}},
        )
        asset.add(
            (points, np.tile((0.0, 0.0, 1.0), (4, 1)), uv * (1, -1) + (0, 1), np.array([(0, 1, 2), (0, 2, 3)])),
            material,
        )
    asset.save(path)


def write_usd(path, n=N):
    prims = []
    for k in range(n):
        points, uv = square(k)
        (path.parent / f"t{k}.png").write_bytes(made.encoded(picture(k)))
        places = ", ".join(f"({x}, {y}, {z})" for x, y, z in points)
        prims.append(
            f"""
def Mesh "square{k}" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [{places}]
    texCoord2f[] primvars:st = [{", ".join(f"({u}, {v})" for u, v in uv)}] (interpolation = "vertex")
    rel material:binding = </m{k}>
}}
def Material "m{k}" {{
    token outputs:surface.connect = </m{k}/surface.outputs:surface>
    def Shader "surface" {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </m{k}/image.outputs:rgb>
        token outputs:surface
    }}
    def Shader "reader" {{
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "st"
        float2 outputs:result
    }}
    def Shader "image" {{
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @t{k}.png@
        float2 inputs:st.connect = </m{k}/reader.outputs:result>
        float3 outputs:rgb
    }}
}}"""
        )
    path.write_text("#usda 1.0\n" + "".join(prims))


def write_obj(path, n=N):
    points, faces = zip(*(square(k) for k in range(n)))
    lines = ["mtllib squares.mtl", *("v {} {} {}".format(*each) for each in np.concatenate(points))]
    lines += ["vt {} {}".format(*each) for each in faces[0]]
    for k in range(n):
        lines += [f"usemtl m{k}", "f " + " ".join(f"{4 * k + i}/{i}" for i in range(1, 5))]
        (path.parent / f"t{k}.png").write_bytes(made.encoded(picture(k)))
    (path.parent / "squares.mtl").write_text("".join(f"newmtl m{k}\nmap_Kd t{k}.png\n" for k in range(n)))
    path.write_text("\n".join(lines) + "\n")


WRITERS = {".glb": write_gltf, ".usda": write_usd, ".obj": write_obj}


def picture(k):
    return np.rint(255 * made.smooth(SIDE, SIDE, 3, k)).astype(np.uint8)


@pytest.fixture(params=WRITERS)
def asset(request, tmp_path):
    if request.param == ".usda":
        pytest.importorskip("pxr")
    path = tmp_path / "in" / f"squares{request.param}"
    path.parent.mkdir()
    WRITERS[request.param](path)
    return path


def unwrapped(asset, folder, **limits):
    folder.mkdir()
    values = from_values({"rebake": "auto", "texture_size": SIZE, "picture_size": 0, "seams": "keep"}).as_json()
    told = []
    request = task.Request(asset.name, str(asset), str(folder), str(folder / asset.name), values, **limits)
    report = task.run(request, lambda phase, note: told.append((phase, note, len(list(folder.iterdir())))))
    assert report["status"] == "unwrapped", report
    return report, [each for each in told if each[1]]


def test_textures_for_which_there_is_no_time_are_smaller(asset, tmp_path):
    """30 textures of 256 x 256 need 2048 x 2048 each, since each square covers a fiftieth of the map."""
    report, told = unwrapped(asset, tmp_path / "out", seconds=8.0)
    sides = [each["width"] for each in report["textures"]]
    assert len(sides) == N
    # By the estimate, 4 seconds are enough for 18 million texels.
    assert 9e6 < sum(side**2 for side in sides) < 19e6
    assert max(sides) <= 2 * min(sides) <= 2048, "the largest are halved first"
    (warning,) = [each for each in report["warnings"] if "textures would have" in each]
    assert warning.startswith("30 textures would have 125.8 million texels, more than there is time or memory for")
    wanted = [(0.9 * SIDE**2 / (each["covered"] * each["width"] ** 2)) ** 0.5 for each in report["textures"]]
    (told_loss,) = re.findall(r"up to ([\d.]+) times fewer per length than before", warning)
    assert float(told_loss) == pytest.approx(max(wanted), rel=0.05)
    ((phase, note, n_files),) = told
    assert phase == "write" and n_files == 0, "it is said before anything is written"
    assert re.match(r"30 textures of \d+x\d+ to \d+x\d+, \d+ million texels: about 0:04, up to \d+ MiB", note), note
    assert note.endswith("instead of 126 million")


def test_memory_is_a_limit_too(tmp_path):
    write_obj(tmp_path / "squares.obj", 4)
    report, _ = unwrapped(tmp_path / "squares.obj", tmp_path / "out", memory=16 << 20)
    sizes = [3 * each["width"] * each["height"] for each in report["textures"]]
    assert 4 * max(sizes) + sum(sizes) / 2 <= 8 << 20 < 4 * (4 * max(sizes) + sum(sizes) / 2)


def test_smaller_textures_are_drawn_again_once_there_is_more_time(tmp_path, capsys):
    (tmp_path / "in").mkdir()
    write_obj(tmp_path / "in" / "squares.obj", 4)
    folder = tmp_path / "out" / "squares.obj"
    folder.parent.mkdir()
    report, _ = unwrapped(tmp_path / "in" / "squares.obj", folder, seconds=0.25)
    assert report["reduced_by"] == {"seconds": 0.25, "memory": None}
    words = [str(tmp_path / "in"), "--out", str(folder.parent), "--rebake", "--texture-size", str(SIZE)]
    words += ["--picture-size", "0", "--seams", "keep", "--resume", "--dry-run"]
    for limits, is_done in (
        (("--seconds", "0.25"), True),
        (("--seconds", "0.25", "--memory", "4000"), True),
        (("--seconds", "0.125"), True),
        (("--seconds", "0.5"), False),
        ((), False),
    ):
        assert command.main([*words, *limits]) == command.ALL_WORKED
        assert ("done already" in capsys.readouterr().out) is is_done, limits


def test_without_limits_textures_are_as_large_as_asked(tmp_path):
    write_obj(tmp_path / "squares.obj", 4)
    report, told = unwrapped(tmp_path / "squares.obj", tmp_path / "out")
    assert not told and not [each for each in report["warnings"] if "texels" in each]
    assert "reduced_by" not in report


def test_a_dry_run_says_what_textures_take(asset, tmp_path, capsys):
    words = ["batch", str(asset), "--out", str(tmp_path / "out"), "--texture-size", str(SIZE), "--dry-run"]
    lines = {}
    for options in ((), ("--rebake",), ("--rebake", "--seconds", "8"), ("--rebake", "--pack-by", "material")):
        assert command.main([*words[1:], *options]) == command.ALL_WORKED
        lines[options] = capsys.readouterr().out
    assert "textures" not in lines[()].split("{", 1)[0]
    assert "  30 textures of 2048x2048, 126 million texels: about 0:2" in lines["--rebake",]
    assert re.search(
        r"million texels: about 0:0[34], .* instead of 126 million\n  30 textures would have",
        lines["--rebake", "--seconds", "8"],
    )
    assert "  30 textures of 512x512, 8 million texels: about 0:0" in lines["--rebake", "--pack-by", "material"]


def test_the_largest_are_halved_until_all_fit():
    textures = [NewTexture(name, (side, side // 2), 3) for name, side in (("a", 512), ("b", 4096), ("c", 2048))]
    limits = DrawingLimits(seconds=0.3)
    plan = limits.planned(textures)
    assert [each.size for each in plan.textures] == [(512, 256), (1024, 512), (1024, 512)]
    assert [each.loss for each in plan.textures] == [1.0, 4.0, 2.0]
    assert plan.seconds <= limits.seconds and plan.asked_texels == 512 * 256 + 4096 * 2048 + 2048 * 1024
    assert DrawingLimits().planned(textures).textures == textures
    # Nothing is smaller than a texel, and nothing takes no time.
    assert {each.size for each in DrawingLimits(seconds=0.0).planned(textures).textures} == {(1, 1)}


def test_images_of_an_atlas_are_within_the_limits_too(tmp_path):
    write_obj(tmp_path / "squares.obj", 4)
    values = from_values({"rebake": "auto", "texture_size": SIZE, "picture_size": 0, "seams": "keep"}).as_json()
    words = "squares.obj", str(tmp_path / "squares.obj"), str(tmp_path), str(tmp_path / "new.obj"), values
    told = []
    for limit, side in ((None, 512), (0.05, 256)):
        atlas = task.Atlas("all", "", [task.Request(*words, seconds=limit)], str(tmp_path))
        (report,) = task.run_atlas(atlas, lambda phase, note: told.append((phase, note)) if note else None)
        assert [each["width"] for each in report["textures"]] == [side]
        assert ["The texture base color would have" in each for each in report["warnings"]].count(True) == (
            limit is not None
        )
    ((phase, note),) = told
    assert phase == "textures" and note.startswith("1 texture of 256x256")


@pytest.mark.slow
def test_the_command_ends_in_time_and_says_so(tmp_path, capsys):
    (tmp_path / "in").mkdir()
    write_gltf(tmp_path / "in" / "squares.glb")
    batch_assets.write_obj(tmp_path / "in" / "other.obj", *batch_assets.grid(4, 0.2, 1))
    words = [str(tmp_path / "in"), "--out", str(tmp_path / "out"), "--rebake", "--texture-size", str(SIZE)]
    assert command.main([*words, "--seconds", "6", "--progress", "json"]) == command.ALL_WORKED
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    (note,) = [each for each in events if each["event"] == "note"]
    assert (note["name"], note["phase"]) == ("squares.glb", "write")
    assert "squares.glb: 30 textures of" in (tmp_path / "out" / command.LOG).read_text()
