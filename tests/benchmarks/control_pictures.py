# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the guide's pictures of what each option does to a map, and print the numbers for docs/benchmarks.md.

    build/venv/bin/python -m tests.benchmarks.control_pictures [folder]

The folder is docs/images by default.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import spectral_conformal as sc

from addon.core.layout.alignment import angle_of_sides
from tests.module import meshes

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
DPI = 80
PANEL_INCHES = 2.8
# Vertices of a sheet, across and up.
SHEET = (25, 17)
# A surface of shades and maps of one color scale need no more.
COLORS = 128


@dataclass(frozen=True)
class Map:
    """One map of an example, its options and the module's measures of it."""

    title: str
    uv: np.ndarray
    measured: sc.Distortion
    hole_rigidity: float
    line_length: float

    @property
    def mean_qc(self) -> float:
        """Mean quasi-conformal distortion."""
        return self.measured.mean_qc

    @property
    def max_qc(self) -> float:
        """Quasi-conformal distortion of the worst triangle."""
        return self.measured.max_qc

    @property
    def spread(self) -> float:
        """Standard deviation of log2 of the scale."""
        return self.measured.log2_scale_deviation

    @property
    def flips(self) -> int:
        """Flipped triangles."""
        return int(self.measured.flipped.sum())

    @property
    def overlaps(self) -> int:
        """Triangles that cover others."""
        return int(self.measured.overlapping.sum())

    @property
    def oblongness(self) -> float:
        """Width of the map over its height."""
        width, height = np.ptp(self.uv, axis=0)
        return float(width / height)


@dataclass(frozen=True)
class Example:
    """A mesh, and the maps that are drawn of it.

    `choices` are keywords of `parameterize`, or functions of the mesh that return them; `further` are measures beside
    mean QC and spread, with fields of the maps.
    """

    name: str
    mesh: Callable[[], tuple[np.ndarray, np.ndarray]]
    choices: dict[str, dict[str, object] | Callable[[np.ndarray, np.ndarray], dict[str, object]]]
    colors: str
    option: str
    further: str = ""
    line: tuple[int, ...] = ()

    def maps(self) -> list[Map]:
        """Solve and measure."""
        vertices, triangles = self.mesh()
        maps = []
        for title, choice in self.choices.items():
            keywords = dict(choice(vertices, triangles) if callable(choice) else choice)
            if "stretch" in keywords:
                keywords["metric"] = sc.metric_from_direction(vertices, triangles, [1, 0, 0], keywords.pop("stretch"))
            relaxed = keywords.pop("relax", None)
            as_given = keywords.pop("as_given", False)
            solution = sc.parameterize(vertices, triangles, **keywords)
            lies_as_given = as_given or "constraints" in keywords
            uv = turned_as_seen_from_above(solution.uv, vertices, by_quarters=lies_as_given)
            if relaxed is not None:
                on_border = (np.abs(vertices[:, :2]) == np.abs(vertices[:, :2]).max(axis=0)).any(axis=1)
                fixed = on_border if relaxed.get("hold_border") else None
                uv = meshes.relax(vertices, triangles, uv, sizes=relaxed["sizes"], fixed=fixed).uv
            measured = sc.distortion(vertices, triangles, uv)
            maps.append(Map(title, uv, measured, solution.hole_rigidity, _length(uv[list(self.line)])))
        return maps

    @property
    def shown(self) -> str:
        """The alternative text of the picture."""
        return f"{self.option}: {', '.join(self.choices)}"

    def written(self, maps: list[Map]) -> str:
        """Return the measures of the maps in one line."""
        vertices, _ = self.mesh()
        qc, spread = ([getattr(each, name) for each in maps] for name in ("mean_qc", "spread"))
        measures = [
            f"mean QC {', '.join(f'{value:.3f}' for value in qc)}",
            f"spread {', '.join(f'{value:.2f}' for value in spread)}",
        ]
        if self.further:
            measures.append(self.further.format(*maps, line_in_space=_length(vertices[list(self.line)])))
        return f"- **{self.option}** ({' / '.join(self.choices)}): {'; '.join(measures)}."


