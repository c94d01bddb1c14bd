# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts of several meshes: their order, the first few, and when no search is needed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_unwrap.core import native
from spectral_unwrap.core.seams import suggestion as seam_suggestion
from spectral_unwrap.core.seams.suggestion import Options, Search, Suggestion, Wishes
from spectral_unwrap.core.words import texts

from tests.core.polygon_meshes import SQUARE, polygon_mesh


def square(size=1.0):
    """A square of four vertices and one face."""
    return polygon_mesh(size * SQUARE, seams=[[2, 3]])


@pytest.fixture
def module(monkeypatch):
    """A stand-in for the native module that returns `cuts` mesh by mesh, or raises an error."""
    fake = SimpleNamespace(cuts=[], asked=[], styles=[])

    def suggest_cuts(_mesh, progress, **options):
        fake.asked.append(options)
        if progress:
            progress(1.0, "search")
        answer = fake.cuts.pop(0)
        if isinstance(answer, Exception):
            raise answer
        cuts = sc.Cuts(np.array(edges, np.int32) for edges in answer)
        cuts.style = fake.styles.pop(0) if fake.styles else ""
        return cuts

    fake.suggest_cuts, fake.Mesh = suggest_cuts, native.spectral_conformal().Mesh
    real = native.spectral_conformal
    monkeypatch.setattr(native, "spectral_conformal", lambda part="": real(part) if part else fake)
    return fake


def test_meshes_take_turns(module):
    module.cuts = [[[[0, 1]], [[1, 2], [0, 3]]], [[[1, 2]]]]
    suggestion = seam_suggestion.suggest([square(), square(2.0)], Options())
    assert [(cut.mesh, cut.length) for cut in suggestion.cuts] == [(0, 1.0), (1, 2.0), (0, 2.0)]
    assert suggestion.length == 5.0
    assert suggestion.errors == ("", "")


def test_part_of_the_cuts(module):
    module.cuts = [[[[0, 1]], [[1, 2], [0, 3]]], [[[1, 2]]]]
    suggestion = seam_suggestion.suggest([square(), square(2.0)], Options())
    first = suggestion.part(0, 2)
    assert first.length == 3.0
    assert first.edges(0).tolist() == [[0, 1]]
    assert first.edges(1).tolist() == [[1, 2]]
    assert suggestion.edges(0).tolist() == [[0, 1], [1, 2], [0, 3]]
    rest = suggestion.part(2, 3)
    assert rest.edges(1).shape == (0, 2)


def test_refused_mesh_does_not_stop_the_others(module):
    module.cuts = [ValueError("no mesh"), [[[0, 1]]]]
    suggestion = seam_suggestion.suggest([square(), square()], Options())
    assert [cut.mesh for cut in suggestion.cuts] == [1]
    assert suggestion.errors == ("no mesh", "")


def test_a_mesh_too_large_for_the_memory_fails_alone(module):
    module.cuts = [[[[0, 1]]], MemoryError("std::bad_alloc"), [[[1, 2]]]]
    suggestion = seam_suggestion.suggest([square(), square(), square()], Options())
    assert [cut.mesh for cut in suggestion.cuts] == [0, 2]
    assert suggestion.errors == ("", texts.TOO_LITTLE_MEMORY_FOR_MESH, "")


def test_no_memory_for_any_mesh_is_that_error(module):
    module.cuts = [MemoryError("std::bad_alloc"), MemoryError("std::bad_alloc")]
    with pytest.raises(MemoryError):
        seam_suggestion.suggest([square(), square()], Options())


