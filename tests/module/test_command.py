# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m spectral_conformal: files in, an OBJ with UVs out, messages and exit codes."""

import dataclasses
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal.__main__ import main

from tests.module import meshes
from tests.module.test_suggest_seams import box

SCRIPTING = Path(__file__).resolve().parents[2] / "docs" / "scripting.md"
PATCH = meshes.saddle_quads(9)


def write_obj(path, vertices, faces, begin=""):
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices).tolist()]
    rows += [f"f {' '.join(str(v + 1) for v in face)}" for face in faces]
    path.write_text(begin + "\n".join(rows) + "\n")
    return path


def write_off(path, vertices, faces):
    rows = ["OFF # a comment", f"{len(vertices)} {len(faces)} 0", *(" ".join(map(repr, v)) for v in vertices.tolist())]
    rows += [f"{len(face)} {' '.join(map(str, face))} 255 0 0" for face in faces]
    path.write_text("\n".join(rows) + "\n")
    return path


def write_ply(path, vertices, faces, form):
    """Faces as lists between two other properties, and an element that is of no interest."""
    header = (
        f"ply\nformat {form} 1.0\ncomment made here\nelement vertex {len(vertices)}\nproperty double x\n"
        f"property double y\nproperty double z\nproperty uchar red\nelement face {len(faces)}\nproperty uchar part\n"
        "property list uchar int vertex_indices\nproperty short last\n"
        "element edge 1\nproperty int vertex1\nend_header\n"
    )
    if form == "ascii":
        rows = [f"{' '.join(map(repr, v))} 7" for v in vertices.tolist()]
        rows += [f"1 {len(face)} {' '.join(map(str, face))} -2" for face in faces]
        path.write_text(header + "\n".join([*rows, "3"]) + "\n")
        return path
    order = {"binary_little_endian": "<", "binary_big_endian": ">"}[form]
    data = b"".join(np.array(v, order + "f8").tobytes() + b"\x07" for v in vertices)
    for face in faces:
        data += bytes([1, len(face)]) + np.array(face, order + "i4").tobytes() + np.array([-2], order + "i2").tobytes()
    path.write_bytes(header.encode() + data + np.array([3], order + "i4").tobytes())
    return path


def read_uv(path):
    """(C, 2) UVs of the corners, not a number where there are none; the words of the faces; and all other lines."""
    lines = [line.split() for line in path.read_text().splitlines()]
    uv = [[float(word) for word in words[1:]] for words in lines if words[0] == "vt"]
    uv = np.array([*uv, [np.nan, np.nan]])
    faces = [words[1:] for words in lines if words[0] == "f"]
    index = [corner.split("/")[1:2] for face in faces for corner in face]
    return (
        uv[[int(i[0]) - 1 if i and i[0] else -1 for i in index]],
        faces,
        [w for w in lines if w[0] not in ("vt", "f")],
    )


