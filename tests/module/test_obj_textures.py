# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of OBJ files, drawn anew with new material files."""

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import assets
from spectral_conformal.assets import images

from tests.module import textured_assets as made
from tests.module.test_gltf_textures import unwrapped
from tests.module.test_rebake import at, in_space, places, shown


def write_sphere(path, material, materials=("skin",)):
    """Write a textured sphere of quads and triangles, each half with a material; return its triangles' old UVs."""
    positions, _, uv, triangles = made.sphere(8)
    uv = uv * (1, -1) + (0, 1)
    text = ["mtllib my materials.mtl", *("v {:.9g} {:.9g} {:.9g}".format(*each) for each in positions)]
    text += ["vt {:.9g} {:.9g}".format(*each) for each in uv]
    for name, part in zip(materials, np.array_split(triangles, len(materials))):
        text += [f"usemtl {name}", *("f {0}/{0} {1}/{1} {2}/{2}".format(*each) for each in part + 1)]
    path.write_text("\n".join(text) + "\n")
    (path.parent / "my materials.mtl").write_text(material)
    return positions, uv, triangles


def new_uv(path, triangles):
    """(3 T, 2) UVs by corner, and triangles of these."""
    (mesh,) = assets.read(path).meshes
    assert len(mesh.corner_uv) == triangles.size
    return mesh.corner_uv, np.arange(triangles.size).reshape(-1, 3)


def statements(path):
    return dict(
        line.split(None, 1) for line in path.read_text().splitlines() if line.startswith(("map", "norm", "refl"))
    )


def test_a_sphere_shows_the_same_colors(tmp_path):
    """Beside its colors, an image that it reads from elsewhere, and two that are not drawn."""
    color, gray = made.painted(256, 384, 3, 1), made.painted(256, 384, 1, 2)
    (tmp_path / "tex").mkdir()
    (tmp_path / "tex" / "skin color.png").write_bytes(made.encoded(color))
    (tmp_path / "rough.tga").write_bytes(images.written(gray, ".tga"))
    (tmp_path / "sky.png").write_bytes(made.encoded(color))
    library = (
        "newmtl skin\nKd 1 1 1\nmap_Kd -blendu on tex/skin color.png\n"
        "map_Pr -o 1 -1 0 -s 1 1 1 rough.tga\nmap_Ks missing.png\nrefl -type sphere sky.png\n"
    )
    source = tmp_path / "a.obj"
    _, uv, triangles = write_sphere(source, library)
    target, report = unwrapped(source, tmp_path / "out")
    assert [each["name"] for each in report["textures"]] == ["skin color.png", "rough.tga"]
    assert any("missing.png was not drawn anew and does not fit the new map: its image is missing" in each
               for each in report["warnings"])  # fmt: skip
    assert "mtllib a_my materials.mtl" in target.read_text()
    found = statements(target.parent / "a_my materials.mtl")
    assert found == {
        "map_Kd": "-blendu on a_skin color.png",
        "map_Pr": "a_rough.tga",
        "map_Ks": "missing.png",
        "refl": "-type sphere sky.png",
    }
    assert (tmp_path / "my materials.mtl").read_text() == library
    assert (target.parent / "sky.png").is_file()
    corner_uv, corners = new_uv(target, triangles)
    where = places(triangles, 20000)
    for old, name in ((color, "a_skin color.png"), (gray, "a_rough.tga")):
        new = images.read((target.parent / name).read_bytes(), name[-4:])
        before = shown(old, at(uv, triangles, where))
        error = np.abs(before - shown(new[:, :, : old.shape[2]], at(corner_uv, corners, where)))
        assert error.mean() < 1
        assert np.percentile(error, 99.9) < 8


def test_each_material_reads_its_own_image(tmp_path):
    for name, value in (("a", 40), ("b", 200)):
        (tmp_path / f"{name}.png").write_bytes(made.encoded(np.full((32, 32, 3), value, np.uint8)))
    source = tmp_path / "m.obj"
    _, _, triangles = write_sphere(source, "newmtl one\nmap_Kd a.png\nnewmtl two\nmap_Kd b.png\n", ("one", "two"))
    target, report = unwrapped(source, tmp_path / "out", seams="keep")
    corner_uv, corners = new_uv(target, triangles)
    number, weights = places(triangles, 5000)
    is_second = number >= len(triangles) // 2
    for name, value, chosen in (("m_a.png", 40, ~is_second), ("m_b.png", 200, is_second)):
        new = images.read((target.parent / name).read_bytes())
        assert shown(new, at(corner_uv, corners, (number[chosen], weights[chosen]))) == pytest.approx(value)
    assert all(0 < each["covered"] < 0.5 for each in report["textures"])


