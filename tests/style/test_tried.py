# SPDX-License-Identifier: GPL-3.0-or-later
"""README's table of Blenders is made from the reports of the tests that ran."""

import collections

from tests import tried
from tests.blender.blenders import Blender

OLD, NEW = Blender("system"), Blender("bpy-5.0.1", "python3")
HEADS = {OLD: ["3.4.1", "3.11.2", "Debian 12"], NEW: ["5.0.1 (`bpy`)", "3.11.7", "Debian 12"]}


def test_calls_and_failed_set_ups_count():
    counts = {}
    for when, outcome in (("setup", "passed"), ("call", "passed"), ("teardown", "passed"), ("setup", "failed")):
        tried.note(counts, OLD, "interface", when, outcome)
    tried.note(counts, OLD, "core", "call", "passed")
    tried.note(counts, OLD, "interface", "setup", "skipped")
    assert counts == {(OLD, "interface"): {"passed": 1, "failed": 1}}


def test_what_did_not_run_this_time_stays():
    first = {(NEW, "blender"): collections.Counter(passed=1234), (OLD, "interface"): collections.Counter(failed=1)}
    rows = tried.merged([], first, "aaaa", HEADS)
    assert rows == [
        [*HEADS[OLD], "-", "1 of 1 fail (aaaa)", "-"],
        [*HEADS[NEW], "1,234 pass (aaaa)", "-", "-"],
    ]
    again = tried.merged(rows, {(OLD, "packaging"): collections.Counter(passed=2)}, "bbbb", HEADS)
    assert again == [[*HEADS[OLD], "-", "1 of 1 fail (aaaa)", "2 pass (bbbb)"], rows[1]]


def test_a_blender_says_its_version():
    head = tried.head_of(Blender("system"))
    assert head[0].startswith("3.") or int(head[0].split(".")[0]) >= 4
    assert head[1].startswith("3.") and head[2]
