# SPDX-License-Identifier: GPL-3.0-or-later
"""What was run in which Blender: README's table, from the reports of a run of the tests with --keep."""

import collections
import datetime
import json
import re
import subprocess
from collections.abc import Mapping

from tests.benchmarks import documents
from tests.blender.blenders import Blender

NAME = "tried"
TITLES = ["Blender", "Python", "system", "tests in background", "by mouse, in a window", "zip installed and removed"]
# The columns of the folders of tests.
COLUMNS = {"blender": 3, "interface": 4, "packaging": 5}
_SYSTEMS = {"trixie": "Debian 13", "sid": "Debian unstable"}
_SAY = "import bpy, json, sys; print('TRIED', json.dumps([bpy.app.version_string, sys.version.split()[0]]))"

# Passed and failed tests, by the Blender and the folder.
Counts = dict[tuple[Blender, str], collections.Counter]


def note(counts: Counts, blender: Blender, folder: str, when: str, outcome: str) -> None:
    """Count a phase of a test: its call, or the set-up that failed."""
    if folder in COLUMNS and (outcome == "failed" or (when == "call" and outcome == "passed")):
        counts.setdefault((blender, folder), collections.Counter())[outcome] += 1


def cell(counted: Mapping[str, int], commit: str) -> str:
    """Return what the table says of the tests of a folder."""
    passed, failed = counted.get("passed", 0), counted.get("failed", 0)
    said = f"{failed} of {passed + failed:,} fail" if failed else f"{passed:,} pass"
    return f"{said} ({commit})"


def merged(rows: list[list[str]], counts: Counts, commit: str, heads: Mapping[Blender, list[str]]) -> list[list[str]]:
    """Return the rows of the table with the new cells; what was not run this time stays.

    `heads` are the first three cells of each Blender.
    """
    known = {tuple(row[:3]): list(row) for row in rows}
    for (blender, folder), counted in counts.items():
        head = heads[blender]
        row = known.setdefault(tuple(head), [*head, *["-"] * (len(TITLES) - len(head))])
        row[COLUMNS[folder]] = cell(counted, commit)
    return sorted(known.values(), key=lambda row: [int(number) for number in re.findall(r"\d+", row[0])])


def head_of(blender: Blender) -> list[str]:
    """Ask a Blender for its version and its Python's."""
    if blender.python:
        command = blender.command("-c", _SAY)
    else:
        command = blender.command("--background", "--factory-startup", "--python-expr", _SAY)
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    version, python = json.loads(re.search(r"^TRIED (.*)$", said, re.MULTILINE)[1])
    kind = " (`bpy`)" if blender.python else ""
    own = documents.machine()["system"]
    return [version.split()[0] + kind, python, _SYSTEMS[blender.system.suite] if blender.system else own]


def keep(counts: Counts, command: str) -> None:
    """Put what was run into the results and into README."""
    results = documents.read()
    commit = documents.commit()
    heads = {blender: head_of(blender) for blender, _ in counts}
    results[NAME] = {
        "command": command,
        "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(),
        "commit": commit,
        "machine": {},
        "code": [],
        "digest": documents.digest([]),
        "titles": TITLES,
        "rows": merged(results.get(NAME, {}).get("rows", []), counts, commit.split()[0] if commit else "-", heads),
    }
    documents.write(results)
    documents.write_documents()
