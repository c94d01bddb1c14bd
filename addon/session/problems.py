# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems of handlers, timers and drawing, printed once, because they would repeat with every redraw."""

from collections.abc import Callable

from ..core.errors import ReadableError
from . import Remembered, of


class Printed(Remembered):
    """The printed sentences."""

    def __init__(self) -> None:
        """Begin without sentences."""
        self.sentences: set[str] = set()


def print_once(error: Exception, sentence: Callable[[str], str]) -> None:
    """Print `sentence(error)`, unless it was printed before."""
    line = sentence(str(error) if isinstance(error, ReadableError) else f"{type(error).__name__}: {error}")
    printed = of(Printed).sentences
    if line not in printed:
        printed.add(line)
        print(line)
