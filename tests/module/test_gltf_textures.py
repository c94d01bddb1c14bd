# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of glTF files, drawn anew for a new map: the asset looks the same from six sides."""

import json

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.__main__ import main
from spectral_conformal.assets import images
from spectral_conformal.batch import settings, task

from tests.module import batch_assets
from tests.module import textured_assets as made
from tests.module.test_gltf import load


def unwrapped(source, folder, **values):
    """Unwrap a file by the batch's settings; return the new file and the report."""
    folder.mkdir()
    target = folder / source.name
    wanted = settings.from_values({"rebake": "auto", "picture_size": 0, "texture_size": 512, **values})
    report = task.run(task.Request(source.name, str(source), str(folder), str(target), wanted.as_json()))
    assert report["status"] == ("kept" if values.get("unwrap") is False else "unwrapped"), report
    return target, report


def differences(before, after):
    """Return the absolute differences of two pictures of the same surface where it is."""
    (old, old_covered), (new, new_covered) = made.render(before), made.render(after)
    assert (old_covered == new_covered).all()
    assert old_covered.mean() > 0.1
    return np.abs(old - new)[old_covered]


def assert_same(before, after):
    found = differences(before, after)
    assert found.mean(axis=0).max() < 1
    assert np.percentile(found, 99.9) < 8


def full_sphere(uri=None, with_tangents=False, kind="PNG"):
    """Color, roughness with metal and occlusion in one image, normals and emission."""
    asset = made.Textured()
    color = asset.texture(made.encoded(made.painted(256, 384, 3, 1), kind), uri and f"{uri}color.{kind.lower()}")
    data = asset.texture(made.encoded(made.painted(128, 192, 3, 2)), uri and f"{uri}data.png")
    normal = asset.texture(made.encoded(made.bumps(256, 384, 3)), uri and f"{uri}bumps.png")
    glow = asset.texture(made.encoded(made.painted(64, 96, 3, 4)), uri and f"{uri}glow.png")
    material = asset.material(
        name="all",
        pbrMetallicRoughness={"baseColorTexture": {"index": color}, "metallicRoughnessTexture": {"index": data}},
        occlusionTexture={"index": data, "strength": 0.5},
        normalTexture={"index": normal},
        emissiveTexture={"index": glow},
    )
    asset.add(made.sphere(), material, with_tangents=with_tangents)
    return asset


@pytest.mark.parametrize("with_tangents", [False, True])
def test_a_sphere_with_all_textures_looks_the_same(with_tangents, tmp_path):
    source = full_sphere(with_tangents=with_tangents).save(tmp_path / "a.glb")
    target, report = unwrapped(source, tmp_path / "out")
    assert_same(source, target)
    assert len(report["textures"]) == 4
    document, _, _ = load(target)
    assert len(document["images"]) == 4
    assert made.TRANSFORM not in json.dumps(document)
    # Without new textures it looks different.
    plain, _ = unwrapped(source, tmp_path / "plain", rebake="none")
    assert differences(source, plain).mean() > 10


def test_fewer_islands_look_the_same(tmp_path):
    """The six islands of the map, joined where distortion allows."""
    source = full_sphere().save(tmp_path / "a.glb")
    target, report = unwrapped(source, tmp_path / "out", seams="merge", qc_limit=1.03)
    assert_same(source, target)
    assert len(report["islands"]) < 4
    # The limit, and what the angles around this coarse sphere's vertices do to every map.
    assert report["totals"]["qc_mean"] < 1.03 + 0.01
    assert report["totals"]["overlaps"] == 0


def test_the_command_draws_textures_too(tmp_path):
    source, target = full_sphere().save(tmp_path / "a.glb"), tmp_path / "new.glb"
    assert main([str(source), "--out", str(target), "--rebake", "--texture-size", "512"]) == 0
    assert_same(source, target)


