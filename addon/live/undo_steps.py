# SPDX-License-Identifier: GPL-3.0-or-later
"""One undo for a change and the map that followed it, although Blender has a step for each of the two.

Blender tells nothing of its steps, so they are known by what is in them: an undo that leads from a map that followed to
the state without it goes on, and so does the redo over the same step.
"""

import hashlib

import bpy
import numpy as np

from .. import compatibility, session
from ..edit_mesh import shapes
from ..edit_mesh.read import temporary_mesh
from ..session import Remembered, edit_meshes


class _Passages(Remembered):
    """The steps over which undo and redo go on.

    Attributes:
        onward: digests of the state that is left, and of the one without its map that is reached.
        left: the state that undo or redo is leaving; None if nothing may go on from there.
        is_going_on: whether an undo or redo goes on.
    """

    def __init__(self) -> None:
        self.onward: set[tuple[bytes, bytes]] = set()
        self.left: bytes | None = None
        self.is_going_on = False


def state() -> bytes:
    """Return a digest of the maps, seams, stored shapes and positions of the meshes in edit mode."""
    digest = hashlib.blake2b(digest_size=16)
    with temporary_mesh() as copy:
        for edit_object in edit_meshes.edited():
            edit_meshes.keep(edit_object.data).bm.to_mesh(copy)
            seams = compatibility.flags(copy, "edges", "use_seam")
            digest.update(edit_object.name_full.encode() + seams.tobytes())
            digest.update(compatibility.positions(copy).tobytes())
            for layer, _ in shapes.of(edit_object.data):
                marks = np.empty(len(copy.attributes[layer].data), dtype=np.int32)
                copy.attributes[layer].data.foreach_get("value", marks)
                digest.update(layer.encode() + marks.tobytes())
            if copy.uv_layers.active is not None:
                digest.update(compatibility.corner_uv(copy).tobytes())
    return digest.digest()


def join(before: bytes) -> None:
    """Let undo go on from the present maps over the state `before` they followed what has changed."""
    session.of(_Passages).onward.add((state(), before))


def leave() -> None:
    """Note the state that undo or redo is about to leave."""
    passages = session.of(_Passages)
    if passages.onward and not passages.is_going_on:
        passages.left = state()


def arrive(is_undo: bool) -> None:
    """Go on with an undo or redo that has reached the state between a change and its map."""
    passages = session.of(_Passages)
    left, passages.left = passages.left, None
    if left is None or passages.is_going_on:
        return
    between = state()
    if (left, between) not in passages.onward:
        return
    passages.is_going_on = True
    try:
        # Other steps without a map, such as a selection, may lie there, too.
        for _ in range(max(1, bpy.context.preferences.edit.undo_steps)):
            further = bpy.ops.ed.undo if is_undo else bpy.ops.ed.redo
            if not further.poll() or further() != {"FINISHED"}:
                break
            reached = state()
            if reached != between:
                passages.onward.add((reached, between))
                break
    finally:
        passages.is_going_on = False
