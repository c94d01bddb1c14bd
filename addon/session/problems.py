# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems of handlers, timers and drawing: printed once, as they would come again with every redraw."""

from collections.abc import Callable

from ..core.errors import ReadableError
from . import Remembered, of


class Printed(Remembered):
    """The sentences that were printed."""

    def __init__(self) -> None:
        """Nothing was printed yet."""
        self.sentences: set[str] = set()


def print_once(error: Exception, sentence: Callable[[str], str]) -> None:
    """Print `sentence` of what the error says, unless it was printed already."""
    line = sentence(str(error) if isinstance(error, ReadableError) else f"{type(error).__name__}: {error}")
    printed = of(Printed).sentences
    if line not in printed:
        printed.add(line)
        print(line)
