# SPDX-License-Identifier: GPL-3.0-or-later
"""The style of seams: found by the shape, or chosen."""

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal._seam_style import hardness, style_of

from . import meshes
from .hard_surfaces import HARD_SURFACES
from .test_suggest_seams import box, closed_creature, length


def polygons(name):
    vertices, faces = HARD_SURFACES[name].make()
    sizes = np.cumsum([0, *map(len, faces)])
    return np.asarray(vertices, float), sizes, np.concatenate(faces).astype(int)


def ball(n):
    vertices, *faces = box((1, 1, 1), n)
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), *faces


@pytest.mark.parametrize("name", HARD_SURFACES)
def test_models_of_hard_surfaces_are_hard(name):
    assert style_of(*polygons(name)) == "hard"


@pytest.mark.parametrize("mesh", [ball(8), closed_creature(), (*meshes.bulge(16, 2.0),)], ids=["ball", "ears", "bulge"])
def test_smooth_bodies_are_organic(mesh):
    if len(mesh) == 2:
        mesh = mesh[0], *meshes.polygons(mesh[1])
    assert style_of(*mesh) == "organic"


def test_finer_meshes_of_a_shape_tell_it_more_clearly():
    """A cylinder's rims hold more and more of the bending, a ball has no creases once its faces are small."""

    def cylinder(n):
        angles = 2 * np.pi * np.arange(n) / n
        ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        k = np.arange(n)
        faces = [k[::-1], n + k, *np.stack([k, (k + 1) % n, n + (k + 1) % n, n + k], axis=1)]
        return np.concatenate([np.c_[ring, 0 * k], np.c_[ring, 1 + 0 * k]]), faces

    found = []
    for n in (16, 32, 64):
        vertices, faces = cylinder(n)
        found.append(hardness(vertices, np.cumsum([0, *map(len, faces)]), np.concatenate(faces)))
    # Of the angle 2 pi / n on n edges of length 1, and pi / 2 on both rims.
    for n, share in zip((16, 32, 64), found):
        rims = 2 * 2 * n * np.sin(np.pi / n) * (np.pi / 2) ** 2
        assert share == pytest.approx(rims / (rims + n * (2 * np.pi / n) ** 2))
    assert found == sorted(found)
    assert hardness(*ball(2)) == 1.0
    assert hardness(*ball(6)) == 0.0


def test_hardness_depends_neither_on_scale_nor_on_empty_faces_and_counts_selected_ones():
    vertices, offsets, corners = polygons("rounded block")
    whole = hardness(vertices, offsets, corners)
    assert 0.0 < whole < 1.0
    assert hardness(1e60 * vertices, offsets, corners) == pytest.approx(whole)
    with_empty = np.insert(offsets, 7, offsets[7])
    selected = np.insert(np.ones(len(offsets) - 1, bool), 7, False)
    assert hardness(vertices, with_empty, corners, selected_faces=selected) == pytest.approx(whole)
    one = np.arange(len(offsets) - 1) == 0
    assert hardness(vertices, offsets, corners, selected_faces=one) == 1.0


@pytest.mark.parametrize(("mesh", "style"), [(polygons("bolt"), "hard"), (closed_creature(), "organic")])
def test_the_found_style_is_used_and_said_and_may_be_overruled(mesh, style):
    cuts = {each: sc.suggest_cuts(*mesh, style=each) for each in ("auto", "hard", "organic")}
    assert cuts["auto"].style == style
    assert {each: cuts[each].style for each in ("hard", "organic")} == {"hard": "hard", "organic": "organic"}
    edges = {each: np.concatenate(found).tolist() for each, found in cuts.items()}
    assert edges["auto"] == edges[style]


def test_organic_seams_are_shorter():
    """In sum: which of two good searches wins on one body is chance."""
    total = dict.fromkeys(("hard", "organic"), 0.0)
    for size, limbs, seed in ((300, 4, 3), (400, 4, 1), (400, 4, 2), (400, 4, 3), (400, 5, 3)):
        mesh = meshes.limbs(size, limbs, seed)
        for style in total:
            total[style] += length(mesh[0], sc.suggest_seams(*mesh, style=style).seam_edges)
    assert total["organic"] < total["hard"]


def test_the_style_does_not_matter_to_the_shortest_seams():
    mesh = closed_creature(6)
    one, other = (sc.suggest_cuts(*mesh, style=style, shortest=True, energy_limit=4.2) for style in ("hard", "organic"))
    assert np.array_equal(np.concatenate(one), np.concatenate(other))
    assert one.style == other.style == "hard"
