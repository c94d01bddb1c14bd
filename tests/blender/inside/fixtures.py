# SPDX-License-Identifier: GPL-3.0-or-later
"""A fresh Blender with the add-on enabled for every test, and what the operator reported.

A plugin and no conftest.py, which the pytest outside of Blender would import.
"""

import warnings

import bpy  # isort: skip - makes addon_utils importable
import addon_utils
import pytest

ADDON = "spectral_unwrap"


@pytest.fixture(autouse=True)
def nothing_that_goes():
    """Fail on deprecated names; recorded, because Blender loses exceptions while a property is set."""
    with warnings.catch_warnings(record=True) as found:
        for category in (DeprecationWarning, PendingDeprecationWarning):
            warnings.filterwarnings("always", category=category)
        yield
    used = [str(warning) for warning in found if "Deprecation" in warning.category.__name__]
    assert not used


@pytest.fixture(autouse=True)
def fresh_blender(nothing_that_goes):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Loading the settings disables every add-on.
    assert addon_utils.enable(ADDON, default_set=True) is not None


@pytest.fixture
def uv_editor():
    """Context overrides for an area turned into a UV editor."""
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    area.ui_type = "UV"
    return {"window": window, "area": area}


@pytest.fixture
def reports(capfd):
    """A function that returns what Blender has reported since the last call, as (level, text) pairs."""

    def read():
        lines = capfd.readouterr().out.splitlines()
        pairs = (line.partition(": ") for line in lines)
        return [(level, text) for level, _, text in pairs if level in {"Info", "Warning", "Error"}]

    read()
    return read
