"""Count the items of an FBX file by kind, so that warnings can name what Blender loses.

The binary form, as Blender's developers described it ("FBX binary file format specification", 2013): nested records
with an end offset, a number of properties and a name.
"""

from __future__ import annotations

import re
import struct
from collections import Counter
from collections.abc import Iterator

MAGIC = b"Kaydara FBX Binary  \x00\x1a\x00"
# From this version on, numbers in records have 64 bits.
_WIDE = 7500
# Where records begin, behind the version.
_FIRST = 27
# More than any program writes behind the records.
_FOOTER = 1024
_SIZES = {b"Y": 2, b"C": 1, b"B": 1, b"I": 4, b"F": 4, b"D": 8, b"L": 8}
_ARRAYS = b"fdlibc"
_MAP = "layer element uv"


def count(data: bytes) -> Counter[str]:
    """Return the number of items of every kind: objects, clips by name, custom properties, layers of meshes.

    Text files have no counts; reading stops at the first unreadable record.
    """
    found: Counter[str] = Counter()
    if not data.startswith(MAGIC):
        return found
    try:
        (version,) = struct.unpack_from("<I", data, _FIRST - 4)
        for name, _, at, end in _records(data, _FIRST, len(data), version):
            if name == "Objects":
                for kind, own, start, stop in _records(data, at, end, version):
                    found[_title(kind, own)] += 1
                    if kind == "AnimationStack":
                        found[f"clips '{_name(own)}'"] += 1
                    found.update(_parts(data, start, stop, version))
    except (struct.error, KeyError, IndexError):
        pass
    return found


def damage(data: bytes) -> str:
    """Return what is wrong with the structure of a binary file, empty if nothing: importers skip what they lack.

    A list of records ends in a record of zeros. Nothing follows in the record that it belongs to, and in the file a
    footer.
    """
    if len(data) < _FIRST:
        return "it ends within its head"
    (version,) = struct.unpack_from("<I", data, _FIRST - 4)
    lists = [(_FIRST, len(data))]
    while lists:
        at, end = lists.pop()
        try:
            for name, _, start, stop in _records(data, at, end, version):
                if not start <= stop <= end:
                    return f"the record '{name}' at byte {at} reaches to byte {stop}"
                lists += [(start, stop)] if start < stop else []
                at = stop
        except struct.error:
            return f"the record at byte {at} cannot be read"
        rest = end - at - _head(version).size
        if rest < 0 or rest > (_FOOTER if end == len(data) else 0):
            return f"a list of records ends at byte {at} instead of {end}"
    return ""


def lost(before: Counter[str], after: Counter[str]) -> list[str]:
    """Return a sentence for each kind that has fewer items, or that is new, except for the map itself."""
    sentences = []
    for kind in sorted(set(before) | set(after)):
        if after[kind] < before[kind]:
            sentences.append(f"FBX through Blender: {after[kind]} of {before[kind]} {kind} are left.")
        elif not before[kind] and kind != _MAP:
            was = "was" if after[kind] == 1 else "were"
            sentences.append(f"FBX through Blender: {after[kind]} {kind} {was} added.")
    return sentences


def _title(kind: str, properties: list[object]) -> str:
    subtype = properties[2] if len(properties) > 2 and isinstance(properties[2], bytes) else b""
    return " ".join(filter(None, (subtype.decode(errors="replace"), kind)))


def _name(properties: list[object]) -> str:
    """Return the name of an object, which is stored before that of its class."""
    name = properties[1] if len(properties) > 1 and isinstance(properties[1], bytes) else b""
    return name.partition(b"\0")[0].decode(errors="replace")


def _parts(data: bytes, at: int, end: int, version: int) -> Iterator[str]:
    for name, _, start, stop in _records(data, at, end, version):
        if name.startswith("LayerElement"):
            yield re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()
        elif name == "Properties70":
            for kind, values, *_ in _records(data, start, stop, version):
                # The mark of users' properties.
                if kind == "P" and len(values) > 3 and isinstance(values[3], bytes) and b"U" in values[3]:
                    yield "custom properties"


def _head(version: int) -> struct.Struct:
    """Return the form of a record's end, number and size of properties, and length of name."""
    return struct.Struct("<QQQB" if version >= _WIDE else "<IIIB")


def _records(data: bytes, at: int, end: int, version: int) -> Iterator[tuple[str, list[object], int, int]]:
    """Yield the name, the properties and the range of nested records of each record from `at` to `end`."""
    head = _head(version)
    while at + head.size <= end:
        stop, n_properties, size, length = head.unpack_from(data, at)
        if not stop:
            return
        at += head.size
        name = data[at : at + length].decode(errors="replace")
        at += length
        yield name, list(_properties(data, at, n_properties)), at + size, stop
        at = stop


def _properties(data: bytes, at: int, count: int) -> Iterator[object]:
    for _ in range(min(count, 8)):
        kind = data[at : at + 1]
        at += 1
        if kind in _SIZES:
            yield data[at : at + _SIZES[kind]]
            at += _SIZES[kind]
        elif kind in (b"S", b"R"):
            (size,) = struct.unpack_from("<I", data, at)
            yield data[at + 4 : at + 4 + size] if kind == b"S" else None
            at += 4 + size
        elif kind and kind in _ARRAYS:
            yield None
            (size,) = struct.unpack_from("<I", data, at + 8)
            at += 12 + size
        else:
            return
