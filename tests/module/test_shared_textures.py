# SPDX-License-Identifier: GPL-3.0-or-later
"""The textures of an atlas: assets share one image for each role, and look the same."""

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from spectral_conformal import assets
from spectral_conformal.batch import command, settings, task

from tests.module import batch_assets
from tests.module import textured_assets as made
from tests.module.test_gltf import corners_of, load, values
from tests.module.test_gltf_textures import assert_same, full_sphere
from tests.module.test_obj_textures import write_sphere as write_obj
from tests.module.test_rebake import at, places, shown

pytest.importorskip("OpenImageIO")


def packed(folder, *names, **more):
    """Unwrap files of a folder into one atlas; return the new files and the reports."""
    wanted = {"rebake": "auto", "picture_size": 0, "texture_size": 512, "seams": "keep", **more}
    requests = []
    for name in names:
        place = folder / "out" / name
        place.mkdir(parents=True)
        paths = str(folder / name), str(place), str(place / name)
        requests.append(task.Request(name, *paths, settings.from_values(wanted).as_json()))
    reports = task.run_atlas(task.Atlas("props", "", requests, str(folder / "out")))
    assert all(report["status"] in ("unwrapped", "kept") for report in reports), reports
    return [folder / "out" / name / name for name in names], reports


def image_of(path, *keys):
    """Return the content of the image of a texture in the first material of a glTF file."""
    document, buffers, _ = load(path)
    info = document["materials"][0]
    for key in keys:
        info = info[key]
    part = type("Part", (), {"document": document, "buffers": buffers, "path": path})
    return made.content_of(document["images"][document["textures"][info["index"]]["source"]], part)


def texels(content, path):
    """Return the texels (n, channels) at the middle of the triangles of a glTF file."""
    document, buffers, _ = load(path)
    pixels = np.asarray(Image.open(io.BytesIO(content)))
    (primitive,) = document["meshes"][0]["primitives"]
    uv = values(document, buffers, primitive["attributes"]["TEXCOORD_0"]).astype(float)
    middle = uv[corners_of(document, buffers, primitive).reshape(-1, 3)].mean(axis=1)
    height, width = pixels.shape[:2]
    return pixels[(middle[:, 1] * height).astype(int), (middle[:, 0] * width).astype(int)]


