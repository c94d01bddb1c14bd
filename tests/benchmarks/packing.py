"""Packing by shape compared with Blender's packer, xatlas and sparrow: same islands, same margin, one run.

    build/venv/bin/python -m tests.benchmarks.packing [--kinds KIND ...] [--counts N ...] [--exact-up-to N]
        [--packers PACKER ...] [--seconds S] [--cap S] [--json FILE] [--picture FOLDER] [--keep TABLE]

Columns:

- fill: the area of the islands over that of the tile
- seconds, by the clock and of the processor
- covered twice: the number of pixel centers inside two islands
- gap: the smallest distance between two islands in pixels, from border points a quarter of a pixel apart

`pack` is the first packing. `pack, S s` takes as long as Blender's Exact Shape, but at most S seconds; without Exact
Shape, S seconds. Blender's margin is set to give the same gap. sparrow (`spyrrow`) packs the outer borders into a
strip, which is scaled until it is square, and does not use holes. xatlas packs at a given scale; the largest scale that
fits one tile is found by search, and its seconds include all tries. The other packers run in their own processes, for
at most --cap seconds each. A message names the packers that are not installed.
"""

from __future__ import annotations

import argparse
import functools
import importlib
import json
import multiprocessing
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
import spectral_conformal as sc

from tests.benchmarks import documents
from tests.module import meshes

TEXTURE = 1024
MARGIN = 2.0
KINDS = ("organic", "hard", "strips", "mixed", "sword")
PACKERS = ("boxes", "convex", "exact", "xatlas", "sparrow")
COUNTS = (10, 30, 100, 1_000, 10_000)
# Beyond, Blender's packing by shape takes minutes.
EXACT_UP_TO = 100
SECONDS = 60.0
# Exact Shape takes a minute for 30 islands on an idle core, and one core may have several processes.
CAP = 300.0
COLUMNS = ("fill", "seconds", "processor", "covered twice", "gap")
Island = np.ndarray
"""(T, 3, 2) triangles."""


def organic(rng: np.random.Generator) -> Island:
    """Return the star-shaped net of a limb or a leaf."""
    n, lobes, depth = 40, rng.integers(2, 6), rng.uniform(0.1, 0.55)
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    r = 1.0 + depth * np.cos(lobes * t + rng.uniform(0, 6)) + 0.15 * np.cos(2 * t) + 0.1 * np.cos(5 * t)
    points = np.c_[rng.uniform(0.6, 1.6) * r * np.cos(t), r * np.sin(t)] * rng.uniform(0.5, 1.5)
    return np.stack([np.tile(points.mean(0), (n, 1)), points, np.roll(points, -1, axis=0)], axis=1)


def _rectangles(*given: tuple[float, float, float, float]) -> Island:
    found = []
    for x, y, w, h in given:
        a, b, c, d = np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h]])
        found += [(a, b, c), (a, c, d)]
    return np.array(found)


def hard(rng: np.random.Generator) -> Island:
    """Return a panel, an unfolded box, an L, a ring or a disk."""
    a, b, c = rng.uniform(0.3, 1.5, 3)
    t = np.linspace(0.0, 2.0 * np.pi, 33)
    circle = np.c_[np.cos(t), np.sin(t)] * a
    one, two = circle[:-1], circle[1:]
    made = [
        lambda: _rectangles((0, 0, 2 * a, b)),
        lambda: _rectangles(
            (0, c, a, b), (a, 0, b, c), (a, c, b, b), (a, c + b, b, c), (a + b, c, a, b), (a + b + a, c, b, b)
        ),
        lambda: _rectangles((0, 0, a, 2), (a, 0, 1, 0.6)),
        lambda: np.concatenate([np.stack([0.6 * one, one, two], 1), np.stack([0.6 * one, two, 0.6 * two], 1)]),
        lambda: np.stack([np.zeros_like(one), one, two], 1),
    ]
    return rng.uniform(0.5, 1.5) * made[rng.integers(5)]()


def strips(rng: np.random.Generator) -> Island:
    """Return a curved strip."""
    n, length, width = 20, rng.uniform(3.0, 9.0), rng.uniform(0.15, 0.5)
    s = np.linspace(0.0, length, n + 1)
    angle = rng.uniform(-0.35, 0.35) * s + 0.3 * np.sin(s * rng.uniform(0.3, 1.2))
    middle = np.cumsum(np.c_[np.cos(angle), np.sin(angle)] * (length / n), 0)
    across = np.c_[-np.sin(angle), np.cos(angle)] * width / 2.0
    low, high = middle - across, middle + across
    pairs = (low[:-1], low[1:], high[1:]), (low[:-1], high[1:], high[:-1])
    return rng.uniform(0.7, 1.3) * np.concatenate([np.stack(three, axis=1) for three in pairs])


