# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of USD files, drawn anew beside the file or in its package."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import assets
from spectral_conformal.assets import images

from tests.module import textured_assets as made
from tests.module.test_gltf_textures import unwrapped
from tests.module.test_rebake import at, in_space, places, shown

pxr = pytest.importorskip("pxr")
Gf, Sdf, Usd, UsdGeom, UsdShade, UsdUtils, Vt = (
    getattr(__import__(f"pxr.{name}"), name) for name in ("Gf", "Sdf", "Usd", "UsdGeom", "UsdShade", "UsdUtils", "Vt")
)

PICTURES = {"color.png": (256, 3, 1), "rough.png": (128, 1, 2)}


def write_sphere(path, scale=(1.0, 1.0), offset=(0.0, 0.0), wrap="repeat", orientation="rightHanded", subset=False):
    """Write a sphere with color, roughness and normals; return its triangles and old UVs, v upward."""
    positions, normals, uv, triangles = made.sphere(8)
    uv = uv * (1, -1) + (0, 1)
    for name, (side, channels, seed) in PICTURES.items():
        (path.parent / name).write_bytes(made.encoded(made.painted(side, side * 3 // 2, channels, seed).squeeze()))
    (path.parent / "bumps.png").write_bytes(made.encoded(made.bumps(256, 384, 3)))
    stage = Usd.Stage.CreateNew(str(path))
    mesh = UsdGeom.Mesh.Define(stage, "/World/Ball")
    wound = triangles if orientation == "rightHanded" else triangles[:, ::-1]
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(positions.astype("f4")))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(triangles), 3, "i4")))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(wound.ravel().astype("i4")))
    mesh.CreateOrientationAttr(orientation)
    mesh.CreateSubdivisionSchemeAttr("none")
    mesh.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(normals.astype("f4")))
    mesh.SetNormalsInterpolation("vertex")
    variable = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "vertex")
    variable.Set(Vt.Vec2fArray.FromNumpy(uv.astype("f4")))
    material = UsdShade.Material.Define(stage, "/World/Skin")
    surface = UsdShade.Shader.Define(stage, "/World/Skin/Surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    reader = UsdShade.Shader.Define(stage, "/World/Skin/Reader")
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    name = material.CreateInput("frame:st", Sdf.ValueTypeNames.String)
    name.Set("st")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).ConnectToSource(name)
    moved = reader
    if scale != (1.0, 1.0):
        moved = UsdShade.Shader.Define(stage, "/World/Skin/Moved")
        moved.CreateIdAttr("UsdTransform2d")
        moved.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
        moved.CreateInput("scale", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(*scale))
        moved.CreateInput("translation", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(*offset))
    for key, file, place, output, kind in (
        ("diffuseColor", "color.png", moved, "rgb", Sdf.ValueTypeNames.Color3f),
        ("roughness", "rough.png", reader, "r", Sdf.ValueTypeNames.Float),
        ("normal", "bumps.png", reader, "rgb", Sdf.ValueTypeNames.Normal3f),
    ):
        texture = UsdShade.Shader.Define(stage, f"/World/Skin/{key}")
        texture.CreateIdAttr("UsdUVTexture")
        texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath(f"./{file}"))
        texture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(place.ConnectableAPI(), "result")
        for side in ("wrapS", "wrapT"):
            texture.CreateInput(side, Sdf.ValueTypeNames.Token).Set(wrap)
        texture.CreateOutput(output, Sdf.ValueTypeNames.Float3 if output == "rgb" else Sdf.ValueTypeNames.Float)
        surface.CreateInput(key, kind).ConnectToSource(texture.ConnectableAPI(), output)
    if subset:
        part = UsdGeom.Subset.Define(stage, "/World/Ball/Part")
        part.CreateIndicesAttr(Vt.IntArray.FromNumpy(np.arange(len(triangles), dtype="i4")))
        part.CreateElementTypeAttr("face")
        part.CreateFamilyNameAttr("materialBind")
        UsdShade.MaterialBindingAPI.Apply(part.GetPrim()).Bind(material)
    else:
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    stage.SetDefaultPrim(stage.GetPrimAtPath("/World"))
    stage.Save()
    return triangles, uv


