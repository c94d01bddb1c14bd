"""Rows of elements, in text or binary: where their properties are and what they hold, in blocks of rows."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

from .._arguments import doubles
from .edits import Integers, ranges
from .lines import Block, blocks, parsed
from .mesh import AssetError, is_whole, numbers

# Codes of the module struct.
_CODES = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
# In a block of binary rows.
_ROWS = 1 << 12


@dataclass
class Property:
    """A property of each row of an element; a list stores its length before its values."""

    name: str
    type: str
    count_type: str | None
    """Of a list: the type of its length."""
    line: int
    """In the header, from 0."""


@dataclass
class Element:
    """Rows with the same properties, in the order of the properties' values."""

    name: str
    rows: int
    line: int
    """In the header, from 0."""
    properties: dict[str, Property]
    start: int = 0
    """Of its rows in the file."""
    end: int = 0

    def first(self, names: Sequence[str]) -> Property | None:
        """Return the first of these properties that exists."""
        return next((self.properties[name] for name in names if name in self.properties), None)


@dataclass
class Column:
    """A property in some rows."""

    starts: Integers
    """(n,) places in the file; a list begins with its length."""
    ends: Integers
    """(n,)"""
    counts: Integers
    """(n,) numbers of values."""
    values: npt.NDArray
    """(sum of counts,)"""


@dataclass
class Rows:
    """Rows of an element that follow each other."""

    first: int
    """Number of the first one in the element."""
    start: int
    """Place in the file."""
    end: int
    columns: dict[str, Column]

    def __len__(self) -> int:
        """Return the number of rows; 0 if they have no properties."""
        return len(next(iter(self.columns.values())).counts) if self.columns else 0

    def table(self, names: Iterable[str]) -> npt.NDArray[np.float64]:
        """Return the values of some properties that are not lists, (n, k)."""
        columns = [doubles(self.columns[name].values[: len(self)]) for name in names]
        return np.stack(columns, axis=1)


class Reader(Protocol):
    """Of the rows of a file."""

    def rows(self, element: Element) -> Iterator[Rows]:
        """Yield the rows of an element, from its start on, in blocks.

        Raises:
            AssetError: a row is broken, or the file ends before the last one.
        """
        ...


class TextReader:
    """Reader of a text file with a row per line; what follows in a line is ignored, and so are blank lines."""

    def __init__(self, path: Path, data: bytes) -> None:
        """Take the content of a file, whose path is for messages."""
        self._path = path
        self._data = data

    def rows(self, element: Element) -> Iterator[Rows]:
        """Yield the rows of an element in blocks; see `Reader`."""
        done = 0
        spans = blocks(self._data, element.start)
        while done < element.rows:
            start, end = next(spans, (0, 0))
            if start == end:
                raise _ends_at(self._path, element, done)
            block = Block(self._data[start:end], start)
            lines = np.flatnonzero(np.diff(block.first_words))[: element.rows - done]
            if not len(lines):
                continue
            if done + len(lines) == element.rows:
                end = min(end, start + int(block.ends[lines[-1]]) + 1)
            yield Rows(done, start, end, self._columns(element, block, lines))
            done += len(lines)

    def _columns(self, element: Element, block: Block, lines: Integers) -> dict[str, Column]:
        values = parsed(block.text, np.float64)
        is_number = np.ones(len(block.word_starts), dtype=bool)
        if values is None or len(values) != len(is_number):
            found = [_number(word) for word in block.text.split()]
            is_number = np.array([number is not None for number in found])
            values = np.array([0.0 if number is None else number for number in found])
        place = block.first_words[lines]
        columns = {}
        for each in element.properties.values():
            first, counts = place, np.ones(len(lines), dtype=np.int64)
            if each.count_type:
                self._check_words(block, lines, place, counts, is_number)
                lengths = values[np.minimum(place, len(values) - 1)]
                is_length = is_whole(lengths) & (lengths >= 0)
                if not is_length.all():
                    bad = int((~is_length).argmax())
                    where = self._where(block, int(lines[bad]))
                    raise AssetError(f"{where}: {element.name} has a list of length {lengths[bad]:.15g}.")
                counts = lengths.astype(np.int64)
                place = place + 1
            self._check_words(block, lines, place, counts, is_number)
            words = ranges(place, counts)
            place = place + counts
            columns[each.name] = Column(
                block.start + block.word_starts[first],
                block.start + block.word_ends[place - 1],
                counts,
                values[words],
            )
        return columns

    def _check_words(
        self, block: Block, lines: Integers, place: Integers, counts: Integers, is_number: npt.NDArray[np.bool_]
    ) -> None:
        """Raise AssetError unless each line has so many numbers from its word `place` on."""
        bad = place + counts > block.first_words[lines + 1]
        if not is_number.all():
            wrong_before = np.append(0, np.cumsum(~is_number))
            last = len(is_number)
            bad |= wrong_before[np.minimum(place + counts, last)] > wrong_before[np.minimum(place, last)]
        if bad.any():
            k = int(bad.argmax())
            line = int(lines[k])
            words = [word.decode("ascii", errors="replace") for word in block.words(line)]
            numbers(self._where(block, line), words[place[k] - block.first_words[line] :], int(counts[k]))

    def _where(self, block: Block, line: int) -> str:
        number = self._data.count(b"\n", 0, block.start + int(block.starts[line])) + 1
        return f"{self._path}:{number}"