def mixed(rng: np.random.Generator) -> Island:
    """Return any of these, in very different sizes."""
    return np.exp(rng.normal(0.0, 0.8)) * (organic, hard, strips)[rng.integers(3)](rng)


def islands(kind: str, n: int) -> list[Island]:
    """Return n islands of a kind, the same in each run: turned at random, or two blades and small parts."""
    rng = np.random.default_rng(1)
    if kind == "sword":
        blade = _rectangles((0, 0, 20.0, 1.0))
        return [blade, blade + 0.0, *[0.6 * hard(rng) for _ in range(n - 2)]]
    found = []
    for _ in range(n):
        island, turn = globals()[kind](rng), rng.uniform(0.0, 2.0 * np.pi)
        found.append(island @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return found


def joined(given: list[Island]) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 2) and triangles (T, 3) of all islands, with shared vertices."""
    vertices, triangles, first = [], [], 0
    for island in given:
        own, index = np.unique(np.round(island.reshape(-1, 2), 9), axis=0, return_inverse=True)
        vertices.append(own)
        triangles.append(index.reshape(-1, 3) + first)
        first += len(own)
    return np.concatenate(vertices), np.concatenate(triangles)


def area(triangles: np.ndarray) -> float:
    """Return the area of triangles (T, 3, 2), unsigned."""
    one, two = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return float(0.5 * np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]).sum())


def covered_twice(triangles: np.ndarray, island: np.ndarray) -> int:
    """Return how many pixel centers triangles (T, 3, 2), in UVs, of more than one island cover."""
    owner = np.full((TEXTURE, TEXTURE), -1)
    twice = np.zeros((TEXTURE, TEXTURE), bool)
    for corners, own in zip(triangles * TEXTURE - 0.5, island):
        low = np.clip(np.ceil(corners.min(0)), 0, TEXTURE).astype(int)
        high = np.clip(np.floor(corners.max(0)), -1, TEXTURE - 1).astype(int)
        if (high < low).any():
            continue
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        sides = []
        for a, b in zip(corners, np.roll(corners, -1, axis=0)):
            sides.append((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]))
        inside = (np.min(sides, axis=0) > 0.0) | (np.max(sides, axis=0) < 0.0)
        at = owner[low[1] : high[1] + 1, low[0] : high[0] + 1]
        twice[low[1] : high[1] + 1, low[0] : high[0] + 1] |= inside & (at >= 0) & (at != own)
        at[inside] = own
    return int(twice.sum())


def gap(triangles: np.ndarray, island: np.ndarray) -> float | None:
    """Return the least distance of two islands in pixels; None without SciPy."""
    try:
        tree = importlib.import_module("scipy.spatial").cKDTree
    except ImportError:
        return None
    starts, ends = triangles.reshape(-1, 2), np.roll(triangles, -1, axis=1).reshape(-1, 2)
    own = np.repeat(island, 3)
    # Edges between two triangles of an island are not its border.
    keys = np.round(np.sort(np.stack([starts, ends], 1).view(np.complex128)[..., 0], axis=1), 7)
    _, index, number = np.unique(np.c_[keys, own], axis=0, return_inverse=True, return_counts=True)
    border = number[index.ravel()] == 1
    starts, ends, own = starts[border] * TEXTURE, ends[border] * TEXTURE, own[border]
    counts = np.maximum(2, np.ceil(4.0 * np.linalg.norm(ends - starts, axis=1)).astype(int))
    edge = np.repeat(np.arange(len(counts)), counts)
    t = (np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts)) / np.repeat(counts, counts)
    points = starts[edge] + t[:, None] * (ends - starts)[edge]
    pairs = tree(points).query_pairs(2.0 * MARGIN, output_type="ndarray")
    pairs = pairs[own[edge[pairs[:, 0]]] != own[edge[pairs[:, 1]]]]
    if not len(pairs):
        return 2.0 * MARGIN
    return float(np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1).min())


class _Run:
    """The islands of one row of tables, and each packer's result."""

    def __init__(self, kind: str, n: int) -> None:
        self.given = islands(kind, n)
        self.uv, self.triangles = joined(self.given)
        self.island = np.repeat(np.arange(n), [len(each) for each in self.given])
        self.rows: dict[str, dict[str, Any]] = {}
        self.maps: dict[str, np.ndarray] = {}

    def add(self, name: str, make: Callable[[], np.ndarray]) -> float:
        """Time a packer, which returns triangles (T, 3, 2) in UVs, and measure its map; return the seconds."""
        start = time.perf_counter(), time.process_time()
        made = make()
        took, processor = time.perf_counter() - start[0], time.process_time() - start[1]
        self.maps[name] = made
        values = area(made), took, processor, covered_twice(made, self.island), gap(made, self.island)
        self.rows[name] = dict(zip(COLUMNS, values))
        shown = " | ".join("" if v is None else f"{v:.4g}" if isinstance(v, float) else str(v) for v in values)
        print(f"| {name} | {shown} |", flush=True)
        return took


