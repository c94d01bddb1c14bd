"""The figures of speed, each with its goal: ratios within one run, seconds, gigabytes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tests.benchmarks import operator_scenes, peers, runs
from tests.benchmarks.generated import Mesh, Scene
from tests.benchmarks.runs import Figures, NotMeasured

SIZES = ("44k", "134k", "535k")
EXTENDER_VERTICES, SEAM_SIDE, PIN_SIDE = 50_000, 316, 221
# Islands along each side of the grid, by the case.
SEAM_PARTS = {"100k, one island": 1, "100k, 16 islands": 4}
# With this many subdivisions, Suzanne has 126,000 vertices.
SUZANNE_SUBDIVISIONS = 4
# Of generated_assets.py, for the batch: much of noise, and many pieces.
MILLION = ("torn terrain", "blobs, 600")


@dataclass
class Measured:
    """Measurements, made on first use and kept.

    Attributes:
        scale: of the numbers of vertices.
        blender: name of the Blender for the operator.
        bff: BFF's program.
        seconds: how long a scene is repeated in Blender.
        all: the results, by measurement and arguments.
    """

    scale: float = 1.0
    blender: str = runs.BLENDER
    bff: str | None = None
    seconds: float = operator_scenes.SECONDS
    all: dict[str, Figures] = field(default_factory=dict)

    def operator(self, scene: str, methods: Sequence[str] = ("CONFORMAL",)) -> Figures:
        """Return the figures of our operator, and of Blender's with the `methods`, in a scene by its name."""
        made = operator_scenes.SCENES[scene].scaled(self.scale)
        options = operator_scenes.options_of(made, {"methods": methods, "seconds": self.seconds})
        return self._in_blender("operators", scene, made, **options)

    def pins(self) -> Figures:
        """Return the figures of a moved pin."""
        return self._in_blender("pins", "grid", Scene(PIN_SIDE).scaled(self.scale))

    def suggested_seams(self) -> Figures:
        """Return the figures of seams suggested for Suzanne."""
        subdivisions = max(0, SUZANNE_SUBDIVISIONS + math.floor(math.log(self.scale, 4)))
        return self._in_blender("suggested_seams", "Suzanne", None, subdivisions=subdivisions)

    def module(self, measurement: str, size: str) -> Figures:
        """Return the figures of the module on the triangles of a patch of this size."""
        side = operator_scenes.SCENES[f"grid-{size}"].side
        return self._native(measurement, size, Scene(side, is_triangulated=True).scaled(self.scale).meshes())

    def bff_seconds(self, size: str) -> float:
        """Return BFF's seconds on the same triangles."""
        side = operator_scenes.SCENES[f"grid-{size}"].side
        meshes = Scene(side, is_triangulated=True).scaled(self.scale).meshes() if self.bff else []
        return _seconds(
            self._native("peer", f"{peers.BFF} {size}", meshes, name=peers.BFF, program=self.bff) if meshes else _NO_BFF
        )

    def extender_change(self) -> Figures:
        """Return the figures of a changing extender."""
        return self._native("extender_change", "disk", (), n=max(100, round(EXTENDER_VERTICES * self.scale)))

    def seam_change(self, parts: int) -> Figures:
        """Return the figures of a seam that grows in a grid of `parts` times `parts` islands."""
        meshes = Scene(SEAM_SIDE).scaled(self.scale).meshes()
        return self._native("seam_change", f"grid of {parts**2}", meshes, parts=parts)

    def batch(self, name: str) -> Figures:
        """Return the figures of the batch on a generated mesh of a million faces."""
        return self._native("batch", name, (), name=name, faces=round(1e6 * self.scale))

    def _in_blender(self, measurement: str, what: str, scene: Scene | None, **options: object) -> Figures:
        return self._kept("operator_scenes", measurement, what, scene.meshes() if scene else (), options, self.blender)

    def _native(self, measurement: str, what: str, meshes: Sequence[Mesh], **options: object) -> Figures:
        return self._kept("native_solver", measurement, what, meshes, options, None)

    def _kept(
        self, script: str, measurement: str, what: str, meshes: Sequence[Mesh], options: Figures, blender: str | None
    ) -> Figures:
        key = f"{measurement}: {what}"
        if key not in self.all:
            self.all[key] = runs.run(script, measurement, options, meshes, blender)
        return self.all[key]


_NO_BFF = {"reason": "give BFF by --bff PROGRAM"}


def _seconds(found: Figures) -> float:
    if "reason" in found:
        raise NotMeasured(found["reason"])
    return found["seconds"]


@dataclass(frozen=True)
class Row:
    """A row of the table.

    Attributes:
        name: for the command line.
        what: what is measured.
        unit: of the figures; "times" for ratios.
        reach: the goal, by the case.
        figure: makes the figure of a case.
        is_more_better: whether the goal is a minimum instead of a maximum.
        beside: what the reader of a measured figure has to know, printed after it.
    """

    name: str
    what: str
    unit: str
    reach: dict[str, float]
    figure: Callable[[Measured, str], float]
    is_more_better: bool = False
    beside: Callable[[Measured, str], str] = lambda _measured, _case: ""

    def is_reached(self, case: str, figure: float) -> bool:
        """Return whether a figure reaches its goal."""
        return figure >= self.reach[case] if self.is_more_better else figure <= self.reach[case]


def _conformal_over_ours(measured: Measured, scene: str) -> float:
    found = measured.operator(scene)
    return found["methods"]["CONFORMAL"] / found["seconds"]


