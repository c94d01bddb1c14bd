# SPDX-License-Identifier: GPL-3.0-or-later
"""Redraw the figures of the paper, and print the page with each claim beside its measurement.

    build/venv/bin/python -m tests.benchmarks.paper_figures [--models FOLDER] [--images FOLDER]

The paper's meshes are not public as a set, so meshes of the same kinds are generated. To use your own, put a
triangulated patch at FOLDER/<name>.obj; `FIGURES` lists the names. Prints the tables of docs/figures.md, and writes the
pictures to docs/images.
"""

from __future__ import annotations

import argparse
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import spectral_conformal as sc
from scipy.sparse import coo_array
from scipy.spatial import Delaunay, KDTree

from tests.benchmarks.control_pictures import COLORS, DPI, IMAGES, triangulated, turned_as_seen_from_above
from tests.module import meshes

PANEL_INCHES = 2.6
# Triangles closer to a vertex than this fraction of the surface's extent are "near" it.
NEAR = 0.04
Mesh = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Panel:
    """A map of one method: its options, and the vertices that are pinned or pushed apart."""

    title: str
    options: dict[str, object]
    pins: tuple[int, ...] = ()
    extenders: tuple[tuple[int, int, float], ...] = ()


@dataclass(frozen=True)
class Map:
    """A map and its measures."""

    mesh: Mesh
    panel: Panel
    uv: np.ndarray
    measured: sc.Distortion

    @property
    def qc(self) -> float:
        """Mean quasi-conformal distortion (section 5)."""
        return self.measured.mean_qc

    @property
    def flips(self) -> int:
        """Flipped triangles."""
        return int(self.measured.flipped.sum())

    @property
    def overlaps(self) -> int:
        """Triangles that cover others."""
        return int(self.measured.overlapping.sum())

    @property
    def spread(self) -> float:
        """Standard deviation of log2 of the scale."""
        return self.measured.log2_scale_deviation

    @property
    def scale_range(self) -> float:
        """How many times as large as the smallest linear scale the largest one is, 1 % of the triangles left out."""
        low, high = np.percentile(self.measured.log2_scale, [0.5, 99.5])
        return float(2 ** (high - low))

    def asymmetry(self, axis: int) -> float:
        """Largest distance between the map and its mirror image, over its extent; of a mesh mirrored in `axis`."""
        vertices = self.mesh[0]
        mirrored = vertices * np.where(np.arange(3) == axis, -1.0, 1.0)
        twin = KDTree(vertices).query(mirrored)[1]
        return float(meshes.similarity_deviation(self.uv, self.uv[twin] * [1, -1]))

    def qc_near(self, points: Sequence[int]) -> float:
        """Mean QC of the triangles near these vertices."""
        vertices, triangles = self.mesh
        middles = vertices[triangles].mean(axis=1)
        nearest = KDTree(vertices[list(points)]).query(middles)[0]
        chosen = nearest < NEAR * np.ptp(vertices, axis=0).max()
        return float(np.average(self.measured.qc[chosen], weights=areas(self.mesh)[chosen]))

    def distance(self, a: int, b: int) -> float:
        """Distance of two vertices in the map, over the root of the map's area."""
        first, second, third = (self.uv[self.mesh[1][:, k]] for k in range(3))
        area = abs(np.linalg.det(np.stack([second - first, third - first], axis=1)).sum()) / 2
        return float(np.linalg.norm(self.uv[a] - self.uv[b]) / area**0.5)


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, its measurement, and whether they agree."""

    said: str
    measured: Callable[[list[Map]], str]
    holds: Callable[[list[Map]], bool] | None = None
    """None: a figure of the paper's own mesh, which ours is not."""


