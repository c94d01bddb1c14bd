# SPDX-License-Identifier: GPL-3.0-or-later
"""One asset of a batch: its report has everything that happens."""

import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import assets
from spectral_conformal.batch import command, entries, overview, report_file, settings, task
from spectral_conformal.batch.blender import fbx_inventory

from tests.module import batch_assets, meshes, test_batch_formats, test_gltf


def request_for(folder):
    batch_assets.write_obj(folder / "a.obj", *batch_assets.grid(4, 0.2, 1))
    values = settings.from_values({}).as_json()
    return task.Request("a.obj", str(folder / "a.obj"), str(folder), str(folder / "b.obj"), values)


@pytest.mark.parametrize("error", [ValueError("no {0} of it"), KeyError("mesh"), AssertionError(), RecursionError()])
def test_an_error_that_nobody_expected_is_in_the_report(error, tmp_path, monkeypatch):
    def fail(*_):
        raise error

    monkeypatch.setattr(task._Work, "solve", fail)
    report = task.run(request_for(tmp_path))
    assert report["status"] == "failed"
    assert report["failure"] == {"kind": "error", "message": f"{type(error).__name__}: {error}"}
    assert (tmp_path / "report.json").is_file()


def test_too_little_memory_is_a_kind_of_its_own(tmp_path, monkeypatch):
    def fail(*_):
        raise MemoryError

    monkeypatch.setattr(task.files, "read", fail)
    report = task.run(request_for(tmp_path))
    assert report["failure"] == {"kind": "memory", "message": "there is too little memory"}


def test_a_mesh_whose_seams_cannot_be_found_for_want_of_memory_fails_alone(tmp_path, monkeypatch):
    """Cut where the file is cut, and said; here one mesh of an open sheet, which needs no seams."""
    real = task.cut

    def fail(mesh, cutting):
        if cutting.seams == "suggest":
            raise MemoryError
        return real(mesh, cutting)

    monkeypatch.setattr(task, "cut", fail)
    report = task.run(request_for(tmp_path))
    assert report["status"] == "unwrapped"
    assert report["warnings"] == ["No seams were found: there is too little memory for it."]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ([""], "Seams were suggested, since there is no UV map with islands to merge."),
        (["One", "Two"], "One, Two: seams were suggested, since there is no UV map with islands to merge."),
        ("ABCDEFG", "A, B, C, D and 3 more: seams were suggested, since there is no UV map with islands to merge."),
    ],
)
def test_without_a_map_to_merge_seams_are_suggested(names, said):
    """Of closed surfaces, which need some, with a warning for all meshes together."""
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    tetrahedron = meshes.polygons(np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]))
    given = [assets.AssetMesh(points, *tetrahedron, None, name) for name in names]
    warnings = []
    found = task._cut(given, settings.from_values({"seams": "merge"}), warnings)
    assert all(len(each.seam_edges) for each in found)
    assert warnings == [said]


