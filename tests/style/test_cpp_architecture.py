# SPDX-License-Identifier: GPL-3.0-or-later
"""The floors of the C++ library, the only file for each third-party library, and matching names."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NATIVE = ROOT / "native"
PUBLIC = NATIVE / "include" / "spectral_conformal"
PUBLIC_HEADERS = sorted(PUBLIC.glob("*.h"))
BINDINGS = sorted(path for path in (NATIVE / "bindings").iterdir() if path.suffix in {".cpp", ".h"})
TESTS = ROOT / "tests" / "native"
GUIDE = (ROOT / "docs" / "developing.md").read_text(encoding="utf-8")
# Templates, and what loops need in line.
TEMPLATES = {
    ("graph", "grouped"),
    ("graph", "mixed_bits"),
    ("geometry", "plane_triangle"),
    ("mesh", "edge_table"),
    ("rebake", "texture_lookup"),
    ("conformal", "conjugate_gradients"),
    ("conformal", "ritz_space"),
    ("relaxation", "line_search"),
}
# Numbers that several units share.
SHARED_CONSTANTS = {("geometry", "tolerances"), ("conformal", "subspace")}
HEADER_ONLY = {"errors", "options", "progress", "relaxation_status", "shared_vector", "step", "types"}
# Library -> the files that may include it; its headers begin with the given names.
PLACES = {
    "CHOLMOD": (r"cholmod|umfpack|SuiteSparse", {"cholmod_factorization.cpp"}),
    "Boost.Graph": (r"boost/graph/", {"maximum_flow.cpp"}),
    "CGAL": (r"CGAL/|boost/", {"orientation.cpp", "polygon_triangulation.cpp"}),
    "Python": (r"pybind11|Python\.h|numpy/", {path.name for path in BINDINGS}),
    "the dynamic linker": (r"dlfcn\.h|windows\.h", {"blas_threads.cpp"}),
    "large pages": (r"sys/mman\.h", {"large_pages.cpp"}),
    # Neither files nor standard streams.
    "outside of the process": (r"fstream|iostream|cstdio|filesystem", set()),
}


def floors():
    """Return the rows of the table in docs/developing.md, from the ground, and the bindings above them."""
    table = re.search(r"\| floor, .*?\n\n", GUIDE, re.DOTALL).group()
    return (*re.findall(r"^\| (\w+) \|", table, re.MULTILINE), "bindings")


def side_libraries():
    """Return the floors whose headers docs/developing.md lets each separate library include, beside public ones."""
    table = re.search(r"\| library, .*?\n\n", GUIDE, re.DOTALL).group()
    return {name: set(each.split(", ")) for name, each in re.findall(r"^\| (\w+) \| .* \| ([\w, ]+) \|$", table, re.M)}


FLOORS = floors()
SIDE = side_libraries()
FOLDERS = sorted([*(path for path in (NATIVE / "src").iterdir() if path.is_dir()), *(NATIVE / name for name in SIDE)])
HEADERS = [*PUBLIC_HEADERS, *(path for folder in FOLDERS for path in sorted(folder.glob("*.h")))]
SOURCES = [path for folder in FOLDERS for path in sorted(folder.glob("*.cpp"))]


def relative(path):
    return str(path.relative_to(ROOT))


def includes(path):
    return re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.MULTILINE)


def floor_of(path):
    """Return the floor of a file of ours: its folder; of a public header, that of the source of its name."""
    if path.parent != PUBLIC:
        return path.parent.name
    return "base" if path.stem in HEADER_ONLY else next(s.parent.name for s in SOURCES if s.stem == path.stem)


def floor_of_header(header):
    """Return the floor of an included header of ours, None for any other."""
    return next((floor_of(path) for path in [*HEADERS, *BINDINGS] if header == f"{path.parent.name}/{path.name}"), None)


def is_allowed(floor, header):
    """Return whether a file of this floor may include the header: from no floor above, from no library's inside."""
    other = floor_of_header(header)
    if not other or floor == "bindings":
        return True
    if floor in SIDE:
        return other in {floor, "base", *SIDE[floor]} or header.startswith(f"{PUBLIC.name}/")
    return other not in SIDE and FLOORS.index(other) <= FLOORS.index(floor)


def forbidden_includes(floor, headers):
    """Return what a file of this floor must not include."""
    return [header for header in headers if not is_allowed(floor, header)]


@pytest.mark.parametrize("path", [*HEADERS, *SOURCES, *BINDINGS], ids=relative)
def test_includes_run_downwards(path):
    forbidden = forbidden_includes(floor_of(path), includes(path))
    assert not forbidden, f"{relative(path)}, on the floor {floor_of(path)}, includes {', '.join(forbidden)}"


