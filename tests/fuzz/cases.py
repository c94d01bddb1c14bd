# SPDX-License-Identifier: GPL-3.0-or-later
"""One random call of the module, and what must hold for any arguments."""

from __future__ import annotations

import copy
import dataclasses
import itertools
import warnings
from collections.abc import Sequence

import numpy as np
import spectral_conformal as sc

from tests.fuzz import random_arguments
from tests.fuzz.random_arguments import Interrupted
from tests.fuzz.random_meshes import random_mesh, random_patch

# Expected exceptions; anything else, warnings included, is a finding. TypeError is only for garbage.
EXPECTED = (ValueError, TypeError, sc.SolveError, sc.Cancelled, MemoryError, Interrupted)
TARGETS = {
    "parameterize": 24,
    "unwrap": 34,
    "Solver": 10,
    "Unwrapper": 10,
    "distortion": 8,
    "relax": 8,
    "pack": 3,
    "pattern": 3,
    "metric_from_uv": 4,
    "metric_from_direction": 4,
    "blend_metric": 2,
    "suggest_seams": 2,
    "suggest_cuts": 2,
}
# suggest_seams solves the mesh once for every cut that it tries; pack draws the outline at every turn.
SMALL = {"suggest_seams": 8, "suggest_cuts": 8, "pack": 8}


class Case:
    """Everything that (seed, number) determines."""

    def __init__(self, seed, number):
        self.rng = np.random.default_rng([seed, number])
        shares = np.array(list(TARGETS.values()), float)
        self.target = str(self.rng.choice(list(TARGETS), p=shares / shares.sum()))
        one_patch = self.target in ("parameterize", "Solver") and self.rng.random() < 0.7
        self.mesh = random_patch(self.rng) if one_patch else random_mesh(self.rng, SMALL.get(self.target))
        self.function = getattr(sc, self.target)
        self.arguments = random_arguments.random_arguments(self.rng, self.mesh, self.function)
        self.later = []
        if self.target in ("Solver", "Unwrapper"):
            solve = self.function.solve
            for _ in range(self.rng.integers(1, 4)):
                self.later.append(random_arguments.random_arguments(self.rng, self.mesh, solve))
        self.spoiled = []
        if self.rng.random() < 0.3:
            which = [self.arguments, *self.later][self.rng.integers(1 + len(self.later))]
            self.spoiled = random_arguments.spoil(self.rng, which) if which else []
        self.repeated = self.rng.random() < 0.15

    def describe(self):
        """What is called, in words."""
        lines = [f"{self.target} on {len(self.mesh.vertices)} vertices: {self.mesh.description}"]
        for arguments in (self.arguments, *self.later):
            lines.append("  with " + ", ".join(f"{name}={shortened(value)}" for name, value in arguments.items()))
        if self.spoiled:
            lines.append(f"  spoiled: {', '.join(self.spoiled)}")
        return "\n".join(lines)

    def run(self):
        """Call, check and return the outcome. Raises AssertionError, and any unexpected exception."""
        before = fingerprint([self.arguments, self.later])
        arguments = copies(self.arguments)
        outcome = self.call(self.arguments)
        assert fingerprint([self.arguments, self.later]) == before, "the call has changed its arguments"
        # A progress function may count its calls.
        if self.repeated and not any("progress" in given for given in (self.arguments, *self.later)):
            if not self.spoiled:
                random_arguments.same_in_another_form(self.rng, arguments)
            assert same(self.call(arguments), outcome), "the same call has not given the same result"
        return outcome[-1] if isinstance(outcome[-1], str) else "solved"

    def call(self, arguments):
        """Return the result of every call; a string for an expected failure."""
        if not self.later:
            return [self.checked(self.function, arguments, arguments)]
        solver = self.checked(self.function, arguments, arguments)
        if isinstance(solver, str):
            return [solver]
        return [self.checked(solver.solve, own, {**arguments, **own}) for own in self.later]

    def checked(self, function, arguments, known):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                result = random_arguments.call(function, arguments)
        except EXPECTED as error:
            assert self.spoiled or not isinstance(error, TypeError), f"sensible arguments are refused: {error}"
            assert str(error) or isinstance(error, (MemoryError, Interrupted)), "an error without a message"
            assert not isinstance(error, sc.Cancelled) or "progress" in arguments, "cancelled by nobody"
            assert not isinstance(error, sc.SolveError) or self.target in ("parameterize", "Solver"), (
                f"{self.target} must report what fails, and raised {error!r}"
            )
            return f"{type(error).__name__}: {error}"
        check = CHECKS.get(type(result).__name__, CHECKS.get(self.target))
        if check is not None:
            check(result, known)
        return result


