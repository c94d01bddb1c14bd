# SPDX-License-Identifier: GPL-3.0-or-later
"""Deprecated names of Python or Blender are errors wherever our modules run, with pytest or without."""

import os
import subprocess
import sys
import warnings

import pytest

from tests.blender import blenders

EVERYWHERE = dict.fromkeys((*blenders.all_blenders(), *blenders.blenders_with_window()))
WARN = 'import warnings; warnings.warn_explicit("gone soon", {}, "file.py", 1, module="{}"); print("went on")'
# From 5.0 on Blender warns of its own properties.
USE = """
import bpy
if bpy.app.version < (5, 0, 0):
    import warnings; warnings.warn("use_nodes", DeprecationWarning)
bpy.data.materials.new("Material").use_nodes = True
print("went on")
"""


@pytest.mark.parametrize("blender", EVERYWHERE, ids=lambda blender: blender.name)
def test_blender_ends_where_a_property_that_goes_is_set(blender, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(USE)
    environ = blender.make_profile(tmp_path)
    code, printed = blenders.run(blender.script_command(script), environ=environ, folder=tmp_path, seconds=120.0)
    assert code == 1, printed
    assert "use_nodes" in printed
    assert "went on" not in printed


@pytest.mark.parametrize("category", ["DeprecationWarning", "PendingDeprecationWarning"])
@pytest.mark.parametrize(
    ("module", "is_ours"),
    [
        ("spectral_conformal.batch.task", True),
        ("bl_ext.user_default.spectral_unwrap.live", True),
        ("tests.interface.session", True),
        ("io_scene_gltf2.io", False),
        ("numpy.testing", False),
        ("mytests", False),
    ],
)
def test_python_ends_for_our_modules_and_for_no_others(module, is_ours, category):
    words = [sys.executable, "-c", WARN.format(category, module)]
    environ = {**os.environ, "PYTHONPATH": str(blenders.STARTUP)}
    ended = subprocess.run(words, env=environ, capture_output=True, text=True, check=False)
    assert (ended.returncode, "went on" in ended.stdout, "gone soon" in ended.stderr) == (is_ours, not is_ours, is_ours)


@pytest.mark.parametrize("category", [DeprecationWarning, PendingDeprecationWarning])
def test_it_is_an_error_in_pytest(category):
    with pytest.raises(category):
        warnings.warn("gone soon", category, stacklevel=1)
