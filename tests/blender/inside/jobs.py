# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives operators that wait for a thread, without a window."""

import importlib
from contextlib import nullcontext
from types import SimpleNamespace

import bpy

job_operator = importlib.import_module("spectral_unwrap.operators.job_operator")
worker = importlib.import_module("spectral_unwrap.core.solve.worker")


class Instance(SimpleNamespace):
    """A stand-in for an instance of the operator."""


def _override(**members):
    """A stand-in for `temp_override`, which rejects fake windows and workspaces."""
    return nullcontext() if "workspace" in members else bpy.context.temp_override(**members)


class Invoked:
    """An operator invoked in a fake window, and the events sent to it.

    Attributes:
        result: the status that the operator returned last.
        reported: (level, text) of its reports.
        status: what was shown in the status bar, None where it was given back.
        timers: the timers that run.
    """

    def __init__(self, monkeypatch, operator_class, is_waiting=True, has_window=True, **properties):
        self.reported, self.status, self.timers, self.handlers = [], [], [], []
        self.operator = Instance(**properties, bl_label=operator_class.bl_label)
        self.operator.properties = SimpleNamespace(is_property_set=properties.__contains__)
        self.operator.properties.bl_rna = SimpleNamespace(properties=())
        self.operator.options = SimpleNamespace(is_invoke=True, is_repeat=False)
        self.operator.report = lambda levels, text: self.reported.append((*levels, text))
        for cls in reversed(operator_class.__mro__[:-1]):
            for name, function in vars(cls).items():
                if type(function).__name__ == "function" and not name.startswith("__"):
                    setattr(self.operator, name, function.__get__(self.operator))
        # One 3D viewport, without gizmos.
        region = SimpleNamespace(type="WINDOW", x=0, y=0, width=800, height=600)
        space = SimpleNamespace(show_gizmo=False)
        spaces = SimpleNamespace(active=space)
        view = SimpleNamespace(type="VIEW_3D", regions=[region], spaces=spaces, tag_redraw=lambda: None)
        screen = SimpleNamespace(areas=[view])
        window = SimpleNamespace(screen=screen) if has_window else None
        manager = SimpleNamespace(
            windows=[window] if has_window else [],
            modal_handler_add=self.handlers.append,
            event_timer_add=self._add_timer,
            event_timer_remove=self.timers.remove,
            progress_begin=lambda _low, _high: None,
            progress_update=lambda _value: None,
            progress_end=lambda: None,
        )
        self.context = SimpleNamespace(
            edit_object=bpy.context.edit_object,
            mode="EDIT_MESH",
            scene=bpy.context.scene,
            area=None,
            window=window,
            objects_in_mode_unique_data=bpy.context.objects_in_mode_unique_data,
            workspace=SimpleNamespace(status_text_set=self.status.append, name="Workspace"),
            screen=screen,
            preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
            temp_override=_override,
            window_manager=manager,
        )
        # In background mode it would execute.
        in_window = SimpleNamespace(app=SimpleNamespace(background=False), context=self.context)
        monkeypatch.setattr(job_operator, "bpy", in_window)
        self.result = self.operator.invoke(self.context, self.event())
        if is_waiting:
            self.wait()

    def _add_timer(self, _seconds, window):
        assert window is self.context.window
        self.timers.append(object())
        return self.timers[-1]

    @property
    def is_running(self):
        return self.result <= {"RUNNING_MODAL", "PASS_THROUGH"}

    @property
    def worker(self):
        return self.operator._job.worker

    @property
    def choice(self):
        return self.operator._job.choice

    def event(self, kind="MOUSEMOVE", value="NOTHING", **others):
        usual = {"mouse_x": 0, "mouse_y": 0, "ascii": "", "ctrl": False, "alt": False, "shift": False}
        return SimpleNamespace(**{"type": kind, "value": value, **usual, **others})

    def send(self, kind, value="PRESS", **others):
        self.result = self.operator.modal(self.context, self.event(kind, value, **others))
        return self.result

    def wait(self):
        """Let the timer run until the operator has ended, or asks and has measured everything."""
        while self.is_running and self.worker is not None:
            self.worker.wait(60.0)
            self.send("TIMER", "NOTHING")
        while self.is_running and (known := self.choice._searching or self.choice._measuring) is not None:
            known.wait(60.0)
            self.send("TIMER", "NOTHING")

    def left_nothing(self):
        """Return whether nothing of the job is left."""
        shown = self.status and self.status[-1] is not None
        return not (shown or self.timers or job_operator.running() is not None)


def defaults(operator):
    """Return the default of every property of an operator, such as `bpy.ops.uv.spectral_unwrap`."""
    properties = operator.get_rna_type().properties
    return {p.identifier: p.default for p in properties if p.identifier != "rna_type"}


def unwrap(monkeypatch, **properties):
    """Invoke Spectral Unwrap; it waits for its thread, however short the work."""
    return _waiting(monkeypatch, "operators.unwrap", "UV_OT_spectral_unwrap", bpy.ops.uv.spectral_unwrap, properties)


def suggest_seams(monkeypatch, **properties):
    """Invoke Suggest Seams; it waits for its thread, however short the work."""
    operator = bpy.ops.uv.spectral_suggest_seams
    return _waiting(monkeypatch, "operators.suggest_seams", "UV_OT_spectral_suggest_seams", operator, properties)


def adjust_extender(monkeypatch, **properties):
    """Invoke Adjust Extender; it waits for the mouse, which has moved to 0."""
    operator_class = importlib.import_module("spectral_unwrap.operators.extender").UV_OT_spectral_extender
    values = {**defaults(bpy.ops.uv.spectral_extender), **properties}
    dragged = Invoked(monkeypatch, operator_class, is_waiting=False, **values)
    if dragged.is_running:
        dragged.send("MOUSEMOVE", "NOTHING", mouse_x=0, shift=False)
    return dragged


def _waiting(monkeypatch, module, name, operator, properties):
    operator_class = getattr(importlib.import_module(f"spectral_unwrap.{module}"), name)
    with monkeypatch.context() as patch:
        patch.setattr(worker.Worker, "wait", lambda _self, _seconds: False)
        return Invoked(monkeypatch, operator_class, is_waiting=False, **{**defaults(operator), **properties})
