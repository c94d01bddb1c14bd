# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch command on generated assets, five of them broken; no interruption loses anything."""

import csv
import html
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import unquote

import numpy as np
import pytest
from spectral_conformal.batch import overview

import build_addon
from tests.module import batch_assets
from tools import batch as tools_batch

ROOT = Path(__file__).resolve().parents[2]
COMMAND = ("-m", "spectral_conformal", "batch")
WITH_FAULTS = ("-m", "tests.module.batch_with_faults")
# Fields that differ in every run.
MEASURED = ("seconds", "peak_memory", "attempts")
SECONDS = 500

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def environ():
    """A minimal environment in which the tests can be imported."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def start(environ, *arguments, command=WITH_FAULTS, python=None):
    words = [python or sys.executable, *command, *map(str, arguments)]
    return subprocess.Popen(
        words, cwd="/", env=environ, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace"
    )


def run(environ, *arguments, **rest):
    process = start(environ, *arguments, **rest)
    try:
        output, errors = process.communicate(timeout=SECONDS)
    finally:
        process.kill()
    return process.returncode, output, errors


def report_of(out, name):
    return json.loads((out / name / "report.json").read_text())


def summary_of(out):
    return json.loads((out / "summary.json").read_text())


def rows_of(out):
    """Return the summary's rows by asset, without measurements."""
    rows = summary_of(out)["rows"]
    return {row["name"]: {key: value for key, value in row.items() if key not in MEASURED} for row in rows}


def results_of(out):
    """Return the digest of every unwrapped file that the reports name."""
    return {path.parent.name: json.loads(path.read_text()).get("output_digest") for path in out.rglob("report.json")}


def reports_in(out):
    """Return the present reports while a batch runs; unlike Path.rglob, files may vanish meanwhile."""
    return [Path(folder) / "report.json" for folder, _, names in os.walk(out) if "report.json" in names]


def left_behind(folder):
    return [path for path in folder.rglob("*") if ".partial" in path.name]