def files_of(path):
    """Return the path of the image of each texture, and whether it reads the primvar itself."""
    stage = Usd.Stage.Open(str(path))
    found = {}
    for key in ("diffuseColor", "roughness", "normal"):
        shader = UsdShade.Shader(stage.GetPrimAtPath(f"/World/Skin/{key}"))
        file = shader.GetInput("file").Get()
        source = shader.GetInput("st").GetConnectedSources()[0][0].source.GetPrim().GetName()
        found[key] = (file.resolvedPath, source)
    return found


def read(path):
    if "[" in path:
        package, _, name = path.rstrip("]").partition("[")
        with zipfile.ZipFile(package) as content:
            return images.read(content.read(name), ".png")
    return images.read(Path(path).read_bytes())


def difference(source_uv, old, new_uv, new, triangles, old_places=lambda uv: uv):
    """Return the mean difference of colors at points of the surface, of 255."""
    where = places(triangles, 20000)
    before = shown(old, old_places(at(source_uv, triangles, where)))
    by_corner = np.arange(triangles.size).reshape(-1, 3)
    return np.abs(before - shown(new, at(new_uv, by_corner, where))).mean(axis=0)


@pytest.mark.parametrize("kind", [".usda", ".usdc", ".usdz"])
@pytest.mark.parametrize("changes", [{}, {"subset": True}, {"orientation": "leftHanded"}], ids=str)
def test_a_sphere_shows_the_same(changes, kind, tmp_path):
    source = tmp_path / f"a{'.usda' if kind == '.usdz' else kind}"
    triangles, uv = write_sphere(source, **changes)
    if kind == ".usdz":
        source = tmp_path / "a.usdz"
        assert UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(tmp_path / "a.usda")), str(source))
    old = {key: read(path) for key, (path, _) in files_of(source).items()}
    target, report = unwrapped(source, tmp_path / "out")
    assert {each["name"] for each in report["textures"]} == {"color.png", "rough.png", "bumps.png"}
    assert report["warnings"] == []
    (mesh,) = assets.read(target).meshes
    new = {key: read(path) for key, (path, _) in files_of(target).items()}
    for key in ("diffuseColor", "roughness"):
        assert difference(uv, old[key], mesh.corner_uv, new[key], triangles).max() < 1
    turned = difference(uv, old["normal"], mesh.corner_uv, new["normal"], triangles)
    # Turned in the surface, normals lean as far.
    assert turned[:2].min() > 5
    assert turned[2] < 1
    assert all(source == "Reader" for _, source in files_of(target).values())
    if kind != ".usdz":
        assert (target.parent / "a_color.png").is_file()


def test_a_repeated_texture_is_drawn_as_it_was_seen(tmp_path):
    triangles, uv = write_sphere(tmp_path / "a.usda", scale=(2.0, 3.0))
    target, _ = unwrapped(tmp_path / "a.usda", tmp_path / "out", texture_size=1024)
    (mesh,) = assets.read(target).meshes
    path, source = files_of(target)["diffuseColor"]
    assert source == "Reader"
    old = read(str(tmp_path / "color.png"))
    assert difference(uv, old, mesh.corner_uv, read(path), triangles, lambda each: each * (2, 3)).max() < 2


@pytest.mark.parametrize(("scale", "read"), [((1.0, 1.0), "st"), ((2.0, 3.0), "st"), ((2.0, 3.0), "other")])
def test_a_texture_that_its_material_moves_is_named(scale, read, tmp_path):
    write_sphere(tmp_path / "a.usda", scale=scale)
    text = (tmp_path / "a.usda").read_text().replace('frame:st = "st"', f'frame:st = "{read}"')
    (tmp_path / "a.usda").write_text(text)
    asset = assets.read(tmp_path / "a.usda", "st")
    (mesh,) = asset.meshes
    assets.write(tmp_path / "n.usda", asset, [assets.UvMap(mesh.corner_uv, np.ones(len(mesh.face_offsets) - 1, bool))])
    is_moved = scale != (1.0, 1.0) and read == "st"
    assert asset.warnings == ["Materials scale, turn or move textures of the map, which was left."] * is_moved


