# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap: the map follows while pins are moved, and after seams are marked or cleared.

Blender tells only that a mesh has changed. So every mesh in edit mode is watched: what has changed is the difference
from how it was seen last. A watch also keeps Blender's Python wrapper of the edit mesh alive, because making or freeing
one moves the UVs in memory, to which a running transform holds pointers.
"""

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from itertools import chain, compress

import bmesh
import bpy
import numpy as np
from bmesh.types import BMesh, BMLoop
from bpy.app.handlers import persistent

from .. import compatibility, names
from ..core import texts
from ..core.mesh import PolygonMesh
from ..core.native import NativeModuleError
from ..core.pinned_chart import PinnedChart, changed_edges, chart_of_face, faces_of_charts_at
from ..edit_mesh import selection
from ..edit_mesh.packing import PackingError
from ..edit_mesh.read import EditMesh, active_uv_layer
from ..edit_mesh.write import write_loops
from ..unwrapping import steps
from ..unwrapping.last_settings import last_settings

# A map that takes longer than this waits until the pins rest for a while.
_SLOW = 2.0
_REST = 0.3
# Looking for changes may take this part of the time.
_SHARE = 0.2

_TRANSFORMS = "TRANSFORM_OT_"


@dataclass
class _Chart:
    """A chart whose pins are being moved; `free` are its corners without a pin, `loops` the same in Blender."""

    pinned_chart: PinnedChart
    free: np.ndarray
    loops: list[BMLoop]


@dataclass
class _Drag:
    """A movement of pins, from its start on; `charts` by number, None for those that move as a whole."""

    operator: int
    start: np.ndarray
    chart_of_face: np.ndarray
    charts: dict[int, _Chart | None] = field(default_factory=dict)
    seconds: float = 0.0
    last_motion: float = 0.0


@dataclass
class _Watch:
    """A mesh in edit mode as it was seen last; the `selected_faces` of `polygons` are the visible ones."""

    edit_object: bpy.types.Object
    bm: BMesh
    layer: str
    polygons: PolygonMesh
    pins: np.ndarray
    loops: list[BMLoop]
    operator: int
    drag: _Drag | None = None
    is_late: bool = False

    def fits(self) -> bool:
        """Return whether the loops can still be used."""
        if not self.bm.is_valid or not all(loop.is_valid for loop in self.loops):
            return False
        layer = self.bm.loops.layers.uv.active
        return (
            layer is not None and layer.name == self.layer and len(self.bm.faces) == len(self.polygons.selected_faces)
        )


@dataclass
class _State:
    watches: dict[int, _Watch] = field(default_factory=dict)
    is_busy: bool = False
    is_undoing: bool = False
    last_look: float = 0.0
    look_seconds: float = 0.0
    told: set[str] = field(default_factory=set)


_state = _State()


def is_on(scene: bpy.types.Scene) -> bool:
    """Return whether live unwrapping is on in a scene."""
    return bool(getattr(scene, names.LIVE_UNWRAP_PROPERTY, False))


def look() -> None:
    """Look for changes of pins and seams in the meshes in edit mode, and follow them. Blender calls this by a timer."""
    scene = bpy.context.scene
    if not is_on(scene) or _state.is_busy or _state.is_undoing or any(w.is_late for w in _state.watches.values()):
        return
    start = time.perf_counter()
    with _guarded():
        _look(scene)
    _state.last_look = time.perf_counter()
    _state.look_seconds = _state.last_look - start


def _look(scene: bpy.types.Scene) -> None:
    before = _state.watches
    for watch in before.values():
        if watch.fits():
            _follow_pins(watch, scene)
    now = _see(scene)
    changed = {}
    for key, seen in now.items():
        watch = before.get(key)
        if watch is None or not _same_topology(watch.polygons, seen.polygons):
            continue
        edges = changed_edges(watch.polygons.seam_edges, seen.polygons.seam_edges)
        if len(edges) and _follows_seams(watch.operator):
            changed[key] = edges
        if watch.drag and watch.drag.operator == seen.operator and np.array_equal(watch.pins, seen.pins):
            seen.drag, seen.is_late = watch.drag, watch.is_late
    _state.watches = now
    if changed:
        _follow_seams(scene, changed)


def _see(scene: bpy.types.Scene) -> dict[int, _Watch]:
    """See the meshes in edit mode that have a UV map as they are now."""
    with _window(scene):
        edit_meshes = steps.read(bpy.context, replace(last_settings(), use_subsurf=False), all_visible=True)
    return {m.mesh.as_pointer(): _watch(m) for m in edit_meshes if m.polygons.uv is not None}


def _watch(edit_mesh: EditMesh) -> _Watch:
    polygons = edit_mesh.polygons
    bm, layer = active_uv_layer(edit_mesh.mesh)
    pins = np.flatnonzero(polygons.pinned_corners)
    loops = []
    if len(pins):
        corners = chain.from_iterable(face.loops for face in bm.faces)
        loops = list(compress(corners, polygons.pinned_corners.tolist()))
    return _Watch(edit_mesh.edit_object, bm, layer.name, polygons, pins, loops, _last_operator_address())


def _same_topology(one: PolygonMesh, other: PolygonMesh) -> bool:
    return np.array_equal(one.face_offsets, other.face_offsets) and np.array_equal(
        one.corner_vertices, other.corner_vertices
    )


def _last_operator() -> bpy.types.Operator | None:
    """Return the last operator that ended; while one waits for the mouse, it is not yet among them."""
    operators = bpy.context.window_manager.operators
    return operators[-1] if operators else None


def _last_operator_address() -> int:
    operator = _last_operator()
    return operator.as_pointer() if operator else 0


def _follows_pins(operator_before: int) -> bool:
    """Return whether a movement since `operator_before` had ended is one to follow: a transform, or a script's."""
    return _last_operator_address() == operator_before or _last_operator().bl_idname.startswith(_TRANSFORMS)


