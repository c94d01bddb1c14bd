# SPDX-License-Identifier: GPL-3.0-or-later
"""When live unwrapping looks at the meshes in edit mode, and what follows.

`on_update`, which Blender's handlers call, follows moved pins at once and notes the changed meshes. A timer looks for
other changes in these meshes a little later.
"""

import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager

import bpy
import numpy as np

from .. import editors, names, session
from ..core.constraints.marks import Edge
from ..core.errors import ReadableError
from ..core.solve.options import Settings
from ..core.words import texts
from ..core.words.translation import translate
from ..session import Lifetime, Remembered, edit_meshes, identity
from ..session.problems import Printed, print_once
from ..unwrapping import island_list, last_result
from ..unwrapping.last_settings import last_settings
from ..unwrapping.outcome import Outcome
from . import extenders, last_operator, seams, snapshot, undo_steps
from .pins import Followed
from .snapshot import Snapshot

# Seconds without movement after which the hand counts as resting.
_REST = 0.3
# Work that ends within these seconds blocks Blender for them; for longer work a timer looks as often.
_SHORT = 0.05
# Fraction of the time that looking for changes may take.
_MAX_LOAD = 0.2


class _Following(Remembered):
    """The state of following.

    Attributes:
        changed: addresses of the meshes that Blender has updated since the last look.
        is_busy: whether current changes are not followed.
        operator: `last_operator.address()` at the last look.
        last_look, look_seconds: time and duration of the last look.
    """

    def __init__(self) -> None:
        self.changed: set[int] = set()
        self.is_busy = False
        self.operator = 0
        self.last_look = 0.0
        self.look_seconds = 0.0

    def end(self) -> None:
        """Stop the timers."""
        for timer in (look, _rest, _push_undo_step):
            if bpy.app.timers.is_registered(timer):
                bpy.app.timers.unregister(timer)


class _Solving(Remembered):
    """The unwraps after changed seams that run in threads, by the key of the scene.

    Undo ends them, because it replaces the meshes.
    """

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        self.by_scene: dict[int, seams.Follow] = {}

    def end(self) -> None:
        """Drop their work and stop the timer."""
        if bpy.app.timers.is_registered(_write_solved):
            bpy.app.timers.unregister(_write_solved)
        for follow in self.by_scene.values():
            follow.cancel()

    def drop(self, scene: bpy.types.Scene) -> seams.Follow | None:
        """Cancel and return that of a scene, None if there is none."""
        follow = self.by_scene.pop(identity.key(scene), None)
        if follow is not None:
            follow.cancel()
        return follow


def _state() -> _Following:
    return session.of(_Following)


def is_on(scene: bpy.types.Scene) -> bool:
    """Return whether live unwrapping is on in a scene."""
    return bool(getattr(scene, names.LIVE_UNWRAP_PROPERTY, False))


def on_update(scene: bpy.types.Scene, meshes: Sequence[bpy.types.Mesh]) -> None:
    """Follow the pins of `meshes` in edit mode, which Blender has just updated; look for other changes later."""
    if not is_on(scene) or _state().is_busy:
        return
    is_dragged = False
    with _guarded():
        for mesh in meshes:
            _state().changed.add(mesh.as_pointer())
            seen = _seen(mesh)
            if seen and seen.pinned and seen.is_current:
                _follow_pins(seen)
                is_dragged |= seen.pinned.is_dragged
    _look_soon(is_dragged or last_operator.address() == _state().operator)


def on_shape_change(mesh: bpy.types.Mesh) -> None:
    """Follow changes in the list of shapes of a mesh in edit mode once the hand rests."""
    if is_on(bpy.context.scene) and not _state().is_busy and mesh.is_editmode:
        _state().changed.add(mesh.as_pointer())
        _look_soon(wait_for_rest=True)


def look() -> None:
    """Look for changes in the meshes that Blender has updated, and follow them; called by a timer."""
    state, scenes = _state(), _followed_scenes()
    if not scenes or state.is_busy or any(map(_waits, _all_seen())):
        return
    start = time.perf_counter()
    changed, state.changed = state.changed, set()
    for scene in scenes:
        with _guarded():
            _look(scene, changed)
    state.last_look = time.perf_counter()
    state.look_seconds = state.last_look - start


def begin() -> None:
    """Accept the meshes in edit mode as they are, without following past changes."""
    session.drop(_Solving)
    _forget_seen()
    for scene in _followed_scenes():
        _accept(scene)