def wait_until(condition, seconds=120.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def children_of(process):
    path = Path(f"/proc/{process}/task/{process}/children")
    return [int(child) for task in path.parents[1].glob("*/children") for child in task.read_text().split()]


def is_alive(process):
    try:
        return "State:\tZ" not in Path(f"/proc/{process}/status").read_text()
    except OSError:
        return False


@pytest.fixture(scope="module")
def batch(environ, tmp_path_factory):
    """A run over 25 good assets and 5 broken ones."""
    folder = tmp_path_factory.mktemp("batch")
    good = batch_assets.write_good(folder / "in", 25)
    batch_assets.write_broken(folder / "in")
    before = {path: path.read_bytes() for path in (folder / "in").rglob("*.*") if path.is_file()}
    code, _, errors = run(environ, folder / "in", "--out", folder / "out", "--jobs", 2)
    return folder, good, before, code, errors


def test_all_assets_are_accounted_for_and_only_broken_ones_fail(batch):
    folder, good, _, code, errors = batch
    rows = {row["name"]: row for row in summary_of(folder / "out")["rows"]}
    assert set(rows) == {*good, *batch_assets.BROKEN}
    assert {name for name, row in rows.items() if row["status"] == "failed"} == set(batch_assets.BROKEN), errors
    assert {rows[name]["status"] for name in good} == {"unwrapped"}
    assert code == 1
    kinds = {name: rows[name]["failure"] for name in batch_assets.BROKEN}
    assert kinds == {**dict.fromkeys(batch_assets.BROKEN, "error"), "crash.obj": "crash"}
    assert rows["crash.obj"]["attempts"] == 2
    assert rows["empty.obj"]["attempts"] == 1
    messages = {name: rows[name]["message"] for name in batch_assets.BROKEN}
    assert messages["empty.obj"] == "empty.obj is empty."
    assert "the position of vertex 11 is not finite" in messages["nan.usda"]
    assert messages["notes.obj"].endswith("has no faces; there is nothing to unwrap.")
    assert "truncated.glb" in messages["truncated.glb"]
    assert "signal 6" in messages["crash.obj"]


def obj_uv(path):
    """Return the UVs of an OBJ's corners, (C, 2), and the vertices of its faces."""
    text = path.read_text()
    uv = np.array([line.split()[1:3] for line in text.splitlines() if line.startswith("vt ")], dtype=float)
    faces = [line.split()[1:] for line in text.splitlines() if line.startswith("f ")]
    index = [[int(corner.split("/")[1]) - 1 for corner in face] for face in faces]
    return uv[np.concatenate(index)], [[int(corner.split("/")[0]) - 1 for corner in face] for face in faces]


def obj_points(path):
    """Return the vertices of an OBJ, (V, 3), and those of its quads, (F, 4)."""
    lines = [line.split() for line in path.read_text().splitlines()]
    points = np.array([line[1:4] for line in lines if line[:1] == ["v"]], dtype=float)
    return points, np.array([[int(c.split("/")[0]) - 1 for c in line[1:]] for line in lines if line[:1] == ["f"]])


def test_reports_tell_what_was_measured(batch):
    folder, good, *_ = batch
    for name in good:
        report = report_of(folder / "out", name)
        totals, islands = report["totals"], report["islands"]
        assert totals["islands"] == len(islands) > 0
        assert totals["flips"] == sum(island["flips"] for island in islands) == 0
        assert totals["overlaps"] == sum(island["overlaps"] for island in islands) == 0
        assert 1.0 <= totals["qc_mean"] <= totals["qc_p99"] + 1e-12 <= totals["qc_max"] + 1e-9
        area = [island["area"] for island in islands]
        mean = np.average([island["qc_mean"] for island in islands], weights=area)
        assert mean == pytest.approx(totals["qc_mean"], rel=1e-9)
        assert set(report["seconds"]) >= {"read", "seams", "solve", "pack", "measure", "picture", "write", "total"}
        assert 10 << 20 < report["peak_memory"] < 200 << 20
        assert report["versions"]["spectral_conformal"] != "unknown" and "blender" not in report["versions"]
        assert report["settings"]["seams"] == "suggest"
        assert len(report["styles"]) == totals["meshes"] and set(report["styles"]) <= {"hard", "organic"}
    # A closed torus has no border but seams, each on two sides.
    torus = next(r for r in (report_of(folder / "out", name) for name in good) if r["totals"]["vertices"] % 8 == 0)
    assert torus["totals"]["seam_length"] > 0.0


def test_border_and_seam_lengths_of_a_closed_mesh_agree(batch):
    folder, good, *_ = batch
    closed = [report_of(folder / "out", name) for k, name in enumerate(good) if k // 3 % 3 == 1]
    assert closed
    for report in closed:
        borders = sum(island["border_length"] for island in report["islands"])
        assert borders == pytest.approx(2.0 * report["totals"]["seam_length"], rel=1e-5)


def test_pictures_show_the_layout_with_its_legend(batch):
    from matplotlib.image import imread

    folder, good, *_ = batch
    for name in good[:6]:
        picture = imread(folder / "out" / name / "layout.png")
        assert picture.shape == (540, 512, 3)
        spread = np.ptp(picture, axis=2)
        # Packed in boxes, a long net covers a tenth of the tile.
        assert (spread[:512] > 0.2).mean() > 0.05
        assert (spread[520:532, 64:-64] > 0.2).mean() > 0.8
        assert max(imread(folder / "out" / name / "thumbnail.png").shape) <= 160


def test_overviews_agree(batch):
    folder, good, *_ = batch
    out = folder / "out"
    summary = summary_of(out)
    assert summary["assets"] == 30
    assert summary["status"] == {"failed": 5, "unwrapped": 25}
    assert summary["failures"] == {"crash": 1, "error": 4}
    with (out / "summary.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    assert (
        [row["name"] for row in table]
        == [row["name"] for row in summary["rows"]]
        == sorted(row["name"] for row in table)
    )
    page = (out / "index.html").read_text()
    assert not re.search(r'(?:src|href)="(?!data:|[^":]+/(?:layout\.png|report\.json)")', page)
    assert {unquote(link) for link in re.findall(r'href="([^"]+\.json)"', page)} == {
        f"{row['name']}/report.json" for row in table
    }
    assert page.count("data:image/png;base64,") == 25
    log = (out / "batch.log").read_text()
    assert all(name in log for name in [*good, *batch_assets.BROKEN])


SORT = """
<script>
const order = name => [...document.querySelectorAll("th")].findIndex(head => head.textContent === name);
const rows = () => [...document.querySelector("tbody").rows].filter(row => !row.matches(".said"));
const names = () => rows().map(row => row.cells[order("name")].dataset.value);
const heads = document.querySelectorAll("th"), said = [names().join("|")];
for (const column of ["faces", "faces", "name"]) { heads[order(column)].click(); said.push(names().join("|")); }
const loaded = [...document.images].every(image => { image.loading = "eager"; return image.src.startsWith("data:"); });
document.body.innerHTML = "<pre id=said></pre>";
document.querySelector("#said").textContent = JSON.stringify({said, loaded});
</script>
"""


# Ubuntu has no such package.
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@pytest.mark.skipif(not BROWSER, reason="no browser: apt-get install chromium")
def test_page_sorts_in_a_browser(batch, tmp_path):
    folder, *_ = batch
    page = (folder / "out" / "index.html").read_text()
    changed = tmp_path / "index.html"
    changed.write_text(page.replace("</body>", SORT + "</body>"))
    words = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    dump = subprocess.run([*words, "--dump-dom", changed.as_uri()], capture_output=True, text=True, timeout=120)
    found = re.search(r'<pre id="said">(.*?)</pre>', dump.stdout, re.DOTALL)
    assert found, dump.stdout[-500:] + dump.stderr[-2000:]
    result = json.loads(found.group(1))
    first, up, down, by_name = (text.split("|") for text in result["said"])
    faces = {row["name"]: row["faces"] for row in summary_of(folder / "out")["rows"]}
    assert result["loaded"]
    assert first == by_name == sorted(faces)
    counted = [faces[name] for name in up if faces[name] is not None]
    assert counted == sorted(counted) and [faces[name] for name in up[-5:]] == [None] * 5
    assert [faces[name] for name in down[:25]] == sorted(counted, reverse=True)


MEASURE = """
<script>
const wide = [innerWidth, document.documentElement.scrollWidth];
document.querySelectorAll("th")[1].click();
document.querySelectorAll("th")[1].click();
const rows = [...document.querySelector("tbody").rows].map(row => row.textContent);
const cut = [...document.querySelectorAll("td")].filter(cell => cell.scrollWidth > cell.clientWidth + 1).length;
document.body.innerHTML = "<pre id=said></pre>";
document.querySelector("#said").textContent = JSON.stringify({wide, cut, rows});
</script>
"""


@pytest.mark.skipif(not BROWSER, reason="no browser: apt-get install chromium")
def test_messages_are_readable_in_a_window_of_1500_pixels(tmp_path):
    totals = dict.fromkeys((name for name, path in overview.COLUMNS if path[0] == "totals"), 1234.5)
    seconds, long = {"total": 123.4}, "Some meshes were lost on the way. " * 9
    broken = {"name": "b.obj", "status": "failed", "failure": {"kind": "memory", "message": f"b is lost: {long}"}}
    whole = {"name": "props/a_long_name" * 4, "status": "unwrapped", "totals": totals, "peak_memory": 1 << 30}
    whole |= {"warnings": ["a_path_without_a_space/" * 30], "not_met": ["flips == 0, but flips is 1"]}
    overview.write(tmp_path, [{**report, "seconds": seconds, "attempts": 1} for report in (broken, whole)])
    page = tmp_path / "index.html"
    page.write_text(page.read_text().replace("</body>", MEASURE + "</body>"))
    words = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    words += ["--window-size=1500,900", "--dump-dom", page.as_uri()]
    dump = subprocess.run(words, capture_output=True, text=True, timeout=120)
    found = json.loads(html.unescape(re.search(r'<pre id="said">(.*?)</pre>', dump.stdout, re.DOTALL).group(1)))
    assert found["wide"] == [1500, 1500] and found["cut"] == 0
    # Messages stay below their asset, whatever the order.
    assert [row[:5] for row in found["rows"]] == ["props", "requi", "b.obj", "b is "]


def test_interrupted_run_goes_on_with_the_same_result(environ, batch, tmp_path):
    folder, good, *_ = batch
    out = tmp_path / "out"
    process = start(environ, folder / "in", "--out", out, "--jobs", 2)
    wait_until(lambda: len(reports_in(out)) >= 6)
    workers = children_of(process.pid)
    assert workers
    process.send_signal(signal.SIGKILL)
    process.communicate()
    wait_until(lambda: not any(map(is_alive, workers)), 20.0)
    done = {path: path.stat().st_mtime_ns for path in out.rglob("report.json")}
    succeeded = {path: when for path, when in done.items() if json.loads(path.read_text())["status"] == "unwrapped"}
    assert 0 < len(done) < 30
    code, _, errors = run(environ, folder / "in", "--out", out, "--jobs", 2, "--resume")
    assert code == 1, errors
    assert {path: path.stat().st_mtime_ns for path in succeeded} == succeeded
    assert rows_of(out) == rows_of(folder / "out")
    assert results_of(out) == results_of(folder / "out")
    assert left_behind(out) == []


@pytest.mark.parametrize("atlas", [(), ("--atlas", "props")])
def test_what_a_killed_process_left_is_removed(atlas, environ, tmp_path):
    (tmp_path / "in").mkdir()
    batch_assets.write_obj(tmp_path / "in" / "a.obj", *batch_assets.grid(5, 0.2, 1))
    out = tmp_path / "out"
    (out / "a.obj").mkdir(parents=True)
    left = [out / "a.obj" / ".0123456789ab.1.partial.obj"]
    left += [out / ".0123456789ab.1.partial.png"] if atlas else []
    for path in left:
        path.write_bytes(b"cut off")
    assert run(environ, tmp_path / "in", "--out", out, "--jobs", 1, "--resume", *atlas)[0] == 0
    assert left_behind(out) == []


def test_resume_does_anew_what_has_changed(environ, tmp_path):
    (tmp_path / "in").mkdir()
    for k in range(3):
        batch_assets.write_obj(tmp_path / "in" / f"{k}.obj", *batch_assets.grid(5, 0.2, k))
    arguments = (tmp_path / "in", "--out", tmp_path / "out", "--jobs", 1)
    assert run(environ, *arguments)[0] == 0
    reports = {k: tmp_path / "out" / f"{k}.obj" / "report.json" for k in range(3)}
    before = {k: path.stat().st_mtime_ns for k, path in reports.items()}
    batch_assets.write_obj(tmp_path / "in" / "1.obj", *batch_assets.grid(6, 0.2, 1))
    (tmp_path / "out" / "2.obj" / "2.obj").write_text("cut off")
    code, _, errors = run(environ, *arguments, "--resume")
    assert code == 0
    assert errors.endswith(f"3 of 3 assets worked (1 done before): {tmp_path / 'out' / 'index.html'}\n")
    assert {k: path.stat().st_mtime_ns != before[k] for k, path in reports.items()} == {0: False, 1: True, 2: True}
    assert report_of(tmp_path / "out", "1.obj")["totals"]["faces"] == 36
    before = {k: path.stat().st_mtime_ns for k, path in reports.items()}
    assert run(environ, *arguments, "--resume", "--area-blend", "0.5")[0] == 0
    assert all(path.stat().st_mtime_ns != before[k] for k, path in reports.items())


def test_limits_end_a_worker_and_the_others_go_on(environ, tmp_path):
    (tmp_path / "in").mkdir()
    for name in ("greedy", "hang", "good"):
        batch_assets.write_obj(tmp_path / "in" / f"{name}.obj", *batch_assets.grid(5, 0.2, 0))
    code, _, errors = run(
        environ, tmp_path / "in", "--out", tmp_path / "out", "--jobs", 1, "--seconds", 8, "--memory", 300
    )
    assert code == 1, errors
    rows = {
        row["name"]: (row["status"], row["failure"], row["attempts"]) for row in summary_of(tmp_path / "out")["rows"]
    }
    assert rows == {
        "good.obj": ("unwrapped", None, 1),
        "greedy.obj": ("failed", "memory", 2),
        "hang.obj": ("failed", "time", 1),
    }


def test_killed_worker_is_replaced_and_its_asset_done_again(environ, tmp_path):
    (tmp_path / "in").mkdir()
    for name in ("once", "zebra"):
        batch_assets.write_obj(tmp_path / "in" / f"{name}.obj", *batch_assets.grid(5, 0.2, 0))
    process = start(environ, tmp_path / "in", "--out", tmp_path / "out", "--jobs", 1)
    wait_until((tmp_path / "in" / "once.sleeps").exists)
    (worker,) = children_of(process.pid)
    os.kill(worker, signal.SIGKILL)
    _, errors = process.communicate(timeout=SECONDS)
    rows = {row["name"]: (row["status"], row["attempts"]) for row in summary_of(tmp_path / "out")["rows"]}
    assert process.returncode == 0, errors
    assert rows["once.obj"] == ("unwrapped", 2)
    assert rows["zebra.obj"] == ("unwrapped", 1)


def test_a_worker_in_the_middle_of_an_asset_ends_with_the_batch(environ, tmp_path):
    (tmp_path / "in").mkdir()
    batch_assets.write_obj(tmp_path / "in" / "hang.obj", *batch_assets.grid(5, 0.2, 0))
    process = start(environ, tmp_path / "in", "--out", tmp_path / "out", "--jobs", 1)
    wait_until((tmp_path / "in" / "hang.sleeps").exists)
    (worker,) = children_of(process.pid)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    wait_until(lambda: not is_alive(worker), 20.0)


def test_memory_does_not_grow(environ, tmp_path):
    batch_assets.write_good(tmp_path / "in", 1)
    (asset,) = [path for path in (tmp_path / "in").rglob("*.obj")]
    points, faces = batch_assets.grid(40, 0.3, 0)
    for k in range(60):
        batch_assets.write_obj(asset.with_name(f"{k:03}.obj"), points, faces)
    code, _, errors = run(environ, asset.parent, "--out", tmp_path / "out", "--jobs", 1, "--recycle", 100)
    assert code == 0, errors
    held = [row["peak_memory"] for row in summary_of(tmp_path / "out")["rows"][:60]]
    assert max(held[-10:]) <= 1.02 * max(held[5:15])


def test_results_of_an_earlier_run_are_no_inputs(environ, tmp_path):
    batch_assets.write_obj(tmp_path / "a.obj", *batch_assets.grid(5, 0.2, 1))
    assert run(environ, tmp_path, "--out", tmp_path / "old", "--jobs", 1)[0] == 0
    code, _, errors = run(environ, tmp_path, "--out", tmp_path / "new", "--jobs", 1)
    old = tmp_path / "old" / "a.obj" / "a.obj"
    assert code == 0 and f"1 file left out, as written by an earlier run: {old}" in errors
    assert [row["name"] for row in summary_of(tmp_path / "new")["rows"]] == ["a.obj"]
    for inputs, said in ((old, "is a result of an earlier run: name its source"), (tmp_path / "old", "All files in")):
        code, _, errors = run(environ, inputs, "--out", tmp_path / "third")
        assert code == 64 and said in errors, errors


def test_source_is_written_over_where_asked(environ, tmp_path):
    source = tmp_path / "in" / "grid.obj"
    source.parent.mkdir()
    batch_assets.write_obj(source, *batch_assets.grid(5, 0.2, 0))
    arguments = (source.parent, "--out", tmp_path / "out", "--overwrite-source", "--jobs", 1)
    assert run(environ, *arguments)[0] == 0
    assert len(obj_uv(source)[0]) == 100
    changed = source.stat().st_mtime_ns
    assert run(environ, *arguments, "--resume")[0] == 0
    assert source.stat().st_mtime_ns == changed


def test_example_of_the_readme(tmp_path, monkeypatch):
    (line,) = re.findall(r"`python3 build_addon\.py (batch [^`]*)`", (ROOT / "README.md").read_text(encoding="utf-8"))
    options = build_addon.parse(line.split())
    batch_assets.write_good(tmp_path / "assets", 3)
    monkeypatch.chdir(tmp_path)
    assert tools_batch.run(options.further_arguments) == 0
    assert len(list((tmp_path / "unwrapped").rglob("report.json"))) == 3
    assert (tmp_path / "unwrapped" / "index.html").is_file()


def gaps(uv):
    """Return the gaps between the bounding boxes of quads, (n, 4, 2), larger of both axes, for every pair."""
    low, high = uv.min(axis=1), uv.max(axis=1)
    between = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
    return between[~np.eye(len(uv), dtype=bool)]


@pytest.mark.parametrize(("texture", "sides"), [("256", (256, 256)), ("1024x128", (1024, 128))])
def test_margin_is_that_many_pixels_and_texels_are_square(environ, tmp_path, texture, sides):
    arguments = (batch_assets.write_cube(tmp_path), "--jobs", 1, "--seams", "sharp", "--texture-size", texture)
    for pixels in (2, 12):
        out = tmp_path / str(pixels)
        code, _, errors = run(environ, *arguments, "--out", out, "--margin", pixels)
        assert code == 0, errors
        uv, _ = obj_uv(out / "cube.obj" / "cube.obj")
        quads = uv.reshape(6, 4, 2) * sides
        assert gaps(quads).min() == pytest.approx(pixels, abs=0.01)
        assert min(quads.min(), (sides - quads).min()) == pytest.approx(pixels, abs=0.01)
        edges = np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2)
        assert np.ptp(edges) < 1e-6 * edges.max()
        # The report measures angles there, too.
        assert report_of(out, "cube.obj")["totals"]["qc_max"] < 1.001


def test_an_old_textures_aspect_does_not_squeeze_a_new_atlas(environ, tmp_path):
    """Like a palette of 256 x 1 texels, in which every face lies in one of them."""
    path = batch_assets.write_cube(tmp_path)
    lines = path.read_text().splitlines()
    texels = [f"vt {(k + 0.5) / 256} 0.5" for k in range(6)]
    faces = iter(range(1, 7))
    lines = [re.sub(r" (\d+)", rf" \1/{next(faces)}", line) if line.startswith("f") else line for line in lines]
    path.write_text("\n".join([*texels, *lines]) + "\n")
    assert run(environ, tmp_path / "in", "--out", tmp_path / "out", "--jobs", 1)[0] == 0
    assert report_of(tmp_path / "out", "cube.obj")["totals"]["qc_max"] < 1.001
    uv, _ = obj_uv(tmp_path / "out" / "cube.obj" / "cube.obj")
    assert np.ptp(uv, axis=0).min() > 0.5


def vertex_per_corner(points, faces):
    return points[faces.ravel()], np.arange(faces.size).reshape(faces.shape)


@pytest.mark.parametrize(
    ("options", "islands", "seam_length"),
    [
        (("suggest",), 1, 14.0),
        (("suggest", "--weld-distance", 0), 6, 0.0),
        (("sharp",), 6, 24.0),
        (("keep",), 6, 0.0),
    ],
    ids=lambda value: value[-1] if isinstance(value, tuple) else "",
)
def test_faces_with_vertices_of_their_own_make_islands_together_and_keep_them(
    environ, tmp_path, options, islands, seam_length
):
    batch_assets.write_cube(tmp_path)
    whole, faces = obj_points(tmp_path / "in" / "cube.obj")
    soup = vertex_per_corner(whole, faces)
    batch_assets.write_obj(tmp_path / "in" / "soup.obj", *soup)
    batch_assets.write_ply(tmp_path / "in" / "soup.ply", *vertex_per_corner(*batch_assets.torus(14, 9)))
    batch_assets.write_obj(tmp_path / "in" / "torus.obj", *batch_assets.torus(14, 9))
    out = tmp_path / "out"
    run(environ, tmp_path / "in", "--out", out, "--jobs", 2, "--seams", *options, "--format", "obj")
    found = report_of(out, "soup.obj")["totals"]
    assert found["islands"] == islands
    assert found["vertices"] == 24
    is_welded = options in (("suggest",), ("sharp",))
    assert found["welded"] == (16 if is_welded else 0)
    assert found["seam_length"] == pytest.approx(seam_length)
    assert found["flips"] == found["overlaps"] == 0
    places, corners = obj_points(out / "soup.obj" / "soup.obj")
    assert np.array_equal(corners, soup[1])
    assert np.abs(places - soup[0]).max() < 1e-5
    if is_welded:
        torus, same = (report_of(out, name)["totals"] for name in ("torus.obj", "soup.ply"))
        assert same["vertices"] == 4 * torus["vertices"]
        for name in ("islands", "qc_mean", "seam_length", "flips", "overlaps", "failed"):
            assert same[name] == pytest.approx(torus[name], rel=1e-4), name


def test_islands_or_places_are_kept_where_asked(environ, tmp_path):
    batch_assets.write_cube(tmp_path)
    assert run(environ, tmp_path / "in", "--out", tmp_path / "one", "--jobs", 1, "--seams", "sharp")[0] == 0
    first = tmp_path / "one" / "cube.obj" / "cube.obj"
    text = re.sub(
        r"^vt (\S+) (\S+)", lambda m: f"vt {0.5 * float(m[1])} {0.5 * float(m[2])}", first.read_text(), flags=re.M
    )
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / "half.obj").write_text(text)
    small, _ = obj_uv(tmp_path / "half" / "half.obj")
    base = (tmp_path / "half", "--jobs", 1, "--seams", "keep", "--no-unwrap")
    assert run(environ, *base, "--no-pack", "--out", tmp_path / "kept")[0] == 0
    kept, _ = obj_uv(tmp_path / "kept" / "half.obj" / "half.obj")
    assert np.abs(kept - small).max() < 1e-5
    assert run(environ, *base, "--out", tmp_path / "packed")[0] == 0
    packed, _ = obj_uv(tmp_path / "packed" / "half.obj" / "half.obj")
    assert np.ptp(packed, axis=0).max() > 1.5 * np.ptp(small, axis=0).max()
    code, _, _ = run(
        environ, tmp_path / "in", "--jobs", 1, "--no-unwrap", "--seams", "keep", "--out", tmp_path / "none"
    )
    assert code == 2
    assert "There is no UV map" in report_of(tmp_path / "none", "cube.obj")["failure"]["message"]


