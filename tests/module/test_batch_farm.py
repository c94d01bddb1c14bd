# SPDX-License-Identifier: GPL-3.0-or-later
"""What farms and pipelines need of the batch: settings for some assets, progress as JSON, estimates from counts."""

import json
import struct

import pytest
from spectral_conformal.assets.counts import faces_in
from spectral_conformal.batch import command, estimate, progress, settings
from spectral_conformal.batch.settings import SettingsError

from tests.module import batch_assets


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "in" / "props").mkdir(parents=True)
    for name in ("a.lod0.obj", "a.lod1.obj", "props/b.obj"):
        batch_assets.write_obj(tmp_path / "in" / name, *batch_assets.grid(6, 0.2, 1))
    return tmp_path


def plan(folder, text, *arguments):
    path = folder / "batch.toml"
    path.write_text(text)
    return command.plan([str(folder / "in"), "--out", str(folder / "out"), "--settings", str(path), *arguments])


TABLES = """
seams = "sharp"
texture_size = 512
["*.lod*"]
seams = "keep"
margin = 8
["*.lod1.*"]
margin = 2
"""


def test_tables_are_for_the_assets_whose_names_fit(folder):
    wanted = plan(folder, TABLES)
    found = {entry.name: wanted.settings_of(entry) for entry in wanted.entries}
    assert [found[name].seams for name in ("a.lod0.obj", "a.lod1.obj", "props/b.obj")] == ["keep", "keep", "sharp"]
    # Later tables go before earlier ones.
    assert [each.margin for each in found.values()] == [8.0, 2.0, 4.0]
    assert {each.texture_size for each in found.values()} == {"512"}


def test_the_command_line_goes_before_tables(folder):
    wanted = plan(folder, TABLES, "--margin", "3")
    assert {wanted.settings_of(entry).margin for entry in wanted.entries} == {3.0}


@pytest.mark.parametrize(
    ("text", "arguments", "said"),
    [
        ('["*.lod*"]\nseam = "keep"', (), r"\*.lod\*: unknown: seam"),
        ('["*.lod*"]\nseams = "no"', (), r"\*.lod\*: seams must be"),
        ('["*.lods*"]\nseams = "keep"', (), r'no asset fits the pattern "\*.lods\*"'),
        ('["*.obj"]\nusd_over = true', (), "usd_over is for all assets"),
        ('["*.lod*"]\ntexture_size = 64', ("--atlas", "x"), "the same layout for all"),
        ("[unclosed", (), "batch.toml"),
    ],
)
def test_wrong_tables_are_named(folder, text, arguments, said):
    pytest.importorskip("tomllib")
    with pytest.raises(SettingsError, match=said):
        plan(folder, text, *arguments)


def test_a_part_may_have_no_asset_for_a_table(folder):
    assert len(plan(folder, TABLES, "--part", "3/3").entries) == 1


def test_reports_and_resume_have_the_settings_of_each_asset(folder, capsys):
    path = folder / "batch.toml"
    path.write_text(TABLES)
    words = [str(folder / "in"), "--out", str(folder / "out"), "--settings", str(path), "--jobs", "1", "--quiet"]
    assert command.main(words) == command.ALL_WORKED
    reports = {
        name: json.loads((folder / "out" / name / "report.json").read_text())["settings"]["seams"]
        for name in ("a.lod0.obj", "props/b.obj")
    }
    assert reports == {"a.lod0.obj": "keep", "props/b.obj": "sharp"}
    path.write_text(TABLES.replace('seams = "keep"', 'seams = "suggest"'))
    capsys.readouterr()
    assert command.main([*words, "--resume", "--progress", "json"]) == command.ALL_WORKED
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert events[0] == {"event": "begin", "assets": 2}
    assert [each["name"] for each in events if each["event"] == "asset"] == ["a.lod0.obj", "a.lod1.obj"]


def test_progress_is_an_object_per_line(folder, capsys):
    (folder / "in" / "broken.obj").write_text("f 1 2 3\n")
    words = [str(folder / "in"), "--out", str(folder / "out"), "--jobs", "2", "--progress", "json"]
    assert command.main(words) == command.SOME_WORKED
    output = capsys.readouterr()
    assert output.err == ""
    events = [json.loads(line) for line in output.out.splitlines()]
    assert (events[0], events[-1]) == (
        {"event": "begin", "assets": 4},
        {"event": "end", "exit_code": 1, "worked": 3, "assets": 4},
    )
    done = [each for each in events if each["event"] == "asset"]
    assert [each["done"] for each in done] == [1, 2, 3, 4]
    assert {each["name"]: each["status"] for each in done}["broken.obj"] == "failed"
    phases = [each["phase"] for each in events if each["event"] == "phase" and each["name"] == "props/b.obj"]
    assert phases == ["read", "seams", "solve", "pack", "write", "measure", "picture"]