@pytest.mark.parametrize(
    ("new", "said"),
    [
        (b"#", "b.obj was not written, since it would lack 1 of 16 faces of the source."),
        (b"f 1 2 3\nf 1", "The source has 1 meshes with 16 faces, the result 1 meshes with 17 faces: "),
    ],
)
def test_a_result_with_other_faces_than_the_source_is_a_failure(new, said, tmp_path, monkeypatch):
    real = assets.obj.ObjAsset.with_uv
    monkeypatch.setattr(assets.obj.ObjAsset, "with_uv", lambda *a: (part.replace(b"f 1", new, 1) for part in real(*a)))
    report = task.run(request_for(tmp_path))
    assert report["status"] == "failed"
    assert report["failure"]["message"].startswith(said)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_memory_that_an_earlier_asset_has_freed_is_not_of_the_next():
    # Blocks that the C library keeps, since one behind them is in use.
    program = """
from spectral_conformal.batch import memory
blocks = [bytes(600) for _ in range(300_000)]
last = bytes(600)
memory.reset_peak()
full = memory.peak()
del blocks
memory.reset_peak()
print(full - memory.peak() > 100 << 20)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True"


def write_usd(path, points, faces):
    """Write USD of any suffix; a package has its layer inside."""
    from pxr import Sdf, UsdUtils

    text = path.with_name("layer.usda")
    batch_assets.write_usd(text, points, faces)
    layer = path.with_name("layer.usdc")
    Sdf.Layer.FindOrOpen(str(text)).Export(str(layer if path.suffix == ".usdz" else path))
    if path.suffix == ".usdz":
        assert UsdUtils.CreateNewUsdzPackage(str(layer), str(path))
    for each in (text, layer):
        each.unlink(missing_ok=True)


def write_gltf_beside(path, points, faces):
    """Write glTF with a buffer of its own."""
    test_batch_formats.write_gltf(path, points, faces)
    build = test_gltf.Builder()
    primitive = {"attributes": {"POSITION": build.accessor(points)}}
    primitive["indices"] = build.accessor(meshes.triangles_of(faces).reshape(-1, 1), "u4")
    build.json |= {"meshes": [{"primitives": [primitive]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
    build.json["buffers"] = [{"byteLength": len(build.buffer)}]
    test_gltf.save(path, build, "beside")


IN_PLACE = {
    "a.obj": batch_assets.write_obj,
    "a.ply": batch_assets.write_ply,
    "a.glb": test_batch_formats.write_gltf,
    "embedded.gltf": test_batch_formats.write_gltf,
    "beside.gltf": write_gltf_beside,
    **dict.fromkeys(("a.usda", "a.usdc", "a.usdz"), write_usd),
}


@pytest.mark.parametrize("name", IN_PLACE)
@pytest.mark.parametrize("fault", ["map", "content"])
def test_a_source_stays_until_the_result_has_been_read_back(name, fault, tmp_path, monkeypatch):
    """A writer with a fault writes another map, or what no reader reads."""
    if name.partition(".")[2].startswith("usd"):
        pytest.importorskip("pxr")
    folder, source = tmp_path / "out", tmp_path / "in" / name
    for each in (folder, source.parent):
        each.mkdir()
    IN_PLACE[name](source, *batch_assets.grid(4, 0.2, 1))
    before = {path.name: path.read_bytes() for path in source.parent.iterdir()}
    files = assets._files

    def wrong(path, asset, maps, textures):
        found = files(path, asset, [assets.UvMap(each.uv + 0.25, each.mapped) for each in maps], textures)
        if fault == "map":
            return found
        return {each: [b"".join(content)[:-200]] if each == path else content for each, content in found.items()}

    request = task.Request(name, str(source), str(folder), str(source), settings.from_values({}).as_json())
    with monkeypatch.context() as patched:
        patched.setattr(assets, "_files", wrong)
        report = task.run(request)
    assert report["status"] == "failed"
    message = report["failure"]["message"]
    assert fault == "content" or message == f"{source}: its map does not read back as written."
    assert ".partial" not in message, message
    assert {path.name: path.read_bytes() for path in source.parent.iterdir()} == before
    # Without the fault, it is written over.
    assert task.run(request)["status"] == "unwrapped"
    assert source.read_bytes() != before[name] and assets.read(source).meshes[0].has_uv().all()


ONE = "f {0} {1} {2} {3}\n"
# The lines of each quad, those of the first one alone, and how many faces have the vertices of another one.
TWO_SIDED = {
    "card": (ONE + "f {3} {2} {1} {0}\n", "", 32),
    "one back": (ONE, "f {3} {2} {1} {0}\n", 2),
    "twice": (ONE + ONE, "", 32),
    "one side": (ONE, "", 0),
}


@pytest.mark.parametrize("name", TWO_SIDED)
@pytest.mark.parametrize("unwrap", [True, False])
def test_faces_back_to_back_are_counted_and_said(name, unwrap, tmp_path):
    each, of_first, doubles = TWO_SIDED[name]
    points, quads = batch_assets.grid(4, 0.0, 1)
    rows = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
    rows += "".join(each.format(*quad) for quad in (quads + 1).tolist()) + of_first.format(*(quads[0] + 1))
    (tmp_path / "a.obj").write_text(rows)
    values = {"picture_size": 0, "seams": "keep"}
    for number in range(1 if unwrap else 2):
        chosen = settings.from_values({**values, "unwrap": number == 0}).as_json()
        report = task.run(
            task.Request("a.obj", str(tmp_path / "a.obj"), str(tmp_path), str(tmp_path / "a.obj"), chosen)
        )
        assert report["totals"]["overlaps"] == doubles
    said = f"{doubles} of {report['totals']['faces']} faces have the vertices of another one, such as a back, and its "
    assert report["warnings"] == ([said + "place in the map."] if doubles and unwrap else [])


NO_MESH = {
    "points.obj": "v 0 0 0\nv 1 0 0\np 1 2\n",
    "lines.gltf": '{"asset": {"version": "2.0"}, "meshes": []}',
    "cloud.ply": "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    "end_header\n0 0 0\n",
    "empty.stl": "solid\nendsolid\n",
    "empty.off": "OFF\n0 0 0\n",
    "empty.ply": "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 0\nproperty list uchar int vertex_indices\nend_header\n",
}


@pytest.mark.parametrize("name", NO_MESH)
def test_what_is_no_mesh_is_skipped(name, tmp_path):
    source, out = tmp_path / "in" / name, tmp_path / "out"
    for folder in (source.parent, out):
        folder.mkdir()
    source.write_text(NO_MESH[name])
    report = task.run(task.Request(name, str(source), str(out), str(out / name), {}))
    assert (report["status"], report["failure"]["kind"]) == ("skipped", "no mesh")
    assert report_file.read(out) == report
    batch_assets.write_obj(source.with_name("good.obj"), *batch_assets.grid(4, 0.2, 1))
    wanted = command.plan([str(source.parent), "--out", str(out)])
    reports = {name: report, "good.obj": {"status": "unwrapped"}}
    assert command._exit_code(wanted, reports) == command.ALL_WORKED
    assert "1 of 1 assets worked, 1 skipped" in command._ending(wanted, reports, 0)
    assert command._exit_code(wanted, {name: report}) == command.NONE_WORKED


@pytest.mark.parametrize(("seams", "number"), [("keep", 1), ("suggest", 0)])
def test_islands_whose_sizes_vary_are_a_warning(seams, number, tmp_path):
    source = tmp_path / "tube.obj"
    batch_assets.write_obj(source, *meshes.tube(16, 9))
    values = settings.from_values({"seams": seams}).as_json()
    report = task.run(task.Request("tube.obj", str(source), str(tmp_path), str(tmp_path / "b.obj"), values))
    assert report["status"] == "unwrapped"
    assert [said.startswith("1 island varies in size by") for said in report["warnings"]] == [True] * number


def test_warnings_are_in_the_overview_and_may_be_required(tmp_path):
    request = request_for(tmp_path)
    (tmp_path / "a.obj").write_text((tmp_path / "a.obj").read_text() + "f 1 2 2\n")
    wanted = command.plan([str(tmp_path / "a.obj"), "--out", str(tmp_path / "out"), "--require", "warnings == 0"])
    report = command._completed(wanted.entries[0], task.run(request), wanted)
    assert report["warnings"] == ["1 of 17 faces have no area."]
    assert report["not_met"] == ["warnings == 0, but warnings is 1"]
    assert overview.row(report)["warnings"] == report["warnings"][0]
    wanted = command.plan([str(tmp_path / "a.obj"), "--out", str(tmp_path / "out"), "--require", "seam_length < 9"])
    assert command._completed(wanted.entries[0], report, wanted)["not_met"] == []
    with pytest.raises(settings.SettingsError, match="--require: '' is not a comparison"):
        command.plan([str(tmp_path / "a.obj"), "--out", str(tmp_path / "out"), "--require", ""])


def test_large_textures_that_are_empty_for_the_most_part_are_a_warning():
    """Materials share one map, so that each has a texture with room for all."""
    sparse = {"width": 8192, "height": 8192, "covered": 0.01}
    (said,) = task._on_textures([sparse] * 9)
    assert said == (
        "The 9 drawn textures have 604 million texels, of which islands cover 1 %: with --pack-by material, each "
        "material has a map of its own."
    )
    assert task._on_textures([sparse] * 4) == []
    assert task._on_textures([{**sparse, "covered": 0.6}] * 9) == []
    assert task._on_textures([]) == []


def test_the_pattern_is_written_in_the_unit_of_the_asset(tmp_path):
    pytest.importorskip("ezdxf")
    request = request_for(tmp_path)
    values = settings.from_values({"svg": True, "dxf": True, "unit": "in", "seams": "keep"}).as_json()
    report = task.run(replace(request, settings=values))
    assert report["pattern"] == {"files": ["pattern.svg", "pattern.dxf"], "seams": []}
    width = float(re.search(r'width="([\d.]+)mm"', (tmp_path / "pattern.svg").read_text())[1])
    # A bumpy square whose sides are 2 and some more.
    assert 2.0 * 25.4 < width < 3.0 * 25.4
    assert (tmp_path / "pattern.dxf").read_text().startswith("  0\nSECTION")
    assert report["totals"]["uv_per_length"] == pytest.approx(report["islands"][0]["density"], rel=1e-2)
    command._clean(entries.Entry("a.obj", tmp_path / "a.obj", tmp_path, tmp_path / "b.obj"))
    assert not list(tmp_path.glob("pattern.*"))


def test_without_its_library_a_drawing_fails_before_anything_is_written(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    request = replace(request_for(tmp_path), settings=settings.from_values({"dxf": True}).as_json())
    report = task.run(request)
    assert (report["status"], report["failure"]["kind"]) == ("failed", "error")
    assert "pip install" in report["failure"]["message"] and not (tmp_path / "b.obj").exists()


def test_a_map_without_area_has_no_pattern_and_a_warning(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\nf 1/1 2/1 3/1\n")
    values = settings.from_values({"svg": True, "unwrap": False, "seams": "keep", "pack": "none"}).as_json()
    request = task.Request("a.obj", str(tmp_path / "a.obj"), str(tmp_path), str(tmp_path / "b.obj"), values)
    report = task.run(request)
    assert report["status"] == "kept" and "pattern" not in report
    assert any(said.startswith("There is no pattern: ") for said in report["warnings"])


def test_the_report_has_the_lengths_of_both_sides_of_seams(tmp_path):
    batch_assets.write_obj(tmp_path / "a.obj", *batch_assets.torus(14, 9))
    values = settings.from_values({"svg": True}).as_json()
    report = task.run(task.Request("a.obj", str(tmp_path / "a.obj"), str(tmp_path), str(tmp_path / "b.obj"), values))
    totals, seams = report["totals"], report["pattern"]["seams"]
    assert [seam["number"] for seam in seams] == list(range(1, len(seams) + 1))
    assert all(len(seam["sides"]) == 2 for seam in seams)
    assert sum(seam["length"] for seam in seams) == pytest.approx(totals["seam_length"], rel=1e-6)
    assert 0.0 < totals["seam_error"] < 0.5
    # What holds for edges bounds what holds for whole seams.
    mismatch = sum(abs(seam["sides"][0] - seam["sides"][1]) for seam in seams) / totals["seam_length"]
    assert 0.0 <= mismatch <= totals["seam_mismatch"] + 1e-12
    wanted = command.plan([str(tmp_path / "a.obj"), "--out", str(tmp_path / "out"), "--require", "seam_error < 0"])
    (missed,) = command._completed(wanted.entries[0], report, wanted)["not_met"]
    assert missed.startswith("seam_error < 0, but seam_error is 0.")


@pytest.mark.parametrize(("unit", "meters", "width"), [("auto", None, 2.0), ("auto", 1.0, 2000.0), ("cm", 1.0, 20.0)])
def test_lengths_are_those_of_the_file_unless_the_unit_is_named(unit, meters, width):
    corners = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)]
    pattern = sc.pattern(sc.Mesh(np.array(corners, float), [[0, 1, 2, 3]], np.array(corners, float)[:, :2] / 8))
    drawn = settings.from_values({"svg": True, "unit": unit}).drawings(pattern, meters)
    assert f'width="{width + 0.2:.17g}mm"' in drawn[".svg"] and list(drawn) == [".svg"]
    with pytest.raises(settings.SettingsError, match="unit must be auto, mm, cm, m, in, ft, not 'yard'"):
        settings.from_values({"unit": "yard"})


def test_a_first_map_of_an_fbx_file_is_no_surprise():
    before, after = Counter({"Mesh Geometry": 1}), Counter({"Mesh Geometry": 1, "layer element uv": 1, "AnimCurve": 2})
    assert fbx_inventory.lost(before, after) == ["FBX through Blender: 2 AnimCurve were added."]
    assert fbx_inventory.lost(after, before) == [
        "FBX through Blender: 0 of 2 AnimCurve are left.",
        "FBX through Blender: 0 of 1 layer element uv are left.",
    ]
