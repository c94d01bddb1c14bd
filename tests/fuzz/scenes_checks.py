# SPDX-License-Identifier: GPL-3.0-or-later
"""Random calls of the add-on's operators, and what they must never do."""

import contextlib
import importlib
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np

from tests.blender.inside import digest

SELECTION = ("select", "UV selection", "selection history", "tool settings")
EXTENDERS = ("shapes", "attribute .spectral_extender:")
# Searches take long on larger meshes.
FACES_TO_SEARCH = 800


@dataclass(frozen=True)
class Call:
    """A call of an operator.

    Attributes:
        description: for the reader.
        run: calls it and returns its status.
        may_change: the parts of `digest.digest` that may change, by words in their names.
        solved_corners: returns which corners of each mesh may get other UVs, by the mesh's name; asked before the call.
        has_step: whether it adds its step of undo itself, in Object Mode.
    """

    description: str
    run: Callable[[], set[str]]
    may_change: tuple[str, ...] = ()
    solved_corners: Callable[[], dict[str, np.ndarray]] = dict
    has_step: bool = False


def random_call(rng, edited):
    """Choose an operator and its settings."""
    shares = {
        _unwrap: 0.36,
        _in_place: 0.06,
        _relax: 0.04,
        _pack: 0.04,
        _new_textures: 0.02,
        _constrain: 0.1,
        _scale_or_turn: 0.06,
        _suggest_seams: 0.08,
        _hint: 0.04,
        _select_failed: 0.05,
        _add_extender: 0.09,
        _adjust_extender: 0.03,
        _choose_extender: 0.03,
    }
    return list(shares)[rng.choice(len(shares), p=list(shares.values()))](rng, edited)


def check(rng, call):
    """Call the operator; raise AssertionError for a forbidden effect."""
    before, uv = digest.digest(), _active_uvs()
    allowed = call.solved_corners()
    undone = rng.random() < 0.25
    if undone:
        bpy.ops.ed.undo_push(message="Before")
    status = _status(call.run)
    after, new_uv = digest.digest(), _active_uvs()
    changed = digest.changes(before, after)
    with_new_map = [name for name in new_uv if uv[name] is None and new_uv[name] is not None]
    words = call.may_change if status == {"FINISHED"} else ()
    unexpected = [name for name in changed if not _is_allowed(name, words, with_new_map)]
    assert not unexpected, f"{status} changed {unexpected}"
    _check_seams(before, after, changed)
    for name, coordinates in new_uv.items():
        if coordinates is not None:
            _check_uvs(name, uv[name], coordinates, allowed.get(name), status)
    if undone and status == {"FINISHED"}:
        _check_undo(before, uv, call.has_step)


def _status(run):
    """Return the operator's status; a reported error is a status, an exception is not."""
    try:
        return run()
    except RuntimeError as error:
        text = str(error)
        assert text.startswith("Error: "), text
        assert "Traceback" not in text, text
        return {"CANCELLED"}


def _is_allowed(name, words, with_new_map):
    if any(name.startswith(f"mesh {mesh}: ") and "UV" in name for mesh in with_new_map):
        return True
    return any(word in name for word in words)


def _check_seams(before, after, changed):
    for name in (name for name in changed if name.endswith("use_seam")):
        old, new = (np.frombuffer(side[name], dtype=bool) for side in (before, after))
        assert (new >= old).all(), f"{name}: seams were cleared"


def _check_uvs(name, old, new, allowed, status):
    if old is None:
        assert status == {"FINISHED"}, f"{name}: got a UV map"
        assert np.isfinite(new).all(), f"{name}: UVs that are no numbers in a new map"
        return
    changed = (old.view(np.int32) != new.view(np.int32)).any(axis=1)
    assert not changed.any() or status == {"FINISHED"}, f"{name}: UVs changed although {status}"
    assert np.isfinite(new[changed]).all(), f"{name}: UVs that are no numbers"
    outside = changed if allowed is None else changed & ~allowed
    assert not outside.any(), f"{name}: {outside.sum()} UVs changed that must not"


def _check_undo(before, uv, has_step):
    if not has_step:
        bpy.ops.ed.undo_push(message="After")
    bpy.ops.ed.undo()
    # Blender makes the selection of vertices and edges anew from that of the faces, which random flags do not fit.
    left = [
        name
        for name in digest.changes(before, digest.digest())
        if not name.endswith((": vertices, select", ": edges, select"))
    ]
    assert not left, f"one undo step does not bring back {left}"
    for name, coordinates in _active_uvs().items():
        old = uv.get(name)
        same = (old is None) == (coordinates is None) and (old is None or old.tobytes() == coordinates.tobytes())
        assert same, f"{name}: one undo step does not bring the UVs back"
    bpy.ops.ed.redo()
    if has_step:
        bpy.ops.object.editmode_toggle()