@pytest.mark.parametrize(("wrap", "beyond"), [("clamp", 20), ("black", 0)])
def test_a_decal_does_not_continue(wrap, beyond, tmp_path):
    """The image lies in the middle of the map."""
    triangles, uv = write_sphere(tmp_path / "a.usda", scale=(3.0, 3.0), offset=(-1.0, -1.0), wrap=wrap)
    target, _ = unwrapped(tmp_path / "a.usda", tmp_path / "out", texture_size=1024)
    (mesh,) = assets.read(target).meshes
    where = places(triangles, 20000)
    read_at = 3.0 * at(uv, triangles, where) - 1.0
    by_corner = np.arange(triangles.size).reshape(-1, 3)
    found = shown(read(files_of(target)["diffuseColor"][0]), at(mesh.corner_uv, by_corner, where))
    outside = ((read_at < -0.05) | (read_at > 1.05)).any(axis=1)
    assert (found[outside].mean() > beyond) if beyond else not found[outside].any()
    inside = ((read_at > 0.05) & (read_at < 0.95)).all(axis=1)
    before = shown(read(str(tmp_path / "color.png")), read_at)
    assert np.abs(before - found)[inside].mean() < 3


@pytest.mark.parametrize(
    ("scale", "modes", "like"),
    [
        (1.0, None, None),
        (3.0, None, "repeat"),
        (3.0, "black", "black"),
        (3.0, "periodic", "repeat"),
        (3.0, "mirror,mirror", "mirror"),
    ],
)
def test_the_file_of_a_texture_may_say_how_it_continues(scale, modes, like, tmp_path):
    """By default. Without either, programs differ."""
    found, oiio = {}, pytest.importorskip("OpenImageIO")
    for wrap in ("useMetadata", like or "repeat"):
        folder = tmp_path / wrap
        folder.mkdir()
        write_sphere(folder / "a.usda", scale=(scale, scale), offset=(0.2, 0.1) if scale > 1.0 else (0, 0), wrap=wrap)
        pixels = images.read((folder / "color.png").read_bytes())
        picture = oiio.ImageOutput.create(str(folder / "color.tif"))
        kind = oiio.ImageSpec(*pixels.shape[1::-1], 3, "uint8")
        if modes:
            kind.attribute("wrapmodes", modes)
        assert picture.open(str(folder / "color.tif"), kind)
        assert picture.write_image(pixels)
        picture.close()
        (folder / "a.usda").write_text((folder / "a.usda").read_text().replace("color.png", "color.tif"))
        target, report = unwrapped(folder / "a.usda", folder / "out")
        found[wrap] = read(files_of(target)["diffuseColor"][0])
        said = "The texture color.tif has no wrap mode, so programs differ beyond it: it was drawn as repeated."
        is_unclear = wrap == "useMetadata" and scale > 1.0 and modes is None
        assert report["warnings"] == [said] * is_unclear
    assert len({each.tobytes() for each in found.values()}) == 1


def test_a_texture_may_be_moved_twice(tmp_path):
    triangles, uv = write_sphere(tmp_path / "a.usda", scale=(2.0, 3.0), offset=(0.25, 0.5))
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    again = UsdShade.Shader.Define(stage, "/World/Skin/Again")
    again.CreateIdAttr("UsdTransform2d")
    first = UsdShade.Shader(stage.GetPrimAtPath("/World/Skin/Moved"))
    again.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(first.ConnectableAPI(), "result")
    again.CreateInput("rotation", Sdf.ValueTypeNames.Float).Set(90.0)
    again.CreateInput("translation", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(0.1, 0.0))
    texture = UsdShade.Shader(stage.GetPrimAtPath("/World/Skin/diffuseColor"))
    texture.GetInput("st").ConnectToSource(again.ConnectableAPI(), "result")
    stage.Save()
    target, report = unwrapped(tmp_path / "a.usda", tmp_path / "out", texture_size=1024)
    assert report["warnings"] == []
    (mesh,) = assets.read(target).meshes
    path, source = files_of(target)["diffuseColor"]
    assert source == "Reader"

    def moved(each):
        u, v = (each * (2.0, 3.0) + (0.25, 0.5)).T
        return np.c_[0.1 - v, u]

    old = read(str(tmp_path / "color.png"))
    assert difference(uv, old, mesh.corner_uv, read(path), triangles, moved).max() < 2


