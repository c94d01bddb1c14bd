"""Text files in blocks of lines, and the words in them."""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from .edits import BLOCK, Integers

BLANK = np.zeros(256, dtype=bool)
BLANK[list(b" \t\r\n\v\f")] = True


class Block:
    """Some whole lines of a text file; places are numbers of bytes from its begin."""

    def __init__(self, text: bytes, start: int) -> None:
        """Find lines and words.

        Args:
            text: the lines; the last one may have no end.
            start: place of the block in the file.
        """
        self.start = start
        self.text = text if text.endswith(b"\n") else text + b"\n"
        self.array = np.frombuffer(self.text, np.uint8)
        self.ends = np.flatnonzero(self.array == ord("\n"))
        """(L,) of the lines, without their ends."""
        self.starts = np.append(0, self.ends[:-1] + 1)
        """(L,)"""
        blank = BLANK[self.array]
        after_blank = np.append(True, blank[:-1])
        self.word_starts = np.flatnonzero(~blank & after_blank)
        """(W,)"""
        self.word_ends = np.flatnonzero(blank & ~after_blank)
        """(W,)"""
        self.first_words = np.searchsorted(self.word_starts, np.append(self.starts, len(self.text)))
        """(L + 1,) the first word of each line, and the number of words."""

    def joined(self, lines: Integers) -> bytes:
        """Return the text of these lines only."""
        if not len(lines):
            return b""
        breaks = np.flatnonzero(np.diff(lines) != 1)
        firsts, lasts = lines[np.append(0, breaks + 1)], lines[np.append(breaks, -1)]
        spans = zip(self.starts[firsts].tolist(), (self.ends[lasts] + 1).tolist())
        return b"".join([self.text[start:end] for start, end in spans])

    def words(self, line: int) -> list[bytes]:
        """Return the words of a line."""
        return self.text[self.starts[line] : self.ends[line]].split()


def blocks(data: bytes, start: int, line_end: bytes = b"\n", size: int = BLOCK) -> Iterator[tuple[int, int]]:
    """Yield begin and end of blocks that together cover data from `start` on, each of whole lines.

    A line that ends in a backslash is in one block with the next.
    """
    while start < len(data):
        end = start + size
        while True:
            found = data.find(line_end, end - 1)
            end = found + 1 if found >= 0 else len(data)
            line = data[data.rfind(line_end, start, found) + 1 : found]
            if found < 0 or not line.rstrip(b" \t\r").endswith(b"\\"):
                break
            end += 1
        yield start, end
        start = end


def parsed(text: bytes, kind: type) -> npt.NDArray | None:
    """Return the numbers in a text, or None if it contains anything else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(text, dtype=kind, sep=" ")
        except (DeprecationWarning, ValueError, OverflowError):
            return None
