# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested seams compared with those that artists gave the same models.

    build/venv/bin/python -m pip install pybullet          # its data has textured models
    apt-get download assimp-testmodels && dpkg -x assimp-testmodels*.deb build/models
    build/venv/bin/python -m tests.benchmarks.artists_seams [file or folder ...] [--keep]

Without arguments, runs on the models of both packages, if present. Uses only models whose UV map covers all faces and
has seams. Maps with seams around every few faces, such as projections and light maps, are skipped. Merges vertices at
the same position. Prints one line per model and method, then the means.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np
import spectral_conformal
from scipy.spatial import cKDTree
from spectral_conformal import assets
from spectral_conformal._measuring import next_corner
from spectral_conformal._straightening import border_edges, is_along_axis
from spectral_conformal.assets import welding

from tests.benchmarks import documents, map_measures

SHARP = np.radians(35)
FLAT = np.radians(1)
NEAR = 0.005
"""Of a model's size (the bounding box's diagonal): seams this close are one to an artist."""
MIN_FACES, MAX_FACES = 60, 60_000


@dataclass(frozen=True)
class SeamMeasures:
    """Of the seams of one model; shares are of their length.

    Attributes:
        flat: on edges whose faces are within a degree of one plane.
        sharp: on edges of 35 degrees and more.
        found: within half a percent of the size of an artist's seam.
        kept: `found`, or sharp.
        covered: share of the artist's length that has a suggested seam within the same distance.
        length: over the root of the area.
        islands: of the map.
        loops: of the regular vertices (four quads) that a seam passes, those where it goes straight on along its edge
            loop; NaN without any.
        bends: of the vertices that a seam passes, those where it turns by more than 30 degrees.
        aligned: of the length of the islands' borders in the map, within 2 degrees of an axis of the texture, with
            borders straightened; of the artist's seams, too, since the artist's own map is not ours.
        worst: the largest quasi-conformal distortion of the map.
    """

    flat: float
    sharp: float
    found: float
    kept: float
    covered: float
    length: float
    islands: float
    loops: float
    bends: float
    aligned: float
    worst: float


@dataclass(frozen=True)
class Model:
    """A polygon mesh (vertices, face_offsets, corner_vertices), its artist's seams (S, 2), and borders of materials."""

    name: str
    vertices: np.ndarray
    offsets: np.ndarray
    corners: np.ndarray
    seams: np.ndarray
    borders: np.ndarray


def models(paths: list[Path]) -> Iterator[Model]:
    """Read the models that count, each mesh of a file by itself."""
    seen = set()
    for path in paths:
        try:
            meshes = assets.read(path).meshes
        except (assets.AssetError, OSError):
            continue
        for number, mesh in enumerate(meshes):
            model = _model(f"{path.parent.name}/{path.stem}" + (f" {number}" if len(meshes) > 1 else ""), mesh)
            if model is not None and (key := (len(model.vertices), len(model.offsets), len(model.seams))) not in seen:
                seen.add(key)
                yield model


def _model(name: str, mesh: assets.AssetMesh) -> Model | None:
    offsets, n_faces = mesh.face_offsets, len(mesh.face_offsets) - 1
    if mesh.corner_uv is None or not MIN_FACES <= n_faces <= MAX_FACES or not mesh.has_uv().all():
        return None
    vertex_of = welding.coincident_vertices(mesh.vertices, offsets, mesh.corner_vertices, 1e-6)
    corners = vertex_of[mesh.corner_vertices]
    island, seams = map_measures.islands_and_seams(offsets, corners, mesh.corner_uv)
    edges = np.unique(welding.face_edges(offsets, corners), axis=0)
    islands = int(island.max()) + 1
    if (
        len(seams) == 0
        or len(seams) > len(edges) / 3
        or islands > n_faces / 4
        or np.ptp(mesh.corner_uv, axis=0).min() <= 0
    ):
        return None
    borders = welding.borders_between(mesh, vertex_of, mesh.material_of_face)
    return Model(name, mesh.vertices, offsets, corners, seams, borders)


def _face_areas(model: Model) -> np.ndarray:
    """Return the vector area of every face, (faces, 3)."""
    first = model.offsets[:-1]
    at = model.vertices[model.corners]
    out = at - at[first].repeat(np.diff(model.offsets), axis=0)
    return 0.5 * np.add.reduceat(np.cross(out, out[next_corner(model.offsets)]), first)


