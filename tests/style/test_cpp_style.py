# SPDX-License-Identifier: GPL-3.0-or-later
"""clang-format and clang-tidy have nothing to say about the C++ code."""

import json
import os
import shlex
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.style import changes
from tools import environment

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = [ROOT / "native", ROOT / "tests" / "native", ROOT / "tests" / "fuzz"]
FILES = sorted(path for folder in FOLDERS for suffix in ("*.h", "*.cpp") for path in folder.rglob(suffix))
SOURCES = sorted(
    path for folder in ("src", "seams", "packing", "rebake") for path in (ROOT / "native" / folder).rglob("*.cpp")
)
UNIT_TESTS = sorted((ROOT / "tests" / "native").rglob("test_*.cpp"))


CLANG_FORMAT = environment.PYTHON.parent / "clang-format"


def tool(name):
    path = shutil.which(name) or shutil.which(f"{name}-14")
    assert path, f"{name} is missing; install it with: apt install {name}"
    return path


def output_if_failed(*command):
    result = subprocess.run(
        [str(word) for word in command], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    return result.stdout if result.returncode else ""


def one_unit(sources, folder):
    """CMake puts as many sources into a unit as it likes, others with every new file: all must go into one."""
    unit = folder / f"with_{sources[0].name}"
    unit.write_text("".join(f'#include "{path}"\n' for path in sources))
    return unit


# The language version stands here because g++ takes C++17 for granted and CMake then leaves it out.
STANDARD = "-std=c++17"


def clang_tidy(sources, folder, *options):
    """Check sources together: Eigen's headers have some 30,000 findings, which take as long as the sources' own."""
    checks = "--checks=-clang-analyzer-*,-bugprone-suspicious-include"
    common = [
        "--quiet",
        f"--config-file={ROOT / '.clang-tidy'}",
        checks,
        "--header-filter=/native/(include|src|seams|packing|rebake)/.*",
    ]
    return output_if_failed(tool("clang-tidy"), *common, one_unit(sources, folder), "--", STANDARD, *options)


def static_analysis(path, *options):
    """Run clang's static analyzer itself: clang-tidy, which takes twice as long, looks into Eigen's headers, too.

    It explores a third of the states of a function that it would by default, in little more than half of the time.
    """
    errors = ["--analyzer-output", "text", "-Xclang", "-analyzer-werror"]
    errors += ["-Xclang", "-analyzer-config", "-Xclang", "max-nodes=75000"]
    return output_if_failed(tool("clang++"), "--analyze", *errors, STANDARD, *options, path)


def errors_in_one_unit(sources, folder, *options):
    return output_if_failed(tool("clang++"), "-fsyntax-only", STANDARD, *options, one_unit(sources, folder))


def test_clang_format():
    assert not output_if_failed(CLANG_FORMAT, "--dry-run", "--Werror", *FILES)


def test_clang_format_sees_a_violation(tmp_path):
    shutil.copy(ROOT / ".clang-format", tmp_path)
    (tmp_path / "bad.cpp").write_text("int  f( ){return 0;}\n")
    assert "bad.cpp" in output_if_failed(CLANG_FORMAT, "--dry-run", "--Werror", tmp_path / "bad.cpp")


def definitions_and_folders():
    """What the sources are compiled with: -DX, -Ifolder, -isystem folder."""
    commands = json.loads((environment.NATIVE_BUILD / "compile_commands.json").read_text())
    libraries = ("spectral_conformal_core.dir", "spectral_conformal_linear_algebra.dir")
    # All sources of a library are compiled alike.
    of_each = {library: line["command"] for line in commands for library in libraries if library in line["command"]}
    words = shlex.split(" ".join(of_each.values()))
    return [word for before, word in zip(words, words[1:]) if word[:2] in ("-D", "-I") or "-isystem" in (before, word)]


@pytest.mark.slow
@pytest.mark.ahead
def test_clang_finds_nothing(request):
    """clang-tidy in the library, its static analyzer in each source, clang in the unit tests: together, on all cores.

    Without --all in what changed lately; also by its headers, but not for the analyzer, which takes two thirds of the
    time and begins at the functions of the source itself. Of files in one unit, no two anonymous namespaces may hold
    the same name: the unit tests, where one of them changed, are checked together.
    """
    takes_all = request.config.getoption("--all")
    sources = SOURCES if takes_all else changes.changed(ROOT, SOURCES)
    analyzed = SOURCES if takes_all else changes.changed(ROOT, SOURCES, by_headers=False)
    unit_tests = UNIT_TESTS if takes_all or changes.changed(ROOT, UNIT_TESTS) else []
    folders = (ROOT / "native", ROOT / "native" / "include", ROOT / "tests" / "native")
    options = (*definitions_and_folders(), *(f"-I{folder}" for folder in folders))
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as threads:
        runs = [
            *(threads.submit(clang_tidy, files, Path(folder), *options) for files in [sources] if files),
            *(threads.submit(errors_in_one_unit, files, Path(folder), *options) for files in [unit_tests] if files),
            *(threads.submit(static_analysis, path, *options) for path in analyzed),
        ]
    assert not "\n".join(filter(None, (run.result() for run in runs)))


# Slow only in that the set-up of quick tests has no clang.
@pytest.mark.slow
@pytest.mark.parametrize("check", [clang_tidy, errors_in_one_unit])
def test_one_translation_unit_shows_a_name_of_two_files(tmp_path, check):
    for name in ("one.cpp", "two.cpp"):
        (tmp_path / name).write_text("namespace {\nconstexpr int count = 3;\n}\n")
    assert "redefinition" in check([tmp_path / "one.cpp", tmp_path / "two.cpp"], tmp_path)


@pytest.mark.slow
def test_clang_static_analyzer_sees_a_violation(tmp_path):
    (tmp_path / "bad.cpp").write_text("int f(int a) { int* p = nullptr; if (a > 3) p = &a; return *p; }\n")
    assert "core.NullDereference" in static_analysis(tmp_path / "bad.cpp")


@pytest.mark.slow
def test_clang_tidy_sees_a_violation(tmp_path):
    source = tmp_path / "native" / "src" / "bad.cpp"
    source.parent.mkdir(parents=True)
    source.write_text("int* f() { return 0; }\n")
    assert "modernize-use-nullptr" in clang_tidy([source], tmp_path)
