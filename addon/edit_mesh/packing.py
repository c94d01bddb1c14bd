# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own packer, over chosen faces only."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager

import bmesh
import bpy
import numpy as np

from .. import compatibility
from ..core import texts
from ..core.errors import ReadableError
from ..core.options import Margin
from ..core.translation import translate
from .read import EditMesh, active_uv_layer


class PackingError(ReadableError):
    """Blender's packer did not run; the message says what to do."""


def pack(
    context: bpy.types.Context, edit_meshes: Sequence[EditMesh], faces: Sequence[np.ndarray], margin: Margin
) -> None:
    """Pack the islands of the given selected `faces`, one (F,) bool per mesh, into the UV tile; leave all others.

    Raises:
        PackingError: the packer did not run.
    """
    chosen = {edit_mesh.mesh: flags for edit_mesh, flags in zip(edit_meshes, faces)}
    meshes = [edit_object.data for edit_object in context.objects_in_mode_unique_data]
    # The packer takes every selected UV of every object in edit mode. With failed islands or unselected UVs among the
    # selected faces, the UV selection must say what to pack; that alone takes as long as all the rest in Python.
    everything = all(mesh.total_face_sel == np.count_nonzero(chosen.get(mesh, ())) for mesh in meshes)
    by_faces = everything and compatibility.can_pack_by_mesh_selection(context.scene.tool_settings)
    selection = _selected_faces(context, meshes) if by_faces else _selected_uvs(context, meshes, chosen)
    # The packer refuses to run from an image editor that shows no UVs, and where the active object has none; without an
    # area, and for an object that was unwrapped, it runs anywhere.
    solved = edit_meshes[0].edit_object
    anywhere = {"area": None, "region": None, "object": solved, "active_object": solved, "edit_object": solved}
    with selection, context.temp_override(**anywhere):
        _run_packer(margin)


def _run_packer(margin: Margin) -> None:
    # A script may give any number, and Blender would pack to places that are none.
    if not np.isfinite(margin.size):
        raise PackingError(texts.no_margin(margin.size))
    try:
        # Rotating, the packer looks at pixels of the active image, and skews islands where that is not square.
        status = bpy.ops.uv.pack_islands(
            "EXEC_DEFAULT", margin=margin.size, rotate=False, **compatibility.packing_options(margin.method)
        )
        reason = translate(texts.PACKER_WAS_CANCELLED)
    except (RuntimeError, TypeError) as error:
        status, reason = set(), str(error).strip()
    if "FINISHED" not in status:
        raise PackingError(texts.not_packed(reason))


@contextmanager
def _selected_faces(context: bpy.types.Context, meshes: Sequence[bpy.types.Mesh]) -> Iterator[None]:
    """Let the mesh selection stand for the UV selection; then restore what was there."""
    with _sync_selection(context, True), ExitStack() as stack:
        for mesh in meshes:
            stack.enter_context(compatibility.mesh_selection_only(bmesh.from_edit_mesh(mesh)))
        yield


@contextmanager
def _selected_uvs(
    context: bpy.types.Context, meshes: Sequence[bpy.types.Mesh], chosen: dict[bpy.types.Mesh, np.ndarray]
) -> Iterator[None]:
    """Make the `chosen` faces the whole UV selection; then restore what was there."""
    meshes = [mesh for mesh in meshes if mesh.uv_layers.active]
    saved = [compatibility.read_uv_selection(*active_uv_layer(mesh)) for mesh in meshes]
    try:
        with _sync_selection(context, False):
            for mesh in meshes:
                bm, layer = active_uv_layer(mesh)
                flags = chosen[mesh].tolist() if mesh in chosen else [False] * len(bm.faces)
                compatibility.select_uv_of_faces(bm, layer, flags)
            yield
    finally:
        for mesh, selection in zip(meshes, saved):
            compatibility.write_uv_selection(*active_uv_layer(mesh), selection)


@contextmanager
def _sync_selection(context: bpy.types.Context, use: bool) -> Iterator[None]:
    tool_settings = context.scene.tool_settings
    before = tool_settings.use_uv_select_sync
    tool_settings.use_uv_select_sync = use
    try:
        yield
    finally:
        tool_settings.use_uv_select_sync = before