def triangulated(polygons: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Split the quads of a mesh, in mirror images of each other on the two sides of x = 0 and of y = 0."""
    vertices, quads = polygons
    x, y, _ = vertices[quads].mean(axis=1).T
    quads = np.where((x * y > 0)[:, None], quads, np.roll(quads, 1, axis=1))
    return vertices, np.r_[quads[:, :3], quads[:, [0, 2, 3]]]


def graded_saddle() -> tuple[np.ndarray, np.ndarray]:
    """Return a saddle whose quads get narrower toward one side."""
    vertices, triangles = triangulated(meshes.saddle_quads(31))
    x = 2 * ((vertices[:, 0] + 1) / 2) ** 3 - 1
    return np.c_[x, vertices[:, 1], x**2 - vertices[:, 1] ** 2], triangles


def saddle_with_a_fine_side() -> tuple[np.ndarray, np.ndarray]:
    """Return the same saddle with every edge of one side cut into 21."""
    vertices, triangles = triangulated(meshes.saddle_quads(21))
    return meshes.with_fine_border(vertices, triangles, lambda middle: middle[0] > 0.999, 20)


def open_bulge() -> tuple[np.ndarray, np.ndarray]:
    """Return a bulge with a square hole in place of its top."""
    vertices, quads = meshes.bulge(41, 1.8)
    kept = (np.abs(vertices[quads].mean(axis=1)[:, :2]) > 0.3).any(axis=1)
    return meshes.without_unused(*triangulated((vertices, quads[kept])))


def swirled(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that hold a map whose middle is turned by 45 degrees."""
    uv = sc.parameterize(vertices, triangles).uv
    z = turned_as_seen_from_above(uv, vertices) @ [1, 1j]
    inside = np.abs(vertices[:, :2]).max(axis=1) < 0.6
    turn = np.exp(0.25j * np.pi * (np.abs(vertices[:, :2]).max(axis=1) < 0.35))
    z = np.where(inside, z * turn, z)
    return {"fixed": np.ones(len(uv), bool), "uv": np.c_[z.real, z.imag]}


def solved_in_place(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that solve the middle of that map again, with the rest held."""
    given = swirled(vertices, triangles)
    return {**given, "fixed": np.abs(vertices[:, :2]).max(axis=1) > 0.6, "polish": True}


def hilly_sheet(hill: float = 1.0, waves: float = 0.12) -> tuple[np.ndarray, np.ndarray]:
    """Return a sheet of width 1.5 with a hill at that place, and waves on its upper border."""
    x, y = np.meshgrid(np.linspace(0, 1.5, SHEET[0]), np.linspace(0, 1, SHEET[1]))
    height = 0.7 * np.exp(-9 * ((x - hill) ** 2 + (y - 0.4) ** 2))
    vertices = np.stack([x, y * (1 + waves * np.sin(7 * x)), height], axis=-1).reshape(-1, 3)
    vertices -= vertices.mean(axis=0)
    return vertices, np.concatenate([sheet_quads()[:, :3], sheet_quads()[:, [0, 2, 3]]])


def sheet_quads() -> np.ndarray:
    """Return the quads of that sheet."""
    number = np.arange(SHEET[0] * SHEET[1]).reshape(SHEET[::-1])
    corners = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    return np.stack([each.ravel() for each in corners], axis=1)


def rectangular(_vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the argument that makes the sheet a rectangle."""
    across, last = SHEET[0] - 1, SHEET[0] * SHEET[1] - 1
    return {"constraints": sc.Constraints.rectangle(triangles.tolist(), [0, across, last, last - across])}


def symmetric(_vertices: np.ndarray, _triangles: np.ndarray) -> dict[str, object]:
    """Return the argument that mirrors the left half of the sheet in its middle column."""
    number = np.arange(SHEET[0] * SHEET[1]).reshape(SHEET[::-1])
    half = SHEET[0] // 2 + 1
    pairs = zip(number[:, :half].ravel().tolist(), number[:, ::-1][:, :half].ravel().tolist())
    return {"constraints": sc.Constraints(mirrored=list(pairs))}


def pushed_in_place(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that solve a part with a push in it."""
    return {**solved_in_place(vertices, triangles), "extenders": [(*PUSHED, 0.6)]}


def squeezed(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that hold a map whose left part is squeezed."""
    uv = turned_as_seen_from_above(sc.parameterize(vertices, triangles).uv, vertices)
    low, high = uv[:, 0].min(), uv[:, 0].max()
    uv[:, 0] = low + (high - low) * ((uv[:, 0] - low) / (high - low)) ** 1.8
    return {"fixed": np.ones(len(uv), bool), "uv": uv, "as_given": True}


def u_only(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that keep the height of every point of that map, and its right end."""
    uv = squeezed(vertices, triangles)["uv"]
    right = int(uv[:, 0].argmax())
    held = np.r_[np.c_[2 * np.arange(len(uv)) + 1, uv[:, 1]], [[2 * right, uv[right, 0]]]]
    return {"constraints": sc.Constraints(held=held), "fallbacks": True}


def leaning(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that hold a map that leans by 25 degrees."""
    uv = turned_as_seen_from_above(sc.parameterize(vertices, triangles).uv, vertices)
    z = uv @ [1, 1j] * np.exp(1j * np.radians(25))
    return {"fixed": np.ones(len(uv), bool), "uv": np.c_[z.real, z.imag], "as_given": True}


def turned_upright(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, object]:
    """Return the arguments that hold that map after *Upright* by most of its edges."""
    given = leaning(vertices, triangles)
    z = given["uv"] @ [1, 1j]
    quads = z[sheet_quads()]
    z = z * np.exp(1j * angle_of_sides((np.roll(quads, -1, axis=1) - quads).ravel()))
    return {**given, "uv": np.c_[z.real, z.imag]}


ROW = tuple(range(10 * SHEET[0], 11 * SHEET[0]))
MIDDLE = tuple(range(SHEET[0] // 2, SHEET[0] * SHEET[1], SHEET[0]))
BULGE = 31
PUSHED = (15 * BULGE + 11, 15 * BULGE + 19)
EXAMPLES = (
    Example(
        "straighten",
        hilly_sheet,
        {"before": {}, "Straighten": {"constraints": sc.Constraints(horizontal=[ROW])}},
        "log2_scale",
        "Straighten",
        line=ROW,
    ),
    Example(
        "rectangle",
        hilly_sheet,
        {
            "before": {},
            "Rectangle": rectangular,
            "Grid": {"constraints": sc.Constraints.grid(sheet_quads())},
        },
        "log2_scale",
        "Rectangle and Grid",
    ),
    Example(
        "symmetric",
        hilly_sheet,
        {"before": {}, "Symmetric": symmetric},
        "log2_scale",
        "Symmetric",
        line=MIDDLE,
    ),
    Example(
        "u_only",
        hilly_sheet,
        {"before": squeezed, "U Only": u_only},
        "log2_scale",
        "U Only",
        line=ROW,
    ),
    Example(
        "turn_upright",
        hilly_sheet,
        {"before": leaning, "Upright": turned_upright},
        "log2_scale",
        "Upright",
    ),
    Example(
        "push_in_place",
        lambda: triangulated(meshes.bulge(BULGE, 1.0)),
        {"Keep in Place": solved_in_place, "Push": pushed_in_place},
        "log2_scale",
        "Push/Pull in a part",
        "distance {0.line_length:.2f}, {1.line_length:.2f}; flipped triangles {1.flips}",
        line=PUSHED,
    ),
    Example(
        "weights",
        graded_saddle,
        {"Uniform": {}, "Inverse Area": {"weights": "inverse_area"}},
        "log2_scale",
        "Weights",
    ),
    Example(
        "boundary",
        saddle_with_a_fine_side,
        {"Vertex": {"boundary": "vertex"}, "Length": {}},
        "log2_scale",
        "Boundary",
    ),
    Example(
        "hole_rigidity",
        meshes.torn_hat,
        {
            "off": {},
            "Automatic Holes": {"hole_rigidity": "automatic"},
            "Hole Rigidity 1": {"hole_rigidity": 1.0},
        },
        "log2_scale",
        "Hole Rigidity",
        "length of the brim {0.line_length:.2f}, {1.line_length:.2f}, {2.line_length:.2f}, {line_in_space:.2f} on the "
        "surface; *Automatic Holes* takes {1.hole_rigidity:.1f}",
        line=(*range(64), 0),
    ),
    Example(
        "area_blend",
        lambda: triangulated(meshes.bulge(41, 1.8)),
        {"Angle to Area 0": {}, "0.5": {"area_blend": 0.5}, "1": {"area_blend": 1.0}},
        "log2_scale",
        "Angle to Area",
    ),
    Example(
        "relax",
        lambda: triangulated(meshes.bulge(41, 1.8)),
        {
            "as it was": {},
            "relaxed, 0.5": {"relax": {"sizes": 0.5}},
            "1": {"relax": {"sizes": 1.0}},
            "1, Border Held": {"relax": {"sizes": 1.0, "hold_border": True}},
        },
        "log2_scale",
        "Spectral Relax",
    ),
    Example(
        "fold_free",
        lambda: triangulated(meshes.spiral_ramp(1.3)),
        {"off": {}, "No Overlaps": {"fold_free": True}},
        "overlapping",
        "No Overlaps",
        "overlapping triangles {0.overlaps}, {1.overlaps}",
    ),
    Example(
        "polish",
        lambda: meshes.rough_grid(14, 0.8, 1, 0.05),
        {"off": {}, "Polish": {"polish": True}},
        "log2_scale",
        "Polish",
        "worst QC {0.max_qc:.2f}, {1.max_qc:.2f}",
    ),
    Example(
        "in_place",
        lambda: triangulated(meshes.bulge(BULGE, 1.0)),
        {"before": swirled, "Keep in Place": solved_in_place},
        "log2_scale",
        "Keep in Place",
        "flipped triangles {0.flips}, {1.flips}",
    ),
    Example(
        "edge_stretch",
        lambda: triangulated(meshes.saddle_quads(31)),
        {"Edge Stretch 1": {}, "2": {"stretch": 2.0}},
        "log2_scale",
        "Edge Stretch",
        "width over height {0.oblongness:.2f}, {1.oblongness:.2f}",
    ),
    Example(
        "extenders",
        lambda: triangulated(meshes.bulge(BULGE, 1.5)),
        {"none": {}, "Push": {"extenders": [(0, BULGE**2 - 1, 2.0)]}},
        "log2_scale",
        "Push/Pull",
        "distance {0.line_length:.2f}, {1.line_length:.2f}",
        line=(0, BULGE**2 - 1),
    ),
    Example(
        "fill_holes",
        open_bulge,
        {"off": {}, "Fill Holes": {"fill_holes": True}},
        "log2_scale",
        "Fill Holes",
        "overlapping triangles {0.overlaps}, {1.overlaps}",
    ),
)


def turned_as_seen_from_above(uv: np.ndarray, vertices: np.ndarray, by_quarters: bool = False) -> np.ndarray:
    """Turn a map to lie as its mesh does, as nearly as possible; `by_quarters` keeps directions."""
    turn = np.vdot(uv @ [1, 1j], vertices[:, :2] @ [1, 1j])
    if by_quarters:
        turn = 1j ** np.round(np.angle(turn) / (np.pi / 2))
    z = (uv @ [1, 1j]) * turn / abs(turn)
    return np.c_[z.real, z.imag]


def draw(example: Example, maps: list[Map], folder: Path) -> None:
    """Draw the surface and its maps, on one scale and with one range of colors."""
    # Only here, so that the tests of the measures load no drawing.
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt
    from PIL import Image

    vertices, triangles = example.mesh()
    line = list(example.line)
    figure = plt.figure(figsize=(PANEL_INCHES * (1 + len(maps)), PANEL_INCHES), layout="constrained")
    surface = figure.add_subplot(1, 1 + len(maps), 1, projection="3d")
    surface.plot_trisurf(*vertices.T, triangles=triangles, color="lightsteelblue", edgecolor="slategrey", linewidth=0.2)
    if len(line) > 2:
        surface.plot(*vertices[line].T, color="darkorange", linewidth=2)
    surface.set_aspect("equal")
    surface.set_axis_off()
    values = [getattr(each.measured, example.colors).astype(float) for each in maps]
    reach = {"overlapping": 1.0}.get(example.colors) or np.percentile(np.abs(np.concatenate(values)), 98)
    panels, (low, high) = [], _common_frame(maps)
    for place, (each, value) in enumerate(zip(maps, values), 2):
        panel = figure.add_subplot(1, 1 + len(maps), place)
        shades = {"cmap": "coolwarm", "vmin": -reach, "vmax": reach}
        colors = panel.tripcolor(*each.uv.T, triangles, value, edgecolors="face", linewidth=0.2, **shades)
        panel.triplot(*each.uv.T, triangles, color="#00000048", linewidth=0.3)
        if line:
            panel.plot(*each.uv[line].T, color="darkorange", linewidth=2)
        panel.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        panel.set_axis_off()
        panel.set_title(each.title, fontsize=11)
        panels.append(panel)
    if example.colors != "overlapping":
        sizes = figure.colorbar(colors, ax=panels, label="size in the map", shrink=0.7)
        sizes.ax.yaxis.set_major_formatter(lambda log2_size, _: f"{2.0**log2_size:.2g} x")
    figure.get_layout_engine().set(w_pad=0.08, h_pad=0.08)
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=DPI)
    plt.close(figure)
    picture = Image.open(drawn).convert("RGB").quantize(COLORS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    picture.save(folder / f"{example.name}.png", optimize=True)


def _common_frame(maps: list[Map]) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of a box that holds all maps."""
    points = np.concatenate([each.uv for each in maps])
    margin = 0.02 * np.ptp(points, axis=0).max()
    return points.min(axis=0) - margin, points.max(axis=0) + margin


def _length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def main() -> None:
    """Draw all pictures, and print their measures for docs/benchmarks.md and their links for docs/guide.md."""
    folder = Path(sys.argv[1]) if sys.argv[1:] else IMAGES
    for example in EXAMPLES:
        maps = example.maps()
        draw(example, maps, folder)
        print(f"{example.written(maps)}\n\n![{example.shown}](images/{example.name}.png)\n")


if __name__ == "__main__":
    main()
