# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch on many files of all formats that need no Blender: the results, and what a full disk leaves."""

import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from spectral_conformal import assets

from tests.module import batch_assets, meshes, test_gltf

SECONDS = 300

pytestmark = pytest.mark.slow

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "real"


def batch(*arguments, limit=None):
    """Run the batch, with a limit of the size of files; return its exit code and what it said."""
    words = [sys.executable, "-m", "spectral_conformal", "batch", "--quiet", *map(str, arguments)]
    words = [*(["prlimit", f"--fsize={limit}"] if limit else []), *words]
    done = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS)
    return done.returncode, done.stdout + done.stderr


def report_of(out, name):
    return json.loads((out / name / "report.json").read_text())


def write_off(path, points, faces):
    rows = ["OFF", f"{len(points)} {len(faces)} 0", *(" ".join(map(repr, point)) for point in points.tolist())]
    path.write_text("\n".join([*rows, *(f"{len(face)} {' '.join(map(str, face))}" for face in faces.tolist())]) + "\n")


def write_gltf(path, points, faces):
    triangles = meshes.triangles_of(faces)
    build = test_gltf.Builder()
    attributes = {"POSITION": build.accessor(points)}
    primitive = {"attributes": attributes, "indices": build.accessor(triangles.reshape(-1, 1), "u4")}
    build.json |= {"meshes": [{"primitives": [primitive]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
    build.json["buffers"] = [{"byteLength": len(build.buffer)}]
    test_gltf.save(path, build, "glb" if path.suffix == ".glb" else "embedded")


WRITERS = {
    ".obj": batch_assets.write_obj,
    ".ply": batch_assets.write_ply,
    ".stl": batch_assets.write_stl,
    ".off": write_off,
    ".usda": batch_assets.write_usd,
    ".glb": write_gltf,
    ".gltf": write_gltf,
}
MAKERS = (
    lambda k: batch_assets.grid(4 + k % 9, 0.3, k),
    lambda k: batch_assets.torus(9 + k % 7, 6),
    lambda k: batch_assets.not_manifold(4 + k % 5, k),
)


@pytest.fixture(scope="module")
def many(tmp_path_factory):
    """Two hundred files of all formats, and their results."""
    folder = tmp_path_factory.mktemp("many")
    names = []
    for k in range(200):
        suffix, write = list(WRITERS.items())[k % len(WRITERS)]
        name = f"{k % 5}/asset {k:03}{suffix}"
        (folder / "in" / name).parent.mkdir(parents=True, exist_ok=True)
        write(folder / "in" / name, *MAKERS[k % len(MAKERS)](k))
        names.append(name)
    before = {path: path.read_bytes() for path in (folder / "in").rglob("*") if path.is_file()}
    code, told = batch(folder / "in", "--out", folder / "out", "--jobs", 2, "--picture-size", 0)
    return folder, names, before, code, told


def test_two_hundred_files_of_all_formats_come_back_with_maps(many):
    folder, names, before, code, told = many
    assert code == 0, told
    assert {path: path.read_bytes() for path in before} == before
    for name in names:
        report = report_of(folder / "out", name)
        totals = report["totals"]
        assert (report["status"], totals["flips"], totals["overlaps"], totals["unmapped"]) == ("unwrapped", 0, 0, 0), (
            name
        )
        source = assets.read(folder / "in" / name).meshes
        written = assets.read(folder / "out" / name / report["output"]).meshes
        for one, other in zip(source, written):
            # Also where vertices have copies, corners lie where they lay.
            assert np.array_equal(one.vertices[one.corner_vertices], other.vertices[other.corner_vertices]), name
            assert np.array_equal(one.face_offsets, other.face_offsets)
            assert np.isfinite(other.corner_uv).all()
            assert other.corner_uv.min() >= 0.0 and other.corner_uv.max() <= 1.0
    with (folder / "out" / "summary.csv").open(newline="") as table:
        assert sorted(row["name"] for row in csv.DictReader(table)) == sorted(names)


@pytest.mark.skipif(not SHARED.is_dir(), reason="no meshes beside the project")
def test_meshes_of_others_come_back_with_maps(tmp_path):
    """Real ones, of up to 10,000 faces."""
    (tmp_path / "in").mkdir()
    for path in SHARED.glob("*.obj"):
        if path.stat().st_size < 500_000:
            shutil.copy(path, tmp_path / "in")
    options = ("--jobs", 2, "--picture-size", 0, "--require", "flips == 0 and overlaps == 0 and qc_mean < 1.05")
    code, told = batch(tmp_path / "in", "--out", tmp_path / "out", *options)
    assert code == 0, told


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("part", [0.2, 0.95])
def test_a_full_disk_destroys_nothing(suffix, part, tmp_path):
    """A limit of the size of files stands for it: what goes beyond cannot be written."""
    source = tmp_path / "in" / f"a{suffix}"
    source.parent.mkdir()
    WRITERS[suffix](source, *batch_assets.grid(40, 0.3, 1))
    options = ("--jobs", 1, "--picture-size", 0, "--seams", "sharp")
    assert batch(source.parent, "--out", tmp_path / "out", *options)[0] == 0
    report = report_of(tmp_path / "out", source.name)
    written = max(path.stat().st_size for path in (tmp_path / "out" / source.name).iterdir())
    before = {path.name: path.read_bytes() for path in source.parent.iterdir()}
    in_place = () if suffix in (".stl", ".off") else ("--overwrite-source",)
    code, told = batch(source.parent, "--out", tmp_path / "full", *options, *in_place, limit=int(part * written))
    assert code == 2, told
    assert {path.name: path.read_bytes() for path in source.parent.iterdir()} == before
    assert not (tmp_path / "full" / source.name / report["output"]).exists()
    assert not [path for path in tmp_path.rglob("*.partial*")]


def test_what_is_required_decides_and_is_told(tmp_path):
    for name, height in (("flat.obj", 0.0), ("bumpy.obj", 0.6)):
        batch_assets.write_obj(tmp_path / name, *batch_assets.grid(8, height, 1))
    paths = (tmp_path / "flat.obj", tmp_path / "bumpy.obj")
    options = ("--jobs", 1, "--seams", "sharp", "--picture-size", 0, "--require", "qc_max < 1.001 and flips == 0")
    code, told = batch(*paths, "--out", tmp_path / "out", *options)
    assert code == 1
    assert report_of(tmp_path / "out", "flat.obj")["not_met"] == []
    (missed,) = report_of(tmp_path / "out", "bumpy.obj")["not_met"]
    assert missed.startswith("qc_max < 1.001, but qc_max is 1.")
    rows = {row["name"]: row for row in json.loads((tmp_path / "out" / "summary.json").read_text())["rows"]}
    assert rows["bumpy.obj"]["not_met"] == missed and rows["bumpy.obj"]["status"] == "unwrapped"
    # It is no setting: existing results are judged again.
    assert batch(*paths, "--out", tmp_path / "out", *options[:-1], "flips == 0", "--resume")[0] == 0


def test_two_batches_do_not_write_into_one_folder(tmp_path):
    batch_assets.write_obj(tmp_path / "a.obj", *batch_assets.grid(8, 0.3, 1))
    (tmp_path / "out").mkdir()
    fcntl = pytest.importorskip("fcntl")
    with (tmp_path / "out" / "batch.log").open("a") as log:
        fcntl.flock(log, fcntl.LOCK_EX)
        code, told = batch(tmp_path / "a.obj", "--out", tmp_path / "out")
    assert code == 64 and "Another batch writes into" in told
    assert batch(tmp_path / "a.obj", "--out", tmp_path / "out")[0] == 0


def test_a_folder_that_cannot_be_written_is_one_line(tmp_path):
    batch_assets.write_obj(tmp_path / "a.obj", *batch_assets.grid(8, 0.3, 1))
    code, told = batch(tmp_path / "a.obj", "--out", "/proc/nowhere")
    assert code == 64 and "Traceback" not in told and "cannot be written" in told


def test_textures_and_materials_go_along_and_are_never_replaced(tmp_path):
    folder = tmp_path / "in"
    (folder / "tex").mkdir(parents=True)
    batch_assets.write_obj(folder / "a.obj", *batch_assets.grid(4, 0.3, 1))
    (folder / "a.obj").write_text(
        "mtllib mats/one.mtl\nusemtl red\nmtllib  ../up.mtl\n" + (folder / "a.obj").read_text()
    )
    (folder / "mats").mkdir()
    (folder / "mats" / "one.mtl").write_text("newmtl red\nmap_Kd ../tex/my red.png\nbump -bm 2 ../tex/bump.png\n")
    for name in ("my red.png", "bump.png"):
        (folder / "tex" / name).write_text(name)
    write_gltf(folder / "b.gltf", *batch_assets.grid(4, 0.3, 1))
    document = json.loads((folder / "b.gltf").read_text())
    document["images"] = [{"uri": "tex/my%20red.png"}, {"uri": "../up.png"}, {"uri": "missing.png"}]
    (folder / "b.gltf").write_text(json.dumps(document))
    for name in ("up.png", "up.mtl"):
        (tmp_path / name).write_text("up")
    out = tmp_path / "out"
    (out / "b.gltf" / "tex").mkdir(parents=True)
    (out / "b.gltf" / "tex" / "my red.png").write_text("mine")
    code, told = batch(folder, "--out", out, "--jobs", 1, "--picture-size", 0)
    assert code == 0, told
    assert (out / "a.obj" / "mats" / "one.mtl").read_bytes() == (folder / "mats" / "one.mtl").read_bytes()
    assert (out / "a.obj" / "tex" / "my red.png").read_text() == "my red.png"
    assert (out / "a.obj" / "tex" / "bump.png").read_text() == "bump.png"
    assert (out / "b.gltf" / "tex" / "my red.png").read_text() == "mine"
    lines = (out / "a.obj" / "a.obj").read_text().splitlines()
    assert [line for line in lines if "mtllib" in line] == ["mtllib mats/one.mtl", "mtllib  ../../up.mtl"]
    # What lies above the folder stays, and is found from where the result lies.
    images = json.loads((out / "b.gltf" / "b.gltf").read_text())["images"]
    assert [image["uri"] for image in images] == ["tex/my%20red.png", "../../up.png", "missing.png"]
    assert report_of(out, "b.gltf")["warnings"] == []
    assert not (out / "up.png").exists()


def test_islands_that_fail_keep_the_uvs_of_the_file(tmp_path):
    """A closed box without seams beside a sheet, both with UVs."""
    points, faces = batch_assets.grid(3, 0.2, 1)
    corners = np.array([[x, y, z] for x in (4, 5) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    path = tmp_path / "a.obj"
    batch_assets.write_obj(path, np.concatenate([points, corners]), np.concatenate([faces, quads + len(points)]))
    lines = [
        " ".join(f"{word}/1" if word != "f" else word for word in line.split()) if line.startswith("f ") else line
        for line in path.read_text().splitlines()
    ]
    lines.insert(len(lines) - len(quads), "o  Box #2 ")
    path.write_text("\n".join(["o Sheet", "vt 0.25 0.75", *lines]) + "\n")
    # All corners at one place are one island of the map: nothing cuts the box.
    code, told = batch(path, "--out", tmp_path / "out", "--jobs", 1, "--seams", "keep", "--picture-size", 0)
    report = report_of(tmp_path / "out", "a.obj")
    assert (code, report["status"], report["totals"]["failed"]) == (2, "incomplete", 1), told
    assert any(warning.startswith("1 island of Box #2 could not be") for warning in report["warnings"])
    assert "closed" in " ".join(report["warnings"])
    (mesh,) = assets.read(tmp_path / "out" / "a.obj" / "a.obj").meshes
    sheet = mesh.face_of_corner() < len(faces)
    assert (mesh.corner_uv[~sheet] == (0.25, 0.75)).all()
    assert np.ptp(mesh.corner_uv[sheet], axis=0).min() > 0.5


def test_islands_go_back_to_their_places_where_asked(tmp_path):
    """Turned, mirrored nowhere, of their size: a sheet that lay upside down in a corner of the tile."""
    points, faces = batch_assets.grid(6, 0.0, 1)
    path = tmp_path / "a.obj"
    batch_assets.write_obj(path, points, faces)
    places = 0.2 - 0.05 * (points[:, :2] + 1.0) * (1.0, 1.0)
    text = "".join(f"vt {u!r} {v!r}\n" for u, v in places.tolist())
    body = "".join(
        "f " + " ".join(f"{word}/{word}" for word in line.split()[1:]) + "\n" if line.startswith("f ") else f"{line}\n"
        for line in path.read_text().splitlines()
    )
    path.write_text(text + body)
    options = ("--jobs", 1, "--seams", "keep", "--no-pack", "--picture-size", 0, "--texture-size", "512x256")
    code, told = batch(path, "--out", tmp_path / "out", *options)
    assert code == 0, told
    (mesh,) = assets.read(tmp_path / "out" / "a.obj" / "a.obj").meshes
    found, former = mesh.corner_uv, places[mesh.corner_vertices]
    assert np.abs(found.mean(axis=0) - former.mean(axis=0)).max() < 1e-6
    # Texels of that texture are square, and the sheet keeps its area.
    sides = np.ptp(found, axis=0) * (512, 256)
    assert sides[0] == pytest.approx(sides[1], rel=1e-6)
    lowest = found[mesh.corner_vertices == 0][0]
    assert (lowest > found.mean(axis=0)).all()