def by_shape(run: _Run, seconds: float) -> None:
    """Pack by `pack`, without and with a budget of seconds."""
    # The first call in a process loads the module.
    meshes.pack(run.uv[:3], [[0, 1, 2]])
    packers = []

    def first() -> np.ndarray:
        options = {"texture_size": TEXTURE, "margin": MARGIN, "keep_stacks": False}
        packers.append(sc.Packer(meshes.flat(run.uv, run.triangles), islands=run.island, **options))
        return packers[0].result.uv.reshape(-1, 3, 2)

    def longer() -> np.ndarray:
        packers[0].step(seconds=seconds)
        return packers[0].result.uv.reshape(-1, 3, 2)

    took = run.add("pack", first)
    if seconds > took:
        run.add(f"pack, {seconds:.0f} s", longer)


def by_boxes(run: _Run) -> None:
    """Pack bounding boxes."""
    from spectral_conformal import _layout

    corners = run.uv[run.triangles].reshape(-1, 2)
    chart = np.repeat(run.island, 3)
    run.add("boxes", lambda: _layout.packed(corners, chart, (MARGIN / TEXTURE,) * 2).reshape(-1, 3, 2))


def by_blender(run: _Run, shapes: set[str]) -> float:
    """Pack by Blender's packer with the shape methods of these names; return the seconds of the last one."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    mesh = bpy.data.meshes.new("islands")
    height = np.zeros((len(run.uv), 1))
    mesh.from_pydata(np.hstack([run.uv, height]).tolist(), [], run.triangles.tolist())
    layer = mesh.uv_layers.new()
    scene_object = bpy.data.objects.new("islands", mesh)
    bpy.context.collection.objects.link(scene_object)
    bpy.context.view_layer.objects.active = scene_object
    scene_object.select_set(True)
    loops = np.empty(3 * len(run.triangles), np.int32)
    mesh.loops.foreach_get("vertex_index", loops)
    took = 0.0
    for name, method in (("boxes", "AABB"), ("convex", "CONVEX"), ("exact", "CONCAVE")):
        if name not in shapes:
            continue
        layer = mesh.uv_layers.active
        layer.data.foreach_set("uv", run.uv[loops].astype(np.float32).ravel())
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.context.scene.tool_settings.use_uv_select_sync = True

        def pack(method: str = method) -> np.ndarray:
            # Each island gets half of the margin on each side.
            bpy.ops.uv.pack_islands(
                rotate=True, rotate_method="ANY", scale=True, margin_method="FRACTION",
                margin=0.5 * MARGIN / TEXTURE, shape_method=method,
            )  # fmt: skip
            bpy.ops.object.mode_set(mode="OBJECT")
            uv = np.empty(2 * len(loops), np.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uv)
            return uv.reshape(-1, 3, 2).astype(float)

        took = run.add(f"Blender, {name}", pack)
    return took


def by_xatlas(run: _Run) -> None:
    """Pack by xatlas with all positions tried, at the largest of some scales that needs no more than a tile."""
    xatlas = importlib.import_module("xatlas")
    uv, triangles = run.uv.astype(np.float32), run.triangles.astype(np.uint32)

    def packed(scale: float) -> np.ndarray | None:
        atlas, options = xatlas.Atlas(), xatlas.PackOptions()
        # xatlas leaves twice its padding between islands.
        options.padding, options.bruteForce, options.resolution = round(MARGIN / 2), True, TEXTURE
        options.texels_per_unit = scale
        # Each island is a chart of its own, even where its faces lie on those of another.
        atlas.add_uv_mesh(uv, triangles, run.island.astype(np.uint32)[:, None])
        atlas.generate(pack_options=options)
        if atlas.atlas_count != 1 or max(atlas.width, atlas.height) > TEXTURE:
            return None
        _, indices, found = atlas.get_mesh(0)
        made = (found * (atlas.width, atlas.height) / TEXTURE)[indices].astype(float)
        # xatlas shrinks islands that are too large for a tile, alone.
        scales = [area(made[run.island == k]) / area(each) for k, each in enumerate(run.given)]
        return made if min(scales) > 0.9 * max(scales) else None

    def search() -> np.ndarray:
        total = sum(area(each) for each in run.given)
        best, low, high = None, 0.2, 0.9
        # Fill to a hundredth.
        while best is None or high - low > 0.01:
            fill = 0.5 * (low + high)
            made = packed(TEXTURE * float(np.sqrt(fill / total)))
            if made is None:
                high = fill
                low = min(low, 0.5 * high)
            else:
                best, low = made, fill
        return best

    run.add("xatlas", search)


def by_sparrow(run: _Run, seconds: float) -> None:
    """Print the fill of sparrow, of outer borders in a strip as wide as a tile."""
    spyrrow = importlib.import_module("spyrrow")
    shapely = importlib.import_module("shapely")
    total = sum(area(each) for each in run.given)
    height = np.sqrt(total / 0.75)
    items = []
    for k, each in enumerate(run.given):
        union = shapely.unary_union([shapely.Polygon(t).buffer(1e-6) for t in each])
        border = np.array(union.exterior.simplify(1e-3).coords)[:-1]
        items.append(spyrrow.Item(str(k), [tuple(p) for p in border], demand=1, allowed_orientations=None))
    for _ in range(2):
        start = time.perf_counter()
        separation = MARGIN / TEXTURE * height
        strip = spyrrow.StripPackingInstance("islands", strip_height=height, items=items)
        config = spyrrow.StripPackingConfig(
            early_termination=False, total_computation_time=max(1, round(seconds)), seed=1,
            min_items_separation=separation, num_workers=2,
        )  # fmt: skip
        width = strip.solve(config).width
        took = time.perf_counter() - start
        fill = total / max(height, width) ** 2
        height = np.sqrt(height * width)
    print(f"| sparrow | {fill:.4g} | {took:.4g} |  |  |  |", flush=True)
    run.rows["sparrow"] = {"fill": fill, "seconds": took}


def _in_child(sent: Connection, packer: Callable[[_Run], object], kind: str, n: int) -> None:
    """Send a packer's result, or the name of a missing module."""
    run = _Run(kind, n)
    try:
        packer(run)
    except ImportError as missing:
        sent.send(missing.name)
        return
    sent.send((run.rows, run.maps))