def _follows_seams(operator_before: int) -> bool:
    """Return whether seams changed since `operator_before` had ended are to be followed.

    Seams made from the islands of a map are there to keep it.
    """
    return (
        _last_operator_address() == operator_before
        or _last_operator().bl_idname not in names.OPERATORS_THAT_MARK_SEAMS_OF_A_MAP
    )


def _follow_pins(watch: _Watch, scene: bpy.types.Scene, is_resting: bool = False) -> None:
    """Map the charts whose pins have moved since the mesh was seen last."""
    layer = watch.bm.loops.layers.uv.active
    places = np.array([loop[layer].uv for loop in watch.loops], dtype=np.float64).reshape(-1, 2)
    moved = (places != watch.polygons.uv[watch.pins]).any(axis=1)
    if not moved.any() and not (is_resting and watch.is_late):
        return
    if not _follows_pins(watch.operator):
        watch.polygons.uv[watch.pins] = places
        return
    drag = watch.drag
    operator = _last_operator_address()
    if drag is None or drag.operator != watch.operator:
        polygons = watch.polygons
        charts = chart_of_face(polygons, polygons.selected_faces)
        drag = watch.drag = _Drag(watch.operator, polygons.uv.copy(), charts)
    watch.polygons.uv[watch.pins] = places
    drag.last_motion = time.perf_counter()
    _add_charts(watch, drag, watch.pins[moved], scene)
    if drag.seconds > _SLOW and not is_resting:
        watch.is_late = True
        _call_after(_rest, _REST)
        return
    start = time.perf_counter()
    written = [_write(watch, drag, chart) for chart in drag.charts.values() if chart]
    watch.is_late = False
    if any(written):
        bmesh.update_edit_mesh(watch.edit_object.data, loop_triangles=False, destructive=False)
        if operator != drag.operator:
            # The transform has ended, and the map is not in its undo step.
            _call_after(_push_undo_step, 0.0)
    drag.seconds = time.perf_counter() - start


def _add_charts(watch: _Watch, drag: _Drag, moved: np.ndarray, scene: bpy.types.Scene) -> None:
    """Add the charts of the `moved` corners to the drag."""
    polygons = watch.polygons
    face = polygons.face_of_corner()
    fresh = set(drag.chart_of_face[face[moved]].tolist()) - set(drag.charts) - {-1}
    if not fresh:
        return
    layer = watch.bm.loops.layers.uv.active
    selected = compatibility.selected_corners(watch.bm, layer, scene.tool_settings.use_uv_select_sync)
    watch.bm.faces.ensure_lookup_table()
    for number in fresh:
        faces = drag.chart_of_face == number
        if selected[faces[face]].all():
            drag.charts[number] = None
            continue
        loops = [loop for f in np.flatnonzero(faces).tolist() for loop in watch.bm.faces[f].loops]
        pinned_chart = PinnedChart(polygons, faces, polygons.pinned_corners, drag.start)
        free = ~pinned_chart.pinned
        drag.charts[number] = _Chart(pinned_chart, pinned_chart.corners[free], list(compress(loops, free.tolist())))


def _write(watch: _Watch, drag: _Drag, chart: _Chart) -> bool:
    """Write the map of a chart for its pins as they are now; return whether there is one."""
    uv = chart.pinned_chart.map(drag.start, watch.polygons.uv)
    if uv is None:
        return False
    uv = uv[~chart.pinned_chart.pinned]
    layer = watch.bm.loops.layers.uv.active
    write_loops(layer, chart.loops, uv.tolist())
    watch.polygons.uv[chart.free] = uv.astype(np.float32)
    return True


def _follow_seams(scene: bpy.types.Scene, changed: dict[int, np.ndarray]) -> None:
    """Unwrap all visible faces and pack them, as Blender does; to keep islands in place, only those at changed seams.

    `changed` are the edges whose seam has changed, by mesh.
    """
    settings = last_settings()
    with _window(scene):
        edit_meshes = steps.read(bpy.context, settings, all_visible=True)
        if settings.keep_in_place:
            edit_meshes = [m for m in edit_meshes if m.mesh.as_pointer() in changed]
            for edit_mesh in edit_meshes:
                edges = changed[edit_mesh.mesh.as_pointer()]
                visible = edit_mesh.polygons.selected_faces
                visible &= faces_of_charts_at(edit_mesh.polygons, visible, edges)
        solutions = steps.solve(edit_meshes, settings)
        with ExitStack() as stack:
            for watch in _state.watches.values():
                stack.enter_context(selection.visible_faces_selected(watch.bm))
            outcome = steps.write(bpy.context, settings, edit_meshes, solutions)
    _state.watches = _see(scene)
    if outcome.summary.solved:
        _push_undo_step()


