# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages about steps: in English, singular and plural, and in other languages."""

import pickle
from string import Formatter
from typing import get_args

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import _messages

from tests.module import meshes

NAN = float("nan")


def said(*steps, **options):
    return sc.hosts.describe([sc.Step(*step) if isinstance(step, tuple) else step for step in steps], **options)


def rejected(reason, constraint=None, **fields):
    return sc.Step("rejected", reason, constraint=constraint, **{"attempts": 1, **fields})


def step(kind, **fields):
    return sc.Step(kind, **fields)


WINDS = "The boundary of the map winds around 2 times instead of once: "
NO_AREA = rejected("no_area")
BLEND = {"count": 0, "before": 0.5, "after": 0.45}
SAID = [
    ([], ""),
    (
        [
            step("reoriented_faces", count=1),
            step("duplicate_faces", count=2),
            step("fan_splits", count=3),
            step("degenerate_triangles", count=5),
        ],
        "1 face wound the other way: reoriented. 2 duplicate faces: placed on the first ones with the same vertices. "
        "3 self-intersecting polygons: split as a fan. 5 degenerate triangles: given a minimal height.",
    ),
    (
        [step("unresolved_triangles", count=2)],
        "2 triangles shrink below what double precision resolves; add seams that make the island flatter.",
    ),
    # Failures name their reason, and what to do.
    (
        [rejected("unresolved", attempts=2)],
        "The triangles differ so much in size or shape that double precision does not resolve the map, in 2 attempts "
        "with different shifts and starts: add seams that make the island flatter, or clean up degenerate faces.",
    ),
    ([rejected("winding", "rigidity", count=2)], f"{WINDS}lower the hole rigidity."),
    ([rejected("winding", "extenders", count=2)], f"{WINDS}weaken or remove extenders (Push/Pull)."),
    (
        [rejected("winding", "extenders_and_rigidity", count=2)],
        f"{WINDS}weaken or remove extenders (Push/Pull), or lower the hole rigidity.",
    ),
    (
        [rejected("not_factorized", after=1.5e-9)],
        "The conformal energy could not be factorized, even with a shift of 1.5e-09 of the boundary form: the island "
        "has too many degenerate triangles; merge vertices by distance or dissolve degenerate faces.",
    ),
    (
        [rejected("too_large", count=2147483647)],
        "The island is too large: its factor would have more than 2147483647 entries: cut it into smaller islands with "
        "seams.",
    ),
    (
        [rejected("no_area", "pins")],
        "The pinned map has no positive area: use the spectral method, or pin other vertices.",
    ),
    # Fallbacks follow their reason.
    *(
        ([NO_AREA, step(kind)], f"The map has no positive area: {text}")
        for kind, text in {
            "clamped_thin": "solved instead with thin triangles raised to a height of 1e-5 of their length.",
            "by_vertex": "solved with the boundary form 'vertex' instead.",
            "by_length": "solved with the boundary form 'length' instead.",
            "inverse_area": "solved with the weights 'inverse_area' instead.",
            "uniform_weights": "solved with the weights 'uniform' instead.",
        }.items()
    ),
    (
        [NO_AREA, step("embedded", before=NAN, after=1.5)],
        "The map has no positive area: replaced by an embedding, relaxed without folding it; angles are off by 50 % "
        "on average.",
    ),
    (
        [NO_AREA, step("by_vertex"), step("retried")],
        "The map has no positive area: solved with the boundary form 'vertex' instead. The first solve failed its "
        "checks and was repeated with a larger shift and another start.",
    ),
    (
        [NO_AREA, step("moved_apart_embedded", before=NAN, after=1.5)],
        "The map has no positive area: replaced by an embedding that does not cover itself, relaxed without folding "
        "it; angles are off by 50 % on average.",
    ),
    (
        [step("moved_apart", before=NAN, after=1.5)],
        "Parts that covered each other moved apart; angles are off by 50 % on average.",
    ),
    # Unfolding tells what it cost, and what it left.
    (
        [step("unfolded", count=3, before=1.021234, after=1.05)],
        "3 flipped triangles unfolded; angles are off by 5.0 % on average, 2.1 % before.",
    ),
    (
        [step("unfolded", count=1, before=1.25, after=1.5), step("still_flipped", count=2, constraint="pins")],
        "1 flipped triangle unfolded; angles are off by 50 % on average, 25 % before. 2 triangles could not be "
        "unfolded between the pins; move or remove pins.",
    ),
    (
        [step("not_injective", count=2)],
        "The boundary of the map winds around 2 times instead of once; add seams.",
    ),
    (
        [step("not_injective", count=-1, constraint="pins")],
        "The map goes around an inner vertex more than once; move or remove pins.",
    ),
    (
        [step("embedded", before=2.0, after=1.5)],
        "The folds left no room to unfold them: replaced by an embedding, relaxed without folding it; angles are off "
        "by 50 % on average, 100 % before.",
    ),
    # An area blend that did little says why.
    (
        [step("blended_little", **BLEND, relaxation="converged")],
        "The area blend evened out sizes only a little: they vary by 37 %, 41 % before. Add seams, or clean up "
        "degenerate faces.",
    ),
    (
        [step("blended_little", **{**BLEND, "after": 0.6}, relaxation="stalled")],
        "The area blend did not even out sizes: they vary by 52 %, 41 % before. Flipped or degenerate triangles "
        "stopped its relaxation; add seams, or clean up degenerate faces.",
    ),
    # Violations of arguments name their numbers, those about charts what to do.
    (
        [step("rejected", reason="corner_of_no_vertex", count=5, index=9, limit=4)],
        "Corner 5 refers to vertex 9, but there are 4 vertices.",
    ),
    (
        [rejected("closed")],
        "The island is closed: it has no boundary to unfold from; mark seams that cut it open.",
    ),
]