def capped(run: _Run, packer: Callable[[_Run], object], name: str, kind: str, n: int, cap: float) -> float:
    """Run a packer in a process of its own for `cap` seconds at most; return how long it took, `cap` without an end."""
    received, sent = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.get_context("spawn").Process(target=_in_child, args=(sent, packer, kind, n))
    process.start()
    # Only the child's end stays open, so that its death is noticed.
    sent.close()
    found = None
    try:
        found = received.recv() if received.poll(cap) else None
    except EOFError:
        print(f"not measured: {name} has crashed", flush=True)
        return 0.0
    finally:
        process.kill()
        process.join()
    if isinstance(found, tuple):
        run.rows.update(found[0])
        run.maps.update(found[1])
        return max(row["processor"] if "processor" in row else row["seconds"] for row in found[0].values())
    print(
        f"| {name} | no end in {cap:.0f} s |" if found is None else f"not measured: {found} is not installed",
        flush=True,
    )
    return cap if found is None else 0.0


def draw(triangles: np.ndarray, island: np.ndarray, path: Path) -> None:
    """Draw a map, each island in a color of its own."""
    figure = importlib.import_module("matplotlib.figure").Figure(figsize=(6, 6))
    collections = importlib.import_module("matplotlib.collections")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    colors = np.random.default_rng(0).uniform(0.25, 0.95, (island.max() + 1, 3))[island]
    axes.add_collection(collections.PolyCollection(triangles, facecolors=colors, edgecolors=colors, linewidths=0.1))
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), xticks=[], yticks=[])
    figure.savefig(path, dpi=100)


