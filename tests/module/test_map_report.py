# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m spectral_conformal report: the numbers of an existing map, and requirements on them."""

import json

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.__main__ import main
from spectral_conformal.assets.report import MapReport, Requirement, RequirementError, map_report

SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)


def mesh_of(squares, uv, scale=1.0):
    """Squares of these sides, apart, with the UVs of each, (4, 2), or None."""
    places = np.concatenate([np.c_[side * SQUARE + (10 * k, 0), np.zeros(4)] for k, side in enumerate(squares)])
    corners = np.arange(len(places))
    given = np.concatenate([np.full((4, 2), np.nan) if each is None else np.asarray(each, float) for each in uv])
    return assets.AssetMesh(
        places, np.arange(0, len(corners) + 1, 4), corners, given, placement=np.diag([scale, scale, scale, 1.0])
    )


def test_a_map_without_fault():
    report = map_report([mesh_of([1, 2], [SQUARE / 4, SQUARE / 2 + 0.5])])
    assert (report.faces, report.islands) == (2, 2)
    assert (report.degenerate, report.unmapped, report.collapsed, report.flips, report.overlaps) == (0, 0, 0, 0, 0)
    assert report.qc_mean == report.qc_p99 == report.qc_max == pytest.approx(1)
    assert report.density_spread == pytest.approx(0, abs=1e-12)
    assert report.fill == pytest.approx(1 / 16 + 1 / 4)


def test_faults_are_counted():
    stretched = SQUARE * (0.25, 0.5)
    report = map_report([mesh_of([1, 1, 1, 0, 1], [stretched, None, stretched, SQUARE / 8 + 0.75, [(2.5, 0.5)] * 4])])
    assert (report.faces, report.unmapped, report.degenerate, report.collapsed) == (5, 1, 1, 1)
    assert report.overlaps == 2 and report.flips == 0
    assert report.qc_mean == report.qc_max == pytest.approx(2)
    # Another tile has a point of it; the face without area in 3D does not count.
    assert report.fill == pytest.approx(2 / 8 / 2)


@pytest.mark.parametrize("place", [0.0, 0.5])
def test_faces_below_single_precision_are_collapsed(place):
    """Renderers read 0.5 and 0.5 + 1e-8 as one number, but not 0 and 1e-8."""
    sliver = SQUARE * (0.25, 1e-8) + (0.25, place)
    report = map_report([mesh_of([1, 1], [SQUARE / 4, sliver if place else SQUARE * (1e-8, 1e-8)])])
    assert report.collapsed == (1 if place else 0)
    assert report.qc_mean == pytest.approx(1)


def test_faces_back_to_back_at_one_place_overlap():
    corners = np.array([0, 1, 3, 3, 1, 0, 1, 2, 3])
    vertices = np.c_[SQUARE, np.zeros(4)]
    report = map_report([assets.AssetMesh(vertices, np.array([0, 3, 6, 9]), corners, SQUARE[corners])])
    assert report.overlaps == 2 and report.fill == pytest.approx(1.5)


def test_a_flip_is_one_within_its_island():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    uv = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0.9, 0.2)])
    mesh = assets.AssetMesh(vertices, np.array([0, 3, 6]), np.array([0, 1, 2, 0, 2, 3]), uv)
    report = map_report([mesh])
    assert (report.islands, report.flips) == (1, 1)


def test_density_is_that_of_the_scene_and_overlaps_are_those_of_all_meshes():
    meshes = [mesh_of([1], [SQUARE / 2]), mesh_of([1], [SQUARE / 2], scale=2.0)]
    report = map_report(meshes)
    assert report.overlaps == 2 and report.islands == 2
    # Densities 1/2 and 1/4 on areas of 1 and 4.
    average = (0.5 + 4 * 0.25) / 5
    spread = np.sqrt(((0.5 - average) ** 2 + 4 * (0.25 - average) ** 2) / 5) / average
    assert report.density_spread == pytest.approx(spread)


