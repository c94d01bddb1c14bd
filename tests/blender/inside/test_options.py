# SPDX-License-Identifier: GPL-3.0-or-later
"""Hole filling, image aspect, subdivision, object scale and margins; compared with Blender's own Unwrap."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def extents(edited):
    """Return width and height of the map."""
    return np.ptp(scenes.read_uv(edited), axis=0)


def ring():
    """A bumpy grid of 6 x 6 faces without the middle four."""
    new = scenes.bumpy_grid(6, 6)
    scenes.edit(new)
    scenes.select_faces(new, [14, 15, 20, 21])
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.mesh.select_all(action="SELECT")
    return new


@pytest.mark.parametrize(("width", "height"), [(1024, 512), (256, 1024)])
@pytest.mark.parametrize("keep_in_place", [False, True])
def test_aspect_of_the_image_is_corrected_as_in_blender(keep_in_place, width, height):
    cylinder = scenes.cylinder()
    scenes.show_image(cylinder, width, height)
    scenes.edit(cylinder)
    before = scenes.read_uv(cylinder)
    ratios = {}
    for correct in (False, True):
        scenes.write_uv(cylinder, before)
        assert bpy.ops.uv.unwrap(method="CONFORMAL", correct_aspect=correct) == {"FINISHED"}
        theirs = extents(cylinder)
        scenes.write_uv(cylinder, before)
        assert bpy.ops.uv.spectral_unwrap(correct_aspect=correct, keep_in_place=keep_in_place) == {"FINISHED"}
        image = (width, height) if correct else (1, 1)
        ours, theirs = sorted(extents(cylinder) * image), sorted(theirs * image)
        ratios[correct] = ours[1] / ours[0], theirs[1] / theirs[0]
        # The texture lies on the surface without distortion.
        uv = scenes.read_uv(cylinder) * image
        scenes.write_uv(cylinder, uv / max(image))
        assert scenes.quasi_conformal(cylinder)[0].max() < 1.001
    for ours, theirs in ratios.values():
        assert ours == pytest.approx(theirs, rel=1e-3)


def test_aspect_of_the_image_counts_without_a_selection():
    grid = scenes.grid(3, 3)
    scenes.show_image(grid, 1024, 256)
    scenes.edit(grid, select=False)
    scenes.edit_mesh(grid).faces.active = None
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_allclose(*(extents(grid) * (4, 1)), rtol=1e-4)


def test_image_of_a_face_without_material_slot_does_not_count():
    cylinder = scenes.cylinder()
    scenes.show_image(cylinder, 1024, 256)
    scenes.edit(cylinder)
    for face in scenes.edit_mesh(cylinder).faces:
        face.material_index = 3
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert scenes.quasi_conformal(cylinder)[0].max() < 1.001


def subdivided_grid(levels=2, first=True):
    """A coarse bumpy grid with a Subdivision Surface modifier, first or after another modifier; in edit mode."""
    new = scenes.bumpy_grid(3, 3)
    for vertex in new.data.vertices:
        vertex.co.z *= 2.0
    if not first:
        new.modifiers.new("Triangulate", "TRIANGULATE")
    new.modifiers.new("Subdivision", "SUBSURF").levels = levels
    scenes.edit(new)
    return new


@pytest.mark.parametrize("keep_in_place", [False, True])
def test_subdivided_surface_is_mapped_as_in_blender(reports, keep_in_place):
    grid = subdivided_grid()
    before, state = scenes.read_uv(grid), scenes.state(grid)
    coarse_and_fine = []
    for use in (False, True):
        scenes.write_uv(grid, before)
        assert bpy.ops.uv.spectral_unwrap(method="LSCM", use_subsurf_data=use, keep_in_place=keep_in_place) == {
            "FINISHED"
        }
        coarse_and_fine.append(scenes.normalized(scenes.read_uv(grid)))
    assert scenes.state(grid) == state
    assert ("Info", "Subdivision Surface modifier needs to be first to work with unwrap") not in reports()
    scenes.write_uv(grid, before)
    assert bpy.ops.uv.unwrap(method="CONFORMAL", use_subsurf_data=True) == {"FINISHED"}
    theirs = scenes.normalized(scenes.read_uv(grid))
    assert np.abs(coarse_and_fine[1] - theirs).max() < np.abs(coarse_and_fine[0] - theirs).max() / 2.0


def test_subdivided_surface_with_pins_hidden_faces_and_seams():
    grid = subdivided_grid()
    scenes.write_uv(grid, scenes.corner_positions(grid)[:, :2] * 0.1)
    before = scenes.read_uv(grid)
    bm = scenes.edit_mesh(grid)
    bm.faces[8].hide_set(True)
    seam = next(edge for edge in bm.edges if {vertex.index for vertex in edge.verts} == {1, 5})
    seam.seam = True
    corners = np.zeros(len(before), dtype=bool)
    corners[[0, 14]] = True
    scenes.pin(grid, corners)
    assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
    after = scenes.read_uv(grid)
    np.testing.assert_array_equal(after[corners], before[corners])
    np.testing.assert_array_equal(after[32:], before[32:])
    # The pins hold their whole vertices, and the hidden face those that it shares.
    held = np.isclose(after[:32], before[:32], atol=1e-6).all(axis=1)
    positions = [tuple(position) for position in scenes.corner_positions(grid)]
    expected = {positions[0], positions[14]} | (set(positions[:32]) & set(positions[32:]))
    assert {positions[corner] for corner in np.flatnonzero(held)} == expected
    # The two faces at the seam have it twice.
    assert np.abs(after[1] - after[4]).max() > 1e-4


@pytest.mark.parametrize("make", [lambda: subdivided_grid(levels=0), lambda: subdivided_grid(first=False)])
def test_subdivision_that_is_not_first_is_told_as_in_blender(reports, make):
    grid = make()
    reports()
    assert bpy.ops.uv.unwrap(use_subsurf_data=True) == {"FINISHED"}
    theirs = {report for report in reports() if "Subdivision" in report[1]}
    assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
    assert {report for report in reports() if "Subdivision" in report[1]} == theirs
    assert len(theirs) == 1
    with_option = scenes.normalized(scenes.read_uv(grid))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_allclose(with_option, scenes.normalized(scenes.read_uv(grid)), atol=1e-5)


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 2, 2), (1, 1, 2), (1, 1, -1), (-1, -1, 1)])
def test_object_scale_is_told_as_in_blender_and_has_no_effect(reports, scale):
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    unscaled = scenes.read_uv(grid)
    grid.scale = scale
    bpy.context.view_layer.update()
    reports()
    assert bpy.ops.uv.unwrap() == {"FINISHED"}
    theirs = [report for report in reports() if report[1].startswith("Object has")]
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert [report for report in reports() if report[1].startswith("Object has")] == theirs
    assert len(theirs) == (scale not in {(1, 1, 1), (2, 2, 2), (-1, -1, 1)})
    np.testing.assert_allclose(scenes.read_uv(grid), unscaled, atol=1e-5)


def test_second_call_without_arguments_uses_the_defaults():
    grid = ring()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    default = scenes.normalized(scenes.read_uv(grid))
    assert bpy.ops.uv.spectral_unwrap(fill_holes=True, method="LSCM") == {"FINISHED"}
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_allclose(scenes.normalized(scenes.read_uv(grid)), default, atol=1e-5)
