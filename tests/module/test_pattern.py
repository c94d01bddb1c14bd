# SPDX-License-Identifier: GPL-3.0-or-later
"""Patterns: outlines in true size, the seams on both of their sides, and their lengths."""

import io
import re
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal._pattern import map_border
from spectral_conformal.assets import drawing

from tests.module.test_suggest_seams import box

SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
SVG = "{http://www.w3.org/2000/svg}"


def cylinder(around=24, rings=6, radius=0.3, height=2.0):
    """A tube, open at both ends, and the edges of a straight cut."""
    angles = 2 * np.pi * np.arange(around) / around
    circle = radius * np.c_[np.cos(angles), np.sin(angles)]
    vertices = np.concatenate([np.c_[circle, np.full(around, z)] for z in np.linspace(0, height, rings + 1)])
    a, b = np.divmod(np.arange(around * rings), around)
    here, beside = a * around + b, a * around + (b + 1) % around
    quads = np.stack([here, beside, beside + around, here + around], axis=1)
    cut = np.arange(0, around * (rings + 1), around)
    return sc.Mesh(vertices, quads, seam_edges=np.stack([cut[:-1], cut[1:]], axis=1))


def seam_errors(mesh):
    return map_border(mesh, np.ones(len(mesh.face_offsets) - 1, bool)).seam_errors()


def test_a_sheet_that_can_be_developed_is_exact():
    mesh = sc.unwrap(cylinder(), straighten=0.0)
    assert abs(mesh.uv_per_length - 1.0) < 1e-12
    packed = sc.pack(mesh)
    assert max(seam_errors(packed)) < 1e-12
    pattern = sc.pattern(packed)
    assert np.abs(pattern.map_lengths - pattern.lengths).max() < 1e-12
    chord = 0.6 * np.sin(np.pi / 24)
    low, high = pattern.points.min(axis=0), pattern.points.max(axis=0)
    assert np.allclose(np.sort(high - low), [24 * chord, 2.0], rtol=0, atol=1e-12)
    # One seam with two sides of equal length, and the two open ends.
    assert sorted(pattern.seams.tolist()) == [0, 0, 1, 1]
    assert np.allclose(pattern.lengths[pattern.seams == 1], 2.0, rtol=0, atol=1e-12)


def test_the_two_sides_of_every_seam_of_a_box_have_its_number():
    vertices, offsets, corners = box([1, 2, 3], 4)
    packed = sc.pack(sc.unwrap(sc.suggest_seams(sc.Mesh(vertices, offsets, corner_vertices=corners))))
    pattern = sc.pattern(packed)
    assert (pattern.seams > 0).all()
    for seam in range(1, pattern.seams.max() + 1):
        one, other = np.flatnonzero(pattern.seams == seam)
        assert pattern.lengths[one] == pytest.approx(pattern.lengths[other], abs=1e-12)
        ends = [set(end_vertices(pattern, side)) for side in (one, other)]
        assert ends[0] == ends[1]
        assert set(vertices_of(pattern, one)) == set(vertices_of(pattern, other))


def vertices_of(pattern, side):
    first, end = pattern.sides[side : side + 2]
    return [*pattern.vertices[first:end].tolist(), int(pattern.vertices[pattern.ends()[end - 1]])]


def end_vertices(pattern, side):
    found = vertices_of(pattern, side)
    return found[0], found[-1]


def test_lengths_along_seams_are_measured_on_both_sides():
    """Two squares that share an edge, one of them wider in the map: sides of 1 and 2 for an edge of 1."""
    corners = [[0, 1, 2, 3], [1, 4, 5, 2]]
    vertices = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)], float)
    uv = np.concatenate([SQUARE, SQUARE * (1, 2) + (5, 0)])
    mesh = sc.Mesh(vertices, corners, uv)
    scale = np.sqrt(3 / 2)
    assert mesh.uv_per_length == pytest.approx(scale)
    error, mismatch = seam_errors(mesh)
    assert error == pytest.approx((abs(1 / scale - 1) + abs(2 / scale - 1)) / 2)
    assert mismatch == pytest.approx(1 / scale)
    pattern = sc.pattern(mesh)
    assert pattern.map_lengths[pattern.seams == 1] == pytest.approx([1 / scale, 2 / scale])