@dataclass(frozen=True)
class Figure:
    """A figure of the paper: its mesh, the drawn maps, and the claims about them."""

    number: str
    name: str
    shown: str
    make: Callable[[], Mesh]
    panels: Callable[[Mesh], list[Panel]]
    claims: tuple[Claim, ...]
    view: tuple[float, float] = (30, -60)
    behind: float = 1.0
    """The maps show what lies in this fraction of the mesh's extent in y, from the back."""

    def mesh(self, models: Path | None = None) -> Mesh:
        """Return the user's mesh of this name from the folder, if there is one, else ours."""
        path = models / f"{self.name}.obj" if models else None
        if path is None or not path.exists():
            return self.make()
        vertices, faces = meshes.read_obj(path)
        return meshes.without_unused(vertices, np.array(faces))

    def maps(self, models: Path | None = None) -> list[Map]:
        """Solve and measure."""
        mesh = self.mesh(models)
        return [solved(mesh, panel) for panel in self.panels(mesh)]

    def table(self, maps: list[Map]) -> str:
        """Return the table of the claims."""
        rows = ["| the paper | measured here | |", "|---|---|---|"]
        for claim in self.claims:
            verdict = "other mesh" if claim.holds is None else "holds" if claim.holds(maps) else "**does not hold**"
            rows.append(f"| {claim.said} | {claim.measured(maps)} | {verdict} |")
        return "\n".join(rows)

    @property
    def picture(self) -> str:
        """The name of its picture."""
        return f"paper_{self.name}.png"


def solved(mesh: Mesh, panel: Panel) -> Map:
    """Solve without fallbacks, which would replace a failed map by another method's."""
    keywords: dict[str, object] = dict(panel.options)
    if panel.pins:
        # As far apart as on the surface, so that the map has about its size.
        a, b = panel.pins
        keywords["pins"] = {a: (0.0, 0.0), b: (float(np.linalg.norm(mesh[0][a] - mesh[0][b])), 0.0)}
    if panel.extenders:
        keywords["extenders"] = list(panel.extenders)
    solution = sc.parameterize(*mesh, fallbacks=False, **keywords)
    uv = turned_as_seen_from_above(solution.uv, mesh[0])
    return Map(mesh, panel, uv, sc.distortion(*mesh, uv))


def areas(mesh: Mesh) -> np.ndarray:
    """(F,) areas of the triangles."""
    a, b, c = (mesh[0][mesh[1][:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def covering(values: np.ndarray, weights: np.ndarray, fraction: float) -> float:
    """Return the weighted quantile of the values."""
    order = np.argsort(values)
    summed = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(summed, fraction * summed[-1])])


def boundary_vertices(triangles: np.ndarray) -> np.ndarray:
    """Vertices of edges of one triangle only."""
    edges = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[count == 1])


def farthest_pins(mesh: Mesh) -> tuple[int, int]:
    """Return the two boundary vertices farthest from each other in space."""
    border = boundary_vertices(mesh[1])
    points = mesh[0][border]
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    a, b = np.unravel_index(distance.argmax(), distance.shape)
    return int(border[a]), int(border[b])


def nearest(mesh: Mesh, place: Sequence[float]) -> int:
    """Return the vertex nearest to a place in the mesh's bounding box, from (0, 0, 0) to (1, 1, 1)."""
    low = mesh[0].min(axis=0)
    return int(np.linalg.norm(mesh[0] - low - place * np.ptp(mesh[0], axis=0), axis=1).argmin())


def saddle() -> Mesh:
    """Return the saddle z = x^2 - y^2."""
    return triangulated(meshes.saddle_quads(31))


def mask() -> Mesh:
    """Return a face in relief with a round border, evenly sampled: stands for the lion head."""
    vertices, triangles = meshes.random_disk(4000, seed=4)
    x, y = vertices[:, :2].T

    def bump(u: float, v: float, height: float, width: float) -> np.ndarray:
        return height * np.exp(-((x - u) ** 2 + (y - v) ** 2) / width**2)

    dome = 0.7 * np.sqrt(np.maximum(1.04 - x**2 - y**2, 0))
    eyes = sum(bump(side * 0.35, 0.2, -0.15, 0.16) + bump(side * 0.35, 0.45, 0.12, 0.2) for side in (-1, 1))
    z = dome + eyes + bump(0, -0.05, 0.45, 0.2) + bump(0, -0.45, 0.2, 0.25)
    return np.c_[x, y, z + 0.02 * np.sin(14 * np.arctan2(y, x)) * (x**2 + y**2)], triangles


