# SPDX-License-Identifier: GPL-3.0-or-later
"""USD files: UVs in the file's own layer, or in one over it; nothing else changes."""

import zipfile

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.assets.usd import UsdAsset

pxr = pytest.importorskip("pxr")
Sdf, Usd, UsdGeom, UsdUtils = (
    getattr(__import__(f"pxr.{name}"), name) for name in ("Sdf", "Usd", "UsdGeom", "UsdUtils")
)

SHEET = """
        int[] faceVertexCounts = [4, 4]
        int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 5, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0.2), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
"""
SCENE = f"""#usda 1.0
(
    customLayerData = {{
        string made = "by hand"
    }}
    defaultPrim = "World"
    metersPerUnit = 0.01
    upAxis = "Z"
)

class "Proto"
{{
    def Mesh "Bolt"
    {{{SHEET}    }}
}}

def Xform "World" (
    variants = {{
        string lod = "high"
    }}
    prepend variantSets = "lod"
)
{{
    def Xform "I1" (
        instanceable = true
        prepend references = </Proto>
    )
    {{
    }}

    def Xform "I2" (
        instanceable = true
        prepend references = </Proto>
    )
    {{
    }}

    def Mesh "Mirrored" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {{{SHEET}        uniform token orientation = "leftHanded"
        rel material:binding = </World/Paint>
        uniform token subdivisionScheme = "catmullClark"
        custom double my:number = 0.1
        texCoord2f[] primvars:lightmap = [(0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (2, 1)] (
            interpolation = "vertex"
        )
        texCoord2f[] primvars:st.timeSamples = {{
            1: [(0, 0), (0, 0), (0, 0), (0, 0), (0, 0), (0, 0)],
            2: [(1, 0), (0, 0), (0, 0), (0, 0), (0, 0), (0, 0)],
        }}
        float3 xformOp:scale = (3, 3, 3)
        uniform token[] xformOpOrder = ["xformOp:scale"]
    }}

    def Mesh "Moving"
    {{
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        point3f[] points.timeSamples = {{
            1: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
            2: [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)],
        }}
    }}

    def Material "Paint"
    {{
    }}

    variantSet "lod" = {{
        "high" {{
            def Mesh "Chosen"
            {{{SHEET.replace(chr(10), chr(10) + "        ").rstrip()}
            }}
        }}
        "low" {{
        }}
    }}
}}
"""
MESHES = ["/Proto/Bolt", "/World/Mirrored", "/World/Moving", "/World/Chosen"]


def save(path):
    """Write the scene, in the format of the suffix, and return its path."""
    if path.suffix == ".usda" or path.stem == "text":
        path.write_text(SCENE)
        return path
    layer = Sdf.Layer.CreateAnonymous(".usda")
    assert layer.ImportFromString(SCENE)
    if path.suffix != ".usdz":
        assert layer.Export(str(path))
        return path
    inner, picture = path.with_name("inner.usdc"), path.with_name("a.png")
    layer.Export(str(inner))
    picture.write_bytes(b"no picture")
    package = Sdf.ZipFileWriter.CreateNew(str(path))
    package.AddFile(str(inner), "inner.usdc")
    package.AddFile(str(picture), "textures/a.png")
    package.Save()
    return path


