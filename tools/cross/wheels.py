# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemble a target's wheels: package, native module, OpenBLAS, and the licenses of all parts."""

from __future__ import annotations

import shutil
from pathlib import Path

from tools import steps
from tools.cross import compilers, native, parts
from tools.cross.targets import PYTHONS, WHEELS, Target
from tools.environment import PYTHON
from tools.licenses import of_debian, of_headers, of_pip, texts
from tools.steps import ROOT, StepError
from tools.wheels import pack as pack_wheel
from tools.wheels import python_tag

PACKAGE = ROOT / "native" / "python" / "spectral_conformal"
METADATA = parts.CROSS / "metadata"
LOG = "cross-wheels"


def make(target: Target) -> list[Path]:
    """Write the wheels of a target to build/cross/wheels/ and return them; its native part must be built."""
    WHEELS.mkdir(parents=True, exist_ok=True)
    origin = metadata()
    found = licenses(target)
    return [pack(target, python, origin, found) for python in PYTHONS]


def pack(target: Target, python: str, origin: Path, found: dict[str, bytes]) -> Path:
    """Write the wheel for one Python and return it."""
    tree = target.folder / "wheel" / origin.name.removesuffix(".dist-info")
    shutil.rmtree(tree.parent, ignore_errors=True)
    package = tree / PACKAGE.name
    for path in steps.source_files(PACKAGE):
        place(path, package / path.relative_to(PACKAGE))
    place(native.module(target, python), package / target.module_name(python))
    place(native.blas_to_ship(target), package / target.blas_name)
    information = tree / origin.name
    for path in steps.source_files(origin):
        place(path, information / path.relative_to(origin))
    for name, content in found.items():
        (information / "licenses" / name).write_bytes(content)
    tag = f"{python_tag(python)}-{python_tag(python)}-{target.tag}"
    (information / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: spectral-unwrap\nRoot-Is-Purelib: false\nTag: {tag}\n"
    )
    for path in tree.rglob("*"):
        # A module need not be executable, and the zip records permissions.
        path.chmod(0o755 if path.is_dir() else 0o644)
    pack_wheel(tree, WHEELS, log=LOG)
    return wheel(target, python)


def wheel(target: Target, python: str) -> Path:
    """Return the path of a target's wheel for a Python."""
    tag = python_tag(python)
    found = sorted(WHEELS.glob(f"spectral_conformal-*-{tag}-{tag}-{target.tag}.whl"))
    if len(found) != 1:
        raise StepError(
            f"{WHEELS} should hold one wheel for {target.name} and Python {python} and holds {len(found)}: remove this "
            f"folder and run build_addon.py package --platforms {target.name}"
        )
    return found[0]


def place(origin: Path, path: Path) -> None:
    """Copy a file and create its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(origin, path)


def metadata() -> Path:
    """Return the .dist-info folder that the build backend makes from pyproject.toml."""
    state = steps.digest([ROOT / "pyproject.toml", ROOT / "README.md", ROOT / "LICENSE"])
    if not steps.is_done("cross-metadata", state) or not any(METADATA.glob("*.dist-info")):
        shutil.rmtree(METADATA, ignore_errors=True)
        METADATA.mkdir(parents=True)
        ask = (
            "import sys; from scikit_build_core.build import prepare_metadata_for_build_wheel as ask; ask(sys.argv[1])"
        )
        steps.run("writing the wheels' metadata", [PYTHON, "-c", ask, METADATA], log=LOG)
        steps.mark_done("cross-metadata", state)
    return next(METADATA.glob("*.dist-info"))


def licenses(target: Target) -> dict[str, bytes]:
    """Return the license texts, by file name, of the code compiled into the module and of OpenBLAS beside it."""
    source = parts.suitesparse()
    suitesparse = ("AMD", "CAMD", "CCOLAMD", "CHOLMOD", "COLAMD")
    files = {
        **of_headers(),
        "openblas-and-libgfortran": of_pip(parts.openblas(target), "scipy_openblas32"),
        "pybind11": of_pip(parts.PARTS / "pybind11", "pybind11"),
        "metis": source / "metis-5.1.0" / "LICENSE.txt",
        **{f"suitesparse-{name.lower()}": source / name / "Doc" / "License.txt" for name in suitesparse},
    }
    if target.system == "Windows":
        files["mingw-w64"] = of_debian("mingw-w64-common")
        files["libgcc-and-libstdc++"] = of_debian("gcc-mingw-w64-base")
    else:
        libraries = compilers.ZIG.parent / "lib"
        files |= {f"llvm-{name}": libraries / name / "LICENSE.TXT" for name in ("libcxx", "libcxxabi", "libunwind")}
        files["zig-compiler-rt"] = compilers.ZIG.parent / "LICENSE"
    return texts(files)