def of_voxels(boxes: Sequence[tuple[Sequence[int], Sequence[int]]], opening: Callable, smoothing: int) -> Mesh:
    """Return the smoothed skin of a union of boxes of unit cubes, without the squares that `opening` chooses.

    Args:
        boxes: (lower corner, upper corner), in cubes, symmetric about x = 0.
        opening: of (n, 3) middles and (n, 3) normals of squares, which of them are left out, (n,) bool.
        smoothing: steps of averaging over neighbors.
    """
    low = np.min([a for a, _ in boxes], axis=0) - 1
    high = np.max([b for _, b in boxes], axis=0) + 1
    filled = np.zeros(high - low, bool)
    for a, b in boxes:
        filled[tuple(slice(s, e) for s, e in zip(np.array(a) - low, np.array(b) - low))] = True
    squares, normals = [], []
    for axis in range(3):
        one, two = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        step = np.eye(3, dtype=int)[axis]
        for sign in (1, -1):
            outside = ~np.roll(filled, -sign, axis=axis)
            corner = np.argwhere(filled & outside) + (step if sign == 1 else 0)
            around = (0 * one, one, one + two, two) if sign == 1 else (0 * one, two, one + two, one)
            squares.append(np.stack([corner + k for k in around], axis=1))
            normals.append(np.tile(sign * step, (len(corner), 1)))
    corners, normal = np.concatenate(squares) + low, np.concatenate(normals)
    kept = ~opening(corners.mean(axis=1), normal)
    points, quads = np.unique(corners[kept].reshape(-1, 3), axis=0, return_inverse=True)
    vertices, quads = points.astype(float), quads.reshape(-1, 4)
    pairs = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    pairs = np.unique(np.r_[pairs, pairs[:, ::-1]], axis=0)
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(vertices),) * 2).tocsr()
    valence = links.sum(axis=1)[:, None]
    for _ in range(smoothing):
        vertices = (vertices + links @ vertices / valence) / 2
    # Split at the corner that comes first in this order, which is alike on the two sides of x = 0.
    rank = np.unique(np.abs(points) * [1, 0, 0] + points * [0, 1, 1], axis=0, return_inverse=True)[1].ravel()
    first = rank[quads].argmin(axis=1)
    quads = np.take_along_axis(quads, (first[:, None] + np.arange(4)) % 4, axis=1)
    return vertices, np.r_[quads[:, :3], quads[:, [0, 2, 3]]]


def airplane() -> Mesh:
    """Return an airplane that is open in front: fuselage, wings, stabilizers, fin."""
    boxes = (
        ((-2, -14, -2), (2, 8, 2)),
        ((-12, -2, -1), (12, 4, 1)),
        ((-6, -14, -1), (6, -10, 1)),
        ((-1, -14, 0), (1, -11, 6)),
    )
    return of_voxels(boxes, lambda middle, normal: (normal[:, 1] == 1) & (middle[:, 1] > 7.5), 3)


def egg_crate() -> Mesh:
    """Return z = cos x cos y over three periods."""
    n = 49
    t = np.linspace(-3 * np.pi, 3 * np.pi, n)
    x, y = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
    return triangulated((np.c_[x, y, 1.6 * np.cos(x) * np.cos(y)], meshes.grid_quads(n, n)))


def half_sphere() -> Mesh:
    """Return a half-sphere whose one side is sampled far more finely."""
    rng = np.random.default_rng(7)
    n = 32000
    candidates = np.sqrt(rng.random(n)) * 0.97 * np.exp(2j * np.pi * rng.random(n))
    kept = rng.random(n) < np.where(candidates.real > 0.1, 0.16, 0.006)
    step = np.arange(720)
    rim = np.exp(2j * np.pi * step / len(step))
    z = np.r_[rim[(rim.real > 0.1) & (step % 3 == 0) | (step % 20 == 0)], candidates[kept]]
    triangles = Delaunay(np.c_[z.real, z.imag]).simplices.astype(np.int64)
    turned = ((z[triangles[:, 1]] - z[triangles[:, 0]]).conj() * (z[triangles[:, 2]] - z[triangles[:, 0]])).imag
    triangles[turned < 0] = triangles[turned < 0][:, ::-1]
    # The inverse of the stereographic projection, under which the half-sphere is the unit disk.
    square = np.abs(z) ** 2
    vertices = np.c_[2 * z.real, 2 * z.imag, 1 - square] / (1 + square)[:, None]
    return meshes.without_unused(vertices, triangles[np.abs(turned) > 1e-10])


