# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancelled or interrupted at any moment, no operator that waits leaves anything behind."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, jobs, scenes

core_options = importlib.import_module("spectral_unwrap.core.solve.options")
seams = importlib.import_module("spectral_unwrap.unwrapping.seams")
core_suggestion = importlib.import_module("spectral_unwrap.core.seams.suggestion")
session = importlib.import_module("spectral_unwrap.session")
kept_maps = importlib.import_module("spectral_unwrap.session.kept_maps")
native = importlib.import_module("spectral_unwrap.core.native")
placement = importlib.import_module("spectral_unwrap.core.layout.placement")
progress = importlib.import_module("spectral_unwrap.ui.progress")
steps = importlib.import_module("spectral_unwrap.unwrapping.steps")
writing = importlib.import_module("spectral_unwrap.edit_mesh.write")
worker = importlib.import_module("spectral_unwrap.core.solve.worker")


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


def cancelling_at(monkeypatch, at):
    """Let every worker be cancelled, as Esc does, by its report number `at`; return the list of reports."""
    reports = []
    report = worker.Worker._report

    def counted(self, fraction, phase):
        if len(reports) == at:
            self.cancel()
        reports.append(phase)
        return report(self, fraction, phase)

    monkeypatch.setattr(worker.Worker, "_report", counted)
    return reports


class Started:
    """An unwrap that solves in a thread, as the operator's job does."""

    def __init__(self, settings):
        session.drop(kept_maps.KeptMaps)  # all is to be solved
        self.settings = settings
        self.edit_meshes = steps.read(bpy.context, settings)
        self.worker = worker.Worker(lambda progress: steps.solve(self.edit_meshes, settings, progress))

    def write(self):
        solutions, polygons = self.worker.result(), [each.polygons for each in self.edit_meshes]
        steps.write(self.edit_meshes, steps.Solved(solutions, placement.place(polygons, solutions, self.settings)))
        return solutions


SETTINGS = {
    "plain": core_options.Settings(),
    "area blend, in place": core_options.Settings(core_options.Options(area_blend=0.5), keep_in_place=True),
    "subdivided": core_options.Settings(core_options.Options(hole_rigidity=1.0), use_subsurf=True),
}


@pytest.mark.parametrize("uv_map", [True, False], ids=["with a UV map", "without"])
@pytest.mark.parametrize("name", SETTINGS)
def test_escape_at_every_report_of_an_unwrap(name, uv_map, monkeypatch):
    grid, _ = prepare(uv_map)
    if name == "subdivided":
        grid.modifiers.new("Subdivision", "SUBSURF").levels = 1
    with monkeypatch.context() as patch:
        reports = cancelling_at(patch, -1)
        assert Started(SETTINGS[name]).worker.wait(60.0)
    before = everything()
    for at in range(len(reports)):
        with monkeypatch.context() as patch:
            seen = cancelling_at(patch, at)
            running = Started(SETTINGS[name])
            with pytest.raises(native.spectral_conformal().Cancelled):
                running.write()
        assert len(seen) == at + 1
        assert digest.changes(before, everything()) == []
    solutions = Started(SETTINGS[name]).write()
    assert sum((solution.column("status") == "solved").sum() for solution in solutions) == 3


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
    pack = placement.pack

    def interrupted(*arguments):
        if packed:
            pack(*arguments)
        raise KeyboardInterrupt

    before = everything()
    monkeypatch.setattr(placement, "pack", interrupted)
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


def searched(target, options, report):
    """Search for seams, then solve the meshes that are cut open, as the operator does."""
    session.drop(kept_maps.KeptMaps)
    cuts = core_suggestion.suggest(target.polygons, options, report)
    edit_meshes = seams.read_cut_open(target, cuts)
    steps.solve(edit_meshes, target.settings, report)


def test_cancelling_at_every_report_of_a_search_and_its_unwrap():
    prepare_closed()
    target = seams.read(bpy.context, core_options.Settings())
    options, calls = core_suggestion.Options(), []
    searched(target, options, lambda *report: calls.append(report))
    before = everything()
    n_cancelled = 0
    for at in range(len(calls)):
        seen = []
        try:
            searched(target, options, lambda *report, seen=seen, at=at: seen.append(report) or len(seen) <= at)
        except native.spectral_conformal().Cancelled:
            assert len(seen) == at + 1
            n_cancelled += 1
        else:
            # Threads share the solves, and only the caller's thread reports: sometimes there are fewer reports.
            assert len(seen) <= at
        assert digest.changes(before, everything()) == []
    assert n_cancelled > len(calls) / 2


def test_escape_after_any_step_of_a_drag(monkeypatch):
    grid, other = prepare()
    for edited in (grid, other):
        for vertex in scenes.edit_mesh(edited).verts:
            vertex.select_set(edited == grid and vertex.index in (0, 47))
    assert bpy.ops.uv.spectral_shape(kind="PUSH_PULL") == {"FINISHED"}
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