@pytest.mark.parametrize("is_normal_map", [False, True])
def test_a_bump_map_with_unit_vectors_is_a_normal_map(is_normal_map, tmp_path):
    """Blender's exporter writes normal maps as bump maps, with heights being the other use."""
    pixels = made.bumps(256, 384, 3) if is_normal_map else np.repeat(made.painted(256, 384, 1, 3), 3, axis=2)
    (tmp_path / "b.png").write_bytes(made.encoded(pixels))
    source = tmp_path / "m.obj"
    positions, uv, triangles = write_sphere(source, "newmtl skin\nmap_Bump -bm 1 b.png\n")
    target, _ = unwrapped(source, tmp_path / "out", rotation="free")
    corner_uv, corners = new_uv(target, triangles)
    new = images.read((target.parent / "m_b.png").read_bytes())
    where = places(triangles, 5000)
    before, after = shown(pixels, at(uv, triangles, where)), shown(new, at(corner_uv, corners, where))
    is_same = np.abs(before - after).mean() < 1
    assert is_same == (not is_normal_map)
    # Turned in the surface, they lean as far.
    assert np.abs(before - after)[:, 2].mean() < 1


@pytest.mark.parametrize("kind", [np.float16, np.float32])
def test_floats_keep_their_digits(kind, tmp_path):
    """Heights would become steps, and light beyond 65504 infinite."""
    pixels = (made.painted(64, 96, 3, 4) / 64.0).astype(kind)
    (tmp_path / "glow.exr").write_bytes(images.written(pixels, ".exr"))
    source = tmp_path / "m.obj"
    _, uv, triangles = write_sphere(source, "newmtl skin\nmap_Ke glow.exr\n")
    target, _ = unwrapped(source, tmp_path / "out")
    new = images.read((target.parent / "m_glow.exr").read_bytes())
    assert new.dtype == kind
    assert new.max() > 2
    corner_uv, corners = new_uv(target, triangles)
    where = places(triangles, 5000)
    error = np.abs(shown(pixels, at(uv, triangles, where)) - shown(new, at(corner_uv, corners, where)))
    assert error.mean() < 0.01 * pixels.max()


def test_files_of_others_beside_the_source_are_not_replaced(tmp_path):
    (tmp_path / "a.png").write_bytes(made.encoded(made.painted(64, 96, 3, 1)))
    for name in ("m_a.png", "m_my materials.mtl"):
        (tmp_path / name).write_bytes(b"of another")
    source = tmp_path / "m.obj"
    write_sphere(source, "newmtl skin\nmap_Kd a.png\n")
    asset = assets.read(source)
    (mesh,) = asset.meshes
    assets.write(source, asset, [assets.UvMap(mesh.corner_uv, mesh.has_uv())], assets.TextureSize("same", (64, 64)))
    assert "mtllib m_my materials_1.mtl" in source.read_text()
    assert statements(tmp_path / "m_my materials_1.mtl") == {"map_Kd": "m_a_1.png"}
    assert (tmp_path / "m_a.png").read_bytes() == (tmp_path / "m_my materials.mtl").read_bytes() == b"of another"


def test_a_broken_image_is_said_in_one_line(tmp_path):
    (tmp_path / "a.png").write_bytes(made.encoded(made.painted(64, 96, 3, 1))[:900])
    source = tmp_path / "m.obj"
    write_sphere(source, "newmtl skin\nmap_Kd a.png\n")
    _, report = unwrapped(source, tmp_path / "out")
    (said,) = report["warnings"]
    assert said.startswith("The texture a.png was not drawn anew and does not fit the new map: ")
    assert "\n" not in said


@pytest.mark.parametrize(
    ("line", "is_said"),
    [("-s 2 2 2 a.png", True), ("-o 0 .5 a.png", True), ("-s 1 1 1 -o 0 0 a.png", False), ("a -s 2 b.png", False)],
)
def test_a_texture_that_its_material_moves_is_named(line, is_said, tmp_path):
    source = tmp_path / "m.obj"
    write_sphere(source, f"newmtl skin\nmap_Kd {line}\nrefl -s 3 3 3 a.png\nnewmtl other\nmap_Kd -s 3 3 3 a.png\n")
    (tmp_path / "a -s 2 b.png").write_bytes(b"")
    asset = assets.read(source)
    (mesh,) = asset.meshes
    uv_map = assets.UvMap(mesh.corner_uv, np.ones(len(mesh.face_offsets) - 1, bool))
    said = ["Materials scale or move textures of the map (-s, -o), which was left."] if is_said else []
    for name in ("n.obj", "again.obj"):
        assert assets.write(tmp_path / name, asset, [uv_map])[1] == said