def roundness(found: Map) -> float:
    """Return by how much the border of a map departs from a circle: greatest over least distance to its middle."""
    border = found.uv[boundary_vertices(found.mesh[1])]
    # The circle of least squares, on which no vertex counts more for being one of many.
    system = np.c_[2 * border, np.ones(len(border))]
    middle = np.linalg.lstsq(system, (border**2).sum(axis=1), rcond=None)[0][:2]
    radius = np.linalg.norm(border - middle, axis=1)
    return float(radius.max() / radius.min())


def cow() -> Mesh:
    """Return a four-legged body, open at the belly."""
    boxes = (
        ((-4, -8, 0), (4, 8, 7)),
        ((-2, 8, 4), (2, 14, 8)),
        *(((x, y, -8), (x + 3, y + 3, 0)) for x in (-4, 1) for y in (-8, 5)),
    )
    return of_voxels(boxes, lambda middle, normal: (normal[:, 2] == -1) & (np.abs(middle[:, 1]) < 4), 3)


def car() -> Mesh:
    """Return the shell of a car: no floor, windows and wheel arches cut out."""
    boxes = (((-7, -18, 0), (7, 18, 7)), ((-6, -11, 7), (6, 8, 13)))

    def opening(middle: np.ndarray, normal: np.ndarray) -> np.ndarray:
        _, y, z = middle.T
        sideways = normal[:, 0] != 0
        windows = sideways & (z > 8) & (z < 12) & (((y > -10) & (y < -2)) | ((y > 0) & (y < 7)))
        screens = (normal[:, 1] != 0) & (z > 8) & (z < 12) & (np.abs(middle[:, 0]) < 5)
        arches = sideways & (np.minimum(np.abs(y - 11), np.abs(y + 11)) < 3) & (z > 1) & (z < 5)
        return (normal[:, 2] == -1) | windows | screens | arches

    return of_voxels(boxes, opening, 6)


def holed() -> Mesh:
    """Return a bumpy disk with 24 holes."""
    return meshes.bumpy_disk(6000, holes=24, seed=9)


LSCM: dict[str, object] = {"method": "lscm"}
# B with 1 for every boundary vertex, as in the paper; ours is by length.
SPECTRAL: dict[str, object] = {"boundary": "vertex"}


def saddle_panels(mesh: Mesh) -> list[Panel]:
    """LSCM with several pairs of boundary vertices, and the spectral map."""
    corner, opposite, beside = (nearest(mesh, p) for p in ((0, 0, 0.5), (1, 1, 0.5), (1, 0, 0.5)))
    left, right = nearest(mesh, (0, 0.5, 1)), nearest(mesh, (0, 0.55, 1))
    return [
        Panel("LSCM, opposite corners", LSCM, (corner, opposite)),
        Panel("LSCM, one side", LSCM, (corner, beside)),
        Panel("LSCM, close together", LSCM, (left, right)),
        Panel("spectral", SPECTRAL),
    ]


def lscm_and_spectral(mesh: Mesh) -> list[Panel]:
    """LSCM with the two farthest boundary vertices pinned, and the spectral map."""
    return [Panel("LSCM", LSCM, farthest_pins(mesh)), Panel("spectral", SPECTRAL)]


def airplane_panels(_: Mesh) -> list[Panel]:
    """The eigenvectors of the three forms B."""
    return [
        Panel("Fiedler vector, B = I", {"method": "fiedler"}),
        Panel("B = A", {"method": "area"}),
        Panel("spectral", SPECTRAL),
    ]