def test_files_beside_and_in_the_text_stay_where_they_were(tmp_path):
    asset = full_sphere("my%20", kind="JPEG")
    asset.texture(made.encoded(made.smooth(64, 64, 3, 9)), "data")
    source = asset.save(tmp_path / "a.gltf", "separate")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    target, report = unwrapped(source, tmp_path / "out")
    assert_same(source, target)
    names = {"a_my color.jpg", "a_my data.png", "a_my bumps.png", "a_my glow.png"}
    assert names <= {path.name for path in target.parent.iterdir()}
    assert not (target.parent / "my color.jpeg").exists()
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()} == before
    assert images.suffix_of((target.parent / "a_my color.jpg").read_bytes()) == ".jpg"


def test_repeated_and_transformed_textures_of_one_image_look_the_same(tmp_path):
    """Three materials read one image, each from another place; one with opacity."""
    asset = made.Textured()
    picture = made.smooth(128, 128, 4, 5)
    texture = asset.texture(made.encoded(picture))
    change = {"offset": [0.3, -0.2], "rotation": 0.7, "scale": [1.5, 0.8]}
    infos = [{"index": texture}, {"index": texture, "extensions": {made.TRANSFORM: change}}, {"index": texture}]
    modes = [{}, {}, {"alphaMode": "BLEND"}]
    for k, (info, mode) in enumerate(zip(infos, modes)):
        material = asset.material(pbrMetallicRoughness={"baseColorTexture": info}, **mode)
        asset.add(made.moved(made.box(2.0), (1.6 * k, 0, 0)), material)
    source = asset.save(tmp_path / "a.glb")
    target, report = unwrapped(source, tmp_path / "out", texture_size=1024, seams="keep")
    assert_same(source, target)
    document, _, _ = load(target)
    assert len(document["images"]) == len(document["textures"]) == 3


def test_the_set_of_a_transform_counts(tmp_path):
    """The reference's own is for readers that do not know the extension."""
    asset, sphere = made.Textured(), made.sphere()
    pictures = [asset.texture(made.encoded(made.painted(128, 192, 3, seed))) for seed in (1, 2)]
    color = {"index": pictures[0], "texCoord": 1, "extensions": {made.TRANSFORM: {"texCoord": 0}}}
    glow = {"index": pictures[1], "extensions": {made.TRANSFORM: {"texCoord": 1}}}
    material = asset.material(pbrMetallicRoughness={"baseColorTexture": color}, emissiveTexture=glow)
    asset.add(sphere, material, more_uv=[sphere[2]])
    source = asset.save(tmp_path / "a.glb")
    target, report = unwrapped(source, tmp_path / "out")
    assert_same(source, target)
    assert [each["name"] for each in report["textures"]] == ["picture 0"]
    assert load(target)[0]["materials"][0] == {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 0}},
        "emissiveTexture": glow,
    }


def test_another_set_is_drawn_alone(tmp_path):
    asset = made.Textured()
    first, second = (asset.texture(made.encoded(made.painted(128, 192, 3, seed))) for seed in (6, 7))
    material = asset.material(
        pbrMetallicRoughness={"baseColorTexture": {"index": first}}, emissiveTexture={"index": second, "texCoord": 1}
    )
    mesh = made.sphere()
    asset.add(mesh, material, more_uv=(mesh[2] + (1, -2),))
    source = asset.save(tmp_path / "a.glb")
    target, report = unwrapped(source, tmp_path / "out", uv_map="1")
    assert_same(source, target)
    assert [each["name"] for each in report["textures"]] == ["picture 1"]


def test_a_kept_map_is_packed_with_its_textures(tmp_path):
    source = full_sphere().save(tmp_path / "a.glb")
    target, _ = unwrapped(source, tmp_path / "out", unwrap=False)
    assert_same(source, target)


def test_16_bits_stay(tmp_path):
    pixels = (257 * made.smooth(128, 128, 3, 8).astype(np.uint16)) ^ np.uint16(5)
    content = images.written(pixels, ".png")
    assert (images.read(content) == pixels).all()
    asset = made.Textured()
    asset.add(made.sphere(), asset.material(occlusionTexture={"index": asset.texture(content)}))
    target, _ = unwrapped(asset.save(tmp_path / "a.glb"), tmp_path / "out")
    document, buffers, _ = load(target)
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    new = images.read(buffers[0][view["byteOffset"] :][: view["byteLength"]])
    assert new.dtype == np.uint16
    assert len(np.unique(new % 256)) > 200


