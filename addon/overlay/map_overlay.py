# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours faces by what the active UV map does to them, in the 3D viewport and in the UV editor.

Shown are the meshes in edit mode, and in object mode those of the selected objects as their modifiers leave them. While
the overlay is off nothing is read, computed or drawn. What is drawn follows every edit at once; the numbers that need
the islands, which take longer, come when the mesh has been left alone for a moment.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence

import bpy
import gpu
import numpy as np

from .. import editors, names, user_preferences
from ..core import choices
from ..core.errors import PrintOnce
from ..core.measure.map_view import IslandNumbers, MapView, automatic_range, joined_numbers
from ..core.mesh.polygon_mesh import MAP, SURFACE, PolygonMesh
from ..core.words import texts
from ..edit_mesh import read_map
from . import colored_triangles, legend
from .colored_triangles import Colors
from .in_front import in_front_of_faces

# Nearer than this fraction of the distance nothing lies before the faces; edges and vertices are drawn nearer still.
_NEARER = 0.0003
# Seconds without an edit after which the islands are looked at.
_QUIET_SECONDS = 0.3
_NEEDS_ISLANDS = frozenset({choices.LOOK_DEFECTS})


class _ShownMesh:
    """What is known and drawn of the mesh of one object."""

    def __init__(self) -> None:
        self._view: MapView | None = None
        self._is_stale = True
        self._trusts_faces = False
        self._batches: dict[tuple[str, float], gpu.types.GPUBatch] = {}
        self._in_editor: dict[tuple[str, float], gpu.types.GPUBatch] = {}
        self._places: gpu.types.GPUVertBuf | None = None
        self.is_too_large = False
        self.islands_known = False

    def edited(self) -> None:
        self._is_stale = True

    def view(self, context: bpy.types.Context, shown: bpy.types.Object) -> MapView | None:
        """Return what the object shows now; None without faces or a UV map."""
        if self._is_stale:
            self._read(context, shown, self._view and self._view.mesh)
        return self._view

    def confirm(self, context: bpy.types.Context, shown: bpy.types.Object) -> MapView | None:
        """Return what `view` returns, after reading again what it took for granted to be fast."""
        if self._trusts_faces:
            self._read(context, shown, None)
        return self._view

    def _read(self, context: bpy.types.Context, shown: bpy.types.Object, before: PolygonMesh | None) -> None:
        self._is_stale = False
        most = user_preferences.read("overlay_max_faces", user_preferences.MAX_FACES)
        self.is_too_large = read_map.n_faces(context, shown) > most
        arrays = None
        if not self.is_too_large:
            arrays = read_map.read_map(context, shown, _preview.get(shown.name_full), before)
        are_known = arrays is not None and before is not None
        self._trusts_faces = are_known and arrays.face_offsets is before.face_offsets
        self._show(arrays)

    def _show(self, arrays: PolygonMesh | None) -> None:
        """Take up what was read, and keep what it does not change."""
        before = self._view
        if arrays is None and before is None:
            return
        has_mesh = arrays is not None and before is not None and arrays.equals(before.mesh, SURFACE)
        if has_mesh and arrays.equals(before.mesh, MAP):
            return
        self._view = None if arrays is None else MapView(arrays, before if has_mesh else None)
        self._batches.clear()
        self._in_editor.clear()
        self.islands_known = False
        if not has_mesh:
            self._places = None

    def batch(self, kind: str, density: float, in_editor: bool) -> gpu.types.GPUBatch | None:
        """Return the triangles to draw for the view that was asked for last; None for none."""
        known, key = (self._in_editor if in_editor else self._batches), (kind, density)
        if key not in known:
            known.clear()
            uv, values = self._view.triangle_map(kind, density)
            chosen = np.repeat(self._view.is_in_uv_editor(), 3) if in_editor else np.ones(1, dtype=bool)
            if not chosen.all():
                places = colored_triangles.places(self._view.triangle_positions()[chosen]) if chosen.any() else None
                uv, values = uv[chosen], values[chosen]
            else:
                if self._places is None:
                    self._places = self._places_of_all()
                places = self._places
            known[key] = colored_triangles.batch(places, uv, values) if len(values) else None
        return known[key]

    def _places_of_all(self) -> gpu.types.GPUVertBuf | None:
        positions = self._view.triangle_positions()
        return colored_triangles.places(positions) if len(positions) else None