def maps_of(asset):
    rng = np.random.default_rng(1)
    sizes = [len(mesh.corner_vertices) for mesh in asset.meshes]
    return [assets.UvMap(rng.random((n, 2)).astype("f4").astype(float), np.ones(n // 4, bool)) for n in sizes]


def without_uv(path):
    """Return the text of the root layer without `primvars:st`."""
    stage = Usd.Stage.Open(str(path))
    text = Sdf.Layer.CreateAnonymous(".usda")
    text.TransferContent(stage.GetRootLayer())
    for mesh in (*MESHES[:-1], "/World{lod=high}Chosen"):
        prim = text.GetPrimAtPath(mesh)
        for name in ("primvars:st", "primvars:st:indices"):
            if name in prim.properties:
                del prim.properties[name]
    return text.ExportToString()


def complaints(path):
    """Return what the validators of usdchecker say of a file."""
    validation = pytest.importorskip("pxr.UsdValidation")
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    errors = validation.ValidationContext(validators).Validate(Usd.Stage.Open(str(path)))
    return sorted((error.GetName(), error.GetMessage().replace(str(path), "")) for error in errors)


def test_the_validators_see_what_is_wrong(tmp_path):
    path = tmp_path / "m.usda"
    path.write_text(SCENE.replace("rel material:binding", "custom rel material:binding").replace('upAxis = "Z"', ""))
    assert "MissingUpAxisMetadata" in {name for name, _ in complaints(path)}


@pytest.mark.parametrize("name", ["m.usda", "m.usdc", "m.usd", "text.usd", "m.usdz"])
def test_all_else_is_as_it_was(name, tmp_path):
    path = save(tmp_path / name)
    suffix = path.suffix
    asset = assets.read(path)
    assert sorted(mesh.name for mesh in asset.meshes) == sorted(MESHES)
    assert {mesh.name: mesh.scale for mesh in asset.meshes}["/World/Mirrored"] == pytest.approx(3)
    assert asset.warnings == ["/World/Moving is animated: it was unwrapped in its first state."]
    maps = maps_of(asset)
    new = tmp_path / f"new{suffix}"
    assets.write(new, asset, maps)
    assert without_uv(new) == without_uv(path)
    assert new.read_bytes()[:8] == path.read_bytes()[:8]
    for mesh, uv_map in zip(assets.read(new).meshes, maps):
        assert np.array_equal(mesh.corner_uv, uv_map.uv)
    assert complaints(new) == complaints(path)
    if suffix == ".usdz":
        with zipfile.ZipFile(new) as package:
            assert package.namelist() == ["inner.usdc", "textures/a.png"]
            assert package.read("textures/a.png") == b"no picture"


def test_instances_share_the_uvs_of_their_prototype(tmp_path):
    asset = assets.read(save(tmp_path / "m.usda"))
    assets.write(tmp_path / "new.usda", asset, maps_of(asset))
    stage = Usd.Stage.Open(str(tmp_path / "new.usda"))
    found = [
        np.array(UsdGeom.PrimvarsAPI(stage.GetPrimAtPath(f"/World/{name}/Bolt")).GetPrimvar("st").ComputeFlattened())
        for name in ("I1", "I2")
    ]
    (bolt,) = [k for k, mesh in enumerate(asset.meshes) if mesh.name == "/Proto/Bolt"]
    assert np.array_equal(found[0], found[1]) and np.array_equal(found[0], maps_of(asset)[bolt].uv)


def test_a_left_handed_mesh_is_wound_as_it_is_seen(tmp_path):
    meshes = {mesh.name: mesh for mesh in assets.read(save(tmp_path / "m.usda")).meshes}
    plain, mirrored = meshes["/World/Chosen"], meshes["/World/Mirrored"]
    assert plain.corner_vertices.tolist() == [0, 1, 2, 3, 1, 4, 5, 2]
    assert mirrored.corner_vertices.tolist() == [3, 2, 1, 0, 2, 5, 4, 1]


def test_a_layer_over_the_file_leaves_it_alone(tmp_path):
    path = save(tmp_path / "m.usda")
    asset = UsdAsset(path, over=True)
    (tmp_path / "over").mkdir()
    new = tmp_path / "over" / "m.usda"
    maps = maps_of(asset)
    assets.write(new, asset, maps)
    assert path.read_text() == SCENE
    layer = Sdf.Layer.FindOrOpen(str(new))
    assert list(layer.subLayerPaths) == ["../m.usda"] and layer.defaultPrim == "World"
    assert {spec.name for spec in layer.rootPrims} == {"Proto", "World"}
    for mesh, uv_map in zip(assets.read(new).meshes, maps):
        assert np.array_equal(mesh.corner_uv, uv_map.uv)


def test_a_prototype_of_another_file_is_named(tmp_path):
    save(tmp_path / "parts.usda")
    (tmp_path / "m.usda").write_text(
        '#usda 1.0\ndef Xform "A" (\n    instanceable = true\n    prepend references = @parts.usda@</Proto>\n)\n{\n}\n'
        'def Mesh "Own"\n{' + SHEET + "}\n"
    )
    asset = assets.read(tmp_path / "m.usda")
    assert [mesh.name for mesh in asset.meshes] == ["/Own"]
    assert asset.warnings == ["/A/Bolt is an instance of another file's prim and has no UVs: unwrap that file."]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("no usd", r"is not a USD file that can be read: <.*m.usda> is not a valid usda layer\.$"),
        ('#usda 1.0\ndef Mesh "A" {\n  int x = \n', "is not a USD file that can be read: line 3.*Expected"),
        ('#usda 1.0\ndef Mesh "A"\n{' + SHEET.replace("[4, 4]", "[9, -1]") + "}\n", "face 1 has -1 corners"),
        ('#usda 1.0\ndef Xform "A"\n{\n}\n', "has no meshes"),
        ('#usda 1.0\ndef Mesh "A"\n{' + SHEET.replace("[4, 4]", "[4, 3]") + "}\n", "the indices disagree"),
        ('#usda 1.0\ndef Mesh "A"\n{' + SHEET.replace("5, 2]", "9, 2]") + "}\n", "a point that does not exist"),
        ('#usda 1.0\ndef Mesh "A"\n{' + SHEET.replace("[4, 4]", "[2, 2, 2, 2]") + "}\n", "has no faces"),
    ],
)
def test_a_broken_file_is_named(content, said, tmp_path):
    (tmp_path / "m.usda").write_text(content)
    with pytest.raises(assets.AssetError, match=f"m.usda.*{said}"):
        assets.read(tmp_path / "m.usda")


def test_damage_that_reading_finds_is_named(tmp_path):
    """A name that is no text, and values that cannot be decompressed once they are wanted."""
    path = tmp_path / "m.usda"
    path.write_bytes(b'#usda 1.0\ndef Mesh "\xac" (\n{\n}\n')
    with pytest.raises(assets.AssetError, match="is not a USD file that can be read"):
        assets.read(path)
    from pxr import Usd, UsdGeom

    path = tmp_path / "m.usdc"
    stage = Usd.Stage.CreateNew(str(path))
    mesh = UsdGeom.Mesh.Define(stage, "/m")
    mesh.CreatePointsAttr([(k, k * k, 0) for k in range(999)])
    mesh.CreateFaceVertexCountsAttr([3 + k % 2 for k in range(99)])
    mesh.CreateFaceVertexIndicesAttr([7 * k % 999 for k in range(sum(3 + k % 2 for k in range(99)))])
    stage.GetRootLayer().Save()
    whole, said = path.read_bytes(), set()
    for place in range(88, len(whole) - 400, 97):
        path.write_bytes(whole[:place] + bytes(64) + whole[place + 64 :])
        try:
            assets.read(path)
        except assets.AssetError as error:
            said.add(str(error))
    assert any("is not a USD file that can be read: Failed to decompress" in each for each in said), said


def test_what_a_scene_is_composed_of_is_found_from_where_it_is_written(tmp_path):
    """A prototype above the scene's folder, with a map of its own, and a sublayer and a texture below it."""
    for name in ("library", "shots/parts", "shots/tex", "out/deep"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "library" / "bolt.usda").write_text(
        f'#usda 1.0\n(\n defaultPrim = "Bolt"\n)\ndef Mesh "Bolt"\n{{{SHEET}}}\n'
    )
    (tmp_path / "shots" / "parts" / "more.usda").write_text('#usda 1.0\ndef Xform "More"\n{\n}\n')
    (tmp_path / "shots" / "tex" / "a.png").write_bytes(b"no picture")
    shot = tmp_path / "shots" / "shot.usda"
    shot.write_text(
        "#usda 1.0\n(\n subLayers = [@./parts/more.usda@]\n)\n"
        f'def Mesh "Own"\n{{{SHEET} asset picture = @./tex/a.png@\n}}\n'
        'def Xform "There" (\n references = @../library/bolt.usda@\n)\n{\n}\n'
    )
    asset = assets.read(shot)
    _, warnings = assets.write(tmp_path / "out" / "deep" / "new.usda", asset, maps_of(asset))
    assert warnings == []
    stage = Usd.Stage.Open(str(tmp_path / "out" / "deep" / "new.usda"))
    assert UsdGeom.Mesh(stage.GetPrimAtPath("/There")).GetPointsAttr().Get() is not None
    assert stage.GetPrimAtPath("/More").IsValid()
    assert stage.GetPrimAtPath("/Own").GetAttribute("picture").Get().resolvedPath
    assert (tmp_path / "out" / "deep" / "tex" / "a.png").is_file()


@pytest.mark.parametrize("suffix", [".usda", ".usdc", ".usdz"])
def test_what_is_read_of_a_file_written_over_is_what_was_written(suffix, tmp_path):
    """Also while what was read before is in use."""
    stage = Usd.Stage.CreateNew(str(tmp_path / "m.usda"))
    stage.GetRootLayer().ImportFromString(f'#usda 1.0\ndef Mesh "m"\n{{{SHEET}}}\n')
    path = tmp_path / f"n{suffix}"
    if suffix == ".usdz":
        stage.Save()
        assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "m.usda"), str(path))
    else:
        stage.Export(str(path))
    before = assets.read(path)
    for k in range(2):
        uv = np.full((8, 2), 0.25 * k) + np.arange(16).reshape(8, 2) / 32
        assets.write(path, before, [assets.UvMap(uv, np.ones(2, bool))])
        assert assets.read(path).meshes[0].corner_uv.tolist() == uv.tolist()


