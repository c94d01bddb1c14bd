# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender reads about the add-on: one version, and the rules of the extension platform."""

import ast
import re
from pathlib import Path

import spectral_conformal

from tools import environment, packaging

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = (ROOT / "addon" / "blender_manifest.toml").read_text(encoding="utf-8")
PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")


def numbers(version):
    return tuple(map(int, version.split(".")))


def manifest(key):
    return re.search(rf'^{key} = "(.*)"$', MANIFEST, re.MULTILINE).group(1)


def bl_info(source=None):
    """Read `bl_info` as Blender does: a literal, without running the file."""
    source = source or (ROOT / "addon" / "__init__.py").read_bytes()
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info":
            return ast.literal_eval(node.value)
    raise AssertionError("no bl_info")


def test_version_stands_in_one_place_and_gets_into_packages():
    version = re.search(r'^\[project\]$.*?^version = "(.*?)"$', PROJECT, re.MULTILINE | re.DOTALL).group(1)
    assert packaging.version() == spectral_conformal.__version__ == version
    assert not re.search(r"^version", MANIFEST, re.MULTILINE)
    assert "version" not in bl_info()
    packed = bl_info(packaging.with_version((ROOT / "addon" / "__init__.py").read_bytes()))
    assert packed == {"version": numbers(version), **bl_info()}
    manifest = packaging.extension_files([], ["linux-x64"])[packaging.MANIFEST].decode()
    assert re.findall(r'^version = "(.*)"$', manifest, re.MULTILINE) == [version]


def test_names_and_descriptions_agree():
    assert manifest("name") == bl_info()["name"]
    assert manifest("tagline") == bl_info()["description"]


def test_manifest_follows_the_platforms_rules():
    assert manifest("id") == packaging.NAME
    (license,) = re.findall(r'^license = "(.*)"$', PROJECT, re.MULTILINE)
    assert re.findall(r"^license = \[(.*)\]$", MANIFEST, re.MULTILINE) == [f'"SPDX:{license}"']
    assert len(manifest("tagline")) <= 64
    assert manifest("tagline")[-1].isalnum()
    # It reaches neither files nor network (test_access.py).
    assert "permissions" not in MANIFEST


def test_the_oldest_blenders_are_those_that_are_tested_and_promised():
    """README.md names the legacy zip's; the extension's is the oldest bpy of the tests, next to the zip's last."""
    (oldest, newest) = re.search(r"-legacy-.*` for Blender (\d+\.\d+) to (\d+\.\d+)", README).groups()
    assert bl_info()["blender"] == (*numbers(oldest), 0)
    minimum = numbers(manifest("blender_version_min"))
    assert minimum[:2] == numbers(environment.OLDER_BPY[3, 11][0])[:2]
    assert numbers(newest) == (minimum[0], minimum[1] - 1)