def cow_panels(mesh: Mesh) -> list[Panel]:
    """LSCM, spectral, two vertices of the border pushed apart, and the hind legs."""
    border = boundary_vertices(mesh[1])
    x, y, _ = (mesh[0][border] - np.median(mesh[0][border], axis=0)).T
    sides = [int(border[np.argmax(side * x - np.abs(y))]) for side in (-1, 1)]
    legs = [nearest(mesh, (x, 0.07, 0)) for x in (0.2, 0.8)]
    pushed = [
        Panel(title, SPECTRAL, extenders=((*ends, strength),))
        for title, ends, strength in (("border extended", sides, 2.0), ("legs extended", legs, 0.02))
    ]
    return [*lscm_and_spectral(mesh), *pushed]


def pushed_apart(which: int) -> tuple[Claim, Claim]:
    """The claims about extenders, for the map with this index."""

    def ends(maps: list[Map]) -> tuple[int, int]:
        first, second, _ = maps[which].panel.extenders[0]
        return first, second

    def distances(maps: list[Map]) -> tuple[float, float]:
        return maps[1].distance(*ends(maps)), maps[which].distance(*ends(maps))

    def near(maps: list[Map]) -> tuple[float, float]:
        return maps[1].qc_near(ends(maps)), maps[which].qc_near(ends(maps))

    where = {2: "the border", 3: "the tips of the legs"}[which]
    return (
        Claim(
            f"extenders give control: on {where}",
            lambda maps: "their distance over the root of the area goes from {:.3f} to {:.3f}".format(*distances(maps)),
            lambda maps: distances(maps)[1] > 1.1 * distances(maps)[0],
        ),
        Claim(
            "without local distortion around the extended vertices",
            lambda maps: (
                "mean QC near them {:.3f} before, {:.3f} after".format(*near(maps))
                + f"; over the surface {maps[1].qc:.3f} and {maps[which].qc:.3f}"
            ),
            # No more than twice what the whole surface pays.
            lambda maps: near(maps)[1] - near(maps)[0] <= 2 * (maps[which].qc - maps[1].qc),
        ),
    )


def both_qc(maps: list[Map]) -> str:
    """Return mean QC of the first and the last map."""
    return f"mean QC {maps[0].qc:.4f} by LSCM, {maps[-1].qc:.4f} spectral"


def no_flips(maps: list[Map]) -> str:
    """Return flips and overlaps of the last map."""
    return f"{maps[-1].flips} flipped, {maps[-1].overlaps} overlapping triangles"


def is_sound(maps: list[Map]) -> bool:
    """Return whether the last map has neither flips nor overlaps."""
    return maps[-1].flips == maps[-1].overlaps == 0


def has_lower_qc(maps: list[Map]) -> bool:
    """Return whether the last map has the lower mean QC."""
    return maps[-1].qc < maps[0].qc


LOWER = Claim("lower mean QC than LSCM", both_qc, has_lower_qc)
NO_FLIPS = Claim("no flips, no folds", no_flips, is_sound)

