# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped zips, installed into fresh profiles of the oldest and the newest Blender at hand."""

import importlib.util
import json
import math
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = Path(__file__).with_name("installation.py")
PACKAGES = ROOT / "build" / "packages"


def build_packages():
    """Run the command that users run and return its zips, the legacy one first."""
    result = subprocess.run(
        [sys.executable, "build_addon.py", "package"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return sorted(PACKAGES.glob("*.zip"), key=lambda path: "legacy" not in path.name)


@pytest.fixture(scope="module")
def packages():
    found = build_packages()
    assert len(found) == 2
    return found


@pytest.fixture
def profile(tmp_path):
    """Return the environment of a Blender that has never run and knows nothing of build/venv."""
    inherited = ("PYTHON", "BLENDER_", "VIRTUAL_ENV")
    environ = {name: value for name, value in os.environ.items() if not name.startswith(inherited)}
    folders = {name: tmp_path / "profile" / name.lower() for name in ("CONFIG", "SCRIPTS", "DATAFILES", "EXTENSIONS")}
    for folder in folders.values():
        folder.mkdir(parents=True)
    home = tmp_path / "home"
    home.mkdir()
    return {**environ, **{f"BLENDER_USER_{name}": str(path) for name, path in folders.items()}, "HOME": str(home)}


@pytest.fixture
def bpy_alone(profile, tmp_path):
    """Return an environment whose Python has the bpy of build/venv, but not its spectral_conformal."""
    spec = importlib.util.find_spec("bpy")
    if spec is None:
        pytest.skip("no bpy for this Python")
    site = tmp_path / "site"
    site.mkdir()
    for path in Path(spec.origin).parents[1].iterdir():
        if not path.name.startswith("spectral_conformal"):
            (site / path.name).symlink_to(path)
    return {**profile, "PYTHONPATH": str(site)}


def install(command, package, profile, tmp_path):
    """Run installation.py in a Blender and return what it saw."""
    seen = tmp_path / "seen.json"
    result = subprocess.run(
        [*command, SCRIPT, "--", package, seen], env=profile, cwd=tmp_path, capture_output=True, text=True, check=False,
        timeout=300,
    )  # fmt: skip
    assert seen.is_file(), result.stdout[-4000:] + result.stderr[-4000:]
    return json.loads(seen.read_text())


def check(seen, tmp_path):
    """Check the steps of installation.py and that nothing is left behind."""
    assert seen["installed"]["enabled"]
    assert seen["installed"]["operator"]
    assert seen["installed"]["menu entries"]
    for unwrapped in (seen["first"], seen["second"]):
        assert unwrapped["result"] == ["FINISHED"]
        assert unwrapped["finite"]
        # A cylinder is developable: its 32 sides of height 2 become a rectangle, whatever its place in the tile.
        assert unwrapped["aspect"] == pytest.approx(32 * math.sin(math.pi / 32), rel=1e-4)
    assert seen["disabled"] == seen["before"]
    assert seen["after"] == seen["before"]
    left = [path for path in (tmp_path / "profile").rglob("*") if re.search("spectral", path.name)]
    assert left == []


def foreign_libraries(seen, tmp_path):
    """Return numerical libraries of the system that the package loaded although it brings its own along."""
    names = re.compile(r"cholmod|openblas|lapack|blas|metis|colamd|gfortran|suitesparse")
    ours = [path for path in seen["libraries"] if names.search(Path(path).name) and "spectral_conformal" in path]
    assert any("cholmod" in path for path in ours), "the native module was not loaded from the package"
    return [path for path in seen["libraries"] if names.search(Path(path).name) and not path.startswith(str(tmp_path))]


def test_zips_are_reproducible(packages):
    before = [path.read_bytes() for path in packages]
    assert [path.read_bytes() for path in build_packages()] == before


def test_legacy_zip_is_one_folder_without_a_manifest(packages):
    names = zipfile.ZipFile(packages[0]).namelist()
    assert {name.split("/")[0] for name in names} == {"spectral_unwrap"}
    assert "spectral_unwrap/__init__.py" in names
    assert not [name for name in names if "manifest" in name or "__pycache__" in name or "/." in name]


def test_legacy_zip_in_the_systems_blender(packages, profile, tmp_path):
    blender = shutil.which("blender")
    if not blender:
        pytest.skip("no system Blender")
    seen = install([blender, "--background", "--factory-startup", "--python"], packages[0], profile, tmp_path)
    if seen["version"] >= [4, 2, 0]:
        pytest.skip("the system's Blender takes the extension")
    check(seen, tmp_path)
    assert foreign_libraries(seen, tmp_path) == []


def test_extension_in_bpy(packages, bpy_alone, tmp_path):
    seen = install([sys._base_executable], packages[1], bpy_alone, tmp_path)
    check(seen, tmp_path)
    assert foreign_libraries(seen, tmp_path) == []
