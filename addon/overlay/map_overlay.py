# SPDX-License-Identifier: GPL-3.0-or-later
"""Color faces by the quality of the active UV map, in the 3D viewport and the UV editor.

The overlay shows the meshes in edit mode or, in object mode, those of the selected objects with their modifiers. While
it is off, nothing is read, computed or drawn. Colors follow every edit at once; numbers that need the islands, which
take longer, follow after a moment without edits.
"""

import functools
import itertools
import time
from collections.abc import Callable, Iterator, Mapping, Sequence

import bpy
import gpu
import numpy as np

from .. import editors, names, session
from ..core import choices
from ..core.measure.map_view import (
    MapView,
    automatic_range,
    fixed_range,
    joined_density,
    joined_numbers,
    median_log2_scale,
)
from ..core.measure.stacks import Stacks, stacks
from ..core.measure.texels import Texels
from ..core.mesh.world_scale import metric_of
from ..core.words import texts
from ..core.words.percent import percent_of_qc, qc_of_percent
from ..edit_mesh import read_map
from ..edit_mesh.texture_size import margin_pixels, texels
from ..session import Remembered, edit_meshes, identity
from ..session.problems import print_once
from . import colored_triangles, draw_handlers, legend
from .colored_triangles import Colors
from .in_front import in_front_of_faces
from .shown_mesh import ShownMesh

# Faces move this fraction of the distance toward the viewer; Blender draws edges and vertices nearer still.
_NEARER = 0.0003
# Seconds without an edit after which islands are computed.
_QUIET_SECONDS = 0.3
# The smallest factor of sizes at the end of a custom range: its logarithm must be finite.
_MIN_SIZE = 1e-3
# With more objects than this, the legend has only the numbers of all together.
_MAX_OBJECTS = 6
# Windows with scenes of their own, whose numbers are kept.
_MAX_WINDOWS = 4
_NEEDS_ISLANDS = frozenset({choices.LOOK_DEFECTS, choices.LOOK_STACKS})
_WITHOUT_RANGE = frozenset({choices.LOOK_DEFECTS, choices.LOOK_CHECKER, choices.LOOK_STACKS})
_BAND = (0.95, 0.75, 0.2)
# Hues of consecutive stacks differ most with steps of the golden ratio.
_HUE_STEP = 0.618034


class Overlay(Remembered):
    """What the overlay has read and shows, as long as it is on.

    Attributes:
        meshes: by the keys of their objects (`identity.key`).
        range: the default ranges, kept while the mesh is edited, so that colors stay comparable.
        numbers: a function, of maps shown together.
        stacks: a function of maps shown together, which returns their stacks, the hues of the faces by map, and a
            serial number of these.
        median: a function of maps shown together: the median of the binary logarithm of their scale.
        preview: UVs, (C, 2), shown instead of those of objects, by their keys.
        pointed_at: the face in the legend, by the key of its object and its index.
        edited_at: time of the last edit of a shown mesh.
    """

    def __init__(self) -> None:
        """Show nothing yet."""
        self.meshes: dict[int, ShownMesh] = {}
        self.range: dict[tuple, tuple[float, float]] = {}
        # Windows may show different scenes.
        self.numbers = functools.lru_cache(_MAX_WINDOWS * (_MAX_OBJECTS + 1))(joined_numbers)
        self.stacks = functools.lru_cache(_MAX_WINDOWS)(functools.partial(_stacks, itertools.count(1)))
        self.median = functools.lru_cache(_MAX_WINDOWS)(median_log2_scale)
        self.preview: dict[int, np.ndarray] = {}
        self.pointed_at: tuple[int, int] | None = None
        self.edited_at = 0.0

    def end(self) -> None:
        """Stop the timer."""
        if bpy.app.timers.is_registered(_look_at_islands):
            bpy.app.timers.unregister(_look_at_islands)


def settings() -> bpy.types.PropertyGroup:
    """Return the properties of the overlay."""
    return getattr(bpy.context.window_manager, names.MAP_OVERLAY_PROPERTY)


