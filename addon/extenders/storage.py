# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh: stored with it, and found again after its topology has changed.

The list is a collection property of the mesh, so it is saved and copied with it. It knows its vertices by identifiers
in an integer layer of the vertices, which topology edits carry along. Undo in edit mode restores layers, with their
names, but no properties. So the layer is named after the content of the list, renamed with every change of it, and
tells after an undo which list goes with it; lists seen in this session are remembered by that name.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bmesh
import bpy
import numpy as np
from bmesh.types import BMesh, BMLayerItem

from .. import editors, names, session
from ..core.extenders import pairs as core
from ..core.extenders.pairs import Extender
from ..core.words import texts
from ..session import Remembered, identity
from ..session.identity import Identity
from .strength import STRENGTH_LIMIT


class _Lists(Remembered):
    """Lists seen since the file was loaded, by the name of their layer, and lists of meshes before they had a layer."""

    def __init__(self) -> None:
        self.by_layer: dict[str, list[Extender]] = {}
        self.without_layer: dict[Identity, list[Extender]] = {}
        self.is_writing = False


def of(mesh: bpy.types.Mesh) -> Sequence[bpy.types.PropertyGroup]:
    """Return the list of extenders of a mesh, each with the attributes of `core.extenders.pairs.Extender`."""
    return getattr(mesh, names.EXTENDERS_PROPERTY)


def active_index(mesh: bpy.types.Mesh) -> int:
    """Return the index of the extender that is active in the panel, -1 if there is none."""
    index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY)
    return index if 0 <= index < len(of(mesh)) else -1


def active(mesh: bpy.types.Mesh) -> bpy.types.PropertyGroup | None:
    """Return the extender that is active in the panel."""
    index = active_index(mesh)
    return of(mesh)[index] if index >= 0 else None


def set_active(mesh: bpy.types.Mesh, index: int) -> None:
    """Make an extender the active one."""
    setattr(mesh, names.ACTIVE_EXTENDER_PROPERTY, index)
    editors.redraw(bpy.context)


def set_strength(mesh: bpy.types.Mesh, index: int, strength: float) -> None:
    """Set the strength of an extender, so that an undo step pushed afterwards knows it."""
    of(mesh)[index].strength = strength


def show_strength(mesh: bpy.types.Mesh, index: int, strength: float) -> None:
    """Let an extender have a strength for a while, which no undo step needs to know."""
    with _writing():
        of(mesh)[index].strength = strength


def changed(extender: bpy.types.PropertyGroup) -> bool:
    """Note that an extender has been changed through its properties; return whether it was by the user or a script."""
    if session.of(_Lists).is_writing:
        return False
    _mark(extender.id_data)
    return True


def renamed(extender: bpy.types.PropertyGroup) -> None:
    """Note that an extender has been renamed through its properties, and give it a name of its own."""
    if session.of(_Lists).is_writing:
        return
    # Members of a collection have no identity in Python; the path is one.
    path = extender.path_from_id()
    others = [other.name for other in of(extender.id_data) if other.path_from_id() != path]
    with _writing():
        extender.name = core.unique_name(extender.name or _new_name(), others)
    _mark(extender.id_data)


def ends(bm: BMesh, mesh: bpy.types.Mesh) -> list[tuple[int, int]]:
    """Return the indices of both vertices of every extender of `mesh` in `bm`, its edit mesh; -1 for one that is gone.

    Looks at all vertices. Where several carry the identifier, as duplicated geometry does, the first one counts. An
    extender both ends of which are one vertex, as only a damaged file has it, counts as having lost the second.
    """
    wanted = _ids_of_list(mesh)
    if not wanted:
        return []
    layer = _layer(bm, mesh)
    vertex_ids = _ids_of_vertices(bm, layer) if layer is not None else np.empty(0, dtype=np.int32)
    found = core.first_with(vertex_ids, wanted)
    return [(first, second if second != first else -1) for first, second in zip(found[::2], found[1::2])]