FIGURES = (
    Figure(
        "3",
        "saddle",
        "a saddle, LSCM with three pairs of pins, and the spectral map",
        saddle,
        saddle_panels,
        (
            Claim(
                "LSCM depends highly on the vertices chosen as constraints",
                lambda maps: "mean QC " + ", ".join(f"{m.qc:.3f} ({m.panel.title[6:]})" for m in maps[:3]),
                lambda maps: max(m.qc for m in maps[:3]) - 1 > 1.5 * (min(m.qc for m in maps[:3]) - 1),
            ),
            Claim(
                "the spectral map has less distortion",
                lambda maps: f"mean QC {maps[3].qc:.3f}",
                lambda maps: maps[3].qc < min(m.qc for m in maps[:3]),
            ),
            Claim(
                "and keeps the symmetry (Fig. 1, 6, 8)",
                lambda maps: (
                    f"distance from its mirror image over its extent: {_small(maps[3].asymmetry(0))}; LSCM up to "
                    f"{max(m.asymmetry(0) for m in maps[:3]):.2f}"
                ),
                lambda maps: maps[3].asymmetry(0) < 1e-6 < max(m.asymmetry(0) for m in maps[:3]),
            ),
        ),
    ),
    Figure(
        "4",
        "mask",
        "a face in relief, by LSCM with two pins and spectral, colored by QC",
        mask,
        lscm_and_spectral,
        (
            Claim(
                "LSCM distorts near its pins",
                lambda maps: (
                    f"mean QC there {maps[0].qc_near(maps[0].panel.pins):.3f}, {maps[0].qc:.3f} over the surface"
                ),
                lambda maps: maps[0].qc_near(maps[0].panel.pins) > maps[0].qc,
            ),
            Claim(
                "the spectral map does not",
                lambda maps: f"in the same place {maps[1].qc_near(maps[0].panel.pins):.3f}",
                lambda maps: maps[1].qc_near(maps[0].panel.pins) < maps[0].qc_near(maps[0].panel.pins),
            ),
            LOWER,
        ),
        (90, -90),
    ),
    Figure(
        "5",
        "airplane",
        "an airplane open in front, and its tail in the maps by the Fiedler vector, by B = A, and spectral",
        airplane,
        airplane_panels,
        (
            Claim(
                "conformal maps of it have wildly varying triangle sizes",
                lambda maps: f"the largest linear scale is {maps[2].scale_range:,.0f} times the smallest",
                lambda maps: maps[2].scale_range > 10,
            ),
            Claim(
                "the Fiedler vector of L has flips and tent-like distortion on the stabilizers",
                lambda maps: f"{maps[0].flips} flips, mean QC {maps[0].qc:.3f}, worst {maps[0].measured.max_qc:.1f}",
                lambda maps: maps[0].flips > 0 and maps[0].qc > maps[2].qc,
            ),
            Claim(
                "the spectral map has no flip",
                lambda maps: f"{maps[2].flips} flips, mean QC {maps[2].qc:.3f}, worst {maps[2].measured.max_qc:.1f}",
                lambda maps: maps[2].flips == 0,
            ),
            Claim(
                "with B = A folds appear more often (3.3)",
                lambda maps: f"{maps[1].flips} flips, mean QC {maps[1].qc:.3f}",
                lambda maps: maps[1].flips > maps[2].flips,
            ),
        ),
        (35, 40),
        behind=0.2,
    ),
    Figure(
        "6",
        "egg_crate",
        "an egg crate, by LSCM with two pins and spectral",
        egg_crate,
        lscm_and_spectral,
        (
            LOWER,
            Claim(
                "the spectral map respects the symmetry better",
                lambda maps: (
                    f"distance from its mirror image over its extent: {maps[0].asymmetry(0):.3f} by LSCM, "
                    f"{_small(maps[1].asymmetry(0))} spectral"
                ),
                lambda maps: maps[1].asymmetry(0) < maps[0].asymmetry(0),
            ),
            Claim("QC = 1.0629, of the paper's own mesh", lambda maps: f"{maps[1].qc:.4f}"),
        ),
    ),
    Figure(
        "7",
        "half_sphere",
        "a half-sphere that is finer on one side, without and with area weights",
        half_sphere,
        lambda mesh: [
            Panel("uniform weights", SPECTRAL),
            Panel("inverse area", {**SPECTRAL, "weights": "inverse_area"}),
            Panel("uniform, B by length", {"boundary": "length"}),
        ],
        (
            Claim(
                "1 / area as weight takes away the bias of irregular sampling",
                lambda maps: (
                    f"spread of the sizes {maps[0].spread:.3f} without, {maps[1].spread:.3f} with; border's largest "
                    f"over smallest radius {roundness(maps[0]):.3f} and {roundness(maps[1]):.3f}"
                ),
                lambda maps: maps[1].spread < maps[0].spread and roundness(maps[1]) < roundness(maps[0]),
            ),
            Claim(
                "(not in the paper) B by length takes it away, too",
                lambda maps: f"spread {maps[2].spread:.3f}, radius {roundness(maps[2]):.3f}",
                lambda maps: maps[2].spread < maps[0].spread,
            ),
        ),
        (35, -60),
    ),
    Figure(
        "8",
        "cow",
        "a four-legged body open at the belly, by LSCM, spectral, and with extenders",
        cow,
        cow_panels,
        (
            Claim(
                "LSCM with the two farthest vertices pinned is asymmetric, the spectral map symmetric",
                lambda maps: (
                    f"distance from its mirror image over its extent: {maps[0].asymmetry(0):.3f} by LSCM, "
                    f"{_small(maps[1].asymmetry(0))} spectral"
                ),
                lambda maps: maps[1].asymmetry(0) < 1e-6 < maps[0].asymmetry(0),
            ),
            *pushed_apart(2),
            *pushed_apart(3),
        ),
        (20, -50),
    ),
    Figure(
        "9",
        "holed",
        "a bumpy disk with 24 holes, by LSCM with two pins and spectral",
        holed,
        lscm_and_spectral,
        (LOWER, NO_FLIPS),
        (50, -60),
    ),
    Figure(
        "10",
        "car",
        "the shell of a car with windows and wheel arches, by LSCM with two pins and spectral",
        car,
        lscm_and_spectral,
        (
            LOWER,
            NO_FLIPS,
            Claim(
                "QC = 1.007874, of the paper's own mesh",
                lambda maps: f"{maps[1].qc:.6f}",
            ),
        ),
        (25, 130),
    ),
)


