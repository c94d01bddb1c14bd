# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of `package --platforms` that need no compiler: names, tags, files for linkers, notes."""

import sys
import zipfile
from pathlib import Path

import pytest

import build_addon
from tools import packaging
from tools.cross import native, notes, parts, targets, wine
from tools.steps import StepError
from tools.wheels import python_tag

ALL = targets.TARGETS


@pytest.mark.parametrize("names", [["windows"], ["linux-x64", "amiga"]])
def test_unknown_platform_is_named_before_anything_is_installed(names, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["build_addon.py", "package", "--platforms", *names])
    monkeypatch.setattr(build_addon.environment, "set_up", lambda *_, **__: pytest.fail("something is set up"))
    assert build_addon.main() == 1
    message = capsys.readouterr().err
    assert f"No platform is called {names[-1]}" in message
    assert all(target.name in message for target in ALL)


def test_platforms_are_chosen_by_name_in_the_order_of_the_table():
    assert targets.named(["all"]) == list(ALL)
    assert [target.name for target in targets.named(["linux-x64", "windows-x64"])] == ["windows-x64", "linux-x64"]


@pytest.mark.parametrize("target", ALL, ids=lambda target: target.name)
def test_tag_of_a_wheel_is_one_that_blender_knows(target):
    for python in targets.PYTHONS:
        tag = python_tag(python)
        wheel = Path(f"spectral_conformal-1.0-{tag}-{tag}-{target.tag}.whl")
        assert packaging.blender_platform(wheel) == target.name
        assert packaging.python_tag(wheel) == tag


def test_native_module_has_the_name_that_each_python_looks_for():
    found = {target.name: target.module_name("3.11") for target in ALL}
    assert found == {
        "windows-x64": "_native.cp311-win_amd64.pyd",
        "linux-x64": "_native.cpython-311-x86_64-linux-gnu.so",
        "linux-arm64": "_native.cpython-311-aarch64-linux-gnu.so",
        "macos-arm64": "_native.cpython-311-darwin.so",
        "macos-x64": "_native.cpython-311-darwin.so",
    }


def test_windows_links_to_openblas_by_its_name_in_the_wheel():
    (target,) = targets.named(["windows-x64"])
    lines = native.module_definition(target).splitlines()
    assert lines[:2] == ["LIBRARY spectral_conformal_openblas.dll", "EXPORTS"]
    assert {"zpotrf_", "ztrsv_", "zgemv_", "dpotrf_"} <= set(lines)


def test_macos_links_to_openblas_beside_the_module():
    (target,) = targets.named(["macos-x64"])
    stub = native.text_stub(target)
    assert "install-name: '@loader_path/libspectral_conformal_openblas.dylib'" in stub
    assert "targets: [ x86_64-macos ]" in stub
    assert "_scipy_zpotrf_" in stub


def test_every_function_of_the_blas_that_the_sources_call_is_linked_to():
    recipe = (native.RECIPES / "CMakeLists.txt").read_text()
    assert all(name in recipe for name in native.BLAS_FUNCTIONS)
    assert {"zgemv_", "zpotrf_", "ztrsv_"} <= set(native.BLAS_FUNCTIONS)


def test_pyconfig_has_the_sizes_of_the_target():
    sizes = {target.name: parts.pyconfig(target) for target in ALL if target.system != "Windows"}
    assert "SIZEOF_LONG_DOUBLE 8" in sizes["macos-arm64"]
    assert "SIZEOF_LONG_DOUBLE 16" in sizes["macos-x64"]
    assert "SIZEOF_PTHREAD_KEY_T 4" in sizes["linux-arm64"]
    assert "_POSIX_C_SOURCE" not in sizes["macos-arm64"]


def test_sources_of_packages_become_sources_of_source_packages():
    one_line = "# a comment\ndeb [signed-by=/key] http://mirror suite main\ndeb-src http://mirror suite main\n"
    assert parts.source_packages(one_line).splitlines() == [
        "# a comment",
        "deb-src [signed-by=/key] http://mirror suite main",
        "deb-src http://mirror suite main",
    ]
    fields = "Types: deb\nURIs: http://mirror\nSuites: suite\n"
    assert parts.source_packages(fields) == "Types: deb-src\nURIs: http://mirror\nSuites: suite\n"


@pytest.mark.parametrize("target", ALL, ids=lambda target: target.name)
def test_notes_say_what_was_run_and_what_was_not(target):
    text = notes.text(target, "1.2.3")
    lines = " ".join(text.split())
    assert text.startswith(f"Spectral Unwrap 1.2.3 for {target.name}\n")
    assert target.was_run in lines
    assert all(f"{other.name}: {other.was_run}" in lines for other in ALL if other is not target)
    assert max(map(len, text.splitlines())) <= notes.WIDTH
    if target.system == "Darwin":
        assert "Nobody has run it" in target.was_run


def test_library_for_wine_has_complex_functions_and_hands_the_rest_on():
    lines = wine.math_definition(["sin", "cexp", "csqrtl"]).splitlines()
    assert "cexp" in lines
    assert "cexpl = cexp" in lines
    assert "sin = ucrtbase.sin" in lines
    assert not [line for line in lines if "ucrtbase.c" in line]
    assert len(wine.MATH) == len(wine.OWN_MATH)


def test_paths_for_programs_under_wine():
    assert wine.windows_path(Path("/some/folder")) == "Z:\\some\\folder"


def test_legacy_zip_takes_licenses_of_others_out_of_the_wheel(tmp_path):
    wheel = tmp_path / "spectral_conformal-1.0-cp311-cp311-win_amd64.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        for name in ("LICENSE", "openblas.txt"):
            archive.writestr(f"spectral_conformal-1.0.dist-info/licenses/{name}", name)
    files = packaging.legacy_files(wheel)
    assert files["spectral_unwrap/licenses/openblas.txt"] == b"openblas.txt"
    assert not [name for name in files if "dist-info" in name]


@pytest.mark.parametrize("count", [0, 2])
def test_wheel_that_is_not_there_once_is_told(count, tmp_path, monkeypatch):
    monkeypatch.setattr(targets, "WHEELS", tmp_path)
    monkeypatch.setattr("tools.cross.wheels.WHEELS", tmp_path)
    from tools.cross import wheels

    for number in range(count):
        (tmp_path / f"spectral_conformal-{number}-cp311-cp311-win_amd64.whl").touch()
    with pytest.raises(StepError, match=f"holds {count}: .*--platforms windows-x64"):
        wheels.wheel(ALL[0], "3.11")
