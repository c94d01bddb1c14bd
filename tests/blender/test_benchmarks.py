# SPDX-License-Identifier: GPL-3.0-or-later
"""Every figure of speed can be measured: all benchmarks, on tiny meshes."""

import importlib.util
import json
import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

from tests.benchmarks import bare_cholmod, figures, generated, operator_scenes, peers, runs, threads

# Writes the vertices' x and y as their map, as BFF's command line would.
FAKE_BFF = """#!/bin/sh
sed -n 's/^v \\([^ ]*\\) \\([^ ]*\\) .*/vt \\1 \\2/p' "$1" > "$2"
"""


@pytest.fixture
def program(tmp_path):
    """Return a function that makes a program of a shell script."""

    def make(text):
        path = tmp_path / "bff-command-line"
        path.write_text(text)
        path.chmod(0o755)
        return str(path)

    return make


@pytest.fixture
def run(tmp_path):
    """Return a function that runs the benchmarks on tiny meshes; it returns what they keep and what they print."""

    def measure(*arguments):
        result = tmp_path / "figures.json"
        command = [sys.executable, "-m", "tests.benchmarks", "--json", result, "--seconds", "0", *map(str, arguments)]
        done = subprocess.run(command, cwd=runs.ROOT, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(result.read_text()), done.stdout

    return measure


@pytest.mark.slow
def test_every_row_of_the_table_has_a_figure(run, program):
    kept, printed = run("table", "--scale", 0.002, "--bff", program(FAKE_BFF))
    found = {(entry["row"], entry["case"]): entry for entry in kept["table"]}
    assert set(found) == {(row.name, case) for row in figures.ROWS for case in row.reach}
    for entry in found.values():
        assert entry["reason"] == ""
        assert math.isfinite(entry["figure"])
        # Times need not grow on meshes as small as these.
        assert entry["figure"] > 0 or entry["row"] == "growth"
        assert entry["is_reached"] is None, "a tiny mesh says nothing about what is within reach"
    scenes = {key.split(": ")[1]: value for key, value in kept["measurements"].items() if "operators" in key}
    assert set(scenes) == set(operator_scenes.SCENES)
    for name, measured in scenes.items():
        phases = measured["phases"]
        # Several charts may be solved at once.
        assert not name.startswith("grid") or sum(measured["native_phases"].values()) < phases["native"]
        assert set(phases) == {"read", "native", "place", "write", "rest", "undo"}
        assert min(phases.values()) > 0
        assert {"charts", "assembly", "factorization", "eigenproblem", "quality"} <= set(measured["native_phases"])
        whole = sum(seconds for name, seconds in phases.items() if name != "undo")
        assert whole == pytest.approx(measured["seconds"])
    assert "| native, `parameterize`, s | vertices | charts | assembly | factorization |" in printed
    assert "| native, operator, s | vertices | charts | kept maps | assembly | factorization |" in printed


@pytest.mark.slow
def test_kinds_own_meshes_growth_and_the_plot(run, program, tmp_path):
    own = tmp_path / "own.obj"
    patch = generated.Scene(6).meshes()[0]
    generated.write_obj(own, patch.vertices, patch.triangles())
    plot = tmp_path / "plot.svg"
    drawn = ["--plot", plot] if importlib.util.find_spec("matplotlib") else []
    kept, _ = run("meshes", "growth", "--mesh", own, "--sizes", 16, 100, "--bff", program(FAKE_BFF), *drawn)
    (entry,) = kept["meshes"]
    assert (entry["mesh"], entry["vertices"]) == ("own.obj", 36)
    needed = {"unwrap", peers.LIBIGL, peers.BFF, "spectral", "CONFORMAL", "ANGLE_BASED"}
    assert needed <= set(entry["seconds"])
    assert peers.XATLAS in entry["seconds"] or "not installed" in entry["reasons"][peers.XATLAS]
    for name in ("spectral", "CONFORMAL", "ANGLE_BASED"):
        assert [n for n, _ in kept["growth"][name]] == [16, 100]
        assert all(seconds > 0 for _, seconds in kept["growth"][name])
    if drawn:
        assert "<svg" in plot.read_text()


def test_every_benchmark_can_be_imported():
    # In a process of its own, because some import bpy.
    names = sorted(path.stem for path in Path(runs.__file__).parent.glob("*.py"))
    imports = "\n".join(f"import tests.benchmarks.{name}" for name in names)
    done = subprocess.run([sys.executable, "-c", imports], cwd=runs.ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("words", "printed"),
    [
        ("working_maps {own}", "own"),
        ("working_maps --follow {own}", "| 36 |"),
        ("working_maps --reach {own}", "| 36 |"),
        ("suggested_seams {own}", "own"),
        ("packing --kinds organic --counts 3 --packers boxes --seconds 0", "| Blender, boxes |"),
        ("fold_free_maps {folder}", "| patches that cover themselves |"),
        ("compare_maps {own}", "at least as good as"),
        ("extender_response", "saddle"),
    ],
)
def test_benchmarks_that_no_other_test_runs(words, printed, tmp_path):
    own = tmp_path / "own.obj"
    patch = generated.Scene(6).meshes()[0]
    generated.write_obj(own, patch.vertices, patch.triangles())
    command = [sys.executable, "-m", *f"tests.benchmarks.{words}".format(own=own, folder=tmp_path).split()]
    done = subprocess.run(command, cwd=runs.ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert printed in done.stdout


def test_generated_meshes_are_of_their_kind():
    scenes = {name: scene.meshes() for name, scene in generated.kinds(900).items()}
    assert {name for name, meshes in scenes.items() if len(meshes) > 1} == {"many objects"}
    for name, meshes in scenes.items():
        for mesh in meshes:
            assert len(np.unique(mesh.triangles())) == len(mesh.vertices)
            assert set(np.diff(mesh.face_offsets)) == ({3} if "triangles" in name else {4})
    quads, numbered = scenes["quads"][0], scenes["quads numbered at random"][0]
    assert sorted(map(tuple, quads.vertices)) == sorted(map(tuple, numbered.vertices))
    assert not np.array_equal(quads.vertices, numbered.vertices)
    assert np.ptp(scenes["noisy quads"][0].vertices - quads.vertices) > 0


def test_bff_is_called_with_a_file_to_read_and_one_to_write(program):
    mesh = generated.Scene(5, is_triangulated=True).meshes()[0]
    arguments = peers.BFF, mesh.vertices, mesh.triangles()
    assert peers.measure(*arguments, program(FAKE_BFF))["seconds"] > 0
    assert "--bff" in peers.measure(*arguments)["reason"]
    with pytest.raises(RuntimeError, match="ended with 3"):
        peers.measure(*arguments, program("#!/bin/sh\nexit 3\n"))
    with pytest.raises(RuntimeError, match="no map"):
        peers.measure(*arguments, program('#!/bin/sh\ncp "$1" "$2"\n'))


def test_bare_cholmod_calls_the_blas_of_the_module():
    if not bare_cholmod.LIBRARY:
        pytest.skip("the module has no CHOLMOD")
    matrix = scipy.sparse.identity(50, format="csc", dtype=complex) * 2.0
    analyze, factorize = bare_cholmod.seconds_to_factor(matrix, 2)
    assert min(analyze, factorize) > 0
    # NumPy and SciPy have their own OpenBLAS, under other names.
    libraries = {
        Path(line.split()[-1]).name for line in Path("/proc/self/maps").read_text().splitlines() if "/" in line
    }
    assert {name for name in libraries if "cholmod" in name} == {bare_cholmod.LIBRARY.name}
    assert {name for name in libraries if re.match(r"lib(blas|lapack|flexiblas)\b", name)} == set()
    assert bare_cholmod.blas().startswith("OpenBLAS ")


def test_serial_parts_follow_from_one_thread_and_two():
    assert [threads.serial_share(1.0, two) for two in (0.4, 0.5, 0.75, 1.0, 1.2)] == [0.0, 0.0, 0.5, 1.0, 1.0]
    assert threads.bound(0.0) == 16
    assert threads.bound(1.0) == 1
    assert threads.bound(0.5, cores=2) == pytest.approx(4 / 3)
    one = threads.Call(10.0, 10.0, {"parallel": 6.0, "serial": 3.0, "small": 0.5, "half": 0.5})
    two = threads.Call(6.75, 10.0, {"parallel": 3.0, "serial": 3.0, "small": 0.5, "half": 0.25})
    assert threads.serial_parts(one, two) == {"serial": pytest.approx(0.3)}


def test_threads_are_measured():
    command = [sys.executable, "-m", "tests.benchmarks.threads", "--scale", "0.001", "unwrap, one", "pack, first"]
    done = subprocess.run(command, cwd=runs.ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows = [line for line in done.stdout.splitlines() if line.startswith("| `")]
    assert len(rows) == 2
    assert all(re.search(r"\| \d\.\d{3} \(\d\.\d{3}\) \| .* times \|", row) for row in rows)