@contextmanager
def _window(scene: bpy.types.Scene) -> Iterator[None]:
    """Within, the context has a window that shows the scene, if there is one."""
    windows = [window for window in bpy.context.window_manager.windows if window.scene == scene]
    if not windows:
        yield
        return
    with bpy.context.temp_override(window=windows[0]):
        yield


def _push_undo_step() -> None:
    with _guarded(), _window(bpy.context.scene):
        if bpy.ops.ed.undo_push.poll():
            bpy.ops.ed.undo_push(message=texts.LIVE_UNWRAP_LABEL)


def _rest() -> float | None:
    """Follow pins that have come to rest; called by a timer."""
    scene = bpy.context.scene
    with _guarded():
        for watch in _state.watches.values():
            watch.is_late &= watch.fits()
            if not watch.is_late:
                continue
            wait = watch.drag.last_motion + _REST - time.perf_counter()
            if wait > 0.0:
                return wait
            _follow_pins(watch, scene, is_resting=True)
    _call_after(look, 0.0)
    return None


def _call_after(function: object, seconds: float) -> None:
    if not bpy.app.background and not bpy.app.timers.is_registered(function):
        bpy.app.timers.register(function, first_interval=seconds)


@contextmanager
def _guarded() -> Iterator[None]:
    """Keep the changes made within from being followed, and errors from reaching Blender; tell each once."""
    outer, _state.is_busy = _state.is_busy, True
    try:
        yield
    except (NativeModuleError, PackingError) as error:
        _tell(str(error))
    except Exception as error:  # noqa: BLE001 - an error in a handler would come again with every movement of the mouse
        _state.watches.clear()
        _tell(f"{type(error).__name__}: {error}")
    finally:
        _state.is_busy = outer


@contextmanager
def not_following() -> Iterator[None]:
    """Within, nothing is followed, and what changed within is not followed afterwards."""
    if _state.is_busy or not is_on(bpy.context.scene):
        yield
        return
    _state.is_busy = True
    try:
        yield
    finally:
        _state.is_busy = False
        with _guarded():
            _state.watches = _see(bpy.context.scene)


def _tell(problem: str) -> None:
    if problem not in _state.told:
        _state.told.add(problem)
        print(f"{texts.LIVE_UNWRAP_LABEL} could not follow: {problem}")


@persistent
def _on_depsgraph_update(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not is_on(scene) or _state.is_busy or _state.is_undoing:
        return
    if bpy.context.mode != "EDIT_MESH":
        _state.watches.clear()
        return
    if not any(update.is_updated_geometry for update in depsgraph.updates):
        return
    is_dragging = False
    with _guarded():
        for watch in _state.watches.values():
            if watch.fits():
                _follow_pins(watch, scene)
                is_dragging |= watch.drag is not None and watch.drag.operator == _last_operator_address()
    passed = time.perf_counter() - _state.last_look
    pause = max(_REST if is_dragging else 0.0, _state.look_seconds / _SHARE - passed)
    if is_dragging and bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    _call_after(look, pause)


@persistent
def _before_undo(*_arguments: object) -> None:
    _state.is_undoing = True
    _state.watches.clear()


@persistent
def _before_load(*_arguments: object) -> None:
    _state.watches.clear()


@persistent
def _after_undo_or_load(*_arguments: object) -> None:
    _state.is_undoing = False
    _state.watches.clear()
    if is_on(bpy.context.scene):
        with _guarded():
            _state.watches = _see(bpy.context.scene)


def _on_toggle(_scene: bpy.types.Scene, _context: bpy.types.Context) -> None:
    _state.told.clear()
    _after_undo_or_load()


_HANDLERS = (
    ("depsgraph_update_post", _on_depsgraph_update),
    ("undo_pre", _before_undo),
    ("redo_pre", _before_undo),
    ("load_pre", _before_load),
    ("undo_post", _after_undo_or_load),
    ("redo_post", _after_undo_or_load),
    ("load_post", _after_undo_or_load),
)


def register() -> None:
    """Add the toggle, off, and the handlers."""
    toggle = bpy.props.BoolProperty(
        name=texts.LIVE_UNWRAP_LABEL, description=texts.LIVE_UNWRAP_DESCRIPTION, update=_on_toggle
    )
    setattr(bpy.types.Scene, names.LIVE_UNWRAP_PROPERTY, toggle)
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)


def unregister() -> None:
    """Remove the handlers, the toggle and its values."""
    for timer in (look, _rest, _push_undo_step):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    _state.watches.clear()
    for scene in bpy.data.scenes:
        scene.property_unset(names.LIVE_UNWRAP_PROPERTY)
    delattr(bpy.types.Scene, names.LIVE_UNWRAP_PROPERTY)