def test_without_seams_nothing_is_wrong_along_them():
    mesh = sc.Mesh(np.c_[SQUARE, np.zeros(4)], [[0, 1, 2, 3]], SQUARE * (1, 3))
    assert seam_errors(mesh) == (0.0, 0.0)
    assert sc.pattern(mesh).seams.tolist() == [0]


def test_a_hole_and_two_parts_that_touch_at_a_point_are_outlines_of_their_own():
    places = np.array([(x, y, 0.0) for y in range(4) for x in range(4)])
    ring = [[y * 4 + x, y * 4 + x + 1, y * 4 + x + 5, y * 4 + x + 4] for y in range(3) for x in range(3)]
    del ring[4]
    mesh = sc.Mesh(places, ring, places[np.array(ring).ravel(), :2])
    assert np.diff(sc.pattern(mesh).outlines).tolist() == [12, 4]
    bow_tie = sc.Mesh(places, [ring[0], [5, 6, 10, 9]], places[np.array([ring[0], [5, 6, 10, 9]]).ravel(), :2])
    assert np.diff(sc.pattern(bow_tie).outlines).tolist() == [4, 4]


def test_winding_does_not_matter():
    mesh = cylinder()
    packed = sc.pack(sc.unwrap(mesh))
    corners = packed.corner_vertices.reshape(-1, 4).copy()
    uv = packed.uv.reshape(-1, 4, 2).copy()
    corners[::2], uv[::2] = corners[::2, ::-1], uv[::2, ::-1]
    turned = sc.pattern(sc.Mesh(packed.vertices, corners, uv))
    pattern = sc.pattern(packed)
    assert np.diff(turned.outlines).tolist() == np.diff(pattern.outlines).tolist()
    assert sorted(turned.lengths) == pytest.approx(sorted(pattern.lengths))
    # The island lies where its middle is.
    for found in (turned, pattern):
        edges = found.points[found.ends()] - found.points
        middle = found.points.mean(axis=0) - found.points
        assert (found.inward * (edges[:, 0] * middle[:, 1] - edges[:, 1] * middle[:, 0]) > 0).all()


def test_faces_without_a_map_are_left_out():
    uv = np.concatenate([SQUARE, np.full((4, 2), np.nan)])
    vertices = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)], float)
    pattern = sc.pattern(sc.Mesh(vertices, [[0, 1, 2, 3], [1, 4, 5, 2]], uv))
    assert pattern.seams.tolist() == [0] and len(pattern.points) == 4


@pytest.mark.parametrize("uv", [SQUARE * 0.0, np.full((4, 2), np.nan), SQUARE * 1e300])
def test_a_map_without_area_has_no_pattern(uv):
    with pytest.raises(ValueError, match="no area"):
        sc.pattern(sc.Mesh(np.c_[SQUARE, np.zeros(4)], [[0, 1, 2, 3]], uv))


def test_pixels_that_are_not_square_do_not_change_the_pattern():
    vertices, faces = np.c_[SQUARE * (1, 2), np.zeros(4)], [[0, 1, 2, 3]]
    wide = sc.pattern(sc.Mesh(vertices, faces, SQUARE * (0.25, 1.0)), aspect=2.0)
    assert wide.points == pytest.approx(SQUARE * (1, 2))
    with pytest.raises(ValueError, match="aspect must be above 0"):
        sc.pattern(sc.Mesh(vertices, faces, SQUARE), aspect=0.0)


def pattern_of_box():
    vertices, offsets, corners = box([1, 2, 3], 4)
    return sc.pattern(sc.pack(sc.unwrap(sc.suggest_seams(sc.Mesh(vertices, offsets, corner_vertices=corners)))))