def resolve(bm: BMesh, mesh: bpy.types.Mesh) -> tuple[list[tuple[int, int, float]], list[str], list[str]]:
    """Return the extenders of `mesh` that act on a solve of `bm`, its edit mesh, and the names of those that cannot.

    Returns:
        (first vertex, second vertex, strength) of every extender that is on, whole and of nonzero strength, with the
        vertices' places in `bm.verts`; the names of those that are on, one of whose vertices is gone; and the names of
        those that are on and whole, but whose strength is no number within the limit, as a script or a file may have
        it.
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


def label(extender: bpy.types.PropertyGroup) -> str:
    """Return what to call an extender in a message; a file may have one without a name."""
    return extender.name or texts.unnamed_extender()


def _new_name() -> str:
    """Return the name of a new extender, in the user's language where Blender is to name new data in it."""
    return bpy.app.translations.pgettext_data(texts.EXTENDER_NAME)


def add(mesh: bpy.types.Mesh, pairs: Sequence[tuple[int, int]], strength: float) -> list[tuple[int, int]]:
    """Add an extender for every pair of vertices of a mesh in edit mode that has none yet; return these pairs.

    The last one becomes the active one. `pairs` are indices of vertices.
    """
    remember(mesh)
    bm = bmesh.from_edit_mesh(mesh)
    present = {frozenset(pair) for pair in ends(bm, mesh)}
    fresh = [pair for pair in pairs if frozenset(pair) not in present]
    if not fresh:
        return []
    vertex_ids = _identify(bm, mesh, [vertex for pair in fresh for vertex in pair])
    taken = {extender.name for extender in of(mesh)}
    extenders = _read(mesh)
    for pair in fresh:
        name = core.unique_name(_new_name(), taken)
        taken.add(name)
        extenders.append(Extender(name, strength, True, *(vertex_ids[vertex] for vertex in pair)))
    _write(mesh, extenders)
    _mark(mesh)
    set_active(mesh, len(extenders) - 1)
    return fresh


def remove(mesh: bpy.types.Mesh, indices: Sequence[int]) -> None:
    """Remove extenders; the active one stays active, or the one before takes its place."""
    remember(mesh)
    index = active_index(mesh)
    extenders = [extender for k, extender in enumerate(_read(mesh)) if k not in indices]
    _write(mesh, extenders)
    _mark(mesh)
    index -= sum(k <= index for k in indices) if index in indices else sum(k < index for k in indices)
    set_active(mesh, max(index, 0))


def remember(mesh: bpy.types.Mesh) -> None:
    """Remember the list of a mesh for an undo of changes that are to come."""
    extenders = _read(mesh)
    session.of(_Lists).by_layer[core.layer_name(names.EXTENDER_LAYER_PREFIX, extenders)] = extenders


def restore(mesh: bpy.types.Mesh) -> None:
    """After an undo or redo in edit mode, give a mesh the list that goes with its layer."""
    layers = _layer_names(mesh)
    if _layer_property(mesh) in layers:
        return
    known = [name for name in layers if name in session.of(_Lists).by_layer]
    if known:
        extenders, name = session.of(_Lists).by_layer[known[0]], known[0]
    elif not layers and (without_layer := session.of(_Lists).without_layer.get(identity.of(mesh))) is not None:
        extenders, name = without_layer, ""
    else:
        return
    index = getattr(mesh, names.ACTIVE_EXTENDER_PROPERTY)
    _write(mesh, extenders)
    setattr(mesh, names.EXTENDER_LAYER_PROPERTY, name)
    set_active(mesh, max(min(index, len(extenders) - 1), 0))


