# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist looks at the distortion of a map, edits it, undoes and looks again."""

import bmesh
import bpy
import gpu
import numpy as np
from bpy_extras import view3d_utils
from mathutils import Matrix

from tests.interface import driving as drive
from tests.interface import extender_sidebar as sidebar
from tests.interface import session
from tests.interface.session import override, screenshot

COLORS = {"low": (0.16, 0.38, 0.85), "middle": (0.98, 0.86, 0.25), "high": (0.86, 0.12, 0.10)}
SMALL, MEDIAN, LARGE = (0.13, 0.40, 0.80), (0.93, 0.93, 0.93), (0.85, 0.25, 0.14)


def toward_large(factor):
    """Return the color between those of the median and of large faces."""
    return tuple(middle + factor * (high - middle) for middle, high in zip(MEDIAN, LARGE))


# Of a face in the first and of one in the last column: where these are two times as wide on the map, so that they have
# 1.41 times the size, half of the way to two times, and to 1.5 times the density 0.83 of it.
LOOKS = {"SIZE": (MEDIAN, toward_large(0.5)), "DENSITY": (MEDIAN, toward_large(0.83)), "DEFECTS": ((0.45,) * 3,) * 2}
LOOKS["STACKS"] = LOOKS["DEFECTS"]
FITTED = {"SIZE": (MEDIAN, LARGE), "DENSITY": (SMALL, LARGE)}
# Of a displayed color, out of 1: Blender mixes its editors in eight bits of linear colors, coarse where dark.
NEARLY = 0.04


def stretch(columns, factor):
    """Make the map of the grid its own positions, its last columns of faces wider by a factor; an undo step."""
    mesh = bpy.context.edit_object.data
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.loops.layers.uv.active
    border = np.sort(np.unique([round(vertex.co.x, 5) for vertex in bm.verts]))[-1 - columns]
    for face in bm.faces:
        for loop in face.loops:
            x, y, _ = loop.vert.co
            loop[layer].uv = 0.2 * (x + max(x - border, 0.0) * (factor - 1.0)) + 0.3, 0.2 * y + 0.3
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    bpy.ops.ed.undo_push(message="Stretch")


def faces_of_columns():
    """Return the indices of a face in the first column and of one in the last, both in the upper half."""
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    upper = [face for face in bm.faces if face.calc_center_median().y > 0.3]
    ends = (min, max)
    return [end(upper, key=lambda face: face.calc_center_median().x).index for end in ends]


def pixel(face, name):
    """Return the color of the middle of a face on the screen, 0 to 1."""
    screenshot(name)
    image = bpy.data.images.load(str(session.SCREENSHOTS / f"{name}.png"))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    region, area = drive.region_of("VIEW_3D"), drive.area_of("VIEW_3D")
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    bm.faces.ensure_lookup_table()
    middle = bpy.context.edit_object.matrix_world @ bm.faces[face].calc_center_median()
    x, y = view3d_utils.location_3d_to_region_2d(region, area.spaces.active.region_3d, middle)
    return pixels.reshape(height, width, 4)[int(region.y + y) + 3, int(region.x + x) + 3, :3]


def check_colors(name, first, last):
    """Check the colors of a face in the first and in the last column."""
    for face, expected in zip(faces_of_columns(), (first, last)):
        found = pixel(face, name)
        assert np.abs(found - expected).max() < NEARLY, (name, face, found, expected)


def drawn_values(low, high):
    """Draw the map into a framebuffer of its own, and return the value at the middle of every face."""
    overlay, triangles = drive.part_of_addon("overlay.map_overlay"), drive.part_of_addon("overlay.colored_triangles")
    ((_, _, view),) = overlay.views(bpy.context)
    size = 512
    offscreen = gpu.types.GPUOffScreen(size, size, format="RGBA32F")
    try:
        with offscreen.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(Matrix(((2, 0, 0, -1), (0, 2, 0, -1), (0, 0, 1, 0), (0, 0, 0, 1))))
            ramp = triangles.Colors((0.0,) * 3, (0.5,) * 3, (1.0,) * 3)
            shader = triangles.shader(is_flat=True, is_displayed=False)
            batch = triangles.batch(triangles.buffer(view.triangle_positions()), *view.triangle_map("ANGLE"))
            triangles.draw(batch, shader, ramp, low, high)
            read = gpu.state.active_framebuffer_get().read_color(0, 0, size, size, 4, 0, "FLOAT")
    finally:
        offscreen.free()
    colors = np.array(read.to_list()).reshape(size, size, 4)
    middles = [np.mean([loop[:] for loop in uv], axis=0) for uv in session.uv().reshape(-1, 4, 2)]
    places = (np.array(middles) * size).astype(int)
    return low + (high - low) * colors[places[:, 1], places[:, 0], 0], view.qc


