"""What a file has, as Blender lists it once the file is open, so that a loss is seen, not believed."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import bpy

from ...assets.inventory import Items

# The window's own; those of a file are not read. The last, since Blender 5.1, has all others again.
_LEFT_OUT = ("screens", "window_managers", "workspaces", "all_ids")
_ALWAYS_SAVED = tuple(getattr(bpy.types, name) for name in ("Scene", "WindowManager", "WorkSpace", "Screen", "Library"))
# Of FBX, which Blender converts: the rest is compared in the file itself (`fbx_inventory`).
CONVERTED = ("meshes", "faces", "materials", "images", "files of images", "packed images")


def listed() -> Items:
    """Count the items of the open file by kind and name: data-blocks in use, and what meshes and objects consist of."""
    found: Items = Counter()
    for kind in _kinds():
        # Saving leaves out what nothing uses.
        found.update((kind, item.name_full) for item in getattr(bpy.data, kind) if _is_used(item))
    for mesh in filter(_is_used, bpy.data.meshes):
        found["faces", mesh.name_full] += len(mesh.polygons)
        found.update(("materials of meshes", f"{mesh.name_full}: {each.name_full}") for each in mesh.materials if each)
        found.update(("UV maps", f"{mesh.name_full}: {each.name}") for each in mesh.uv_layers)
        found.update(
            ("attributes", f"{mesh.name_full}: {each.name}")
            for each in mesh.attributes
            if not getattr(each, "is_internal", each.name.startswith("."))
        )
    for item in filter(_is_used, bpy.data.objects):
        for kind in ("modifiers", "constraints", "vertex_groups"):
            found.update((kind.replace("_", " "), f"{item.name_full}: {each.name}") for each in getattr(item, kind, ()))
    for image in filter(_is_used, bpy.data.images):
        if image.packed_file:
            found["packed images", image.name_full] += 1
        elif image.source != "VIEWER" and _path(image).is_file():
            found["files of images", _path(image).name] += 1
    found.update(("files of libraries", each.name) for each in bpy.data.libraries if _path(each).is_file())
    return found


def keep() -> None:
    """Keep what counts as used, but only by what is not: in files of old Blenders, the images of their materials.

    Saved and opened again, it would not count any more, and after the next time it would be gone.
    """
    used_by: dict[bpy.types.ID, list[bpy.types.ID]] = {}
    for item, users in bpy.data.user_map().items():
        for user in users:
            used_by.setdefault(user, []).append(item)
    waiting = [item for item in bpy.data.user_map() if item.use_fake_user or isinstance(item, _ALWAYS_SAVED)]
    reached = set(waiting)
    while waiting:
        new = {item for item in used_by.get(waiting.pop(), ()) if item not in reached}
        reached |= new
        waiting += new
    for kind in _kinds():
        for item in getattr(bpy.data, kind):
            if item not in reached and item.library is None and _is_used(item):
                item.use_fake_user = True


def _kinds() -> list[str]:
    """Return the names of the lists of data-blocks."""
    names = (each.identifier for each in bpy.data.bl_rna.properties if each.type == "COLLECTION")
    return [name for name in names if name not in _LEFT_OUT]


def _is_used(item: bpy.types.ID) -> bool:
    # Of an image, the extra user is an editor that shows it, in a window of the file.
    is_shown = isinstance(item, bpy.types.Image) and item.use_extra_user
    return item.users > is_shown


def _path(item: bpy.types.Image | bpy.types.Library) -> Path:
    return Path(bpy.path.abspath(item.filepath, library=item.library))
