# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders apart from Blender: identifiers, pairs of the selection, names, arrows."""

from dataclasses import replace
from itertools import combinations, islice

import numpy as np
import pytest
from spectral_unwrap.core import extender_pairs as extenders
from spectral_unwrap.core.extender_pairs import ArrowSize, Extender, SelectionError

FEW = [Extender("Extender", 1.0, True, 17, 4), Extender("Other", -2.5, False, 17, 99)]


def test_ids_are_distinct_exact_in_single_precision_and_not_zero():
    ids = np.array(list(islice(extenders.fresh_ids(()), 20000)))
    assert len(np.unique(ids)) == len(ids)
    assert ids.min() > 0
    assert ids.max() < 1 << 24
    np.testing.assert_array_equal(ids.astype(np.float32).astype(int), ids)


def test_values_interpolated_between_ids_are_no_ids():
    ids = list(islice(extenders.fresh_ids(()), 100))
    pairs = [*combinations(ids, 2), *((vertex_id, 0) for vertex_id in ids)]
    for weight in (0.5, 0.25, 0.75, 1.0 / 3.0, 2.0 / 3.0):
        between = {round(weight * a + (1.0 - weight) * b) + shift for a, b in pairs for shift in (-1, 0, 1)}
        assert not between & set(ids)


def test_taken_ids_are_left_out():
    first, second, third = islice(extenders.fresh_ids(()), 3)
    assert list(islice(extenders.fresh_ids([second]), 2)) == [first, third]


def test_lowest_vertex_of_an_id_counts_and_zero_is_none():
    assert extenders.first_with(np.array([0, 7, 5, 7, 5, 0]), [5, 7, 9, 0, 5]) == [2, 1, -1, -1, 2]
    assert extenders.first_with(np.array([], dtype=int), [5]) == [-1]
    assert extenders.first_with(np.array([3]), []) == []


def test_layer_name_tells_every_change_and_nothing_else():
    name = extenders.layer_name(".prefix:", FEW)
    assert name.startswith(".prefix:")
    assert name == extenders.layer_name(".prefix:", list(map(replace, FEW)))
    changes = [{"name": "x"}, {"strength": 1.5}, {"use": False}, {"first_id": 1}, {"second_id": 1}]
    others = [[replace(FEW[0], **change), FEW[1]] for change in changes] + [FEW[:1], FEW[::-1], []]
    names = {extenders.layer_name(".prefix:", other) for other in others}
    assert len(names | {name}) == len(others) + 1
    # Blender cuts names of layers off.
    assert max(map(len, names)) < 60


def test_two_vertices_are_a_pair_with_or_without_order():
    assert extenders.pairs_in_order([3, 8], []) == [(3, 8)]
    assert extenders.pairs_in_order([3, 8], [8]) == [(3, 8)]
    assert extenders.pairs_in_order([3, 8], [8, 3]) == [(8, 3)]


def test_several_vertices_pair_up_in_order():
    assert extenders.pairs_in_order([1, 2, 3, 4], [4, 1, 3, 2]) == [(4, 1), (3, 2)]


@pytest.mark.parametrize(
    ("selected", "ordered", "words"),
    [
        ([], [], "two vertices"),
        ([1], [1], "two vertices"),
        ([1, 2, 3], [3, 1, 2], "even"),
        ([1, 2, 3, 4], [4, 1], "order"),
    ],
)
def test_selection_without_pairs_is_refused_with_advice(selected, ordered, words):
    with pytest.raises(SelectionError, match=words):
        extenders.pairs_in_order(selected, ordered)


def test_pairs_to_active():
    assert extenders.pairs_to_active([1, 5, 9], 5) == [(1, 5), (9, 5)]
    with pytest.raises(SelectionError, match="active"):
        extenders.pairs_to_active([1, 5, 9], None)
    with pytest.raises(SelectionError, match="connect"):
        extenders.pairs_to_active([5], 5)


def test_names_are_made_unique_as_in_blender():
    assert extenders.unique_name("Extender", []) == "Extender"
    assert extenders.unique_name("Extender", ["Extender"]) == "Extender.001"
    assert extenders.unique_name("Extender.001", ["Extender", "Extender.001"]) == "Extender.002"
    assert extenders.unique_name("Extender", ["Extender", "Extender.002", "Extender.001"]) == "Extender.003"
    assert extenders.unique_name(".5", [".5"]) == ".5.001"


def tips_and_bases(triangles):
    """The tip and the middle of the base of each of the two heads, which come first."""
    return [(head[0], head[1:].mean(axis=0)) for head in triangles[:2]]


@pytest.mark.parametrize("end", [(200.0, 0.0), (0.0, -90.0), (30.0, 40.0)])
def test_outward_heads_end_at_the_vertices_and_inward_ones_meet_in_the_middle(end):
    start, end = np.array([5.0, -3.0]), np.array([5.0, -3.0]) + end
    for outward in (True, False):
        heads = tips_and_bases(extenders.arrow(start, end, outward, ArrowSize()))
        if outward:
            np.testing.assert_allclose([tip for tip, _ in heads], [start, end])
        else:
            np.testing.assert_allclose(np.mean([tip for tip, _ in heads], axis=0), (start + end) / 2.0)
        towards_end = [(tip - base) @ (end - start) for tip, base in heads]
        assert np.sign(towards_end).tolist() == ([-1, 1] if outward else [1, -1])


@pytest.mark.parametrize("outward", [True, False])
def test_arrow_keeps_its_size_in_pixels_and_shrinks_only_without_room(outward):
    def width(length):
        triangles = extenders.arrow(np.zeros(2), np.array([length, 0.0]), outward, ArrowSize())
        assert triangles[:, :, 0].min() >= -1e-9
        assert triangles[:, :, 0].max() <= length + 1e-9
        return np.ptp(triangles[:, :, 1])

    assert width(100.0) == pytest.approx(width(1000.0)) == pytest.approx(ArrowSize().head_width)
    assert width(10.0) < width(100.0)


@pytest.mark.parametrize("outward", [True, False])
def test_margin_surrounds_the_arrow(outward):
    inner, outer = (
        extenders.arrow(np.zeros(2), np.array([80.0, 0.0]), outward, ArrowSize(margin=margin)) for margin in (0.0, 1.5)
    )
    for head, larger in zip(inner[:2], outer[:2]):
        for i in range(3):
            normal = np.array([(head[i] - head[i - 1])[1], -(head[i] - head[i - 1])[0]])
            normal *= np.sign(normal @ (head[i] - head[i - 2])) / np.linalg.norm(normal)
            assert normal @ (larger[i] - head[i]) == pytest.approx(1.5)


def test_points_in_one_place_or_nowhere_make_no_arrow():
    assert extenders.arrow(np.ones(2), np.ones(2), True, ArrowSize()).shape == (0, 3, 2)
    assert extenders.arrow(np.ones(2), np.array([np.nan, 0.0]), True, ArrowSize()).shape == (0, 3, 2)


def test_nearest_copies():
    first, second = np.array([(0.0, 0.0), (5.0, 5.0)]), np.array([(9.0, 9.0), (5.0, 6.0)])
    np.testing.assert_array_equal(extenders.nearest_pair(first, second), [(5.0, 5.0), (5.0, 6.0)])
