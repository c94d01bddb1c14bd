# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration's reader of meshes, on damaged files and files without meshes."""

import struct

import bpy
import pytest

from tools.demo import blender_unwrap

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
PLY = "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
DAMAGED = {
    "empty.obj": b"",
    "words.obj": b"these are words and no mesh\n",
    "bytes.obj": bytes(range(256)) * 20,
    "vertices only.obj": TRIANGLE.encode(),
    "face of words.obj": (TRIANGLE + "f a b c\n").encode(),
    "coordinates of words.obj": b"v a b c\nv d e f\nv g h i\n",
    "cut off.obj": (TRIANGLE + "f 1").encode(),
    "empty.ply": b"",
    "words.ply": b"these are words and no mesh\n",
    "header cut off.ply": PLY.format(3).encode(),
    "no faces.ply": (PLY.format(3) + "end_header\n0 0 0\n1 0 0\n0 1 0\n").encode(),
    "empty.stl": b"",
    "cut off.stl": b"\0" * 80 + struct.pack("<I", 1000) + b"\0" * 30,
    "empty.blend": b"",
    "words.blend": b"these are words and no file of Blender's\n",
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_file_is_told(name, tmp_path):
    path = tmp_path / name
    path.write_bytes(DAMAGED[name])
    with pytest.raises(SystemExit) as raised:
        blender_unwrap.load(path)
    message = str(raised.value)
    assert message.startswith(str(path))
    assert "has no faces" in message or "Blender cannot read this file: " in message
    assert "Traceback" not in message


@pytest.mark.parametrize("share", [0.02, 0.3, 0.9])
def test_blend_that_is_cut_off_is_told(share, tmp_path):
    bpy.ops.mesh.primitive_monkey_add()
    path = tmp_path / "cut off ümläut.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(SystemExit, match=r"cut off ümläut\.blend: "):
        blender_unwrap.load(path)


def test_whole_files_of_any_name_are_read(tmp_path):
    path = tmp_path / "a mesh with ümläut.obj"
    path.write_text(TRIANGLE + "f 1 2 3\n", encoding="utf-8")
    assert len(blender_unwrap.load(path).data.polygons) == 1
    bpy.ops.wm.save_as_mainfile(filepath=str(path.with_suffix(".blend")))
    assert len(blender_unwrap.load(path.with_suffix(".blend")).data.polygons) == 1


def test_a_file_with_indices_beyond_its_vertices_is_read_or_told(tmp_path):
    path = tmp_path / "beyond.obj"
    path.write_text(TRIANGLE + "f 1 2 99\nf 1 2 3\nf 0 0 0\nf -9 -8 -7\n", encoding="utf-8")
    try:
        target = blender_unwrap.load(path)
    except SystemExit as error:
        assert str(path) in str(error)
        return
    assert all(vertex < 3 for face in target.data.polygons for vertex in face.vertices)
