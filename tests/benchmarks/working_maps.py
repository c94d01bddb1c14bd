"""Work on an existing map, compared with Blender's methods in one run.

    build/venv/bin/python -m tests.benchmarks.working_maps [mesh.obj ...] [--vertices N] [--blender NAME] [--keep]
    build/venv/bin/python -m tests.benchmarks.working_maps --reach [--sizes N ...] [--keep]
    build/venv/bin/python -m tests.benchmarks.working_maps --follow [--sizes N ...] [--keep]

The first form maps generated models, or the given files, by every method. Columns:

- mean QC over the surface
- mean symmetric Dirichlet energy, 4 for an isometry, at the scale of the whole map that minimizes it
- standard deviation of log2 of the scale
- flipped and overlapping faces
- deviation of the chain, or of the worst side of the rectangle, from a straight line, over the root of the map's area
- seconds from the mesh to the map, including an unwrap that the method needs first

A chain is one side of the patch, between two of its four corners; all four sides make the rectangle. They are made
straight by constraints, and as in other tools: by pinning their points on the line through the ends, spaced by length,
and solving again by LSCM.

`--reach` compares a relaxation with Blender's MINIMUM_STRETCH of 10 iterations, which minimizes the same energy. It
reports when the relaxation falls below Blender's energy, when it is within 0.1 % of its own final energy, and the peak
memory of a plain solve and of a relaxation.

`--follow` times the solves of live unwrapping, with a moving border and with a straight side, and compares solves with
constraints with a plain one.
"""

from __future__ import annotations

import argparse
import importlib
import json
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tests.benchmarks import documents, generated, runs
from tests.benchmarks.documents import Table
from tests.benchmarks.generated import Mesh

VERTICES = 2_500
REACH = (10_000, 50_000, 200_000)
ROUNDS = 2
CONSTRAINED_ROUNDS = 15
# Maximum number of steps of a relaxation that ends by itself.
MANY_STEPS = 1_000
CODE = (*documents.RELAXING, "native/src/layout", "native/packing")
# Of the generated models, the one in the documents.
KEPT = "noisy quads"
TITLES = ("mean QC", "energy", "spread", "flipped", "overlapping", "off straight", "s")


