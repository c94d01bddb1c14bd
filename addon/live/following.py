# SPDX-License-Identifier: GPL-3.0-or-later
"""When live unwrapping looks at the meshes in edit mode, and what it lets follow.

`on_update`, which Blender's handlers call, follows moved pins at once and notes which meshes have changed. What else
has changed in them is looked for a little later, by a timer, and in these meshes only.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy

from .. import names
from ..core.errors import PrintOnce, ReadableError
from ..core.extenders.adjustment import AdjustmentError
from ..core.words import texts
from . import extenders, last_operator, seams, snapshot
from .pins import Followed
from .snapshot import Edge, Snapshot

# In seconds: a hand that has not moved for so long is taken to rest.
_REST = 0.3
# Looking for changes may take this fraction of the time.
_MAX_LOAD = 0.2


@dataclass
class _State:
    """Meshes by their address: as they were seen last, and those that have changed since."""

    snapshots: dict[int, Snapshot] = field(default_factory=dict)
    changed: set[int] = field(default_factory=set)
    is_busy: bool = False
    is_undoing: bool = False
    operator: int = 0
    last_look: float = 0.0
    look_seconds: float = 0.0


_state = _State()
_print_once = PrintOnce(texts.could_not_follow)


def is_on(scene: bpy.types.Scene) -> bool:
    """Return whether live unwrapping is on in a scene."""
    return bool(getattr(scene, names.LIVE_UNWRAP_PROPERTY, False))


def on_update(scene: bpy.types.Scene, meshes: Sequence[bpy.types.Mesh]) -> None:
    """Let pins of `meshes` in edit mode, which Blender has just updated, be followed, and look for the rest later."""
    if not is_on(scene) or _state.is_busy or _state.is_undoing:
        return
    is_dragged = False
    with _guarded():
        for mesh in meshes:
            _state.changed.add(mesh.as_pointer())
            seen = _state.snapshots.get(mesh.as_pointer())
            if seen and seen.pinned and seen.is_current:
                _follow_pins(scene, seen)
                is_dragged |= seen.pinned.is_dragged
    _look_soon(is_dragged or last_operator.address() == _state.operator)


def on_extender_change(mesh: bpy.types.Mesh) -> None:
    """Let changes in the list of extenders of a mesh in edit mode be followed, once the hand rests."""
    if is_on(bpy.context.scene) and not _state.is_busy and mesh.is_editmode:
        _state.changed.add(mesh.as_pointer())
        _look_soon(wait_for_rest=True)


def look() -> None:
    """Look for changes in the meshes that Blender has updated, and follow them. Blender calls this by a timer."""
    scene = bpy.context.scene
    if not is_on(scene) or _state.is_busy or _state.is_undoing or any(map(_waits, _state.snapshots.values())):
        return
    start = time.perf_counter()
    with _guarded():
        _look(scene)
    _state.last_look = time.perf_counter()
    _state.look_seconds = _state.last_look - start


def see() -> None:
    """Take what is in the meshes in edit mode as it is: whatever has changed is not followed."""
    _state.snapshots.clear()
    _state.changed.clear()
    if is_on(bpy.context.scene):
        with _guarded(), _window(bpy.context.scene):
            for edit_object in _edited():
                _renew(edit_object)


def forget() -> None:
    """Let all meshes go, which are about to change or to leave edit mode."""
    _state.snapshots.clear()
    _state.changed.clear()


def forget_left() -> None:
    """Let meshes go that have left edit mode."""
    for key in [key for key, seen in _state.snapshots.items() if not seen.bm.is_valid]:
        del _state.snapshots[key]


def before_undo() -> None:
    """Follow nothing until `after_undo`."""
    _state.is_undoing = True
    forget()


def after_undo() -> None:
    """Take what was undone as it is now."""
    _state.is_undoing = False
    see()


def toggled() -> None:
    """Begin, or stop, with what there is now; problems are told again."""
    _print_once.forget()
    see()


def stop() -> None:
    """Let go of everything: meshes and timers."""
    _state.is_undoing = False
    forget()
    for timer in (look, _rest, _push_undo_step):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)


@contextmanager
def not_following() -> Iterator[None]:
    """Within, nothing is followed, and what changed within is not followed afterwards."""
    if _state.is_busy:
        yield
        return
    # Also where it is off: it may be turned on within.
    _state.is_busy = True
    try:
        yield
    finally:
        _state.is_busy = False
        see()


def follow_extenders(edit_object: bpy.types.Object, strengths: Mapping[Edge, float]) -> str:
    """Solve the islands of changed extenders at once, within an operator; see `extenders.follow`."""
    with not_following():
        return extenders.follow(edit_object, strengths)


def _look(scene: bpy.types.Scene) -> None:
    before = dict(_state.snapshots)
    changed, _state.changed = _state.changed, set()
    for seen in before.values():
        if seen.pinned and seen.is_current:
            _follow_pins(scene, seen)
    new_seams, new_strengths = {}, {}
    with _window(scene):
        for edit_object in _edited():
            seen = before.get(edit_object.data.as_pointer())
            if seen and edit_object.data.as_pointer() not in changed and seen.is_current:
                seen.note_operators()
                continue
            now = _renew(edit_object)
            if seen is None or now is None or seen.layer != now.layer:
                continue
            edges = seen.changed_seams(now)
            if len(edges) and last_operator.changes_seams(seen.operator):
                new_seams[edit_object.data] = edges
            new_strengths[edit_object] = seen.changed_strengths(now)
            if seen.pinned and now.pinned:
                now.pinned.goes_on_from(seen.pinned)
        _state.operator = last_operator.address()
        is_written = bool(new_seams) and seams.follow(bpy.context, new_seams)
        for edit_object, strengths in new_strengths.items():
            # Unwrapping after changed seams uses the extenders, except that it keeps other islands as they are.
            if strengths and not new_seams:
                is_written |= _follow_strengths(edit_object, strengths)
    if is_written:
        see()
        _push_undo_step()


def _follow_strengths(edit_object: bpy.types.Object, strengths: Mapping[Edge, float]) -> bool:
    try:
        extenders.follow(edit_object, strengths)
    except AdjustmentError as error:
        _print_once(error)
        return False
    return True


def _edited() -> list[bpy.types.Object]:
    """Return one object for every mesh in edit mode."""
    if bpy.context.mode != "EDIT_MESH":
        return []
    # While a file is opened they are not in it yet.
    return [edit_object for edit_object in bpy.context.objects_in_mode_unique_data if edit_object.data.is_editmode]


def _renew(edit_object: bpy.types.Object) -> Snapshot | None:
    now = snapshot.take(edit_object)
    if now is None:
        _state.snapshots.pop(edit_object.data.as_pointer(), None)
    else:
        _state.snapshots[edit_object.data.as_pointer()] = now
    return now


def _waits(seen: Snapshot) -> bool:
    return seen.pinned is not None and seen.pinned.waits


def _follow_pins(scene: bpy.types.Scene, seen: Snapshot, is_resting: bool = False) -> None:
    followed = seen.pinned.follow(scene.tool_settings.use_uv_select_sync, is_resting)
    if followed is Followed.WAITS:
        _call_after(_rest, _REST)
    elif followed is Followed.WRITTEN_TOO_LATE:
        _call_after(_push_undo_step, 0.0)


def _rest() -> float | None:
    """Follow pins that have come to rest; called by a timer."""
    scene = bpy.context.scene
    with _guarded():
        for seen in filter(_waits, _state.snapshots.values()):
            if not seen.is_current:
                seen.pinned.waits = False
                continue
            wait = _REST - seen.pinned.seconds_of_rest
            if wait > 0.0:
                return wait
            _follow_pins(scene, seen, is_resting=True)
    _call_after(look, 0.0)
    return None


def _look_soon(wait_for_rest: bool) -> None:
    """Look as soon as the load allows, or with `wait_for_rest` only once Blender has updated nothing for a while."""
    passed = time.perf_counter() - _state.last_look
    pause = max(_REST if wait_for_rest else 0.0, _state.look_seconds / _MAX_LOAD - passed)
    if wait_for_rest and bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    _call_after(look, pause)


def _call_after(function: Callable[[], "float | None"], seconds: float) -> None:
    if not bpy.app.background and not bpy.app.timers.is_registered(function):
        bpy.app.timers.register(function, first_interval=seconds)


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


@contextmanager
def _guarded() -> Iterator[None]:
    """Keep the changes made within from being followed, and errors from reaching Blender; print each once."""
    outer, _state.is_busy = _state.is_busy, True
    try:
        yield
    except ReadableError as error:
        _print_once(error)
    except Exception as error:  # noqa: BLE001 - an error in a handler would come again with every movement of the mouse
        forget()
        _print_once(error)
    finally:
        _state.is_busy = outer