@pytest.mark.parametrize("content", ["int[] faceVertexCounts = []\nint[] faceVertexIndices = []", ""])
def test_an_empty_mesh_beside_others_is_a_warning(content, tmp_path):
    path = tmp_path / "m.usda"
    path.write_text(f'#usda 1.0\ndef Mesh "null"\n{{\n{content}\n}}\ndef Mesh "good"\n{{{SHEET}}}\n')
    asset = assets.read(path)
    assert [mesh.name for mesh in asset.meshes] == ["/good"]
    maps = [assets.UvMap(np.zeros((8, 2)), np.ones(2, bool))]
    assert "/null has no faces." in assets.write(tmp_path / "new.usda", asset, maps)[1]
    path.write_text(f'#usda 1.0\ndef Mesh "null"\n{{\n{content}\n}}\n')
    with pytest.raises(assets.AssetError, match="there is nothing to unwrap"):
        assets.read(path)


READER = """
    rel material:binding = </M>
}
def Material "M" {
    def Shader "R" {
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname%s
    }
"""


@pytest.mark.parametrize("value", [' = "UVMap"', ".connect = </M.inputs:frame>"])
def test_the_map_is_the_one_that_the_material_reads(value, tmp_path):
    path, new = tmp_path / "m.usda", tmp_path / "new.usda"
    path.write_text(f'#usda 1.0\ndef Mesh "m" {{\n{SHEET}{READER % value}\n}}\n')
    if "connect" in value:
        path.write_text(path.read_text().replace("def Shader", 'string inputs:frame = "UVMap"\n    def Shader'))
    for given, name in (("", "UVMap"), ("Other", "Other")):
        uv = np.arange(16).reshape(8, 2) / 32
        assets.write(new, assets.read(path, given), [assets.UvMap(uv, np.ones(2, bool))])
        assert assets.read(new, given).meshes[0].corner_uv.tolist() == uv.tolist()
        stage = Usd.Stage.Open(Sdf.Layer.OpenAsAnonymous(str(new)))
        mesh = stage.GetPrimAtPath("/m")
        assert mesh.HasAttribute(f"primvars:{name}") and not mesh.HasAttribute("primvars:st")


