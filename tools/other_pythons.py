# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module for the Pythons of other systems; their wheels reuse the compiled library."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Collection
from pathlib import Path

from tools import packaging, solver_libraries, steps, systems, wheels
from tools.environment import NATIVE_BUILD, PYTHON, VENV, compile_jobs, install_newest_bpy, site_packages, wheel
from tools.steps import BUILD, ROOT
from tools.systems import System

FOLDER = BUILD / "other-pythons"
INPUTS = ("CMakeLists.txt", "native")


def set_up(suites: Collection[str]) -> None:
    """Make these systems if they are possible on this machine, and the module and bpy for their Pythons."""
    with steps.exclusive():
        systems.make_all(suites)
        made = [system for system in systems.wanted() if system.is_made and system.suite in suites]
        for system in made:
            build(system)
        if systems.TRIXIE in made:
            install_newest_bpy()


def site(version: str) -> Path:
    """Return the folder with the module and its libraries, for the path of such a Python."""
    return FOLDER / wheels.python_tag(version) / "site"


def repaired_wheel(version: str) -> Path:
    """Return the self-contained wheel for a Python version."""
    (found,) = (FOLDER / wheels.python_tag(version) / "repaired").glob("*.whl")
    return found


def build(system: System) -> None:
    """Build the module for the Python of a system, unless its inputs are unchanged."""
    version = system.python
    folder = FOLDER / wheels.python_tag(version)
    state = steps.digest([version, wheel(), Path(wheels.__file__), *(ROOT / name for name in INPUTS)])
    if steps.is_done(folder.name, state) and site(version).is_dir():
        return
    shutil.rmtree(folder, ignore_errors=True)
    native = compile_bindings(system, folder / "build")
    unrepaired = pack(native, version, folder)
    with zipfile.ZipFile(wheels.repair(unrepaired, folder / "repaired")) as archive:
        archive.extractall(site(version))
    steps.mark_done(folder.name, state)


def compile_bindings(system: System, folder: Path) -> Path:
    """Compile the bindings and link them to the library; return the extension module."""
    version = system.python
    headers = system.folder / "usr" / "include"
    # Debian keeps pyconfig.h in the architecture's folder, beside that system's C library, which must not be used.
    beside = folder / "headers" / "x86_64-linux-gnu"
    beside.mkdir(parents=True)
    (beside / f"python{version}").symlink_to(headers / "x86_64-linux-gnu" / f"python{version}")
    abi = f"cpython-{version.replace('.', '')}-x86_64-linux-gnu"
    definitions = {
        "CMAKE_UNITY_BUILD": "ON",
        "CMAKE_MAKE_PROGRAM": PYTHON.parent / "ninja",
        "pybind11_DIR": site_packages(VENV) / "pybind11" / "share" / "cmake" / "pybind11",
        "CMAKE_CXX_FLAGS": f"-isystem {beside.parent}",
        "SPECTRAL_CONFORMAL_BUILT": NATIVE_BUILD,
        "SPECTRAL_CONFORMAL_OTHER_PYTHON": "ON",
        "Python_INCLUDE_DIR": headers / f"python{version}",
        "Python_SOABI": abi,
        "PYTHON_MODULE_EXTENSION": f".{abi}.so",
        **solver_libraries.settings(),
    }
    cmake = PYTHON.parent / "cmake"
    steps.run(
        f"configuring for Python {version}",
        [cmake, "-S", ROOT, "-B", folder, "-G", "Ninja", *(f"-D{name}={value}" for name, value in definitions.items())],
        log="other-pythons",
    )
    steps.run(
        f"compiling for Python {version}", [cmake, "--build", folder, "--parallel", compile_jobs()], log="other-pythons"
    )
    return folder / f"_native.{abi}.so"


def pack(native: Path, version: str, folder: Path) -> Path:
    """Make a copy of this Python's wheel with another extension module; return it."""
    own_tag = packaging.python_tag(wheel())
    with wheels.unpacked(wheel(), folder) as content:
        (own,) = content.glob("spectral_conformal/_native*.so")
        own.unlink()
        shutil.copy2(native, own.parent)
        (information,) = content.glob("*.dist-info/WHEEL")
        information.write_text(information.read_text().replace(own_tag, wheels.python_tag(version)))
    (packed,) = folder.glob("spectral_conformal-*.whl")
    return packed