def draw(figure: Figure, maps: list[Map], folder: Path) -> None:
    """Draw the surface and its maps, colored by QC on one scale; pins and the ends of extenders are dots."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt
    from PIL import Image

    (vertices, triangles), n = maps[0].mesh, 1 + len(maps)
    drawing = plt.figure(figsize=(PANEL_INCHES * n, PANEL_INCHES), layout="constrained")
    surface = drawing.add_subplot(1, n, 1, projection="3d")
    surface.plot_trisurf(*vertices.T, triangles=triangles, color="lightsteelblue", edgecolor="slategrey", linewidth=0.1)
    surface.view_init(*figure.view)
    surface.set_aspect("equal")
    surface.set_axis_off()
    top = max(covering(each.measured.qc, areas(each.mesh), 0.95) for each in maps)
    panels = []
    for place, each in enumerate(maps, 2):
        panel = drawing.add_subplot(1, n, place)
        shades = {"cmap": "viridis", "vmin": 1, "vmax": top}
        colors = panel.tripcolor(*each.uv.T, triangles, each.measured.qc, edgecolors="face", linewidth=0.1, **shades)
        marked = [*each.panel.pins, *(end for pair in each.panel.extenders for end in pair[:2])]
        panel.plot(*each.uv[marked].T, "o", color="red", markersize=4)
        y = vertices[:, 1]
        shown = each.uv[y <= y.min() + figure.behind * np.ptp(y)]
        low, high = shown.min(axis=0), shown.max(axis=0)
        margin = 0.04 * (high - low).max()
        panel.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
        panel.set_aspect("equal")
        panel.set_axis_off()
        panel.set_title(f"{each.panel.title}\nmean QC {each.qc:.3f}", fontsize=9)
        panels.append(panel)
    drawing.colorbar(colors, ax=panels, label="QC", shrink=0.7)
    drawn = io.BytesIO()
    drawing.savefig(drawn, dpi=DPI)
    plt.close(drawing)
    picture = Image.open(drawn).convert("RGB").quantize(COLORS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    picture.save(folder / figure.picture, optimize=True)


def _small(value: float) -> str:
    """Return a number as text; pure rounding errors, which vary with the BLAS, become an upper bound."""
    return "below 1e-9" if value < 1e-9 else f"{value:.0e}"


def section(figure: Figure, maps: list[Map]) -> str:
    """Return the page's section on one figure."""
    vertices, triangles = maps[0].mesh
    size = f"{len(vertices):,} vertices, {len(triangles):,} triangles."
    title = f"## Figure {figure.number}: {figure.shown}"
    return f"{title}\n\n{size}\n\n![Figure {figure.number}](images/{figure.picture})\n\n{figure.table(maps)}\n"


def main() -> None:
    """Draw all pictures and print the page's sections."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--models", type=Path, help="folder of meshes <name>.obj to take instead of ours")
    parser.add_argument("--images", type=Path, default=IMAGES, help="where the pictures go (docs/images)")
    arguments = parser.parse_args()
    for figure in FIGURES:
        maps = figure.maps(arguments.models)
        draw(figure, maps, arguments.images)
        print(section(figure, maps), flush=True)


if __name__ == "__main__":
    main()