# What must hold of a result

# The weights of the mean add up to 1 but for rounding.
LEAST_MEAN_QC = 1 - 1e-12


def check_parameterization(result, known):
    assert result.uv.shape == (len(known["vertices"]), 2)
    assert np.isfinite(result.uv).all()
    assert np.isfinite(result.eigenvalue)
    # A map that was unfolded is no eigenvector.
    # A map that was polished, unfolded, moved apart or replaced is no eigenvector.
    is_changed = result.polish_steps or result.is_embedding or np.isfinite(result.mean_qc_before)
    is_changed = is_changed or any(step.kind == "nearest_to_free" for step in result.steps)
    assert result.residual >= 0
    assert result.residual < 1e-3 or result.unfolded or is_changed
    assert isinstance(result.message, str)
    if result.method == "spectral":
        # No Overlaps under constraints may end with no injective map, and says so.
        is_told = "constraints" in known and any(s.kind in ("not_injective", "still_flipped") for s in result.steps)
        assert abs(result.turning_number) == 1 or is_told
    assert result.fallback is None or known.get("fallbacks", False) or result.is_embedding
    assert (result.fallback == "tutte_embedding") == result.is_embedding
    pins = known.get("pins") or {}
    fixed = np.asarray(known.get("fixed", []))
    n_held = len(pins) + (np.count_nonzero(fixed) if fixed.dtype == bool else fixed.size)
    kinds = {step.kind for step in result.steps}
    if known.get("fold_free") and n_held < least_held(known) and "constraints" not in known:
        assert abs(result.turning_number) == 1
        check_unfolded(result)
    else:
        assert abs(result.turning_number) == 1 or kinds & {"winds", "not_injective", "still_flipped"}
    if len(pins) > 1 and result.method == "lscm":
        for vertex, position in pins.items():
            assert tuple(result.uv[vertex]) == tuple(map(float, position)), "a pin has moved"


# Beyond it, rounding alone could have made the map.
LARGEST_QC = 1e9


def is_foldable(result):
    """Whether folds may stay: no map by straight lines has those of fans that draw an edge twice."""
    return "self-intersecting" in result.message or result.mean_qc_before > LARGEST_QC


def draw_an_edge_twice(faces, known):
    """Whether polygons are split such that two triangles have the same vertices, one the other's back.

    They need a fold as well where they share two of their edges. Quads have another split for that.
    """
    triangles, face = sc.hosts.face_triangles(known["vertices"], known["faces"], known["corner_vertices"])
    size = np.diff(np.asarray(known["faces"]).astype(np.int64))[face]
    chosen = np.isin(face, faces) & (size != 4)
    vertices = np.sort(np.asarray(known["corner_vertices"])[triangles[chosen]], axis=1)
    _, which, count = np.unique(vertices, axis=0, return_inverse=True, return_counts=True)
    # Two triangles that are faces themselves are duplicates, of which the chart has one.
    return bool((count[which.ravel()][size[chosen] > 4] > 1).any())


def least_held(known):
    """The number of pins from which they may hold a fold in place, which a step says. Fewer only place the map."""
    return 2 if known.get("method") == "lscm" else 3


def says_folded(chart):
    return any(step.kind in ("still_flipped", "folds") for step in chart.steps)


def has_details_of_rounding(faces, uv, known):
    """Whether rounding alone could fold triangles of LARGEST_QC: of a chart or map that large, with edges that short.

    Pins may make the map small.
    """
    offsets, vertices = known["faces"], np.asarray(known["vertices"])[known["corner_vertices"]]
    corners = [range(offsets[face], offsets[face + 1]) for face in faces]
    edges = np.concatenate([np.linalg.norm(vertices[c] - np.roll(vertices[c], 1, axis=0), axis=1) for c in corners])
    extent = max(edges.max(), np.ptp(uv[np.concatenate(corners)], axis=0).max())
    return edges[edges > 0].min() < LARGEST_QC * np.finfo(float).eps * extent


def check_unfolded(result):
    assert "could not be unfolded in double precision" not in result.message or is_foldable(result)