def colored_sphere(seed, kind="PNG", uri=None, **more):
    asset = made.Textured()
    color = asset.texture(made.encoded(made.painted(128, 192, 3, seed), kind), uri)
    asset.add(made.sphere(6), asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": color}, **more}))
    return asset


def plain_sphere(**material):
    """No texture, and a map that nothing reads."""
    asset = made.Textured()
    asset.add(made.sphere(6), asset.material(**material))
    return asset


def test_binary_files_hold_the_same_image_of_each_role(tmp_path):
    full_sphere().save(tmp_path / "a.glb")
    colored_sphere(5, roughnessFactor=0.2).save(tmp_path / "b.glb")
    plain_sphere(
        pbrMetallicRoughness={"baseColorFactor": [1.0, 0.0, 0.5, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6},
        emissiveFactor=[0.0, 0.25, 1.0],
    ).save(tmp_path / "c.glb")
    written, reports = packed(tmp_path, "a.glb", "b.glb", "c.glb")
    assert_same(tmp_path / "a.glb", written[0])
    surface = "pbrMetallicRoughness"
    roles = {
        "base_color": (surface, "baseColorTexture"),
        "metallic_roughness": (surface, "metallicRoughnessTexture"),
        "normal": ("normalTexture",),
        "occlusion": ("occlusionTexture",),
        "emissive": ("emissiveTexture",),
    }
    for role, keys in roles.items():
        beside = (tmp_path / "out" / f"props_{role}.png").read_bytes()
        assert [image_of(path, *keys) for path in written] == [beside] * 3
    for path, report in zip(written, reports):
        document, _, _ = load(path)
        assert len(document["images"]) == 5
        assert {each["name"] for each in report["textures"]} == {f"props_{role}.png" for role in roles}
        assert sorted(report["shared_textures"]) == sorted(f"props_{role}.png" for role in roles)
    # Factors became texels, and are gone.
    found = {role: texels(image_of(written[2], *keys), written[2]) for role, keys in roles.items()}
    for role, expected in {
        "base_color": (255, 0, 188),
        "metallic_roughness": (255, 153, 0),
        "normal": (128, 128, 255),
        "occlusion": (255, 255, 255),
        "emissive": (0, 137, 255),
    }.items():
        assert np.abs(found[role].astype(int) - expected).max() <= 1
    material = load(written[2])[0]["materials"][0]
    assert material["emissiveFactor"] == [1.0, 1.0, 1.0]
    assert material[surface].keys() == {"baseColorTexture", "metallicRoughnessTexture"}
    # A texture of its own stays with its factor.
    rough = texels(image_of(written[1], *roles["metallic_roughness"]), written[1])
    assert np.abs(rough.astype(int) - (255, 51, 255)).max() <= 1
    assert "emissiveFactor" in load(written[1])[0]["materials"][0]


def test_without_any_texture_of_a_role_there_is_no_image(tmp_path):
    colored_sphere(1, "JPEG").save(tmp_path / "a.glb")
    colored_sphere(2, "JPEG").save(tmp_path / "b.glb")
    written, _ = packed(tmp_path, "a.glb", "b.glb")
    assert [each.name for each in (tmp_path / "out").glob("props*")] == ["props_base_color.jpg"]
    for name, path in zip(("a.glb", "b.glb"), written):
        document, _, _ = load(path)
        assert len(document["images"]) == len(document["textures"]) == 1
        assert document["images"][0]["mimeType"] == "image/jpeg"
        assert_same(tmp_path / name, path)


def test_without_any_texture_files_are_as_ever(tmp_path):
    for name in ("a.glb", "b.glb"):
        asset = plain_sphere(pbrMetallicRoughness={"baseColorFactor": [1.0, 0.0, 0.5, 1.0]})
        for key in ("images", "textures", "samplers"):
            del asset.build.json[key]
        asset.save(tmp_path / name)
    written, reports = packed(tmp_path, "a.glb", "b.glb")
    for path, report in zip(written, reports):
        document, _, _ = load(path)
        assert not {"images", "textures"} & document.keys()
        assert document["materials"] == load(tmp_path / path.name)[0]["materials"]
        assert report["textures"] == report["shared_textures"] == []


def test_files_of_several_formats_name_one_image(tmp_path):
    pxr_tests = pytest.importorskip("tests.module.test_usd_textures")
    colored_sphere(1, uri="color.png").save(tmp_path / "a.gltf", "gltf")
    color = made.painted(256, 384, 3, 6)
    (tmp_path / "skin.png").write_bytes(made.encoded(color))
    source = tmp_path / "b.obj"
    _, uv, triangles = write_obj(
        source, "newmtl skin\nKd 1 1 1\nmap_Kd skin.png\nnewmtl red\nKd 1 0 0\n", ("skin", "red")
    )
    (tmp_path / "usd").mkdir()
    pxr_tests.write_sphere(tmp_path / "usd" / "c.usda")
    for path in (tmp_path / "usd").iterdir():
        path.rename(tmp_path / ("c.usda" if path.suffix == ".usda" else path.name))
    written, reports = packed(tmp_path, "a.gltf", "b.obj", "c.usda")
    shared = tmp_path / "out" / "props_base_color.png"
    document = json.loads(written[0].read_text())
    assert [image["uri"] for image in document["images"] if "base" in image["uri"]] == ["../props_base_color.png"]
    library = written[1].with_name("b_my materials.mtl")
    assert library.read_text().count("map_Kd ../props_base_color.png") == 2
    assert "Kd 1 1 1\nmap_Kd" in library.read_text().partition("newmtl red")[2]
    assert_same(tmp_path / "a.gltf", written[0])
    image = assets.images.read(shared.read_bytes())
    (mesh,) = assets.read(written[1]).meshes
    corners = np.arange(triangles.size).reshape(-1, 3)
    half = len(np.array_split(triangles, 2)[0])
    where = places(triangles[:half], 4000)
    before = shown(color, at(uv, triangles[:half], where))
    after = shown(image, at(mesh.corner_uv, corners[:half], where))
    assert np.abs(before - after).mean() < 1
    where = places(triangles[half:], 4000)
    red = shown(image, at(mesh.corner_uv, corners[half:], where))
    assert np.abs(red - (255, 0, 0)).mean() < 1
    named = pxr_tests.files_of(written[2])
    for key, role in (("diffuseColor", "base_color"), ("roughness", "roughness"), ("normal", "normal")):
        assert Path(named[key][0]).resolve() == tmp_path / "out" / f"props_{role}.png"
    assert "@../props_base_color.png@" in written[2].read_text()
    assert (tmp_path / "out" / "props_roughness.png").is_file()
    assert not any("lie on others" in warning for report in reports for warning in report["warnings"])


def test_a_package_holds_a_copy(tmp_path):
    pxr_tests = pytest.importorskip("tests.module.test_usd_textures")
    pxr_tests.write_sphere(tmp_path / "a.usda")
    pxr_tests.UsdUtils.CreateNewUsdzPackage(str(tmp_path / "a.usda"), str(tmp_path / "a.usdz"))
    colored_sphere(1).save(tmp_path / "b.glb")
    written, _ = packed(tmp_path, "a.usdz", "b.glb")
    with zipfile.ZipFile(written[0]) as package:
        (name,) = [name for name in package.namelist() if "base_color" in name]
        assert package.read(name) == (tmp_path / "out" / "props_base_color.png").read_bytes()


@pytest.mark.parametrize("name", ["b.usda", "b.usdz"])
def test_values_of_usd_are_in_the_images(name, tmp_path):
    pxr_tests = pytest.importorskip("tests.module.test_usd_textures")
    from pxr import Sdf, Usd, UsdGeom, UsdShade, UsdUtils

    pxr_tests.write_sphere(tmp_path / "a.usda")
    source = tmp_path / name.replace("usdz", "usda")
    batch_assets.write_usd(source, *batch_assets.grid(5, 0.3, 2))
    stage = Usd.Stage.Open(str(source))
    material = UsdShade.Material.Define(stage, "/grid/Red")
    surface = UsdShade.Shader.Define(stage, "/grid/Red/Surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set((1.0, 0.0, 0.5))
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    UsdShade.MaterialBindingAPI.Apply(stage.GetPrimAtPath("/grid")).Bind(material)
    stage.Save()
    if name.endswith("z"):
        UsdUtils.CreateNewUsdzPackage(str(source), str(tmp_path / name))
    written, reports = packed(tmp_path, "a.usda", name)
    stage = Usd.Stage.Open(str(written[1]))
    (mesh,) = assets.read(written[1]).meshes
    middle = np.add.reduceat(mesh.corner_uv, mesh.face_offsets[:-1]) / np.diff(mesh.face_offsets)[:, None]
    for key, role, expected in (("diffuseColor", "base_color", (255, 0, 188)), ("roughness", "roughness", (128,) * 3)):
        fed = UsdShade.Shader(stage.GetPrimAtPath("/grid/Red/Surface")).GetInput(key).GetConnectedSources()[0][0]
        reader = fed.source.GetInput("st").GetConnectedSources()[0][0].source
        variable = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/grid")).GetPrimvar(reader.GetInput("varname").Get())
        assert variable.HasValue()
        content = pxr_tests.read(fed.source.GetInput("file").Get().resolvedPath)
        assert (content == assets.images.read((tmp_path / "out" / f"props_{role}.png").read_bytes())).all()
        height, width = content.shape[:2]
        found = content[((1 - middle[:, 1]) * height).astype(int), (middle[:, 0] * width).astype(int)]
        assert np.abs(found.astype(int) - expected).max() <= 1
    # Nothing has textures of metal or emission.
    assert not UsdShade.Shader(stage.GetPrimAtPath("/grid/Red/Surface")).GetInput("metallic")
    assert all(report["warnings"] == [] or "lie on" not in str(report["warnings"]) for report in reports)


@pytest.mark.parametrize("name", ["a.obj", "a.ply", "a.glb", "a.usda"])
def test_vertex_colors_are_part_of_the_base_color(name, tmp_path):
    write_green(tmp_path / name)
    colored_sphere(1).save(tmp_path / "b.glb")
    written, reports = packed(tmp_path, name, "b.glb", rebake_colors=True, seams="suggest")
    assert [each["name"] for each in reports[0]["textures"]][0] == "props_base_color.png"
    if name == "a.obj":
        assert "map_Kd ../props_base_color.png" in next(written[0].parent.glob("*.mtl")).read_text()
    elif name == "a.glb":
        named = image_of(written[0], "pbrMetallicRoughness", "baseColorTexture")
        assert named == (tmp_path / "out" / "props_base_color.png").read_bytes()
    else:
        assert b"../props_base_color.png" in written[0].read_bytes()
    pixels = np.asarray(Image.open(tmp_path / "out" / "props_base_color.png"))
    (mesh,) = assets.read(written[0]).meshes
    middle = np.add.reduceat(mesh.corner_uv, mesh.face_offsets[:-1]) / np.diff(mesh.face_offsets)[:, None]
    height, width = pixels.shape[:2]
    found = pixels[((1 - middle[:, 1]) * height).astype(int), (middle[:, 0] * width).astype(int)]
    assert (found[:, :3] == (0, 255, 0)).all()


def test_vertex_colors_alone_lose_nothing(tmp_path):
    for name in ("a.ply", "b.ply"):
        write_green(tmp_path / name)
    packed(tmp_path, "a.ply", "b.ply", rebake_colors=True, seams="suggest")
    assert [each.name for each in (tmp_path / "out").glob("props*")] == ["props_base_color.png"]


def write_green(path):
    """Write a mesh without a map, whose vertices are green."""
    points, faces = batch_assets.grid(6, 0.2, 1)
    if path.suffix == ".obj":
        rows = ["v {} {} {} 0 1 0".format(*point) for point in points.tolist()]
        rows += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in faces.tolist()]
        path.write_text("\n".join(rows) + "\n")
    elif path.suffix == ".ply":
        head = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
        head += "".join(f"property float {axis}\n" for axis in "xyz")
        head += "".join(f"property uchar {color}\n" for color in ("red", "green", "blue"))
        head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        rows = ["{} {} {} 0 255 0".format(*point) for point in points.tolist()]
        rows += [" ".join(map(str, [len(face), *face])) for face in faces.tolist()]
        path.write_text(head + "\n".join(rows) + "\n")
    elif path.suffix == ".usda":
        pytest.importorskip("pxr")
        batch_assets.write_usd(path, points, faces)
        colors = ", ".join(["(0, 1, 0)"] * len(points))
        more = f'    color3f[] primvars:displayColor = [{colors}] (\n        interpolation = "vertex"\n    )\n'
        text = path.read_text()
        path.write_text(text[: text.rindex("}")] + more + "}\n")
    else:
        asset = made.Textured()
        positions, normals, uv, triangles = made.sphere(6)
        asset.add((positions, normals, uv, triangles), asset.material())
        attributes = asset.primitives[0]["attributes"]
        attributes["COLOR_0"] = asset.build.accessor(np.tile([0.0, 1.0, 0.0], (len(positions), 1)))
        del attributes["TEXCOORD_0"]
        asset.save(path)


def test_variants_keep_their_own_images(tmp_path):
    """They lie on each other in the map."""
    asset = colored_sphere(1)
    other = asset.texture(made.encoded(made.painted(128, 192, 3, 9)))
    number = asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": other}})
    asset.primitives[0]["extensions"] = {
        "KHR_materials_variants": {"mappings": [{"material": number, "variants": [0]}]}
    }
    asset.build.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "second"}]}}
    asset.build.json["extensionsUsed"].append("KHR_materials_variants")
    asset.save(tmp_path / "a.glb")
    colored_sphere(2).save(tmp_path / "b.glb")
    written, reports = packed(tmp_path, "a.glb", "b.glb")
    assert_same(tmp_path / "a.glb", written[0])
    assert_same(tmp_path / "b.glb", written[1])
    assert sum("is not in the atlas: it belongs to a variant" in each for each in reports[0]["warnings"]) == 2


