"""How many faces a file has, without reading its content where its format allows that."""

from __future__ import annotations

import json
import re
import struct
from pathlib import Path
from typing import Any

_BLOCK = 1 << 22
_STL_HEADER, _STL_TRIANGLE = 84, 50
# Of glTF: how many triangles so many vertices are in each mode.
_TRIANGLES = {4: lambda n: n // 3, 5: lambda n: max(0, n - 2), 6: lambda n: max(0, n - 2)}
_HEADER = 1 << 16


def faces_in(path: Path) -> int | None:
    """Return the number of faces of a file, triangles where it has no others; None if unknown.

    In OBJ and STL as text, words are counted; of USD only the sizes of faces are read. Broken files, .blend and .fbx
    are unknown.
    """
    count = {
        ".glb": _of_glb,
        ".gltf": lambda path: _of_gltf(json.loads(path.read_bytes())),
        ".obj": lambda path: _occurrences(path, b"\nf ", b"\nf\t"),
        ".off": _of_off,
        ".ply": _of_ply,
        ".stl": _of_stl,
        **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), _of_usd),
    }.get(path.suffix.lower())
    try:
        return None if count is None else count(path)
    except Exception:  # noqa: BLE001 - whatever is wrong with a file, its reader says so later
        return None


def _of_glb(path: Path) -> int:
    with path.open("rb") as file:
        _, _, _, length, _ = struct.unpack("<5I", file.read(20))
        return _of_gltf(json.loads(file.read(length)))


def _of_gltf(content: dict[str, Any]) -> int:
    accessors, total = content["accessors"], 0
    for mesh in content.get("meshes", ()):
        for primitive in mesh["primitives"]:
            number = primitive.get("indices", primitive["attributes"]["POSITION"])
            count = _TRIANGLES.get(primitive.get("mode", 4))
            total += count(accessors[number]["count"]) if count else 0
    return total


def _occurrences(path: Path, *words: bytes) -> int:
    """Count words of one length in a file that begins with a line break."""
    found, rest = 0, b"\n"
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            text = rest + block
            found += sum(text.count(word) for word in words)
            # Too short for a word that was counted.
            rest = text[1 - len(words[0]) :]
    return found


def _of_off(path: Path) -> int:
    with path.open("rb") as file:
        text = re.sub(rb"#[^\n]*", b"", file.read(_HEADER))
    words = [word for word in text.split() if word.isdigit()]
    return int(words[1])


def _of_ply(path: Path) -> int:
    with path.open("rb") as file:
        return int(re.search(rb"\n\s*element\s+face\s+(\d+)", file.read(_HEADER)).group(1))  # type: ignore[union-attr]


def _of_stl(path: Path) -> int:
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(_STL_HEADER)
    if len(head) == _STL_HEADER:
        (count,) = struct.unpack("<I", head[80:])
        # The word "solid" begins binary files, too.
        if size == _STL_HEADER + _STL_TRIANGLE * count or not head.startswith(b"solid"):
            return int(count)
    return _occurrences(path, b"endfacet")


def _of_usd(path: Path) -> int:
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(str(path))
    total = 0
    # Prototypes of instances once.
    for root in (stage.GetPseudoRoot(), *stage.GetPrototypes()):
        for prim in Usd.PrimRange(root):
            if prim.IsA(UsdGeom.Mesh):
                total += len(UsdGeom.Mesh(prim).GetFaceVertexCountsAttr().Get(Usd.TimeCode.EarliestTime()) or ())
    return total
