# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh: stored with it, and found again after its topology has changed.

The list is a collection property of the mesh, so it is saved and copied with it. It knows its vertices by identifiers
in an integer layer of the vertices, which topology edits carry along. Undo in edit mode restores layers, with their
names, but no properties. So the layer is named after the content of the list, renamed with every change of it, and
identifies its list after an undo; lists seen in this session are remembered by that name.
"""

from collections.abc import Iterable, Sequence

import bpy
import numpy as np
from bmesh.types import BMesh, BMLayerItem, BMVert

from .. import editors, names, session
from ..core.extenders import pairs as core
from ..core.extenders.pairs import Extender
from ..core.words import texts
from ..session import Remembered, edit_meshes, identity
from ..session.identity import Identity

# Limit of all strengths, in drags and scripts.
STRENGTH_LIMIT = 1e4
# Arguments of a strength property.
STRENGTH = {
    **texts.STRENGTH_PROPERTY,
    **{"default": 1.0, "min": -STRENGTH_LIMIT, "max": STRENGTH_LIMIT, "soft_min": -10.0, "soft_max": 10.0},
}


class _Lists(Remembered):
    """The lists seen, by the name of their layer, and by mesh without a layer; whether one is being written."""

    def __init__(self) -> None:
        self.seen: dict[str | Identity, list[Extender]] = {}
        self.is_writing = False


def of(mesh: bpy.types.Mesh) -> Sequence[bpy.types.PropertyGroup]:
    """Return the list of extenders of a mesh, each with the attributes of `core.extenders.pairs.Extender`."""
    return getattr(mesh, names.EXTENDERS_PROPERTY)


def active_index(mesh: bpy.types.Mesh) -> int:
    """Return the index of the extender that is active in the panel, -1 if there is none."""
    index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY)
    return index if 0 <= index < len(of(mesh)) else -1


def label(extender: bpy.types.PropertyGroup) -> str:
    """Return the name of an extender for messages; a file may have one without a name."""
    return extender.name or texts.unnamed_extender()


def changed(extender: bpy.types.PropertyGroup) -> bool:
    """Note that an extender was changed through its properties; return whether by the user or a script."""
    if session.of(_Lists).is_writing:
        return False
    _note_change(extender.id_data)
    return True


def show_strength(mesh: bpy.types.Mesh, index: int, strength: float, is_final: bool = False) -> None:
    """Set the strength of an extender; if it `is_final`, the next undo step includes it."""
    lists = session.of(_Lists)
    lists.is_writing = True
    of(mesh)[index].strength = strength
    lists.is_writing = False
    if is_final:
        _note_change(mesh)


def ends(bm: BMesh, mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    """Return the indices of both vertices of every extender of `mesh` in `bm`, its edit mesh; -1 for one that is gone.

    Looks at all vertices. If several have the identifier, as in duplicated geometry, the first one counts. An extender
    with one vertex at both ends, as in damaged files, counts as having lost the second.
    """
    wanted = _ids_of_list(mesh)
    layer = _layer(bm, mesh) if wanted else None
    found = core.first_with(_ids_of_vertices(bm, layer), wanted) if layer is not None else [-1] * len(wanted)
    return [(first, second if second != first else -1) for first, second in zip(found[::2], found[1::2])]


def resolve(bm: BMesh, mesh: bpy.types.Mesh) -> tuple[list[tuple[int, int, float]], list[str], list[str]]:
    """Return the extenders of `mesh` that act on a solve of `bm`, its edit mesh, and the names of those that cannot.

    Returns:
        (first vertex, second vertex, strength) of every extender that is on, whole and of nonzero strength, with the
        vertices' indices in `bm.verts`; the names of those that are on but lost a vertex; and the names of those that
        are on and whole, but have an invalid strength, as scripts and files may.
    """
    forces, broken, without_strength = [], [], []
    for extender, (first, second) in zip(of(mesh), ends(bm, mesh)):
        if not extender.use:
            continue
        if first < 0 or second < 0:
            broken.append(label(extender))
        elif not abs(extender.strength) <= STRENGTH_LIMIT:
            without_strength.append(label(extender))
        elif extender.strength != 0.0:
            forces.append((first, second, extender.strength))
    return forces, broken, without_strength


def follow(meshes: Iterable[bpy.types.Mesh]) -> None:
    """Keep those of the `meshes` in edit mode that have extenders, for drawing and undo."""
    for mesh in meshes:
        if of(mesh) and edit_meshes.kept(mesh) is None:
            edit_meshes.keep(mesh)
            _remember(mesh)


def begin() -> None:
    """Restore the lists of the meshes in edit mode, and keep the meshes."""
    meshes = [edit_object.data for edit_object in edit_meshes.edited()]
    for mesh in meshes:
        _restore(mesh)
    follow(meshes)


def vertices(mesh: bpy.types.Mesh) -> list[tuple[BMVert | None, BMVert | None]] | None:
    """Return both vertices of every extender, None for one that is gone; None while the mesh is not kept.

    For drawing: cheap as long as neither the list nor the topology has changed.
    """
    known = edit_meshes.kept(mesh)
    if known is None:
        return None
    verts, key = known.bm.verts, (len(known.bm.verts), _ids_of_list(mesh))
    if known.extenders is None or known.extenders[0] != key or not _are_valid(known.extenders[1]):
        found = ends(known.bm, mesh)
        verts.ensure_lookup_table()
        known.extenders = key, [tuple(verts[index] if index >= 0 else None for index in pair) for pair in found]
    return known.extenders[1]


def _are_valid(found: list[tuple[BMVert | None, BMVert | None]]) -> bool:
    return all(vertex is None or vertex.is_valid for pair in found for vertex in pair)


def broken(mesh: bpy.types.Mesh) -> list[bool]:
    """Return which extenders of a mesh in edit mode have lost a vertex, if known."""
    found = vertices(mesh)
    return [False] * len(of(mesh)) if found is None else [None in pair for pair in found]


def add(mesh: bpy.types.Mesh, pairs: Sequence[tuple[int, int]], strength: float) -> list[tuple[int, int]]:
    """Add an extender for every pair of vertices of a mesh in edit mode that has none yet; return these pairs.

    The last one becomes the active one. `pairs` are indices of vertices.
    """
    bm, extenders = edit_meshes.keep(mesh).bm, _read(mesh)
    present = set(map(frozenset, ends(bm, mesh)))
    fresh = [pair for pair in pairs if frozenset(pair) not in present]
    if fresh:
        _remember(mesh)
        id_of_vertex = _identify(bm, mesh, [vertex for pair in fresh for vertex in pair])
        # In the user's language if Blender translates the names of new data.
        name, taken = bpy.app.translations.pgettext_data(texts.EXTENDER_NAME), {each.name for each in extenders}
        for first, second in fresh:
            free = core.free_name(name, taken)
            taken.add(free)
            extenders.append(Extender(free, strength, True, id_of_vertex[first], id_of_vertex[second]))
        _write(mesh, extenders, len(extenders) - 1)
        _note_change(mesh)
    return fresh


def remove(mesh: bpy.types.Mesh, indices: Sequence[int]) -> None:
    """Remove extenders; the active one stays active, or the one before becomes so."""
    _remember(mesh)
    index = active_index(mesh)
    extenders = [extender for k, extender in enumerate(_read(mesh)) if k not in indices]
    _write(mesh, extenders, index - sum(k < index for k in indices) - (index in indices))
    _note_change(mesh)


def _note_change(mesh: bpy.types.Mesh) -> None:
    """Rename the layer of a mesh after its list has changed, and redraw."""
    _remember(mesh)
    # Blender redraws when a property changes, but not when one is removed.
    editors.redraw(bpy.context)
    layer = _layer_name(mesh)
    if layer:
        attribute, name = mesh.attributes[layer], _name_of(_read(mesh))
        if attribute.name != name:
            attribute.name = name
        setattr(mesh, names.EXTENDER_LAYER_PROPERTY, attribute.name)


def _remember(mesh: bpy.types.Mesh) -> None:
    """Remember the list of a mesh for an undo of coming changes."""
    extenders = _read(mesh)
    session.of(_Lists).seen[_name_of(extenders)] = extenders


def _restore(mesh: bpy.types.Mesh) -> None:
    """Restore the list that belongs to a mesh's layer after an undo or redo in edit mode."""
    layers, seen = _layer_names(mesh), session.of(_Lists).seen
    if getattr(mesh, names.EXTENDER_LAYER_PROPERTY) in layers:
        return
    known = next((key for key in layers or [identity.of(mesh)] if key in seen), None)
    if known is not None:
        _write(mesh, seen[known], min(getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY), len(seen[known]) - 1))
        setattr(mesh, names.EXTENDER_LAYER_PROPERTY, known if layers else "")


