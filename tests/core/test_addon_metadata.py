# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender reads about the add-on: one version, and the rules of the extension platform."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = (ROOT / "addon" / "blender_manifest.toml").read_text(encoding="utf-8")


def manifest(key):
    return re.search(rf'^{key} = "(.*)"$', MANIFEST, re.MULTILINE).group(1)


def bl_info():
    """Read `bl_info` as Blender does: a literal, without running the file."""
    for node in ast.parse((ROOT / "addon" / "__init__.py").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info":
            return ast.literal_eval(node.value)
    raise AssertionError("no bl_info")


def test_versions_agree():
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    version = re.search(r'^\[project\]$.*?^version = "(.*?)"$', project, re.MULTILINE | re.DOTALL).group(1)
    assert manifest("version") == version
    assert ".".join(map(str, bl_info()["version"])) == version


def test_names_and_descriptions_agree():
    assert manifest("name") == bl_info()["name"]
    assert manifest("tagline") == bl_info()["description"]


def test_manifest_follows_the_platforms_rules():
    assert manifest("schema_version") == "1.0.0"
    assert manifest("id") == "spectral_unwrap"
    assert manifest("type") == "add-on"
    assert manifest("blender_version_min") == "4.2.0"
    assert 'license = ["SPDX:GPL-3.0-or-later"]' in MANIFEST
    assert len(manifest("tagline")) <= 64
    assert manifest("tagline")[-1].isalnum()
    # The add-on needs no files, network or other rights beyond Blender's own.
    assert "[permissions]" not in MANIFEST


def test_oldest_blender_is_the_supported_one():
    assert bl_info()["blender"] == (3, 4, 0)
