"""The cost of fold-free maps: flips, mean QC and time on rough surfaces, fingers and, if present, the shared meshes.

    build/venv/bin/python -m tests.benchmarks.fold_free_maps [folder of OBJ files] [--keep]

Time is the ratio of a solve with fold_free to one without, in the same run. At the end, patches are grown at random on
the shared meshes, and those that overlap themselves are counted with and without fold_free. The default folder has the
shared meshes, beside the project.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
import spectral_conformal as sc

from tests.benchmarks import documents
from tests.module import meshes

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "real"
LARGEST = 100_000  # vertices


def row(name: str, vertices: np.ndarray, faces: list[list[int]]) -> str | None:
    """Return one line of the table, or None for a mesh whose map has no folds."""
    mesh = (vertices, *meshes.polygons(faces))
    start = time.perf_counter()
    plain = sc.unwrap(*mesh)
    middle = time.perf_counter()
    if all(chart.status == "solved" and not chart.flipped for chart in plain.charts):
        return None
    free = sc.unwrap(*mesh, fold_free=True)
    end = time.perf_counter()
    if all(chart.status != "solved" for chart in free.charts):
        return None  # closed, one-sided

    def total(charts: list, value: str) -> str:
        solved = [chart for chart in charts if chart.status == "solved"]
        if not solved:
            return "no map"
        area = sum(chart.area for chart in solved)
        qc = sum(chart.mean_qc * chart.area for chart in solved) / area
        return f"{qc:.4g}" if value == "qc" else str(sum(chart.flipped for chart in solved))

    way = "embedding" if any(chart.is_embedding for chart in free.charts) else "in place"
    return (
        f"{name:24}{len(vertices):>8}{total(plain.charts, 'flipped'):>8} ->{total(free.charts, 'flipped'):>3}"
        f"{total(plain.charts, 'qc'):>12} ->{total(free.charts, 'qc'):>8}  {way:10}"
        f"{middle - start:8.2f} s x{(end - middle) / (middle - start):5.1f}"
    )


def grown(faces: list[list[int]], size: int, rng: np.random.Generator) -> np.ndarray:
    """Return which faces a patch has, (F,) bool, grown at random over edges to `size` faces."""
    sides: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(faces):
        for a, b in zip(face, [*face[1:], face[0]]):
            sides.setdefault((min(a, b), max(a, b)), []).append(number)
    beside: list[list[int]] = [[] for _ in faces]
    for first, *others in sides.values():
        if len(others) == 1:
            beside[first].append(others[0])
            beside[others[0]].append(first)
    start = int(rng.integers(len(faces)))
    chosen, open_faces = {start}, [start]
    while open_faces and len(chosen) < size:
        at = int(rng.integers(len(open_faces))) if rng.random() < 0.5 else len(open_faces) - 1
        new = [face for face in beside[open_faces.pop(at)] if face not in chosen]
        chosen.update(new)
        open_faces += new
    patch = np.zeros(len(faces), dtype=bool)
    patch[list(chosen)] = True
    return patch


def patches(folder: Path) -> documents.Table:
    """Print how many patches of the meshes cover themselves, without fold_free and with it, and at which mean QC."""
    rng = np.random.default_rng(1)
    before, after, seconds, left = [], [], [], 0
    for path in sorted(folder.glob("*.obj")):
        vertices, faces = meshes.read_obj(path)
        if len(faces) > LARGEST:
            continue
        mesh = (vertices, *meshes.polygons(faces))
        for _ in range(12):
            size = np.exp(rng.uniform(np.log(40), np.log(min(4000, 0.8 * len(faces) + 41))))
            selected = grown(faces, int(size), rng)
            plain = sc.unwrap(*mesh, selected_faces=selected).charts
            if not any(chart.status == "solved" and chart.overlapping for chart in plain):
                continue
            start = time.perf_counter()
            free = sc.unwrap(*mesh, selected_faces=selected, fold_free=True).charts
            seconds.append(time.perf_counter() - start)
            for chart, apart in zip(plain, free):
                if chart.status == "solved" and chart.overlapping:
                    before.append(chart.mean_qc)
                    after.append(apart.mean_qc)
                    left += apart.overlapping > 0
    titles = ("patches that cover themselves", "with *No Overlaps*", "median of the mean QC")
    table = documents.Table("fold-free", (*titles, "with *No Overlaps*, median", "slowest, s"), documents.SOLVING)
    costs = (f"{np.median(before):.3f}", f"{np.median(after):.3f}", f"{np.max(seconds):.1f}") if before else ()
    table.row(len(before), left, *costs)
    return table


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=SHARED, metavar="folder of OBJ files")
    parser.add_argument("--keep", action="store_true", help="put the table of the patches into the documents")
    options = parser.parse_args()
    folder = options.folder
    cases = [(f"floater {offset:g}", *meshes.floater(offset)) for offset in (-1.0, -2.0, -5.0)]
    cases += [(f"rough grid {n} x {n}", *meshes.rough_grid(n, 2.0, 3)) for n in (20, 60, 150)]
    cases += [(f"finger of {rings} rings", *meshes.finger(16, rings)) for rings in (120, 200)]
    print(f"{'':24}{'vertices':>8}{'flipped':>14}{'mean QC':>23}  {'':10}{'time':>10}")
    for name, vertices, triangles in cases:
        line = row(name, vertices, triangles.tolist())
        if line:
            print(line, flush=True)
    for path in sorted(folder.glob("*.obj")):
        vertices, faces = meshes.read_obj(path)
        if len(vertices) <= LARGEST:
            line = row(path.stem, vertices, faces)
            if line:
                print(line, flush=True)
    if any(folder.glob("*.obj")):
        table = patches(folder)
        if options.keep:
            documents.keep(table)


if __name__ == "__main__":
    main()
