# SPDX-License-Identifier: GPL-3.0-or-later
"""Several assets in one texture: each file has its share, nothing overlaps, and broken assets take no share."""

import json

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.assets.report import Measurement
from spectral_conformal.batch import command, settings, task

from tests.module import batch_assets
from tests.module import textured_assets as made

NAMES = ("a.obj", "deep/b.ply", "c.usda")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "in" / "deep").mkdir(parents=True)
    batch_assets.write_obj(tmp_path / "in" / "a.obj", *batch_assets.grid(6, 0.2, 1))
    batch_assets.write_ply(tmp_path / "in" / "deep" / "b.ply", *batch_assets.torus(12, 8))
    batch_assets.write_usd(tmp_path / "in" / "c.usda", *batch_assets.grid(5, 0.3, 2))
    return tmp_path


def run(folder, *arguments, out="out"):
    return command.main([str(folder / "in"), "--out", str(folder / out), "--jobs", "1", "--quiet", *arguments])


def report_of(folder, name, out="out"):
    return json.loads((folder / out / name / "report.json").read_text())


def written(folder, name, out="out"):
    return assets.read(folder / out / name / name.rpartition("/")[2]).meshes


def test_every_asset_gets_its_share_of_one_texture(folder):
    pytest.importorskip("pxr")
    assert run(folder, "--atlas", "props") == command.ALL_WORKED
    meshes = [mesh for name in NAMES for mesh in written(folder, name)]
    whole = Measurement(meshes).report()
    assert (whole.overlaps, whole.flips, whole.tiles) == (0, 0, 1)
    assert whole.fill > 0.5
    # One density for all, but for bumps, whose area in the map is that of the surface only on average.
    assert whole.density_spread == pytest.approx(
        max(Measurement(written(folder, name)).report().density_spread for name in NAMES), abs=0.05
    )
    densities = [report_of(folder, name)["totals"]["uv_per_length"] for name in NAMES]
    assert densities == pytest.approx([densities[0]] * 3, rel=1e-3)
    reports = [report_of(folder, name) for name in NAMES]
    assert [report["status"] for report in reports] == ["unwrapped"] * 3
    assert {json.dumps(report["atlas"]) for report in reports} == {
        json.dumps({"assets": sorted(NAMES), "name": "props"})
    }
    assert (folder / "out" / "props.png").read_bytes().startswith(b"\x89PNG")
    assert sum(report["totals"]["fill"] for report in reports) == pytest.approx(whole.fill)


def test_a_broken_asset_takes_no_share_and_fails_alone(folder):
    (folder / "in" / "c.usda").unlink()
    (folder / "in" / "broken.obj").write_text("v 0 0 0\nf 1 2 3\n")
    assert run(folder, "--atlas", "props") == command.SOME_WORKED
    assert report_of(folder, "broken.obj")["failure"]["kind"] == "error"
    assert report_of(folder, "a.obj")["atlas"]["assets"] == ["a.obj", "deep/b.ply"]
    assert report_of(folder, "a.obj")["status"] == "unwrapped"


def test_it_is_resumed_as_a_whole(folder, capsys):
    (folder / "in" / "c.usda").unlink()
    arguments = ("--atlas", "props", "--resume")
    assert run(folder, *arguments) == command.ALL_WORKED
    first = [report_of(folder, name) for name in NAMES[:2]]
    assert run(folder, *arguments) == command.ALL_WORKED
    assert [report_of(folder, name) for name in NAMES[:2]] == first
    batch_assets.write_obj(folder / "in" / "d.obj", *batch_assets.grid(4, 0.1, 3))
    assert run(folder, *arguments) == command.ALL_WORKED
    again = [report_of(folder, name) for name in (*NAMES[:2], "d.obj")]
    assert {tuple(report["atlas"]["assets"]) for report in again} == {("a.obj", "d.obj", "deep/b.ply")}
    # Alone they are not what they are in the atlas.
    assert run(folder, "--resume") == command.ALL_WORKED
    assert not any("atlas" in report_of(folder, name) for name in NAMES[:2])


