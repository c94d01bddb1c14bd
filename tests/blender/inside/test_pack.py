# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectral Pack: which islands move and where to, what stays to the last bit, and what it reports."""

import importlib

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

# Of a cube whose six faces are islands.
FACES = 6


def edit_cubes(count=1):
    """Cubes whose faces are islands in a row, of which every second is half as wide, in edit mode."""
    cubes = [scenes.cube(name=f"Cube {k}", all_seams=True) for k in range(count)]
    scenes.edit(*cubes)
    for k, cube in enumerate(cubes):
        square = np.array([(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)])
        sizes = [(0.5 if face % 2 else 1.0, 1.0) for face in range(FACES)]
        uv = [square * size + (0.15 * face, 0.2 * k) for face, size in enumerate(sizes)]
        scenes.write_uv(cube, np.concatenate(uv).tolist())
    return cubes


def moved(edited, before):
    """Return which faces have moved in the map."""
    return (scenes.read_uv(edited) != before).any(axis=1).reshape(FACES, 4).any(axis=1).tolist()


def gap(*edited):
    """Return the least distance of two islands, and of one to the border of the tile, for islands along the axes."""
    faces = np.concatenate([scenes.read_uv(each).reshape(-1, 4, 2) for each in edited])
    low, high = faces.min(axis=1), faces.max(axis=1)
    apart = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
    np.fill_diagonal(apart, np.inf)
    return apart.min(), min(low.min(), 1.0 - high.max())


def test_islands_of_several_objects_fill_the_tile_with_their_margin(reports):
    cubes = edit_cubes(2)
    before, state = scenes.read_uv(cubes[0]), scenes.state(cubes[0])
    options = {"margin": 8.0, "texture_size": 512, "rotation": "QUARTERS", "steps": 3}
    assert bpy.ops.uv.spectral_pack(**options) == {"FINISHED"}
    assert scenes.state(cubes[0]) == state
    assert not scenes.overlapping_faces(*cubes).any()
    between, border = gap(*cubes)
    assert min(between, border) * 512 > 8.0 - 0.01
    ((level, text),) = reports()
    assert level == "Info"
    assert text.startswith("Packed 12 islands; ")
    fill = int(text.split("; ")[1].split()[0])
    areas = [np.ptp(scenes.read_uv(cube).reshape(-1, 4, 2), axis=1).prod(axis=1).sum() for cube in cubes]
    assert fill == int(100.0 * sum(areas)) and fill > 70
    # The same again, and undone.
    after = scenes.read_uv(cubes[0])
    scenes.write_uv(cubes[0], before.tolist())
    scenes.write_uv(cubes[1], (before + (0.0, 0.2)).tolist())
    assert bpy.ops.uv.spectral_pack(**options) == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(cubes[0]), after)


@pytest.mark.parametrize("rotation", [{}, {"rotation": "UPRIGHT"}], ids=["default", "upright"])
def test_straight_islands_that_lean_become_upright(reports, rotation):
    (cube,) = edit_cubes()

    def leaning():
        faces = scenes.read_uv(cube).reshape(-1, 4, 2)
        return np.abs(np.roll(faces, 1, axis=1) - faces).min(axis=2).max(axis=1) > 1e-5

    turn = np.array([[np.cos(0.4), np.sin(0.4)], [-np.sin(0.4), np.cos(0.4)]])
    scenes.write_uv(cube, (scenes.read_uv(cube) @ turn).tolist())
    assert bpy.ops.uv.spectral_pack(rotation="QUARTERS", steps=0) == {"FINISHED"}
    assert leaning().all()
    assert bpy.ops.uv.spectral_pack(**rotation, steps=0) == {"FINISHED"}
    assert not leaning().any()
    assert not scenes.overlapping_faces(cube).any()
    assert reports()[-1][1].startswith("Packed 6 islands")


def test_hidden_pinned_and_unselected_islands_stay_and_are_packed_around(reports):
    (cube,) = edit_cubes()
    before = scenes.read_uv(cube)
    scenes.select_faces(cube, [0, 1, 2, 3])
    bm = scenes.edit_mesh(cube)
    layer = bm.loops.layers.uv.active
    for loop in bm.faces[1].loops:
        loop[layer].pin_uv = True
    bm.faces[5].hide_set(True)
    bmesh.update_edit_mesh(cube.data)
    assert bpy.ops.uv.spectral_pack(steps=0) == {"FINISHED"}
    assert moved(cube, before) == [True, False, True, True, False, False]
    assert not scenes.overlapping_faces(cube).any()
    assert reports()[0] == ("Info", "1 pinned island stays where it is")
    assert bpy.ops.uv.spectral_pack(steps=0, hold_pinned=False) == {"FINISHED"}
    assert moved(cube, before) == [True, True, True, True, False, False]
    scenes.select_faces(cube, [1])
    reports()
    assert bpy.ops.uv.spectral_pack() == {"CANCELLED"}
    assert reports() == [("Warning", "Nothing can move: all selected islands are pinned")]


