# SPDX-License-Identifier: GPL-3.0-or-later
"""The No Flip check box, and what single precision cannot hold."""

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


def floater(offset):
    """Three triangles around one inner vertex that stands aside (Floater 1998)."""
    vertices = [(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.5, offset, 1)]
    return scenes.new_object(vertices, [(0, 1, 3), (1, 2, 3), (2, 0, 3)], name="Floater")


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
    for make in (rough_grid, lambda: floater(-2.0), lambda: floater(-1.0)):
        made = make()
        scenes.edit(made)
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        assert signed_areas(made).min() < 1e-9
        reports()
        assert bpy.ops.uv.spectral_unwrap(no_flip=True) == {"FINISHED"}
        assert signed_areas(made).min() > 0
        texts = [text for _, text in reports()]
        (told,) = [text for text in texts if text.startswith("No Flip: ")]
        assert re.search(r"angles there off by \S+ % on average, \S+ % before$", told)
        assert any("; no flipped faces" in text for text in texts)
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(made)


def test_faces_below_single_precision_are_told(reports):
    long, short = finger(16, 60), finger(16, 10)
    scenes.edit(short)
    reports()
    bpy.ops.uv.spectral_unwrap()
    assert not any("too small for the precision" in text for _, text in reports())
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.edit(long)
    bpy.ops.uv.spectral_unwrap()
    (warning,) = [text for level, text in reports() if level == "Warning"]
    count = int(re.match(r"(\d+) faces are too small for the precision", warning)[1])
    # As many as have no area in what was written, up to a factor.
    uv = scenes.read_uv(long)
    ends = np.cumsum([0] + [len(face.vertices) for face in long.data.polygons])[:-1]
    extent = (np.maximum.reduceat(uv, ends) - np.minimum.reduceat(uv, ends)).max(axis=1)
    merged = np.count_nonzero(extent < 2.0**-23)
    assert 0.5 * count <= merged <= 2 * count
