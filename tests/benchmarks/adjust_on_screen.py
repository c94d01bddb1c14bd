"""Updates per second on screen while an extender is adjusted: solve, write, redraw; Blender 3.4.1, virtual screen.

    build/venv/bin/python -m tests.benchmarks.adjust_on_screen [vertices ...]

Mesa's software renderer draws the workspace UV Editing at 1600 x 1000 pixels. The default is 10000 vertices. "Still"
is a redraw of the unchanged scene.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

ROUNDS = 30


def inside(side: int, result: Path) -> None:
    """Run in Blender: time the parts of an update, in milliseconds."""
    import addon_utils
    import bpy
    import numpy as np

    addon_utils.enable("spectral_unwrap", default_set=True)
    window = bpy.context.window_manager.windows[0]
    window.workspace = bpy.data.workspaces["UV Editing"]

    def run() -> None:
        area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
        region = next(region for region in area.regions if region.type == "WINDOW")
        with bpy.context.temp_override(window=window, area=area, region=region):
            bpy.data.objects.remove(bpy.data.objects["Cube"])
            bpy.ops.mesh.primitive_grid_add(x_subdivisions=side - 1, y_subdivisions=side - 1)
            mesh = bpy.context.object.data
            for vertex in mesh.vertices:
                x, y, _ = vertex.co
                vertex.co.z = np.exp(-4.0 * ((x - 0.2) ** 2 + (y + 0.1) ** 2))
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT")
            extenders = sys.modules["spectral_unwrap.edit_mesh.extenders"]
            pair = (0, side * side // 2)
            polygons = sys.modules["spectral_unwrap.edit_mesh.read"].read_mesh(bpy.context.edit_object).polygons
            extenders.add(mesh, polygons, [pair], 50.0)
            following = sys.modules["spectral_unwrap.live.extenders"]
            settings = sys.modules["spectral_unwrap.core.solve.options"].Settings()
            islands = following.AdjustedIslands(bpy.context.edit_object, [pair], settings)
            islands.write((*pair, 1.0, 1.0), False)
            solve, spent = islands.adjustment.map, []

            def timed(changed: tuple[int, int, float, float], is_final: bool) -> np.ndarray:
                start = time.perf_counter()
                uv = solve(changed, is_final)
                spent.append(time.perf_counter() - start)
                return uv

            islands.adjustment.map = timed
            seconds = []
            for strength in np.linspace(1.0, 3.0, ROUNDS + 1)[1:]:
                start = time.perf_counter()
                islands.write((*pair, float(strength), 1.0), False)
                written = time.perf_counter()
                solved = start + spent[-1]
                bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
                seconds.append((solved - start, written - solved, time.perf_counter() - written))
            start = time.perf_counter()
            bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=5)
            still = (time.perf_counter() - start) / 5
            parts = [*(statistics.median(part) for part in zip(*seconds)), still]
            result.write_text(" ".join(str(1000 * part) for part in parts))
        bpy.ops.wm.quit_blender()

    bpy.app.timers.register(run, first_interval=3.0)


def measure(vertices: int) -> str:
    from tests.benchmarks import on_screen

    side = round(vertices**0.5)
    solve, write, draw, still = map(float, on_screen.run(__file__, side).split())
    rates = f"{1000 / (solve + write + draw):.1f} | {1000 / (solve + write):.1f}"
    return f"| {side * side} | {solve:.1f} | {write:.1f} | {draw:.1f} | {still:.1f} | {rates} |"


def main() -> None:
    if "--inside" in sys.argv:
        inside(int(sys.argv[-2]), Path(sys.argv[-1]))
        return
    print("| vertices | solve, ms | write, ms | draw, ms | still, ms | updates a second | without drawing |")
    print("|---|---|---|---|---|---|---|", flush=True)
    for vertices in sys.argv[1:] or ["10000"]:
        print(measure(int(vertices)), flush=True)


if __name__ == "__main__":
    main()
