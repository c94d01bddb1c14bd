# SPDX-License-Identifier: GPL-3.0-or-later
"""Packing of the maps of the meshes in edit mode: read, find the tiles, report."""

from collections.abc import Sequence

import bpy
import numpy as np

from .. import compatibility, session
from ..core import choices
from ..core.layout.map_packing import MapPacking, MapPackOptions
from ..core.layout.shape_packing import Packed, Region, region_of_tile
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.read import EditMesh, Reading, out_of_edit_mode, read_meshes
from ..session import Lifetime, Remembered
from . import result_numbers
from .texel_density import selected_faces

_TILES_IN_A_ROW = 10
# To choose from if as many are filled as needed.
_MOST_TILES = 100


def read(context: bpy.types.Context, correct_aspect: bool) -> tuple[list[EditMesh], list[np.ndarray]]:
    """Read all meshes in edit mode with a UV map and faces, and which faces of each are selected, (F,) bool.

    Without a selection these are all visible ones. The selected faces of the meshes read are the visible ones.
    """
    objects = context.objects_in_mode_unique_data
    found = read_meshes(objects, Reading(all_visible=True, correct_aspect=correct_aspect))
    edit_meshes = [each for each in found if each.polygons.uv is not None and len(each.polygons.selected_faces)]
    chosen = selected_faces(context, [each.edit_object for each in edit_meshes])
    return edit_meshes, [chosen[each.edit_object] for each in edit_meshes]


def groups(edit_meshes: Sequence[EditMesh], kind: str) -> list[np.ndarray] | None:
    """Return the group of every face, (F,) for each mesh, given the property of the operator; None for no groups."""
    if kind == "NONE":
        return None
    if kind == "OBJECT":
        return [np.full(len(each.polygons.selected_faces), index) for index, each in enumerate(edit_meshes)]
    numbers: dict[bpy.types.Material | None, int] = {}
    found = []
    for each in edit_meshes:
        slots = [slot.material for slot in each.edit_object.material_slots] or [None]
        of_slot = np.array([numbers.setdefault(material, len(numbers)) for material in slots])
        with out_of_edit_mode(each.mesh) as mesh:
            found.append(of_slot[compatibility.materials(mesh, len(slots))])
    return found


def regions(context: bpy.types.Context, kind: str, count: int, box: Sequence[float]) -> list[Region] | str:
    """Return what to fill, as `MapPackOptions.regions`, given the properties of the operator."""
    if kind in (choices.TILES_OWN, choices.TILES_BOUNDS):
        return kind
    if kind == choices.TILES_BOX:
        corners = np.array(box, dtype=np.float64).reshape(2, 2)
        return [(*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())]
    column, row = _active_tile(context)
    start = column + _TILES_IN_A_ROW * row
    count = {choices.TILES_ACTIVE: 1, choices.TILES_AUTO: _MOST_TILES}.get(kind, count)
    numbers = range(start, start + count)
    return [region_of_tile((number % _TILES_IN_A_ROW, number // _TILES_IN_A_ROW)) for number in numbers]


def rounds_to_pixels(context: bpy.types.Context) -> bool:
    """Return whether Blender's Round to Pixels is on in the UV editor that packs."""
    return getattr(getattr(context.space_data, "uv_editor", None), "pixel_round_mode", "DISABLED") != "DISABLED"


def _active_tile(context: bpy.types.Context) -> tuple[int, int]:
    """Return the active tile of the UV editor, this one or any in the window; the first tile without an editor."""
    areas = [] if context.screen is None else list(context.screen.areas)
    for area in [area for area in (context.area, *areas) if area is not None and area.type == "IMAGE_EDITOR"]:
        image = area.spaces.active.image
        if image is not None and image.source == "TILED" and image.tiles.active is not None:
            number = image.tiles.active.number - 1001
            return number % _TILES_IN_A_ROW, number // _TILES_IN_A_ROW
    return 0, 0


def reports(
    context: bpy.types.Context, found: Packed, packing: MapPacking, options: MapPackOptions, seconds: float
) -> list[tuple[str, str]]:
    """Return the reports of packed maps as (level, text) pairs, some empty, the most important last."""
    note_fill(found.fill)
    placed = found.islands - found.without_room
    result_numbers.store(
        "pack", seconds=seconds, packed=placed, stacked=found.stacked, fill=found.fill, steps=found.steps
    )
    is_kept, is_group = found.is_kept and placed > 0, options.groups is not None
    return [
        ("INFO", texts.counted(packing.pinned, texts.PACKED_AROUND_PINS)),
        (
            "INFO",
            translate("Blender does not tell add-ons its Custom Region; to fill a part of the tile, pack to a Box")
            if _has_custom_region(context, options)
            else "",
        ),
        ("INFO", texts.counted(packing.kept_turns, texts.NOT_TURNED)),
        ("INFO", texts.packed(placed, found.stacked, found.fill, seconds, is_kept, is_group, _tiles(found, options))),
        ("WARNING", texts.without_room(found.without_room, found.islands, is_group)),
    ]


def _has_custom_region(context: bpy.types.Context, options: MapPackOptions) -> bool:
    """Return whether Blender's own packing would fill a region that no add-on can read (5.0 to 5.2)."""
    return getattr(context.tool_settings, "use_uv_custom_region", False) and not options.fills_box


def status(found: Packed | None, options: MapPackOptions) -> str:
    """Return the text of the status bar for a packing in progress, and remember its fill."""
    if found:
        note_fill(found.fill)
    return texts.pack_status(found.fill, found.steps, _tiles(found, options)) if found else texts.pack_status(None, 0)


def _tiles(found: Packed, options: MapPackOptions) -> int:
    """Return the number of tiles to fill; 0 for a box."""
    return 0 if options.fills_box else found.regions


class _LastFill(Remembered):
    """How much of the tile is filled, as far as the last packing has come."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        self.fill: float | None = None


def note_fill(fill: float) -> None:
    """Remember for the sidebar how much of the tiles is filled."""
    session.of(_LastFill).fill = fill


def last_fill() -> float | None:
    """Return how much of the tiles the last packing has filled; None if nothing is known."""
    return session.of(_LastFill).fill


def nothing_to_pack(pinned: int) -> str:
    """Return why there is nothing to pack."""
    return translate("Nothing can move: all selected islands are pinned" if pinned else texts.NOTHING_SELECTED)