def angles(model: Model, edges: np.ndarray) -> np.ndarray:
    """Return the angle between the faces of each edge, in radians; 0 where there are not two."""
    offsets, corners = model.offsets, model.corners
    normals = _face_areas(model)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    of_edge: dict[tuple[int, int], list[int]] = {}
    face = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    for (a, b), f in zip(welding.face_edges(offsets, corners).tolist(), face.tolist(), strict=True):
        of_edge.setdefault((a, b), []).append(f)
    result = []
    for a, b in np.sort(edges, axis=1).tolist():
        faces = of_edge.get((a, b), [])
        cosine = normals[faces[0]] @ normals[faces[1]] if len(faces) == 2 else 1.0
        result.append(np.arccos(np.clip(cosine, -1, 1)))
    return np.array(result)


def _samples(model: Model, edges: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points on edges (n, 3), at most `step` apart, their edges (n,), and the length each stands for (n,)."""
    start, end = model.vertices[edges[:, 0]], model.vertices[edges[:, 1]]
    length = np.linalg.norm(end - start, axis=1)
    count = np.maximum(np.ceil(length / step).astype(int), 1)
    edge = np.repeat(np.arange(len(edges)), count)
    along = (np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count) + 0.5) / count[edge]
    return start[edge] + along[:, None] * (end - start)[edge], edge, (length / count)[edge]


def passages(model: Model, seams: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the seams' inner vertices: each (n,), and its two neighbors on the seam (n, 2); and their turns (n,)."""
    ends = np.concatenate([seams, seams[:, ::-1]])
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    vertex, first, count = np.unique(ends[:, 0], return_index=True, return_counts=True)
    first, vertex = first[count == 2], vertex[count == 2]
    beside = np.stack([ends[first, 1], ends[first + 1, 1]], axis=1)
    before, after = (model.vertices[a] - model.vertices[b] for a, b in ((vertex, beside[:, 0]), (beside[:, 1], vertex)))
    cosine = (before * after).sum(axis=1) / np.maximum(
        np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1), 1e-300
    )
    return vertex, beside, np.arccos(np.clip(cosine, -1.0, 1.0))


def on_loops(model: Model, vertex: np.ndarray, beside: np.ndarray) -> np.ndarray:
    """Return for the regular ones among vertices that a seam passes whether its two edges are opposite, (m,) bool."""
    sizes = np.diff(model.offsets)
    n = len(model.vertices)
    faces_of = np.bincount(model.corners, minlength=n)
    quads_of = np.bincount(model.corners, weights=np.repeat(sizes == 4, sizes), minlength=n)
    edges = np.unique(welding.face_edges(model.offsets, model.corners), axis=0)
    edges_of = np.bincount(edges.ravel(), minlength=n)
    regular = (faces_of[vertex] == 4) & (quads_of[vertex] == 4) & (edges_of[vertex] == 4)
    face = np.repeat(np.arange(len(sizes)), sizes)
    around: dict[int, list[set[int]]] = {}
    for corner, v in enumerate(model.corners.tolist()):
        around.setdefault(v, []).append(
            set(model.corners[model.offsets[face[corner]] : model.offsets[face[corner] + 1]])
        )
    return np.array(
        [
            not any({a, b} <= corners for corners in around[v])
            for v, (a, b) in zip(vertex[regular].tolist(), beside[regular].tolist(), strict=True)
        ],
        dtype=bool,
    )


def aligned_share(result: spectral_conformal.Unwrap) -> float:
    """Return how much of the islands' borders in a map lies within 2 degrees of an axis."""
    corners, step = border_edges(result)
    step = step[result.solved_corners[corners]]
    length = np.abs(step)
    return float(length[is_along_axis(step)].sum() / length.sum())