def _active_uvs():
    return {mesh.name: digest.active_uv(mesh) for mesh in bpy.data.meshes}


def _addon(name):
    return importlib.import_module(f"spectral_unwrap.{name}")


def _unwrap(rng, edited):
    properties = {
        "method": str(rng.choice(["SPECTRAL", "SPECTRAL", "SPECTRAL", "LSCM"])),
        "weights": str(rng.choice(["UNIFORM", "INVERSE_AREA"])),
        "boundary": str(rng.choice(["LENGTH", "VERTEX"])),
        "keep_in_place": bool(rng.random() < 0.3),
        "fill_holes": bool(rng.random() < 0.2),
        "hole_rigidity": float(rng.choice([0.0, 0.0, 0.5, 1e4])),
        "area_blend": float(rng.choice([0.0, 0.0, 0.0, 0.3, 1.0])),
        "fold_free": bool(rng.random() < 0.3),
        "straighten": bool(rng.random() < 0.3),
        "polish": str(rng.choice(["OFF", "ANGLES", "BALANCED", "BALANCED"])),
        "automatic_hole_rigidity": bool(rng.random() < 0.8),
        "stretch": float(rng.choice([1.0, 1.0, 0.01, 2.0, 100.0])),
        "use_subsurf_data": bool(rng.random() < 0.3),
        "soft_pins": float(rng.choice([0.0, 0.0, 0.0, 1e-6, 1.0, 100.0, 1e4])),
        "correct_aspect": bool(rng.random() < 0.5),
        "margin": float(rng.choice([0.0, 1.0, 50.0, 2000.0])),
        "texture_size": int(rng.choice([0, 1, 512, 4096])),
        "rotation": str(rng.choice(["SQUARE", "FREE", "UPRIGHT", "QUARTERS", "NONE"])),
        "hold_rest": bool(rng.random() < 0.7),
    }
    if rng.random() < 0.1:
        properties[str(rng.choice(["hole_rigidity", "area_blend", "stretch", "soft_pins", "margin"]))] = np.nan
    in_uv_editor = rng.random() < 0.2

    def run():
        with _uv_editor(in_uv_editor):
            return bpy.ops.uv.spectral_unwrap(**properties)

    def solved():
        with _uv_editor(in_uv_editor):
            return _solved_corners(properties)

    place = "in the UV editor " if in_uv_editor else ""
    return Call(f"unwrap {place}{properties}", run, solved_corners=solved)


def _in_place(rng, _edited):
    properties = {
        "keep_in_place": True,
        "blend": tuple(rng.choice([1.0, 1.0, 0.5, 0.0], 2).tolist()),
        "fold_free": bool(rng.random() < 0.3),
    }
    return _work_on_map(rng, "unwrap", properties)


def _relax(rng, _edited):
    properties = {
        "sizes": float(rng.choice([0.0, 0.5, 1.0])),
        "steps": int(rng.choice([1, 5, 30])),
        "border": str(rng.choice(["FREE", "SLIDING", "HELD"])),
        "fold_free": bool(rng.random() < 0.5),
    }
    return _work_on_map(rng, "relax", properties)


def _pack(rng, _edited):
    properties = {
        "margin": float(rng.choice([0.0, 4.0, 4096.0])),
        "texture_size": int(rng.choice([0, 1, 512, 4096])),
        "rotation": str(rng.choice(["FREE", "SQUARE", "UPRIGHT", "QUARTERS", "NONE"])),
        "scale": bool(rng.random() < 0.7),
        "stacks": str(rng.choice(["APART", "KEPT", "OVERLAPPING", "EQUAL", "MIRRORED"])),
        "hold_pinned": bool(rng.random() < 0.5),
        "groups": str(rng.choice(["NONE", "OBJECT", "MATERIAL"])),
        "tiles": str(rng.choice(["OWN", "ACTIVE", "SEVERAL", "AUTO", "BOUNDS", "BOX"])),
        "tile_count": int(rng.choice([1, 3])),
        "min_size": float(rng.choice([0.0, 5.0, 4096.0])),
        "snap": bool(rng.random() < 0.3),
        "box": (0.0, float(rng.choice([0.0, 0.5])), float(rng.choice([0.5, 1.0])), 0.5),
        "steps": int(rng.choice([0, 2])),
    }
    return _work_on_map(rng, "pack", properties)


