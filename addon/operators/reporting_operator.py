# SPDX-License-Identifier: GPL-3.0-or-later
"""What all operators of this add-on share: errors become reports."""

from collections.abc import Callable

import bpy

from ..core.errors import ReadableError
from ..core.words import texts
from ..core.words.translation import translate


class ReportingOperator:
    """Mixin of an operator whose work is `run`."""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the work; report errors that an artist can do something about."""
        return self.reporting(self.run, context)

    def run(self, context: bpy.types.Context) -> set[str]:
        """Do the work and return the operator's status.

        Raises:
            ReadableError: nothing was changed; the message says why.
        """
        raise NotImplementedError

    def reporting(self, function: Callable[..., set[str]], *arguments: object) -> set[str]:
        """Return what `function` returns; of errors that an artist can do something about, report the message."""
        try:
            return function(*arguments)
        except ReadableError as error:
            self.report({"ERROR"}, str(error))
        except MemoryError:
            self.report({"ERROR"}, translate(texts.OUT_OF_MEMORY))
        return {"CANCELLED"}