def test_an_image_that_cannot_be_read_is_said(tmp_path):
    asset = colored_sphere(1)
    broken = asset.texture(b"\x89PNG\r\n\x1a\nnothing")
    asset.build.json["materials"][0]["emissiveTexture"] = {"index": broken}
    asset.save(tmp_path / "a.glb")
    full_sphere().save(tmp_path / "b.glb")
    written, reports = packed(tmp_path, "a.glb", "b.glb")
    assert any("was not drawn anew" in each for each in reports[0]["warnings"])
    assert image_of(written[0], "emissiveTexture") == b"\x89PNG\r\n\x1a\nnothing"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--rebake", "same"), "needs --rebake auto or a size"),
        (("--settings", "tables.toml"), "needs the same rebake and rebake_colors"),
    ],
)
def test_what_an_atlas_cannot_share(arguments, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    batch_assets.write_obj(tmp_path / "a.obj", *batch_assets.grid(4, 0.2, 1))
    (tmp_path / "tables.toml").write_text('["a*"]\nrebake = "auto"\n')
    code = command.main(["a.obj", "--out", "out", "--atlas", "props", *arguments])
    assert code == command.WRONG_USE
    assert said in capsys.readouterr().err


def test_an_atlas_without_its_images_is_made_again(tmp_path):
    (tmp_path / "in").mkdir()
    for k in (1, 2):
        colored_sphere(k).save(tmp_path / "in" / f"{k}.glb")
    words = [str(tmp_path / "in"), "--out", str(tmp_path / "out"), "--jobs", "1", "--quiet", "--atlas", "props"]
    words += ["--rebake", "--texture-size", "256", "--seams", "keep", "--resume"]
    image = tmp_path / "out" / "props_base_color.png"
    assert command.main(words) == command.ALL_WORKED
    content, made_at = image.read_bytes(), (tmp_path / "out" / "1.glb" / "report.json").stat().st_mtime_ns
    assert command.main(words) == command.ALL_WORKED
    assert (tmp_path / "out" / "1.glb" / "report.json").stat().st_mtime_ns == made_at
    image.unlink()
    assert command.main(words) == command.ALL_WORKED
    assert image.read_bytes() == content