def main() -> None:
    """Measure and print one table per kind and number of islands."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--counts", nargs="+", type=int, default=COUNTS)
    parser.add_argument("--packers", nargs="+", choices=PACKERS, default=PACKERS, help="beside ours")
    parser.add_argument("--exact-up-to", type=int, default=EXACT_UP_TO, help="islands, of all but Blender's boxes")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="at most, for pack beside Blender")
    parser.add_argument("--cap", type=float, default=CAP, help="seconds, for each packer beside ours")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--picture", type=Path, help="folder")
    parser.add_argument("--keep", choices=SUMMARIES, help="put this table into the documents")
    given = parser.parse_args()
    found: dict[str, dict[str, dict[str, Any]]] = {}
    for kind in given.kinds:
        for n in given.counts:
            print(f"\n| {n} {kind} | {' | '.join(COLUMNS)} |\n|{'---|' * (len(COLUMNS) + 1)}", flush=True)
            run = _Run(kind, n)
            by_boxes(run)
            seconds = given.seconds
            for shape in ("boxes", "convex", "exact"):
                if shape in given.packers and (shape != "exact" or n <= given.exact_up_to):
                    blender = functools.partial(by_blender, shapes={shape})
                    took = capped(run, blender, f"Blender, {shape}", kind, n, given.cap)
                    if shape == "exact" and took:
                        seconds = min(seconds, took)
            by_shape(run, seconds)
            others = {"xatlas": by_xatlas, "sparrow": functools.partial(by_sparrow, seconds=seconds)}
            for name, other in others.items() if n <= given.exact_up_to else ():
                if name in given.packers:
                    capped(run, other, name, kind, n, given.cap)
            found[f"{n:,} {kind}"] = run.rows
            for name, made in run.maps.items() if given.picture else ():
                draw(made, run.island, given.picture / f"{n}_{kind}_{name.replace(', ', '_').replace(' ', '_')}.png")
    if given.json:
        given.json.write_text(json.dumps(found, indent=1))
    if given.keep:
        titles, cells = SUMMARIES[given.keep]
        table = documents.Table(given.keep, ("islands", *titles), documents.PACKING)
        for name, rows in found.items():
            # What took the given seconds is last.
            longer = next((row for packer, row in rows.items() if packer.startswith("pack, ")), None)
            table.row(name, *cells({**rows, "longer": longer}))
        documents.keep(table)


def _filled(row: dict[str, Any] | None) -> str:
    """Return fill / processor seconds of a row of the first table, and the gap where it is below the margin."""
    if row is None:
        return "not measured"
    gap = f", gap {row['gap']:.2f}" if (row.get("gap") or MARGIN) < 0.995 * MARGIN else ""
    return f"{100 * row['fill']:.1f} % / {row.get('processor', row['seconds']):.1f}{gap}"


def _first(rows: dict[str, Any]) -> list[str]:
    pack = rows["pack"]
    return [_filled(rows.get("Blender, boxes")), _filled(pack), f"{pack['seconds']:.1f}"]


def _longer(rows: dict[str, Any]) -> list[str]:
    exact, longer = rows.get("Blender, exact"), rows["longer"]
    more = f"{100 * (longer['fill'] - exact['fill']):.1f}" if exact and longer else ""
    return [*map(_filled, (rows.get("Blender, boxes"), exact, rows["pack"], longer)), more]


def _others(rows: dict[str, Any]) -> list[str]:
    return [_filled(rows.get(name)) for name in ("Blender, convex", "xatlas", "sparrow", "longer")]


# The columns of the documents' tables, as fill / processor seconds, and what makes their cells.
SUMMARIES: dict[str, tuple[tuple[str, ...], Callable[[dict[str, Any]], list[str]]]] = {
    "packing-first": (("Blender, Bounding Box", "`pack`, first", "seconds by the clock"), _first),
    "packing-longer": (
        ("Blender, Bounding Box", "Blender, Exact Shape", "`pack`, first", "`pack`, longer", "more than Exact Shape"),
        _longer,
    ),
    "packing-others": (("Blender, Convex Hull", "xatlas", "sparrow", "`pack`, longer"), _others),
}


if __name__ == "__main__":
    main()