def test_options_and_seams_reach_the_module(module):
    module.cuts = [[]]
    seam_suggestion.suggest([square()], Options(3.0, 1.2, 7.0, "inverse_area", "vertex", 0.5, (0.0, -2.0, 0.0), 0.01))
    (options,) = module.asked
    assert options.pop("seam_edges").tolist() == [[2, 3]]
    assert options.pop("selected_faces").tolist() == [True]
    assert options == {
        "scale_limit": 3.0,
        "qc_limit": 1.2,
        "qc_gain": 0.01,
        "style": "auto",
        "longest_side": 1.75,
        "max_length": 7.0,
        "weights": "inverse_area",
        "boundary": "vertex",
        "area_blend": 0.5,
        "front": (0.0, -2.0, 0.0),
        "vertex_preference": None,
        "avoided_edges": None,
        "preferred_edges": None,
        "edge_preference": None,
    }


def test_strips_are_measured_by_the_sheet_that_all_meshes_share(module):
    module.cuts = [[], [], []]
    in_world = replace(square(1.0), world_metric=4.0 * np.eye(3))
    seam_suggestion.suggest([square(2.0), in_world, square(0.0)], Options(longest_side=3.0))
    # Two squares of the same size in the world, and one without any.
    assert [options["longest_side"] for options in module.asked] == pytest.approx([3.0 * 2**0.5, 3.0 * 2**0.5, 3.0])


def test_found_styles_are_told_most_frequent_first(module):
    for style, expected in (("auto", ("organic", "hard")), ("hard", ())):
        module.cuts, module.styles = [[], [], []], ["organic", "hard", "organic"]
        assert seam_suggestion.suggest([square()] * 3, Options(style=style)).styles == expected


