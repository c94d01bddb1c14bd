# SPDX-License-Identifier: GPL-3.0-or-later
"""Run programs for Windows under Wine: Windows' Python with packages, and Blender as the module bpy."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from tools import steps
from tools.cross import compilers, emulated, parts, targets
from tools.environment import PYTHON
from tools.steps import BUILD, StepError

FOLDER = BUILD / "wine"
PREFIX = FOLDER / "prefix"
LOG = "wine"
ENVIRONMENT = {"WINEPREFIX": str(PREFIX), "WINEARCH": "win64", "WINEDEBUG": "-all", "LC_ALL": "C.UTF-8"}
# By Python: the Blender for Windows with it.
BPY = {"3.11": "5.0.1", "3.13": "5.2.3"}
# pip does not see that pytest needs colorama on Windows.
PACKAGES = ("colorama", "libigl", "pytest", "scipy")
# Wine 8 lacks C's complex functions, which NumPy calls. Programs load our own library instead of Windows' math library;
# its name is patched into their files and has the same length.
MATH = "api-ms-win-crt-math-l1-1-0.dll"
OWN_MATH = "wine-crt-math-complex-l1-1.dll"
COMPLEX_FUNCTIONS = (
    *("cabs", "cacos", "cacosh", "carg", "casin", "casinh", "catan", "catanh", "ccos", "ccosh", "cexp", "cimag"),
    *("clog", "conj", "cpow", "cproj", "creal", "csin", "csinh", "csqrt", "ctan", "ctanh"),
)


def run(
    words: Sequence[object], *, environ: Mapping[str, str] | None = None, folder: Path = BUILD, timeout: float = 300
) -> subprocess.CompletedProcess[str]:
    """Run a program for Windows; its output goes through pipes, since Python under Wine cannot write to files."""
    prefix()
    return emulated.run(["wine", *words], environ=environment(environ), folder=folder, timeout=timeout)


def environment(more: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return the environment of programs under Wine, without the variables of this machine's Python and Blender."""
    return emulated.environment({**ENVIRONMENT, **(more or {})})


def windows_path(path: Path) -> str:
    """Return a file's path as programs under Wine see it."""
    return "Z:" + str(path.resolve()).replace("/", "\\")


def prefix() -> None:
    """Make the folder of a Windows installation, once."""
    if steps.is_done("wine-prefix", "win10") and PREFIX.is_dir():
        return
    shutil.rmtree(PREFIX, ignore_errors=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    steps.run("making a Windows (wineboot)", ["wineboot", "-i"], log=LOG, environ=ENVIRONMENT)
    steps.run("choosing Windows 10 (winecfg)", ["wine", "winecfg", "-v", "win10"], log=LOG, environ=ENVIRONMENT)
    steps.mark_done("wine-prefix", "win10")


def stop() -> None:
    """End Wine's background processes for this prefix."""
    subprocess.run(["wineserver", "-k"], env=environment(), check=False)


def python(version: str, *, bpy: bool = False) -> Path:
    """Return python.exe of a Windows Python with the packages for the tests, or with bpy in a separate folder."""
    origin = parts.windows_python(version)
    folder = FOLDER / f"{'bpy' if bpy else 'python'}-{version}"
    requirements = [f"bpy=={BPY[version]}"] if bpy else PACKAGES
    state = steps.digest([parts.WINDOWS_PYTHONS[version][1], *requirements, "complex functions"])
    if steps.is_done(f"wine-{folder.name}", state) and folder.is_dir():
        return folder / "python.exe"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(origin, folder, symlinks=True)
    # Its query of the Windows version ends the process under Wine.
    (folder / "DLLs" / "_wmi.pyd").unlink(missing_ok=True)
    site = folder / "Lib" / "site-packages"
    # pip compares a package's required Python with the Python that runs pip.
    steps.run(
        f"pip install {' '.join(requirements)} (for Windows, Python {version})",
        [PYTHON, "-m", "pip", "install", "--upgrade", "--target", site, "--platform", "win_amd64", "--implementation",
         "cp", "--python-version", version, "--only-binary=:all:", "--ignore-requires-python", *requirements],
        log=LOG,
    )  # fmt: skip
    add_complex_functions(folder)
    steps.mark_done(f"wine-{folder.name}", state)
    return folder / "python.exe"


def add_complex_functions(folder: Path) -> None:
    """Let all libraries in a Python's folder find C's complex functions."""
    library = FOLDER / "math" / OWN_MATH
    if not library.is_file():
        build_math(library.parent)
    for path in folder.rglob("*"):
        if path.suffix.lower() in {".dll", ".pyd"}:
            content = path.read_bytes()
            if MATH.encode() in content:
                path.write_bytes(content.replace(MATH.encode(), OWN_MATH.encode()))
    shutil.copyfile(library, folder / OWN_MATH)


def build_math(folder: Path) -> None:
    """Build the library: complex functions from MinGW, everything else from Wine's own library."""
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / "complex.c"
    source.write_text(complex_source())
    definitions = folder / "math.def"
    definitions.write_text(math_definition(names_in_wine()))
    compiler = compilers.program(f"{targets.named(['windows-x64'])[0].triple}-gcc-posix")
    # It gets its final name last, since an unfinished file would be considered done.
    part = folder / "part.dll"
    flags = ["-O2", "-shared", "-fno-builtin", "-static", "-s"]
    steps.run(
        "building complex functions for Wine", [compiler, *flags, source, definitions, "-o", part, "-lm"], log=LOG
    )
    part.rename(folder / OWN_MATH)


def complex_source() -> str:
    """Return C source that takes the complex functions' addresses, so that the linker includes them."""
    names = [name + ending for name in COMPLEX_FUNCTIONS for ending in ("", "f")]
    return f"#include <complex.h>\nvoid *functions[] = {{{', '.join(f'(void *){name}' for name in names)}}};\n"


def math_definition(names: Sequence[str]) -> str:
    """Return the .def file: to Windows' compilers a long double is a double, and other names are Wine's."""
    own = {name + ending for name in COMPLEX_FUNCTIONS for ending in ("", "f", "l")}
    lines = [f"LIBRARY {OWN_MATH}", "EXPORTS"]
    for name in COMPLEX_FUNCTIONS:
        lines += [name, f"{name}f", f"{name}l = {name}"]
    return "\n".join([*lines, *(f"{name} = ucrtbase.{name}" for name in names if name not in own), ""])


def names_in_wine() -> list[str]:
    """Return the names of all functions in Wine's C library, which includes the math functions."""
    # lief belongs to the packages of `cross`; a bare Python does not have it.
    import lief

    found = sorted(Path("/usr/lib").glob("*/wine/x86_64-windows/ucrtbase.dll"))
    if not found:
        raise StepError("Wine has no ucrtbase.dll under /usr/lib: install the packages of `wine`.")
    library = lief.PE.parse(str(found[0]))
    return [entry.name for entry in library.get_export().entries]