class BinaryReader:
    """Reader of a binary file."""

    def __init__(self, path: Path, data: bytes, order: str) -> None:
        """Take the content of a file, whose path is for messages, and its byte order, < or >."""
        self._path = path
        self._data = data
        self._order = order

    def rows(self, element: Element) -> Iterator[Rows]:
        """Yield the rows of an element in blocks; see `Reader`."""
        done, at = 0, element.start
        while done < element.rows:
            starts, lengths = self._lengths(element, at, done, min(_ROWS, element.rows - done))
            columns, places = {}, starts[:-1]
            for each in element.properties.values():
                first, counts = places, lengths.get(each.name)
                if counts is None:
                    counts = np.ones(len(places), dtype=np.int64)
                else:
                    places = places + np.dtype(each.count_type).itemsize
                size = np.dtype(each.type).itemsize
                values = _gathered(self._data, places, counts, np.dtype(self._order + each.type))
                places = places + size * counts
                columns[each.name] = Column(first, places, counts, values)
            yield Rows(done, at, int(starts[-1]), columns)
            done += len(starts) - 1
            at = int(starts[-1])

    def _lengths(self, element: Element, at: int, row: int, n_rows: int) -> tuple[Integers, dict[str, Integers]]:
        """Return where `n_rows` rows begin, with the end of the last one, and the lengths of their lists by name."""
        lists, fixed = [], 0
        for each in element.properties.values():
            if each.count_type:
                code = struct.Struct(self._order + _CODES[each.count_type])
                lists.append((each.name, fixed, code, np.dtype(each.type).itemsize))
                fixed = 0
            else:
                fixed += np.dtype(each.type).itemsize
        # Most files have lists of one length, which is quick to check.
        firsts = self._lengths_of_row(element, lists, at, row)
        inner = [before + code.size + count * size for count, (_, before, code, size) in zip(firsts, lists)]
        length = sum(inner) + fixed
        places = at + np.append(0, np.cumsum(inner, dtype=np.int64))[:-1] + [before for _, before, _, _ in lists]
        possible = min(n_rows, (len(self._data) - at) // length) if length else n_rows
        if not possible:
            raise _ends_at(self._path, element, row)
        starts = at + length * np.arange(possible + 1)
        is_alike = True
        for place, count, (_, _, code, _) in zip(places, firsts, lists):
            kind = np.dtype(code.format)
            found = np.ndarray(possible, kind, self._data, int(place), (length,))
            is_alike = is_alike and bool((found == count).all())
        if is_alike:
            return starts, {name: np.full(possible, count) for count, (name, *_) in zip(firsts, lists)}
        starts, lengths = [at], []
        for number in range(row, row + n_rows):
            found = self._lengths_of_row(element, lists, starts[-1], number)
            lengths.append(found)
            inside = sum(before + code.size + n * size for n, (_, before, code, size) in zip(found, lists))
            starts.append(starts[-1] + inside + fixed)
            if starts[-1] > len(self._data):
                raise _ends_at(self._path, element, number)
        table = np.array(lengths, dtype=np.int64).reshape(-1, len(lists))
        return np.array(starts), {name: column for column, (name, *_) in zip(table.T, lists)}

    def _lengths_of_row(self, element: Element, lists: Sequence[tuple], at: int, row: int) -> list[int]:
        result = []
        for _, before, code, size in lists:
            at += before
            try:
                count = int(code.unpack_from(self._data, at)[0])
            except (struct.error, ValueError, OverflowError):
                raise _ends_at(self._path, element, row) from None
            if count < 0:
                raise AssetError(f"{self._path}: {element.name} {row} has a list of length {count}.")
            at += code.size + count * size
            if at > len(self._data):
                raise _ends_at(self._path, element, row)
            result.append(count)
        return result


def _ends_at(path: Path, element: Element, row: int) -> AssetError:
    return AssetError(f"{path}: ends at {element.name} {row} of {element.rows}.")


def _gathered(data: bytes, places: Integers, counts: Integers, kind: np.dtype) -> npt.NDArray:
    """Return the values that stand one after the other from each place on, `counts` of them."""
    starts = ranges(places, counts, kind.itemsize)
    array = np.frombuffer(data, np.uint8)
    return array[starts[:, None] + np.arange(kind.itemsize)].reshape(-1).view(kind)


def _number(word: bytes) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None
