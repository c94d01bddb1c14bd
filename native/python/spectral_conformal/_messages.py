"""Messages about maps, in English or, through their templates, in another language."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Literal, Optional

StepKind = Literal[
    "rejected",
    "retried",
    "winds",
    "lowered_rigidity",
    "clamped_thin",
    "by_length",
    "by_vertex",
    "uniform_weights",
    "inverse_area",
    "relaxed_with_flips",
    "blended_little",
    "embedded",
    "unfolded",
    "moved_apart",
    "moved_apart_embedded",
    "covers_itself",
    "still_flipped",
    "nearest_to_free",
    "folds",
    "unmet_constraints",
    "not_injective",
    "unresolved_triangles",
    "reoriented_faces",
    "duplicate_faces",
    "fan_splits",
    "degenerate_triangles",
    "shrunk_to_point",
    "degenerate_faces",
    "out_of_memory",
]
Reason = Optional[
    Literal[
        "not_factorized",
        "not_converged",
        "not_finite",
        "collapsed",
        "unresolved",
        "no_area",
        "winding",
        "folded",
        "no_embedding",
        "too_large",
        "library_failed",
        "no_cholmod",
        "vertex_not_finite",
        "not_orientable",
        "closed",
        "handles",
        "no_extent",
        "border_of_two",
        "no_surface",
        "degenerate_face",
        "no_faces",
        "non_manifold_edges",
        "several_components",
        "bow_ties",
        "too_many_vertices",
        "too_many_faces",
        "too_many_corners",
        "too_many_seam_edges",
        "offsets_decrease",
        "offsets_not_from_zero",
        "corner_of_no_vertex",
        "seam_of_no_vertex",
        "not_triangle",
        "uv_not_finite",
        "pinned_uv_not_finite",
        "metric_not_positive",
        "loop_without_length",
        "unused_pinned_vertex",
        "unused_extender_vertex",
        "pins_at_one_position",
        "too_many_pins",
        "method_without_pins",
        "method_without_extenders",
        "method_without_constraints",
        "constraints_join_vertices",
        "constraints_flatten_triangle",
    ]
]
Constraint = Optional[Literal["pins", "extenders", "rigidity", "extenders_and_rigidity", "linear"]]
Translate = Callable[[str], str]


@dataclass(frozen=True)
class Step:
    """An extra action of a solve, a property of its map, or the reason why there is no map.

        The kind determines which fields have a meaning;
    `hosts.describe` puts a step into words.
    """

    kind: StepKind
    """"rejected": a map was not accepted; the next step says what replaced it, and without one there is no map. Steps
    to a map: "retried" at the same problem, the "lowered_rigidity" of holes, "clamped_thin", "by_length", "by_vertex",
    "uniform_weights" and "inverse_area" (fallbacks), "embedded", "unfolded", "moved_apart", "moved_apart_embedded", and
    under constraints "nearest_to_free".
    Properties of a map: it "winds", "folds" (pulled or constrained, it has flipped triangles), "covers_itself", is
    "still_flipped" or "not_injective", has "unresolved_triangles" or "unmet_constraints".
    Of the area blend: "relaxed_with_flips", "blended_little". Of faces: "reoriented_faces", "duplicate_faces",
    "fan_splits", "degenerate_triangles". Of charts: "shrunk_to_point", "degenerate_faces", "out_of_memory"."""
    reason: Reason = None
    """Why a map was rejected, or the condition that the input violates."""
    count: int = 0
    """Of triangles, faces or handles; the vertex, face, corner or edge that violates a condition; the turning number of
    a map that winds; the status of a library that failed."""
    attempts: int = 0
    """At the problem whose map was rejected."""
    before: float = 0.0
    """Mean QC before unfolding or moving apart, NaN without a map; the requested hole rigidity; the spread of scale
    (log2) of the conformal map."""
    after: float = 0.0
    """The same afterward; for "not_factorized" the last shift."""
    constraint: Constraint = None
    """The possible cause of the problem."""
    relaxation: str | None = None
    """How the relaxation of an area blend ended, see `Parameterization.relaxation`."""
    index: int = 0
    """The vertex that a corner or edge refers to, or the face of a UV that is not finite."""
    limit: int = 0
    """How many vertices there are, or how many elements a mesh may have."""


# A template for the count 1 and, if it differs, a template for other counts.
_SENTENCES: dict[str, tuple[str, ...]] = {
    "retried": ("The first solve failed its checks and was repeated with a larger shift and another start.",),
    "winds": ("The boundary of the map winds around {count} times instead of once.",),
    "lowered_rigidity": ("Hole rigidity lowered from {before} to {after}, the most that the island allows.",),
    "relaxed_with_flips": (
        "{count} triangle of the relaxed map could not be unfolded.",
        "{count} triangles of the relaxed map could not be unfolded.",
    ),
    "embedded": (
        "The folds left no room to unfold them: replaced by an embedding, relaxed without folding it; angles are off "
        "by {after} % on average, {before} % before.",
    ),
    "unfolded": (
        "{count} flipped triangle unfolded; angles are off by {after} % on average, {before} % before.",
        "{count} flipped triangles unfolded; angles are off by {after} % on average, {before} % before.",
    ),
    "moved_apart": (
        "Parts that covered each other moved apart; angles are off by {after} % on average, {before} % before.",
    ),
    "moved_apart_embedded": (
        "Parts that covered each other came apart in an embedding, relaxed without folding it; angles are off by "
        "{after} % on average, {before} % before.",
    ),
    "moved_apart_without_map": ("Parts that covered each other moved apart; angles are off by {after} % on average.",),
    "covers_itself": ("The island still covers itself somewhere; add seams.",),
    "still_flipped": (
        "{count} triangle could not be unfolded in double precision; add seams that make the island flatter.",
        "{count} triangles could not be unfolded in double precision; add seams that make the island flatter.",
    ),
    "still_flipped_between_pins": (
        "{count} triangle could not be unfolded between the pins; move or remove pins.",
        "{count} triangles could not be unfolded between the pins; move or remove pins.",
    ),
    "still_flipped_beside_constraints": (
        "{count} triangle could not be unfolded beside straight edges and other constraints; remove some of them.",
        "{count} triangles could not be unfolded beside straight edges and other constraints; remove some of them.",
    ),
    # The count 1 : the turning number is right.
    "nearest_to_free": (
        "Under the constraints, the map of least energy has flipped triangles; the one nearest to the unconstrained "
        "map replaces it.",
        "Under the constraints, the map of least energy winds around {count} times; the one nearest to the "
        "unconstrained map replaces it.",
    ),
    "unmet_constraints": (
        "{count} edge does not meet its constraint, because the UVs held there contradict it; hold fewer of them.",
        "{count} edges do not meet their constraints, because the UVs held there contradict them; hold fewer.",
    ),
    # The count 1 : the turning number is right.
    "not_injective": (
        "The map goes around an inner vertex more than once; add seams.",
        "The boundary of the map winds around {count} times instead of once; add seams.",
    ),
    "not_injective_between_pins": (
        "The map goes around an inner vertex more than once; move or remove pins.",
        "The boundary of the map winds around {count} times instead of once; move or remove pins.",
    ),
    "not_injective_beside_constraints": (
        "The map goes around an inner vertex more than once; remove straight edges or other constraints.",
        "The boundary of the map winds around {count} times instead of once; remove straight edges or other "
        "constraints.",
    ),
    "unresolved_triangles": (
        "{count} triangle shrinks below what double precision resolves; add seams that make the island flatter.",
        "{count} triangles shrink below what double precision resolves; add seams that make the island flatter.",
    ),
    "reoriented_faces": (
        "{count} face wound the other way: reoriented.",
        "{count} faces wound the other way: reoriented.",
    ),
    "duplicate_faces": (
        "{count} duplicate face: placed on the first one with the same vertices.",
        "{count} duplicate faces: placed on the first ones with the same vertices.",
    ),
    "fan_splits": (
        "{count} self-intersecting polygon: split as a fan.",
        "{count} self-intersecting polygons: split as a fan.",
    ),
    "degenerate_triangles": (
        "{count} degenerate triangle: given a minimal height.",
        "{count} degenerate triangles: given a minimal height.",
    ),
    "shrunk_to_point": ("The island has no area: its map is a point.",),
    "degenerate_faces": (
        "Faces with fewer than three different vertices, or with the same vertex twice in a row, cannot be unwrapped; "
        "delete them or merge their vertices.",
    ),
    "out_of_memory": (
        "There is too little memory for this island of {count} face; close other programs.",
        "There is too little memory for this island of {count} faces; close other programs, or cut it into smaller "
        "ones with seams.",
    ),
}
# The consequences that follow the reason for a rejected map.
_STAND_INS: dict[str, tuple[str, ...]] = {
    "clamped_thin": ("solved instead with thin triangles raised to a height of 1e-5 of their length.",),
    "by_length": ("solved with the boundary form 'length' instead.",),
    "by_vertex": ("solved with the boundary form 'vertex' instead.",),
    "uniform_weights": ("solved with the weights 'uniform' instead.",),
    "inverse_area": ("solved with the weights 'inverse_area' instead.",),
    "embedded": ("replaced by an embedding, relaxed without folding it; angles are off by {after} % on average.",),
    "moved_apart_embedded": (
        "replaced by an embedding that does not cover itself, relaxed without folding it; angles are off by {after} % "
        "on average.",
    ),
    "unfolded": _SENTENCES["unfolded"],
}
_LITTLE = "The area blend evened out sizes only a little: they vary by {after} %, {before} % before"
_NOT_LOWERED = "The area blend did not even out sizes: they vary by {after} %, {before} % before"
_RELAXATIONS = {
    "converged": "{blend}. Add seams, or clean up degenerate faces.",
    "factorization_limit": (
        "{blend}. Its relaxation reached its limit of factorizations; add seams, or clean up degenerate faces."
    ),
    "stalled": (
        "{blend}. Flipped or degenerate triangles stopped its relaxation; add seams, or clean up degenerate faces."
    ),
    "failed": "{blend}. Its relaxation failed; add seams, or clean up degenerate faces.",
}
_REASONS = {
    "not_factorized": (
        "The conformal energy could not be factorized, even with a shift of {after} of the boundary form"
    ),
    "not_converged": "The eigenvalue iteration did not converge",
    "not_finite": "The map is not finite",
    "collapsed": "The map shrinks the boundary to a point",
    "unresolved": ("The triangles differ so much in size or shape that double precision does not resolve the map"),
    "no_area": "The map has no positive area",
    "winding": "The boundary of the map winds around {count} times instead of once",
    "folded": "The map folds over at {count} of its triangles",
    "no_embedding": "No embedding into a circle could be solved for in double precision",
    "too_large": "The island is too large: its factor would have more than {count} entries",
    "library_failed": "CHOLMOD reported status {count}",
}
_PINNED_REASONS = {
    "not_factorized": "The pinned conformal energy is singular in double precision",
    "not_finite": "The pinned map is not finite",
    "collapsed": "The pinned map shrinks the boundary to a point",
    "unresolved": "The pinned map does not satisfy its equations in double precision",
    "no_area": "The pinned map has no positive area",
}
# Conditions that a chart violates, and what to do.
_CONDITIONS: dict[str, tuple[str, ...]] = {
    "vertex_not_finite": (
        "Vertex {count} has a coordinate that is not finite; give it a valid position or delete it.",
    ),
    "not_orientable": ("The island is non-orientable, like a Moebius strip; cut it with a seam.",),
    "closed": (
        "The island is closed, with {count} handle: it has no boundary to unfold from; mark seams that cut it open.",
        "The island is closed, with {count} handles: it has no boundary to unfold from; mark seams that cut it open.",
    ),
    "closed_without_handles": (
        "The island is closed: it has no boundary to unfold from; mark seams that cut it open.",
    ),
    "handles": (
        "The island has {count} handle and cannot lie flat without overlap; mark seams that cut the handle open.",
        "The island has {count} handles and cannot lie flat without overlap; mark seams that cut the handles open.",
    ),
    "no_extent": (
        "The island has no extent that double precision can hold: all of its vertices coincide or lie too far apart; "
        "delete or rescale it.",
    ),
    "border_of_two": (
        ("The island's boundary has only two vertices, so no map can open between them; mark more seams."),
    ),
    "no_surface": ("The island has no area: its vertices lie on one line; delete it or move them apart.",),
}
# Conditions that a mesh, its arrays or other arguments violate.
_VIOLATIONS = {
    "degenerate_face": "Face {count} has fewer than three different vertices; remove it.",
    "no_faces": "The mesh has no faces; there is nothing to parameterize.",
    "non_manifold_edges": "Edges with three or more faces: {count}; split the mesh there, or use unwrap, which does.",
    "several_components": (
        "The mesh has {count} separate components; pass one at a time, or use unwrap, which takes them all."
    ),
    "bow_ties": (
        "Vertices where parts of the boundary touch (bow ties): {count}; split them, or use unwrap, which does."
    ),
    "too_many_vertices": (
        "The mesh has {count} vertices; at most {limit} can be numbered. Split it into several meshes."
    ),
    "too_many_faces": "The mesh has {count} faces; at most {limit} can be numbered. Split it into several meshes.",
    "too_many_corners": (
        "The mesh has {count} face corners; at most {limit} can be numbered. Split it into several meshes."
    ),
    "too_many_seam_edges": (
        "The mesh has {count} seam edges; at most {limit} can be numbered. Split it into several meshes."
    ),
    "offsets_decrease": "face_offsets must not decrease, but they do after face {count}.",
    "offsets_not_from_zero": "face_offsets must start with 0.",
    "corner_of_no_vertex": "Corner {count} refers to vertex {index}, but there are {limit} vertices.",
    "seam_of_no_vertex": "Seam edge {count} refers to vertex {index}, but there are {limit} vertices.",
    "not_triangle": "Face {count} is not a triangle.",
    "uv_not_finite": (
        "The UV of corner {count} (face {index}) is not finite; leave its face out of the selection or give it "
        "coordinates."
    ),
    "pinned_uv_not_finite": "A pinned UV of face {count} is not finite; unpin it or give it a valid position.",
    "metric_not_positive": (
        "The metric of face {count} is not positive definite in double precision; both of its eigenvalues must be "
        "positive."
    ),
    "loop_without_length": "The island's longest boundary loop has no length; clean up its coincident vertices.",
    "unused_pinned_vertex": "Vertex {count} is pinned, but no triangle uses it.",
    "unused_extender_vertex": "Vertex {count} has an extender, but no triangle uses it.",
    "pins_at_one_position": "All pins have the same position, so the map would shrink to a point; move one of them.",
    "too_many_pins": "The mesh has too many vertices with several pins; unpin some.",
    "method_without_pins": (
        "The methods 'fiedler' and 'area' hold at most two pins; use 'spectral' or 'lscm', or remove all pins but two."
    ),
    "no_cholmod": "This build has no CHOLMOD; install SuiteSparse and build again, or use 'eigen'.",
    "method_without_extenders": (
        "Extenders and hole rigidity need the method 'spectral'; hole rigidity also needs a map that nothing holds, "
        "so make the pins soft."
    ),
    "method_without_constraints": "Straight edges and other constraints need the method 'spectral'.",
    "constraints_join_vertices": (
        "The constraints give vertices {count} and {index} of one edge the same position; remove one of them."
    ),
    "constraints_flatten_triangle": (
        "The constraints put all corners of the triangle of vertices {count}, {index} and {limit} on one line; remove "
        "one of them."
    ),
}
# Steps whose numbers are distortions, and the one whose numbers are spreads of the scale : in percent.
_ANGLES = {"embedded", "unfolded", "moved_apart", "moved_apart_embedded"}
_SIZES = "blended_little"
_REPEATED = "{reason}, in {attempts} attempts with different shifts and starts"
_ADVICE = {
    "too_large": "cut it into smaller islands with seams.",
    "library_failed": "please report this with the mesh.",
    "no_embedding": "add seams that make the island flatter.",
    "not_factorized": (
        "the island has too many degenerate triangles; merge vertices by distance or dissolve degenerate faces."
    ),
    "": "add seams that make the island flatter, or clean up degenerate faces.",
    "pins not_factorized": (
        "the island has degenerate triangles or pins that coincide in 3D; clean the mesh or pin other vertices."
    ),
    "pins collapsed": "pin other vertices, or merge vertices by distance.",
    "pins no_area": "use the spectral method, or pin other vertices.",
    "pins folded": "move or remove pins.",
    "pins": "clean up degenerate faces, cut an island that is very long, or pin other vertices.",
    "rigidity": "lower the hole rigidity.",
    "extenders": "weaken or remove extenders (Push/Pull).",
    "extenders_and_rigidity": "weaken or remove extenders (Push/Pull), or lower the hole rigidity.",
    "linear": "remove straight edges or other constraints, or clean up degenerate faces.",
}
_JOINED = "{reason}: {consequence}"
# Of a RuntimeError.
REENTERED = "This object waits for the progress function that calls it; let the function return first, or call another."
# Of a MemoryError.
OUT_OF_MEMORY = "There is too little memory for this mesh; close other programs, or unwrap fewer or coarser faces."


def parts_without_seams(n_parts: int, n_vertices: int) -> str:
    """Say that memory was too small to search parts of a mesh, of up to `n_vertices` vertices; "" for no parts."""
    if n_parts == 0:
        return ""
    parts = "1 part" if n_parts == 1 else f"{n_parts} parts"
    return (
        f"There is too little memory to look for seams in {parts} of the mesh, of up to {n_vertices} vertices; close "
        "other programs, or select fewer faces."
    )


class SolveError(RuntimeError):
    """No map passed the checks; the message says why, and what to do."""

    def __init__(self, *steps: Step | tuple) -> None:
        """Take the steps from the native module."""
        self.steps = steps_of(steps)
        super().__init__(*self.steps)

    def __str__(self) -> str:
        """Return the message."""
        return describe(self.steps)


def steps_of(steps: Iterable[Step | tuple]) -> tuple[Step, ...]:
    """Return the native module's tuples as steps."""
    return tuple(step if isinstance(step, Step) else Step(*step) for step in steps)


