"""Record the installed module's results for many meshes and options, and compare two recordings.

    build/venv/bin/python -m tests.benchmarks.record_maps record FILE.npz [--quick]
    build/venv/bin/python -m tests.benchmarks.record_maps compare BEFORE.npz AFTER.npz [--messages]

Run it from the project's folder; PYTHONPATH may name another build of the module. The meshes are those of
tests/module/meshes.py and, if present, the shared ones beside the project. A recording takes about ten minutes on one
core; with --quick (meshes of up to 1,200 vertices), less than one.

A case is named `mesh/function/options`. The tolerance is 1e-12: relative to the extent of the island for maps, absolute
for residuals, which are rounding errors themselves, and relative for other floating-point values. Everything else must
be equal. Lists what only one recording has; `--messages` adds the messages that differ. `compare` returns 1 if a number
differs.
"""

from __future__ import annotations

import os

# The order of summation, and with it the last digits, depends on the number of threads of the BLAS.
os.environ.update(OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")

import argparse  # noqa: E402
import dataclasses  # noqa: E402
import hashlib  # noqa: E402
import numbers  # noqa: E402
import sys  # noqa: E402
import time  # noqa: E402
import zipfile  # noqa: E402
from collections import Counter  # noqa: E402
from collections.abc import Callable, Iterable, Iterator, Sequence  # noqa: E402
from pathlib import Path  # noqa: E402

import numpy as np  # noqa: E402

from tests.module import meshes  # noqa: E402

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes"
TOLERANCE = 1e-12
QUICK_LIMIT = 1200  # vertices
# Vertices up to which an option is recorded, chosen for a recording of about ten minutes; those without are for all.
COSTLY_LIMIT = 9000
SEAMS_LIMIT = {False: 1300, True: 250}
SLOW = 5.0  # seconds, above which a case is printed
RESIDUALS = {"residual"}
NOT_COMPARED = {"timings", "steps"}  # the message has the steps
MESSAGES = {"message", "error_text"}


def extent(points: np.ndarray) -> float:
    """Return the longest side of the box around points."""
    return float(np.ptp(points, axis=0).max()) if len(points) else 0.0


@dataclasses.dataclass
class Mesh:
    """A polygon mesh with pins, seams and a selection that follow from its geometry alone."""

    name: str
    vertices: np.ndarray
    offsets: np.ndarray
    corners: np.ndarray

    def __post_init__(self) -> None:
        """Choose pins, seams and a selection."""
        used = np.unique(self.corners)
        finite = np.where(np.isfinite(self.vertices), self.vertices, 0.0)
        spread = [extent(finite[used, k : k + 1]) for k in range(3)]
        first, second = np.argsort(np.negative(spread), kind="stable")[:2]
        # A plane image of the mesh, stretched, so that pins and extenders have something to do.
        self.image = np.c_[1.2 * finite[:, first], finite[:, second]]
        self.handles = used[(np.array([0, 1 / 3, 1 / 2, 2 / 3]) * len(used)).astype(int)].tolist() if len(used) else []
        sizes = np.diff(self.offsets)
        face_of_corner = np.repeat(np.arange(len(sizes)), sizes)
        height = finite[self.corners, first]
        mean = np.bincount(face_of_corner, height, len(sizes)) / np.maximum(sizes, 1)
        order = np.argsort(np.argsort(mean, kind="stable"), kind="stable")
        self.selected = order < 0.6 * len(sizes)
        self.seams = self._edges_between(order < 0.5 * len(sizes), face_of_corner)
        self.triangles = self.corners.reshape(-1, 3) if len(sizes) and (sizes == 3).all() else None

        # Of the many corners at a vertex two are enough, the first and the last, which lie on both sides of most seams.
        first_use = np.unique(self.corners, return_index=True)[1]
        last_use = len(self.corners) - 1 - np.unique(self.corners[::-1], return_index=True)[1]
        self.recorded_corners = np.union1d(first_use, last_use)

    def _edges_between(self, side: np.ndarray, face_of_corner: np.ndarray) -> np.ndarray:
        """Return the edges between faces of different sides."""
        following = np.arange(len(self.corners)) + 1
        has_corners = np.diff(self.offsets) > 0
        following[self.offsets[1:][has_corners] - 1] = self.offsets[:-1][has_corners]
        edges = np.sort(np.c_[self.corners, self.corners[following]], axis=1)
        keys = edges[:, 0] * np.int64(len(self.vertices)) + edges[:, 1]
        unique, inverse = np.unique(keys, return_inverse=True)
        on_side = np.bincount(inverse, side[face_of_corner], len(unique))
        uses = np.bincount(inverse, minlength=len(unique))
        between = unique[(on_side > 0) & (on_side < uses)]
        return np.c_[between // len(self.vertices), between % len(self.vertices)].astype(np.int64)

    def digest(self) -> str:
        """Identify the mesh."""
        parts = (self.vertices, self.offsets.astype(np.int64), self.corners.astype(np.int64))
        return hashlib.sha256(b"".join(np.ascontiguousarray(part).tobytes() for part in parts)).hexdigest()[:16]

    @property
    def polygons(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The first three arguments of `unwrap`."""
        return self.vertices, self.offsets, self.corners

    @property
    def pins(self) -> dict[int, tuple[float, float]]:
        """Four vertices and their positions in the plane image."""
        return {vertex: tuple(self.image[vertex].tolist()) for vertex in self.handles}

    @property
    def extenders(self) -> list[tuple[int, int, float]]:
        """Two pairs of different vertices, where there are such."""
        if len(set(self.handles)) < 4:
            return []
        a, b, c, d = self.handles
        return [(a, c, 0.5), (b, d, 2.0)]

    def pinned_corners(self, vertices: Iterable[int], torn: float = 0.0) -> dict[str, np.ndarray]:
        """Pin all corners of some vertices; `torn` moves every other corner's pin away."""
        uv = self.image[self.corners]
        uv[::2, 0] += torn * extent(uv)
        return {"fixed": np.isin(self.corners, list(vertices)), "uv": uv}

    def noisy(self, uv: np.ndarray) -> np.ndarray:
        """Return a map with folds."""
        size = extent(uv) / max(np.sqrt(len(uv)), 1.0)
        return uv + 0.5 * size * np.random.default_rng(5).normal(size=uv.shape)


def generated() -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield the meshes that are made here."""
    yield "random_disk", *meshes.random_disk(1000)
    yield "random_disk_holes", *meshes.random_disk(1100, 7)
    yield "bumpy_disk", *meshes.bumpy_disk(1000)
    yield "bumpy_disk_holes", *meshes.bumpy_disk(1100, 3)
    yield "bumpy_disk_10k", *meshes.bumpy_disk(8900, 5)
    yield "saddle_quads", *meshes.saddle_quads(31)
    yield "bulge", *meshes.bulge(31, 1.5)
    yield "torn_hat", *meshes.torn_hat()
    yield "spiral_ramp", *meshes.spiral_ramp(1.25)
    yield "spiral_ramp_2", *meshes.spiral_ramp(2.3)
    yield "finger", *meshes.finger(16, 40)
    yield "long_finger", *meshes.finger(16, 120)
    for offset in (-0.5, -2.0, -5.0):
        yield f"floater_{offset:g}", *meshes.floater(offset)
    yield "rough_grid", *meshes.rough_grid(20, 2.0, 3)
    yield "rough_grid_dropped", *meshes.rough_grid(30, 1.0, 4, 0.05)
    yield "rough_grid_60", *meshes.rough_grid(60, 2.0, 3)


def all_meshes(quick: bool) -> Iterator[Mesh]:
    """Yield the generated meshes and the shared ones, the same in every recording."""
    for name, vertices, faces in generated():
        if not quick or len(vertices) <= QUICK_LIMIT:
            yield Mesh(name, vertices, *meshes.polygons(faces))
    for path in sorted([*(SHARED / "hard").glob("*.obj"), *(SHARED / "real").glob("*.obj")]):
        # A line of a vertex has more than 20 characters: do not read what is too large.
        if quick and path.stat().st_size > 100 * QUICK_LIMIT:
            continue
        vertices, faces = meshes.read_obj(path)
        if not quick or len(vertices) <= QUICK_LIMIT:
            offsets, corners = meshes.polygons(faces) if faces else (np.zeros(1, np.int64), np.zeros(0, np.int64))
            yield Mesh(f"{path.parent.name}:{path.stem}", vertices, offsets, corners)


def option_sets(mesh: Mesh) -> Iterator[tuple[str, dict, float]]:
    """Yield the options that `parameterize` and `unwrap` share: name, arguments, limit of the vertices."""
    everywhere = {
        "default": {},
        "inverse_area": {"weights": "inverse_area"},
        "vertex": {"boundary": "vertex"},
        "inverse_area_vertex": {"weights": "inverse_area", "boundary": "vertex"},
        "fill_holes": {"fill_holes": True},
        "lscm": {"method": "lscm"},
        "lscm_pins": {"method": "lscm", "pins": mesh.pins},
        "lscm_one_pin": {"method": "lscm", "pins": dict(list(mesh.pins.items())[:1])},
        "soft_pins": {"pins": mesh.pins, "soft_pins": 10.0},
        "extenders": {"extenders": mesh.extenders},
        "hole_rigidity": {"hole_rigidity": 1.0},
    }
    costly = {
        "fiedler": {"method": "fiedler"},
        "area": {"method": "area"},
        "eigen": {"factorization": "eigen"},
        "eigen_extenders": {"factorization": "eigen", "extenders": mesh.extenders},
        "eigen_lscm_pins": {"factorization": "eigen", "method": "lscm", "pins": mesh.pins},
        "tolerance": {"tolerance": 1e-12},
        "area_blend": {"area_blend": 0.5},
        "area_blend_1": {"area_blend": 1.0, "weights": "inverse_area"},
        "fold_free": {"fold_free": True},
        "fold_free_vertex": {"fold_free": True, "boundary": "vertex", "weights": "inverse_area"},
        "fold_free_lscm_pins": {"fold_free": True, "method": "lscm", "pins": mesh.pins},
        "fold_free_soft_pins": {"fold_free": True, "pins": mesh.pins, "soft_pins": 10.0},
        "fold_free_fill_holes": {"fold_free": True, "fill_holes": True},
        "fold_free_area_blend": {"fold_free": True, "area_blend": 0.5},
        "everything": {
            "weights": "inverse_area",
            "boundary": "vertex",
            "fill_holes": True,
            "area_blend": 0.3,
            "fold_free": True,
            "pins": mesh.pins,
            "soft_pins": 1.0,
            "extenders": mesh.extenders,
            "hole_rigidity": 2.0,
        },
        "strong_soft_pins": {"pins": mesh.pins, "soft_pins": 1000.0, "hole_rigidity": 10.0},
        "attraction": {"extenders": [(a, b, -0.02 * strength) for a, b, strength in mesh.extenders]},
        "spectral_pins": {"pins": mesh.pins},
        "fiedler_inverse_area": {"method": "fiedler", "weights": "inverse_area"},
        "area_vertex": {"method": "area", "boundary": "vertex"},
    }
    for name, options in everywhere.items():
        yield name, options, np.inf
    for name, options in costly.items():
        yield name, options, COSTLY_LIMIT


def cases(mesh: Mesh, sc, quick: bool) -> Iterator[tuple[str, Callable[[], object]]]:
    """Yield the name `function/options` of every case of a mesh, and what computes it."""
    size = len(mesh.vertices)
    metric = np.eye(3) + 0.5 * np.ones((3, 3)) / 3
    metrics = np.tile(metric, (len(mesh.offsets) - 1, 1, 1))
    for name, options, limit in option_sets(mesh):
        if size <= limit:
            yield f"unwrap/{name}", lambda options=options: unwrapped(mesh, sc, **options)
            if mesh.triangles is not None:
                yield (
                    f"parameterize/{name}",
                    lambda options=options: sc.parameterize(
                        mesh.vertices, mesh.triangles, **{"fallbacks": True, **options}
                    ),
                )
    only_unwrap = {
        "seams": {"seam_edges": mesh.seams},
        "selection": {"selected_faces": mesh.selected},
        "metric": {"metric": metrics},
        "pinned_corners": mesh.pinned_corners(mesh.handles),
        "one_pinned_corner": mesh.pinned_corners(mesh.handles[:1]),
    }
    only_unwrap_costly = {
        "torn_pins": mesh.pinned_corners(mesh.handles, torn=0.5),
        "soft_pinned_corners": {**mesh.pinned_corners(mesh.handles), "soft_pins": 10.0},
        "seams_fold_free": {"seam_edges": mesh.seams, "fold_free": True},
        "seams_extenders": {"seam_edges": mesh.seams, "extenders": mesh.extenders, "hole_rigidity": 1.0},
        "fold_free_pinned_corners": {**mesh.pinned_corners(mesh.handles), "fold_free": True},
        "selection_seams_pins": {
            **mesh.pinned_corners(mesh.handles[:2]),
            "seam_edges": mesh.seams,
            "selected_faces": mesh.selected,
            "area_blend": 0.5,
        },
    }
    for name, options in {**only_unwrap, **(only_unwrap_costly if size <= COSTLY_LIMIT else {})}.items():
        yield f"unwrap/{name}", lambda options=options: unwrapped(mesh, sc, **options)
    if size <= COSTLY_LIMIT:
        yield "Unwrapper/second_solves", lambda: second_unwraps(mesh, sc)
        yield "map_defects/of_unwrap", lambda: defects(mesh, sc)
        yield "map_defects/of_image", lambda: defects(mesh, sc, mesh.image[mesh.corners])
    # Rough surfaces want hundreds of cuts.
    if size <= SEAMS_LIMIT[quick] and not mesh.name.startswith("rough"):
        yield "suggest_cuts/default", lambda: sc.suggest_cuts(*mesh.polygons)
        yield (
            "suggest_cuts/limits",
            lambda: sc.suggest_cuts(
                *mesh.polygons,
                selected_faces=mesh.selected,
                scale_limit=1.3,
                qc_limit=1.01,
                max_length=3.0 * extent(mesh.image),
                weights="inverse_area",
                boundary="vertex",
            ),
        )
        yield "suggest_seams/seams", lambda: sc.suggest_seams(*mesh.polygons, seam_edges=mesh.seams).seam_edges
    if mesh.triangles is not None:
        yield "distortion/of_parameterize", lambda: measured(mesh, sc)
        if size <= COSTLY_LIMIT:
            yield "Solver/second_solves", lambda: second_solves(mesh, sc)
            yield "parameterize/metric", lambda: quasi_conformal(mesh, sc)


def unwrapped(mesh: Mesh, sc, uv: np.ndarray | None = None, **options: object) -> object:
    return sc.unwrap(meshes.mesh(*mesh.polygons, uv=uv), **options)


def measured(mesh: Mesh, sc) -> tuple[object, ...]:
    uv = sc.parameterize(mesh.vertices, mesh.triangles, fallbacks=True).uv
    return tuple(sc.distortion(mesh.vertices, mesh.triangles, image) for image in (uv, mesh.noisy(uv)))


def defects(mesh: Mesh, sc, uv: np.ndarray | None = None) -> tuple[object, ...]:
    if uv is None:
        uv = sc.unwrap(*mesh.polygons, seam_edges=mesh.seams).uv
    return tuple(
        meshes.defects(mesh.offsets, mesh.corners, image, selected_faces=selected, between_islands=between)
        for image in (uv, mesh.noisy(uv))
        for selected, between in ((None, False), (None, True), (mesh.selected, True))
    )


def second_solves(mesh: Mesh, sc) -> tuple[object, ...]:
    solver = sc.Solver(mesh.vertices, mesh.triangles, fallbacks=True)
    pairs = mesh.extenders
    return (
        solver.solve(),
        solver.solve(extenders=pairs),
        solver.solve(extenders=[(a, b, 1.05 * strength) for a, b, strength in pairs], hole_rigidity=0.1),
        solver.solve(method="lscm", pins=mesh.pins),
        solver.solve(pins=mesh.pins, soft_pins=5.0),
        solver.solve(tolerance=1e-10),
        solver.solve(method="area"),
    )


def second_unwraps(mesh: Mesh, sc) -> tuple[object, ...]:
    unwrapper = sc.Unwrapper(*mesh.polygons, seam_edges=mesh.seams)
    pairs = mesh.extenders
    return (
        unwrapper.solve(),
        unwrapper.solve(extenders=pairs),
        unwrapper.solve(extenders=[(a, b, 1.05 * strength) for a, b, strength in pairs], hole_rigidity=0.1),
    )


def quasi_conformal(mesh: Mesh, sc) -> tuple[object, ...]:
    metric = sc.metric_from_direction(mesh.vertices, mesh.triangles, [1.0, 2.0, 3.0], 1.5)
    half = sc.blend_metric(metric, 0.5)
    solution = sc.parameterize(mesh.vertices, mesh.triangles, metric=half, fallbacks=True)
    return metric, half, solution, sc.metric_from_uv(mesh.vertices, mesh.triangles, solution.uv)


def flattened(value: object, name: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """Yield the fields of a result as arrays: of a list of equal dataclasses field by field, ragged arrays joined."""
    if dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            if field.name not in NOT_COMPARED:
                yield from flattened(getattr(value, field.name), f"{name}.{field.name}" if name else field.name)
        if isinstance(getattr(type(value), "message", None), property):
            yield f"{name}.message" if name else "message", np.array(value.message)
    elif isinstance(value, np.ndarray):
        yield name, value
    elif isinstance(value, (bool, str, numbers.Number)):
        yield name, np.array(value)
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from flattened(entry, f"{name}[{key}]")
    elif isinstance(value, Sequence):
        columns: dict[str, list[np.ndarray]] = {}
        for entry in value:
            for key, array in flattened(entry):
                columns.setdefault(key, []).append(array)
        yield f"{name}.length", np.array(len(value))
        for key, arrays in columns.items():
            arrays = [np.atleast_1d(array) for array in arrays]
            yield f"{name}.{key}.lengths", np.array([len(array) for array in arrays])
            yield f"{name}.{key}", np.concatenate(arrays)
    else:
        yield name, np.array(repr(value))


def answer(compute: Callable[[], object], mesh: Mesh) -> dict[str, np.ndarray]:
    """Return the fields of a case's result, or the type and text of its exception."""
    try:
        result = compute()
    except Exception as error:  # noqa: BLE001 - what is raised is part of what is recorded
        return {"error": np.array(type(error).__name__), "error_text": np.array(str(error))}
    fields = {}
    # Results that come several at once are told apart, so that each map has its own size.
    several = isinstance(result, tuple)
    for index, entry in enumerate(result if several else [result]):
        prefix = f"{index}:" if several else ""
        fields.update({f"{prefix}{name or 'value'}": array for name, array in flattened(entry)})
        charts = getattr(entry, "chart_of_face", None)
        if charts is not None:
            fields[f"{prefix}uv"] = entry.uv[mesh.recorded_corners]
            fields[f"{prefix}chart_of_corner"] = np.repeat(charts, np.diff(mesh.offsets))[mesh.recorded_corners]
    return fields


def record(path: Path, quick: bool) -> None:
    """Write a recording."""
    import spectral_conformal as sc

    print(f"{sc.__file__}: {sc.build_info()}")
    recording: dict[str, np.ndarray] = {}
    seconds: Counter[str] = Counter()
    begin = time.perf_counter()
    for mesh in all_meshes(quick):
        recording[f"{mesh.name}||digest"] = np.array(mesh.digest())
        before = time.perf_counter()
        for name, compute in cases(mesh, sc, quick):
            start = time.perf_counter()
            for field, array in answer(compute, mesh).items():
                recording[f"{mesh.name}|{name}|{field}"] = array
            elapsed = time.perf_counter() - start
            seconds[name] += elapsed
            if elapsed > SLOW:
                print(f"    {name} {elapsed:.1f} s")
        print(f"{mesh.name:36}{len(mesh.vertices):>8} vertices {time.perf_counter() - before:8.1f} s", flush=True)
    with path.open("wb") as file:
        np.savez(file, **{key.replace("/", "\\"): array for key, array in recording.items()})
    print("most of the time: " + ", ".join(f"{name} {value:.0f} s" for name, value in seconds.most_common(12)))
    print(f"{len({key.rpartition('|')[0] for key in recording})} cases, {time.perf_counter() - begin:.0f} s: {path}")


class Recording:
    """A recording, read case by case; NumPy's own reader looks up every name in a list of all."""

    def __init__(self, path: Path) -> None:
        """Read the names of all fields."""
        self.file = zipfile.ZipFile(path)
        self.names: dict[str, dict[str, str]] = {}
        self.checksums: dict[str, dict[str, tuple[int, int]]] = {}
        for info in self.file.infolist():
            entry = info.filename
            mesh, case, field = entry[: -len(".npy")].replace("\\", "/").split("|")
            name = f"{mesh}/{case}" if case else mesh
            self.names.setdefault(name, {})[field] = entry
            self.checksums.setdefault(name, {})[field] = (info.CRC, info.file_size)

    def __getitem__(self, case: str) -> dict[str, np.ndarray]:
        """Return the fields of a case."""
        return {field: self._array(entry) for field, entry in self.names[case].items()}

    def _array(self, entry: str) -> np.ndarray:
        with self.file.open(entry) as file:
            return np.lib.format.read_array(file)


def map_difference(before: np.ndarray, after: np.ndarray, charts: np.ndarray | None) -> float:
    """Return the greatest distance of two maps over the extent of its island."""
    if charts is None:
        charts = np.zeros(len(before), int)
    worst = 0.0
    for chart in np.unique(charts):
        a, b = before[charts == chart], after[charts == chart]
        distance = np.abs(a - b).max(initial=0.0)
        if distance > 0 or np.isnan(distance):
            worst = max(worst, distance / max(extent(a), np.finfo(float).tiny))
    return float(np.nan_to_num(worst, nan=np.inf))


def value_difference(before: np.ndarray, after: np.ndarray, floor: float) -> float:
    """Return the greatest difference of floating-point values relative to their size, or to the floor."""
    if before.size == 0:
        return 0.0
    same = (before == after) | (np.isnan(before) & np.isnan(after))
    with np.errstate(invalid="ignore", over="ignore"):
        ratio = np.abs(before - after) / np.maximum(np.maximum(np.abs(before), np.abs(after)), floor)
    return float(np.nan_to_num(np.where(same, 0.0, ratio), nan=np.inf).max())


def field_difference(name: str, before: dict[str, np.ndarray], after: dict[str, np.ndarray]) -> tuple[float, str]:
    """Return how much a field differs (0 where it does not) and a few words about it."""
    a, b = before[name], after[name]
    if a.shape != b.shape:
        return np.inf, f"shape {a.shape} -> {b.shape}"
    prefix, last = f"{name.rpartition(':')[0]}:" if ":" in name else "", name.rpartition(":")[2]
    if last == "uv" and a.dtype.kind == "f":
        size = map_difference(a, b, before.get(f"{prefix}chart_of_corner"))
        return (size, f"{size:.1e}") if size > TOLERANCE else (0.0, "")
    if a.dtype.kind == "f" and b.dtype.kind == "f":
        floor = 1.0 if last.rpartition(".")[2] in RESIDUALS else np.finfo(float).tiny
        size = value_difference(a, b, floor)
        words = f"{size:.1e}" if a.size != 1 else f"{size:.1e} ({a.flat[0]:.6g} -> {b.flat[0]:.6g})"
        return (size, words) if size > TOLERANCE else (0.0, "")
    if np.array_equal(a, b):
        return 0.0, ""
    if a.size == 1:
        return np.inf, f"{a.item()} -> {b.item()}"
    return np.inf, f"{np.count_nonzero(a != b)} of {a.size} differ"


def compare(first: Path, second: Path, with_messages: bool) -> int:
    """Print the differences between two recordings; return 1 if a number differs."""
    before, after = Recording(first), Recording(second)
    common = [name for name in before.names if name in after.names]
    changed, reworded, gone, new = [], Counter(), Counter(), Counter()
    worst = Counter()
    for case in common:
        if before.checksums[case] == after.checksums[case]:
            continue
        a, b = before[case], after[case]
        if ("error" in a) != ("error" in b):
            outcome = [str(fields["error"]) + ": " + str(fields["error_text"]) if "error" in fields else "a result"
                       for fields in (a, b)]  # fmt: skip
            print(f"{case}: {outcome[0]} -> {outcome[1]}")
            changed.append(case)
            continue
        gone.update(name.rpartition(":")[2] for name in a.keys() - b.keys())
        new.update(name.rpartition(":")[2] for name in b.keys() - a.keys())
        words = []
        for name in sorted(a.keys() & b.keys()):
            last = name.rpartition(":")[2].rpartition(".")[2]
            texts = [str(text) for text in (np.atleast_1d(fields[name]).tolist() for fields in (a, b))]
            is_length = name.endswith(".lengths") and name.rpartition(".")[0].rpartition(".")[2] in MESSAGES
            if last in MESSAGES or is_length:
                if texts[0] != texts[1]:
                    reworded[f"{texts[0]}\n    -> {texts[1]}"] += 1
                continue
            size, said = field_difference(name, a, b)
            if size:
                words.append(f"{name} {said}")
                worst[name.rpartition(":")[2]] = max(worst[name.rpartition(":")[2]], size)
        if words:
            print(f"{case}: {'; '.join(words)}")
            changed.append(case)
    if with_messages:
        for text, times in reworded.most_common():
            print(f"{times} x {text}")
    both = before.names.keys(), after.names.keys()
    for title, names in (("only before", both[0] - both[1]), ("only after", both[1] - both[0])):
        if names:
            print(f"cases {title}: {len(names)}, such as {', '.join(sorted(names)[:5])}")
    for title, fields in (("gone", gone), ("new", new)):
        if fields:
            print(f"fields {title}: " + ", ".join(f"{name} ({times} x)" for name, times in fields.items()))
    if worst:
        print("greatest difference by field: " + ", ".join(f"{name} {size:.1e}" for name, size in worst.most_common()))
    print(
        f"{len(common)} cases compared, {len(changed)} differ in numbers; "
        f"{sum(reworded.values())} messages reworded ({len(reworded)} different)"
    )
    return 1 if changed else 0


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("record")
    command.add_argument("file", type=Path)
    command.add_argument("--quick", action="store_true", help="small meshes only")
    command = commands.add_parser("compare")
    command.add_argument("before", type=Path)
    command.add_argument("after", type=Path)
    command.add_argument("--messages", action="store_true", help="print the messages that differ, too")
    options = parser.parse_args()
    if options.command == "compare":
        return compare(options.before, options.after, options.messages)
    record(options.file, options.quick)
    return 0


if __name__ == "__main__":
    sys.exit(main())