def mixed():
    """Quads and triangles, so that no two formats of rows are alike."""
    vertices, quads = PATCH
    faces = [*quads[: len(quads) // 2].tolist()]
    for quad in quads[len(quads) // 2 :].tolist():
        faces += [quad[:3], [quad[0], *quad[2:]]]
    return vertices, faces


@pytest.mark.parametrize("form", ["obj", "off", "ascii", "binary_little_endian", "binary_big_endian"])
def test_every_format_gets_the_map_of_unwrap(form, tmp_path, capsys):
    vertices, faces = mixed()
    if form in ("obj", "off"):
        path = {"obj": write_obj, "off": write_off}[form](tmp_path / f"m.{form}", vertices, faces)
    else:
        path = write_ply(tmp_path / "m.ply", vertices, faces, form)
    assert main([str(path), "--seams", "keep", "--out", str(tmp_path / "out.obj")]) == 0
    uv, written, _ = read_uv(tmp_path / "out.obj")
    assert [[int(corner.split("/")[0]) - 1 for corner in face] for face in written] == faces
    expected = sc.unwrap(vertices, *meshes.polygons(faces), options=sc.defaults.MAPS)
    assert uv.min() >= 0
    assert uv.max() <= 1
    assert meshes.similarity_deviation(uv, expected.uv) < 1e-7
    row = capsys.readouterr().out.splitlines()[1].split()
    chart = expected.charts[0]
    assert row == ["0", str(len(faces)), f"{chart.mean_qc:.4f}", f"{chart.max_qc:.4g}", "0", "0"]


def test_what_else_an_obj_has_stays(tmp_path):
    vertices, faces = PATCH
    lines = ["mtllib m.mtl", "o part", *(f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()), "vn 0 0 1", "vt 0 0"]
    lines += ["usemtl red", *(f"f {' '.join(f'{v - len(vertices)}/1/-1' for v in face)}" for face in faces), "l 1 2"]
    (tmp_path / "m.obj").write_text("\n".join(lines) + "\n")
    assert main([str(tmp_path / "m.obj"), "--out", str(tmp_path / "out.obj")]) == 0
    uv, written, others = read_uv(tmp_path / "out.obj")
    assert others == [line.split() for line in lines if line.split()[0] not in ("f", "vt")]
    assert all(re.fullmatch(r"-\d+/\d+/-1", corner) for face in written for corner in face)
    assert np.isfinite(uv).all()


def test_suggested_seams_open_what_is_closed_and_are_kept_the_next_time(tmp_path):
    vertices, offsets, corners = box((1, 1, 1), 4)
    path = write_obj(tmp_path / "m.obj", vertices, np.split(corners, offsets[1:-1]))
    assert main([str(path), "--seams", "keep"]) == 1
    assert np.isnan(read_uv(tmp_path / "m_uv.obj")[0]).all()
    assert main([str(path)]) == 0
    first = read_uv(tmp_path / "m_uv.obj")[0]
    assert main([str(tmp_path / "m_uv.obj"), "--seams", "keep", "--out", str(tmp_path / "again.obj")]) == 0
    again = read_uv(tmp_path / "again.obj")[0]
    assert np.abs(again - first).max() < 1e-6


def test_an_open_tube_that_becomes_a_ring_is_said_to_vary_in_size_with_what_helps(tmp_path, capsys):
    path = write_obj(tmp_path / "tube.obj", *meshes.tube(16, 9))
    assert main([str(path), "--seams", "keep"]) == 0
    said = re.search(
        r"warning: 1 island varies in size by up to (\d+) %; .*--seams suggest.*--area-blend", capsys.readouterr().out
    )
    assert said
    assert int(said[1]) > 41
    for helps in ([], ["--seams", "keep", "--area-blend", "1"]):
        assert main([str(path), *helps]) == 0
        assert "vary" not in capsys.readouterr().out


PLY = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
BROKEN = {
    "index.obj": ("v 0 0 0\nf 1 2 3\n", "index.obj:2: there is no vertex 2; the file has 1"),
    "word.obj": ("v 0 0 zero\n", "word.obj:1: '0 0 zero' has a word that is not a number"),
    "short.obj": ("v 0 0\n", "short.obj:1: 'v' has too few numbers"),
    "two.obj": ("v 0 0 0\nv 0 0 1\nf 1 2\n", "two.obj:3: a face needs at least three corners"),
    "nan.obj": ("v 0 0 0\nv 1 0 0\nv nan 0 1\nf 1 2 3\n", "the position of vertex 3 is not finite"),
    "none.obj": ("v 0 0 0\n", "has no faces"),
    "empty.obj": ("", "has no faces"),
    "relative.obj": (
        "v 0 0 0\nf -1 -2 -3\nv 1 0 0\n",
        "relative.obj:2: there is no vertex -2; 1 stand before this line",
    ),
    "mesh.3ds": ("solid\n", "only .glb, .gltf, .obj, .off, .ply, .stl, .usd, .usda, .usdc, .usdz files can be read"),
    "empty.stl": ("solid\nendsolid\n", "has no faces"),
    "facet.stl": ("solid\nfacet\nvertex 0 0 0\nendfacet\n", "facet.stl:4: a facet has three vertices, this one has 1"),
    "word.stl": ("solid\nvertex 0 0 zero\n", "word.stl:2: '0 0 zero' has a word that is not a number"),
    "begin.off": ("mesh\n3 1 0\n", "begin.off:1: an OFF file begins with 'OFF'"),
    "counts.off": ("OFF\nthree\n", "counts.off:2: the numbers of vertices and faces are missing"),
    "ends.off": ("OFF\n3 1 0\n0 0 0\n", "ends.off: ends at vertex 1 of 3"),
    "range.off": ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "range.off:6: there is no vertex 3"),
    "short.off": ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "short.off:6: 3 numbers are needed, but the line has 2"),
    "header.ply": ("ply\nformat ascii 1.0\nelement vertex many\nend_header\n", "header.ply:3: 'element vertex many'"),
    "endless.ply": (PLY, "the header has no 'end_header'"),
    "rows.ply": (PLY + "end_header\n", "ends at vertex 0 of 1"),
    "faceless.ply": (PLY + "end_header\n0 0 0\n", "faceless.ply: has no element 'face'"),
    "binary.ply": (PLY.replace("ascii", "binary_little_endian") + "end_header\nabc", "ends at vertex 0 of 1"),
    "range.ply": (
        PLY + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 9\n",
        "range.ply: face 0: there is no vertex 9; the file has 1, numbered from 0",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_file_is_named_with_its_line(name, tmp_path, capsys):
    content, message = BROKEN[name]
    (tmp_path / name).write_text(content)
    assert main([str(tmp_path / name)]) == 1
    said = capsys.readouterr().err
    assert said.startswith("error: ") and said.count("\n") == 1
    assert message in said
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_options_are_those_of_the_records(tmp_path, capsys):
    path = write_obj(tmp_path / "m.obj", *PATCH)
    with pytest.raises(SystemExit):
        main(["--help"])
    shown = capsys.readouterr().out
    for field in {f.name for kind in (sc.Options, sc.SeamOptions) for f in dataclasses.fields(kind)}:
        assert f"--{field.replace('_', '-')}" in shown
    given = ["--method", "lscm", "--hole-rigidity", "0", "--polish", "--no-fallbacks", "--seams", "keep"]
    assert main([str(path), *given]) == 0
    uv = read_uv(tmp_path / "m_uv.obj")[0]
    lscm = sc.unwrap(PATCH[0], *meshes.polygons(PATCH[1]), method="lscm", polish=True)
    assert meshes.similarity_deviation(uv, lscm.uv) < 1e-6


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--hole-rigidity", "much"], "hole_rigidity must lie between"),
        (["--tolerance", "1"], "tolerance must"),
        (["--max-length", "None"], "max_length must be a number"),
        (["--out", "m.ply"], "--out must end with .obj, which m.obj can be written as"),
        (["--margin", "2000"], "margin must be from 0 to less than texture_size"),
        (["--marg", "0.7"], "unrecognized arguments: --marg"),
        (["--seams", "smart"], "--seams smart needs Blender"),
    ],
)
def test_an_option_that_cannot_be_used(given, said, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["m.obj", *given])
    assert stopped.value.code == 2
    assert said in capsys.readouterr().err


def options_of(command, capsys):
    """The options of a command, as its help shows them."""
    with pytest.raises(SystemExit) as stopped:
        found = main([*command, "--help"])
        raise SystemExit(found)
    assert not stopped.value.code
    return set(re.findall(r"--[a-z][a-z-]+", capsys.readouterr().out.split("settings, in a settings file", 1)[1]))


def test_both_commands_have_the_same_settings_and_defaults(capsys, tmp_path):
    one, many = options_of([], capsys), options_of(["batch"], capsys)
    assert many - one == {"--unwrap", "--no-unwrap", "--checker", "--no-checker", "--picture-size", "--usd-over",
                          "--no-usd-over", "--keep-overlaps", "--no-keep-overlaps"}  # fmt: skip
    assert {"--uv-map", "--margin", "--texture-size", "--texel-density", "--udim", "--rotation"} <= one
    vertices, offsets, corners = box((1, 2, 3), 3)
    path = write_obj(tmp_path / "m.obj", vertices, np.split(corners, offsets[1:-1]))
    given = ["--margin", "8", "--texture-size", "512", "--udim", "2", "--rotation", "quarters"]
    assert main([str(path), *given]) == 0
    assert main(["batch", str(path), "--out", str(tmp_path / "out"), "--quiet", *given]) == 0
    assert (tmp_path / "out" / "m.obj" / "m.obj").read_bytes() == (tmp_path / "m_uv.obj").read_bytes()


def test_a_density_that_the_texture_has_no_room_for_is_said(tmp_path, capsys):
    path = write_obj(tmp_path / "m.obj", *PATCH)
    assert main([str(path), "--texel-density", "100"]) == 0
    uv = read_uv(tmp_path / "m_uv.obj")[0]
    mesh = meshes.mesh(PATCH[0], PATCH[1], uv=uv)
    measured = sc.face_distortion(mesh)
    assert np.sqrt(measured.image_area.sum() / measured.area.sum()) * 1024 == pytest.approx(100, rel=1e-3)
    assert main([str(path), "--texel-density", "100000"]) == 1
    assert "times the texture size" in capsys.readouterr().err


@pytest.mark.parametrize("command", [[], ["batch"], ["report"]])
def test_version(command, capsys):
    try:
        assert main([*command, "--version"]) == 0
    except SystemExit as end:
        assert not end.code
    assert capsys.readouterr().out == f"spectral_conformal {sc.__version__}\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["in.obj", "--method", "magic"], "magic"),
        (["in.obj", "--format", "stl"], "stl"),
        (["in.obj", "--require", "x<1"], "x"),
        (["in.obj", "--jobs", "0"], "0 is not a whole number of at least 1"),
        (["in.obj", "--jobs", "many"], "many is not a whole number of at least 1"),
        (["in.obj", "--seconds", "soon"], "soon is not a number above 0"),
        (["in.obj", "--settings", "missing.toml"], "missing.toml: no such file or directory."),
        (["missing.obj"], "missing.obj"),
        (["in.obj", "--blender", "/no/such"], "There is no program /no/such."),
        (["in.obj", "--require", ""], "--require: '' is not a comparison"),
    ],
)
def test_the_batch_says_in_one_line_what_cannot_be_done(arguments, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_obj(tmp_path / "in.obj", *PATCH)
    assert main(["batch", "--out", "out", *arguments]) == 64
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.startswith("error: ") and said in last
    assert "Errno" not in last and "_positive" not in last


def commands():
    return re.findall(r"^ {4}python -m spectral_conformal (.+)$", SCRIPTING.read_text(encoding="utf-8"), re.M)


@pytest.mark.parametrize("command", commands())
def test_commands_of_the_documents_run(command, tmp_path):
    arguments = shlex.split(command, comments=True)
    writer = {".obj": write_obj, ".off": write_off, ".ply": lambda *a: write_ply(*a, "binary_little_endian")}
    name = next(word for word in arguments if Path(word).suffix in writer)
    writer[Path(name).suffix](tmp_path / name, *PATCH)
    if arguments[0] == "report":
        assert main([str(tmp_path / name), "--out", str(tmp_path / name)]) == 0
    done = subprocess.run([sys.executable, "-m", "spectral_conformal", *arguments], cwd=tmp_path, capture_output=True)
    assert done.returncode == 0, done.stderr


def test_there_are_commands_in_the_documents():
    assert len(commands()) == 4


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        ([""], 2, "the mesh must be the name of a file"),
        (["missing.obj"], 1, "missing.obj: no such file or directory."),
        (["folder.obj", "--out", "x.obj"], 1, "folder.obj: is a directory."),
        (["ok.obj", "--out", "nowhere/x.obj"], 2, "there is no folder nowhere"),
        (["ok.obj", "--out", "folder.obj"], 2, "folder.obj is a folder"),
        (["ok.obj", "--qc-limit", "1.2", "--seams", "keep"], 2, "--qc-limit has an effect only with --seams suggest"),
        (["ok.obj", "--front", "0", "1", "0", "--seams", "keep"], 2, "--front has an effect only with --seams suggest"),
        (["deep.gltf"], 1, "deep.gltf: its JSON is nested too deeply"),
        (["report", "deep.gltf"], 1, "deep.gltf: its JSON is nested too deeply"),
        (["report", "missing.obj"], 1, "missing.obj: no such file or directory."),
        (["report", "ok.obj", "--require", "flips == 0"], 1, "ok.obj: required: a UV map, but there is none"),
        (["report", "ok.obj", "--require", ""], 2, "'' is not a comparison"),
    ],
)
def test_what_cannot_be_done_is_one_clear_line(arguments, code, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.obj").mkdir()
    (tmp_path / "ok.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "deep.gltf").write_text('{"a":' * 100_000 + "1" + "}" * 100_000)
    try:
        found = main(arguments)
    except SystemExit as end:
        found = end.code
    last = capsys.readouterr().err.splitlines()[-1]
    assert found == code and said in last and "Errno" not in last
    assert sorted(path.name for path in tmp_path.iterdir()) == ["deep.gltf", "folder.obj", "ok.obj"]


def test_what_cannot_be_written_is_named_as_the_user_named_it(tmp_path, monkeypatch, capsys):
    path = write_obj(tmp_path / "m.obj", *PATCH)

    whole = Path.open

    def full(file, mode="r", *arguments, **options):
        if "w" in mode:
            raise OSError(28, "No space left on device", str(file))
        return whole(file, mode, *arguments, **options)

    monkeypatch.setattr(Path, "open", full)
    assert main([str(path), "--out", str(tmp_path / "out.obj")]) == 1
    assert capsys.readouterr().err == f"error: {tmp_path / 'out.obj'}: no space left on device.\n"


def test_an_interrupted_command_says_so_without_a_traceback(tmp_path, monkeypatch, capsys):
    path = write_obj(tmp_path / "m.obj", *PATCH)

    def interrupted(*_arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("spectral_conformal.__main__.cut", interrupted)
    assert main([str(path)]) == 130
    assert capsys.readouterr().err == "error: interrupted.\n"
    assert [each.name for each in tmp_path.iterdir()] == ["m.obj"]


def test_the_pattern_lies_beside_the_result_in_true_size(tmp_path):
    vertices = np.array([(0.25 * i, 0.5 * j, 0.0) for i in range(4) for j in range(6)])
    write_obj(tmp_path / "a.obj", vertices, meshes.grid_quads(4, 6))
    assert main([str(tmp_path / "a.obj"), "--svg", "--unit", "cm", "--margin", "0"]) == 0
    text = (tmp_path / "a_uv.svg").read_text()
    sides = [float(re.search(rf'{name}="([\d.]+)mm"', text)[1]) - 0.2 for name in ("width", "height")]
    assert sorted(sides) == pytest.approx([7.5, 25.0], rel=1e-12)