def test_graph_has_no_threads_and_no_counters():
    headers = {header for path in [*HEADERS, *SOURCES] if floor_of(path) == "graph" for header in includes(path)}
    assert {header for header in headers if header.startswith("concurrency/")} == {"concurrency/cancellation_scope.h"}
    assert not headers & {"thread", "mutex", "atomic", "future", "condition_variable"}


def test_the_scan_sees_a_forbidden_include():
    unwrap, seams, lscm = "spectral_conformal/unwrap.h", "spectral_conformal/seam_suggestion.h", "conformal/lscm.h"
    assert forbidden_includes("mesh", ["vector", lscm, "geometry/triangle_shape.h"]) == [lscm]
    assert forbidden_includes("quality", [unwrap, "spectral_conformal/types.h"]) == [unwrap]
    assert forbidden_includes("parameterization", [lscm, unwrap, seams, "seams/pieces.h"]) == [seams, "seams/pieces.h"]
    factor = "linear_algebra/factorization.h"
    assert forbidden_includes("seams", [unwrap, seams, lscm, factor, "mesh/charts.h"]) == [lscm, factor]
    assert forbidden_includes("rebake", [unwrap, "seams/pieces.h", "graph/grouped.h"]) == ["seams/pieces.h"]
    assert forbidden_includes("packing", ["layout/upright.h", "packing/skyline.h", lscm]) == [lscm]


@pytest.mark.parametrize("path", PUBLIC_HEADERS, ids=relative)
def test_public_headers_include_public_headers_only(path):
    private = [h for h in includes(path) if floor_of_header(h) and not h.startswith("spectral_conformal/")]
    assert not private, f"{relative(path)} shows its reader {', '.join(private)}"


def test_every_floor_is_known_and_used():
    folders = {path.name for path in FOLDERS} | {"base", "bindings"}
    assert folders == {*FLOORS, *SIDE}
    assert set().union(*SIDE.values()) <= set(FLOORS)
    assert not list((NATIVE / "src").glob("*.*"))


def place_of(header):
    """Return (library, files that may include it) of a third-party header, or None for std, Eigen and our own."""
    for library, (prefix, files) in PLACES.items():
        if re.match(prefix, header):
            return library, files
    if re.fullmatch(r"[a-z_]+", header) or header.startswith("Eigen/") or floor_of_header(header):
        return None
    return f"unknown header {header}", set()


@pytest.mark.parametrize("path", [*HEADERS, *SOURCES, *BINDINGS], ids=relative)
def test_third_party_headers_stand_in_their_place_only(path):
    for header in includes(path):
        place = place_of(header)
        assert place is None or path.name in place[1], f"{relative(path)} includes <{header}>: {place[0]}"


@pytest.mark.parametrize("header", ["cholmod.h", "suitesparse/cholmod.h", "unistd.h", "fstream", "CGAL/Kernel.h"])
def test_the_scan_sees_a_forbidden_header(header, tmp_path):
    source = tmp_path / "charts.cpp"
    source.write_text(f"#include <vector>\n #  include <{header}>\n")
    assert includes(source) == ["vector", header]
    assert source.name not in place_of(header)[1]


def test_no_library_is_listed_in_vain():
    for prefix, files in PLACES.values():
        for name in files:
            (path,) = [p for p in [*SOURCES, *BINDINGS, *(set(HEADERS) - set(PUBLIC_HEADERS))] if p.name == name]
            assert any(re.match(prefix, header) for header in includes(path))


def test_header_source_and_test_share_their_name_and_floor():
    units = {(path.parent.name, path.stem) for path in SOURCES} | TEMPLATES
    alone = SHARED_CONSTANTS | {("base", name) for name in HEADER_ONLY}
    assert {(floor_of(path), path.stem) for path in HEADERS} == units | alone
    tests = {(path.parent.name, path.stem) for path in TESTS.rglob("test_*.cpp")}
    assert tests == {(floor, f"test_{name}") for floor, name in units}
    assert len({name for _, name in units}) == len(units)


@pytest.mark.parametrize("path", SOURCES, ids=relative)
def test_a_source_includes_its_own_header_first(path):
    assert includes(path)[0] in {f"spectral_conformal/{path.stem}.h", f"{path.parent.name}/{path.stem}.h"}


@pytest.mark.parametrize("path", [path for path in [*HEADERS, *BINDINGS] if path.suffix == ".h"], ids=relative)
def test_headers_are_guarded_and_leave_namespaces_closed(path):
    text = path.read_text(encoding="utf-8")
    assert text.startswith("#pragma once\n")
    assert "using namespace" not in text


def test_builds_run_on_every_machine_and_keep_ieee_arithmetic():
    for path in [ROOT / "CMakeLists.txt", ROOT / "pyproject.toml", *(ROOT / "tools").glob("*.py")]:
        assert not re.search(r"-march=|-mtune=|-ffast-math|-Ofast|/fp:fast|-funsafe", path.read_text(encoding="utf-8"))
