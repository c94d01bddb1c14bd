# SPDX-License-Identifier: GPL-3.0-or-later
"""Layouts of assets: a texture of its own for each object or material, tiles for a density, texels, overlaps."""

from dataclasses import replace

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import assets
from spectral_conformal.assets.report import Measurement, map_report
from spectral_conformal.assets.unwrapping import Cutting, Layout, cut, laid_out, laid_out_anew, sheets_of, unwrapped
from spectral_conformal.batch import settings, task

from tests.module.batch_assets import grid, write_cube

SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)


def two_parts():
    """An OBJ mesh of two sheets, the first one with two materials, and another mesh with one of these."""
    points, quads = grid(6, 0.1, 1)
    n = len(quads)
    vertices = np.concatenate([points, points + [3.0, 0.0, 0.0]])
    corners = np.concatenate([quads, quads + len(points)]).ravel()
    material = np.repeat([0, 1, 1], [n // 2, n - n // 2, n])
    one = assets.AssetMesh(
        *(vertices, np.arange(0, 8 * n + 1, 4), corners, None, "one"),
        parts=("left", "right"),
        part_of_face=np.repeat([0, 1], n),
        material_of_face=material,
    )
    other = assets.AssetMesh(points, np.arange(0, 4 * n + 1, 4), quads.ravel(), None, "other", material=0)
    return [one, other]


def laid(meshes, layout, cutting=None):
    cutting = cutting or Cutting("keep", between_materials=layout.pack_by == "material")
    results = [unwrapped(cut(mesh, cutting), sc.Options()) for mesh in meshes]
    return [mesh.with_map(found) for mesh, found in zip(meshes, laid_out(meshes, results, layout))]


@pytest.mark.parametrize("pack", ["shape", "box"])
@pytest.mark.parametrize(("pack_by", "sheets", "islands"), [("asset", 1, 3), ("object", 3, 3), ("material", 2, 4)])
def test_each_sheet_fills_a_texture_of_its_own(pack, pack_by, sheets, islands):
    meshes = laid(two_parts(), Layout(pack, 2.0, 256, 256, pack_by=pack_by))
    report = map_report(meshes, pack_by)
    assert (report.tiles, report.islands, report.overlaps, report.flips) == (sheets, islands, 0, 0)
    assert report.fill > 0.5
    for mesh in meshes:
        assert mesh.corner_uv.min() > 0.0
        assert mesh.corner_uv.max() < 1.0
    # Without the textures being told apart, islands lie on each other.
    assert (map_report(meshes).overlaps > 0) == (sheets > 1)


def test_a_sheet_is_the_same_as_alone():
    meshes = two_parts()
    together = laid(meshes, Layout(margin=2.0, width=256, height=256, pack_by="object"))
    alone = laid(meshes[1:], Layout(margin=2.0, width=256, height=256))
    assert np.array_equal(together[1].corner_uv, alone[0].corner_uv)


def test_textures_are_beside_each_other_in_the_picture():
    meshes = laid(two_parts(), Layout(margin=2.0, width=256, height=256, pack_by="object"))
    uv, _ = Measurement(meshes, sheets=sheets_of(meshes, "object")).triangles()
    assert np.unique(np.floor(uv[..., 0])).tolist() == [0, 1, 2]
    assert Measurement(meshes).triangles()[0].max() < 1.0


def test_tiles_are_found_for_a_density():
    meshes = two_parts()
    for density in (40.0, 80.0, 110.0):
        found = laid(meshes, Layout(margin=2.0, width=256, height=256, density=density, tiles="auto"))
        report = map_report(found)
        # Each of three sheets has an area of about 4.
        least = np.ceil(3 * 4 * density**2 / 256**2)
        assert least <= report.tiles <= least + 2
        assert report.uv_per_length * 256 == pytest.approx(density, rel=1e-6)
        assert report.overlaps == 0
    with pytest.raises(
        ValueError, match="a density of 200 pixels per unit is too high: 3 islands have no room in a tile"
    ):
        laid(meshes, Layout(margin=2.0, width=256, height=256, density=200.0, tiles="auto"))
    with pytest.raises(ValueError, match="1 island has no room in a tile; make it or the margin smaller"):
        laid([squares(((0, 0), 1))], Layout(margin=2.0, width=64, height=64, density=200.0, tiles="auto"))


def squares(*places):
    """Squares with these corners and sides in the map, apart in 3D."""
    vertices = np.concatenate([np.c_[SQUARE, np.full(4, 2.0 * k)] for k in range(len(places))])
    uv = np.concatenate([np.array(at) + side * SQUARE for at, side in places])
    n = len(vertices)
    return assets.AssetMesh(vertices, np.arange(0, n + 1, 4), np.arange(n), uv)


def packed_again(mesh, **options):
    layout = Layout(margin=2.0, width=256, height=256, **options)
    islands = Measurement([mesh]).island_of_face
    return mesh.with_map(laid_out_anew([mesh], [islands], layout)[0])


def test_existing_islands_that_overlap_stay_together_if_asked():
    mesh = squares(((0.1, 0.1), 0.2), ((0.2, 0.25), 0.1), ((0.6, 0.6), 0.3))
    assert map_report([mesh]).overlaps == 2
    apart = packed_again(mesh)
    assert map_report([apart]).overlaps == 0
    together = packed_again(mesh, keep_overlaps=True)
    assert map_report([together]).overlaps == 2
    first, second, _ = np.split(together.corner_uv, 3)
    side = np.linalg.norm(first[1] - first[0])
    assert np.linalg.norm(second - first[0], axis=1) / side == pytest.approx(
        np.linalg.norm(mesh.corner_uv[4:8] - mesh.corner_uv[0], axis=1) / 0.2
    )


@pytest.mark.parametrize("pack", ["shape", "box"])
def test_an_existing_map_gets_a_density_and_keeps_the_ratios_of_its_islands(pack):
    mesh = squares(((0.1, 0.1), 0.2), ((0.1, 0.1), 0.2), ((0.6, 0.6), 0.3))
    found = packed_again(mesh, pack=pack, density=60.0)
    assert map_report([found]).uv_per_length * 256 == pytest.approx(60.0, rel=1e-6)
    sides = np.array([np.linalg.norm(each[1] - each[0]) for each in np.split(found.corner_uv, 3)])
    assert sides / sides[0] == pytest.approx([1.0, 1.0, 1.5])
    # Two islands lie on each other, which boxes do not keep.
    assert map_report([found]).tiles == 1 and (map_report([found]).overlaps == 2) == (pack == "shape")
    with pytest.raises(ValueError, match="a density of 600 pixels per unit"):
        packed_again(mesh, pack=pack, density=600.0)
    flat = replace(mesh, corner_uv=0.0 * mesh.corner_uv)
    with pytest.raises(ValueError, match="a density needs a map with area"):
        packed_again(flat, pack=pack, density=60.0)


def test_an_existing_map_fills_as_few_tiles_as_its_density_or_its_size_needs():
    mesh = squares(*[((0.05 * k, 0.5), 0.4) for k in range(9)])
    # Four of these have room in a tile.
    by_size = packed_again(mesh, tiles="auto")
    assert map_report([by_size]).tiles == 3
    sides = [np.linalg.norm(each[1] - each[0]) for each in np.split(by_size.corner_uv, 9)]
    assert sides == pytest.approx([0.4] * 9)
    # Sides of 1 in 3D: nine or one in a tile.
    assert map_report([packed_again(mesh, tiles="auto", density=80.0)]).tiles == 1
    assert map_report([packed_again(mesh, tiles="auto", density=200.0)]).tiles == 9
    with pytest.raises(ValueError, match="9 islands have no room in a tile; make them or the margin smaller"):
        packed_again(squares(*[((0.0, 0.0), 2.0)] * 9), tiles="auto", keep_overlaps=False)


def test_small_islands_are_enlarged_and_borders_lie_between_pixels():
    mesh = squares(*[((0.07 * k, 0.5), 0.05) for k in range(9)], ((0.9, 0.1), 0.0005))
    plain = packed_again(mesh)
    found = packed_again(mesh, min_size=6.0, snap=True)
    sides = [256 * np.linalg.norm(each[1] - each[0]) for each in np.split(found.corner_uv, 10)]
    assert 256 * np.linalg.norm(plain.corner_uv[-3] - plain.corner_uv[-4]) < 2.0
    assert 5.5 <= sides[-1] <= 7.5
    assert np.array_equal(256 * found.corner_uv, np.round(256 * found.corner_uv))


def test_the_report_says_how_many_tiles(tmp_path):
    write_cube(tmp_path)
    values = {"texel_density": 100.0, "texture_size": 256, "udim": "auto", "seams": "sharp"}
    source = str(tmp_path / "in" / "cube.obj")
    request = task.Request("cube.obj", source, str(tmp_path), str(tmp_path / "b.obj"), {})
    report = task.run(replace(request, settings=settings.from_values(values).as_json()))
    # Each side has 200 pixels and needs a tile of its own.
    assert (report["status"], report["totals"]["tiles"]) == ("unwrapped", 6)
    assert report["totals"]["uv_per_length"] == pytest.approx(100 / 256, rel=1e-5)
    values["texel_density"] = 200.0
    report = task.run(replace(request, settings=settings.from_values(values).as_json()))
    assert report["failure"] == {
        "kind": "error",
        "message": "a density of 200 pixels per unit is too high: 6 islands have no room in a tile; make them or the "
        "margin smaller.",
    }


def test_a_batch_packs_existing_maps_at_a_density_or_in_their_sizes(tmp_path):
    write_cube(tmp_path)
    source, mapped = str(tmp_path / "in" / "cube.obj"), str(tmp_path / "b.obj")
    base = {"texture_size": 256, "seams": "sharp"}
    request = task.Request("cube.obj", source, str(tmp_path), mapped, settings.from_values(base).as_json())
    assert task.run(request)["status"] == "unwrapped"
    for values, density in (({"texel_density": 100.0}, 100.0), ({}, None)):
        values = {**base, "udim": "auto", "unwrap": False, **values}
        again = replace(request, source=mapped, settings=settings.from_values(values).as_json())
        report = task.run(replace(again, target=str(tmp_path / "c.obj")))
        assert (report["status"], report["totals"]["tiles"]) == ("kept", 6 if density else 1), report
        if density:
            assert report["totals"]["uv_per_length"] == pytest.approx(density / 256, rel=1e-5)


@pytest.mark.parametrize(("text", "materials"), [("", [-1, -1]), ("usemtl a\n", [0, 0])])
def test_the_material_of_a_mesh_with_one_is_known(text, materials, tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n" + text + "f 1 2 3\nf 2 4 3\n")
    (mesh,) = assets.read(path).meshes
    assert mesh.materials().tolist() == materials
    assert replace(mesh, material_of_face=np.array([3, 4])).materials().tolist() == [3, 4]


def test_the_materials_of_usd_are_those_of_meshes_and_subsets(tmp_path):
    pytest.importorskip("pxr")
    path = tmp_path / "a.usda"
    mesh = (
        'def Mesh "{name}" (prepend apiSchemas = ["MaterialBindingAPI"]) {{\n'
        "  int[] faceVertexCounts = [3, 3]\n  int[] faceVertexIndices = [0, 1, 2, 1, 3, 2]\n"
        "  point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]\n{more}}}\n"
    )
    subset = (
        '  def GeomSubset "part" (prepend apiSchemas = ["MaterialBindingAPI"]) {\n'
        '    uniform token elementType = "face"\n'
        '    uniform token familyName = "materialBind"\n    int[] indices = [1]\n'
        "    rel material:binding = </second>\n  }\n"
    )
    path.write_text(
        '#usda 1.0\ndef Material "first" {}\ndef Material "second" {}\n'
        + mesh.format(name="one", more="  rel material:binding = </first>\n" + subset)
        + mesh.format(name="other", more="  rel material:binding = </second>\n")
        + mesh.format(name="bare", more="")
    )
    found = [each.materials().tolist() for each in assets.read(path).meshes]
    assert found[0][0] != found[0][1] and found[1] == [found[0][1]] * 2 and found[2] == [-1, -1]


def test_textures_are_told_apart_in_a_format_without_materials(tmp_path):
    """Two sheets of a USD file with a material each, written as OBJ, which then has only the meshes."""
    pytest.importorskip("pxr")
    points, quads = grid(4, 0.1, 1)
    text = "#usda 1.0\n"
    for k in range(2):
        text += f'def Material "m{k}" {{}}\ndef Mesh "mesh{k}" (prepend apiSchemas = ["MaterialBindingAPI"]) {{\n'
        text += f"  int[] faceVertexCounts = {[4] * len(quads)}\n  int[] faceVertexIndices = {quads.ravel().tolist()}\n"
        text += f"  point3f[] points = {[tuple(point) for point in points.tolist()]}\n"
        text += f"  rel material:binding = </m{k}>\n}}\n"
    (tmp_path / "a.usda").write_text(text)
    wanted = settings.from_values({"pack_by": "material"}).as_json()
    report = task.run(task.Request("a", str(tmp_path / "a.usda"), str(tmp_path), str(tmp_path / "b.obj"), wanted))
    assert (report["status"], report["totals"]["tiles"], report["totals"]["overlaps"]) == ("unwrapped", 2, 0)
