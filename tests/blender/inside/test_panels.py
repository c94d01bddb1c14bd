# SPDX-License-Identifier: GPL-3.0-or-later
"""Every panel and menu draws, in every state of a mesh, in every Blender: what it asks Blender for exists."""

from types import SimpleNamespace

import bpy
import pytest

from tests.blender.inside import scenes
from tests.blender.inside.test_control import add_extender


class Layout:
    """Takes all that a layout takes; a property or an operator must exist, and its name is kept."""

    def __init__(self, operators):
        self.operators = operators

    def __getattr__(self, name):
        return lambda *arguments, **keywords: Layout(self.operators)

    def prop(self, owner, name, **_options):
        assert name in owner.bl_rna.properties

    def operator(self, name, **_options):
        self.operators.add(name)
        category, function = name.split(".")
        return Properties(getattr(getattr(bpy.ops, category), function).get_rna_type())


class Properties:
    """Takes the properties of an operator, which must exist."""

    def __init__(self, operator):
        vars(self)["operator"] = operator

    def __setattr__(self, name, _value):
        assert name in self.operator.properties


class Context:
    """The context with a region and an editor, which there are none of in background."""

    region = SimpleNamespace(width=280)

    def __init__(self, editor):
        self.space_data = SimpleNamespace(type=editor, show_uvedit=True)

    def __getattr__(self, name):
        return getattr(bpy.context, name)


def drawn():
    """Draw all of the add-on that is polled; return the classes, and the operators by editor."""
    found, operators = [], {}
    for made in (*bpy.types.Panel.__subclasses__(), *bpy.types.Menu.__subclasses__()):
        is_ours = made.__module__.startswith("spectral_unwrap") or "spectral" in made.__name__
        editor = getattr(made, "bl_space_type", "VIEW_3D")
        context = Context(editor)
        if not is_ours or (hasattr(made, "poll") and not made.poll(context)):
            continue
        shown = SimpleNamespace(layout=Layout(operators.setdefault(editor, set())))
        for name in ("draw_header", "draw_header_preset", "draw"):
            if hasattr(made, name):
                getattr(made, name)(shown, context)
        found.append(made)
    return found, operators


@pytest.mark.parametrize("what", ["nothing unwrapped", "a result", "a failure", "constraints and an extender"])
def test_all_panels_and_menus_draw(what):
    made = scenes.cube() if what == "a failure" else scenes.bumpy_grid()
    scenes.edit(made)
    if what == "constraints and an extender":
        add_extender(made, 0, 6, 1.0)
    if what != "nothing unwrapped":
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.spectral_unwrap()
    found, operators = drawn()
    assert len(found) > 10
    assert {"mesh.uv_texture_add", "uv.stitch", "uv.weld"} <= operators["IMAGE_EDITOR"]
    assert "uv.stitch" not in operators["VIEW_3D"]