def test_svg_is_in_true_size_with_the_numbers_on_both_sides():
    pattern = pattern_of_box()
    root = ElementTree.fromstring(drawing.svg(pattern, 10.0))
    width, height = (float(root.get(name).removesuffix("mm")) for name in ("width", "height"))
    extent = 10.0 * (pattern.points.max(axis=0) - pattern.points.min(axis=0))
    assert (width, height) == pytest.approx(tuple(extent + 0.2), rel=1e-14)
    assert [float(word) for word in root.get("viewBox").split()] == [0, 0, width, height]
    polygons = root.findall(f"{SVG}g[@id='OUTLINES']/{SVG}polygon")
    assert len(polygons) == len(pattern.outlines) - 1
    drawn = np.concatenate([np.array([pair.split(",") for pair in p.get("points").split()], float) for p in polygons])
    found = np.hypot(*(drawn[pattern.ends()] - drawn).T)
    expected = 10.0 * np.hypot(*(pattern.points[pattern.ends()] - pattern.points).T)
    assert np.abs(found - expected).max() < 1e-12
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert sorted(map(int, texts)) == sorted(pattern.seams.tolist())
    # Numbers lie inside of their islands: y points downward here.
    for text in root.iter(f"{SVG}text"):
        x, y = (float(word) for word in re.findall(r"-?\d[\d.e+-]*", text.get("transform"))[1:])
        assert is_inside(drawn, pattern, (x, y))


def is_inside(points, pattern, place):
    """The winding number by the angles at which the outlines are seen."""
    z = (points - place) @ [1, 1j]
    return abs(np.angle(z[pattern.ends()] / z).sum()) > np.pi


def test_dxf_is_in_millimeters_and_always_the_same():
    ezdxf = pytest.importorskip("ezdxf")
    pattern = pattern_of_box()
    text = drawing.dxf(pattern, 10.0)
    assert text == drawing.dxf(pattern, 10.0)
    document = ezdxf.read(io.StringIO(text))
    assert document.units == ezdxf.units.MM
    assert not document.audit().errors
    space = document.modelspace()
    lines = space.query("LWPOLYLINE")
    assert all(line.closed for line in lines) and len(lines) == len(pattern.outlines) - 1
    drawn = np.concatenate([np.array(line.get_points("xy")) for line in lines])
    expected = 10.0 * (pattern.points - pattern.points.min(axis=0))
    assert np.abs(drawn - expected).max() < 1e-12
    assert sorted(int(each.dxf.text) for each in space.query("TEXT")) == sorted(pattern.seams.tolist())
    assert not ezdxf.options.write_fixed_meta_data_for_testing


def test_without_the_library_the_error_names_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(ValueError, match="DXF needs ezdxf: pip install"):
        drawing.dxf(pattern_of_box())


def test_a_seam_that_three_sheets_share_has_three_sides():
    """Three squares that meet at one edge: two of them may be one island, the third one has that seam alone."""
    turns = 2 * np.pi * np.arange(3) / 3
    vertices = [(0, 0, 0), (0, 0, 1), *((np.cos(t), np.sin(t), z) for t in turns for z in (0, 1))]
    faces = [[0, 2 + 2 * k, 3 + 2 * k, 1] for k in range(3)]
    uv = np.concatenate([SQUARE + (2 * k, 0) for k in range(3)])
    pattern = sc.pattern(sc.Mesh(np.array(vertices, float), faces, uv))
    assert (pattern.seams == 1).sum() == 3


def test_a_closed_seam_begins_at_the_same_vertex_on_both_sides():
    mesh = cylinder(around=8, rings=2)
    uv = np.zeros((len(mesh.corner_vertices), 2))
    # Two rings seen from above, the lower one larger: the seam between them is closed in both.
    for face in range(16):
        here = slice(4 * face, 4 * face + 4)
        places = mesh.vertices[mesh.corner_vertices[here]]
        uv[here] = places[:, :2] * (1.0 + places[:, 2:]) + (10.0 * (face // 8), 0.0)
    pattern = sc.pattern(sc.Mesh(mesh.vertices, mesh.face_offsets, uv, corner_vertices=mesh.corner_vertices))
    one, other = np.flatnonzero(pattern.seams == 1)
    assert pattern.vertices[pattern.sides[one]] == pattern.vertices[pattern.sides[other]]
    assert set(vertices_of(pattern, one)) == set(vertices_of(pattern, other))
