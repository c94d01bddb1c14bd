# SPDX-License-Identifier: GPL-3.0-or-later
"""Base of all operators of the add-on: errors become reports."""

from collections.abc import Callable, Iterable

import bpy

from ..core.errors import ReadableError
from ..core.words import texts
from ..core.words.translation import translate


class ReportingOperator:
    """Mixin of an operator on meshes whose work is `run`."""

    bl_options = {"REGISTER", "UNDO"}
    modes = frozenset({"EDIT_MESH"})
    """The modes of Blender in which the operator works."""
    described_by = ""
    """The property whose chosen item describes a button of the operator; empty for the operator's own description."""

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return what the chosen item does; empty for the operator's own description."""
        if not cls.described_by:
            return ""
        items = properties.bl_rna.properties[cls.described_by].enum_items
        return translate(items[getattr(properties, cls.described_by)].description)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow the operator in its modes."""
        return context.mode in cls.modes

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the work; report readable errors."""
        return self.reporting(self._run, context)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Do the work and return the operator's status.

        Raises:
            ReadableError: nothing was changed; the message says why.
        """
        raise NotImplementedError

    def _run(self, context: bpy.types.Context) -> set[str]:
        """Refuse properties that are no numbers, which Blender does not put within their limits."""
        for each in self.properties.bl_rna.properties:
            value = getattr(self, each.identifier) if each.type == "FLOAT" else 0.0
            if any(part != part for part in (value if getattr(each, "is_array", False) else (value,))):
                raise ReadableError(translate("{name} must be a number, not nan").format(name=translate(each.name)))
        return self.run(context)

    def canceled(self, warning: str) -> set[str]:
        """Report why nothing was done; return the operator's status."""
        self.report({"WARNING"}, warning)
        return {"CANCELLED"}

    def without_map(self, context: bpy.types.Context) -> set[str]:
        """Report that there is no UV map that may be read or written; return the operator's status."""
        chosen = context.selected_objects if context.mode == "OBJECT" else ()
        is_linked = any(each.type == "MESH" and each.data.library for each in chosen)
        return self.canceled(translate(texts.ONLY_LINKED_MESHES if is_linked else texts.NO_UV_MAP))

    def report_all(self, reports: Iterable[tuple[str, str]]) -> None:
        """Report these (level, text) pairs, but for empty texts."""
        for level, text in reports:
            if text:
                self.report({level}, text)

    def reporting(self, function: Callable[..., set[str]], *arguments: object) -> set[str]:
        """Return the status of `function`, or report the message of a readable error."""
        try:
            return function(*arguments)
        except ReadableError as error:
            self.report({"ERROR"}, str(error))
        except MemoryError:
            self.report(
                {"ERROR"},
                translate(
                    "Not enough memory, so nothing was changed; close other programs, select fewer faces, or "
                    "lower the subdivision levels"
                ),
            )
        return {"CANCELLED"}