_shown: dict[str, _ShownMesh] = {}
# The automatic range, kept while the mesh is edited: colours that change all the time tell nothing.
_range: dict[tuple, tuple[float, float]] = {}
# The numbers of the maps shown last, together.
_numbers: dict[tuple[MapView, ...], IslandNumbers] = {}
_handles: list[tuple[type, object]] = []
# UVs shown in place of those of objects, by their full names: a map that an artist may choose.
_preview: dict[str, np.ndarray] = {}
# The face whose numbers the legend has, by the name of its object and its index.
_pointed_at: tuple[str, int] | None = None
_print_once = PrintOnce(lambda problem: texts.not_drawn(texts.MAP_OVERLAY_LABEL, problem))
_edited_at = 0.0


def settings() -> bpy.types.PropertyGroup:
    """Return the properties of the overlay."""
    return getattr(bpy.context.window_manager, names.MAP_OVERLAY_PROPERTY)


def is_on() -> bool:
    """Return whether the overlay is shown."""
    return settings().show


def follow_switch() -> None:
    """Take up drawing, or end it and forget everything, as the switch says, whoever has turned it."""
    if is_on():
        _add_handlers()
    else:
        _remove_handlers()
    redraw(bpy.context)


def edited() -> None:
    """Look at the shown meshes again when they are drawn next."""
    global _edited_at  # noqa: PLW0603 - the overlay is one, like the list of its handlers
    if not _handles:
        return
    _edited_at = time.monotonic()
    for shown in _shown.values():
        shown.edited()


def on_update(depsgraph: bpy.types.Depsgraph) -> None:
    """Look at the shown meshes again if Blender has updated a geometry."""
    if _handles and any(update.is_updated_geometry for update in depsgraph.updates):
        edited()


def forget() -> None:
    """Forget all meshes, as names mean others in another file."""
    global _pointed_at  # noqa: PLW0603 - see point_at
    _pointed_at = None
    _preview.clear()
    _shown.clear()
    _range.clear()
    _numbers.clear()


def preview(context: bpy.types.Context, maps: Mapping[str, np.ndarray]) -> None:
    """Show these UVs, (C, 2), of objects in edit mode by their full names, in place of their own; none to end that."""
    if maps or _preview:
        _preview.clear()
        _preview.update(maps)
        edited()
        redraw(context)


def point_at(context: bpy.types.Context, face: tuple[str, int] | None) -> None:
    """Let the legend have the numbers of a face, given the full name of its object and its index; None for no face."""
    global _pointed_at  # noqa: PLW0603 - there is one mouse
    if face != _pointed_at:
        _pointed_at = face
        redraw(context)


def redraw(context: bpy.types.Context) -> None:
    """Draw all editors that show the overlay again."""
    editors.redraw(context)