def _identify(bm: BMesh, mesh: bpy.types.Mesh, wanted: Sequence[int]) -> dict[int, int]:
    """Return the identifiers of vertices, given by index, and assign missing ones."""
    layer = _layer(bm, mesh)
    if layer is None:
        extenders = _read(mesh)
        session.of(_Lists).seen[identity.of(mesh)] = extenders
        layer = bm.verts.layers.int.new(_name_of(extenders))
        setattr(mesh, names.EXTENDER_LAYER_PROPERTY, _name_of(extenders))
    bm.verts.ensure_lookup_table()
    used, present = _ids_of_list(mesh), _ids_of_vertices(bm, layer)
    id_of_vertex = {vertex: each for vertex, each in zip(core.first_with(present, used), used) if vertex >= 0}
    # Vertices still have the identifiers of removed extenders.
    fresh = core.fresh_ids([*used, *np.unique(present).tolist()])
    for vertex in wanted:
        if vertex not in id_of_vertex:
            id_of_vertex[vertex] = bm.verts[vertex][layer] = next(fresh)
    return id_of_vertex


def _ids_of_list(mesh: bpy.types.Mesh) -> list[int]:
    return [vertex_id for extender in of(mesh) for vertex_id in (extender.first_id, extender.second_id)]


def _ids_of_vertices(bm: BMesh, layer: BMLayerItem) -> np.ndarray:
    return np.fromiter((vertex[layer] for vertex in bm.verts), dtype=np.int32, count=len(bm.verts))