def steps():
    yield from sidebar.open_grid()
    with override("VIEW_3D"):
        bpy.ops.mesh.select_mode("EXEC_DEFAULT", True, type="FACE")
        bpy.context.space_data.overlay.show_face_center = False
        stretch(2, 2.0)
    shown = bpy.context.window_manager.spectral_map_overlay
    overlay = drive.part_of_addon("overlay.map_overlay")
    shown.opacity = 1.0
    yield from sidebar.click_sidebar(sidebar.SHOW_MAP)
    yield from drive.until(lambda: shown.show)
    yield
    # Angles are kept on the left; on the right they are beyond the end of the range.
    check_colors("map_overlay_angle", COLORS["low"], COLORS["high"])
    # The sidebar says how far they are off once islands are known.
    yield from drive.until(lambda: overlay.figure(bpy.context).endswith(" %"))
    shown.use_range = True
    assert np.allclose(overlay.shown_range(bpy.context), overlay.automatic(bpy.context)), "begins fitted"
    shown.range = 0.0, 200.0
    yield
    yield
    check_colors("map_overlay_own_range", COLORS["low"], COLORS["middle"])
    values, expected = drawn_values(1.0, 3.0)
    assert np.ptp(expected) > 0.9, expected
    assert np.abs(values - expected).max() < 1e-6, (values, expected)
    # It follows an edit, undo and redo.
    with override("VIEW_3D"):
        stretch(2, 3.0)
    yield
    yield
    check_colors("map_overlay_edited", COLORS["low"], COLORS["high"])
    session.point_at("VIEW_3D", 0.3, 0.3)
    session.xdotool("key", "ctrl+z")
    yield
    yield
    check_colors("map_overlay_undone", COLORS["low"], COLORS["middle"])
    # The legend's numbers come when the mesh is left alone.
    yield from drive.until(lambda: all(found.islands_known for _, found, _ in overlay.views(bpy.context)))
    yield
    for kind, colors in LOOKS.items():
        shown.kind = kind
        assert not shown.use_range
        yield
        yield
        check_colors(f"map_overlay_{kind.lower()}", *colors)
        if kind in FITTED:
            shown.use_range = True
            yield
            yield
            check_colors(f"map_overlay_{kind.lower()}_fitted", *FITTED[kind])
    shown.kind = "CHECKER"
    yield
    yield
    square = pixel(faces_of_columns()[0], "map_overlay_checker")
    assert min(np.abs(square - gray).max() for gray in (0.12, 0.92)) < NEARLY, square
    shown.kind = "ANGLE"
    shown.use_range, shown.range = True, (0.0, 200.0)
    # A face that is hidden is not drawn.
    first, _ = faces_of_columns()
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    bm.faces.ensure_lookup_table()
    bm.faces[first].hide_set(True)
    bmesh.update_edit_mesh(bpy.context.edit_object.data)
    yield
    yield
    assert np.abs(pixel(first, "map_overlay_hidden") - COLORS["low"]).max() > 0.1
    # Off: nothing is drawn, nothing kept.
    yield from sidebar.click_sidebar(sidebar.SHOW_MAP)
    yield from drive.until(lambda: not shown.show)
    yield
    assert not drive.part_of_addon("session").of(overlay.Overlay).meshes
    assert np.abs(pixel(faces_of_columns()[1], "map_overlay_off") - COLORS["middle"]).max() > 0.1


drive.run(steps)
