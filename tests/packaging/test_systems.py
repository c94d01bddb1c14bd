# SPDX-License-Identifier: GPL-3.0-or-later
"""Other releases of Debian: one line names the obstacle to making them, and commands leave no mounts behind."""

import os
import subprocess
from pathlib import Path

import pytest

from tools import systems

SUITES = [system.suite for system in systems.ALL]
DEBIAN_12 = "ID=debian\nVERSION_CODENAME=bookworm\n"


@pytest.fixture
def none_made(monkeypatch, tmp_path):
    monkeypatch.setattr(systems, "FOLDER", tmp_path)
    monkeypatch.setattr(systems, "release_file", lambda: DEBIAN_12)


def test_the_own_release_is_not_made_again(monkeypatch):
    for codename, expected in {"bookworm": systems.ALL, "trixie": (systems.SID,), "noble": systems.ALL}.items():
        monkeypatch.setattr(systems, "release_file", lambda name=codename: f"ID=debian\nVERSION_CODENAME={name}\n")
        assert systems.wanted() == expected


@pytest.mark.parametrize(
    ("module", "name", "value", "reason"),
    [
        (os, "geteuid", lambda: 1000, "that needs root"),
        (systems.platform, "machine", lambda: "aarch64", "the processor is aarch64"),
        (systems, "release_file", lambda: "ID=ubuntu\nVERSION_CODENAME=noble\n", "this is not Debian"),
        (systems, "has_own_mounts", lambda: False, "that needs mounts"),
    ],
)
def test_one_line_for_each_says_what_is_left_out_and_why(none_made, module, name, value, reason, monkeypatch, capsys):
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(systems.platform, "machine", lambda: "x86_64")
    monkeypatch.setattr(systems, "has_own_mounts", lambda: True)
    assert systems.obstacle() is None
    monkeypatch.setattr(module, name, value)
    systems.make_all(SUITES)
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2
    for line, system in zip(lines, systems.ALL):
        assert line.startswith(f"- not run: {system.serves}: needs Debian {system.suite}")
        assert reason in line
    assert [line[2:] for line in lines] == systems.left_out()


def test_a_system_that_cannot_be_made_names_its_log_and_does_not_stop_the_others(none_made, monkeypatch, capsys):
    made = []

    def make(system):
        if system is systems.SID:
            raise systems.StepError("the mirror does not answer")
        made.append(system)

    monkeypatch.setattr(systems, "obstacle", lambda: None)
    monkeypatch.setattr(systems, "make", make)
    systems.make_all(SUITES)
    assert made == [systems.TRIXIE]
    assert f"the mirror does not answer\n- not run: {systems.SID.serves}" in capsys.readouterr().out
    assert systems.left_out()[1].endswith("see build/logs/system-sid.log")


def test_only_those_asked_for_are_made(none_made, monkeypatch):
    made = []
    monkeypatch.setattr(systems, "obstacle", lambda: None)
    monkeypatch.setattr(systems, "make", made.append)
    systems.make_all(["sid"])
    assert made == [systems.SID]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("sources.list", "# a comment\ndeb [signed-by=/x.gpg] ftp://a/debian bookworm main\n"),
        ("sources.list.d/b.list", "deb ftp://a/debian bookworm main\n"),
        ("sources.list.d/c.sources", "Types: deb\nURIs: ftp://a/debian\nSuites: bookworm\n"),
    ],
)
def test_the_machines_own_mirror_is_found(name, text, tmp_path):
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    (tmp_path / "sources.list.d").mkdir(exist_ok=True)
    (tmp_path / "sources.list.d" / "a.sources").write_text("Types: deb\nURIs: ftp://elsewhere/other\nSuites: x\n")
    path.write_text(text)
    assert systems.mirror(tmp_path) == "ftp://a/debian"


def test_a_machine_without_a_mirror_is_told(tmp_path):
    with pytest.raises(systems.StepError, match="names a mirror"):
        systems.mirror(tmp_path)


@pytest.mark.parametrize("system", [each for each in systems.ALL if each.is_made], ids=lambda system: system.suite)
def test_commands_run_in_the_project_and_leave_no_mounts_behind(system):
    program = "import os, platform; print(os.getcwd(), *platform.python_version_tuple()[:2])"
    shown = subprocess.run(
        system.command(["python3", "-c", program]), capture_output=True, text=True, check=True
    ).stdout
    assert shown.split() == [str(systems.ROOT), *system.python.split(".")]
    assert str(system.folder) not in Path("/proc/self/mountinfo").read_text()