def shown_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the objects whose maps are shown, each mesh in edit mode once."""
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    return [each for each in context.selected_objects if each.type == "MESH"] if context.mode == "OBJECT" else []


def views(context: bpy.types.Context) -> list[tuple[bpy.types.Object, _ShownMesh, MapView]]:
    """Return the objects that have a map to show, with it."""
    objects = shown_objects(context)
    keys = [each.name_full for each in objects]
    for gone in set(_shown).difference(keys):
        del _shown[gone]
    found = []
    for key, each in zip(keys, objects):
        shown = _shown.setdefault(key, _ShownMesh())
        view = shown.view(context, each)
        if view is not None:
            found.append((each, shown, view))
    return found


def automatic(context: bpy.types.Context) -> tuple[float, float]:
    """Return the range of the colours that follows the shown maps."""
    found, chosen = views(context), settings()
    key = (chosen.kind, chosen.image_size, *(each.name_full for each, *_ in found))
    if found and key not in _range:
        _range.clear()
        _range[key] = automatic_range([view for *_, view in found], chosen.kind, chosen.image_size)
    return _range[key] if found else (0.0, 1.0)


def shown_range(context: bpy.types.Context) -> tuple[float, float]:
    """Return the values at the two ends of the colours."""
    chosen = settings()
    if chosen.use_range and chosen.kind not in (choices.LOOK_DEFECTS, choices.LOOK_CHECKER):
        return chosen.range_low, max(chosen.range_high, chosen.range_low + 1e-6)
    return automatic(context)


def colors() -> Colors:
    """Return the colours that the overlay has now."""
    chosen = settings()
    return legend.colors_of(chosen.kind, chosen.opacity)


def _guarded(draw: Callable[[bpy.types.Context], None]) -> Callable[[], None]:
    """Return a function for Blender to call, which prints an error once instead of with every redraw."""

    def guarded() -> None:
        try:
            draw(bpy.context)
        except Exception as error:  # noqa: BLE001 - it would come again with every redraw
            _print_once(error)

    return guarded


def _draw_in_viewport(context: bpy.types.Context) -> None:
    space = context.space_data
    if not space.overlay.show_overlays:
        return
    ready = list(_ready(context))
    if not ready:
        return
    chosen, low_high = settings(), shown_range(context)
    is_through = space.shading.type == "WIREFRAME" or (space.shading.type == "SOLID" and space.shading.show_xray)
    shader = colored_triangles.shader(is_flat=False)
    with in_front_of_faces(context.region_data, _NEARER):
        gpu.state.depth_test_set("NONE" if is_through else "LESS_EQUAL")
        for each, shown, _view in ready:
            triangles = shown.batch(chosen.kind, chosen.image_size, in_editor=False)
            if triangles is None or not each.visible_in_viewport_get(space):
                continue
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(each.matrix_world)
                colored_triangles.draw(triangles, shader, colors(), *low_high, _checks(chosen))


def _draw_in_uv_editor(context: bpy.types.Context) -> None:
    space = context.space_data
    if not (space.show_uvedit and space.overlay.show_overlays and context.mode == "EDIT_MESH"):
        return
    if _preview:
        # It would lie among the UVs that there are.
        return
    ready = list(_ready(context))
    chosen, low_high = settings(), shown_range(context)
    gpu.state.blend_set("ALPHA")
    try:
        for _each, shown, _view in ready:
            triangles = shown.batch(chosen.kind, chosen.image_size, in_editor=True)
            if triangles is not None:
                shader = colored_triangles.shader(is_flat=True)
                colored_triangles.draw(triangles, shader, colors(), *low_high, _checks(chosen))
    finally:
        gpu.state.blend_set("NONE")


def _ready(context: bpy.types.Context) -> Iterator[tuple[bpy.types.Object, _ShownMesh, MapView]]:
    """Yield what can be drawn now: flipped and overlapping faces only once they are known."""
    needs_islands = settings().kind in _NEEDS_ISLANDS
    for found in views(context):
        if needs_islands and not found[1].islands_known:
            continue
        yield found
    _look_at_islands_later(context)


def _checks(chosen: bpy.types.PropertyGroup) -> float:
    return float(chosen.checks) if chosen.kind == choices.LOOK_CHECKER else 0.0


def _draw_legend(context: bpy.types.Context) -> None:
    space = context.space_data
    if not (settings().legend and space.overlay.show_overlays):
        return
    if context.area.type == "IMAGE_EDITOR" and not (space.show_uvedit and context.mode == "EDIT_MESH"):
        return
    found = views(context)
    too_large = [each.name for each in shown_objects(context) if _shown[each.name_full].is_too_large]
    if not (found or too_large):
        return
    chosen = settings()
    lines = texts.too_many_faces(too_large)
    if found and all(shown.islands_known for _, shown, _ in found):
        lines.extend(texts.legend_numbers(texts.LEGEND_MESH, _joined_numbers([view for *_, view in found])))
        lines.extend(_active_island_lines(context, found))
    for each, shown, view in found:
        if _pointed_at is not None and each.name_full == _pointed_at[0] and _pointed_at[1] < len(view.qc):
            lines.extend(_face_lines(shown, view, _pointed_at[1], chosen.image_size))
    legend.draw(context, chosen.kind, colors(), shown_range(context), lines)


def _joined_numbers(shown: Sequence[MapView]) -> IslandNumbers:
    """Return the numbers of all shown maps together."""
    key = tuple(shown)
    if key not in _numbers:
        _numbers.clear()
        _numbers[key] = joined_numbers(shown)
    return _numbers[key]


def _active_island_lines(
    context: bpy.types.Context, found: Sequence[tuple[bpy.types.Object, _ShownMesh, MapView]]
) -> Sequence[str]:
    """Return the lines on the island of the active object's active face; none without one."""
    for each, _, view in found:
        if each != context.object:
            continue
        face = read_map.active_face(each)
        if 0 <= face < len(view.island_of_face) and view.island_of_face[face] >= 0:
            island = view.numbers([int(view.island_of_face[face])])
            return texts.legend_numbers(texts.LEGEND_ISLAND, island)
    return ()