def _new_textures(rng, _edited):
    properties = {
        "size": str(rng.choice(["SAME", "SIZE", "AUTO"])),
        "margin": float(rng.choice([0.0, 4.0, 4096.0])),
        "texture_size": int(rng.choice([0, 1, 512])),
    }
    # Edit mode is left, and what it selects of vertices and edges made anew from the faces.
    selected = (": vertices, select", ": edges, select", "selection history", "select mode")
    changed = ("UV", "names of images", "names of materials", "material slots", *selected)

    def every():
        return {
            mesh.name: np.ones(len(uv), dtype=bool)
            for mesh in bpy.data.meshes
            if (uv := digest.active_uv(mesh)) is not None
        }

    return Call(
        f"new textures {properties}",
        lambda: bpy.ops.uv.spectral_new_textures(**properties),
        changed,
        every,
        has_step=True,
    )


def _scale_or_turn(rng, _edited):
    name, properties, changes = [
        ("shape", {"kind": "UPRIGHT", "by": str(rng.choice(["MOST", "EDGES", "X", "Y", "Z"]))}, ()),
        ("density", {"density": float(rng.choice([1e-3, 512.0, 1e9]))}, ()),
        ("density", {"kind": "EQUAL"}, ()),
        (
            "density",
            {"kind": "FACTOR", "factor": float(rng.choice([0.1, 1.0, 4.0]))},
            ("attribute spectral_density_factor",),
        ),
    ][rng.integers(4)]
    return _work_on_map(rng, name, properties, changes)


def _work_on_map(rng, name, properties, changes=()):
    """Call an operator that moves UVs of visible faces, in either editor."""
    in_uv_editor = rng.random() < 0.3

    def run():
        with _uv_editor(in_uv_editor):
            return getattr(bpy.ops.uv, f"spectral_{name}")(**properties)

    place = "in the UV editor " if in_uv_editor else ""
    return Call(f"{name} {place}{properties}", run, changes, _visible_corners)


def _constrain(rng, edited):
    """Add a constraint; if the mesh has one, perhaps remove it."""
    prefix = _addon("names").CONSTRAINT_LAYER_PREFIX
    attribute = f"attribute {prefix}"
    listed = [entry.kind for entry in bpy.context.edit_object.data.spectral_shapes]
    places = [place for place, kind in enumerate(listed) if kind != "EXTENDER"]
    if places and rng.random() < 0.5:
        place = int(rng.choice(places))
        remove = bpy.ops.uv.spectral_shape_remove
        return Call(f"remove {place}", lambda: remove(index=place), (attribute, "shapes"), _followed_corners)
    properties = {
        "kind": str(rng.choice(["STRAIGHT", "RECTANGLE", "GRID", "SYMMETRIC"])),
        "direction": str(rng.choice(["NEAREST", "HORIZONTAL", "VERTICAL", "OWN"])),
        "spacing": str(rng.choice(["FREE", "EVEN", "LENGTH"])),
        "unwrap": bool(rng.random() < 0.8),
    }
    in_uv_editor = rng.random() < 0.2

    def run():
        with _uv_editor(in_uv_editor):
            return bpy.ops.uv.spectral_shape(**properties)

    # Edges that exclude each other are selected.
    return Call(f"shape {properties}", run, (attribute, "shapes", *SELECTION), _visible_corners)


@contextlib.contextmanager
def _uv_editor(wanted):
    if not wanted:
        yield
        return
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    area.ui_type = "UV"
    with bpy.context.temp_override(window=window, area=area):
        yield


def _solved_corners(properties):
    """Return which corners the operator must write: those of its faces, if the solver succeeds."""
    steps = _addon("unwrapping.steps")
    # Blender's properties have single precision, which decides whether a patch at the limit is solved.
    held = {name: float(np.float32(value)) if isinstance(value, float) else value for name, value in properties.items()}
    # Where a margin lies, does not count.
    held = {"blend": (1.0, 1.0), **held}
    settings = _addon("unwrapping.last_settings").settings_of(SimpleNamespace(**held), 0.0, "none")
    edit_meshes, all_visible = steps.read_selected_or_visible(bpy.context, settings, settings.hold_rest)
    found = {mesh.name: np.zeros(len(_chosen_corners(mesh)), dtype=bool) for mesh in _meshes()}
    for edit_mesh, solution in zip(edit_meshes, steps.solve_and_place(edit_meshes, settings).solutions):
        chosen = _chosen_corners(edit_mesh.mesh, all_visible)
        assert not (solution.solved_corners & ~chosen).any(), "faces were solved that are not selected, or hidden"
        found[edit_mesh.mesh.name] = solution.solved_corners
    return found


