# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration: unwrap a mesh in a real Blender, compare with Blender's own unwrappers, draw the results."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from tools import paths, steps
from tools.environment import PYTHON, VENV, blender_command, site_packages
from tools.steps import BUILD, ROOT, StepError

OUTPUT = BUILD / "demo"
HERE = Path(__file__).resolve().parent
SUFFIXES = (".obj", ".ply", ".stl", ".blend")
# Files that the steps exchange, and the add-on where Blender looks for it.
WORK = BUILD / "demo-work"
RESULTS = ("mesh.obj", "mesh.blend", "uv_layout.png", "checker.png", "report.json")


def check_mesh(mesh: Path | None) -> Path | None:
    """Return the absolute path of the mesh; raise StepError if it does not exist or cannot be read."""
    if mesh is None:
        return None
    found = paths.existing_file(mesh)
    if mesh.suffix.lower() not in SUFFIXES:
        raise StepError(f"{mesh}: expected one of {', '.join(SUFFIXES)}.")
    return found


def run(mesh: Path | None) -> int:
    """Unwrap the mesh (Suzanne if None), write everything to build/demo/ and print the table."""
    for folder in (OUTPUT, WORK):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
    job = WORK / "job.json"
    job.write_text(json.dumps({"mesh": str(mesh) if mesh else None, "output": str(OUTPUT), "work": str(WORK)}))
    blender, environ = blender_command(), profile(WORK / "scripts")
    steps.run(
        "unwrapping in Blender, three methods",
        [*blender, HERE / "blender_unwrap.py", "--", job],
        log="demo",
        environ=environ,
    )
    steps.run("measuring and drawing the UV layout", [PYTHON, HERE / "measure.py", job], log="demo")
    steps.run(
        "rendering the checker texture", [*blender, HERE / "blender_render.py", "--", job], log="demo", environ=environ
    )
    print()
    print(table(json.loads((OUTPUT / "report.json").read_text())))
    print()
    for name in RESULTS:
        print(f"{(OUTPUT / name).relative_to(ROOT)}  {(OUTPUT / name).stat().st_size / 1e6:.1f} MB")
    return 0


def profile(scripts: Path) -> dict[str, str]:
    """Make a folder of user scripts with the add-on; return the settings by which Blender and its Python find it."""
    addons = scripts / "addons"
    addons.mkdir(parents=True)
    # Links, since copies could become stale.
    (addons / "spectral_unwrap").symlink_to(ROOT / "addon", target_is_directory=True)
    # Blender appends this folder to Python's path: the system's Blender finds the native module there, after its own.
    (addons / "modules").symlink_to(site_packages(VENV), target_is_directory=True)
    return {"BLENDER_USER_SCRIPTS": str(scripts), "PYTHONPATH": str(ROOT)}


TITLES = ("method", "mean QC", "max QC", "flips", "first call, s", "again, s")


def cells(row: dict) -> list[str]:
    """Return the cells of a method in the comparison."""
    qualities = [f"{row['mean_qc']:.5f}", f"{row['max_qc']:.3f}", str(row["flips"])]
    return [row["method"], *qualities, f"{row['first_seconds']:.2f}", f"{row['seconds']:.2f}"]


def table(report: dict) -> str:
    """Return the comparison as lines of text."""
    mesh = report["mesh"]
    lines = [
        f"{mesh['name']}: {mesh['vertices']} vertices, {mesh['triangles']} triangles, {mesh['islands']} islands; "
        f"Blender {report['versions']['blender']}",
    ]
    for row in (TITLES, *map(cells, report["methods"])):
        lines.append(f"{row[0]:<22}" + "".join(f"{cell:>15}" for cell in row[1:]))
    return "\n".join(lines)
