# SPDX-License-Identifier: GPL-3.0-or-later
"""The No Overlaps check box, and what single precision cannot hold."""

import re

import bpy
import numpy as np

from tests.blender.inside import scenes


def rough_grid(n=14, roughness=2.0, seed=0):
    """Triangles over a grid, every vertex moved at random: the conformal map has folds."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
    vertices = np.stack([x, y, 0 * x], -1).reshape(-1, 3) + roughness * rng.normal(size=(n * n, 3)) / n
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return scenes.new_object(vertices, np.vstack([np.c_[a, b, c], np.c_[a, c, d]]), name="Rough")


def finger(sides, rings):
    """A tube of unit radius, closed at its far end."""
    angle = 2 * np.pi * np.arange(sides) / sides
    step = 2 * np.pi / sides
    vertices = [(np.cos(a), np.sin(a), k * step) for k in range(rings) for a in angle] + [(0, 0, rings * step)]
    faces = [
        (k * sides + q, k * sides + (q + 1) % sides, (k + 1) * sides + (q + 1) % sides, (k + 1) * sides + q)
        for k in range(rings - 1)
        for q in range(sides)
    ]
    last = (rings - 1) * sides
    faces += [(last + q, last + (q + 1) % sides, rings * sides) for q in range(sides)]
    return scenes.new_object(vertices, faces, name="Finger")


def signed_areas(edited):
    a, b, c = scenes.read_uv(edited).astype(np.float64).reshape(-1, 3, 2).transpose(1, 0, 2)
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def test_no_face_is_flipped_in_the_uv_map_and_the_cost_is_told(reports):
    made = rough_grid()
    scenes.edit(made)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert signed_areas(made).min() < 0
    reports()
    assert bpy.ops.uv.spectral_unwrap(fold_free=True) == {"FINISHED"}
    assert signed_areas(made).min() > 0
    texts = [text for _, text in reports()]
    (told,) = [text for text in texts if text.startswith("No Overlaps: ")]
    assert re.search(r"angles there off by \S+ % on average, \S+ % before$", told)
    assert any("; no flipped faces" in text for text in texts)


def test_faces_below_single_precision_are_told(reports):
    scenes.edit(finger(16, 60))
    reports()
    bpy.ops.uv.spectral_unwrap()
    (warning,) = [text for level, text in reports() if level == "Warning"]
    assert re.match(r"\d+ faces are too small for the precision", warning)
