# SPDX-License-Identifier: GPL-3.0-or-later
"""The source distribution: its content, its installation by pip, and its message if headers are missing."""

import re
import shutil
import subprocess
import sys
import tarfile
import venv
from pathlib import Path

import pytest
from scikit_build_core.build import build_sdist

from tools import environment, solver_libraries

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sdist")
    return folder / build_sdist(str(folder))


@pytest.fixture(scope="module")
def unpacked(sdist, tmp_path_factory):
    folder = tmp_path_factory.mktemp("unpacked")
    with tarfile.open(sdist) as archive:
        # Python 3.14 wants one; those before 3.11.4 have none.
        archive.extraction_filter = getattr(tarfile, "data_filter", None)
        archive.extractall(folder)
    (project,) = folder.iterdir()
    return project


def test_it_has_what_compiles_and_nothing_else(unpacked):
    tracked = subprocess.run(
        ["git", "ls-files", "native", "CMakeLists.txt", "LICENSE", "README.md", "pyproject.toml"],
        cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True,
    ).stdout.splitlines()  # fmt: skip
    there = {name for name in tracked if (ROOT / name).is_file()}
    found = {str(path.relative_to(unpacked)) for path in unpacked.rglob("*") if path.is_file()}
    assert found == there | {"PKG-INFO"}


def test_pip_installs_it(sdist, tmp_path):
    # The library is compiled already: what is compiled here is what depends on Python.
    fresh = tmp_path / "venv"
    venv.create(fresh, with_pip=True)
    python = fresh / "bin" / "python"
    install = [python, "-m", "pip", "install", "numpy<2" if sys.version_info < (3, 13) else "numpy", sdist]
    defined = {"SPECTRAL_CONFORMAL_BUILT": environment.NATIVE_BUILD, **solver_libraries.settings()}
    settings = [f"--config-settings=cmake.define.{name}={value}" for name, value in defined.items()]
    result = subprocess.run([*install, *settings], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert result.returncode == 0, result.stdout
    script = """
import spectral_conformal as sc
print(sc.__version__, sc.unwrap([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]]).charts[0].status)
"""
    said = subprocess.run([python, "-c", script], cwd=tmp_path, check=True, stdout=subprocess.PIPE, text=True).stdout
    assert re.fullmatch(r"\d+\.\d+\.\d+ solved\n", said)


@pytest.mark.parametrize(
    ("given", "named", "packages"),
    [
        (
            (),
            ["Eigen 3.4 or later", "CGAL", "Boost"],
            "libeigen3-dev libcgal-dev libboost-dev",
        ),
        (("SPECTRA_INCLUDE_DIR",), ["Eigen 3.4 or later", "CGAL", "Boost"], "libeigen3-dev libcgal-dev libboost-dev"),
    ],
)
def test_missing_headers_are_named_at_once(unpacked, tmp_path, given, named, packages):
    nowhere = [f"-DCMAKE_FIND_USE_{place}=OFF" for place in (
        "CMAKE_SYSTEM_PATH", "SYSTEM_ENVIRONMENT_PATH", "CMAKE_ENVIRONMENT_PATH", "INSTALL_PREFIX", "PACKAGE_REGISTRY",
        "SYSTEM_PACKAGE_REGISTRY",
    )]  # fmt: skip
    ninja, compiler = Path(sys.executable).with_name("ninja"), shutil.which("c++")
    programs = ["-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={ninja}", f"-DCMAKE_CXX_COMPILER={compiler}"]
    given = [f"-D{name}={tmp_path}" for name in given]
    result = subprocess.run(
        [sys.executable, "-m", "cmake", "-S", unpacked, "-B", tmp_path / "build", *programs, *nowhere, *given],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert result.returncode != 0
    assert result.stdout.count("CMake Error") == 1, result.stdout
    said = result.stdout.partition("Headers of these libraries are missing:")[2]
    assert [line.strip() for line in said.partition("Install them")[0].splitlines() if line.strip()] == named
    assert f"apt-get install {packages}" in " ".join(said.split())