def _meshes():
    return [item.data for item in bpy.context.objects_in_mode_unique_data]


def _chosen_corners(mesh, all_visible=False):
    """Return which corners belong to selected visible faces, or to visible ones."""
    faces = bmesh.from_edit_mesh(mesh).faces
    return np.array(
        [(all_visible or face.select) and not face.hide for face in faces for _ in face.loops], dtype=bool
    ).reshape(-1)


def _suggest_seams(rng, edited):
    if sum(len(bmesh.from_edit_mesh(mesh).faces) for mesh in _meshes()) > FACES_TO_SEARCH:
        return _select_failed(rng, edited)
    properties = {
        "scale_limit": float(rng.choice([1.01, 2.0, 8.0])),
        "angle_distortion": float(rng.choice([5.0, 50.0])),
        "max_length": float(rng.choice([0.0, 0.0, 3.0])),
        "longest_side": float(rng.choice([0.5, 1.75, 10.0])),
        "style": str(rng.choice(["AUTO", "HARD", "ORGANIC", "ANGLE"])),
        "sharp_angle": float(rng.choice([0.0, 0.5, 1.6])),
        "unwrap": bool(rng.random() < 0.7),
    }

    def chosen():
        nothing = not any(_chosen_corners(mesh).any() for mesh in _meshes())
        return {mesh.name: _chosen_corners(mesh, nothing) for mesh in _meshes()}

    return Call(
        f"suggest seams {properties}",
        lambda: bpy.ops.uv.spectral_suggest_seams(**properties),
        ("use_seam", "attribute uv_seam"),
        chosen,
    )


def _hint(rng, _edited):
    hint = str(rng.choice(["CUT", "NEVER", "CLEAR"]))
    return Call(f"hint {hint}", lambda: bpy.ops.mesh.spectral_seam_hint(hint=hint), ("attribute spectral_seam_hint",))


def _select_failed(rng, edited):
    return Call("select failed", lambda: bpy.ops.uv.spectral_select(kind="FAILED"), SELECTION)


def _add_extender(rng, edited):
    """Select two vertices of a mesh, or a few, and connect them."""
    mesh = edited[rng.integers(len(edited))].data
    bm = bmesh.from_edit_mesh(mesh)
    vertices = [vertex for vertex in bm.verts if not vertex.hide]
    chosen = rng.choice(len(vertices), min(len(vertices), rng.choice([2, 2, 3, 4])), replace=False) if vertices else ()
    if rng.random() < 0.8:
        for element in (*bm.verts, *bm.edges, *bm.faces):
            element.select = False
        for index in chosen:
            vertices[index].select_set(True)
            bm.select_history.add(vertices[index])
        bmesh.update_edit_mesh(mesh)
    amount = float(rng.choice([50.0, -50.0, 0.0, 100.0, -100.0]))
    return Call(
        f"add extender of {amount} %",
        lambda: bpy.ops.uv.spectral_shape(kind="EXTENDER", amount=amount),
        EXTENDERS,
        _followed_corners,
    )


def _followed_corners():
    """Return the corners that may follow an extender at once: those of visible faces, with Live Spectral Unwrap on."""
    if not bpy.context.scene.spectral_unwrap_live:
        return {}
    return _visible_corners()


def _visible_corners():
    return {mesh.name: _chosen_corners(mesh, all_visible=True) for mesh in _meshes()}


def _adjust_extender(rng, edited):
    amount = float(rng.choice([0.0, 60.0, -75.0, 100.0]))
    if not bpy.ops.uv.spectral_extender.poll():
        return _add_extender(rng, edited)
    return Call(
        f"adjust extender to {amount} %",
        lambda: bpy.ops.uv.spectral_extender(amount=amount),
        EXTENDERS,
        _visible_corners,
    )


def _choose_extender(rng, edited):
    if not bpy.ops.uv.spectral_shape_remove.poll():
        return _add_extender(rng, edited)
    mesh = bpy.context.edit_object.data
    mesh.spectral_shapes_active = int(rng.integers(len(mesh.spectral_shapes)))
    return Call(
        "remove extender",
        lambda: bpy.ops.uv.spectral_shape_remove(),
        EXTENDERS,
        _followed_corners,
    )