@pytest.mark.parametrize(("steps", "sentences"), SAID)
def test_steps_are_said(steps, sentences):
    assert said(*steps) == sentences


@pytest.mark.parametrize(
    ("steps", "part"),
    [
        ([rejected("closed", count=2)], "The island is closed, with 2 handles: it has"),
        ([rejected("handles", count=1)], "The island has 1 handle and cannot lie flat"),
        (
            [NO_AREA, step("moved_apart", before=1.0, after=2.0)],
            "Parts that covered each other moved apart; angles are off by 100 % on average, 0.0 % before.",
        ),
        (
            [step("blended_little", **BLEND, relaxation="rejected")],
            "before. Its relaxation failed; add seams, or clean up degenerate faces.",
        ),
    ],
)
def test_parts_of_longer_ones(steps, part):
    assert part in said(*steps)


@pytest.mark.parametrize("constraint", [None, *get_args(get_args(_messages.Constraint)[0])])
@pytest.mark.parametrize("reason", get_args(get_args(_messages.Reason)[0]))
def test_every_failure_is_a_sentence(reason, constraint):
    text = said(rejected(reason, constraint, count=3))
    assert text.endswith(".") and "{" not in text
    # What arguments must be says what to do; it may begin with an argument's name.
    assert reason in _messages._VIOLATIONS or (text[0].isupper() and (": " in text or "; " in text))


def test_violations_of_arguments_name_their_numbers():
    vertices, triangles = meshes.bumpy_disk(60)
    with pytest.raises(sc.InvalidMeshError, match="^Vertex 60 is pinned, but no triangle uses it"):
        sc.parameterize(np.r_[vertices, [[9, 9, 9]]], triangles, pins={60: (0, 0)})
    (chart,) = sc.unwrap(vertices, triangles, pins=dict.fromkeys((0, 1, 2), (0, 0))).charts
    (step,) = chart.steps
    assert (step.reason, chart.message) == ("pins_at_one_position", said(step))


def test_conditions_of_charts_name_what_to_do():
    with pytest.raises(sc.InvalidMeshError, match="^The island is closed: it has no boundary"):
        sc.parameterize(np.eye(4, 3), [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    (chart,) = sc.unwrap(np.eye(4, 3), [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).charts
    assert (chart.steps, chart.message) == ((sc.Step("rejected", "closed"),), said(rejected("closed")))


def test_every_kind_has_a_sentence_whose_fields_are_filled_in():
    for kind in get_args(_messages.StepKind):
        step = rejected("winding", count=2) if kind == "rejected" else sc.Step(kind, count=2, relaxation="stalled")
        if kind in ("clamped_thin", "by_length", "by_vertex", "uniform_weights", "inverse_area"):
            step = [rejected("winding", count=2), step]
        text = said(*(step if isinstance(step, list) else [step]))
        assert text.endswith(".") and "{" not in text, kind


def test_templates_are_looked_up_whole():
    asked = []

    def shouted(template):
        asked.append(template)
        return template.upper().format_map(
            {name.upper(): f"{{{name}}}" for _, name, _, _ in Formatter().parse(template) if name}
        )

    text = said(rejected("winding", count=2), sc.Step("by_vertex"), sc.Step("fan_splits", count=3), translate=shouted)
    assert text == (
        "THE BOUNDARY OF THE MAP WINDS AROUND 2 TIMES INSTEAD OF ONCE: SOLVED WITH THE BOUNDARY FORM 'VERTEX' INSTEAD. "
        "3 SELF-INTERSECTING POLYGONS: SPLIT AS A FAN."
    )
    assert set(asked) <= set(sc.hosts.message_templates())


def test_results_and_errors_say_what_their_steps_mean():
    vertices, triangles = meshes.bumpy_disk(60)
    triangles = triangles.copy()
    triangles[3] = triangles[3][::-1]
    solution = sc.parameterize(vertices, triangles)
    assert solution.steps == (sc.Step("reoriented_faces", count=1),)
    assert solution.message == sc.hosts.describe(solution.steps) != ""
    (chart,) = sc.unwrap(vertices, *meshes.polygons(triangles)).charts
    assert (chart.steps, chart.message) == (solution.steps, solution.message)
    with pytest.raises(sc.SolveError) as caught:
        sc.parameterize(vertices, triangles, extenders=[(0, 30, -1000.0)])
    (step,) = caught.value.steps
    assert (step.kind, step.reason, step.constraint) == ("rejected", "winding", "extenders")
    assert str(caught.value) == sc.hosts.describe([step])
    again = pickle.loads(pickle.dumps(caught.value))  # noqa: S301 - our own
    assert (again.steps, str(again)) == (caught.value.steps, str(caught.value))