def test_a_transform_that_moves_itself_ends(tmp_path):
    write_sphere(tmp_path / "a.usda", scale=(2.0, 3.0))
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    moved = UsdShade.Shader(stage.GetPrimAtPath("/World/Skin/Moved"))
    moved.GetInput("in").ConnectToSource(moved.ConnectableAPI(), "result")
    stage.Save()
    _, report = unwrapped(tmp_path / "a.usda", tmp_path / "out")
    assert "color.png was not drawn anew and does not fit the new map: what places it is no primvar." in " ".join(
        report["warnings"]
    )


def test_a_layer_over_the_file_names_the_new_textures(tmp_path):
    triangles, uv = write_sphere(tmp_path / "a.usda")
    before = (tmp_path / "a.usda").read_bytes()
    folder = tmp_path / "out"
    asset = assets.usd.UsdAsset(tmp_path / "a.usda", over=True)
    folder.mkdir()
    (mesh,) = asset.meshes
    moved = assets.UvMap(0.5 * np.nan_to_num(mesh.corner_uv) + 0.1, mesh.has_uv())
    assets.write(folder / "a.usda", asset, [moved], assets.TextureSize("same", (64, 64)))
    assert (tmp_path / "a.usda").read_bytes() == before
    path, _ = files_of(folder / "a.usda")["diffuseColor"]
    assert path == str(folder / "a_color.png")
    assert difference(uv, read(str(tmp_path / "color.png")), moved.uv, read(path), triangles).max() < 3


def test_a_proxy_that_shares_a_material_is_named(tmp_path):
    """Its map stays, and the material can read one image only."""
    write_sphere(tmp_path / "a.usda")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    Sdf.CopySpec(stage.GetRootLayer(), "/World/Ball", stage.GetRootLayer(), "/World/Proxy")
    UsdGeom.Mesh(stage.GetPrimAtPath("/World/Proxy")).CreatePurposeAttr("proxy")
    stage.Save()
    _, report = unwrapped(tmp_path / "a.usda", tmp_path / "out")
    assert "/World/Proxy kept the old map, which the new textures do not fit" in " ".join(report["warnings"])


def test_what_cannot_be_drawn_is_said(tmp_path):
    write_sphere(tmp_path / "a.usda")
    (tmp_path / "color.png").unlink()
    (tmp_path / "rough.png").write_bytes(b"\x89PNG\r\n\x1a\n broken")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    shader = UsdShade.Shader(stage.GetPrimAtPath("/World/Skin/normal"))
    shader.GetInput("st").ClearSources()
    of_material_x = UsdShade.Shader.Define(stage, "/World/Skin/X")
    of_material_x.CreateIdAttr("ND_image_color3")
    of_material_x.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath("./x.png"))
    stage.Save()
    _, report = unwrapped(tmp_path / "a.usda", tmp_path / "out")
    said = " ".join(report["warnings"])
    assert "color.png was not drawn anew and does not fit the new map: its image is missing." in said
    assert "rough.png was not drawn anew" in said
    assert "bumps.png was not drawn anew and does not fit the new map: what places it is no primvar." in said
    assert "x.png was not drawn anew and does not fit the new map: it is one of MaterialX." in said
    assert report["textures"] == []


