# SPDX-License-Identifier: GPL-3.0-or-later
"""A failure within Blender reaches the report, at its own test."""

import pytest

from tests.blender import blenders, collecting

FILE = """
import os, sys
import pytest

def test_good():
    pass

@pytest.mark.parametrize("number", [1, 2, 3])
def test_bad(number):
    print("number", number, "was printed")
    assert number != 2

def test_skipped():
    pytest.skip("no reason")

def test_abort():
    os.abort()

def test_ends_badly():
    import atexit
    atexit.register(os._exit, 3)
"""
BLENDERS = pytest.mark.parametrize("blender", blenders.all_blenders(), ids=lambda blender: blender.name)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "test_sample.py"
    path.write_text(FILE)
    return path


@BLENDERS
def test_each_function_has_its_own_outcome(file, blender):
    found = collecting.run(file, ["test_good", "test_bad", "test_skipped"], blender)
    assert found["test_good"] == ""
    assert "assert 2 != 2" in found["test_bad"]
    assert "number 2 was printed" in found["test_bad"]
    assert "test_bad[1]" not in found["test_bad"]
    assert "no reason" in found["test_skipped"]


@BLENDERS
def test_a_crash_fails_all_that_were_to_run(file, blender):
    found = collecting.run(file, ["test_good", "test_abort"], blender)
    assert all("exit code" in text and "test_abort" in text for text in found.values())
    assert len(found) == 2


@BLENDERS
def test_a_crash_at_the_end_fails_what_passed(file, blender):
    found = collecting.run(file, ["test_good", "test_ends_badly"], blender)
    assert len(found) == 2
    assert all("exit code" in text for text in found.values())


def test_functions_that_pytest_finds_elsewhere_are_missed(file):
    blender = blenders.all_blenders()[-1]
    file.write_text("def test_good(): pass\nexec('def test_hidden(): pass')\n")
    assert collecting.functions_of(file) == ["test_good"]
    found = collecting.run(file, ["test_good"], blender)
    assert "test_hidden" in found["test_good"]


def test_a_file_that_cannot_be_imported_fails(file):
    blender = blenders.all_blenders()[-1]
    file.write_text("import no_such_module\ndef test_good(): pass\n")
    assert "no_such_module" in collecting.run(file, ["test_good"], blender)["test_good"]