def dask(environ, module, *arguments):
    words = [sys.executable, "-m", f"distributed.cli.{module}", *map(str, arguments)]
    return subprocess.Popen(words, env=environ, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.fixture
def cluster(environ, tmp_path):
    """A scheduler and three Nannies with a worker each, of which the last has too little memory for each thread."""
    pytest.importorskip("distributed")
    file = tmp_path / "scheduler.json"
    environ = {**environ, "DASK_DISTRIBUTED__WORKER__MEMORY__SPILL": "false"}
    options = (
        "--scheduler-file",
        file,
        "--nworkers",
        1,
        "--local-directory",
        tmp_path,
        "--no-dashboard",
    )
    started = [dask(environ, "dask_scheduler", "--scheduler-file", file, "--port", 0, "--no-dashboard")]
    try:
        wait_until(file.exists)
        for size, threads in (("4GB", 1), ("4GB", 1), ("200MB", 8)):
            started.append(dask(environ, "dask_worker", *options, "--memory-limit", size, "--nthreads", threads))
        yield json.loads(file.read_text())["address"], started[1:]
    finally:
        for process in started:
            process.terminate()
        for process in started:
            process.wait(timeout=60)


def test_dask_cluster_loses_a_worker_and_no_asset(environ, batch, cluster, tmp_path):
    from distributed import Client

    folder, good, *_ = batch
    address, nannies = cluster
    out = tmp_path / "out"
    with Client(address) as client:
        client.wait_for_workers(3, timeout=120)
        limits = [worker["memory_limit"] for worker in client.scheduler_info()["workers"].values()]
        assert sorted(limits)[0] < 300e6 < sorted(limits)[1]
    sources = [folder / "in" / name for name in good]
    process = start(environ, *sources, "--out", out, "--scheduler", address, command=COMMAND)
    wait_until(lambda: len(reports_in(out)) >= 4)
    (worker,) = [
        child for child in children_of(nannies[0].pid) if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()
    ]
    unwrapping = children_of(worker)
    os.kill(worker, signal.SIGKILL)
    _, errors = process.communicate(timeout=SECONDS)
    assert process.returncode == 0, errors
    assert {row["status"] for row in summary_of(out)["rows"]} == {"unwrapped"}
    assert len(summary_of(out)["rows"]) == len(good)
    # Some were first given to the worker that is too small for them.
    assert max(row["attempts"] for row in summary_of(out)["rows"]) > 1
    wait_until(lambda: not any(map(is_alive, unwrapping)), 20.0)
    expected = results_of(folder / "out")
    assert {name: digest for name, digest in results_of(out).items()} == {
        Path(name).name: expected[Path(name).name] for name in good
    }


def test_scheduler_that_does_not_answer_is_named(environ, tmp_path):
    batch_assets.write_good(tmp_path / "in", 1)
    pytest.importorskip("distributed")
    arguments = (tmp_path / "in", "--out", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:9")
    code, _, errors = run(environ, *arguments, command=COMMAND)
    assert code == 64
    assert "No Dask scheduler answers at tcp://127.0.0.1:9" in errors


AUTHOR = """
const tasks = [];
const author = {
    Task: (name, type) => ({ name, type, commands: [], dependencies: [],
        addCommand(command) { this.commands.push(command); },
        addDependency(task) { this.dependencies.push(task.name); } }),
    Command: (name, parameters) => ({ name, parameters }),
};
"""
# What Flamenco's schema AvailableJobSetting lists.
SETTING_KEYS = {"key", "type", "subtype", "choices", "propargs", "description", "label", "default", "eval", "evalInfo"}
SETTING_KEYS |= {"visible", "required", "editable"}
SETTING_TYPES = {"string", "int32", "float", "bool"}
SETTING_SUBTYPES = {"file_path", "dir_path", "file_name", "hashed_file_path"}
TASK_TYPES = {"blender", "ffmpeg", "file-management", "misc"}


@pytest.mark.skipif(not shutil.which("node"), reason="nothing to run the job type in: apt-get install nodejs")
def test_flamenco_job_type_makes_tasks_that_do_the_batch(environ, tmp_path):
    names = batch_assets.write_good(tmp_path / "in", 5)
    (tmp_path / "in" / "empty.obj").write_bytes(b"")
    settings = {
        "inputs": str(tmp_path / "in"),
        "out": str(tmp_path / "out"),
        "parts": 2,
        "options": "--jobs 1  --quiet",
    }
    settings["python"] = sys.executable
    source = (ROOT / "tools" / "flamenco" / "spectral_unwrap.js").read_text(encoding="utf-8")
    job = f"const job = {{ settings: {json.dumps(settings)}, addTask: (task) => tasks.push(task) }};"
    program = f"{AUTHOR}{source}{job}compileJob(job);console.log(JSON.stringify({{ JOB_TYPE, tasks }}));"
    told = subprocess.run(["node", "--eval", program], check=True, capture_output=True, text=True, timeout=60)
    found = json.loads(told.stdout)
    assert {"label", "settings"} <= set(found["JOB_TYPE"])
    for setting in found["JOB_TYPE"]["settings"]:
        assert set(setting) <= SETTING_KEYS
        assert setting["type"] in SETTING_TYPES
        assert setting.get("subtype", "file_path") in SETTING_SUBTYPES
        assert setting["key"] in settings
    tasks = found["tasks"]
    assert [task["name"] for task in tasks] == ["unwrap-1", "unwrap-2", "overview"]
    assert tasks[2]["dependencies"] == ["unwrap-1", "unwrap-2"]
    assert {task["type"] for task in tasks} <= TASK_TYPES
    codes = []
    for task in tasks:
        (only,) = task["commands"]
        assert (only["name"], only["parameters"]["exe"]) == ("exec", sys.executable)
        arguments = only["parameters"]["args"]
        assert tuple(arguments[: len(COMMAND)]) == COMMAND
        codes.append(run(environ, *arguments, command=())[0])
    assert codes == [0, 0, 1]
    rows = {row["name"]: row["status"] for row in summary_of(tmp_path / "out")["rows"]}
    assert rows == {**dict.fromkeys(names, "unwrapped"), "empty.obj": "failed"}


@pytest.mark.skipif(not shutil.which("bash"), reason="the tasks are scripts of bash")
def test_open_job_template_makes_tasks_that_do_the_batch(environ, tmp_path):
    pytest.importorskip("openjd.cli")
    names = batch_assets.write_good(tmp_path / "in", 4)
    template = ROOT / "tools" / "openjd" / "spectral_unwrap.yaml"
    values = {
        "Inputs": tmp_path / "in",
        "Out": tmp_path / "with space",
        "Python": sys.executable,
        "Parts": 2,
        "Options": "--jobs 1 --recycle 3",
    }
    given = [word for name, value in values.items() for word in ("--job-param", f"{name}={value}")]
    words = ["run", template, "--step", "Overview", "--run-dependencies", *given]
    code, output, errors = run(environ, *words, command=("-m", "openjd"))
    assert code == 0, output + errors
    # Two parts of two assets.
    assert output.count("openjd_progress: 50.0") == output.count("openjd_progress: 100.0") == 2
    rows = {row["name"]: row["status"] for row in summary_of(tmp_path / "with space")["rows"]}
    assert rows == dict.fromkeys(names, "unwrapped")
