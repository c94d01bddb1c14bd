"""The whole operator beside Blender's own Unwrap, on the same mesh in the same run.

    build/venv/bin/python -m tests.benchmarks.blender_operator [vertices along a side, default 223]

Runs in the `bpy` of the environment and in the system's Blender, each in a process of its own.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

SIDE = 223


def measure(side: int) -> None:
    import bpy  # first: it puts Blender's own modules on the path
    import addon_utils  # isort: skip
    import numpy as np

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("spectral_unwrap")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side - 1, y_subdivisions=side - 1)
    mesh = bpy.context.object.data
    position = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", position)
    position = position.reshape(-1, 3)
    position[:, 2] = 0.3 * np.sin(7 * position[:, 0]) * np.cos(5 * position[:, 1])
    mesh.vertices.foreach_set("co", position.ravel())
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")

    def seconds(operator: object, **options: str) -> float:
        start = time.perf_counter()
        assert operator(**options) == {"FINISHED"}
        return time.perf_counter() - start

    spectral = min(seconds(bpy.ops.uv.spectral_unwrap) for _ in range(3))
    conformal = seconds(bpy.ops.uv.unwrap, method="CONFORMAL")
    angle_based = seconds(bpy.ops.uv.unwrap, method="ANGLE_BASED")
    print(
        f"\nBlender {bpy.app.version_string}, {len(mesh.vertices)} vertices: spectral {spectral:.2f} s, "
        f"CONFORMAL {conformal:.2f} s ({conformal / spectral:.1f} times as long), "
        f"ANGLE_BASED {angle_based:.2f} s ({angle_based / spectral:.1f} times)"
    )


def main() -> None:
    from tests.blender import blenders

    side = sys.argv[1] if len(sys.argv) > 1 else str(SIDE)
    for blender in blenders.all_blenders():
        with tempfile.TemporaryDirectory() as folder:
            environment = blender.make_profile(Path(folder))
            separator = [] if blender.python else ["--"]
            command = [*blender.script_command(Path(__file__)), *separator, "--one", side]
            output = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
            print(*(line for line in output.splitlines() if line.startswith("Blender 3") or "CONFORMAL" in line))


if __name__ == "__main__":
    if "--one" in sys.argv:
        measure(int(sys.argv[-1]))
    else:
        main()
