# SPDX-License-Identifier: GPL-3.0-or-later
"""The sentences that the user reads."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import spectral_conformal
from spectral_unwrap import locale
from spectral_unwrap.core.measure.defects import Defects
from spectral_unwrap.core.measure.quality import MapQuality
from spectral_unwrap.core.measure.summary import Strain, summarize
from spectral_unwrap.core.solve.solution import Solution
from spectral_unwrap.core.words import texts, translation


def solved(area=1.0, mean_qc=1.0, max_qc=1.0, flipped=0, overlapping=0, method="spectral", n_pins=0, **unfolding):
    return SimpleNamespace(
        **{"unfolded": 0, "is_embedding": False, "mean_qc_before": float("nan"), **unfolding},
        status="solved",
        message="",
        steps=(),
        area=area,
        mean_qc=mean_qc,
        max_qc=max_qc,
        flipped=flipped,
        overlapping=overlapping,
        method=method,
        n_pins=n_pins,
    )


def failed(message, steps=()):
    nan = float("nan")
    chart = solved(nan, nan, nan, method="")
    return SimpleNamespace(**{**vars(chart), "status": "failed", "message": message, "steps": steps})


def summary(*charts, error=""):
    solution = Solution(np.zeros((0, 2)), np.zeros(0, dtype=int), charts, np.zeros(0, dtype=int), error=error)
    return summarize([solution], ["Object"])


def test_mean_is_weighted_by_area_and_maximum_is_over_all():
    result = summary(solved(3.0, 1.0, 1.5, 2), failed("closed"), solved(1.0, 2.0, 4.0, 1))
    assert (result.solved, result.failed) == (2, 1)
    assert result.mean_qc == pytest.approx(1.25)
    assert (result.max_qc, result.flipped) == (4.0, 3)


@pytest.mark.parametrize("area", [1e-300, 1e300])
def test_mean_does_not_overflow(area):
    assert summary(solved(area, 1.5), solved(area, 1.5)).mean_qc == pytest.approx(1.5)


def test_information():
    one = texts.information(summary(solved(1.0, 1.01, 1.5)), 0.257)
    assert one == "Unwrapped 1 island: angles off by 1.0 % on average, 50 % at worst; no flipped faces; 0.26 s"
    packed = texts.information(summary(solved(1.0, 1.01, 1.5)), 0.257, 0.678)
    assert packed.endswith("; no flipped faces; 67 % of the tile filled; 0.26 s")
    assert texts.packed(2, 0, 0.5, 0.1, False, tiles=3) == "Packed 2 islands; 50 % of 3 tiles filled; 0.10 s"
    for worst, said in ((54.7, "5370 %"), (12345.6, "beyond measure")):
        two = texts.information(summary(solved(), solved(1.0, 1.0 - 1e-15, worst)), 12.0)
        assert two == f"Unwrapped 2 islands: angles off by 0.0 % on average, {said} at worst; no flipped faces; 12.00 s"


@pytest.mark.parametrize(
    ("flipped", "overlapping", "said"),
    [
        (1, 0, "; 1 flipped face (see Select Flipped and Overlapping); "),
        (0, 12, "; 12 overlapping faces (see Select Flipped and Overlapping); "),
        (3, 1, "; 3 flipped faces, 1 overlapping face (see Select Flipped and Overlapping); "),
    ],
)
def test_information_tells_where_to_see_defects(flipped, overlapping, said):
    charts = solved(flipped=flipped, overlapping=overlapping), solved()
    assert said in texts.information(summary(*charts), 1.0)


def test_selected_defects():
    one = np.zeros(3, int)
    first = Defects(np.array([True, True, False]), np.array([False, True, True]), np.array([False, False, False]), one)
    second = Defects(np.array([False]), np.array([False]), np.array([True]), one[:1])
    both = [first, second]
    said = texts.selected_defects(both, True, True)
    assert said == "Selected 4 faces: 2 flipped, 2 overlapping, 1 with invalid UVs"
    assert texts.selected_defects([first], False, True) == "Selected 2 faces: 2 overlapping"
    none = Defects(*(np.zeros(2, dtype=bool),) * 3, one[:2])
    assert texts.selected_defects([none], True, True) == "No flipped or overlapping faces, selection unchanged"
    assert texts.selected_defects([none, none], False, True) == "No overlapping faces, selection unchanged"


def test_unfolding_tells_what_it_cost():
    unfolded = solved(3.0, 1.25, unfolded=5, mean_qc_before=1.05)
    replaced = solved(1.0, 1.5, unfolded=1, is_embedding=True, mean_qc_before=1.25)
    without_map = solved(1.0, 9.0, is_embedding=True)
    for chart in (unfolded, replaced, without_map):
        chart.message = "what the module says"
    result = summary(unfolded, replaced, without_map, solved())
    assert texts.unfolded(result) == (
        "No Overlaps: 6 flipped triangles unfolded, 2 islands needed the slower method; "
        "angles there off by 31 % on average, 10 % before"
    )
    assert texts.repairs(result) == ""
    assert texts.unfolded(summary(without_map)).endswith("needed the slower method")
    assert texts.unfolded(summary(solved())) == ""


def test_what_could_not_be_unfolded_is_reported_as_a_fallback_that_failed():
    stuck = solved(unfolded=2, flipped=1, mean_qc_before=1.1)
    stuck.message = "1 triangle could not be unfolded between the pins; move or remove pins."
    result = summary(stuck)
    assert texts.unfolded(result) == ""
    assert "could not be unfolded" in texts.repairs(result)


def test_counts_have_a_form_for_one_and_one_for_more():
    assert texts.counted(0, texts.TOO_SMALL) == ""
    assert texts.counted(1, texts.TOO_SMALL).startswith("1 face is too small for")
    assert texts.counted(12, texts.TOO_SMALL).startswith("12 faces are too small for")


def test_no_failures_no_warning():
    assert texts.failures(summary(solved())) == ""


def test_equal_reasons_are_grouped():
    one = texts.failures(summary(solved(), failed("closed; cut"), failed("closed; cut")))
    assert one == "2 of 3 islands failed, UVs unchanged: closed; cut"
    two = texts.failures(summary(failed("flat"), failed("closed"), failed("closed")))
    assert two == "3 of 3 islands failed, UVs unchanged: 2: closed; 1: flat"


def test_reasons_that_differ_in_numbers_only_are_one_reason():
    def contradiction(vertex):
        steps = (spectral_conformal.Step("rejected", "constraints_join_vertices", count=vertex, index=vertex + 1),)
        return failed(spectral_conformal.hosts.describe(steps), steps)

    said = texts.failures(summary(*map(contradiction, range(1, 25)), failed("closed")))
    assert said == (
        "25 of 25 islands failed, UVs unchanged: 24: The constraints give vertices 1 and 2 of one edge the same "
        "position; remove one of them (and 23 similar); 1: closed"
    )


def test_repairs_and_fallbacks_are_reported():
    assert texts.repairs(summary(solved())) == ""
    charts = [solved(), solved(), solved()]
    charts[0].message = charts[1].message = "3 faces were turned."
    assert texts.repairs(summary(*charts)) == "2 islands needed a repair or fallback: 3 faces were turned"


def test_pins_tell_how_islands_were_solved():
    assert texts.pinned(summary(solved(), solved(n_pins=1))) == ""
    charts = [solved(method="lscm", n_pins=2), solved(method="lscm", n_pins=5), solved()]
    assert texts.pinned(summary(*charts)) == "2 islands with pins: solved by pinned least squares (LSCM)"
    soft = texts.pinned(summary(solved(n_pins=3)))
    assert soft == "1 island with pins: solved by the spectral method with soft pins"


def test_object_scale_is_told_as_blender_does():
    assert texts.object_scale([(1.0, 1.0, 1.0), (2.0, 2.0, 2.0)], [False, False]) == ""
    assert texts.object_scale([(1.0, 1.0, 1.0)], [True]).startswith("Object has negative scale, ")
    uneven = texts.object_scale([(2.0, 2.0, 2.0), (1.0, 1.1, 1.0)], [False, True])
    assert uneven.startswith("Object has non-uniform scale, ")


NAN = float("nan")
SENTENCES = [
    (texts.selected_failed(2, 4), "Selected 4 faces of 2 failed islands"),
    (texts.selected_failed(0, 0), "No islands failed, selection unchanged"),
    (texts.failures(summary(error="no vertices")), "Not unwrapped: Object: no vertices"),
    (texts.marked(1, 0, "2 m"), "Marked 1 cut, length 2 m"),
    (texts.marked(3, 0, "7.5"), "Marked 3 cuts, length 7.5"),
    (texts.marked(3, 1, "7.5"), "Marked 3 cuts + 1 edge, length 7.5"),
    (texts.marked(0, 2, "7.5"), "Marked 2 edges, length 7.5"),
    (texts.without_suggestion(["", ""], ["A", "B"]), ""),
    (texts.without_suggestion(["", "No mesh."], ["A", "B"]), "No seams suggested for B: No mesh"),
    (texts.preview(3, 3, "2 m", "2 m"), "3 cuts, length 2 m"),
    (texts.preview(1, 3, "1 m", "2 m"), "1 of 3 cuts, length 1 m of 2 m"),
    (
        texts.expected(MapQuality(0.0, NAN), MapQuality(0.9999, 1.0271)),
        "99 % evenly sized (now 0 %), angles off by 2.7 % on average",
    ),
    (
        texts.expected(MapQuality(0.5, 1.5), MapQuality(1.0, 1.0)),
        "100 % evenly sized (now 50 %), angles off by 0.0 % on average (now 50 %)",
    ),
]


@pytest.mark.parametrize(("said", "expected"), SENTENCES)
def test_sentences(said, expected):
    assert said == expected


def test_nothing_to_suggest_names_the_limit_if_there_is_one():
    assert "length" not in texts.nothing_to_suggest("AUTO", is_limited=False)
    assert "within the length" in texts.nothing_to_suggest("AUTO", is_limited=True)


def test_where_seams_are_missing_suggest_seams_is_named():
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    offsets, corners = np.arange(0, 25, 4), np.concatenate(faces)
    (chart,) = spectral_conformal.unwrap(cube, offsets, corners).charts
    text = texts.failures(summary(failed(chart.message, chart.steps)))
    assert "closed" in text
    assert text.endswith("Suggest Seams finds where to cut")
    assert "Suggest Seams" not in texts.failures(summary(failed("The map winds.")))


def test_reasons_of_the_solver_come_in_the_language_of_the_user(monkeypatch):
    steps = (spectral_conformal.Step("rejected", "closed"),)
    german = locale.table("de")
    monkeypatch.setattr(translation, "_look_up", lambda text: german.get(text, text))
    text = texts.failures(summary(failed("In English", steps)))
    assert "Die Insel ist geschlossen: sie hat keinen Rand" in text and "In English" not in text


def test_what_is_infinite_is_said_in_words():
    text = texts.information(summary(solved(mean_qc=float("inf"), max_qc=float("inf"))), 0.5)
    assert text.startswith("Unwrapped 1 island: angles off beyond measure, because faces shrink to nothing; ")


def test_stretched_faces_are_a_warning_with_their_number():
    assert texts.strained(Strain(0, 1.0)) == ""
    assert texts.strained(Strain(1, 12.4)).startswith("1 face is stretched to more than twice its width, 12.4 times")
    assert "Select Stretched Faces" in texts.strained(Strain(3, 12.4))


@pytest.mark.parametrize(("flags", "said"), [((True, False), "Flipped"), ((False, True), "Overlapping")])
def test_lines_of_the_legend_begin_with_capitals(flags, said):
    assert texts.face_numbers(1.5, 1.0, "2 px/m", *flags) == (
        "Under the mouse: angles off by 50 %",
        "Size 2.00 x, 2 px/m",
        said,
    )


# How the native code names what it does while it reports the progress.
PHASES = re.compile(r'(?:lap|report|CancellationScope \w+|PolledWork \w+)\([^;"\n]*"([a-z ]+)"')


def test_every_phase_of_the_solver_is_said_in_words_of_an_artist():
    native = Path(__file__).resolve().parents[3] / "native"
    sources = [
        path.read_text(encoding="utf-8")
        for folder in ("src", "seams", "bindings")
        for path in (native / folder).rglob("*.*")
    ]
    named = {name for source in sources for name in PHASES.findall(source)}
    assert {"seams", "factorization", "packing"} <= named
    for name in named:
        said = texts.printed_progress(texts.UNWRAP_LABEL, 41, name)
        assert re.fullmatch(r"Spectral Unwrap: 41 % \([A-Z][a-z ]+\)", said), said
    assert "Finding seams, 41 %" in texts.progress(texts.SUGGEST_SEAMS_LABEL, 41, "seams")
