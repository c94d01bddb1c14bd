# SPDX-License-Identifier: GPL-3.0-or-later
"""Each third-party library has its one place; headers, sources and tests share their names."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NATIVE = ROOT / "native"
HEADERS = sorted((NATIVE / "include").rglob("*.h"))
SOURCES = sorted((NATIVE / "src").glob("*.cpp"))
BINDINGS = sorted((NATIVE / "bindings").glob("*.cpp"))
HEADER_ONLY = {"errors", "progress", "types"}
# Library -> the files that may include it; its headers begin with the given names.
PLACES = {
    "CHOLMOD": (r"cholmod|umfpack|SuiteSparse", {"factorization.cpp"}),
    "Spectra": (r"Spectra/", {"eigenproblem.cpp"}),
    "CGAL": (r"CGAL/|boost/", {"polygon_triangulation.cpp"}),
    "Python": (r"pybind11|Python\.h|numpy/", {"module.cpp"}),
    "the dynamic linker": (r"dlfcn\.h", {"factorization.cpp"}),
}


def relative(path):
    return str(path.relative_to(ROOT))


def includes(path):
    return re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.MULTILINE)


def place_of(header):
    """Return (library, files that may include it) of a third-party header, or None for std, Eigen and our own."""
    for library, (prefix, files) in PLACES.items():
        if re.match(prefix, header):
            return library, files
    if re.fullmatch(r"[a-z_]+", header) or header.startswith(("Eigen/", "spectral_conformal/")):
        return None
    return f"unknown header {header}", set()


@pytest.mark.parametrize("path", [*HEADERS, *SOURCES, *BINDINGS], ids=relative)
def test_third_party_headers_stand_in_their_place_only(path):
    for header in includes(path):
        place = place_of(header)
        assert place is None or path.name in place[1], f"{relative(path)} includes <{header}>: {place[0]}"


@pytest.mark.parametrize("header", ["cholmod.h", "suitesparse/cholmod.h", "unistd.h", "Python.h", "CGAL/Kernel.h"])
def test_the_scan_sees_a_forbidden_header(header, tmp_path):
    source = tmp_path / "charts.cpp"
    source.write_text(f"#include <vector>\n #  include <{header}>\n")
    assert includes(source) == ["vector", header]
    assert source.name not in place_of(header)[1]


def test_no_library_is_listed_in_vain():
    for prefix, files in PLACES.values():
        for name in files:
            (path,) = [p for p in [*SOURCES, *BINDINGS] if p.name == name]
            assert any(re.match(prefix, header) for header in includes(path))


def test_header_source_and_test_share_their_name():
    names = {path.stem for path in SOURCES}
    assert {path.stem for path in HEADERS} == names | HEADER_ONLY
    assert {path.stem for path in (ROOT / "tests" / "native").glob("test_*.cpp")} == {f"test_{name}" for name in names}


@pytest.mark.parametrize("path", SOURCES, ids=relative)
def test_a_source_includes_its_own_header_first(path):
    assert includes(path)[0] == f"spectral_conformal/{path.stem}.h"


@pytest.mark.parametrize("path", HEADERS, ids=relative)
def test_headers_are_guarded_and_leave_namespaces_closed(path):
    text = path.read_text(encoding="utf-8")
    assert text.startswith("#pragma once\n")
    assert "using namespace" not in text


def test_builds_run_on_every_machine_and_keep_ieee_arithmetic():
    for path in [ROOT / "CMakeLists.txt", ROOT / "pyproject.toml", *(ROOT / "tools").glob("*.py")]:
        assert not re.search(r"-march=|-mtune=|-ffast-math|-Ofast|/fp:fast|-funsafe", path.read_text(encoding="utf-8"))