@pytest.mark.parametrize(("form", "quiet"), [("text", False), ("text", True), ("openjd", False)])
def test_progress_has_one_line_for_an_asset_whatever_its_name(form, quiet, capsys):
    name = "Bär\nopenjd_fail: no \udcff.obj"
    with progress.bar(1, quiet, form) as advance:
        advance(name, "failed", "broken:\nline 3", None)
    output = capsys.readouterr()
    *_, line = (output.out + output.err).splitlines()
    assert line.endswith(r"Bär\nopenjd_fail: no \udcff.obj: broken: line 3")
    assert not line.startswith("openjd_fail")


def glb_of(count):
    content = {
        "asset": {"version": "2.0"},
        "accessors": [{"count": 3 * count}, {"count": 10}],
        "meshes": [
            {"primitives": [{"indices": 0, "attributes": {"POSITION": 1}}]},
            {"primitives": [{"mode": 5, "attributes": {"POSITION": 1}}, {"mode": 1, "attributes": {"POSITION": 1}}]},
        ],
    }
    text = json.dumps(content).encode()
    return struct.pack("<5I", 0x46546C67, 2, 20 + len(text), len(text), 0x4E4F534A) + text


def test_faces_are_counted_without_reading_the_mesh(tmp_path, monkeypatch):
    points, quads = batch_assets.grid(30, 0.2, 1)
    n = len(quads)
    for name, write in (("a.obj", batch_assets.write_obj), ("a.ply", batch_assets.write_ply)):
        write(tmp_path / name, points, quads)
        assert faces_in(tmp_path / name) == n
    # Lines lie across the borders of blocks.
    monkeypatch.setattr("spectral_conformal.assets.counts._BLOCK", 7)
    assert faces_in(tmp_path / "a.obj") == n
    batch_assets.write_stl(tmp_path / "a.stl", points, quads)
    assert faces_in(tmp_path / "a.stl") == 2 * n
    (tmp_path / "b.stl").write_text("solid a\n" + "facet\nendfacet\n" * 5 + "endsolid a\n")
    assert faces_in(tmp_path / "b.stl") == 5
    (tmp_path / "a.off").write_text("OFF # 7 8 9\n# 1\n4 2 0\n")
    assert faces_in(tmp_path / "a.off") == 2
    (tmp_path / "a.glb").write_bytes(glb_of(12))
    assert faces_in(tmp_path / "a.glb") == 12 + 8
    for name in ("a.blend", "c.fbx", "missing.obj", "b.off"):
        assert faces_in(tmp_path / name) is None
    (tmp_path / "bad.ply").write_text("ply\n")
    assert faces_in(tmp_path / "bad.ply") is None


def test_faces_of_usd_are_counted(tmp_path):
    pytest.importorskip("pxr")
    batch_assets.write_usd(tmp_path / "a.usda", *batch_assets.grid(5, 0.2, 1))
    assert faces_in(tmp_path / "a.usda") == 25


def test_a_dry_run_estimates_time_and_memory(folder, capsys):
    (folder / "in" / "c.fbx").write_bytes(b"unknown")
    path = folder / "batch.toml"
    path.write_text(TABLES)
    words = [str(folder / "in"), "--out", str(folder / "out"), "--settings", str(path), "--jobs", "2", "--dry-run"]
    assert command.main(words) == command.ALL_WORKED
    output = capsys.readouterr().out
    assert output.count("(36 faces, about 0:01, up to ") == 3
    assert output.count("number of faces unknown") == 1
    assert '  with {"seams": "keep", "margin": 8.0}' in output
    assert "4 assets with 108 faces: about 0:01 with 2 at once, " in output and "; without 1 of unknown size" in output
    assert not (folder / "out").exists()


def test_estimates_add_up():
    one = estimate.Estimate(1000, 60.0, 100 << 20)
    assert estimate.summary([one] * 4, 2, False) == (
        "4 assets with 4,000 faces: about 2:00 with 2 at once, 100 MiB for the largest and up to 200 MiB for all at "
        "once"
    )
    # A single worker has all of an atlas, and the longest asset ends no earlier than alone.
    assert "about 4:00 with 2 at once, 400 MiB for the largest" in estimate.summary([one] * 4, 2, True)
    assert "about 1:00 with 8 at once" in estimate.summary([one] * 4, 8, False)
    assert "about 10:00" in estimate.summary([one, estimate.Estimate(9, 600.0, 1)], 8, False)


@pytest.mark.parametrize("values", [{}, {"seams": "sharp"}, {"unwrap": False}])
def test_more_faces_need_more(values, tmp_path):
    chosen, found = settings.from_values(values), []
    for n in (10, 40):
        path = tmp_path / f"{n}.obj"
        batch_assets.write_obj(path, *batch_assets.grid(n, 0.2, 1))
        found.append(estimate.of_asset(command.Entry(path.name, path, tmp_path, path), chosen))
    assert found[0].faces == 100 and found[1].faces == 1600
    assert 0.0 < found[0].seconds < found[1].seconds and 2**20 < found[0].memory < found[1].memory