def check_unwrap(result, known):
    corners = len(known["corner_vertices"])
    offsets = np.asarray(known["faces"]).astype(np.int64)
    assert result.uv.shape == (corners, 2)
    assert np.isfinite(result.uv).all()
    assert not result.uv[~result.solved_corners].any()
    faces = [np.flatnonzero(result.chart_of_face == i) for i in range(len(result.charts))]
    selected = known.get("selected_faces")
    inside = np.ones(len(offsets) - 1, bool) if selected is None else np.asarray(selected)
    assert ((result.chart_of_face >= 0) == inside).all()
    solved = np.zeros(corners, bool)
    for chart, its_faces in zip(result.charts, faces):
        assert np.array_equal(chart.faces, its_faces)
        check_chart(chart)
        is_point = chart.status == "solved" and "its map is a point" in chart.message
        if is_point:
            places = [result.uv[offsets[face] : offsets[face + 1]] for face in its_faces]
            assert not np.ptp(np.concatenate(places), axis=0).any()
        # No Overlaps leaves the vertices of constraints where they are.
        may_stay = "constraints" in known or chart.n_pins >= least_held(known) or is_point
        may_stay = may_stay or (says_folded(chart) and has_details_of_rounding(its_faces, result.uv, known))
        if known.get("fold_free") and chart.status == "solved" and not may_stay:
            is_unfolded = (chart.flipped, abs(chart.turning_number)) == (0, 1)
            if is_unfolded or not draw_an_edge_twice(its_faces, known):
                assert is_unfolded or is_foldable(chart)
                check_unfolded(chart)
        for face in its_faces if chart.status == "solved" else []:
            solved[offsets[face] : offsets[face + 1]] = True
    assert np.array_equal(solved, result.solved_corners)


def check_chart(chart):
    numbers = (chart.eigenvalue, chart.residual, chart.mean_qc, chart.max_qc)
    if chart.status == "failed":
        assert chart.message.endswith(".")
        assert np.isnan(numbers).all()
        return
    assert np.isfinite(numbers[:2]).all()
    assert not np.isnan(numbers).any()
    assert chart.mean_qc >= LEAST_MEAN_QC
    assert 0 <= chart.flipped <= len(chart.faces)


def check_relaxed(result, known):
    given = np.asarray(known["uv"], float).reshape(-1, 2)
    assert result.uv.shape == given.shape
    assert np.isfinite(result.uv).all()
    if "fixed" in known:
        stays = np.asarray(known["fixed"], bool).ravel()
        assert np.array_equal(result.uv[stays], given[stays]), "a fixed corner has moved"
    energies = np.array((result.energy_before, result.energy))
    # Infinite if all is collapsed, or flipped triangles cancel the area of others; 0 if nothing can move.
    assert np.isfinite(energies).all() or (not np.isnan(energies).any() and result.flipped > 0)
    assert (energies >= (2 + 2 * known.get("sizes", 0.5)) * (1 - 1e-9)).all() or not energies.any()
    assert 0 <= result.steps <= known["max_steps"]
    assert 0 <= result.flipped <= len(result.face_offsets) - 1
    before, after = (int(sc.map_defects(each).overlapping.sum()) for each in (result.with_uv(given), result))
    assert after <= before, f"{before} overlapping triangles have become {after}"


def check_packed(result, known):
    given = np.asarray(known["uv"], float).reshape(-1, 2)
    count = len(result.has_room)
    assert result.motions.shape == (count, 2, 3)
    assert np.isfinite(result.motions).all()
    assert ((result.islands >= -1) & (result.islands < count)).all()
    assert ((result.stack >= 0) & (result.stack < count)).all()
    assert np.isfinite(result.scale)
    assert result.fill >= 0
    moved = np.append(result.has_room, False)[result.islands]
    moves = np.repeat(moved, np.diff(result.face_offsets))
    assert np.isfinite(result.uv[moves]).all()
    assert np.array_equal(result.uv[~moves], given[~moves], equal_nan=True), "a corner that stays has moved"


