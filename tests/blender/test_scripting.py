# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents' script for background mode, run verbatim."""

import re
import subprocess
from pathlib import Path

import pytest

from tests.blender import blenders

SCRIPTING = Path(__file__).resolve().parents[2] / "docs" / "scripting.md"

MAKE_SCENE = """
import bpy
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8)
bpy.ops.mesh.primitive_uv_sphere_add()  # closed: cannot be unwrapped
bpy.ops.mesh.primitive_cylinder_add(end_fill_type="NOTHING")
bpy.context.object.data.edges[0].use_seam = True
for mesh in bpy.data.meshes:
    while mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[0])
bpy.ops.object.mode_set(mode="EDIT")  # a file saved in Edit Mode opens in it
bpy.ops.wm.save_as_mainfile(filepath={path!r})
"""

CHECK_SCENE = """
import bpy
bpy.ops.wm.open_mainfile(filepath={path!r})
for mesh in bpy.data.meshes:
    layer = mesh.uv_layers.active
    spread = max(abs(x) for uv in layer.data for x in uv.uv) if layer else 0
    print("RESULT", mesh.name, spread > 0.5)
"""


def script():
    (code,) = re.findall(r"unwrap_all\.py`:\n\n```python\n(.*?)```", SCRIPTING.read_text(encoding="utf-8"), re.DOTALL)
    return code


@pytest.mark.parametrize("blender", blenders.all_blenders(), ids=lambda blender: blender.name)
def test_script_unwraps_every_mesh_of_a_file(blender, tmp_path):
    scene = str(tmp_path / "scene.blend")
    environment = blender.make_profile(tmp_path / "profile")

    def run(name, code):
        file = tmp_path / name
        file.write_text(code, encoding="utf-8")
        command = blender.script_command(file)
        result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, result.stdout + result.stderr
        return result.stdout

    run("make.py", MAKE_SCENE.format(path=scene))
    # A user has the add-on enabled in the preferences; --factory-startup forgets that.
    opened = "import bpy, addon_utils\naddon_utils.enable('spectral_unwrap')\n"
    output = run("unwrap_all.py", opened + f"bpy.ops.wm.open_mainfile(filepath={scene!r})\n" + script())
    assert output.count("{'FINISHED'}") == 2
    assert output.count("{'CANCELLED'}") == 1
    assert "closed" in output
    results = [line for line in run("check.py", CHECK_SCENE.format(path=scene)).splitlines() if "RESULT" in line]
    assert sorted(line.rpartition(" ")[2] for line in results) == ["False", "True", "True"]
