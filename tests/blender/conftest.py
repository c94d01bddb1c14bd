# SPDX-License-Identifier: GPL-3.0-or-later
"""The tests in `inside` are for the pytest that runs within Blender."""

from tests.blender import collecting


def pytest_pycollect_makemodule(module_path, parent):
    is_inside = module_path.parent == collecting.INSIDE
    return collecting.InsideFile.from_parent(parent, path=module_path) if is_inside else None