def _over_bare(measured: Measured, size: str) -> float:
    found = measured.module("parameterize", size)
    if "no_bare" in found:
        raise NotMeasured(found["no_bare"])
    return found["seconds"] / (found["bare_analyze"] + found["bare_factorize"])


def _on_blas(measured: Measured, size: str) -> str:
    found = measured.module("parameterize", size)
    return f"; {found['threads']} threads, CHOLMOD {found['bare_threads']}, both on {found['blas']}"


def _over_bff(measured: Measured, size: str) -> float:
    seconds = measured.bff_seconds(size)
    return measured.module("parameterize", size)["seconds"] / seconds


def _unwrap_over_parameterize(measured: Measured, size: str) -> float:
    found = measured.module("unwrap", size)
    return found["unwrap"] / found["parameterize"]


def _busy_over_idle(measured: Measured, size: str) -> float:
    found = measured.module("busy", size)
    return found["busy"] / found["idle"]


def _growth(measured: Measured, _case: str) -> float:
    first, last = (measured.module("parameterize", size) for size in (SIZES[0], SIZES[-1]))
    return math.log(last["seconds"] / first["seconds"]) / math.log(last["vertices"] / first["vertices"])


def _million(measured: Measured, case: str) -> float:
    found = measured.operator("grid-1M", ())
    if case == "peak, GB":
        return found["peak_megabytes"] / 1e3
    return found["seconds"] / measured.operator("grid-535k")["seconds"]


def _extender_change(measured: Measured, _case: str) -> float:
    found = measured.extender_change()
    if "no_bare" in found:
        raise NotMeasured(found["no_bare"])
    return found["seconds"] / found["back_substitution"]


def _seam_change(measured: Measured, case: str) -> float:
    found = measured.seam_change(SEAM_PARTS[case])
    return found["again"] / found["whole"]


def _batch(measured: Measured, case: str) -> float:
    found = measured.batch(next(name for name in MILLION if case.startswith(name)))
    if case.endswith("GB"):
        return found["gigabytes"]
    return sum(found["seconds"][phase] for phase in ("seams", "solve", "pack"))


ROWS = (
    Row(
        "patch",
        "operator, one patch: Blender's CONFORMAL over ours",
        "times",
        {"grid-44k": 12, "grid-134k": 20, "grid-535k": 32, "scan-44k": 12, "scan-134k": 22, "scan-535k": 32},
        _conformal_over_ours,
        is_more_better=True,
    ),
    Row(
        "scenes",
        "operator, small and many patches: Blender's CONFORMAL over ours",
        "times",
        {"islands-1000": 4, "objects-500": 1.5, "objects-10": 3, "islands-6": 6, "grid-529": 1.5, "among-10000": 1},
        _conformal_over_ours,
        is_more_better=True,
    ),
    Row(
        "smallest",
        "operator, one island of 36 vertices",
        "ms",
        {"grid-36": 1},
        lambda measured, scene: 1e3 * measured.operator(scene)["seconds"],
    ),
    Row(
        "cholmod",
        "`parameterize` over one bare CHOLMOD analyze + factorize",
        "times",
        # A third to a half of the time goes to charts and the eigenproblem. Half of CHOLMOD and less is what one
        # measures if CHOLMOD runs on the reference BLAS, as Debian's own does.
        {"44k": 0.7, "134k": 0.7, "535k": 0.6},
        _over_bare,
        beside=_on_blas,
    ),
    Row(
        "bff",
        "`parameterize` over BFF",
        "times",
        {"44k": 0.4, "134k": 0.35, "535k": 0.25},
        _over_bff,
        beside=lambda measured, _case: f"; BFF on {peers.solver(peers.BFF, measured.bff)}",
    ),
    Row("unwrap", "`unwrap` over `parameterize`", "times", {"535k": 1.1}, _unwrap_over_parameterize),
    Row(
        "python",
        "Python around the native call, operator",
        "s",
        {"grid-44k": 0.04, "grid-535k": 0.5},
        lambda measured, scene: measured.operator(scene)["python_seconds"],
    ),
    Row(
        "busy",
        "`parameterize` while other processes keep all cores busy, over idle",
        "times",
        {"535k": 3},
        _busy_over_idle,
    ),
    Row(
        "memory",
        "peak memory, operator, Blender included",
        "GB",
        {"grid-535k": 2},
        lambda measured, scene: measured.operator(scene)["peak_megabytes"] / 1e3,
    ),
    Row("growth", "exponent of growth, `parameterize`", "", {"44k to 535k": 1.15}, _growth),
    Row("million", "operator, a million vertices", "", {"over the seconds of 535k": 2.4, "peak, GB": 5}, _million),
    Row("extender", "extender change with a kept factor, in back-substitutions", "", {"50k": 2}, _extender_change),
    Row(
        "pins",
        "live pin, 48,400 faces",
        "s",
        {"first": 0.15, "later": 0.05},
        lambda measured, case: measured.pins()[case],
    ),
    Row(
        "seam",
        "`unwrap` again after one seam has changed, over the whole",
        "times",
        dict.fromkeys(SEAM_PARTS, 0.4),
        _seam_change,
    ),
    Row(
        "suggest",
        "suggest seams, 126k vertices",
        "s",
        {"Suzanne": 2},
        lambda measured, _case: measured.suggested_seams()["seconds"],
    ),
    Row(
        "batch",
        "batch, a million faces: seams, unwrap and pack",
        "",
        {f"{name}, {what}": most for name in MILLION for what, most in (("s", 30.0), ("peak, GB", 3.0))},
        _batch,
    ),
)