def test_meshes_in_variants_that_are_not_selected_are_named(tmp_path):
    path = tmp_path / "m.usda"
    variants = "".join(
        f'    "{name}" {{\n        def Mesh "m" {{\n{SHEET}        }}\n    }}\n' for name in ("high", "low")
    )
    head = 'def Xform "x" (\n    variants = {\n        string lod = "high"\n    }\n    prepend variantSets = "lod"\n)'
    path.write_text(f'#usda 1.0\n{head}\n{{\n  variantSet "lod" = {{\n{variants}  }}\n}}\n')
    asset = assets.read(path)
    _, warnings = assets.write(tmp_path / "n.usda", asset, [assets.UvMap(np.zeros((8, 2)), np.ones(2, bool))])
    assert warnings == ["Left unchanged, because their variants are not selected: /x{lod=low}m."]


@pytest.mark.parametrize("kind", ["the mesh itself", "payloads"])
def test_a_map_of_faces_that_a_variant_has_stays_in_it(kind, tmp_path):
    few = SHEET.replace("[4, 4]", "[4]").replace(", 1, 4, 5, 2]", "]")
    bodies = {"high": SHEET, "low": few, "same": SHEET}
    for name, body in bodies.items():
        (tmp_path / f"{name}.usda").write_text(
            '#usda 1.0\n(\n  defaultPrim = "x"\n)\ndef Xform "x"\n{\n  def Mesh "m"\n  {' + body + "  }\n}\n"
        )
    form = '"{0}" {{{1}}}\n' if kind == "the mesh itself" else '"{0}" (\n  payload = @{0}.usda@\n) {{\n}}\n'
    variants = "".join(form.format(*each) for each in bodies.items())
    head = 'def Xform "x" (\n    variants = {\n        string lod = "high"\n    }\n    prepend variantSets = "lod"\n)'
    head = head.replace("Xform", "Mesh") if kind == "the mesh itself" else head
    (tmp_path / "m.usda").write_text(f'#usda 1.0\n{head}\n{{\n  variantSet "lod" = {{\n{variants}  }}\n}}\n')
    name = "" if kind == "the mesh itself" else "m"
    asset = assets.read(tmp_path / "m.usda")
    left = ", ".join(f"/x{{lod={variant}}}{name}" for variant in ("low", "same"))
    assert asset.warnings == [f"Left unchanged, because their variants are not selected: {left}."]
    (mesh,) = asset.meshes
    uv = mesh.vertices[mesh.corner_vertices][:, :2]
    assets.write(tmp_path / "new.usda", asset, [assets.UvMap(uv, np.ones(2, bool))])
    stage = Usd.Stage.Open(str(tmp_path / "new.usda"))
    found = {}
    for variant in bodies:
        stage.GetPrimAtPath("/x").GetVariantSet("lod").SetVariantSelection(variant)
        st = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath(f"/x/{name}" if name else "/x")).GetPrimvar("st")
        found[variant] = len(st.ComputeFlattened()) if st and st.HasValue() else 0
    assert found == {"high": len(uv), "low": 0, "same": 0}