def describe(steps: Iterable[Step], translate: Translate = str) -> str:
    """Return the steps of a solve in words: sentences, or "" if there are no steps.

    Args:
        steps: of a `Parameterization`, a `Chart` or a `SolveError`.
        translate: returns a template in another language; `message_templates` has them all. Fields in braces stay.
    """
    sentences = []
    rejected: Step | None = None
    for step in steps:
        if rejected and step.kind in _STAND_INS:
            consequence = _filled(_STAND_INS[step.kind], step, translate)
            sentences.append(translate(_JOINED).format(reason=_reason(rejected, translate), consequence=consequence))
        elif step.kind != "rejected":
            if rejected:
                sentences.append(_failure(rejected, translate))
            sentences.append(_sentence(step, translate))
        rejected = step if step.kind == "rejected" else None
    if rejected:
        sentences.append(_failure(rejected, translate))
    return " ".join(sentences)


def describe_native(steps: Iterable[tuple]) -> str:
    """Return the native module's tuples in words."""
    return describe(steps_of(steps))


def message_templates() -> Iterator[str]:
    """Iterate over the templates that `describe` passes to `translate`."""
    for forms in (*_SENTENCES.values(), *_STAND_INS.values(), *_CONDITIONS.values()):
        yield from forms
    for texts in (_RELAXATIONS, _REASONS, _PINNED_REASONS, _VIOLATIONS, _ADVICE):
        yield from texts.values()
    yield from (_LITTLE, _NOT_LOWERED, _REPEATED, _JOINED)


