# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders apart from Blender: identifiers, pairs of the selection, names."""

from dataclasses import replace
from itertools import combinations, islice

import numpy as np
import pytest
from spectral_unwrap.core.extenders import pairs as extender_pairs
from spectral_unwrap.core.extenders.pairs import Extender, SelectionError

FEW = [Extender("Extender", 1.0, True, 17, 4), Extender("Other", -2.5, False, 17, 99)]


def test_ids_are_distinct_exact_in_single_precision_and_not_zero():
    ids = np.array(list(islice(extender_pairs.fresh_ids(()), 20000)))
    assert len(np.unique(ids)) == len(ids)
    assert ids.min() > 0
    assert ids.max() < 1 << 24
    np.testing.assert_array_equal(ids.astype(np.float32).astype(int), ids)


def test_values_interpolated_between_ids_are_no_ids():
    ids = list(islice(extender_pairs.fresh_ids(()), 100))
    pairs = [*combinations(ids, 2), *((vertex_id, 0) for vertex_id in ids)]
    for weight in (0.5, 0.25, 0.75, 1.0 / 3.0, 2.0 / 3.0):
        between = {round(weight * a + (1.0 - weight) * b) + shift for a, b in pairs for shift in (-1, 0, 1)}
        assert not between & set(ids)


def test_taken_ids_are_left_out():
    first, second, third = islice(extender_pairs.fresh_ids(()), 3)
    assert list(islice(extender_pairs.fresh_ids([second]), 2)) == [first, third]


def test_lowest_vertex_of_an_id_counts_and_zero_is_none():
    assert extender_pairs.first_with(np.array([0, 7, 5, 7, 5, 0]), [5, 7, 9, 0, 5]) == [2, 1, -1, -1, 2]
    assert extender_pairs.first_with(np.array([], dtype=int), [5]) == [-1]
    assert extender_pairs.first_with(np.array([3]), []) == []


def test_layer_name_tells_every_change_and_nothing_else():
    name = extender_pairs.layer_name(".prefix:", FEW)
    assert name.startswith(".prefix:")
    assert name == extender_pairs.layer_name(".prefix:", list(map(replace, FEW)))
    changes = [{"name": "x"}, {"strength": 1.5}, {"use": False}, {"first_id": 1}, {"second_id": 1}]
    others = [[replace(FEW[0], **change), FEW[1]] for change in changes] + [FEW[:1], FEW[::-1], []]
    names = {extender_pairs.layer_name(".prefix:", other) for other in others}
    assert len(names | {name}) == len(others) + 1
    # Blender cuts names of layers off.
    assert max(map(len, names)) < 60


def test_two_vertices_are_a_pair_with_or_without_an_active_one():
    assert extender_pairs.pairs([3, 8], None) == [(3, 8)]
    assert extender_pairs.pairs([3, 8], 8) == [(3, 8)]
    assert extender_pairs.pairs([3, 8], 3) == [(8, 3)]


def test_several_vertices_are_connected_with_the_active_one():
    assert extender_pairs.pairs([1, 5, 9], 5) == [(1, 5), (9, 5)]


@pytest.mark.parametrize(
    ("selected", "active", "words"), [([], None, "two vertices"), ([1], 1, "two vertices"), ([1, 2, 3], None, "active")]
)
def test_selection_without_pairs_is_refused_with_advice(selected, active, words):
    with pytest.raises(SelectionError, match=words):
        extender_pairs.pairs(selected, active)


def test_names_are_made_unique_as_in_blender():
    assert extender_pairs.free_name("Extender", []) == "Extender"
    assert extender_pairs.free_name("Extender", ["Extender"]) == "Extender.001"
    assert extender_pairs.free_name("Extender", ["Extender", "Extender.002", "Extender.001"]) == "Extender.003"
    assert extender_pairs.free_name(".5", [".5"]) == ".5.001"
