# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders apart from Blender: pairs of the selection, names, amounts."""

import pytest
from spectral_unwrap.core.errors import ReadableError
from spectral_unwrap.core.extenders import pairs as extender_pairs


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
    with pytest.raises(ReadableError, match=words):
        extender_pairs.pairs(selected, active)


def test_names_are_made_unique_as_in_blender():
    assert extender_pairs.free_name("Extender", []) == "Extender"
    assert extender_pairs.free_name("Extender", ["Extender"]) == "Extender.001"
    assert extender_pairs.free_name("Extender", ["Extender", "Extender.002", "Extender.001"]) == "Extender.003"
    assert extender_pairs.free_name(".5", [".5"]) == ".5.001"


@pytest.mark.parametrize("strength", [0.0, 0.2, -0.2, 1.0, 1e3, -1e3, 1e-3])
def test_amounts_stand_for_strengths(strength):
    amount = extender_pairs.amount_of(strength)
    assert abs(amount) < 100.0
    assert extender_pairs.strength_of(amount) == pytest.approx(strength)


def test_amounts_end_at_the_limit_of_strengths():
    assert [extender_pairs.strength_of(amount) for amount in (-200.0, -100.0, 0.0, 100.0, 1e9)] == pytest.approx(
        [-1e4, -1e4, 0.0, 1e4, 1e4]
    )