@pytest.mark.parametrize("sync", [False, True])
def test_selection_of_the_uv_editor(uv_editor, sync):
    bpy.context.scene.tool_settings.use_uv_select_sync = sync
    (cube,) = edit_cubes()
    before = scenes.read_uv(cube)
    if sync:
        scenes.select_faces(cube, [0, 1])
    else:
        scenes.set_uv_flags(cube, scenes.corners_of(cube, [0, 1]))
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_pack(steps=0) == {"FINISHED"}
    assert moved(cube, before) == [True, True, False, False, False, False]


def test_tiles():
    (cube,) = edit_cubes()
    uv = scenes.read_uv(cube)
    uv[8:12] += (1.0, 1.0)
    scenes.write_uv(cube, uv.tolist())

    def tiles_of_faces():
        return np.floor(scenes.read_uv(cube).reshape(FACES, 4, 2).mean(axis=1)).astype(int).tolist()

    assert bpy.ops.uv.spectral_pack(steps=0) == {"FINISHED"}
    assert tiles_of_faces() == [[0, 0], [0, 0], [1, 1], [0, 0], [0, 0], [0, 0]]
    assert bpy.ops.uv.spectral_pack(steps=0, tiles="ACTIVE") == {"FINISHED"}
    assert tiles_of_faces() == [[0, 0]] * FACES
    assert bpy.ops.uv.spectral_pack(steps=0, tiles="SEVERAL", tile_count=3) == {"FINISHED"}
    assert {tuple(tile) for tile in tiles_of_faces()} == {(0, 0), (1, 0), (2, 0)}
    # The tile that is active in the UV editor.
    area = bpy.context.window_manager.windows[0].screen.areas[0]
    area.ui_type = "UV"
    image = bpy.data.images.new("Tiled", 64, 64, tiled=True)
    image.tiles.active = image.tiles.new(1012)
    area.spaces.active.image = image
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area):
        assert bpy.ops.uv.spectral_pack(steps=0, tiles="ACTIVE") == {"FINISHED"}
    assert tiles_of_faces() == [[1, 1]] * FACES


def test_stacks_and_sizes(reports):
    (cube,) = edit_cubes()
    before = scenes.read_uv(cube)
    assert bpy.ops.uv.spectral_pack(steps=0, stacks="EQUAL") == {"FINISHED"}
    assert "; 4 stacked on others; " in reports()[-1][1]
    # Three each lie on each other, and go on doing so unless they shall lie apart.
    assert scenes.overlapping_faces(cube).all()
    assert bpy.ops.uv.spectral_pack(steps=0) == {"FINISHED"}
    assert scenes.overlapping_faces(cube).all()
    assert bpy.ops.uv.spectral_pack(steps=0, stacks="APART") == {"FINISHED"}
    assert not scenes.overlapping_faces(cube).any()
    # Without scaling, islands that are too large stay.
    scenes.write_uv(cube, (before * 7.0).tolist())
    stay = scenes.read_uv(cube)
    reports()
    assert bpy.ops.uv.spectral_pack(steps=0, scale=False, tiles="ACTIVE") == {"FINISHED"}
    ((_, packed), (level, text)) = reports()
    assert level == "Warning"
    assert text.startswith(f"{moved(cube, stay).count(False)} of 6 islands found no room")
    assert packed.startswith(f"Packed {moved(cube, stay).count(True)} ")


def test_the_image_of_the_material_gives_size_and_aspect(reports):
    (cube,) = edit_cubes()
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.show_image(cube, 256, 64)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.uv.spectral_pack(margin=4.0, rotation="NONE", steps=0) == {"FINISHED"}
    faces = scenes.read_uv(cube).reshape(FACES, 4, 2) * (256, 64)
    low, high = faces.min(axis=1), faces.max(axis=1)
    apart = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
    np.fill_diagonal(apart, np.inf)
    assert apart.min() > 4.0 - 0.01 and low.min() > 4.0 - 0.01
    reports()
    with pytest.raises(RuntimeError, match="A margin of 64 px leaves no room within 64 px"):
        bpy.ops.uv.spectral_pack(margin=64.0)


