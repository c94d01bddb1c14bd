# SPDX-License-Identifier: GPL-3.0-or-later
"""A few random scenes of tests/fuzz/scenes_run.py in every Blender, and how that script reads Blender's output."""

import pytest

from tests.blender import blenders
from tests.fuzz import scenes_run

SCENES = 80


@pytest.mark.parametrize("blender", blenders.all_blenders(), ids=lambda blender: blender.name)
def test_random_scenes(blender, tmp_path):
    found = scenes_run.run(blender, scenes_run.SEED, 0, SCENES, tmp_path)
    assert found.bad == {}
    assert found.done == SCENES


def read(*lines, code=0):
    found = scenes_run.Run()
    return scenes_run.read("\n".join(lines), code, 3, found), found


def test_scenes_that_end_are_counted():
    lines = ("@fuzz begin 3", "@fuzz call 3 unwrap", "@fuzz end 3 0.5 10", "@fuzz begin 4", "@fuzz end 4 0.1 10")
    following, found = read(*lines)
    assert (following, found.done, found.bad, found.calls) == (5, 2, {}, 1)
    assert found.slowest == (0.05, 3, 0.5, 10)


def test_a_crash_belongs_to_the_scene_that_was_begun():
    lines = ("@fuzz begin 3", "@fuzz end 3 0.5 10", "@fuzz begin 4", "@fuzz call 4 unwrap", "Segmentation fault")
    following, found = read(*lines, code=-11)
    assert (following, found.done, list(found.bad)) == (5, 1, [4])
    assert "Segmentation fault" in found.bad[4]


def test_a_process_that_begins_nothing_is_a_find():
    following, found = read("No such add-on", code=1)
    assert (following, list(found.bad)) == (4, [3])
    assert "No such add-on" in found.bad[3]


def test_a_crash_at_the_end_is_a_find():
    following, found = read("@fuzz begin 3", "@fuzz end 3 0.5 10", "Aborted", code=-6)
    assert (following, list(found.bad)) == (4, [3])


def test_what_must_not_happen_is_a_find():
    following, found = read("@fuzz begin 3", "@fuzz call 3 unwrap", "@fuzz bad 3 Asser | tion", "@fuzz end 3 0.0 0")
    assert (following, found.done) == (4, 0)
    assert found.bad == {3: "@fuzz call 3 unwrap\nAsser\ntion"}


def test_an_exception_that_blender_only_prints_is_a_find():
    _, found = read("@fuzz begin 3", "Traceback (most recent call last):", "@fuzz end 3 0.0 9")
    assert found.done == 0
    assert "Traceback" in found.bad[3]