def measure(model: Model, seams: np.ndarray) -> SeamMeasures:
    """Measure seams (S, 2) of a model, and our map of them, beside its artist's."""
    result = spectral_conformal.unwrap(
        model.vertices, model.offsets, model.corners, seam_edges=seams, polish=True, straighten="auto"
    )
    islands = len(result.charts)
    worst = max((chart.max_qc for chart in result.charts if np.isfinite(chart.max_qc)), default=float("nan"))
    aligned = aligned_share(result)
    if len(seams) == 0:
        return SeamMeasures(0, 0, 0, 0, 0, 0, islands, float("nan"), 0, aligned, worst)
    vertex, beside, turns = passages(model, seams)
    straight = on_loops(model, vertex, beside)
    size = float(np.linalg.norm(np.ptp(model.vertices[np.unique(model.corners)], axis=0)))
    points, edge, weights = _samples(model, seams, 0.5 * NEAR * size)
    theirs, _, their_weights = _samples(model, model.seams, 0.5 * NEAR * size)
    near = cKDTree(theirs).query(points)[0] <= NEAR * size
    near_ours = cKDTree(points).query(theirs)[0] <= NEAR * size
    length = np.linalg.norm(model.vertices[seams[:, 0]] - model.vertices[seams[:, 1]], axis=1)
    angle = angles(model, seams)
    sharp = (angle >= SHARP)[edge]
    area = np.linalg.norm(_face_areas(model), axis=1).sum()
    return SeamMeasures(
        flat=float(np.average(angle <= FLAT, weights=length)),
        sharp=float(np.average(angle >= SHARP, weights=length)),
        found=float(np.average(near, weights=weights)),
        kept=float(np.average(near | sharp, weights=weights)),
        covered=float(np.average(near_ours, weights=their_weights)),
        length=float(length.sum() / np.sqrt(area)),
        islands=islands,
        loops=float(straight.mean()) if len(straight) else float("nan"),
        bends=float((turns > np.radians(30)).mean()) if len(turns) else 0.0,
        aligned=aligned,
        worst=worst,
    )


def suggested(model: Model) -> SeamMeasures:
    """Suggest seams from nothing but borders of materials, unwrap, and measure."""
    seams = spectral_conformal.suggest_seams(
        model.vertices, model.offsets, model.corners, preferred_edges=model.borders
    ).seam_edges
    return measure(model, seams)


def given_paths(arguments: list[str]) -> list[Path]:
    """Return the named files, or those of the installed packages."""
    roots = [Path(argument) for argument in arguments]
    if not roots:
        found = importlib.util.find_spec("pybullet_data")
        roots = [Path(found.origin).parent] if found and found.origin else []
        roots += [Path(folder) for folder in ("build/models", "/usr/share/assimp/models") if Path(folder).is_dir()]
    paths = [path for root in roots for path in (sorted(root.rglob("*")) if root.is_dir() else [root])]
    return [path for path in paths if path.suffix.lower() in assets.READABLE]


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="*", metavar="file or folder")
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    names = [field.name for field in fields(SeamMeasures)]
    print(f"| model | faces | seams | {' | '.join(names)} |\n|{'---|' * (len(names) + 3)}", flush=True)
    totals: dict[str, list[SeamMeasures]] = {"artists'": [], "suggested": []}
    for model in models(given_paths(options.paths)):
        for whose, each in (
            ("artists'", measure(model, model.seams)),
            ("suggested", suggested(model)),
        ):
            totals[whose].append(each)
            cells = " | ".join(f"{value:.2f}" for value in astuple(each))
            print(f"| {model.name} | {len(model.offsets) - 1} | {whose} | {cells} |", flush=True)
    if not totals["suggested"]:
        print("No model counts: see the module's docstring for packages that have some.")
        return 1
    titles = ("seams", "models", "across flat regions", "on sharp edges", "kept", "found", "along edge loops", "bends")
    more = ("borders along axes", "length over root of area", "islands")
    table = documents.Table("artists-seams", (*titles, *more), documents.SEAMS)
    for whose, found in totals.items():
        mean = SeamMeasures(*np.nanmean([astuple(each) for each in found], axis=0))
        # The artists' own are all found.
        shares = [mean.flat, mean.sharp, *((mean.kept, mean.covered) if whose == "suggested" else ())]
        cells = [f"{100 * share:.0f} %" for share in shares] + [""] * (4 - len(shares))
        cells += [f"{100 * share:.0f} %" for share in (mean.loops, mean.bends, mean.aligned)]
        table.row(whose, len(found), *cells, f"{mean.length:.1f}", f"{mean.islands:.0f}")
    if options.keep:
        documents.keep(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