def is_on() -> bool:
    """Return whether the overlay is shown."""
    return settings().show


def edited() -> None:
    """Read the shown meshes again when they are drawn next."""
    overlay = session.of(Overlay)
    overlay.edited_at = time.monotonic()
    for shown in overlay.meshes.values():
        shown.edited()
    for kept in (overlay.numbers, overlay.stacks, overlay.median):
        # They would hold maps that are gone.
        kept.cache_clear()


def on_update(depsgraph: bpy.types.Depsgraph) -> None:
    """Read the shown meshes again if Blender has updated a geometry, a material, or the scale of a shown object."""
    if is_on() and any(_concerns_maps(update) for update in depsgraph.updates):
        edited()


def _concerns_maps(update: bpy.types.DepsgraphUpdate) -> bool:
    if update.is_updated_geometry or isinstance(update.id, bpy.types.Material):
        return True
    if not isinstance(update.id, bpy.types.Object):
        return False
    shown = session.of(Overlay).meshes.get(identity.key(update.id.original))
    return shown is not None and update.is_updated_transform and not shown.has_scale(metric_of(update.id.matrix_world))


def preview(context: bpy.types.Context, maps: Mapping[int, np.ndarray]) -> None:
    """Show these UVs, (C, 2), of objects in edit mode, by key, instead of their own; none to end that."""
    overlay = session.of(Overlay)
    if maps or overlay.preview:
        overlay.preview = dict(maps)
        edited()
        editors.redraw(context)


def point_at(context: bpy.types.Context, face: tuple[int, int] | None) -> None:
    """Show the numbers of a face in the legend, given the key of its object and its index; None for no face."""
    overlay = session.of(Overlay)
    if face != overlay.pointed_at:
        overlay.pointed_at = face
        editors.redraw(context)


def _may_be_shown(view_layer: bpy.types.ViewLayer) -> Iterator[bpy.types.Object]:
    """Yield the objects whose maps a window with this view layer may show."""
    for each in view_layer.objects:
        if each.type == "MESH" and (each.mode == "EDIT" or each.select_get(view_layer=view_layer)):
            yield each


