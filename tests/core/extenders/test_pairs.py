# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders apart from Blender: pairs of the selection, names, amounts."""

import numpy as np
import pytest
import spectral_conformal
from spectral_unwrap.core.errors import ReadableError
from spectral_unwrap.core.extenders import pairs as extender_pairs

from tests.benchmarks import extender_response


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


@pytest.mark.parametrize("name", extender_response.SURFACES)
def test_the_effect_of_a_push_is_about_even_over_the_slider(name):
    columns, rows, height = extender_response.SURFACES[name]
    # The response does not depend on the resolution.
    columns, rows = columns // 2, rows // 2
    mesh = extender_response.surface(columns, rows, height)
    solver = spectral_conformal.Solver(*mesh)
    free = solver.solve().uv
    for pair in extender_response.pairs(columns, rows).values():
        half = extender_response.half_of(mesh, free, pair)
        strengths = [extender_pairs.strength_of(amount, half) for amount in (0.0, 20.0, 50.0, 100.0)]
        none, *pushed = (extender_response.distance(solver, mesh, pair, strength) for strength in strengths)
        fifth, middle = ((each - none) / (pushed[-1] - none) for each in pushed[:-1])
        # Even would be 20 and 50 %. Corners of a hill answer most at the beginning.
        assert 0.19 < fifth < 0.33
        assert 0.49 < middle < 0.7


def test_without_a_map_an_island_or_an_extent_half_is_the_usual_one():
    mesh = extender_response.surface(2, 2, lambda x, y: 0.0 * x)
    flat = mesh[0][:, :2]
    # Four corners and four middles of the sides, at squares of 1/2 and 1/4 from the middle; the diagonal has 2.
    assert extender_response.half_of(mesh, flat, (0, 8)) == pytest.approx(0.375 / 2.0)
    for uv, pair in ((0.0 * flat, (0, 8)), (flat * np.nan, (0, 8)), (np.where(flat > 0.9, 0.0, flat), (0, 8))):
        assert extender_response.half_of(mesh, uv, pair) == extender_pairs.HALF
    without_faces = (mesh[0], np.zeros((0, 3), int))
    assert extender_response.half_of(without_faces, flat, (0, 8)) == extender_pairs.HALF


@pytest.mark.parametrize("strength", [0.0, 0.2, -0.2, 1.0, 1e3, -1e3, 1e-3])
def test_amounts_stand_for_strengths(strength):
    amount = extender_pairs.amount_of(strength)
    assert abs(amount) < 100.0
    assert extender_pairs.strength_of(amount) == pytest.approx(strength)


def test_amounts_end_at_the_limit_of_strengths():
    assert [extender_pairs.strength_of(amount) for amount in (-200.0, -100.0, 0.0, 100.0, 1e9)] == pytest.approx(
        [-1e4, -1e4, 0.0, 1e4, 1e4]
    )
