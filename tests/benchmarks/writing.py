# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to write the UVs of a mesh in edit mode, in processor seconds.

    build/venv/bin/python -m tests.benchmarks.writing [--side N] [--blender NAME] [--keep]

- loops: one assignment per corner, as `addon/edit_mesh/write.py` does;
- iterators: the same by `map`, `getitem` and `setattr`, without bytecode in between;
- other mode: leave edit mode, `foreach_set`, enter it again;
- new elements: `foreach_set` in a copy of the mesh, from which all elements are made anew.

The last two end all references to elements, which other add-ons and running tools may hold; the last one loses shape
keys, too.
"""

from __future__ import annotations

import argparse
import time
from collections import deque
from collections.abc import Callable
from itertools import chain, repeat
from operator import attrgetter, getitem

from tests.benchmarks import documents, runs

ROUNDS = 15
WAYS = ("loops", "iterators", "other mode", "new elements")


def ways(side: int) -> runs.Figures:
    """Write the UVs of a grid with `side` squares along each side in every way; return the least seconds of each."""
    import bpy  # first: it puts Blender's own modules on the path
    import bmesh  # isort: skip
    import numpy as np

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, enter_editmode=True)
    edited, mesh = bpy.context.object, bpy.context.object.data
    uv = np.random.default_rng(0).random((4 * side**2, 2))
    single, columns = uv.astype(np.float32).ravel(), [memoryview(column.copy()) for column in uv.T]

    def by_loops() -> None:
        bm = bmesh.from_edit_mesh(mesh)
        layer, points = bm.loops.layers.uv.active, zip(*columns)
        for face in bm.faces:
            for loop in face.loops:
                loop[layer].uv = next(points)

    def by_iterators() -> None:
        bm = bmesh.from_edit_mesh(mesh)
        loops = chain.from_iterable(map(attrgetter("loops"), bm.faces))
        corners = map(getitem, loops, repeat(bm.loops.layers.uv.active))
        deque(map(setattr, corners, repeat("uv"), zip(*columns)), maxlen=0)

    def in_other_mode() -> None:
        bpy.ops.object.mode_set(mode="OBJECT")
        mesh.uv_layers.active.data.foreach_set("uv", single)
        bpy.ops.object.mode_set(mode="EDIT")

    def with_new_elements() -> None:
        edited.update_from_editmode()
        copy, bm = mesh.copy(), bmesh.from_edit_mesh(mesh)
        copy.uv_layers.active.data.foreach_set("uv", single)
        bm.clear()
        bm.from_mesh(copy)
        bpy.data.meshes.remove(copy)

    found = {}
    for name, write in zip(WAYS, (by_loops, by_iterators, in_other_mode, with_new_elements)):
        found[name] = min(_seconds(write) for _ in range(ROUNDS))
    return {"blender": bpy.app.version_string, "corners": len(uv), **found}


def _seconds(function: Callable[[], None]) -> float:
    start = time.process_time()
    function()
    return time.process_time() - start


def main() -> None:
    """Measure in one Blender."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=210, help="squares along each side of the grid")
    parser.add_argument("--blender", default=runs.BLENDER)
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    table = documents.Table("writing", ("Blender", "corners", *WAYS), ("addon/edit_mesh/write.py",))
    found = runs.run("writing", "ways", {"side": options.side}, blender=options.blender)
    table.row(found["blender"], found["corners"], *(f"{found[name]:.4f}" for name in WAYS))
    if options.keep:
        documents.keep(table)


if __name__ == "__main__":
    runs.answer(ways) if runs.is_measuring() else main()