def shown_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the objects whose maps are shown, each mesh in edit mode once."""
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    return [each for each in context.selected_objects if each.type == "MESH"] if context.mode == "OBJECT" else []


def views(context: bpy.types.Context) -> list[tuple[bpy.types.Object, ShownMesh, MapView]]:
    """Return the objects with a map to show, and the map."""
    objects = shown_objects(context)
    keys = [identity.key(each) for each in objects]
    overlay = session.of(Overlay)
    if not overlay.meshes.keys() <= set(keys):
        in_windows = {
            identity.key(each) for window in context.window_manager.windows for each in _may_be_shown(window.view_layer)
        }
        for gone in set(overlay.meshes).difference(keys, in_windows):
            del overlay.meshes[gone]
    found = []
    for key, each in zip(keys, objects):
        shown = overlay.meshes.setdefault(key, ShownMesh())
        view = shown.view(context, each, overlay.preview.get(key))
        if view is not None:
            found.append((each, shown, view))
    return found


def fixed(context: bpy.types.Context) -> tuple[float, float]:
    """Return the default range for the shown maps."""
    found, chosen = views(context), settings()
    key = (chosen.kind, texels(context), *(identity.key(each) for each, *_ in found))
    known = session.of(Overlay).range
    if found and key not in known:
        if len(known) >= _MAX_WINDOWS:
            known.clear()
        known[key] = fixed_range([view for *_, view in found], chosen.kind, texels(context))
    return known[key] if found else (0.0, 1.0)


def automatic(context: bpy.types.Context) -> tuple[float, float]:
    """Return the range of most of the surface of the shown maps."""
    found = [view for *_, view in views(context)]
    return automatic_range(found, settings().kind, texels(context)) if found else fixed(context)


def set_range(low_high: tuple[float, float]) -> None:
    """Make these values the custom range; angles are in percent there, sizes factors."""
    chosen = settings()
    of_kind = {choices.LOOK_ANGLE: percent_of_qc, choices.LOOK_SIZE: np.exp2}.get(chosen.kind, float)
    chosen.range = list(map(of_kind, low_high))


def shown_range(context: bpy.types.Context) -> tuple[float, float]:
    """Return the values at the two ends of the colors."""
    chosen = settings()
    if not chosen.use_range or chosen.kind in _WITHOUT_RANGE:
        return fixed(context)
    low, high = chosen.range
    if chosen.kind == choices.LOOK_ANGLE:
        low, high = qc_of_percent(low), qc_of_percent(high)
    if chosen.kind == choices.LOOK_SIZE:
        low, high = np.log2(np.maximum((low, high), _MIN_SIZE)).tolist()
    return low, max(high, low + 1e-6)


def colors() -> Colors:
    """Return the current colors of the overlay."""
    chosen = settings()
    return legend.colors_of(chosen.kind, chosen.opacity)


def _draw_in_viewport(context: bpy.types.Context) -> None:
    space = context.space_data
    if not space.overlay.show_overlays:
        return
    ready = list(_ready(context))
    if not ready:
        return
    low_high = shown_range(context)
    is_through = space.shading.type == "WIREFRAME" or (space.shading.type == "SOLID" and space.shading.show_xray)
    with in_front_of_faces(context.region_data, _NEARER):
        gpu.state.depth_test_set("NONE" if is_through else "LESS_EQUAL")
        for each, shown, view in ready:
            if each.visible_in_viewport_get(space):
                with gpu.matrix.push_pop():
                    gpu.matrix.multiply_matrix(each.matrix_world)
                    _draw_map(context, shown, view, ready, low_high, in_editor=False)


def _draw_in_uv_editor(context: bpy.types.Context) -> None:
    space = context.space_data
    if not (space.show_uvedit and space.overlay.show_overlays and context.mode == "EDIT_MESH"):
        return
    if session.of(Overlay).preview:
        # It would lie among the actual UVs.
        return
    ready = list(_ready(context))
    chosen, low_high = settings(), shown_range(context)
    gpu.state.blend_set("ALPHA")
    try:
        for _each, shown, _view in ready if _has_hues(chosen) else ():
            band = shown.band(margin_pixels(context), texels(context))
            if band is not None:
                color = Colors(_BAND, _BAND, _BAND)
                colored_triangles.draw(band, colored_triangles.shader(is_flat=True), color, 0.0, 1.0, as_hues=True)
        for _each, shown, view in ready:
            _draw_map(context, shown, view, ready, low_high, in_editor=True)
    finally:
        gpu.state.blend_set("NONE")


def _draw_map(
    context: bpy.types.Context,
    shown: ShownMesh,
    view: MapView,
    ready: Sequence[tuple],
    low_high: tuple[float, float],
    in_editor: bool,
) -> None:
    """Draw one of the maps that are `ready`, in the UV editor or with the current matrices."""
    chosen = settings()
    triangles = shown.batch(chosen.kind, texels(context), in_editor, _own_values(view, ready))
    if triangles is not None:
        shader, ends = colored_triangles.shader(is_flat=in_editor), _ends_of(view, ready, low_high)
        checks = float(chosen.checks) if chosen.kind == choices.LOOK_CHECKER else 0.0
        colored_triangles.draw(triangles, shader, colors(), *ends, checks, _has_hues(chosen))


def _ready(context: bpy.types.Context) -> Iterator[tuple[bpy.types.Object, ShownMesh, MapView]]:
    """Yield the maps that can be drawn now: flipped and overlapping faces need islands."""
    needs_islands = settings().kind in _NEEDS_ISLANDS
    for found in views(context):
        if needs_islands and not found[1].islands_known:
            continue
        yield found
    _look_at_islands_later(context)


def _has_hues(chosen: bpy.types.PropertyGroup) -> bool:
    return chosen.kind == choices.LOOK_STACKS


def _own_values(view: MapView, ready: Sequence[tuple]) -> tuple[int, np.ndarray] | None:
    """Return the hues of the stacks in a map, with their serial number; None for other kinds."""
    if not _has_hues(settings()):
        return None
    _, hues, serial = session.of(Overlay).stacks(tuple(each for *_, each in ready))
    return serial, hues[view]


def _stacks(serials: Iterator[int], shown: tuple[MapView, ...]) -> tuple[Stacks, dict[MapView, np.ndarray], int]:
    """Return the stacks, the hues of all faces, -1 for islands alone, and the next serial number."""
    # Islands that agree to a pixel show the same pixels.
    found = stacks(shown, 1.0 / texels(bpy.context).side)
    hues = [np.where(stack < 0, -1.0, (stack * _HUE_STEP) % 1.0) for stack in found.of_face]
    return found, dict(zip(shown, hues)), next(serials)


def _draw_legend(context: bpy.types.Context) -> None:
    space = context.space_data
    if not (settings().legend and space.overlay.show_overlays):
        return
    if context.area.type == "IMAGE_EDITOR" and not (space.show_uvedit and context.mode == "EDIT_MESH"):
        return
    found, overlay = views(context), session.of(Overlay)
    too_large = [each.name for each in shown_objects(context) if overlay.meshes[identity.key(each)].is_too_large]
    if not (found or too_large):
        return
    chosen = settings()
    lines = texts.too_many_faces(too_large)
    if found and all(shown.islands_known for _, shown, _ in found):
        if _has_hues(chosen):
            of_all, _, _ = overlay.stacks(tuple(view for *_, view in found))
            margin = margin_pixels(context)
            lines.extend(texts.stacked(of_all.count, of_all.islands, of_all.fill, of_all.tiles, margin))
        lines.extend(texts.legend_numbers(texts.LEGEND_MESH, overlay.numbers(tuple(view for *_, view in found))))
        lines.extend(_object_lines(found, texels(context)))
        lines.extend(_active_island_lines(context, found))
    for each, shown, view in found:
        key, face = overlay.pointed_at or (0, -1)
        if identity.key(each) == key and face < len(view.qc):
            lines.extend(_face_lines(shown, view, face, median_of_all([view for *_, view in found]), texels(context)))
    legend.draw(context, chosen.kind, colors(), shown_range(context), lines)


def figure(context: bpy.types.Context) -> str:
    """Return the number of the shown maps as read last, for the sidebar; empty where none is known."""
    if not (is_on() and _is_kept(context)):
        return ""
    overlay, measured = session.of(Overlay), texels(context)
    meshes = [overlay.meshes.get(identity.key(each)) for each in shown_objects(context)]
    read = [each for each in meshes if each is not None and each.last_view is not None]
    if not read or not all(each.islands_known for each in read):
        return ""
    shown = tuple(each.last_view for each in read)
    kind = settings().kind
    density = joined_density(shown, measured) if kind == choices.LOOK_DENSITY else 0.0
    return texts.figure(kind, overlay.numbers(shown), density, measured.symbol)


def median_of_all(shown: Sequence[MapView]) -> float:
    """Return the median of the binary logarithm of the scale of all these maps; sizes are relative to it."""
    return session.of(Overlay).median(tuple(shown))


def _ends_of(view: MapView, ready: Sequence[tuple], low_high: tuple[float, float]) -> tuple[float, float]:
    """Return the values at the two ends of the colors for the triangles of one map.

    Their sizes are relative to the median of their own map, those of the legend to the median of all maps.
    """
    low, high = low_high
    shift = 0.0
    if settings().kind == choices.LOOK_SIZE:
        shift = median_of_all([each for *_, each in ready]) - view.median_log2_scale
    return low + shift, high + shift


def _object_lines(found: Sequence[tuple[bpy.types.Object, ShownMesh, MapView]], measured: Texels) -> list[str]:
    """Return a line for each of several objects."""
    if len(found) < 2:
        return []
    lines = []
    for each, _, view in found[:_MAX_OBJECTS]:
        numbers = session.of(Overlay).numbers((view,))
        lines.append(texts.legend_object(each.name, numbers, view.mean_density(measured), measured.symbol))
    return [*lines, *texts.legend_more(len(found) - _MAX_OBJECTS)]


def _active_island_lines(
    context: bpy.types.Context, found: Sequence[tuple[bpy.types.Object, ShownMesh, MapView]]
) -> Sequence[str]:
    """Return the lines about the island of the active face; none without one."""
    for each, _, view in found:
        if each != context.object:
            continue
        face = read_map.active_face(each)
        if 0 <= face < len(view.island_of_face) and view.island_of_face[face] >= 0:
            island = view.numbers([int(view.island_of_face[face])])
            return texts.legend_numbers("Active island", island)
    return ()


def _face_lines(shown: ShownMesh, view: MapView, face: int, median: float, measured: Texels) -> tuple[str, ...]:
    values = [float(each[face]) for each in (view.qc, view.values(choices.LOOK_SIZE, measured, median))]
    density = texts.density(float(view.densities(measured)[face]), measured.symbol)
    defects = [bool(each[face]) for each in (view.flipped, view.overlapping)] if shown.islands_known else [False] * 2
    return texts.face_numbers(*values, density, *defects)


def _look_at_islands_later(context: bpy.types.Context) -> None:
    waits = any(not shown.islands_known for _, shown, _ in views(context))
    if waits and not bpy.app.timers.is_registered(_look_at_islands):
        bpy.app.timers.register(_look_at_islands, first_interval=_QUIET_SECONDS)


def _look_at_islands() -> float | None:
    """Compute the islands of the shown meshes; after a recent edit, return when to try again."""
    if not is_on():
        return None
    overlay = session.of(Overlay)
    left = _QUIET_SECONDS - (time.monotonic() - overlay.edited_at)
    if left > 0.0:
        return left
    try:
        # A timer has no window of its own.
        for window in bpy.context.window_manager.windows:
            with bpy.context.temp_override(window=window):
                _look_at_islands_of(bpy.context)
    except Exception as error:  # noqa: BLE001 - a timer that fails ends silently
        print_once(error, lambda problem: texts.not_drawn(texts.MAP_OVERLAY_LABEL, problem))
    return None


def _look_at_islands_of(context: bpy.types.Context) -> None:
    """Compute the islands of the meshes that a window shows."""
    overlay, found = session.of(Overlay), views(context)
    for each, shown, _view in found:
        if not shown.islands_known:
            view = shown.confirm(context, each, overlay.preview.get(identity.key(each)))
            # Computed here, not while drawing.
            shown.islands_known = view is not None and len(view.island_of_face) > 0
            overlay.range.clear()
            editors.redraw(context)
    if found and all(shown.islands_known for _, shown, _ in found):
        overlay.numbers(tuple(view for *_, view in views(context)))


def _is_kept(context: bpy.types.Context) -> bool:
    """Return whether all that is drawn in edit mode is kept: drawing may not make a wrapper (`edit_meshes`)."""
    return context.mode != "EDIT_MESH" or all(
        edit_meshes.kept(each.data) is not None for each in context.objects_in_mode_unique_data
    )


def _while_on(draw: Callable[[bpy.types.Context], None]) -> Callable[[bpy.types.Context], None]:
    """Return a function that draws while the switch is on, and otherwise drops the read meshes."""

    def drawn(context: bpy.types.Context) -> None:
        if is_on():
            if _is_kept(context):
                draw(context)
        else:
            session.drop(Overlay)

    return drawn


def add_draw_handlers() -> None:
    """Start drawing; only the switch decides whether anything is drawn."""
    for space, draw, when in (
        (bpy.types.SpaceView3D, _draw_in_viewport, "POST_VIEW"),
        (bpy.types.SpaceView3D, _draw_legend, "POST_PIXEL"),
        (bpy.types.SpaceImageEditor, _draw_in_uv_editor, "POST_VIEW"),
        (bpy.types.SpaceImageEditor, _draw_legend, "POST_PIXEL"),
    ):
        draw_handlers.add(space, _while_on(draw), when, name=texts.MAP_OVERLAY_LABEL)
