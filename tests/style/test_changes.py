# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files the slow checks of C++ take: those of the last commits, in a clone as in the folder of work."""

import subprocess

import pytest

from tests.style import changes


def git(folder, *words):
    names = ["-c", "user.name=n", "-c", "user.email=e"]
    subprocess.run(["git", "-C", folder, *names, *words], check=True, stdout=subprocess.DEVNULL)


@pytest.fixture
def history(tmp_path):
    """Three sources and a header; after them, two commits without C++."""
    folder = tmp_path / "project"
    folder.mkdir()
    git(folder, "init", "--quiet")
    for name in ("a.cpp", "b.cpp", "c.cpp"):
        (folder / name).write_text('#include "graph/shared.h"\n' if name == "c.cpp" else "int x;\n")
    (folder / "shared.h").write_text("int y;\n")
    for k in range(3):
        (folder / "notes.md").write_text(str(k))
        git(folder, "add", ".")
        git(folder, "commit", "--quiet", "--message", str(k))
    return folder


def names(folder, commits=2):
    return [path.name for path in changes.changed(folder, sorted(folder.glob("*.cpp")), commits)]


def test_nothing_changed(history):
    assert names(history) == []


def test_committed_and_new_files_are_taken(history):
    (history / "a.cpp").write_text("int z;\n")
    git(history, "commit", "--quiet", "--all", "--message", "changed")
    (history / "new.cpp").touch()
    assert names(history) == ["a.cpp", "new.cpp"]


def test_what_includes_a_changed_header_is_taken(history):
    (history / "shared.h").write_text("int w;\n")
    assert names(history) == ["c.cpp"]
    assert changes.changed(history, sorted(history.glob("*.cpp")), 2, by_headers=False) == []


def test_all_are_taken_where_the_history_is_too_short(history, tmp_path):
    assert names(history, 20) == ["a.cpp", "b.cpp", "c.cpp"]
    clone = tmp_path / "clone"
    subprocess.run(["git", "clone", "--quiet", "--depth=1", f"file://{history}", clone], check=True)
    assert names(clone) == ["a.cpp", "b.cpp", "c.cpp"]


def test_all_are_taken_without_a_repository(tmp_path):
    (tmp_path / "a.cpp").touch()
    assert names(tmp_path) == ["a.cpp"]