def test_a_layer_that_goes_along_finds_what_it_references(tmp_path):
    """Above the scene's folder, from a layer below it; and beside it, which goes along."""
    for name in ("library", "shots/parts", "shots/tex", "far/out"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "library" / "bolt.usda").write_text(f'#usda 1.0\n(\n defaultPrim = "B"\n)\ndef Mesh "B"\n{{{SHEET}}}\n')
    (tmp_path / "shots" / "tex" / "a.png").write_bytes(b"no picture")
    (tmp_path / "shots" / "parts" / "part.usda").write_text(
        '#usda 1.0\n(\n defaultPrim = "P"\n)\ndef Xform "P"\n{\n asset picture = @../tex/a.png@\n'
        ' def "B" (\n references = @../../library/bolt.usda@\n)\n{\n}\n}\n'
    )
    shot = tmp_path / "shots" / "shot.usda"
    shot.write_text('#usda 1.0\ndef Xform "S" (\n references = @./parts/part.usda@\n)\n{\n}\n')
    asset = assets.read(shot)
    assets.write(tmp_path / "far" / "out" / "new.usda", asset, maps_of(asset))
    assert [mesh.name for mesh in assets.read(tmp_path / "far" / "out" / "new.usda").meshes] == ["/S/B"]
    stage = Usd.Stage.Open(str(tmp_path / "far" / "out" / "new.usda"))
    found = stage.GetPrimAtPath("/S").GetAttribute("picture").Get().resolvedPath
    assert found == str(tmp_path / "far" / "out" / "tex" / "a.png")


def test_textures_of_materialx_go_along(tmp_path):
    """USD does not look into these files unless it has a plugin for them."""
    (tmp_path / "in" / "looks" / "tex").mkdir(parents=True)
    (tmp_path / "out").mkdir()
    for name in ("a.png", "b.png"):
        (tmp_path / "in" / "looks" / "tex" / name).write_bytes(b"no picture")
    (tmp_path / "in" / "looks" / "m.mtlx").write_text(
        '<?xml version="1.0"?>\n<materialx version="1.38" fileprefix="tex/">\n'
        '<image name="i" type="color3"><input name="file" type="filename" value="a.png" /></image>\n'
        '<image name="k" type="color3"><input value="b.png" name="file" type="filename" /></image>\n</materialx>\n'
    )
    path = tmp_path / "in" / "m.usda"
    path.write_text(
        f'#usda 1.0\ndef Mesh "M"\n{{{SHEET}}}\ndef "L" (\n references = @./looks/m.mtlx@</MaterialX>\n)\n{{\n}}\n'
    )
    asset = assets.read(path)
    assets.write(tmp_path / "out" / "m.usda", asset, maps_of(asset))
    found = sorted(str(each.relative_to(tmp_path / "out")) for each in (tmp_path / "out").rglob("*.*"))
    assert found == ["looks/m.mtlx", "looks/tex/a.png", "looks/tex/b.png", "m.usda"]