def test_the_percentile_is_one_of_area():
    wide = [SQUARE * (3, 1) / 100 + k / 8 for k in range(2)]
    report = map_report([mesh_of([10, 0.1], [SQUARE / 10 + 0.8, wide[0]])])
    assert report.qc_p99 == pytest.approx(1) and report.qc_max == pytest.approx(3)
    report = map_report([mesh_of([1, 1], [SQUARE / 10 + 0.8, wide[0]])])
    assert report.qc_p99 == pytest.approx(3)


def test_without_any_map():
    report = map_report([mesh_of([1], [None])])
    assert report.unmapped == 1 and report.islands == 0
    assert np.isnan([report.qc_mean, report.qc_p99, report.qc_max, report.density_spread, report.fill]).all()


def test_quads_that_a_fixed_diagonal_flips_are_counted():
    """A dart, whose reflex corner makes one diagonal lie outside of it, from each of its corners."""
    dart = np.array([(0.0, 0.0), (0.5, 0.4), (1.0, 0.0), (0.5, 1.0)])
    found = [map_report([mesh_of([1], [np.roll(dart, turn, axis=0)])]) for turn in range(4)]
    assert [report.split_flips for report in found] == [1, 0, 1, 0]
    assert [report.flips for report in found] == [0] * 4
    assert map_report([mesh_of([1], [SQUARE])]).split_flips == 0


GOOD = MapReport(9, 0, 0, 0, 3, 0, 0, 1.01, 1.2, 1.4, 0.01, 0.6)


@pytest.mark.parametrize(
    ("text", "failures"),
    [
        ("flips == 0 and overlaps == 0 and qc_p99 < 1.5 and density_spread < 0.05", []),
        ("fill >= 0.7", ["fill >= 0.7, but fill is 0.6"]),
        ("islands<=2 and qc_max != 1.4", ["islands <= 2, but islands is 3", "qc_max != 1.4, but qc_max is 1.4"]),
    ],
)
def test_what_is_required(text, failures):
    assert Requirement(text).failures(GOOD) == failures


def test_what_is_not_known_meets_nothing():
    unknown = map_report([mesh_of([1], [None])])
    assert Requirement("qc_mean != 2 and unmapped == 1").failures(unknown) == ["qc_mean != 2, but qc_mean is nan"]


@pytest.mark.parametrize(
    "text",
    ["", "flips", "flips = 0", "flips == 0 or islands == 1", "0 < flips < 3", "flips == overlaps", "__import__('os')",
     "faces == 'a'", "texels > 3"],
)  # fmt: skip
def test_what_cannot_be_required(text):
    with pytest.raises(RequirementError, match="not a comparison|A report has no 'texels'"):
        Requirement(text)


def test_the_command_says_which_file_fails_which_condition(tmp_path, capsys):
    rows = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 {} \nvt 0 {}\nf 1/1 2/2 3/3 4/4\n"
    for name, height in (("good.obj", 1), ("bad.obj", 0.5)):
        (tmp_path / name).write_text(rows.format(height, height))
    files = [str(tmp_path / name) for name in ("good.obj", "bad.obj", "none.obj")]
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert main(["report", *files, "--json", "--require", "qc_p99 < 1.5 and overlaps == 0"]) == 1
    told = capsys.readouterr()
    good, bad = map(json.loads, told.out.splitlines())
    assert good["failures"] == [] and good["qc_mean"] == pytest.approx(1) and good["file"] == files[0]
    assert bad["failures"] == ["qc_p99 < 1.5, but qc_p99 is 2"]
    assert [line.partition(":")[0] for line in told.err.splitlines()] == [files[1], "error"]
    assert main(["report", files[0], "--require", "qc_p99 < 1.5"]) == 0
    assert "qc_p99" in capsys.readouterr().out
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    with pytest.raises(SystemExit):
        main(["report", files[0], "--require", "nothing"])
    assert "not a comparison" in capsys.readouterr().err