@pytest.mark.parametrize(
    ("suffix", "dtype", "is_coded"),
    [(".png", np.uint16, True), (".exr", np.float16, True), (".exr", np.float32, False), (".exr", np.float16, False)],
)
def test_normals_keep_their_depth_and_lean_as_before(suffix, dtype, is_coded, tmp_path):
    """Coded normals are read by a scale of 2 and a bias of -1; files of floats may have them as they are."""
    triangles, uv = write_sphere(tmp_path / "a.usda")
    pixels = made.bumps(256, 384, 3, dtype=np.float64)
    stored = (pixels + 1) / 2 if is_coded else pixels
    stored = np.rint(65535 * stored).astype(dtype) if dtype == np.uint16 else stored.astype(dtype)
    (tmp_path / f"n{suffix}").write_bytes(images.written(stored, suffix))
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    texture = UsdShade.Shader(stage.GetPrimAtPath("/World/Skin/normal"))
    texture.GetInput("file").Set(Sdf.AssetPath(f"./n{suffix}"))
    for name, value in (("scale", (2.0, 2.0, 2.0, 1.0)), ("bias", (-1.0, -1.0, -1.0, 0.0))) if is_coded else ():
        texture.CreateInput(name, Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(*value))
    stage.Save()
    target, _ = unwrapped(tmp_path / "a.usda", tmp_path / "out")
    new = images.read((target.parent / f"a_n{suffix}").read_bytes())
    assert new.dtype == dtype
    found = new / (65535 if dtype == np.uint16 else 1.0)
    (mesh,) = assets.read(target).meshes
    positions, normals, _, _ = made.sphere(8)
    where, leaning = places(triangles, 20000), []
    for image, each in ((pixels, uv[triangles.ravel()]), (2 * found - 1 if is_coded else found, mesh.corner_uv)):
        # Triangles share tangents where the map is continuous.
        rows = np.c_[positions[triangles.ravel()], normals[triangles.ravel()], each]
        _, first, number = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        points, directions, places_of_rows = np.split(rows[first], (3, 6), axis=1)
        shared = number.reshape(-1, 3)
        frames = directions, sc.tangents(points, shared, places_of_rows, directions)
        leaning.append(in_space(65535 * (image + 1.0) / 2.0, places_of_rows, frames, shared, where))
    angle = np.degrees(np.arccos(np.clip((leaning[0] * leaning[1]).sum(axis=1), -1, 1)))
    assert angle.mean() < 0.5
    # The frames of a few of these coarse triangles turn by much between two texels, whatever the depth.
    assert np.percentile(angle, 99) < 2


@pytest.mark.parametrize(("suffix", "dtype"), [(".png", np.uint16), (".exr", np.float32)])
def test_displacement_keeps_its_depth(suffix, dtype, tmp_path):
    """In 8 bits, the relief would have 5 steps."""
    triangles, uv = write_sphere(tmp_path / "a.usda")
    values = 0.5 + 0.02 * made.painted(256, 384, 1, 5) / 255
    pixels = np.rint(65535 * values).astype(dtype) if dtype == np.uint16 else (10.0 * values - 5.1).astype(dtype)
    (tmp_path / f"h{suffix}").write_bytes(images.written(pixels, suffix))
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    surface, rough = (UsdShade.Shader(stage.GetPrimAtPath(f"/World/Skin/{name}")) for name in ("Surface", "roughness"))
    rough.GetInput("file").Set(Sdf.AssetPath(f"./h{suffix}"))
    surface.GetInput("roughness").ClearSources()
    surface.CreateInput("displacement", Sdf.ValueTypeNames.Float).ConnectToSource(rough.ConnectableAPI(), "r")
    stage.Save()
    target, _ = unwrapped(tmp_path / "a.usda", tmp_path / "out")
    new = images.read((target.parent / f"a_h{suffix}").read_bytes())
    assert new.dtype == dtype
    (mesh,) = assets.read(target).meshes
    # Of the relief itself, not of the range of the file.
    relief = np.ptp(pixels.astype(float)) / 255
    assert difference(uv, pixels / relief, mesh.corner_uv, new / relief, triangles).max() < 1