def test_existing_maps_are_packed_together(folder):
    (folder / "in" / "c.usda").unlink()
    assert run(folder) == command.ALL_WORKED
    (folder / "again").mkdir()
    for name in NAMES[:2]:
        short = name.rpartition("/")[2]
        (folder / "again" / short).write_bytes((folder / "out" / name / short).read_bytes())
    arguments = [str(folder / "again"), "--out", str(folder / "packed"), "--jobs", "1", "--quiet", "--no-unwrap"]
    assert command.main([*arguments, "--atlas", "both", "--seams", "keep"]) == command.ALL_WORKED
    meshes = [mesh for name in ("a.obj", "b.ply") for mesh in written(folder, name, "packed")]
    assert Measurement(meshes).report().overlaps == 0
    assert report_of(folder, "a.obj", "packed")["status"] == "kept"


def test_the_whole_fails_where_there_is_no_room(folder):
    (folder / "in" / "c.usda").unlink()
    assert run(folder, "--atlas", "props", "--texel-density", "4000") == command.NONE_WORKED
    messages = {report_of(folder, name)["failure"]["message"] for name in NAMES[:2]}
    assert len(messages) == 1 and "a density of 4000 pixels per unit needs about" in messages.pop()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--atlas", "a/b"), "--atlas must be a name"),
        (("--atlas", ""), "--atlas must be a name"),
        (("--atlas", "a", "--part", "1/2"), "exclude each other"),
        (("--atlas", "a", "--pack-by", "object"), "--pack-by asset"),
        (("--atlas", "a", "--no-pack"), "needs --pack"),
    ],
)
def test_what_an_atlas_cannot_be(folder, arguments, said, capsys):
    assert run(folder, *arguments) == command.WRONG_USE
    assert said in capsys.readouterr().err


def test_assets_that_are_unwrapped_do_not_mix_with_kept_ones(folder):

    requests = []
    for name, unwrap in (("a.obj", True), ("b.obj", False)):
        batch_assets.write_obj(folder / name, *batch_assets.grid(4, 0.2, 1))
        path = str(folder / name)
        if not unwrap:
            values = settings.from_values({}).as_json()
            task.run(task.Request(name, path, str(folder), path, values))
        values = settings.from_values({"unwrap": unwrap}).as_json()
        requests.append(task.Request(name, path, str(folder), str(folder / f"new_{name}"), values))
    reports = task.run_atlas(task.Atlas("x", "", requests))
    assert {report["failure"]["message"] for report in reports} == {
        "All assets of an atlas are unwrapped, or none: no-unwrap must be the same for all."
    }
    assert reports[0]["seconds"]["total"] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("options", [("--atlas", "both"), ("--pack-by", "material"), ("--pack-by", "object")])
def test_textures_drawn_anew_look_the_same(options, tmp_path):
    pytest.importorskip("OpenImageIO")
    (tmp_path / "in").mkdir()
    for name, seed in (("one", 1), ("other", 2)):
        asset = made.Textured()
        for k in range(2):
            color = asset.texture(made.encoded(made.painted(128, 192, 3, seed + 5 * k)))
            material = asset.material(name=str(k), pbrMetallicRoughness={"baseColorTexture": {"index": color}})
            asset.add(made.moved(made.sphere(), (2.5 * k, 0.0, 0.0)), material)
        asset.save(tmp_path / "in" / f"{name}.glb")
    assert run(tmp_path, *options, "--rebake", "--texture-size", "1024") == command.ALL_WORKED
    for name in ("one.glb", "other.glb"):
        before, after = made.render(tmp_path / "in" / name), made.render(tmp_path / "out" / name / name)
        found = np.abs(before[0] - after[0])[before[1]]
        assert found.mean(axis=0).max() < 1 and np.percentile(found, 99.9) < 8
