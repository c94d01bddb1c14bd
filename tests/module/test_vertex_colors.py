# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex colors of files, drawn to a texture."""

import zipfile

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.assets import images

from tests.module import batch_assets
from tests.module import textured_assets as made
from tests.module.test_gltf import corners_of, load, values
from tests.module.test_gltf_textures import unwrapped
from tests.module.test_rebake import at, places, shown

# Of 255: rounding of colors and of texels, and the margin of interpolated colors between two islands.
SAME = 1.0


def painted_sphere(n=16):
    """Positions, normals, UVs and triangles, and a smooth color (rows, 3) for each row, equal where rows meet."""
    positions, normals, uv, triangles = made.sphere(n)
    return positions, normals, uv, triangles, 0.5 + 0.4 * np.sin(3.0 * positions[:, [1, 2, 0]])


def linear(coded):
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def colors_at(path, triangles, picture):
    """Return what the picture shows at random points of the surface, and (triangle, weights) of these."""
    (mesh,) = assets.read(path).meshes
    where = places(triangles, 20000)
    by_corner = np.arange(triangles.size).reshape(-1, 3)
    return shown(picture, at(mesh.corner_uv, by_corner, where))[:, :3], where


def write_gltf(path, how, kind="f4", width=3, alpha="OPAQUE", **parts):
    asset = made.Textured()
    positions, normals, _, triangles, colors = painted_sphere()
    number = asset.material(alphaMode=alpha, **parts)
    asset.add((positions, normals, np.zeros((len(positions), 2)), triangles), number)
    attributes = asset.primitives[0]["attributes"]
    stored = np.c_[colors, np.full((len(colors), width - 3), 0.5)]
    if kind != "f4":
        stored = np.rint(stored * np.iinfo(kind).max)
    more = {} if kind == "f4" else {"normalized": True}
    attributes["COLOR_0"] = asset.build.accessor(stored, kind, **more)
    del attributes["TEXCOORD_0"]
    return asset.save(path, how), triangles, colors


def content_of(image, document, buffers):
    """Return the content of an image that is stored in the first buffer."""
    view = document["bufferViews"][image["bufferView"]]
    return buffers[0][view["byteOffset"] :][: view["byteLength"]]


def base_color(document, primitive):
    info = document["materials"][primitive["material"]]["pbrMetallicRoughness"]["baseColorTexture"]
    return info, document["images"][document["textures"][info["index"]]["source"]]


@pytest.mark.parametrize("how", ["glb", "separate", "embedded"])
@pytest.mark.parametrize("kind", ["f4", "u1", "u2"])
def test_colors_of_gltf_become_the_base_color(kind, how, tmp_path):
    source, triangles, colors = write_gltf(
        tmp_path / f"a.{'glb' if how == 'glb' else 'gltf'}", how, kind, pbrMetallicRoughness={"roughnessFactor": 0.3}
    )
    target, report = unwrapped(source, tmp_path / "out", rebake="none", rebake_colors=True)
    document, buffers, _ = load(target)
    (primitive,) = document["meshes"][0]["primitives"]
    assert {"_COLOR_0", "TEXCOORD_0"} <= primitive["attributes"].keys()
    assert "COLOR_0" not in primitive["attributes"]
    info, image = base_color(document, primitive)
    assert info["texCoord"] == 0
    assert document["materials"][primitive["material"]]["pbrMetallicRoughness"]["roughnessFactor"] == 0.3
    picture = images.read(content_of(image, document, buffers))
    assert picture.shape == (512, 512, 3)
    found, where = colors_at(target, triangles, picture)
    expected = at(colors, triangles, where)
    assert np.abs(255 * (linear(found / 255) - expected)).mean() < SAME
    (drawn,) = report["textures"]
    assert (drawn["name"], drawn["width"]) == ("vertex_colors", 512)
    # The colors themselves are still there.
    assert len(values(document, buffers, primitive["attributes"]["_COLOR_0"])) >= len(colors)
    assert len(corners_of(document, buffers, primitive)) == triangles.size


def test_opacity_of_colors_counts_where_the_material_blends(tmp_path):
    for alpha, channels in (("OPAQUE", 3), ("BLEND", 4)):
        source, triangles, _ = write_gltf(tmp_path / f"{alpha}.glb", "glb", width=4, alpha=alpha)
        target, _ = unwrapped(source, tmp_path / alpha, rebake_colors=True)
        document, buffers, _ = load(target)
        _, image = base_color(document, document["meshes"][0]["primitives"][0])
        picture = images.read(content_of(image, document, buffers))
        assert picture.shape[2] == channels
        if channels == 4:
            assert (picture[:, :, 3] == 128).all()