@pytest.mark.parametrize("rule", ["same", "auto"])
def test_a_palette_needs_a_texel_for_each_triangle(rule, tmp_path):
    """Every triangle shows a point of a tiny texture, which has no area."""
    (tmp_path / "palette.png").write_bytes(made.encoded(made.painted(4, 4, 3, 1)))
    positions, _, _, triangles = made.sphere(8)
    text = ["mtllib palette.mtl", "usemtl colors", *("v {} {} {}".format(*each) for each in positions)]
    text += [f"vt {(k % 4 + 0.5) / 4} {(k // 4 % 4 + 0.5) / 4}" for k in range(len(triangles))]
    text += ["f " + " ".join(f"{v}/{k + 1}" for v in each + 1) for k, each in enumerate(triangles)]
    (tmp_path / "a.obj").write_text("\n".join(text) + "\n")
    (tmp_path / "palette.mtl").write_text("newmtl colors\nmap_Kd palette.png\n")
    _, report = unwrapped(tmp_path / "a.obj", tmp_path / "out", rebake=rule, texture_size=16)
    (texture,) = report["textures"]
    if rule == "same":
        assert texture["width"] == 4
        assert any("fewer texels per length" in each for each in report["warnings"])
    else:
        assert texture["width"] ** 2 * texture["covered"] >= 0.9 * len(triangles)
        assert report["warnings"] == []


def heights(dtype):
    """(256, 384, 1) of a surface whose heights differ by a fiftieth of the range, as those of fine relief."""
    values = made.painted(256, 384, 3, 5).astype(float).mean(axis=2, keepdims=True) / 255
    if np.dtype(dtype).kind == "u":
        return np.rint((0.5 + 0.02 * values) * np.iinfo(dtype).max).astype(dtype)
    # Floats are lengths, also below the surface.
    return (20.0 * values - 12.0).astype(dtype)


@pytest.mark.parametrize("key", ["map_Bump", "disp"])
@pytest.mark.parametrize(
    ("suffix", "dtype"), [(".png", np.uint16), (".tif", np.uint16), (".exr", np.float16), (".exr", np.float32)]
)
def test_heights_keep_their_depth(key, suffix, dtype, tmp_path):
    """In 8 bits, the relief would have 5 steps."""
    pixels = heights(dtype)
    (tmp_path / f"h{suffix}").write_bytes(images.written(pixels, suffix))
    source = tmp_path / "m.obj"
    _, uv, triangles = write_sphere(source, f"newmtl skin\n{key} h{suffix}\n")
    target, _ = unwrapped(source, tmp_path / "out")
    new = images.read((target.parent / f"m_h{suffix}").read_bytes())
    assert new.dtype == dtype
    corner_uv, corners = new_uv(target, triangles)
    where = places(triangles, 20000)
    error = np.abs(shown(pixels, at(uv, triangles, where)) - shown(new, at(corner_uv, corners, where)))
    # Of the relief itself, not of the range of the file.
    error *= 255 / np.ptp(pixels.astype(float))
    assert error.mean() < 1
    assert np.percentile(error, 99.9) < 8


def leaning(pixels, uv, positions, normals, triangles, where):
    """(n, 3) the normals in space that a normal map of floats from -1 to 1 shows at points of the sphere."""
    tangents = sc.tangents(positions, triangles, uv, normals)
    return in_space(65535 * (pixels + 1.0) / 2.0, uv, (normals, tangents), triangles, where)


@pytest.mark.parametrize(("suffix", "dtype", "codes"), [
    (".png", np.uint8, True), (".png", np.uint16, True), (".exr", np.float16, True), (".exr", np.float32, False),
    (".exr", np.float16, False)])  # fmt: skip
def test_normals_keep_their_depth_and_lean_as_before(suffix, dtype, codes, tmp_path):
    """Integers and some files of floats code them as colors, other files of floats have them as they are."""
    pixels = made.bumps(256, 384, 3, dtype=np.float64)
    stored = (pixels + 1) / 2 if codes else pixels
    stored = (
        np.rint(stored * np.iinfo(dtype).max).astype(dtype) if np.dtype(dtype).kind == "u" else stored.astype(dtype)
    )
    (tmp_path / f"n{suffix}").write_bytes(images.written(stored, suffix))
    source = tmp_path / "m.obj"
    positions, uv, triangles = write_sphere(source, f"newmtl skin\nnorm n{suffix}\n")
    target, _ = unwrapped(source, tmp_path / "out", rotation="free")
    new = images.read((target.parent / f"m_n{suffix}").read_bytes())
    assert new.dtype == dtype
    found = new / (np.iinfo(dtype).max if new.dtype.kind == "u" else 1.0)
    found = 2 * found - 1 if codes else found
    corner_uv, corners = new_uv(target, triangles)
    where = places(triangles, 20000)
    # OBJ without normals: those of the triangles.
    flat = np.repeat(np.cross(*(positions[triangles[:, k]] - positions[triangles[:, 0]] for k in (1, 2))), 3, axis=0)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    by_corner = positions[triangles.ravel()], flat, corners, where
    before, after = (
        leaning(image, each, *by_corner) for image, each in ((pixels, uv[triangles.ravel()]), (found, corner_uv))
    )
    angle = np.degrees(np.arccos(np.clip((before * after).sum(axis=1), -1, 1)))
    assert angle.mean() < 0.5
    # At an edge of flat triangles, a texel has the mean of both, in the frame of one.
    assert np.percentile(angle, 98) < 2
