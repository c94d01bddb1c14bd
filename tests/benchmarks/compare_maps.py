"""The operator's maps compared with those of Blender's methods, island by island, on models with seams.

    build/venv/bin/python -m tests.benchmarks.compare_maps [FILE or FOLDER ...] [--json OUT.json] [--only NAME]
    build/venv/bin/python -m tests.benchmarks.compare_maps --blends [--keep]

Without arguments, runs on the models of models.py. Otherwise runs on the given files, and on all files in the given
folders, that Blender can read and that have UV maps. The borders of their islands become seams, and "own" is their
existing map. Each method unwraps a copy of the same mesh in one call of the operator with default settings. Islands are
measured in Blender's single precision, and all methods split quads in the same way.

Only islands that have a map (triangulated manifolds of genus 0 with a boundary) and more than eight triangles are
compared. A map is "at least as good" if its mean QC, or its spread of sizes, exceeds the lower one of CONFORMAL and
ANGLE_BASED by at most a relative 1e-4. Single precision and the choice of splits can cause such a difference.

The second form runs the models at several settings of *Angle to Area*, and prints one table of their means.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from tests.benchmarks import models  # first: it imports bpy

import addon_utils  # isort: skip
import bpy  # isort: skip
import numpy as np
import spectral_conformal as sc

from tests.benchmarks import documents
from tests.blender import blenders
from tests.module import meshes

OWN = "own"
SPECTRAL = "spectral"
PEERS = ("CONFORMAL", "ANGLE_BASED", "MINIMUM_STRETCH")
CONFORMAL_PEERS = PEERS[:2]
TOLERANCE = 1e-4
# Of log2 of the scale of a flat island: Blender rounds UVs to 6e-8, a hundred-thousandth of an edge of 0.006.
NEGLIGIBLE_DEVIATION = 1e-5
# Of *Angle to Area*, for `--blends`.
BLENDS = (0.0, 0.3, 0.5, 1.0)


@dataclass
class Record:
    """One island under one method; without a map, QC and the others are not a number."""

    model: str
    island: int
    triangles: int
    method: str
    mean_qc: float
    max_qc: float
    scale_deviation: float
    flipped: int
    overlapping: int
    seconds: float  # of the whole model

    @property
    def is_mapped(self) -> bool:
        """Whether there is a map."""
        return np.isfinite(self.mean_qc)


def methods() -> list[str]:
    """Return what this Blender can do."""
    offered = bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items.keys()
    return [SPECTRAL, *(method for method in PEERS if method in offered)]


def unwrapped(item: bpy.types.Object, method: str, settings: dict[str, object]) -> tuple[np.ndarray, float]:
    """Unwrap a copy of an object; return the UVs of its loops, all zero where an island failed, and the seconds."""
    copy = item.copy()
    copy.data = item.data.copy()
    while copy.data.uv_layers:
        copy.data.uv_layers.remove(copy.data.uv_layers[0])
    copy.data.uv_layers.new(name="UVMap", do_init=False)
    bpy.context.scene.collection.objects.link(copy)
    for other in bpy.context.selected_objects:
        other.select_set(False)
    bpy.context.view_layer.objects.active = copy
    copy.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    begin = time.perf_counter()
    if method == SPECTRAL:
        bpy.ops.uv.spectral_unwrap(**settings)
    else:
        bpy.ops.uv.unwrap(method=method)
    seconds = time.perf_counter() - begin
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = models.uv_of(copy.data)
    mesh = copy.data
    bpy.data.objects.remove(copy)
    bpy.data.meshes.remove(mesh)
    return uv, seconds


def measure(
    name: str, mesh: bpy.types.Mesh, found: models.Islands, uv: np.ndarray, method: str, seconds: float
) -> Iterator[Record]:
    """Measure all islands under one map."""
    offsets = np.append(models.array(mesh.polygons, "loop_start", np.int32), len(mesh.loops)).astype(np.int32)
    corners = models.array(mesh.loops, "vertex_index", np.int32)
    position = uv[found.corner]
    for i, (triangles, faces) in enumerate(zip(found.triangles, found.faces, strict=True)):
        used, local = np.unique(triangles, return_inverse=True)
        local = local.reshape(triangles.shape)
        image = position[used]
        a, b, c = (image[local[:, k]] for k in range(3))
        side, other = b - a, c - a
        area = 0.5 * (side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0]).sum()
        empty = Record(name, i, len(triangles), method, *[float("nan")] * 3, 0, 0, seconds)
        if area == 0:
            yield empty
            continue
        if area < 0:
            image = image * [-1, 1]
        distortion = sc.distortion(found.positions[used], local, image)
        selected = np.zeros(len(mesh.polygons), dtype=bool)
        selected[faces] = True
        defects = meshes.defects(offsets, corners, uv, selected_faces=selected)
        yield Record(
            name,
            i,
            len(triangles),
            method,
            float(distortion.mean_qc),
            float(distortion.max_qc),
            float(distortion.log2_scale_deviation),
            int(defects.flipped.sum()),
            int(defects.overlapping.sum()),
            seconds,
        )


def compare(name: str, item: bpy.types.Object, settings: dict[str, object], chosen: list[str]) -> list[Record]:
    """Return the records of one model, of the chosen methods."""
    found = models.islands(item.data)
    if not found.faces:
        return []
    records = []
    if item.data.uv_layers:
        records += measure(name, item.data, found, models.uv_of(item.data), OWN, float("nan"))
    for method in chosen:
        uv, seconds = unwrapped(item, method, settings)
        records += measure(name, item.data, found, uv, method, seconds)
    return records


def row(name: str, records: list[Record], method: str) -> str:
    """Return one line of a table: a method over some islands."""
    own = [record for record in records if record.method == method]
    mapped = [record for record in own if record.is_mapped]
    if not mapped:
        return f"{name:24}{method:>16}{len(own):>8}  no map"
    qc = np.array([record.mean_qc for record in mapped])
    seconds = sum({record.model: record.seconds for record in own}.values())
    return (
        f"{name:24}{method:>16}{len(own):>8}{len(own) - len(mapped):>8}{qc.mean():>10.4f}{qc.max():>10.3g}"
        f"{sum(record.flipped > 0 for record in mapped):>9}{sum(record.overlapping > 0 for record in mapped):>9}"
        f"{np.mean([record.scale_deviation for record in mapped]):>9.3f}{seconds:>9.2f}"
    )


HEADER = (
    f"{'':24}{'method':>16}{'islands':>8}{'no map':>8}{'mean QC':>10}{'worst':>10}{'flipped':>9}{'overlap':>9}"
    f"{'spread':>9}{'seconds':>9}"
)


def by_island(records: list[Record], method: str, measure: str) -> dict[tuple[str, int], float]:
    """Return a measure of every island under one method."""
    return {(each.model, each.island): getattr(each, measure) for each in records if each.method == method}


def shares(records: list[Record]) -> str:
    """Say on how many islands spectral is at least as good as the better conformal method, and where it is worse."""
    better = {}
    for measure, negligible in (("mean_qc", 0.0), ("scale_deviation", NEGLIGIBLE_DEVIATION)):
        spectral = by_island(records, SPECTRAL, measure)
        peers = [by_island(records, method, measure) for method in CONFORMAL_PEERS]
        best = {key: np.nanmin([peer[key] for peer in peers]) for key in spectral}
        better[measure] = {key: spectral[key] <= best[key] * (1 + TOLERANCE) + negligible for key in spectral}
        if measure == "mean_qc":
            worse = [(spectral[key] / best[key], key) for key in spectral if spectral[key] > 1.01 * best[key]]
            values = spectral
    counted = {
        "mean QC": better["mean_qc"].values(),
        "spread": better["scale_deviation"].values(),
        "both": [better["mean_qc"][key] and better["scale_deviation"][key] for key in values],
    }
    text = f"at least as good as the better of {' and '.join(CONFORMAL_PEERS)}, of {len(values)} islands: "
    text += ", ".join(f"{name} {100 * sum(flags) / max(len(values), 1):.1f} %" for name, flags in counted.items())
    text += f"; mean QC worse by more than 1 %: {len(worse)}"
    for ratio, (model, island) in sorted(worse, reverse=True)[:20]:
        text += f"\n  {model}, island {island}: {values[model, island]:.4f}, {ratio:.3f} times the better one"
    return text


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--methods", nargs="+", help=f"some of {SPECTRAL}, {', '.join(PEERS)}; all when left out")
    parser.add_argument("--only", help="names of models that contain this")
    parser.add_argument("--largest", type=int, default=200_000, help="faces; larger models are left out")
    parser.add_argument("--set", nargs="*", default=[], metavar="NAME=VALUE", help="settings of the operator, as JSON")
    parser.add_argument("--inside", action="store_true", help="of a profile that has the add-on; used by this command")
    parser.add_argument("--blends", action="store_true", help="compare settings of *Angle to Area*")
    parser.add_argument("--keep", action="store_true", help="put the table of --blends into the documents")
    options = parser.parse_args()
    if options.blends:
        compare_blends([*map(str, options.paths), *(["--only", options.only] if options.only else [])], options.keep)
        return
    if not options.inside:
        run_inside(sys.argv[1:])
        return
    settings = {name: json.loads(value) for name, value in (word.split("=", 1) for word in options.set)}
    records: list[Record] = []
    print(HEADER)
    for name, item in items(options.paths):
        if (options.only and options.only not in name) or len(item.data.polygons) > options.largest:
            continue
        addon_utils.enable("spectral_unwrap")  # a new file forgets it
        of_model = compare(name, item, settings, options.methods or methods())
        records += of_model
        for method in dict.fromkeys(record.method for record in of_model):
            print(row(name[-24:], of_model, method), flush=True)
        if options.json:
            options.json.write_text(json.dumps([asdict(record) for record in records], indent=1))
    print()
    for method in dict.fromkeys(record.method for record in records):
        print(row("all", records, method))
    if not options.methods or {SPECTRAL, *CONFORMAL_PEERS} <= set(options.methods):
        print(shares(records))


def compare_blends(chosen: list[str], is_kept: bool) -> None:
    """Print the mean spread of the sizes and the mean of the mean QC over all islands, by the setting."""
    columns: dict[str, list[dict]] = {}
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "records.json"
        for blend in BLENDS:
            run_inside([*chosen, "--json", str(result), "--methods", SPECTRAL, "--set", f"area_blend={blend}"])
            columns[f"{blend:g}"] = json.loads(result.read_text())
        run_inside([*chosen, "--json", str(result), "--methods", "MINIMUM_STRETCH"])
        columns["Blender's Minimum Stretch"] = json.loads(result.read_text())
    own = {name: [row for row in rows if row["method"] != OWN] for name, rows in columns.items()}
    table = documents.Table("angle-to-area", (f"{len(own['0'])} islands", *own), documents.OPERATOR)
    for title, key in (("spread", "scale_deviation"), ("mean QC", "mean_qc")):
        table.row(title, *(f"{np.nanmean([row[key] for row in rows]):.3f}" for rows in own.values()))
    if is_kept:
        documents.keep(table)


def run_inside(arguments: list[str]) -> None:
    """Run this command again in a profile of its own, in which the add-on is installed."""
    with tempfile.TemporaryDirectory() as folder:
        this = blenders.Blender("bpy", sys.executable)
        command = this.command("-m", "tests.benchmarks.compare_maps", "--inside", *arguments)
        subprocess.run(command, env=this.make_profile(Path(folder)), check=True)


def items(paths: list[Path]) -> Iterator[tuple[str, bpy.types.Object]]:
    """Return the models: generated ones, or those of files and folders."""
    if not paths:
        yield from models.generated()
        return
    for path in paths:
        files = sorted(file for file in path.rglob("*") if file.is_file()) if path.is_dir() else [path]
        for file in files:
            if file.suffix.lower() not in models.IMPORTERS:
                continue
            try:
                found = models.read(file)
            except RuntimeError as problem:  # what Blender raises for files that it cannot read
                print(f"{file.name} cannot be read: {problem}")
                continue
            for item in found:
                yield f"{file.stem}: {item.name}", item


if __name__ == "__main__":
    main()
