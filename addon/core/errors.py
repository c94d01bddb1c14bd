# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that artists read, and printing each of them once."""

from collections.abc import Callable


class ReadableError(Exception):
    """An error whose message tells an artist what to do; not a programming error."""


class PrintOnce:
    """Prints every problem once: an error in a handler or while drawing would repeat with each redraw."""

    def __init__(self, sentence: Callable[[str], str]) -> None:
        """Print `sentence(problem)`."""
        self._sentence = sentence
        self._printed: set[str] = set()

    def __call__(self, error: Exception) -> None:
        """Print the error, unless the same was printed since `forget`."""
        problem = str(error) if isinstance(error, ReadableError) else f"{type(error).__name__}: {error}"
        if problem not in self._printed:
            self._printed.add(problem)
            print(self._sentence(problem))

    def forget(self) -> None:
        """Print everything once more."""
        self._printed.clear()