def toggled(scene: bpy.types.Scene) -> None:
    """Start or stop following in a scene; problems are printed again."""
    session.drop(Printed)
    _accept(scene)


@contextmanager
def not_following() -> Iterator[None]:
    """Follow nothing within the context, nor its changes afterward."""
    if _state().is_busy:
        yield
        return
    # Also if it is off: it may be turned on meanwhile.
    _state().is_busy = True
    try:
        yield
    finally:
        _state().is_busy = False
        _accept(bpy.context.scene)


def unwrap_at(context: bpy.types.Context, changed: Mapping[bpy.types.Mesh, np.ndarray], settings: Settings) -> Outcome:
    """Unwrap the islands at the `changed` edges (N, 2) of each mesh at once, with these settings, but in place.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    solving = seams.Follow(context, changed, settings, in_place=True)
    with not_following():
        result = solving.write()
    return result or Outcome(is_solved=False, reports=[("WARNING", translate(texts.NO_FACE_AT_EDGES))])


def _accept(scene: bpy.types.Scene) -> None:
    """Accept the meshes in edit mode in a scene as they are; others are followed as before."""
    session.of(_Solving).drop(scene)
    for known in edit_meshes.all_kept():
        if known.seen and known.seen.scene == scene:
            known.seen = None
    with _guarded(), _window(scene):
        for edit_object in edit_meshes.edited():
            _state().changed.discard(edit_object.data.as_pointer())
            if is_on(scene):
                _renew(edit_object)


def _followed_scenes() -> list[bpy.types.Scene]:
    """Return the scenes in windows, without windows that of the context, in which live unwrapping is on."""
    scenes = [window.scene for window in bpy.context.window_manager.windows] or [bpy.context.scene]
    return [scene for scene in dict.fromkeys(scenes) if is_on(scene)]


def _look(scene: bpy.types.Scene, changed: Collection[int]) -> None:
    """Follow what has changed in a scene, given the addresses of the changed meshes."""
    for seen in _all_seen():
        if seen.pinned and seen.is_current and seen.scene == scene:
            _follow_pins(seen)
    new_seams, moved, new_extenders = {}, {}, {}
    with _window(scene):
        for edit_object in edit_meshes.edited():
            seen = _seen(edit_object.data)
            if seen and edit_object.data.as_pointer() not in changed and seen.is_current:
                seen.note_operators()
                continue
            now = _renew(edit_object)
            if seen is None or now is None or seen.layer != now.layer:
                continue
            edges = seen.changed_constraints(now)
            if last_operator.changes_seams(seen.operator):
                edges |= seen.changed_seams(now)
            if edges:
                new_seams[edit_object.data] = np.array(sorted(edges))
            elif edges := _moved_edges(seen, now):
                moved[edit_object.data] = np.array(sorted(edges))
            new_extenders[edit_object] = seen.changed_extenders(now)
            if seen.pinned and now.pinned:
                now.pinned.continue_from(seen.pinned)
        _state().operator = last_operator.address()
        if new_seams or moved:
            _solve({**moved, **new_seams}, in_place=not new_seams)
        is_written, before = False, undo_steps.state() if any(new_extenders.values()) else b""
        for edit_object, pairs in new_extenders.items():
            # Unwrapping after changed seams uses the extenders, but keeps other islands.
            if pairs and identity.key(scene) not in session.of(_Solving).by_scene and not (new_seams or moved):
                with _guarded():
                    _follow_extenders(edit_object, pairs)
                    is_written = True
    if is_written:
        _accept(scene)
        _push_undo_step()
        undo_steps.join(before)


def _moved_edges(seen: Snapshot, now: Snapshot) -> set[Edge]:
    """Return the edges that have moved and are to be followed: a map that someone else has made is left alone."""
    is_followed = last_operator.moves_vertices(seen.operator) and last_result.is_remembered(now.edit_object.data)
    return seen.moved_edges(now) if is_followed else set()


def _follow_extenders(edit_object: bpy.types.Object, pairs: Collection[tuple[int, int]]) -> None:
    """Follow changed extenders; the sidebar shows what is wrong with the map, or why it cannot."""
    try:
        island_list.note(extenders.follow(edit_object, pairs, last_settings()))
    except ReadableError as error:
        island_list.note(texts.could_not_follow(str(error)))
        raise
    finally:
        editors.redraw(bpy.context)


def _solve(changed: Mapping[bpy.types.Mesh, np.ndarray], in_place: bool) -> None:
    """Unwrap after edges have changed, in the background if that takes longer; what runs in this scene begins again.

    With `in_place`, as after vertices have moved, islands stay where they are.
    """
    running = session.of(_Solving).drop(bpy.context.scene)
    in_place &= running is None or running.in_place
    for mesh, edges in (running.changed if running is not None else {}).items():
        changed = {**changed, mesh: np.concatenate([edges, changed.get(mesh, edges[:0])])}
    follow = seams.Follow(bpy.context, changed, last_settings(), in_place)
    if bpy.app.background or follow.is_done(_SHORT):
        _finish(follow)
    else:
        session.of(_Solving).by_scene[identity.key(follow.scene)] = follow
        _call_after(_write_solved, _SHORT)


def _write_solved() -> float | None:
    """Write what was solved in the background once it is there; called by a timer."""
    by_scene = session.of(_Solving).by_scene
    for key, follow in list(by_scene.items()):
        if not follow.is_done(0.0) or last_operator.transforms():
            continue
        del by_scene[key]
        with _guarded(), _window(follow.scene):
            current = follow.again(bpy.context) if is_on(follow.scene) else None
            if current is follow:
                _finish(follow)
            elif current is not None:
                by_scene[key] = current
    return _SHORT if by_scene else None


def _finish(follow: seams.Follow) -> None:
    before = undo_steps.state()
    result = follow.write()
    if result is not None and result.is_solved:
        _accept(follow.scene)
        _push_undo_step()
        undo_steps.join(before)


def _seen(mesh: bpy.types.Mesh) -> Snapshot | None:
    known = edit_meshes.kept(mesh)
    return known and known.seen


def _all_seen() -> list[Snapshot]:
    return [known.seen for known in edit_meshes.all_kept() if known.seen]


def _forget_seen() -> None:
    for known in edit_meshes.all_kept():
        known.seen = None
    _state().changed.clear()


def _renew(edit_object: bpy.types.Object) -> Snapshot | None:
    now = snapshot.take(edit_object, last_settings().correct_aspect)
    if now is not None:
        edit_meshes.keep(edit_object.data).seen = now
    elif (known := edit_meshes.kept(edit_object.data)) is not None:
        known.seen = None
    return now


def _waits(seen: Snapshot) -> bool:
    return seen.pinned is not None and seen.pinned.waits


def _follow_pins(seen: Snapshot, is_resting: bool = False) -> None:
    before = undo_steps.state() if is_resting else b""
    by_sync = seen.scene.tool_settings.use_uv_select_sync
    followed = seen.pinned.follow(last_settings().options, by_sync, is_resting)
    if followed is Followed.WAITS:
        _call_after(_rest, _REST)
    elif followed is Followed.WRITTEN_TOO_LATE and is_resting:
        _push_undo_step()
        undo_steps.join(before)
    elif followed is Followed.WRITTEN_TOO_LATE:
        _call_after(_push_undo_step, 0.0)


def _rest() -> float | None:
    """Follow pins that rest; called by a timer."""
    with _guarded():
        for seen in filter(_waits, _all_seen()):
            if not seen.is_current:
                seen.pinned.waits = False
                continue
            wait = _REST - seen.pinned.seconds_of_rest
            if wait > 0.0:
                return wait
            _follow_pins(seen, is_resting=True)
    _call_after(look, 0.0)
    return None


def _look_soon(wait_for_rest: bool) -> None:
    """Look as soon as the load allows, or with `wait_for_rest` once Blender has not updated for a while."""
    passed = time.perf_counter() - _state().last_look
    pause = max(_REST if wait_for_rest else 0.0, _state().look_seconds / _MAX_LOAD - passed)
    if wait_for_rest and bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    _call_after(look, pause)


def _call_after(function: Callable[[], "float | None"], seconds: float) -> None:
    if not bpy.app.background and not bpy.app.timers.is_registered(function):
        bpy.app.timers.register(function, first_interval=seconds)


@contextmanager
def _window(scene: bpy.types.Scene) -> Iterator[None]:
    """Give the context a window that shows the scene, if there is one."""
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
    """Do not follow the changes made within, and print each error once instead of raising it."""
    state = _state()
    outer, state.is_busy = state.is_busy, True
    try:
        yield
    except ReadableError as error:
        print_once(error, texts.could_not_follow)
    except Exception as error:  # noqa: BLE001 - an error in a handler would come again with every movement of the mouse
        _forget_seen()
        print_once(error, texts.could_not_follow)
    finally:
        state.is_busy = outer