def test_groups_and_a_box(reports):
    cubes = edit_cubes(2)
    before = [scenes.read_uv(cube) for cube in cubes]

    def shapes():
        parts = [scenes.read_uv(cube) for cube in cubes]
        return [np.linalg.norm(uv[:, None] - uv, axis=2) / np.linalg.norm(uv[0] - uv[-1]) for uv in parts]

    as_they_were = shapes()
    box = {"tiles": "BOX", "box": (0.5, 0.5, 0.0, 1.0)}
    assert bpy.ops.uv.spectral_pack(steps=0, groups="OBJECT", **box) == {"FINISHED"}
    report = reports()[-1][1]
    assert report.startswith("Packed 2 groups; ") and "of the box filled" in report
    np.testing.assert_allclose(shapes(), as_they_were, atol=1e-4)
    uv = np.concatenate([scenes.read_uv(cube) for cube in cubes])
    assert (uv >= (0.0, 0.5)).all() and (uv <= (0.5, 1.0)).all()
    # Two faces of each cube have another material, and move as one.
    for cube, own in zip(cubes, before):
        scenes.write_uv(cube, own.tolist())
        for name in ("Wood", "Steel"):
            cube.data.materials.append(bpy.data.materials.get(name) or bpy.data.materials.new(name))
        for face in scenes.edit_mesh(cube).faces:
            face.material_index = int(face.index < 2)
    assert bpy.ops.uv.spectral_pack(steps=0, groups="MATERIAL", rotation="NONE") == {"FINISHED"}
    ends = [scenes.read_uv(cube).reshape(FACES, 4, 2)[:, 0] for cube in cubes]
    starts = [uv.reshape(FACES, 4, 2)[:, 0] for uv in before]
    steel, wood = (
        [np.concatenate([part[faces] for part in parts]) for parts in (starts, ends)]
        for faces in (slice(0, 2), slice(2, None))
    )
    for was, now in (steel, wood):
        scale = np.linalg.norm(now[1] - now[0]) / np.linalg.norm(was[1] - was[0])
        np.testing.assert_allclose(now - now[0], scale * (was - was[0]), atol=1e-5)


def test_a_custom_region_that_blender_hides_is_mentioned(reports):
    edit_cubes()
    bpy.context.tool_settings.use_uv_select_sync = True
    if hasattr(bpy.context.tool_settings, "use_uv_custom_region"):
        bpy.context.tool_settings.use_uv_custom_region = True
    for tiles, is_mentioned in (("ACTIVE", hasattr(bpy.context.tool_settings, "use_uv_custom_region")), ("BOX", False)):
        assert bpy.ops.uv.spectral_pack(tiles=tiles, steps=0) == {"FINISHED"}
        assert any("Custom Region" in text for _, text in reports()) == is_mentioned


def test_overlaps_whole_pixels_and_the_smallest_island(reports):
    (cube,) = edit_cubes()
    uv = scenes.read_uv(cube)
    # The second island lies across the first, and the last is a hundredth as large.
    uv[4:8] += (-0.1, 0.02)
    uv[20:24] = uv[20] + 0.01 * (uv[20:24] - uv[20])
    scenes.write_uv(cube, uv.tolist())
    before = scenes.read_uv(cube)
    options = {"texture_size": 512, "rotation": "NONE", "min_size": 6.0, "snap": True, "steps": 0}
    assert bpy.ops.uv.spectral_pack(**options, stacks="OVERLAPPING") == {"FINISHED"}
    faces = 512 * scenes.read_uv(cube).reshape(-1, 4, 2)
    assert np.abs(faces - np.round(faces)).max() < 1e-3
    assert 6.0 <= np.ptp(faces[5], axis=0).max() <= 7.0
    scale = np.ptp(faces[0], axis=0) / np.ptp(before[:4], axis=0)
    assert faces[1] - faces[0, 0] == pytest.approx((before[4:8] - before[0]) * scale, abs=1.0)
    ((_, text),) = reports()
    assert text.startswith("Packed 6 islands; ") and "; 1 stacked on others; " in text


def test_as_many_tiles_as_islands_of_a_size_need(reports):
    (cube,) = edit_cubes()
    scenes.write_uv(cube, (4.0 * scenes.read_uv(cube)).tolist())
    options = {"tiles": "AUTO", "texture_size": 512, "rotation": "NONE", "steps": 0}
    assert bpy.ops.uv.spectral_pack(**options) == {"FINISHED"}
    faces = scenes.read_uv(cube).reshape(-1, 4, 2)
    assert np.ptp(faces, axis=1)[:, 1] == pytest.approx(np.full(FACES, 0.4), abs=1e-5)
    # Six islands with 0.4 x 0.4 and 0.2 x 0.4, four of the large ones or as much in a tile.
    assert np.ptp(np.floor(faces.mean(axis=1)[:, 0])) == 1.0
    ((_, text),) = reports()
    assert "of 2 tiles" in text
    scenes.write_uv(cube, (4.0 * scenes.read_uv(cube)).tolist())
    with pytest.raises(RuntimeError, match="do not fit into a tile"):
        bpy.ops.uv.spectral_pack(**options)


def test_the_sidebar_keeps_the_fill_of_the_last_packing_until_the_next():
    packing = importlib.import_module("spectral_unwrap.unwrapping.packing")
    edit_cubes()
    assert packing.last_fill() is None
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    fill = packing.last_fill()
    assert 0.3 < fill <= 1.0
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    assert packing.last_fill() == fill