def test_the_size_follows_the_density(tmp_path):
    asset = made.Textured()
    # Four by four repetitions of 256 texels on each of six faces.
    texture = asset.texture(made.encoded(made.smooth(256, 256, 3, 1)))
    asset.add(made.box(4.0), asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}}))
    source = asset.save(tmp_path / "a.glb")
    for rebake, side in (("auto", 4096), ("same", 256), ("300", 300), ("512x256", (512, 256))):
        target, report = unwrapped(source, tmp_path / f"out {rebake}", rebake=rebake)
        (drawn,) = report["textures"]
        assert (drawn["width"], drawn["height"]) == (side if isinstance(side, tuple) else (side, side))
        assert 0.3 < drawn["covered"] < 1
        is_lossy = any("times fewer texels per length" in each for each in report["warnings"])
        assert is_lossy == (rebake != "auto")


def test_what_cannot_be_drawn_is_said(tmp_path):
    asset = full_sphere("my%20")
    asset.texture(b"\x89PNG broken")
    for key, content in (("data", b"KTX 20"), ("bumps", b"\x89PNG\r\n\x1a\n broken")):
        asset.files[f"my {key}.png"] = content
    asset.files.pop("my glow.png")
    source = asset.save(tmp_path / "a.gltf", "separate")
    target, report = unwrapped(source, tmp_path / "out")
    said = " ".join(report["warnings"])
    assert "The texture my glow.png was not drawn anew and does not fit the new map: its image is missing." in said
    assert "The texture my data.png was not drawn anew and does not fit the new map: only PNG, JPEG and WebP" in said
    assert "The texture my bumps.png was not drawn anew and does not fit the new map: " in said
    assert [each["name"] for each in report["textures"]] == ["my color.png"]


def test_lines_that_share_a_material_are_named(tmp_path):
    """Their map stays, and the material can read one image only."""
    asset = full_sphere()
    asset.add(made.sphere(), asset.primitives[0]["material"])
    asset.primitives[1]["mode"] = 1
    _, report = unwrapped(asset.save(tmp_path / "a.glb"), tmp_path / "out")
    assert [each for each in report["warnings"] if "kept the old map, which the new textures do not fit" in each]


def test_formats_whose_textures_stay_are_named(tmp_path):
    source = tmp_path / "a.ply"
    batch_assets.write_ply(source, *batch_assets.grid(3, 0.1, 1))
    said = "Textures of .ply files are not drawn anew: they do not fit the new map."
    assert said not in unwrapped(source, tmp_path / "plain")[1]["warnings"]
    source.write_bytes(source.read_bytes().replace(b"ply\n", b"ply\ncomment TextureFile a.png\n", 1))
    assert said in unwrapped(source, tmp_path / "out")[1]["warnings"]
    # Formats without textures.
    (tmp_path / "a.off").write_text("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    asset, size = assets.read(tmp_path / "a.off"), assets.TextureSize("auto", (64, 64))
    found = [assets.UvMap(asset.meshes[0].vertices[:, :2], np.ones(1, bool))]
    assert assets.write(tmp_path / "a.obj", asset, found, size)[1] == []


def test_a_file_without_textures_is_written_as_ever(tmp_path):
    asset = made.Textured()
    asset.add(made.sphere(), asset.material())
    source = asset.save(tmp_path / "a.glb")
    new = [unwrapped(source, tmp_path / rebake, rebake=rebake)[0].read_bytes() for rebake in ("auto", "none")]
    assert new[0] == new[1]


def test_a_python_without_the_library_is_told_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "OpenImageIO", None)
    asset = assets.read(full_sphere().save(tmp_path / "a.glb"))
    maps = [assets.UvMap(np.nan_to_num(mesh.corner_uv), mesh.has_uv()) for mesh in asset.meshes]
    _, said = assets.write(tmp_path / "b.glb", asset, maps, assets.TextureSize("same", (64, 64)))
    assert any('pip install "spectral_conformal[batch]"' in each for each in said)