def test_only_primitives_without_a_texture_are_colored(tmp_path):
    """Three of one material: with colors, without, and with colors beside a texture."""
    asset = made.Textured()
    positions, normals, uv, triangles, colors = painted_sphere(6)
    plain = asset.material()
    texture = asset.texture(made.encoded(made.painted(64, 96, 3, 1)))
    textured = asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}})
    for offset, material, has_colors in ((0.0, plain, True), (3.0, plain, False), (6.0, textured, True)):
        asset.add(made.moved((positions, normals, uv, triangles), (offset, 0.0, 0.0)), material)
        if has_colors:
            asset.primitives[-1]["attributes"]["COLOR_0"] = asset.build.accessor(colors)
    source = asset.save(tmp_path / "a.glb")
    target, report = unwrapped(source, tmp_path / "out", rebake_colors=True)
    document, _, _ = load(target)
    first, second, third = document["meshes"][0]["primitives"]
    assert second["material"] == plain
    assert "pbrMetallicRoughness" not in document["materials"][plain]
    assert first["material"] not in (plain, textured)
    assert third["material"] == textured
    assert "COLOR_0" in third["attributes"]
    assert len(report["textures"]) == 2


def write_obj(path, library=""):
    positions, _, _, triangles, colors = painted_sphere()
    rows = np.c_[positions, colors]
    text = ["mtllib own.mtl"] if library else []
    text += ["v " + " ".join(f"{value:.6f}" for value in row) for row in rows]
    text += ["usemtl skin"] if library else []
    text += ["f {} {} {}".format(*each) for each in triangles + 1]
    path.write_text("\n".join(text) + "\n")
    if library:
        (path.parent / "own.mtl").write_text(library)
    return triangles, colors


@pytest.mark.parametrize("library", ["", "newmtl skin\nKd 1 1 1\nnewmtl other\nmap_Kd x.png\n"])
def test_colors_of_an_obj_become_its_texture(library, tmp_path):
    triangles, colors = write_obj(tmp_path / "a.obj", library)
    target, report = unwrapped(tmp_path / "a.obj", tmp_path / "out", rebake="none", rebake_colors=True)
    picture = images.read((target.parent / "a_vertex_colors.png").read_bytes())
    found, where = colors_at(target, triangles, picture)
    assert np.abs(found - 255 * at(colors, triangles, where)).mean() < SAME
    name = "a_own.mtl" if library else "a_vertex_colors.mtl"
    assert f"mtllib {name}\n" in target.read_text()
    written = (target.parent / name).read_text()
    assert "map_Kd a_vertex_colors.png\n" in written.partition("newmtl other")[0]
    assert "a_vertex" not in written.partition("newmtl other")[2]
    assert [each["name"] for each in report["textures"]] == ["vertex_colors"]
    # It has a texture now, which is drawn anew.
    again, report = unwrapped(target, tmp_path / "again", rebake_colors=True, seams="keep")
    assert [each["name"] for each in report["textures"]][0] == "a_vertex_colors.png"
    assert "map_Kd a_a_vertex_colors.png\n" in (again.parent / f"a_{name}").read_text()


@pytest.mark.parametrize("text", [False, True])
def test_colors_of_a_ply_become_the_texture_that_meshlab_reads(text, tmp_path):
    positions, _, _, triangles, colors = painted_sphere()
    coded = np.rint(255 * colors).astype("u1")
    head = ["ply", f"format {'ascii' if text else 'binary_little_endian'} 1.0", f"element vertex {len(positions)}"]
    head += [f"property float {axis}" for axis in "xyz"] + [
        f"property uchar {name}" for name in ("red", "green", "blue")
    ]
    head += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header\n"]
    if text:
        rows = [f"{x:.6f} {y:.6f} {z:.6f} {r} {g} {b}" for (x, y, z), (r, g, b) in zip(positions, coded)]
        body = "\n".join([*rows, *("3 {} {} {}".format(*each) for each in triangles)]).encode() + b"\n"
    else:
        vertices = np.zeros(len(positions), [("p", "<f4", 3), ("c", "u1", 3)])
        vertices["p"], vertices["c"] = positions, coded
        faces = np.zeros(len(triangles), [("n", "u1"), ("v", "<i4", 3)])
        faces["n"], faces["v"] = 3, triangles
        body = vertices.tobytes() + faces.tobytes()
    source = tmp_path / "a.ply"
    source.write_bytes("\n".join(head).encode() + body)
    target, report = unwrapped(source, tmp_path / "out", rebake="none", rebake_colors=True)
    assert b"\ncomment TextureFile a_vertex_colors.png\n" in target.read_bytes()
    picture = images.read((target.parent / "a_vertex_colors.png").read_bytes())
    found, where = colors_at(target, triangles, picture)
    assert np.abs(found - at(coded.astype(float), triangles, where)).mean() < SAME
    assert report["warnings"] == []
    assert [each["name"] for each in report["textures"]] == ["vertex_colors"]


def test_the_texture_holds_what_the_vertices_do(tmp_path):
    """Doubled by the rule auto: two texels for every vertex, in either direction."""
    write_obj(tmp_path / "a.obj")
    (small,) = unwrapped(tmp_path / "a.obj", tmp_path / "s", rebake="64", rebake_colors=True)[1]["textures"]
    (fitting,) = unwrapped(tmp_path / "a.obj", tmp_path / "f", texture_size=64, rebake_colors=True)[1]["textures"]
    assert small["width"] == 64
    number = 6 * 16**2
    assert fitting["covered"] * fitting["width"] ** 2 > 4 * number > fitting["covered"] * fitting["width"] ** 2 / 8