def _filled(forms: tuple[str, ...], step: Step, translate: Translate, **fields: str) -> str:
    """Return the form for a step's count, translated, with its numbers."""
    template = forms[0] if abs(step.count) == 1 else forms[-1]
    values = {name: str(getattr(step, name)) for name in ("count", "index", "limit")}
    values.update({"before": _number(step, step.before), "after": _number(step, step.after), **fields})
    return translate(template).format(**values)


def _number(step: Step, value: float) -> str:
    """Return `before` or `after` of a step in the unit of its templates."""
    if step.kind not in _ANGLES and step.kind != _SIZES:
        return f"{value:.5g}"
    percent = 100.0 * ((value if step.kind in _ANGLES else 2.0 ** min(value, 1e3)) - 1.0)
    return format(percent, ".1f" if percent < 10.0 else ".0f")


def _sentence(step: Step, translate: Translate) -> str:
    if step.kind == "folds":
        return _failure(replace(step, kind="rejected", reason="folded"), translate)
    if step.kind == "blended_little":
        blend = _filled((_LITTLE if step.after < step.before else _NOT_LOWERED,), step, translate)
        return translate(_RELAXATIONS.get(step.relaxation or "", _RELAXATIONS["failed"])).format(blend=blend)
    suffix = {"pins": "_between_pins", "linear": "_beside_constraints"}.get(step.constraint or "", "")
    key = f"{step.kind}{suffix}"
    if step.kind == "moved_apart" and math.isnan(step.before):
        key = "moved_apart_without_map"
    return _filled(_SENTENCES[key], step, translate)


def _reason(step: Step, translate: Translate) -> str:
    """Return why a map was rejected, without a period."""
    of_pins = _PINNED_REASONS if step.constraint == "pins" else {}
    reason = _filled((of_pins.get(step.reason or "", _REASONS[step.reason or ""]),), step, translate)
    return (
        _filled((_REPEATED,), step, translate, reason=reason, attempts=str(step.attempts))
        if step.attempts > 1
        else reason
    )


def _failure(step: Step, translate: Translate) -> str:
    """Return why there is no map, and what to do about it."""
    if step.reason in _CONDITIONS:
        is_plain = step.reason == "closed" and not step.count
        return _filled(_CONDITIONS["closed_without_handles" if is_plain else step.reason], step, translate)
    if step.reason in _VIOLATIONS:
        return _filled((_VIOLATIONS[step.reason],), step, translate)
    constraint = step.constraint or ""
    keys = (f"{constraint} {step.reason}", constraint) if constraint else (step.reason or "", "")
    advice = next(_ADVICE[key] for key in keys if key in _ADVICE)
    return translate(_JOINED).format(reason=_reason(step, translate), consequence=translate(advice))
