"""The cost of the UV map overlay, for the first draw and after an edit, in Blender on a virtual screen.

    build/venv/bin/python -m tests.benchmarks.map_overlay [faces ...] [--blender NAME] [--keep]

Times are in milliseconds, medians over several edits that move one UV, on a wavy grid of 200,000 triangles by default.
"First" is the whole first draw. "Read" includes Blender's copy of the edited mesh, which "copy" times alone. "Fill"
computes triangles and values and fills the buffer of the graphics card, which Mesa's software renderer copies.
"Islands" finds flipped and overlapping faces and the numbers of the legend, once no further edit comes. `--blender`
takes `system` or `sid`; the default is both, if present.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from pathlib import Path

ROUNDS = 9


def inside(faces: int, result: Path) -> None:
    """Run in Blender: time the parts of a refill."""
    import addon_utils
    import bmesh
    import bpy
    import numpy as np

    addon_utils.enable("spectral_unwrap", default_set=True)

    def run() -> None:
        window = bpy.context.window_manager.windows[0]
        area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
        region = next(region for region in area.regions if region.type == "WINDOW")
        with bpy.context.temp_override(window=window, area=area, region=region):
            bpy.data.objects.remove(bpy.data.objects["Cube"])
            side = round((faces / 2) ** 0.5)
            bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side)
            mesh = bpy.context.object.data
            position = np.empty(3 * len(mesh.vertices))
            mesh.vertices.foreach_get("co", position)
            position[2::3] = 0.1 * np.sin(7.0 * position[::3]) * np.cos(5.0 * position[1::3])
            mesh.vertices.foreach_set("co", position)
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.mesh.quads_convert_to_tris()
            overlay, session = (sys.modules[f"spectral_unwrap.{name}"] for name in ("overlay.map_overlay", "session"))
            bm = bmesh.from_edit_mesh(mesh)
            layer = bm.loops.layers.uv.active
            bm.faces.ensure_lookup_table()
            copy = bpy.data.meshes.new("Copy")
            parts = []
            for index in range(ROUNDS + 1):
                bm.faces[index].loops[0][layer].uv.x += 1e-3
                for shown in session.of(overlay.Overlay).meshes.values():
                    shown.edited()
                start = time.perf_counter()
                ((_, shown, view),) = overlay.views(bpy.context)
                read = time.perf_counter()
                view.qc  # noqa: B018 - computed when it is first asked for
                measured = time.perf_counter()
                shown.batch("ANGLE", 1024, in_editor=False)
                filled = time.perf_counter()
                view.numbers()
                known = time.perf_counter()
                bm.to_mesh(copy)
                copied = time.perf_counter()
                steps = (copied - known, read - start, measured - read, filled - measured, filled - start)
                parts.append((*steps, known - filled))
            first = parts.pop(0)[4]
            medians = [statistics.median(part) for part in zip(*parts)]
            result.write_text(" ".join(f"{1000 * each:.1f}" for each in (*medians[:5], first, medians[5])))
        bpy.ops.wm.quit_blender()

    bpy.app.timers.register(run, first_interval=3.0)


def main() -> None:
    if "--inside" in sys.argv:
        inside(int(sys.argv[-2]), Path(sys.argv[-1]))
        return
    from tests.benchmarks import documents, on_screen

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("faces", nargs="*", type=int, default=[200_000])
    parser.add_argument("--blender", action="append", choices=on_screen.names())
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    parts = (f"{part}, ms" for part in ("copy", "read", "measure", "fill", "refill", "first", "islands"))
    table = documents.Table("map-overlay", ("Blender", "faces", *parts), documents.OVERLAY)
    for blender in options.blender or on_screen.names():
        for faces in options.faces:
            table.row(blender, f"{faces:,}", *on_screen.run(__file__, faces, blender=blender).split())
    if options.keep:
        documents.keep(table)


if __name__ == "__main__":
    main()