def _identify(bm: BMesh, mesh: bpy.types.Mesh, vertices: Sequence[int]) -> dict[int, int]:
    """Return the identifiers of vertices, given by index; those without one get one."""
    layer = _layer(bm, mesh)
    if layer is None:
        session.of(_Lists).without_layer[identity.of(mesh)] = _read(mesh)
        name = core.layer_name(names.EXTENDER_LAYER_PREFIX, _read(mesh))
        layer = bm.verts.layers.int.new(name)
        setattr(mesh, names.EXTENDER_LAYER_PROPERTY, name)
    bm.verts.ensure_lookup_table()
    used, present = _ids_of_list(mesh), _ids_of_vertices(bm, layer)
    found = core.first_with(present, used)
    id_of_vertex = {vertex: vertex_id for vertex, vertex_id in zip(found, used) if vertex >= 0}
    # Vertices still carry the identifiers of removed extenders.
    fresh = core.fresh_ids([*used, *np.unique(present).tolist()])
    for vertex in vertices:
        if vertex not in id_of_vertex:
            id_of_vertex[vertex] = bm.verts[vertex][layer] = next(fresh)
    return id_of_vertex


def _ids_of_list(mesh: bpy.types.Mesh) -> list[int]:
    return [vertex_id for extender in of(mesh) for vertex_id in (extender.first_id, extender.second_id)]


def _ids_of_vertices(bm: BMesh, layer: BMLayerItem) -> np.ndarray:
    return np.fromiter((vertex[layer] for vertex in bm.verts), dtype=np.int32, count=len(bm.verts))


def _mark(mesh: bpy.types.Mesh) -> None:
    """Rename the layer of a mesh after its list, which has changed, and let what is drawn of it follow."""
    remember(mesh)
    # Blender draws again where a property changes, but not where one goes.
    editors.redraw(bpy.context)
    attribute = _attribute(mesh)
    if attribute is None:
        return
    name = core.layer_name(names.EXTENDER_LAYER_PREFIX, _read(mesh))
    if attribute.name != name:
        attribute.name = name
    setattr(mesh, names.EXTENDER_LAYER_PROPERTY, attribute.name)


def _attribute(mesh: bpy.types.Mesh) -> bpy.types.Attribute | None:
    """Return the attribute with the identifiers, in edit mode or not."""
    name = _chosen(mesh, _layer_names(mesh))
    return mesh.attributes[name] if name else None


def _layer(bm: BMesh, mesh: bpy.types.Mesh) -> BMLayerItem | None:
    """Return the layer of `bm` with the identifiers."""
    layers = bm.verts.layers.int
    name = _chosen(mesh, [name for name in layers.keys() if name.startswith(names.EXTENDER_LAYER_PREFIX)])  # noqa: SIM118
    return layers[name] if name else None


def _layer_names(mesh: bpy.types.Mesh) -> list[str]:
    """Return the names of the layers that may hold identifiers; others of such a name are not this add-on's."""
    return [
        a.name
        for a in mesh.attributes
        if a.name.startswith(names.EXTENDER_LAYER_PREFIX) and (a.data_type, a.domain) == ("INT", "POINT")
    ]


def _chosen(mesh: bpy.types.Mesh, layers: Sequence[str]) -> str:
    """Return which of several layers goes with the list: a mesh joined from others has theirs, too."""
    return _layer_property(mesh) if _layer_property(mesh) in layers else next(iter(layers), "")


def _layer_property(mesh: bpy.types.Mesh) -> str:
    return getattr(mesh, names.EXTENDER_LAYER_PROPERTY)


def _read(mesh: bpy.types.Mesh) -> list[Extender]:
    return [Extender(e.name, e.strength, e.use, e.first_id, e.second_id) for e in of(mesh)]


def _write(mesh: bpy.types.Mesh, extenders: Sequence[Extender]) -> None:
    with _writing():
        collection = of(mesh)
        collection.clear()
        for extender in extenders:
            item = collection.add()
            item.name = extender.name
            item.strength = extender.strength
            item.use = extender.use
            item.first_id = extender.first_id
            item.second_id = extender.second_id


@contextmanager
def _writing() -> Iterator[None]:
    """Within, changes of properties do nothing but change them."""
    session.of(_Lists).is_writing = True
    try:
        yield
    finally:
        session.of(_Lists).is_writing = False
