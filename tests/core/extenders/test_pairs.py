# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders apart from Blender: names of layers, pairs of the selection, names."""

import math

import numpy as np
import pytest
from spectral_unwrap.core.errors import ReadableError
from spectral_unwrap.core.extenders import pairs as extender_pairs

PREFIX = ".spectral_extender:"
EXTENDERS = [
    ("Extender", 1.0, True),
    ("", -2.5, False),
    ("with: colons\nand lines", 1e4, True),
    ("Drücken 推", float(np.float32(0.1)), True),
    ("1:2:3", 1e-30, False),
]


@pytest.mark.parametrize("extender", EXTENDERS)
def test_names_of_layers_hold_all_of_an_extender(extender):
    name = extender_pairs.layer_name(PREFIX, *extender)
    found = extender_pairs.properties(PREFIX, name)
    assert (found[0], np.float32(found[1]), found[2]) == (extender[0], np.float32(extender[1]), extender[2])
    assert extender_pairs.layer_name(PREFIX, *found) == name


@pytest.mark.parametrize("strength", [math.nan, math.inf, -math.inf, 1.1e4, -1e38])
def test_a_strength_that_is_none_counts_as_zero(strength):
    assert extender_pairs.properties(PREFIX, extender_pairs.layer_name(PREFIX, "Nose", strength, True)) == (
        "Nose",
        0.0,
        True,
    )


@pytest.mark.parametrize(
    "name",
    ["", "Attribute", ".spectral_extenders:8f01", ".spectral_extender:", ".spectral_extender:1:x"]
    + [f".spectral_extender:1:{number}:x" for number in ("", "1e", "--1", "1.2.3", "one", "nan", "inf", "1e5")],
)
def test_other_layers_are_no_extenders(name):
    assert extender_pairs.properties(PREFIX, name) is None


def test_long_names_are_cut_between_characters():
    # Blender cuts names of layers off after 63 bytes.
    name = extender_pairs.layer_name(PREFIX, "推" * 40, -1.23456789e-5, True)
    assert 60 < len(name.encode()) <= 63
    kept, _, _ = extender_pairs.properties(PREFIX, name)
    assert kept == "推" * len(kept)


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