def _layer(bm: BMesh, mesh: bpy.types.Mesh) -> BMLayerItem | None:
    """Return the layer of `bm` with the identifiers."""
    return bm.verts.layers.int.get(_layer_name(mesh))


def _layer_names(mesh: bpy.types.Mesh) -> list[str]:
    """Return the names of the layers that may hold identifiers; others are not the add-on's."""
    ours = [each for each in mesh.attributes if each.name.startswith(names.EXTENDER_LAYER_PREFIX)]
    return [each.name for each in ours if (each.data_type, each.domain) == ("INT", "POINT")]


def _layer_name(mesh: bpy.types.Mesh) -> str:
    """Return the name of the layer of the list; a mesh joined from others has theirs, too."""
    own, layers = getattr(mesh, names.EXTENDER_LAYER_PROPERTY), _layer_names(mesh)
    return own if own in layers else next(iter(layers), "")


def _name_of(extenders: Sequence[Extender]) -> str:
    return core.layer_name(names.EXTENDER_LAYER_PREFIX, extenders)


def _read(mesh: bpy.types.Mesh) -> list[Extender]:
    return [Extender(e.name, e.strength, e.use, e.first_id, e.second_id) for e in of(mesh)]


def _write(mesh: bpy.types.Mesh, extenders: Sequence[Extender], active: int) -> None:
    lists, collection = session.of(_Lists), of(mesh)
    lists.is_writing = True
    collection.clear()
    for extender in extenders:
        item = collection.add()
        for name, value in vars(extender).items():
            setattr(item, name, value)
    lists.is_writing = False
    setattr(mesh, names.ACTIVE_EXTENDER_PROPERTY, max(active, 0))
    editors.redraw(bpy.context)