def two_squares(height=0.0):
    """Two squares that meet in the edge from 1 to 2; the far side of the second one lies at a height."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, height), (2, 1, height)]
    return polygon_mesh(points, [[0, 1, 2, 3], [1, 4, 5, 2]])


def hints(cut=(), never=()):
    return Wishes(None, *(np.array(edges, np.int32).reshape(-1, 2) for edges in (cut, never)))


def test_edges_to_cut_are_seams_of_the_search_and_of_every_part(monkeypatch):
    asked = []

    def suggest_cuts(*_arrays, **options):
        asked.append(options)
        return [np.array([[0, 1]], np.int32)]

    monkeypatch.setattr(sc, "suggest_cuts", suggest_cuts)
    # The outer edge is no seam between two faces.
    suggestion = seam_suggestion.suggest([two_squares()], Options(wishes=[hints([[2, 1], [0, 1]], [[1, 4]])]))
    (options,) = asked
    assert options["seam_edges"].tolist() == [[2, 1]]
    assert options["avoided_edges"].tolist() == [[1, 4]]
    assert suggestion.part(0, 0).edges(0).tolist() == [[2, 1]]
    assert suggestion.edges(0).tolist() == [[2, 1], [0, 1]]
    assert (suggestion.length, suggestion.part(0, 0).length) == (2.0, 1.0)
    assert suggestion.refused_hints == 0


def test_marks_reach_the_module_and_belong_to_the_question(module):
    marked = Wishes(cheap=np.array([[0, 1]], np.int32), cheapness=np.array([0.5]))
    stronger = replace(marked, cheapness=np.array([0.75]))
    module.cuts = [[], []]
    search = seam_suggestion.Search()
    for wishes in ([marked], [marked], [stronger]):
        search.suggest([square()], Options(wishes=wishes))
    assert [options["preferred_edges"].tolist() for options in module.asked] == [[[0, 1]]] * 2
    assert [options["edge_preference"].tolist() for options in module.asked] == [[0.5], [0.75]]


def test_cuts_against_a_hint_are_counted(monkeypatch):
    monkeypatch.setattr(sc, "suggest_cuts", lambda *_arrays, **_options: [np.array([[1, 2], [0, 1]], np.int32)])
    suggestion = seam_suggestion.suggest([two_squares()], Options(wishes=[hints(never=[[2, 1], [4, 5]])]))
    assert suggestion.refused_hints == 1


@pytest.mark.parametrize(
    ("height", "hinted", "edges"),
    [
        (0.5, hints(), []),
        (2.0, hints(), [[1, 2]]),
        (2.0, hints(never=[[2, 1]]), []),
        (0.5, hints(cut=[[2, 1]]), [[2, 1]]),
        (2.0, hints(cut=[[1, 2]]), [[1, 2]]),
    ],
)
def test_seams_by_angle(height, hinted, edges):
    options = Options(style="angle", sharp_angle=np.radians(45.0), wishes=[hinted])
    suggestion = seam_suggestion.suggest([two_squares(height)], options)
    assert suggestion.edges(0).tolist() == edges
    assert suggestion.cuts == ()
    assert suggestion.is_empty == (not edges)


def test_every_mesh_gets_its_own_preference(module):
    module.cuts = [[], []]
    wanted = np.array([1.0, 0.0, 0.5, 0.0])
    seam_suggestion.suggest([square(), square()], Options(wishes=[Wishes(), Wishes(wanted)]))
    assert [options["vertex_preference"] for options in module.asked] == [None, wanted]


def test_progress_is_that_of_all_meshes(module):
    module.cuts = [[], []]
    seen = []
    seam_suggestion.suggest([square(), square()], Options(), lambda fraction, phase: seen.append((fraction, phase)))
    assert seen == [(0.5, "search"), (1.0, "search")]


def test_segments_are_the_ends_of_edges():
    points = seam_suggestion.segments(square(2.0), np.array([[1, 2], [0, 3]]))
    assert points.tolist() == [[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 0.0, 0.0], [0.0, 2.0, 0.0]]
    assert seam_suggestion.segments(square(), np.empty((0, 2), np.int32)).shape == (0, 3)


def test_cut_meshes_have_the_cuts_beside_their_seams(module):
    module.cuts = [[[[0, 1]]], []]
    meshes = [square(), square()]
    first, second = seam_suggestion.cut_open(meshes, seam_suggestion.suggest(meshes, Options()))
    assert first.seam_edges.tolist() == [[2, 3], [0, 1]]
    assert second.seam_edges.tolist() == [[2, 3]]
    assert meshes[0].seam_edges.tolist() == [[2, 3]]


def _moved():
    mesh = square()
    mesh.vertices[0, 2] = 1e-6
    return mesh


@pytest.mark.parametrize(
    "question",
    [
        ([_moved()], Options()),
        ([polygon_mesh(SQUARE, seams=[[2, 3]], selected=[False])], Options()),
        ([polygon_mesh(SQUARE)], Options()),
        ([square(), square()], Options()),
        ([square()], Options(qc_limit=1.2)),
        ([square()], Options(qc_gain=0.01)),
        ([square()], Options(front=(0.0, -1.0, 0.0))),
        ([square()], Options(wishes=[Wishes(np.ones(4))])),
        ([square()], Options(max_length=1.0)),
    ],
)
def test_only_the_same_question_needs_no_search(module, question):
    module.cuts = [[[[0, 1]]]] + [[]] * 4
    search = Search()
    answer = search.suggest([square()], Options())
    assert search.suggest([square()], Options()) is answer
    assert len(module.asked) == 1
    assert search.suggest(*question).cuts == ()
    assert len(module.asked) == 1 + len(question[0])
    # Only the last answer is kept.
    assert search.suggest([square()], Options()) is not answer


def test_a_cancelled_search_is_not_remembered(module):
    module.cuts = [sc.Cancelled("stopped"), [[[0, 1]]], [[[1, 2]]], sc.Cancelled("stopped"), [[[0, 1]]]]
    search = Search()
    with pytest.raises(sc.Cancelled):
        search.suggest([square()], Options())
    assert search.suggest([square()], Options()).edges(0).tolist() == [[0, 1]]
    # Neither in the place of an answer, nor beside it.
    assert search.suggest([square(2.0)], Options()).edges(0).tolist() == [[1, 2]]
    with pytest.raises(sc.Cancelled):
        search.suggest([square()], Options())
    assert search.suggest([square()], Options()).edges(0).tolist() == [[0, 1]]


def test_nothing_suggested():
    assert Suggestion((), ("",)).length == 0
    assert Suggestion((), ("",)).edges(0).shape == (0, 2)
