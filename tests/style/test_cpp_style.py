# SPDX-License-Identifier: GPL-3.0-or-later
"""clang-format and clang-tidy have nothing to say about the C++ code."""

import json
import os
import shlex
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.native import flavours
from tools import environment

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = [ROOT / "native", ROOT / "tests" / "native", ROOT / "tests" / "fuzz"]
FILES = sorted(path for folder in FOLDERS for suffix in ("*.h", "*.cpp") for path in folder.rglob(suffix))
SOURCES = sorted((ROOT / "native" / "src").rglob("*.cpp"))
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


def clang_tidy(path, compile_commands, *options):
    # The language version stands here because g++ takes C++17 for granted and CMake then leaves it out.
    common = ["--quiet", "--extra-arg=-std=c++17", "-p", compile_commands]
    return output_if_failed(tool("clang-tidy"), *common, *options, path)


def test_clang_format():
    assert not output_if_failed(CLANG_FORMAT, "--dry-run", "--Werror", *FILES)


def test_clang_format_sees_a_violation(tmp_path):
    shutil.copy(ROOT / ".clang-format", tmp_path)
    (tmp_path / "bad.cpp").write_text("int  f( ){return 0;}\n")
    assert "bad.cpp" in output_if_failed(CLANG_FORMAT, "--dry-run", "--Werror", tmp_path / "bad.cpp")


def findings(paths, *arguments):
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        return "\n".join(filter(None, threads.map(lambda path: clang_tidy(path, *arguments), paths)))


# Every file brings some 30,000 findings in Eigen's headers, which take as long as the analysis of the file itself: for
# the checks that also see included sources, once for several files.


@pytest.mark.slow
def test_clang_tidy():
    folder = flavours.configure("sanitized")
    commands = json.loads((folder / "compile_commands.json").read_text())
    library = [command["file"] for command in commands if "spectral_conformal_core.dir" in command["command"]]
    units = [path for path in library if "/Unity/" in path]
    included = "".join(Path(unit).read_text() for unit in units)
    assert all(str(path) in (*library, *included.split('"')) for path in SOURCES)
    assert not findings(library, folder, "--checks=-clang-analyzer-*", "--header-filter=native/(include|src)/.*")


def static_analysis(path, *options):
    """Run clang's static analyzer itself: clang-tidy, which takes twice as long, looks into Eigen's headers, too."""
    errors = ["--analyzer-output", "text", "-Xclang", "-analyzer-werror"]
    return output_if_failed(tool("clang++"), "--analyze", *errors, "-std=c++17", *options, path)


def definitions_and_folders():
    """What the sources are compiled with: -DX, -Ifolder, -isystem folder."""
    commands = json.loads((environment.NATIVE_BUILD / "compile_commands.json").read_text())
    library = next(line["command"] for line in commands if "spectral_conformal_core.dir" in line["command"])
    words = shlex.split(library)
    return [word for before, word in zip(words, words[1:]) if word[:2] in ("-D", "-I") or "-isystem" in (before, word)]


@pytest.mark.slow
def test_clang_static_analyzer():
    options = definitions_and_folders()
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        found = threads.map(lambda path: static_analysis(path, *options), SOURCES)
        assert not "\n".join(filter(None, found))


# CMake puts as many sources into a translation unit as it likes, others with every file that is added. So all of them
# must go into one, and no two anonymous namespaces may hold the same name.


def errors_in_one_unit(sources, folder, *options):
    unit = folder / "all_sources.cpp"
    unit.write_text("".join(f'#include "{path}"\n' for path in sources))
    return output_if_failed(tool("g++"), "-fsyntax-only", "-std=c++17", "-Wno-subobject-linkage", *options, unit)


@pytest.mark.slow
@pytest.mark.parametrize("sources", [SOURCES, UNIT_TESTS], ids=["library", "unit tests"])
def test_all_sources_go_into_one_translation_unit(tmp_path, sources):
    options = (*definitions_and_folders(), f"-I{ROOT / 'native' / 'include'}", f"-I{ROOT / 'tests' / 'native'}")
    assert not errors_in_one_unit(sources, tmp_path, *options)


def test_one_translation_unit_shows_a_name_of_two_files(tmp_path):
    for name in ("one.cpp", "two.cpp"):
        (tmp_path / name).write_text("namespace {\nconstexpr int count = 3;\n}\n")
    assert "redefinition" in errors_in_one_unit([tmp_path / "one.cpp", tmp_path / "two.cpp"], tmp_path)


def test_clang_static_analyzer_sees_a_violation(tmp_path):
    (tmp_path / "bad.cpp").write_text("int f(int a) { int* p = nullptr; if (a > 3) p = &a; return *p; }\n")
    assert "core.NullDereference" in static_analysis(tmp_path / "bad.cpp")


def test_clang_tidy_sees_a_violation(tmp_path):
    shutil.copy(ROOT / ".clang-tidy", tmp_path)
    (tmp_path / "bad.cpp").write_text("int* f() { return 0; }\n")
    (tmp_path / "compile_flags.txt").write_text("")
    assert "modernize-use-nullptr" in clang_tidy(tmp_path / "bad.cpp", tmp_path)
