# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancelled or interrupted at any moment, no operator that waits leaves anything behind."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, jobs, scenes

core_suggestion = importlib.import_module("spectral_unwrap.core.seams.suggestion")
session = importlib.import_module("spectral_unwrap.session")
kept_maps = importlib.import_module("spectral_unwrap.session.kept_maps")
placement = importlib.import_module("spectral_unwrap.core.layout.placement")
progress = importlib.import_module("spectral_unwrap.ui.progress")
writing = importlib.import_module("spectral_unwrap.edit_mesh.write")


def prepare(uv_map=True):
    """A mesh with two islands, shape keys and pins, and another one, both in edit mode."""
    grid = scenes.bumpy_grid(10, 8, seams=[(r * 11 + 5, r * 11 + 16) for r in range(8)], uv_map=uv_map)
    grid.shape_key_add(name="Basis")
    grid.shape_key_add(name="Key")
    other = scenes.cylinder(name="Other", uv_map=uv_map)
    scenes.edit(grid, other)
    if uv_map:
        scenes.pin(other, [3])
    return grid, other


def prepare_closed(uv_map=True):
    """A closed box and a grid, both in edit mode, so that there are seams to suggest."""
    box = scenes.cube(name="Box", uv_map=uv_map)
    scenes.edit(box, scenes.bumpy_grid(uv_map=uv_map))
    return box


PREPARE = {"spectral_unwrap": prepare, "spectral_suggest_seams": prepare_closed}


def everything():
    """Return everything that must not change."""
    maps = {mesh.name: digest.active_uv(mesh) for mesh in bpy.data.meshes}
    return digest.digest() | {name: uv is not None and uv.tobytes() for name, uv in maps.items()}


def interrupting_at(at):
    """Return a context manager like `progress.blocking` whose function is interrupted at its call number `at`."""
    session.drop(kept_maps.KeptMaps)  # all is to be solved
    calls = []

    class Blocking:
        def __init__(self, *_):
            pass

        def __enter__(self):
            return self.report

        def __exit__(self, *_):
            return False

        def report(self, _fraction, phase):
            calls.append(phase)
            if len(calls) == at + 1:
                raise KeyboardInterrupt

    return Blocking, calls


@pytest.mark.parametrize("operator", ["spectral_unwrap", "spectral_suggest_seams"])
def test_interrupted_script_at_every_report(operator, monkeypatch):
    PREPARE[operator]()
    call = getattr(bpy.ops.uv, operator)
    # Searched anew every time.
    monkeypatch.setattr(
        core_suggestion.Search, "suggest", lambda _search, *question: core_suggestion.suggest(*question)
    )
    before, at = everything(), 0
    while True:
        blocking, calls = interrupting_at(at)
        monkeypatch.setattr(progress, "blocking", blocking)
        if at >= len(calls) and _ends_without_interrupt(call, calls, at):
            break
        assert digest.changes(before, everything()) == []
        at += 1
    assert at > 10


def _ends_without_interrupt(call, calls, at):
    """Call the operator; return whether it had fewer reports than the one that interrupts."""
    try:
        status = call()
    except RuntimeError as error:
        assert "KeyboardInterrupt" in str(error)
        return False
    except KeyboardInterrupt:
        return False
    assert status == {"FINISHED"} or len(calls) == at + 1
    return len(calls) <= at


@pytest.mark.parametrize("uv_map", [True, False], ids=["with a UV map", "without"])
@pytest.mark.parametrize("packed", [True, False], ids=["after packing", "before packing"])
@pytest.mark.parametrize("operator", ["spectral_unwrap", "spectral_suggest_seams"])
def test_interrupted_while_packing(operator, packed, uv_map, monkeypatch):
    PREPARE[operator](uv_map)
    pack = placement._with_margin

    def interrupted(*arguments):
        if packed:
            pack(*arguments)
        raise KeyboardInterrupt

    before = everything()
    monkeypatch.setattr(placement, "_with_margin", interrupted)
    with pytest.raises((KeyboardInterrupt, RuntimeError), match="KeyboardInterrupt|^$"):
        getattr(bpy.ops.uv, operator)()
    assert digest.changes(before, everything()) == []


@pytest.mark.parametrize("uv_map", [True, False], ids=["with a UV map", "without"])
def test_interrupted_while_writing(uv_map, monkeypatch):
    prepare(uv_map)
    write_uv, calls = writing.write_uv, []

    def interrupted(*arguments):
        calls.append(arguments)
        if len(calls) == 2:
            raise KeyboardInterrupt
        write_uv(*arguments)

    before = everything()
    monkeypatch.setattr(writing, "write_uv", interrupted)
    with pytest.raises((KeyboardInterrupt, RuntimeError)):
        bpy.ops.uv.spectral_unwrap()
    assert digest.changes(before, everything()) == []


def test_escape_after_any_step_of_a_drag(monkeypatch):
    grid, other = prepare()
    scenes.select_vertices(grid, (0, 47))
    scenes.select_vertices(other, ())
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    grid.data.spectral_shapes[0].strength = 1.0
    before = everything()
    for steps in range(4):
        dragged = jobs.adjust_extender(monkeypatch)
        # The strong attraction has no map; the one before stays.
        for mouse_x in (50, -300, -2000)[:steps]:
            dragged.send("MOUSEMOVE", "NOTHING", mouse_x=mouse_x)
        assert dragged.send("ESC") == {"CANCELLED"}
        assert digest.changes(before, everything()) == []
    assert np.isclose(grid.data.spectral_shapes[0].strength, 1.0)