class _InBlender:
    """One mesh in edit mode, mapped by Blender's methods."""

    def __init__(self, mesh: Mesh) -> None:
        import bpy  # first: it puts Blender's own modules on the path

        from tests.benchmarks import operator_scenes

        self._bpy = bpy
        operator_scenes._make(bpy, [mesh])
        self.methods = operator_scenes._known(bpy, operator_scenes.METHODS)

    def unwrap(self, method: str, **options: Any) -> np.ndarray:  # noqa: ANN401 - the operator's
        """Return the map of a method, (C, 2)."""
        assert self._bpy.ops.uv.unwrap(method=method, **options) == {"FINISHED"}
        return self.uv()

    def minimize_stretch(self, iterations: int) -> np.ndarray:
        """Return the map of the older operator, which starts from the existing map."""
        # The operator needs the UV editor.
        window = self._bpy.context.window_manager.windows[0]
        area = window.screen.areas[0]
        before, area.ui_type = area.ui_type, "UV"
        with self._bpy.context.temp_override(window=window, area=area, region=area.regions[-1]):
            self._bpy.ops.uv.select_all(action="SELECT")
            assert self._bpy.ops.uv.minimize_stretch(iterations=iterations) == {"FINISHED"}
        area.ui_type = before
        return self.uv()

    def pinned(self, corners: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return the LSCM map with these `corners` (C,) bool pinned at their `points` (C, 2)."""
        self._pin(corners, points)
        uv = self.unwrap("CONFORMAL")
        self._pin(corners, points, pin=False)
        return uv

    def uv(self) -> np.ndarray:
        """Return the active map, (C, 2)."""
        bm, layer = self._layer()
        return np.array([loop[layer].uv for face in bm.faces for loop in face.loops], dtype=np.float64)

    def _pin(self, corners: np.ndarray, points: np.ndarray, pin: bool = True) -> None:
        bm, layer = self._layer()
        loops = (loop for face in bm.faces for loop in face.loops)
        for loop, is_pinned, point in zip(loops, corners.tolist(), points.tolist(), strict=True):
            if is_pinned:
                loop[layer].uv = point
                loop[layer].pin_uv = pin

    def _layer(self) -> tuple[Any, Any]:
        import bmesh

        bm = bmesh.from_edit_mesh(self._bpy.context.object.data)
        return bm, bm.loops.layers.uv.active


def _timed(call: Callable[[], np.ndarray], rounds: int) -> tuple[float, np.ndarray]:
    found = []
    for _ in range(rounds):
        start = time.perf_counter()
        uv = call()
        found.append((time.perf_counter() - start, uv))
    return min(found, key=lambda each: each[0])


def measures(mesh: Mesh, uv: np.ndarray, chains: Sequence[Sequence[int]] = ()) -> runs.Figures:
    """Return the figures of a map, (C, 2); `chains` of vertices are to be straight."""
    import spectral_conformal as sc

    from tests.benchmarks import map_measures

    faces = sc.face_distortion(sc.Mesh(mesh[0], mesh[1], uv, corner_vertices=mesh[2]))
    good = (faces.area > 0) & np.isfinite(faces.qc) & np.isfinite(faces.log2_scale)
    area, scale = faces.area[good], faces.log2_scale[good]
    whole = map_measures.measure(*mesh, uv)
    return {
        "qc": float(np.average(faces.qc[good], weights=area)),
        "energy": whole.energy,
        "spread": float(np.sqrt(np.average((scale - np.average(scale, weights=area)) ** 2, weights=area))),
        "flipped": whole.flipped,
        "overlapping": whole.overlapping,
        "bent": max((_bend(_of_vertices(mesh, uv)[list(chain)]) for chain in chains), default=0.0)
        / _image_area(mesh, uv) ** 0.5,
    }


def _of_vertices(mesh: Mesh, uv: np.ndarray) -> np.ndarray:
    points = np.zeros((len(mesh.vertices), 2))
    points[mesh.corner_vertices] = uv
    return points


def _image_area(mesh: Mesh, uv: np.ndarray) -> float:
    a, b, c = (_of_vertices(mesh, uv)[mesh.triangles()[:, k]] for k in range(3))
    return abs(float(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum()) / 2.0)


def _bend(points: np.ndarray) -> float:
    """Return the distance of the farthest point from the line that lies best."""
    centered = points - points.mean(axis=0)
    return float(np.abs(centered @ np.linalg.svd(centered, full_matrices=False)[2][1]).max())


def sides_of(mesh: Mesh, points: np.ndarray) -> list[list[int]]:
    """Return the four sides of a patch between the corners of its border in a map, `points` (V, 2), in its winding.

    Raises:
        NotMeasured: it has no single border.
    """
    import spectral_conformal as sc

    faces = np.split(mesh.corner_vertices, mesh.face_offsets[1:-1])
    try:
        loop = sc._constraints._border_loop([face.tolist() for face in faces])
    except ValueError as error:
        raise runs.NotMeasured(str(error)) from None
    along = points[loop] - points[loop].mean(axis=0)
    before, own, after = (mesh.vertices[np.roll(loop, k)] for k in (1, 0, -1))
    to = [(end - own) / np.linalg.norm(end - own, axis=1)[:, None] for end in (before, after)]
    # The farthest in four directions; of those nearly as far, the sharpest, which in a net of triangles may be next.
    sharpness = 0.05 * np.ptp(along, axis=0).max() * (to[0] * to[1]).sum(axis=1)
    directions = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    corners = sorted({int(np.argmax(along @ direction + sharpness)) for direction in directions})
    if len(corners) < 4:
        raise runs.NotMeasured("its border has no four corners")
    loop = [*loop[corners[0] :], *loop[: corners[0] + 1]]
    ends = [*(corner - corners[0] for corner in corners), len(loop) - 1]
    return [loop[a : b + 1] for a, b in zip(ends[:-1], ends[1:], strict=True)]


def _lengths(mesh: Mesh, chain: Sequence[int]) -> np.ndarray:
    """Return the length from the chain's first vertex to each, (n,)."""
    steps = np.linalg.norm(np.diff(mesh.vertices[list(chain)], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _scale(mesh: Mesh, uv: np.ndarray) -> float:
    a, b, c = (mesh.vertices[mesh.triangles()[:, k]] for k in range(3))
    return float((_image_area(mesh, uv) / (np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)) ** 0.5)


def _straightened(mesh: Mesh, uv: np.ndarray, chain: Sequence[int]) -> np.ndarray:
    """Return the points of the vertices, (V, 2), with the chain on the line through its ends, as long as in 3D."""
    points = _of_vertices(mesh, uv)
    first, last = points[chain[0]].copy(), points[chain[-1]].copy()
    lengths = _lengths(mesh, chain)
    direction = (last - first) / np.linalg.norm(last - first)
    start = (first + last) / 2.0 - direction * lengths[-1] * _scale(mesh, uv) / 2.0
    points[list(chain)] = start + lengths[:, None] * _scale(mesh, uv) * direction
    return points


def _on_rectangle(mesh: Mesh, uv: np.ndarray, sides: Sequence[Sequence[int]]) -> np.ndarray:
    """Return the points of the vertices, (V, 2), with the sides on a rectangle as wide and high as they are long."""
    points = _of_vertices(mesh, uv)
    lengths = [_lengths(mesh, side) for side in sides]
    width, height = ((lengths[k][-1] + lengths[k + 2][-1]) / 2.0 * _scale(mesh, uv) for k in (0, 1))
    starts = np.array([(0, 0), (width, 0), (width, height), (0, height)])
    for k, (side, length) in enumerate(zip(sides, lengths, strict=True)):
        points[list(side)] = starts[k] + (length / length[-1])[:, None] * (starts[(k + 1) % 4] - starts[k])
    return points


def methods(meshes: Sequence[Mesh], rounds: int = ROUNDS) -> runs.Figures:
    """Map a mesh by every method, in a Blender; return the rows, each with its figures or why there are none."""
    (mesh,) = meshes
    blender = _InBlender(mesh)
    import spectral_conformal as sc

    relaxing = importlib.import_module("spectral_unwrap.core.solve.relaxing")
    rows: dict[str, runs.Figures] = {}

    def row(name: str, call: Callable[[], np.ndarray], chains: Sequence[Sequence[int]] = (), n: int = rounds) -> None:
        try:
            seconds, uv = _timed(call, n)
        except (ValueError, sc.SolveError, runs.NotMeasured) as reason:
            rows[name] = {"reason": str(reason)}
            return
        rows[name] = {**measures(mesh, uv, chains), "seconds": seconds}

    def relaxed(uv: np.ndarray, sizes: float, faces: np.ndarray | None = None) -> np.ndarray:
        polygons = relaxing.PolygonMesh(
            *mesh,
            seam_edges=np.empty((0, 2), dtype=np.int32),
            selected_faces=np.ones(len(mesh.face_offsets) - 1, dtype=bool) if faces is None else faces,
            uv=uv,
        )
        maps = relaxing.Relaxing([polygons], relaxing.RelaxOptions(sizes))
        maps.step(MANY_STEPS)
        return maps.now().maps[0]

    for method in blender.methods:
        options = {"iterations": 10} if method == "MINIMUM_STRETCH" else {}
        row(method, lambda method=method, options=options: blender.unwrap(method, **options))
    conformal = blender.unwrap("CONFORMAL")
    row("CONFORMAL, minimize_stretch, 10", lambda: (blender.unwrap("CONFORMAL"), blender.minimize_stretch(10))[1])
    row("unwrap", lambda: sc.unwrap(*mesh).uv)
    row("unwrap, No Overlaps", lambda: sc.unwrap(*mesh, fold_free=True).uv)
    for sizes in (0.0, 0.5, 1.0):
        row(f"unwrap and relax, sizes {sizes:g}", lambda sizes=sizes: relaxed(sc.unwrap(*mesh).uv, sizes))
    start = sc.unwrap(*mesh).uv
    # Half of the faces, those on one side.
    height = np.add.reduceat(mesh.vertices[mesh.corner_vertices, 1], mesh.face_offsets[:-1])
    height /= np.diff(mesh.face_offsets)
    half = height < np.median(height)
    row("unwrap, half of it relaxed in place, sizes 1", lambda: relaxed(start, 1.0, half))
    triangles = mesh.triangles()
    held = np.zeros(len(mesh.vertices), dtype=bool)
    held[mesh.corner_vertices[np.repeat(~half, np.diff(mesh.face_offsets))]] = True
    points = _of_vertices(mesh, start)
    row(
        "unwrap, half of it solved in place",
        lambda: sc.parameterize(mesh.vertices, triangles, fixed=held, uv=points).uv[mesh.corner_vertices],
    )
    try:
        sides = sides_of(mesh, _of_vertices(mesh, start))
    except runs.NotMeasured as reason:
        rows["straight side"] = {"reason": str(reason)}
        return rows
    faces = [face.tolist() for face in np.split(mesh.corner_vertices, mesh.face_offsets[1:-1])]
    side, corners = sides[0], [each[0] for each in sides]
    for what, constraints, chains, pin in (
        ("one side straight", lambda: sc.Constraints(horizontal=[side]), [side], _straightened),
        ("rectangle", lambda: sc.Constraints.rectangle(faces, corners), sides, _on_rectangle),
    ):
        row(
            f"{what}, constraints",
            lambda constraints=constraints: sc.parameterize(mesh.vertices, triangles, constraints=constraints()).uv[
                mesh.corner_vertices
            ],
            chains,
        )
        pinned = np.isin(mesh.corner_vertices, np.concatenate(chains))
        points = pin(mesh, conformal, side if pin is _straightened else sides)[mesh.corner_vertices]
        row(
            f"{what}, pinned, CONFORMAL",
            lambda pinned=pinned, points=points: (blender.unwrap("CONFORMAL"), blender.pinned(pinned, points))[1],
            chains,
        )
    return rows


def reach(meshes: Sequence[Mesh]) -> runs.Figures:
    """Compare a relaxation with MINIMUM_STRETCH with 10 iterations, in a Blender."""
    (mesh,) = meshes
    blender = _InBlender(mesh)
    if "MINIMUM_STRETCH" not in blender.methods:
        raise runs.NotMeasured("this Blender has no MINIMUM_STRETCH")
    import spectral_conformal as sc

    clock = _Clock()
    uv = blender.unwrap("MINIMUM_STRETCH", iterations=10)
    theirs = clock.read()
    their_energy = measures(mesh, uv)["energy"]
    triangles = mesh.triangles()
    clock = _Clock()
    given = sc.parameterize(mesh.vertices, triangles).uv
    unwrapped = clock.read()
    relaxation = sc.Relaxation(sc.Mesh(mesh.vertices, triangles, given[triangles]), sizes=1.0, tolerance=0.0)
    # At its own scale the map's area is not quite that of the best, as theirs has it.
    path, goes_on = [(clock.read(), relaxation.energy)], True
    while goes_on and not (len(path) > 20 and path[-1][1] > (1.0 - 1e-6) * path[-20][1]):
        goes_on = relaxation.step(1)
        path.append((clock.read(), relaxation.energy))
    end = path[-1][1]
    return {
        "vertices": len(mesh.vertices),
        "theirs": theirs,
        "their_energy": their_energy,
        "unwrap": unwrapped,
        "below": next((each for each, energy in path if energy < their_energy), None),
        "near": next((each for each, energy in path if energy < 1.001 * end), None),
        "end": end,
    }


def follow(meshes: Sequence[Mesh]) -> runs.Figures:
    """Time the solves of live unwrapping: maps within a moving border, and maps with one straight side."""
    import spectral_conformal as sc

    (mesh,) = meshes
    clock = _Clock()
    uv = sc.unwrap(*mesh).uv
    row: runs.Figures = {"vertices": len(mesh.vertices), "plain": clock.read()}
    sides = sides_of(mesh, _of_vertices(mesh, uv))
    corner = np.full(len(mesh.vertices), -1)
    corner[mesh.corner_vertices] = np.arange(len(mesh.corner_vertices))
    straight = sc.Constraints(horizontal=[corner[sides[0]].tolist()])
    clock = _Clock()
    sc.unwrap(*mesh, constraints=straight)
    row["straight"] = clock.read()
    pinned = np.isin(mesh.corner_vertices, np.concatenate(sides))
    clock = _Clock()
    unwrapper = sc.Unwrapper(sc.Mesh(mesh[0], mesh[1], uv, corner_vertices=mesh[2]), fixed=pinned)
    unwrapper.solve()
    row["first"] = clock.read()
    moves = []
    for k in range(1, 6):
        clock = _Clock()
        unwrapper.solve(uv=uv + 0.01 * k * np.sin(3.0 * uv[:, ::-1]))
        moves.append(clock.read())
    row["next"] = tuple(np.median(moves, axis=0).tolist())
    return row


def constrained(meshes: Sequence[Mesh]) -> runs.Figures:
    """Return the least seconds of the processor, of several rounds, of a plain solve and of some with constraints."""
    import spectral_conformal as sc

    (mesh,) = meshes
    triangles = mesh.triangles()
    south, east, north, west = sides_of(mesh, sc.parameterize(mesh.vertices, triangles).uv)
    given = {
        "plain": None,
        "an edge": sc.Constraints(horizontal=[south[:2]]),
        "a side": sc.Constraints(horizontal=[south]),
        "two sides": sc.Constraints(horizontal=[south, north]),
        "three sides": sc.Constraints(horizontal=[south, north], vertical=[west]),
        "a rectangle": sc.Constraints(horizontal=[south, north], vertical=[west, east]),
    }
    least = dict.fromkeys(given, float("inf"))
    for _ in range(CONSTRAINED_ROUNDS):
        for name, constraints in given.items():
            clock = _Clock()
            sc.parameterize(mesh.vertices, triangles, constraints=constraints)
            least[name] = min(least[name], clock.read()[1])
    return {"vertices": len(mesh.vertices), **least}


class _Clock:
    """Seconds since its creation: by the clock, and of the processor in all threads, which other load disturbs less."""

    def __init__(self) -> None:
        self._start = time.perf_counter(), time.process_time()

    def read(self) -> tuple[float, float]:
        return time.perf_counter() - self._start[0], time.process_time() - self._start[1]


def memory(meshes: Sequence[Mesh], is_relaxed: bool) -> runs.Figures:
    """Return the memory that a plain solve, or the relaxation of a map, needs at its peak beyond its arguments."""
    import spectral_conformal as sc

    (mesh,) = meshes
    triangles = mesh.triangles()
    uv = mesh.vertices[:, :2].copy()
    # The peak of a process begins with that of the one that started it.
    Path("/proc/self/clear_refs").write_text("5")
    before = _peak_megabytes()
    if is_relaxed:
        sc.relax(sc.Mesh(mesh.vertices, triangles, uv[triangles]), sizes=1.0)
    else:
        sc.parameterize(mesh.vertices, triangles)
    return {"megabytes": _peak_megabytes() - before}


def _peak_megabytes() -> float:
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1e3


def _models(n: int) -> dict[str, Mesh]:
    """Return one generated patch of about `n` vertices of every kind."""
    return {name: scene.meshes()[0] for name, scene in generated.kinds(n).items() if "many" not in name}


def _methods_table(mesh: str, rows: dict[str, runs.Figures]) -> Table:
    table = Table("working-maps", (mesh, *TITLES), CODE)
    for name, row in rows.items():
        if "reason" in row:
            table.row(name, row["reason"])
            continue
        quality = f"{row['qc']:.4f}", f"{row['energy']:.4f}", f"{row['spread']:.3f}", row["flipped"], row["overlapping"]
        bent = f"{row['bent']:.1e}" if "straight" in name or "rectangle" in name else ""
        table.row(name, *quality, bent, f"{row['seconds']:.3f}")
    return table


def _reach_table() -> Table:
    titles = (
        *("vertices", "MINIMUM_STRETCH, s", "its energy", "unwrap, s", "and relaxed below it, s", "of its time"),
        *("within 0.1 % of the end, s", "energy there", "peak of a solve, MB", "of a relaxation, MB"),
    )
    return Table("reach", titles, CODE)


def _add_reach(table: Table, row: runs.Figures) -> None:
    def seconds(name: str) -> str:
        return "never" if row[name] is None else " / ".join(f"{each:.2f}" for each in row[name])

    shares = "" if row["below"] is None else " / ".join(f"{a / b:.3f}" for a, b in zip(row["below"], row["theirs"]))
    table.row(
        *(row["vertices"], seconds("theirs"), f"{row['their_energy']:.4f}", seconds("unwrap"), seconds("below")),
        *(shares, seconds("near"), f"{row['end']:.4f}", f"{row['solve']:.0f}", f"{row['relax']:.0f}"),
    )


def _follow_table() -> Table:
    titles = ("vertices", "unwrap, s", "with a straight side, s", "between a held border, s", "which moves, s")
    return Table("follow", titles, CODE)


def _add_follow(table: Table, row: runs.Figures) -> None:
    seconds = (" / ".join(f"{each:.3f}" for each in row[name]) for name in ("plain", "straight", "first", "next"))
    table.row(row["vertices"], *seconds)


def _constrained_table(rows: Sequence[runs.Figures]) -> Table:
    names = [name for name in rows[0] if name not in ("vertices", "plain")]
    print("\nSeconds of the processor over those of a plain solve.")
    table = Table("constrained", ("vertices", "plain, s", *names), CODE)
    for row in rows:
        table.row(row["vertices"], f"{row['plain']:.3f}", *(f"{row[name] / row['plain']:.2f}" for name in names))
    return table


def main() -> None:
    """Measure what the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, metavar="mesh.obj")
    parser.add_argument("--vertices", type=int, default=VERTICES, help=f"of generated models, default {VERTICES}")
    parser.add_argument("--reach", action="store_true", help="the relaxation beside MINIMUM_STRETCH")
    parser.add_argument("--follow", action="store_true", help="maps between a moving border, and with straight sides")
    parser.add_argument("--sizes", nargs="+", type=int, default=REACH, metavar="N", help="vertices, for these two")
    parser.add_argument("--blender", default=runs.BLENDER, help=f"default {runs.BLENDER}")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures to this file")
    parser.add_argument("--keep", action="store_true", help=f"put the tables, or that of {KEPT}, into the documents")
    options = parser.parse_args()
    given = {path.name: generated.read(path) for path in options.files}
    tables: list[Table] = []
    kept: Any
    if options.reach or options.follow:
        scenes = [generated.Scene(round(n**0.5), is_triangulated=True) for n in options.sizes]
        models = given or {str(scene.n_vertices): scene.meshes()[0] for scene in scenes}
        kept = []
        print("Seconds / seconds of the processor.")
        tables.append(_follow_table() if options.follow else _reach_table())
        for mesh in models.values():
            if options.follow:
                kept.append(runs.run("working_maps", "follow", {}, [mesh]))
                _add_follow(tables[0], kept[-1])
                continue
            row = runs.run("working_maps", "reach", {}, [mesh], options.blender)
            for name, is_relaxed in (("solve", False), ("relax", True)):
                row[name] = runs.run("working_maps", "memory", {"is_relaxed": is_relaxed}, [mesh])["megabytes"]
            kept.append(row)
            _add_reach(tables[0], row)
    else:
        models = given or _models(options.vertices)
        kept = {}
        for name, mesh in models.items():
            kept[name] = runs.run("working_maps", "methods", {}, [mesh], options.blender)
            table = _methods_table(name, kept[name])
            tables += [table] if name == KEPT else []
    if options.follow:
        rows = [runs.run("working_maps", "constrained", {}, [mesh]) for mesh in models.values()]
        tables.append(_constrained_table(rows))
        kept += rows
    if options.json:
        options.json.write_text(json.dumps(kept, indent=1) + "\n")
    if options.keep:
        documents.keep(*tables)


if __name__ == "__main__":
    runs.answer(methods, reach, follow, constrained, memory) if runs.is_measuring() else main()
