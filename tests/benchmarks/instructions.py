"""Count the instructions of typical calls, for comparisons that do not depend on the load of the machine.

    build/venv/bin/python -m tests.benchmarks.instructions OUT.json [case ...]
    build/venv/bin/python -m tests.benchmarks.instructions --compare BEFORE.json AFTER.json

Run it from the project's folder; PYTHONPATH may name another build of the module. Needs valgrind. Counts the second
call of each case, to leave out one-time setup. BLAS runs in one thread. Counts of the same build differ by up to 0.5 %.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from tests import callgrind
from tests.module import meshes

# A change of structure may cost no more than 3 %.
LIMIT = 1.03


def thousand_islands() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A thousand separate curved patches of 5 x 5 vertices, each of a size of its own."""
    vertices, quads = meshes.saddle_quads(5)
    n = len(vertices)
    moved = [vertices * (1 + k / 1000) + [3 * k, 0, 0] for k in range(1000)]
    return np.concatenate(moved), *meshes.polygons(np.concatenate([quads + n * k for k in range(1000)]))


def parameterize_10k() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    return lambda: sc.parameterize(vertices, triangles)


def polish_10k() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    return lambda: sc.parameterize(vertices, triangles, polish="balanced")


def extender_change() -> Callable[[], object]:
    """A solver that is kept, as while an extender's strength is dragged."""
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    solver = sc.Solver(vertices, triangles)
    strength = 1.0

    def change() -> object:
        nonlocal strength
        strength += 0.05
        return solver.solve(extenders=[(0, len(vertices) // 2, strength)], tolerance=1e-4)

    change()
    return change


def unwrap_1000_islands() -> Callable[[], object]:
    import spectral_conformal as sc

    mesh = thousand_islands()
    return lambda: sc.unwrap(*mesh)


def constrained_10k() -> Callable[[], object]:
    """An edge straight, and then an extender: the factor stays."""
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    solver = sc.Solver(vertices, triangles)
    straight = sc.Constraints(horizontal=[triangles[0, :2].tolist()])

    def solve() -> object:
        solver.solve(constraints=straight)
        return solver.solve(constraints=straight, extenders=[(17, 4000, 0.5)])

    return solve


def lscm_10k() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    return lambda: sc.parameterize(vertices, triangles, method="lscm")


def moved_pin() -> Callable[[], object]:
    """A pin among others that follows the mouse; the map folds around it."""
    import spectral_conformal as sc

    vertices, quads = meshes.saddle_quads(101)
    offsets, corners = meshes.polygons(quads)
    pinned = np.isin(corners, np.linspace(0, len(vertices) - 1, 6).astype(int))
    uv = sc.unwrap(vertices, offsets, corners).uv.copy()
    unwrapper = sc.Unwrapper(sc.Mesh(vertices, offsets, uv, corner_vertices=corners), fixed=pinned)
    moves = corners == corners[pinned][len(corners[pinned]) // 2]

    def move() -> object:
        uv[moves] += 0.02
        return unwrapper.solve(uv=uv, tolerance=1e-6, measure=False)

    move()
    return move


def fold_free() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.rough_grid(20, 2.0, 3)
    return lambda: sc.parameterize(vertices, triangles, fold_free=True)


def area_blend() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(2_000)
    return lambda: sc.parameterize(vertices, triangles, area_blend=0.5)


def forces() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(5_000, holes=3)
    pairs = [(5, len(vertices) // 2, 0.5), (40, len(vertices) // 3, 2.0)]
    return lambda: sc.parameterize(vertices, triangles, extenders=pairs, hole_rigidity=1.0)


def suggest_seams() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, quads = meshes.bulge(21, 1.5)
    mesh = vertices, *meshes.polygons(quads)
    return lambda: sc.suggest_seams(*mesh).seam_edges


def flat_islands(n: int, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A map of n bent patches of side x side points, each of a size of its own, which lie on each other."""
    vertices, quads = meshes.saddle_quads(side)
    points = vertices[:, :2] + 0.1 * vertices[:, 1::-1] ** 2
    moved = [points * (1 + k / n) for k in range(n)]
    return np.concatenate(moved), *meshes.polygons(np.concatenate([quads + len(points) * k for k in range(n)]))


def first_packing(n: int, side: int) -> Callable[[], object]:
    """As the operator packs new maps."""
    import spectral_conformal as sc

    islands = flat_islands(n, side)
    mesh = meshes.flat(*islands)
    return lambda: sc.Packer(mesh, margin=2.0, rotation="none", keep_stacks=False, quick=True)


def pack_1000_islands() -> Callable[[], object]:
    return first_packing(1000, 8)


def pack_6_islands() -> Callable[[], object]:
    return first_packing(6, 60)


def suggest_seams_body() -> Callable[[], object]:
    """A closed body with limbs: a coarse copy, many charts, and trials that can't gain."""
    import spectral_conformal as sc

    mesh = meshes.limbs(2500, 12, 1)
    return lambda: sc.suggest_seams(*mesh).seam_edges


def map_defects() -> Callable[[], object]:

    n = 100
    offsets, corners = meshes.polygons(meshes.grid_quads(n, n))
    uv = np.c_[np.arange(n * n) // n, np.arange(n * n) % n] + np.random.default_rng(0).normal(size=(n * n, 2)) / 5
    return lambda: meshes.defects(offsets, corners, uv[corners], between_islands=True)


def distortion() -> Callable[[], object]:
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    return lambda: sc.distortion(vertices, triangles, vertices[:, :2])


def rebake_512() -> Callable[[], object]:
    """Colors with opacity, for a map that is turned and as dense."""
    import spectral_conformal as sc

    vertices, triangles = meshes.bumpy_disk(10_000)
    old = 0.5 + 0.5 * vertices[:, :2]
    new = 0.5 + 0.5 * vertices[:, :2] @ np.array([[0.6, 0.8], [-0.8, 0.6]])
    image = np.random.default_rng(0).integers(0, 256, (512, 512, 4)).astype(np.uint8)
    return lambda: sc.rebake(image, old, new, triangles, content="color", opacity=True)


CASES: dict[str, Callable[[], Callable[[], object]]] = {
    case.__name__: case
    for case in (
        parameterize_10k,
        polish_10k,
        lscm_10k,
        constrained_10k,
        extender_change,
        unwrap_1000_islands,
        moved_pin,
        fold_free,
        area_blend,
        forces,
        suggest_seams,
        pack_1000_islands,
        pack_6_islands,
        suggest_seams_body,
        map_defects,
        distortion,
        rebake_512,
    )
}


def instructions(cases: Iterable[str]) -> dict[str, int]:
    """Return the instructions of a call of each case."""
    cases = list(cases)
    return dict(zip(cases, callgrind.counts(len(cases), "-m", "tests.benchmarks.instructions", "--call", *cases)))


def compare(before: Path, after: Path) -> int:
    """Print the ratios; return 1 when one is above the limit."""
    first, second = (json.loads(path.read_text()) for path in (before, after))
    slower = False
    for case in first:
        if case in second:
            ratio = second[case] / first[case]
            slower |= ratio > LIMIT
            print(f"{case:24}{first[case]:>16,}{second[case]:>16,}{ratio:9.4f}{'  slower' if ratio > LIMIT else ''}")
    return int(slower)


def main() -> int:
    """Count, or compare counts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--compare", nargs=2, type=Path, metavar=("BEFORE.json", "AFTER.json"))
    parser.add_argument("--call", nargs="+", metavar="CASE", help=argparse.SUPPRESS)
    parser.add_argument("file", nargs="?", type=Path, metavar="OUT.json")
    parser.add_argument("cases", nargs="*", metavar="case", help=", ".join(CASES))
    options = parser.parse_args()
    if options.compare:
        return compare(*options.compare)
    if options.call:
        for case in options.call:
            call = CASES[case]()
            call()
            callgrind.count(call)
        return 0
    if not options.file or not set(options.cases) <= CASES.keys():
        parser.error(f"give OUT.json, then cases among {', '.join(CASES)}")
    counts = instructions(options.cases or CASES)
    for case, count in counts.items():
        print(f"{case:24}{count:>16,}")
    options.file.write_text(json.dumps(counts, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