def check_pattern(result, known):
    count = len(result.points)
    assert result.outlines[0] == result.sides[0] == 0 and result.outlines[-1] == result.sides[-1] == count
    assert (np.diff(result.outlines) > 0).all() and (np.diff(result.sides) > 0).all()
    assert np.isin(result.outlines, result.sides).all(), "an outline begins within a side"
    numbers, sides = np.unique(result.seams, return_counts=True)
    assert (sides[numbers > 0] > 1).all(), "a seam with one side"
    assert np.array_equal(numbers[numbers > 0], np.arange(1, 1 + (numbers > 0).sum()))


def check_distortion(result, known):
    n = len(np.asarray(known["triangles"]))
    for values in (result.qc, result.log2_scale, result.flipped, result.overlapping):
        assert values.shape == (n,)
    assert (result.qc >= 1).all()
    for number in (result.mean_qc, result.p95_qc, result.p99_qc, result.max_qc):
        assert number >= LEAST_MEAN_QC or n == 0
    assert not np.isnan(result.log2_scale).any()


def check_metric(result, known):
    assert result.ndim == 3
    assert np.isfinite(result).all()
    assert np.array_equal(result, result.transpose(0, 2, 1))
    assert (np.trace(result, axis1=1, axis2=2) > 0).all()


def check_seams(result, known):
    seams = known.get("seam_edges")
    kept = 0 if seams is None else len(np.asarray(seams))
    is_list = isinstance(result, list)
    edges = np.concatenate([np.zeros((0, 2), np.int32), *result]) if is_list else result.seam_edges[kept:]
    assert edges.dtype == np.int32
    assert edges.shape[1:] == (2,)
    found = [(int(a), int(b)) for a, b in edges]
    assert all(a < b for a, b in found)
    assert len(set(found)) == len(found), "a seam twice"
    offsets = np.asarray(known["faces"]).astype(np.int64)
    corners = np.asarray(known["corner_vertices"]).astype(np.int64)
    following = np.arange(1, len(corners) + 1)
    filled = offsets[1:] > offsets[:-1]
    following[offsets[1:][filled] - 1] = offsets[:-1][filled]
    sides = {(min(a, b), max(a, b)) for a, b in zip(corners.tolist(), corners[following].tolist())}
    assert set(found) <= sides, "a seam that is no edge"
    given = set() if seams is None else {(min(a, b), max(a, b)) for a, b in np.asarray(seams).tolist()}
    assert not set(found) & given, "a seam that the mesh had"


CHECKS = {
    "Parameterization": check_parameterization,
    "Unwrap": check_unwrap,
    "Distortion": check_distortion,
    "Pattern": check_pattern,
    "RelaxedMap": check_relaxed,
    "PackedMap": check_packed,
    "metric_from_uv": check_metric,
    "metric_from_direction": check_metric,
    "blend_metric": check_metric,
    "suggest_seams": check_seams,
    "suggest_cuts": check_seams,
}


# Comparing


def fingerprint(value):
    """Something that is equal for equal arguments, bit for bit."""
    if isinstance(value, dict):
        return [(key, fingerprint(item)) for key, item in value.items()]
    if isinstance(value, (list, tuple)):
        return [type(value), [fingerprint(item) for item in value]]
    if type(value) is np.ndarray:
        if 0 in value.strides:
            return (value.shape, value.strides, value.dtype.str)
        return (value.shape, value.strides, value.dtype.str, value.tobytes())
    return repr(value)


def copies(arguments):
    """Arguments that share no array with the given ones."""
    return {name: value.copy() if own_array(value) else value for name, value in arguments.items()}


def own_array(value):
    return type(value) is np.ndarray and 0 not in value.strides and value.dtype != object


def same(left, right):
    """Whether two results agree bit for bit, except for times and kept maps."""
    if dataclasses.is_dataclass(left):
        names = [field.name for field in dataclasses.fields(left) if field.name not in ("timings", "reused")]
        return type(left) is type(right) and all(same(getattr(left, n), getattr(right, n)) for n in names)
    if isinstance(left, np.ndarray):
        return left.shape == right.shape and left.tobytes() == right.tobytes()
    if isinstance(left, Sequence) and not isinstance(left, str):
        return len(left) == len(right) and all(itertools.starmap(same, zip(left, right)))
    if isinstance(left, float):
        return left == right or (left != left and right != right)
    return left == right


def shortened(value):
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}"
    try:
        text = repr(copy.copy(value)) if not callable(value) else getattr(value, "__name__", "callable")
    except TypeError:  # views of dictionaries
        text = repr(value)
    return text if len(text) < 100 else text[:100] + "..."
