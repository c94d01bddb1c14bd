# SPDX-License-Identifier: GPL-3.0-or-later
"""What is printed for want of an operator that could report it: problems in handlers and while drawing."""

from collections.abc import Iterator
from contextlib import contextmanager

_printed: set[str] = set()


def print_once(sentence: str) -> None:
    """Print a sentence, unless it was printed before: handlers run with every movement of the mouse."""
    if sentence not in _printed:
        _printed.add(sentence)
        print(sentence)


def forget(beginning: str = "") -> None:
    """Let sentences that begin like this be printed again."""
    _printed.difference_update([sentence for sentence in _printed if sentence.startswith(beginning)])


@contextmanager
def errors_printed_once(what_failed: str) -> Iterator[None]:
    """Keep exceptions raised within from reaching Blender, which would bring them with every redraw; print each once.

    `what_failed` is the beginning of the sentence, to which the exception is added.
    """
    try:
        yield
    except Exception as error:  # noqa: BLE001 - whatever it is, it would come again at once
        print_once(f"{what_failed}: {type(error).__name__}: {error}")
