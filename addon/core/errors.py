# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that artists read, and how often."""

from collections.abc import Callable


class ReadableError(Exception):
    """Something did not work, and the message tells an artist what to do; no programming error."""


class PrintOnce:
    """Prints every problem once: an error in a handler or while drawing would come again with each redraw."""

    def __init__(self, sentence: Callable[[str], str]) -> None:
        """Print `sentence(problem)`."""
        self._sentence = sentence
        self._printed: set[str] = set()

    def __call__(self, error: Exception) -> None:
        """Print what the error says, unless the same was printed since `forget`."""
        problem = str(error) if isinstance(error, ReadableError) else f"{type(error).__name__}: {error}"
        if problem not in self._printed:
            self._printed.add(problem)
            print(self._sentence(problem))

    def forget(self) -> None:
        """Print everything once more."""
        self._printed.clear()