def _face_lines(shown: _ShownMesh, view: MapView, face: int, image_size: int) -> tuple[str, ...]:
    values = [float(view.values(kind, image_size)[face]) for kind in (choices.LOOK_ANGLE, choices.LOOK_SIZE)]
    density = float(view.values(choices.LOOK_DENSITY, image_size)[face])
    defects = [bool(each[face]) for each in (view.flipped, view.overlapping)] if shown.islands_known else [False] * 2
    return texts.face_numbers(*values, density, *defects)


def _look_at_islands_later(context: bpy.types.Context) -> None:
    waits = any(not shown.islands_known for _, shown, _ in views(context))
    if waits and not bpy.app.timers.is_registered(_look_at_islands):
        bpy.app.timers.register(_look_at_islands, first_interval=_QUIET_SECONDS)


def _look_at_islands() -> float | None:
    """Look at the islands of the shown meshes, unless an edit was just made; returns when to try again."""
    if not _handles:
        return None
    left = _QUIET_SECONDS - (time.monotonic() - _edited_at)
    if left > 0.0:
        return left
    try:
        found = views(bpy.context)
        for each, shown, _view in found:
            if not shown.islands_known:
                view = shown.confirm(bpy.context, each)
                # Looked at here, and not while drawing.
                shown.islands_known = view is not None and len(view.island_of_face) > 0
                _range.clear()
                redraw(bpy.context)
        if found and all(shown.islands_known for _, shown, _ in found):
            _joined_numbers([view for *_, view in views(bpy.context)])
    except Exception as error:  # noqa: BLE001 - a timer that fails is lost without a word
        _print_once(error)
    return None


def _add_handlers() -> None:
    if _handles or bpy.app.background:
        return
    for space, draw, kind in (
        (bpy.types.SpaceView3D, _draw_in_viewport, "POST_VIEW"),
        (bpy.types.SpaceView3D, _draw_legend, "POST_PIXEL"),
        (bpy.types.SpaceImageEditor, _draw_in_uv_editor, "POST_VIEW"),
        (bpy.types.SpaceImageEditor, _draw_legend, "POST_PIXEL"),
    ):
        _handles.append((space, space.draw_handler_add(_guarded(draw), (), "WINDOW", kind)))


def _remove_handlers() -> None:
    for space, handle in _handles:
        space.draw_handler_remove(handle, "WINDOW")
    _handles.clear()
    forget()


def register() -> None:
    """Nothing is drawn before `follow_switch`."""


def unregister() -> None:
    """Draw nothing any more and forget everything."""
    _remove_handlers()
    redraw(bpy.context)
    if bpy.app.timers.is_registered(_look_at_islands):
        bpy.app.timers.unregister(_look_at_islands)
    colored_triangles.shader.cache_clear()
    _print_once.forget()
