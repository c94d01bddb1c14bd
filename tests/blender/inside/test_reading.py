# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading a mesh costs nothing that grows with the file."""

import importlib
from types import SimpleNamespace

import bpy
import pytest

from tests.blender.inside import scenes

read = importlib.import_module("spectral_unwrap.edit_mesh.read")


@pytest.mark.parametrize("use_subsurf", [False, True])
def test_the_temporary_mesh_goes_without_a_search_of_the_file(use_subsurf, monkeypatch):
    cylinder = scenes.cylinder()
    cylinder.modifiers.new("Subdivision", "SUBSURF").levels = 1
    scenes.edit(cylinder)
    meshes, removals = bpy.data.meshes, []

    def remove(mesh, **options):
        # Nothing refers to it.
        assert mesh.users == 0
        removals.append(options)
        meshes.remove(mesh, **options)

    spied = SimpleNamespace(meshes=SimpleNamespace(new=meshes.new, remove=remove))
    spy = SimpleNamespace(data=spied, types=bpy.types)
    monkeypatch.setattr(read, "bpy", spy)
    before = {mesh.name for mesh in meshes}
    assert (read.read_mesh(cylinder, use_subsurf=use_subsurf).subdivision is not None) == use_subsurf
    # By default Blender looks through the whole file for references, and redraws all windows.
    assert [options["do_unlink"] for options in removals] == [False]
    assert {mesh.name for mesh in meshes} == before
