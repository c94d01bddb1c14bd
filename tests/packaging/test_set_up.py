# SPDX-License-Identifier: GPL-3.0-or-later
"""The set-up behind build_addon.py: its requirements, and that a failed or changed step runs again."""

import ctypes
import subprocess
import sys

import pytest

import build_addon
from tools import environment, solver_libraries, steps
from tools.cross import notes, targets


@pytest.fixture
def build_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(steps, "ROOT", tmp_path)
    monkeypatch.setattr(steps, "LOGS", tmp_path / "logs")
    monkeypatch.setattr(steps, "STAMPS", tmp_path / "stamps")
    return tmp_path


def test_one_line_names_missing_packages_where_nothing_can_be_installed(monkeypatch):
    monkeypatch.setitem(environment.APT, "build", ["g++", "no-such-package"])
    monkeypatch.setattr(environment, "as_root", lambda: None)
    with pytest.raises(steps.StepError, match=r"sudo apt-get install --no-install-recommends .*no-such-package"):
        environment.install_system_packages(["build"])


def test_failed_step_shows_the_end_of_its_output_and_names_the_log(build_folder, capsys):
    program = "print('first'); print('the reason'); raise SystemExit(3)"
    with pytest.raises(steps.StepError, match=r"(?s)the reason.*exit code 3.*sample\.log"):
        steps.run("a step", [sys.executable, "-c", program], log="sample")
    assert capsys.readouterr().out == "- a step ... failed\n"


def test_missing_program_is_named(build_folder):
    with pytest.raises(steps.StepError, match="no-such-program is not installed"):
        steps.run("a step", ["no-such-program"], log="sample")


def test_step_is_done_for_one_state_of_its_inputs(build_folder):
    source = build_folder / "source.txt"
    source.write_text("one")
    before = steps.digest([source])
    assert not steps.is_done("sample", before)
    steps.mark_done("sample", before)
    assert steps.is_done("sample", steps.digest([source]))
    source.write_text("two")
    assert not steps.is_done("sample", steps.digest([source]))


def test_digest_of_a_folder_sees_renamed_files(build_folder):
    folder = build_folder / "sources"
    folder.mkdir()
    (folder / "a").write_text("same")
    before = steps.digest([folder])
    (folder / "a").rename(folder / "b")
    assert steps.digest([folder]) != before


def test_source_files_leave_caches_out(build_folder):
    for name in ("core/kept.py", "core/__pycache__/kept.pyc", ".ruff_cache/x", "core/.hidden"):
        (build_folder / name).parent.mkdir(exist_ok=True, parents=True)
        (build_folder / name).touch()
    assert steps.source_files(build_folder) == [build_folder / "core" / "kept.py"]


@pytest.mark.parametrize(
    ("arguments", "suites"),
    [
        (["--quick", "-x"], []),
        (["-m", "core", "-x"], []),
        (["--blender", "sid"], ["sid"]),
        (["--blender=trixie", "-k", "sid_"], ["trixie"]),
        (["--all", "-x"], ["trixie", "sid"]),
    ],
)
def test_blenders_are_set_up_for_tests_that_need_them(arguments, suites, monkeypatch):
    groups, passed_on, systems_made = [], [], []
    monkeypatch.setattr(sys, "argv", ["build_addon.py", "test", *arguments])
    monkeypatch.setattr(environment, "set_up", lambda *names: groups.extend(names))
    monkeypatch.setattr(build_addon.other_pythons, "set_up", systems_made.extend)
    monkeypatch.setattr(environment, "run_pytest", lambda words: passed_on.extend(words) or 0)
    assert build_addon.main() == 0
    needed = [name for group in groups for name in (*environment.APT[group], *environment.PIP[group])]
    is_quick = "--quick" in arguments
    assert any("blender" in name or "bpy" in name for name in needed) != is_quick
    assert {"pytest", "ruff", "clang-format==14.0.6", "git"} <= set(needed)
    assert ("all" in groups, systems_made) == (bool(suites), suites)
    assert passed_on == (["-m", environment.QUICK, "-x"] if is_quick else arguments)


def test_one_release_of_openblas_is_named_everywhere():
    workflow = (steps.ROOT / ".github" / "workflows" / "wheels.yml").read_text()
    assert f"scipy-openblas32=={environment.OPENBLAS} " in workflow
    assert f"scipy-openblas32=={environment.OPENBLAS}" in environment.PIP["build"]
    assert f"OpenBLAS {environment.OPENBLAS} " in " ".join(notes.text(targets.TARGETS[0], "1.0").split())


@pytest.fixture
def solver_folder(tmp_path, monkeypatch):
    for name, file in (("FOLDER", ""), ("OPENBLAS", "libopen.so"), ("CHOLMOD", "libchol.so")):
        monkeypatch.setattr(solver_libraries, name, tmp_path / "libraries" / file)
    monkeypatch.setattr(steps, "STAMPS", tmp_path / "stamps")
    return tmp_path


def test_without_cholmod_there_are_no_solver_libraries(solver_folder, monkeypatch):
    monkeypatch.setattr(solver_libraries, "cholmod_of_system", lambda: None)
    solver_libraries.make(environment.PYTHON)
    assert solver_libraries.settings() == {}


def test_cholmod_is_bound_to_openblas(solver_folder, monkeypatch):
    """Small libraries of the same shape: what calls the plain names calls the other's prefixed ones, and no third."""
    systems = compiled(solver_folder, "blas", "int dgemm_(void) { return 1; }", "-Wl,-soname,libblas.so.3")
    ours = compiled(solver_folder, "openblas", "int scipy_dgemm_(void) { return 2; }")
    code = "int dgemm_(void); int solve(void) { return dgemm_(); }"
    cholmod = compiled(solver_folder, "cholmod", code, systems)
    monkeypatch.setattr(solver_libraries, "cholmod_of_system", lambda: cholmod)
    monkeypatch.setattr(solver_libraries, "openblas_of", lambda _python: ours)
    solver_libraries.make(environment.PYTHON)
    systems.unlink()
    assert ctypes.CDLL(str(solver_libraries.CHOLMOD)).solve() == 2
    before = solver_libraries.CHOLMOD.stat().st_mtime_ns
    solver_libraries.make(environment.PYTHON)
    assert solver_libraries.CHOLMOD.stat().st_mtime_ns == before


def compiled(folder, name, code, *options):
    """Return a shared library made of some C."""
    source = folder / f"{name}.c"
    source.write_text(code)
    path = source.with_suffix(".so")
    subprocess.run(["gcc", "-shared", "-fPIC", source, "-o", path, *options], check=True)
    return path