def three(first, second):
    """A file with a mesh and two others, which have these lines, too."""
    bodies = zip(("Plain", "First", "Second"), ("", first, second))
    return "#usda 1.0\n" + "".join(f'def Mesh "{name}"\n{{{SHEET}{line}\n}}\n' for name, line in bodies)


def test_guides_and_proxies_are_left_out(tmp_path):
    path = tmp_path / "m.usda"
    path.write_text(three('uniform token purpose = "guide"', 'uniform token purpose = "proxy"'))
    asset = assets.read(path)
    assert [mesh.name for mesh in asset.meshes] == ["/Plain"]
    assert asset.warnings == ["Left unchanged, because they are guides or proxies: /First, /Second."]
    # Unless there is nothing else.
    path.write_text(f'#usda 1.0\ndef Mesh "m"\n{{{SHEET}uniform token purpose = "proxy"\n}}\n')
    assert len(assets.read(path).meshes) == 1 and assets.read(path).warnings == []


def test_what_is_never_seen_is_left_out(tmp_path):
    """A class whose faces others inherit, and a prim that is turned off."""
    path = tmp_path / "m.usda"
    heirs = "".join(f'def Mesh "{name}" (\n inherits = </c>\n) {{\n}}\n' for name in ("one", "two"))
    off = f'def Mesh "off" (\n active = false\n) {{{SHEET}}}\n'
    path.write_text(f'#usda 1.0\nclass Mesh "c" {{{SHEET}}}\n{heirs}{off}')
    asset = assets.read(path)
    assert [mesh.name for mesh in asset.meshes] == ["/one", "/two"]
    assert asset.warnings == ["Left unchanged, because they are abstract or inactive: /c, /off."]
    # Unless there is nothing else.
    path.write_text(f'#usda 1.0\nclass Mesh "c" {{{SHEET}}}\n')
    assert len(assets.read(path).meshes) == 1 and assets.read(path).warnings == []


def test_a_material_that_reads_another_map_is_named(tmp_path):
    path = tmp_path / "m.usda"
    part = 'def GeomSubset "{0}" {{\nint[] indices = [{1}]\nuniform token elementType = "face"\n'
    part += 'uniform token familyName = "materialBind"\nrel material:binding = </{0}>\n}}\n'
    parts = "".join(part.format(name, k) for k, name in enumerate(("A", "B")))
    reader = 'def Material "{0}" {{\ndef Shader "R" {{\nuniform token info:id = "UsdPrimvarReader_float2"\n'
    reader += 'string inputs:varname = "{1}"\n}}\n}}\n'
    for first, second, said in (
        ("a", "b", ["No texture of /B reads a, only b: name that as the UV map to show the new one."]),
        ("a", "a", []),
    ):
        materials = "".join(reader.format(*each) for each in (("A", first), ("B", second)))
        path.write_text(f'#usda 1.0\ndef Mesh "m" {{{SHEET}{parts}}}\n{materials}')
        assert assets.read(path).warnings == said
        assert assets.read(path, "b").warnings == []


@pytest.mark.parametrize("kind", ["float", "float[]", "float3", "string", "string[]", "int"])
@pytest.mark.parametrize("name", ["normals", "primvars:normals", "primvars:displayColor", "primvars:st"])
def test_values_of_other_types_are_none(name, kind, tmp_path):
    value = {"f": "(1, 2, 3)" if "3" in kind else "1", "i": "1", "s": '"a"'}[kind[0]]
    value = f"[{', '.join(8 * [value])}]" if "[]" in kind else value
    subdivision = 'uniform token subdivisionScheme = "none"'
    path = tmp_path / "m.usda"
    path.write_text(f'#usda 1.0\ndef Mesh "m"\n{{{SHEET}{subdivision}\n{kind} {name} = {value}\n}}\n')
    asset = assets.read(path)
    (mesh,) = asset._meshes
    assert asset.meshes[0].corner_uv is None
    assert mesh._colors() is None
    assert mesh._normals() is None
    assets.write(tmp_path / "new.usda", asset, maps_of(asset))
    assert assets.read(tmp_path / "new.usda").meshes[0].has_uv().all()