def test_without_the_option_colors_stay(tmp_path):
    source, _, _ = write_gltf(tmp_path / "a.glb", "glb")
    target, report = unwrapped(source, tmp_path / "out")
    assert "COLOR_0" in load(target)[0]["meshes"][0]["primitives"][0]["attributes"]
    assert report["textures"] == []


def write_usd(path, by, material=False):
    """Write a sphere without UVs, whose display colors stand at its points, corners or faces."""
    from pxr import Sdf, Usd, UsdGeom, UsdShade

    positions, _, _, triangles, colors = painted_sphere()
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.Xform.Define(stage, "/World")
    mesh = UsdGeom.Mesh.Define(stage, "/World/Ball")
    mesh.CreatePointsAttr(positions.astype("f4"))
    mesh.CreateFaceVertexCountsAttr(np.full(len(triangles), 3, "i4"))
    mesh.CreateFaceVertexIndicesAttr(triangles.ravel().astype("i4"))
    by_corner = colors[triangles]
    if by == "uniform":
        by_corner = np.repeat(by_corner.mean(axis=1, keepdims=True), 3, axis=1)
    stored = {"vertex": colors, "faceVarying": by_corner.reshape(-1, 3), "uniform": by_corner[:, 0]}[by]
    mesh.CreateDisplayColorPrimvar(by).Set(stored.astype("f4"))
    if material:
        skin = UsdShade.Material.Define(stage, "/World/Skin")
        surface = UsdShade.Shader.Define(stage, "/World/Skin/Surface")
        surface.CreateIdAttr("UsdPreviewSurface")
        surface.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(0.3)
        reader = UsdShade.Shader.Define(stage, "/World/Skin/Colors")
        reader.CreateIdAttr("UsdPrimvarReader_float3")
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("displayColor")
        color = surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
        color.ConnectToSource(reader.ConnectableAPI(), "result")
        skin.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(skin)
    stage.SetDefaultPrim(stage.GetPrimAtPath("/World"))
    stage.Save()
    return triangles, by_corner.reshape(-1, 3)


@pytest.mark.parametrize("name", ["a.usda", "a.usdc", "a.usdz"])
@pytest.mark.parametrize(
    ("by", "material"), [("vertex", False), ("faceVarying", False), ("uniform", False), ("vertex", True)]
)
def test_colors_of_a_usd_become_its_texture(by, material, name, tmp_path):
    pytest.importorskip("pxr")
    from pxr import Usd, UsdShade, UsdUtils

    source = tmp_path / name
    triangles, colors = write_usd(source.with_suffix(".usdc" if name.endswith("z") else source.suffix), by, material)
    if name.endswith("z"):
        UsdUtils.CreateNewUsdzPackage(str(source.with_suffix(".usdc")), str(source))
    target, report = unwrapped(source, tmp_path / "out", rebake="none", rebake_colors=True, texture_size=1024)
    assert [each["name"] for each in report["textures"]] == ["vertex_colors"]
    stage = Usd.Stage.Open(str(target))
    mesh = stage.GetPrimAtPath("/World/Ball")
    bound = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()[0]
    assert str(bound.GetPath()) == ("/World/Skin" if material else "/World/vertex_colors")
    surface = bound.ComputeSurfaceSource()[0]
    texture = surface.GetInput("diffuseColor").GetConnectedSources()[0][0].source
    assert texture.GetPrim().GetAttribute("info:id").Get() == "UsdUVTexture"
    reader = texture.GetInput("st").GetConnectedSources()[0][0].source
    assert reader.GetInput("varname").Get() == "st"
    path = texture.GetInput("file").Get().resolvedPath
    if name.endswith("z"):
        with zipfile.ZipFile(target) as package:
            content = package.read(path.partition("[")[2].rstrip("]"))
    else:
        content = (tmp_path / "out" / "a_vertex_colors.png").read_bytes()
        assert path == str(tmp_path / "out" / "a_vertex_colors.png")
    found, where = colors_at(target, triangles, images.read(content))
    number, weights = where
    expected = np.einsum("nk,nkd->nd", weights, colors.reshape(-1, 3, 3)[number])
    assert np.abs(255 * (linear(found / 255) - expected)).mean() < (2 * SAME if by == "uniform" else SAME)
    # They are still there.
    assert mesh.GetAttribute("primvars:displayColor").HasValue()


def test_the_same_color_everywhere_needs_no_texture(tmp_path):
    pytest.importorskip("pxr")
    batch_assets.write_usd(tmp_path / "a.usda", *batch_assets.grid(5, 0.3, 2))
    text = (tmp_path / "a.usda").read_text()
    (tmp_path / "a.usda").write_text(
        text[: text.rindex("}")] + "    color3f[] primvars:displayColor = [(1, 0, 0)]\n}\n"
    )
    _, report = unwrapped(tmp_path / "a.usda", tmp_path / "out", rebake_colors=True)
    assert report["textures"] == []