def test_a_mesh_without_faces_is_nothing_to_unwrap(tmp_path):
    (tmp_path / "m.usda").write_text('#usda 1.0\ndef Mesh "A"\n{\n}\n')
    with pytest.raises(assets.NoMeshError, match="has no faces"):
        assets.read(tmp_path / "m.usda")


@pytest.mark.parametrize("hand", ["rightHanded", "leftHanded"])
def test_faces_of_fewer_than_three_corners_are_no_obstacle(hand, tmp_path):
    """Two quads, and between them faces of two, one and no corners, with values for all corners and faces."""
    path = tmp_path / "m.usda"
    uv = "[(0, 0), (1, 0), (1, 1), (0, 1), (9, 9), (9, 9), (9, 9), (2, 0), (3, 0), (3, 1), (2, 1)]"
    path.write_text(
        f"""#usda 1.0
def Mesh "m"
{{
    uniform token orientation = "{hand}"
    int[] faceVertexCounts = [4, 2, 1, 0, 4]
    int[] faceVertexIndices = [0, 1, 2, 3, 0, 1, 5, 1, 4, 5, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0.2), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
    texCoord2f[] primvars:st = {uv} ( interpolation = "faceVarying" )
    normal3f[] normals = [{", ".join(f"(0, {k}, 1)" for k in range(11))}] ( interpolation = "faceVarying" )
    color3f[] primvars:displayColor = [(1, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 1)] (
        interpolation = "uniform"
    )
    uniform token subdivisionScheme = "none"
    def GeomSubset "last" ( prepend apiSchemas = ["MaterialBindingAPI"] )
    {{
        uniform token elementType = "face"
        int[] indices = [4]
        rel material:binding = </Blue>
    }}
}}
def Material "Blue" {{}}
"""
    )
    asset = assets.read(path)
    said = "3 faces have fewer than three corners: no UVs for them."
    assert asset.warnings == [said]
    (mesh,) = asset.meshes
    step = 1 if hand == "rightHanded" else -1
    assert mesh.corner_vertices.tolist() == [*[0, 1, 2, 3][::step], *[1, 4, 5, 2][::step]]
    assert mesh.corner_uv[:, 0].tolist() == [*[0, 1, 1, 0][::step], *[2, 3, 3, 2][::step]]
    assert mesh.material_of_face.tolist() == [-1, 0]
    assert asset._meshes[0]._colors()[:, 0].tolist() == 4 * [1.0] + 4 * [0.0]
    normals = asset._meshes[0]._normals()
    assert np.allclose(normals[:, 1] / normals[:, 2], [*[0, 1, 2, 3][::step], *[7, 8, 9, 10][::step]])
    (uv_map,) = maps_of(asset)
    assert said in assets.write(tmp_path / "new.usda", asset, [uv_map])[1]
    assert np.array_equal(assets.read(tmp_path / "new.usda").meshes[0].corner_uv, uv_map.uv)
    stage = Usd.Stage.Open(str(tmp_path / "new.usda"))
    primvar = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/m")).GetPrimvar("st")
    assert np.array(primvar.ComputeFlattened())[4:7].tolist() == 3 * [[0, 0]]


def test_faces_that_change_over_time_are_left_out(tmp_path):
    path, same = tmp_path / "m.usda", "int[] faceVertexCounts.timeSamples = { 1: [4, 4], 2: [4, 4] }"
    other = "int[] faceVertexIndices.timeSamples = { 1: [0, 1, 2, 3, 1, 4, 5, 2], 2: [1, 2, 3, 0, 4, 5, 2, 1] }"
    path.write_text(three(same, other))
    asset = assets.read(path)
    assert [mesh.name for mesh in asset.meshes] == ["/Plain", "/First"]
    said = "Left unchanged, because their faces change over time, which no single map fits: /Second."
    assert asset.warnings == [said]
    path.write_text(f'#usda 1.0\ndef Mesh "m"\n{{{SHEET}{other}\n}}\n')
    with pytest.raises(assets.AssetError, match="the faces of its meshes change over time"):
        assets.read(path)
