# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences with numbers, and words that several places say; all others stand where they are shown.

A chart is an island here, as in Blender. A function that returns an empty text has nothing to say.

Every text that an artist reads is a key of the tables in addon/locale/, with named fields for values. The functions
translate their sentences and the labels that they get. The constants are English: Blender translates labels and
descriptions itself; everything else goes through `translation.translate` where it is shown. The tables have the
solver's sentences, too (`measure/summary.py`).
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from .. import choices
from .percent import percent_of_qc
from .translation import translate

if TYPE_CHECKING:
    from ..measure.defects import Defects
    from ..measure.map_view import IslandNumbers
    from ..measure.quality import MapQuality
    from ..measure.summary import Strain, Summary, Unevenness

UNWRAP_LABEL = "Spectral Unwrap"
# Of a property: Blender itself may translate the name of the verb in another way.
UNWRAP_TOO_LABEL = "Then Unwrap"
RELAX_LABEL = "Spectral Relax"
PACK_LABEL = "Spectral Pack"
# In the sidebar.
VERBS = ("Unwrap", "Relax", "Pack")
NEW_TEXTURES_LABEL = "New UV Map and Textures"
IMPROVING_KEYS = "Enter or click: Keep   Esc or right click: Restore"
SELECT_DEFECTS_LABEL = "Select Flipped and Overlapping"
SELECT_STRETCHED_LABEL = "Select Stretched Faces"
SELECT_FAILED_LABEL = "Select Failed Islands"
SUGGEST_SEAMS_LABEL = "Suggest Seams"
SEAM_HINT_LABEL = "Seam Hint"
SEAM_HINTS = (
    ("CUT", "Cut Here", "Suggest Seams cuts the selected edges"),
    ("NEVER", "Never Here", "Suggest Seams does not cut the selected edges"),
    ("CLEAR", "Clear Hints", "Leave the selected edges to Suggest Seams"),
)
SHAPE_PANEL_LABEL = "Shape"
SHAPE_ITEMS = (
    (choices.SHAPE_STRAIGHT, "Straight", "Keep the selected edges straight in the map, exactly and without pins"),
    (
        choices.SHAPE_RECTANGLE,
        "Rectangle",
        "Keep the selected faces or islands rectangular; four selected vertices on an island's border become its "
        "corners, otherwise the sharpest ones do",
    ),
    (choices.SHAPE_GRID, "Grid", "Keep the rows and columns of the selected quads straight in the map"),
    (
        choices.SHAPE_SYMMETRIC,
        "Symmetric",
        "Make both sides of the selected edges mirror images in the map, with the edges upright; if faces are "
        "selected, the mirror plane of their islands is the axis",
    ),
    (
        choices.SHAPE_UPRIGHT,
        "Upright",
        "Turn the selected islands upright, by their edges or by an axis of the mesh; without a selection, all islands",
    ),
    (choices.SHAPE_EXTENDER, "Push/Pull", "Push pairs of selected vertices apart in the map, or pull them together"),
)
# What the list calls them, by their kinds.
CONSTRAINT_KINDS = {
    "STRAIGHT": "Straight {number}",
    "RECTANGLE": "Rectangle {number}",
    "GRID": "Grid {number}",
    "SYMMETRIC": "Symmetric {number}",
}
NO_RECTANGLE_SELECTED = "Nothing selected; select faces, or the four corners of an island"
NO_QUADS_SELECTED = "No quads selected; select quads that form a grid"
NO_GRID = "These quads do not form a grid; leave out those around vertices where three, or five or more, of them meet"
NO_RECTANGLE = "To become a rectangle, an island needs a single border, with four or more vertices, and no holes"
TWO_DIRECTIONS = "Some seams would have to be horizontal on one side and vertical on the other; select fewer islands"
NO_FACE_AT_EDGES = "No visible face has these edges, so nothing was unwrapped"
LIVE_UNWRAP_LABEL = "Live Spectral Unwrap"
ADJUST_EXTENDER_LABEL = "Adjust Push/Pull"
SIDEBAR_TAB = "Spectral"
SEAMS_LABEL = "Seams"
ADVANCED_LABEL = "Advanced"
DEFECTS_LABEL = "Flipped and Overlapping"
TEXEL_DENSITY_LABEL = "Texel Density"
APPLY_LABEL = "Apply"
EQUALIZE_LABEL = "Equalize"
DENSITY_ITEMS = (
    (choices.DENSITY_NUMBER, "Number", "Scale the selected islands to a number of pixels per unit of length"),
    (
        choices.DENSITY_EQUAL,
        EQUALIZE_LABEL,
        "Scale the selected islands of all meshes to an equal texel density, times their factors; the scale of the "
        "objects and the sizes of their textures count",
    ),
    (
        choices.DENSITY_FACTOR,
        "Factor",
        "Give the selected islands more or fewer pixels than others, such as 1.5 for a head; kept with the mesh, for "
        "Spectral Unwrap and Equalize",
    ),
    (
        choices.DENSITY_PICKED,
        "Pick",
        "Show how many pixels of the texture the selected islands have per unit of length, and use that for Number",
    ),
)
EXTENDERS_LABEL = "Push/Pull"
TEXTURE_SIZES = (("1k", 1024), ("2k", 2048), ("4k", 4096))
SEAM_STYLES = (
    ("AUTO", "By Shape", "Hard Surface if at least half of the bending lies on sharp edges, else Organic"),
    ("HARD", "Hard Surface", "Along sharp edges, into any number of islands"),
    ("ORGANIC", "Organic", "Fewer islands, and the front stays clearer"),
    (choices.SEAMS_BY_ANGLE, "By Angle", "Cut the edges where faces meet at a sharp angle"),
)
SELECT_ITEMS = (
    (choices.SELECT_DISTORTED, "Most Distorted", "Faces that the map distorts most, or beyond a limit"),
    (choices.SELECT_STRETCHED, "Stretched Faces", "Faces that the map stretches to more than twice their width"),
    (choices.SELECT_DEFECTS, DEFECTS_LABEL, "Faces that are flipped or overlap others of their island"),
    (choices.SELECT_FLIPPED, "Flipped", "Faces that are flipped relative to the rest of their island"),
    (choices.SELECT_OVERLAPPING, "Overlapping", "Faces that overlap another face of their island"),
    (
        choices.SELECT_FAILED,
        "Failed Islands",
        "Islands that the last unwrap could not solve, or the edges whose shapes contradict each other",
    ),
)
# What the buttons below a warning say.
SELECT_LABELS = {choices.SELECT_STRETCHED: SELECT_STRETCHED_LABEL, choices.SELECT_FAILED: SELECT_FAILED_LABEL}

MAP_OVERLAY_LABEL = "UV Map Overlay"
TOO_MANY_FACES_TO_COLOR = "Too many faces to color:"
LIMIT_IN_PREFERENCES = "The add-on's preferences set the limit"

# Enumeration items: (identifier, label, description).
LOOK_ITEMS = (
    (choices.LOOK_ANGLE, "Angle Distortion", "How far angles are off; 0 % where they are kept"),
    (choices.LOOK_SIZE, "Size", "Size in the map relative to the surface in the world, compared with the median"),
    (choices.LOOK_DENSITY, TEXEL_DENSITY_LABEL, "Pixels of the texture per unit of length in the world"),
    (choices.LOOK_DEFECTS, DEFECTS_LABEL, "Faces that are flipped or overlap others of their island"),
    (choices.LOOK_CHECKER, "Checker", "Checker squares on the surface; materials stay as they are"),
    (
        choices.LOOK_STACKS,
        "Stacks and Margin",
        "Stacks of equal or mirrored islands in one color each, and the margin around islands as a band",
    ),
)

TOO_LITTLE_MEMORY_FOR_MESH = "Not enough memory for this mesh; close other programs, select fewer faces, or add seams"
NOTHING_SELECTED = "No faces selected"
NO_EDGES_SELECTED = "No edges selected"
MESHES_CHANGED_NO_TEXTURES = "Meshes or materials changed meanwhile, so nothing was written; call it again"
ONLY_LINKED_MESHES = "The selected meshes belong to linked files, and cannot be changed; make them local first"
NO_UV_MAP = "There is no UV map; unwrap first"
UNUSED_EXTENDERS = (
    "{n} push/pull had no effect: both vertices must lie in one unwrapped island, not both pinned",
    "{n} pushes/pulls had no effect: both vertices must lie in one unwrapped island, not both pinned",
)
BROKEN_EXTENDERS = (
    "Skipped {n} push/pull that lost a vertex: {names}",
    "Skipped {n} pushes/pulls that lost a vertex: {names}",
)
REFUSED_PARTS = (
    "{problem}; {n} part stays as it is, now selected",
    "{problem}; {n} parts stay as they are, now selected",
)
ARRANGED = ("Arranged {n} island", "Arranged {n} islands")
REFUSED_HINTS = (
    "{n} edge is cut despite Never Here: otherwise an island could not be unwrapped, or would overlap itself",
    "{n} edges are cut despite Never Here: otherwise an island could not be unwrapped, or would overlap itself",
)
NOTHING_FREE = (
    "Nothing moved in {n} part of an island: unselected faces share all UVs; select more or turn off Hold the Rest",
    "Nothing moved in {n} parts of islands: unselected faces share all UVs; select more or turn off Hold the Rest",
)
FLIPPED_BY_BLENDING = ("{n} face flipped by Blend", "{n} faces flipped by Blend")
COVERED_BY_PARTS = (
    "The part solved in place now covers {n} face of the rest; select more, or move the UVs that it shares",
    "The part solved in place now covers {n} faces of the rest; select more, or move the UVs that it shares",
)
TOO_SMALL = (
    (
        "{n} face is too small for the precision of Blender's UVs; add seams that make its island flatter, or "
        "raise Angle to Area"
    ),
    (
        "{n} faces are too small for the precision of Blender's UVs; add seams that make their islands flatter, "
        "or raise Angle to Area"
    ),
)
WITHOUT_BOUNDS = (
    "{n} island had no former bounds and was packed into the UV tile",
    "{n} islands had no former bounds and were packed into the UV tile",
)
MIRRORED_PAIRS = (
    "{n} pair of islands mirrors each other: both are mapped alike, without an axis",
    "{n} pairs of islands mirror each other: both of a pair are mapped alike, without an axis",
)
NOT_TURNED = (
    "{n} island was not turned: it is bound by a stored shape",
    "{n} islands were not turned: they are bound by a stored shape",
)
PACKED_AROUND_PINS = ("{n} pinned island stays where it is", "{n} pinned islands stay where they are")
SELECTED_CONTRADICTING = (
    "Selected {n} edge whose shapes contradict each other",
    "Selected {n} edges whose shapes contradict each other",
)
# Differences of scale that Blender's own Unwrap ignores.
_EVEN_SCALE = 1e-4
_PINNED_METHODS = {"lscm": "pinned least squares (LSCM)", "spectral": "the spectral method with soft pins"}
# Numbers with what they count: for one, and for any other number.
_CUTS = ("{n} cut", "{n} cuts")
_EDGES = ("{n} edge", "{n} edges")
_EXTENDERS = ("{n} push/pull", "{n} pushes/pulls")
_FACES = ("{n} face", "{n} faces")
_TEXTURES = ("{n} texture", "{n} textures")
_ISLANDS = ("{n} island", "{n} islands")
_GROUPS = ("{n} group", "{n} groups")
_STEPS = ("{n} step", "{n} steps")
# What the solver does in a phase, by its name.
_PHASES = {
    "charts": "Finding islands",
    "kept maps": "Finding islands",
    "seams": "Finding seams",
    "assembly": "Measuring the surface",
    "area blend": "Flattening islands",
    "constraints": "Flattening islands",
    "ordering": "Flattening islands",
    "factorization": "Flattening islands",
    "solve": "Flattening islands",
    "eigenproblem": "Flattening islands",
    "nearest map": "Flattening islands",
    "polish": "Polishing",
    "unfold": "Removing flips",
    "unfolding": "Removing flips",
    "embedding": "Removing flips",
    "relax": "Relaxing",
    "placement": "Placing islands",
    "packing": "Packing",
    "quality": "Measuring the map",
    "rebake": "Drawing textures",
    "done": "Done",
}


def canceled(label: str) -> str:
    """Return the report of a canceled operator with this label."""
    return translate("{operator}: Canceled").format(operator=translate(label))


def progress(label: str, percent: int, phase: str) -> str:
    """Return the text of the status bar while the operator with this label runs."""
    operator = translate(label)
    if not phase:
        return translate("{operator}: {percent} %   Esc: Cancel").format(operator=operator, percent=percent)
    sentence = translate("{operator}: {phase}, {percent} %   Esc: Cancel")
    return sentence.format(operator=operator, percent=percent, phase=_phase(phase))


def printed_progress(label: str, percent: int, phase: str) -> str:
    """Return the line that prints the progress of the operator with this label."""
    sentence = translate("{operator}: {percent} % ({phase})")
    return sentence.format(operator=translate(label), percent=percent, phase=_phase(phase))


def _phase(phase: str) -> str:
    """Return what an artist reads of a phase of the solver, by its name; an unknown one under its own."""
    return translate(_PHASES.get(phase, phase))


def status(label: str, known: str, keys: str) -> str:
    """Return the text of the status bar while the operator with this label goes on until the artist ends it."""
    sentence = translate("{operator}: {known}   {keys}")
    return sentence.format(operator=translate(label), known=known, keys=translate(keys))


def could_not_follow(problem: str) -> str:
    """Return the line to print if live unwrapping could not follow."""
    sentence = translate("{operator} could not follow: {problem}")
    return sentence.format(operator=translate(LIVE_UNWRAP_LABEL), problem=problem)


def not_drawn(label: str, problem: str) -> str:
    """Return the line to print if something could not be drawn."""
    return translate("{name} could not be drawn: {problem}").format(name=translate(label), problem=problem)


def information(summary: Summary, seconds: float, fill: float | None = None, stacked: int = 0) -> str:
    """Return the report of an unwrap that solved at least one chart.

    `seconds` is the time of the whole operator; `fill` how much of the tile packed islands fill; `stacked` how many of
    them lie on others.
    """
    unwrapped = translate("Unwrapped {islands}: angles off by {mean} on average, {worst} at worst")
    if math.isinf(summary.mean_qc):
        unwrapped = translate("Unwrapped {islands}: angles off beyond measure, because faces shrink to nothing")
    parts = [
        unwrapped.format(
            islands=_count(summary.solved, _ISLANDS), mean=_angles(summary.mean_qc), worst=_angles(summary.max_qc)
        ),
        _defects(summary.flipped, summary.overlapping),
        *_filled(fill),
        *_on_others(stacked),
        translate("{seconds} s").format(seconds=format(seconds, ".2f")),
    ]
    return "; ".join(parts)


# Why a texture is not drawn anew, by the reasons of the module.
_KEPT_TEXTURES = {
    "tiles": "a sequence, a movie or tiles",
    "missing": "missing",
    "projection": "not projected by a UV map alone",
    "procedural": "moved by other nodes",
    "group": "in a node group",
}


def new_textures(uv_map: str, islands: int, textures: int, seconds: float) -> str:
    """Return the report of a new UV map, by its name, and of the textures drawn for it."""
    sentence = translate("New UV map {uv_map} with {islands}; {textures} drawn for it; {seconds} s")
    return sentence.format(
        uv_map=uv_map,
        islands=_count(islands, _ISLANDS),
        textures=_count(textures, _TEXTURES),
        seconds=format(seconds, ".2f"),
    )


def kept_textures(kept: Sequence[tuple[str, str]]) -> str:
    """Return which textures, by (name, reason), were not drawn anew; empty for none."""
    if not kept:
        return ""
    why = translate("{name}: {reason}")
    names = "; ".join(why.format(name=name, reason=translate(_KEPT_TEXTURES[reason])) for name, reason in kept)
    return translate("Not drawn anew, so keep the old UV map or bake these: {names}").format(names=names)


def coarser_textures(losses: dict[str, float]) -> str:
    """Return which textures have visibly fewer texels per length, and how many times; empty for none."""
    factor = translate("{name} {factor} times")
    names = ", ".join(factor.format(name=name, factor=format(loss, ".2g")) for name, loss in losses.items())
    sentence = translate("Coarser than before, so choose a larger size: {names}")
    return sentence.format(names=names) if names else ""


def copied_materials(names: Sequence[str]) -> str:
    """Return which materials were copied because other objects have them, too; empty for none."""
    sentence = translate("Copied, because other objects have these materials, too: {names}")
    return sentence.format(names=", ".join(names)) if names else ""


def _filled(fill: float | None, tiles: int = 1) -> list[str]:
    """Return how much of the tiles, or without `tiles` of a box, packed islands fill; nothing for None."""
    if fill is None:
        return []
    if not tiles:
        return [translate("{percent} of the box filled").format(percent=_percent(fill))]
    return [_count(tiles, ("{percent} of the tile filled", "{percent} of {n} tiles filled"), percent=_percent(fill))]


def last_fill(fill: float | None) -> str:
    """Return what the sidebar says of the last packing; `fill` is None where nothing is known."""
    if fill is None:
        return translate("Nothing packed yet")
    return translate("Last packing: {percent} filled").format(percent=_percent(fill))


def _on_others(stacked: int) -> list[str]:
    """Return how many islands lie on another; nothing for none."""
    return [translate("{count} stacked on others").format(count=stacked)] if stacked else []


def relaxed(gain: float, steps: int, flipped: int, overlapping: int, seconds: float) -> str:
    """Return the report of relaxed maps; `gain` is the fraction of their distortion that is gone."""
    percent = _percent(gain)
    gained = translate("Relaxed in {steps}: distortion {percent} lower")
    sentence = translate("Relaxed in {steps}: distortion hardly lower") if percent == _percent(0.0) else gained
    parts = [
        sentence.format(steps=_count(steps, _STEPS), percent=percent),
        _defects(flipped, overlapping),
        translate("{seconds} s").format(seconds=format(seconds, ".2f")),
    ]
    return "; ".join(parts)


def newly_covering(faces: int) -> str:
    """Return the warning about faces that lie on other islands since they were relaxed; empty for none."""
    forms = (
        "{n} face overlaps another island now; {operator} separates them",
        "{n} faces overlap other islands now; {operator} separates them",
    )
    return counted(faces, forms, operator=translate(PACK_LABEL))


def newly_beyond_tile(faces: int) -> str:
    """Return the warning about faces that have left their UV tile since they were relaxed; empty for none."""
    forms = (
        "{n} face lies beyond its UV tile now; {operator} brings it back",
        "{n} faces lie beyond their UV tile now; {operator} brings them back",
    )
    return counted(faces, forms, operator=translate(PACK_LABEL))


def relax_status(gain: float, steps: int) -> str:
    """Return the text of the status bar while maps relax."""
    known = translate("{steps}, distortion {percent} lower").format(steps=_count(steps, _STEPS), percent=_percent(gain))
    return status(RELAX_LABEL, known, IMPROVING_KEYS)


def packed(
    islands: int, stacked: int, fill: float, seconds: float, is_kept: bool, is_group: bool = False, tiles: int = 1
) -> str:
    """Return the report of packed islands, or groups of them, some of them stacked.

    If is_kept, nothing denser was found; tiles is as in `pack_status`.
    """
    sentence = translate("Kept {islands} as packed; no denser packing found" if is_kept else "Packed {islands}")
    parts = [sentence.format(islands=_count(islands, _GROUPS if is_group else _ISLANDS)), *_filled(fill, tiles)]
    return "; ".join([*parts, *_on_others(stacked), translate("{seconds} s").format(seconds=format(seconds, ".2f"))])


def without_room(islands: int, of: int, is_group: bool = False) -> str:
    """Return the warning about islands, or groups of them, that were not packed; empty for none."""
    if not islands:
        return ""
    sentence = translate("{count} of {islands} found no room; turn on Scale, lower the margin or fill more tiles")
    return sentence.format(count=islands, islands=_count(of, _GROUPS if is_group else _ISLANDS))


def pack_status(fill: float | None, steps: int, tiles: int = 1) -> str:
    """Return the text of the status bar while islands are packed; `fill` is None before the first packing.

    tiles: the number of those to fill; 0 for a box.
    """
    known = translate("{fill} after {steps}").format(fill="".join(_filled(fill, tiles)), steps=_count(steps, _STEPS))
    return status(PACK_LABEL, translate("packing ...") if fill is None else known, IMPROVING_KEYS)


def _defects(flipped: int, overlapping: int) -> str:
    faces = _joined(
        counted(flipped, ("{n} flipped face", "{n} flipped faces")),
        counted(overlapping, ("{n} overlapping face", "{n} overlapping faces")),
    )
    if not faces:
        return translate("no flipped faces")
    return translate("{faces} (see {operator})").format(faces=faces, operator=translate(SELECT_DEFECTS_LABEL))


def folds(flipped: int, overlapping: int) -> str:
    """Return the warning about flipped and overlapping faces of a pushed or pulled island; empty for none."""
    return _defects(flipped, overlapping) if flipped or overlapping else ""


def look(kind: str, unit: str) -> str:
    """Return the heading of the legend for a kind that the overlay shows; `unit` as in `density`."""
    label = translate(next(label for identifier, label, _ in LOOK_ITEMS if identifier == kind))
    if kind != choices.LOOK_DENSITY:
        return label
    return translate("{name} (px/{unit})").format(name=label, unit=unit or translate("unit"))


def look_value(kind: str, value: float) -> str:
    """Return a value of this kind as the legend shows it."""
    if kind == choices.LOOK_ANGLE:
        return _angles(value)
    if kind == choices.LOOK_SIZE:
        return translate("{factor} x").format(factor=format(2.0**value, ".2f"))
    return _digits(value)


def density_unit(unit: str) -> str:
    """Return the unit of texel densities; `unit` as in `density`."""
    return translate("px/{unit}").format(unit=unit or translate("unit"))


def density(value: float, unit: str) -> str:
    """Return a texel density with its unit, given the symbol of the unit of length, empty for Blender's unit."""
    return translate("{density} px/{unit}").format(density=_digits(value), unit=unit or translate("unit"))


def _digits(value: float) -> str:
    # Three digits are what an artist compares; never in powers of ten.
    return format(value, ".0f") if value >= 100.0 else format(value, ".3g")


def densities(mean: float, low: float, high: float, islands: int, unit: str) -> str:
    """Return what Pick says of a number of islands; `unit` as in `density`."""
    counted = _count(islands, _ISLANDS)
    # Equal to the digits shown.
    if high - low <= 0.005 * high:
        return translate("{islands}: {density}").format(islands=counted, density=density(mean, unit))
    sentence = translate("{islands}: {density} together, from {low} to {high}")
    return sentence.format(islands=counted, density=density(mean, unit), low=_digits(low), high=_digits(high))


def density_set(value: float, islands: int, unit: str) -> str:
    """Return what Number says; `unit` as in `density`."""
    sentence = translate("Scaled {islands} to {density}; pack them if they overlap now")
    return sentence.format(islands=_count(islands, _ISLANDS), density=density(value, unit))


def density_equalized(common: float, islands: int, with_factor: int, unit: str) -> str:
    """Return what Equalize says; `common` is the density of islands without a factor."""
    text = density_set(common, islands, unit)
    if with_factor:
        forms = ("{n} island has a factor of its own", "{n} islands have factors of their own")
        text = ". ".join((text, _count(with_factor, forms)))
    return text


def density_factor(factor: float, islands: int) -> str:
    """Return what Factor says."""
    sentence = translate("{islands}: factor {factor}; {unwrap} and {equalize} use it")
    return sentence.format(
        islands=_count(islands, _ISLANDS),
        factor=_digits(factor),
        unwrap=translate(UNWRAP_LABEL),
        equalize=translate(EQUALIZE_LABEL),
    )


def legend_ends(kind: str, low: float, middle: float, high: float) -> tuple[str, ...]:
    """Return the labels of the lower end, the middle and the upper end of the legend's colors."""
    if kind == choices.LOOK_DEFECTS:
        return (translate("good"), translate("overlapping"), translate("flipped"))
    return tuple(look_value(kind, value) for value in (low, middle, high))


def too_many_faces(meshes: Sequence[str]) -> list[str]:
    """Return the legend's lines about objects that the overlay skips, by name."""
    return [translate(TOO_MANY_FACES_TO_COLOR), *meshes, translate(LIMIT_IN_PREFERENCES)] if meshes else []


def legend_numbers(label: str, numbers: IslandNumbers) -> tuple[str, ...]:
    """Return the legend's lines about the part of the map with this label."""
    name, faces = translate(label), _count(numbers.faces, _FACES)
    if math.isnan(numbers.mean_qc):
        return (translate("{name}: {faces}, nothing to measure").format(name=name, faces=faces),)
    # Short: the legend has to fit beside panels.
    angles = translate("Angles off {mean}, worst {worst}")
    lines = [
        translate("{name}: {faces}").format(name=name, faces=faces),
        angles.format(mean=_angles(numbers.mean_qc), worst=_angles(numbers.max_qc)),
        translate("Sizes vary by {percent} %").format(percent=_spread(numbers.log2_scale_deviation)),
    ]
    if numbers.flipped or numbers.overlapping:
        defects = translate("{flipped} flipped, {overlapping} overlapping")
        lines.append(defects.format(flipped=numbers.flipped, overlapping=numbers.overlapping))
    return tuple(lines)


def figure(kind: str, numbers: IslandNumbers, mean_density: float, unit: str) -> str:
    """Return the one number of the shown maps that the sidebar has; empty for kinds without one, and without faces."""
    if math.isnan(numbers.mean_qc):
        return ""
    if kind == choices.LOOK_ANGLE:
        return _angles(numbers.mean_qc)
    if kind == choices.LOOK_SIZE:
        return translate("{percent} %").format(percent=_spread(numbers.log2_scale_deviation))
    if kind == choices.LOOK_DENSITY:
        return density(mean_density, unit)
    return _count(numbers.defective, _FACES) if kind == choices.LOOK_DEFECTS else ""


def legend_object(name: str, numbers: IslandNumbers, mean_density: float, unit: str) -> str:
    """Return the legend's line about one of several objects; `unit` as in `density`."""
    if math.isnan(numbers.mean_qc):
        return translate("{name}: nothing to measure").format(name=name)
    sentence = translate("{name}: {mean}, {density}")
    return sentence.format(name=name, mean=_angles(numbers.mean_qc), density=density(mean_density, unit))


def legend_more(objects: int) -> list[str]:
    """Return the legend's line about objects without a line; none for none."""
    return [_count(objects, ("and {n} more", "and {n} more"))] if objects > 0 else []


def stacked(count: int, islands_in_stacks: int, fill: float | None, tiles: int, margin: float) -> list[str]:
    """Return the legend's lines about the fill of the tiles, stacks and the margin in pixels."""
    lines = [
        *_filled(fill, tiles),
        translate("Margin of {margin} px: too narrow where bands touch").format(margin=format(margin, "g")),
    ]
    if not count:
        return [translate("No stacks"), *lines]
    return [
        _count(count, ("{n} stack of {islands}", "{n} stacks of {islands}"), islands=islands(islands_in_stacks)),
        *lines,
    ]


def _spread(log2_scale_deviation: float) -> str:
    """Return the deviation of the scale in percent."""
    return format(100.0 * (2.0**log2_scale_deviation - 1.0), ".1f")


def island_row(faces: int, mean_qc: float, max_qc: float, flipped: int, overlapping: int) -> str:
    """Return the line of an island in the list of the last result."""
    parts = [" / ".join((_angles(mean_qc), _angles(max_qc))), translate("{n} f.").format(n=faces)]
    if flipped:
        parts.append(translate("{n} flipped").format(n=flipped))
    if overlapping:
        parts.append(translate("{n} overlap").format(n=overlapping))
    return "   ".join(parts)


ISLAND_GONE = "The faces of this island have changed; unwrap again"


def selected_distorted(faces: int) -> str:
    """Return what Select says of a number of distorted faces."""
    if not faces:
        return translate("No such faces, selection unchanged")
    return translate("Selected {faces}").format(faces=_count(faces, _FACES))


def face_numbers(qc: float, log2_size: float, density: str, flipped: bool, overlapping: bool) -> tuple[str, ...]:
    """Return the legend's lines about the face under the mouse, given its `density` with the unit."""
    size = translate("Size {size}, {density}")
    lines = [
        translate("{name}: angles off by {qc}").format(name=translate(LEGEND_FACE), qc=_angles(qc)),
        size.format(size=look_value(choices.LOOK_SIZE, log2_size), density=density),
    ]
    if flipped and overlapping:
        lines.append(translate("Flipped and overlapping"))
    elif flipped or overlapping:
        lines.append(translate("Flipped" if flipped else "Overlapping"))
    return tuple(lines)


LEGEND_MESH = "Shown"
LEGEND_FACE = "Under the mouse"


def unfolded(summary: Summary) -> str:
    """Return what was unfolded on request, and the cost in angles; empty for nothing."""
    changes = _joined(
        counted(summary.unfolded, ("{n} flipped triangle unfolded", "{n} flipped triangles unfolded")),
        counted(summary.embedded, ("{n} island needed the slower method", "{n} islands needed the slower method")),
    )
    if not changes:
        return ""
    if summary.mean_qc_change is None:
        return translate("No Overlaps: {changes}").format(changes=changes)
    before, after = summary.mean_qc_change
    sentence = translate("No Overlaps: {changes}; angles there off by {after} on average, {before} before")
    return sentence.format(changes=changes, before=_angles(before), after=_angles(after))


def strained(strain: Strain) -> str:
    """Return the warning about strongly stretched faces; empty for none."""
    forms = (
        "{n} face is stretched to more than twice its width, {worst} times ({operator}); add seams there",
        "{n} faces are stretched to more than twice their width, up to {worst} times ({operator}); add seams there",
    )
    worst, operator = _digits(strain.max_qc), translate(SELECT_STRETCHED_LABEL)
    return counted(strain.faces, forms, worst=worst, operator=operator)


def uneven(unevenness: Unevenness) -> str:
    """Return the warning about islands whose sizes vary strongly; empty for none."""
    forms = (
        "{n} island varies in size by {percent} %; add a seam that opens it, or raise Angle to Area",
        "{n} islands vary in size, by up to {percent} %; add seams that open them, or raise Angle to Area",
    )
    return counted(unevenness.charts, forms, percent=_spread(unevenness.deviation))


def failures(summary: Summary) -> str:
    """Return why charts or whole meshes were not unwrapped; empty for none."""
    parts = []
    if summary.failed:
        sentence = translate("{failed} of {islands} failed, UVs unchanged: {reasons}")
        islands, reasons = _count(summary.solved + summary.failed, _ISLANDS), _grouped(summary.failures)
        parts.append(sentence.format(failed=summary.failed, islands=islands, reasons=reasons))
        if summary.lacks_seams:
            hint = translate("{operator} finds where to cut")
            parts.append(hint.format(operator=translate(SUGGEST_SEAMS_LABEL)))
    if summary.refused:
        parts.append(translate("Not unwrapped: {reasons}").format(reasons="; ".join(summary.refused)))
    return ". ".join(parts)


def repairs(summary: Summary) -> str:
    """Return the repairs and fallbacks of charts; empty for none."""
    forms = ("{n} island needed a repair or fallback: {reasons}", "{n} islands needed a repair or fallback: {reasons}")
    return counted(sum(summary.repairs.values()), forms, reasons=_grouped(summary.repairs))


def in_place(parts: int, held: int) -> str:
    """Return how many parts of islands were solved with UVs held that the rest shares; empty for none."""
    forms = (
        "{n} part of an island solved in place; {uvs} shared with the rest stayed",
        "{n} parts of islands solved in place; {uvs} shared with the rest stayed",
    )
    return counted(parts, forms, uvs=_count(held, ("{n} UV", "{n} UVs")))


def pinned(summary: Summary) -> str:
    """Return how charts that their pins bend were solved; empty for none."""
    ways = Counter({translate(_PINNED_METHODS.get(method, method)): count for method, count in summary.pinned.items()})
    forms = ("{n} island with pins: solved by {ways}", "{n} islands with pins: solved by {ways}")
    return counted(sum(summary.pinned.values()), forms, ways=_grouped(ways))


def average_density(objects: Sequence[str]) -> str:
    """Return the note on these objects, by name, whose scale is uneven; empty for none."""
    if not objects:
        return ""
    sentence = translate("{objects}: scaled unevenly, so every island has an average texel density; apply the scale")
    return sentence.format(objects=", ".join(objects))


def object_scale(scales: Sequence[tuple[float, float, float]], negative: Sequence[bool]) -> str:
    """Return Blender's own sentence about the first object with an uneven or negative scale."""
    for (x, y, z), is_negative in zip(scales, negative):
        if abs(x - y) >= _EVEN_SCALE or abs(y - z) >= _EVEN_SCALE:
            return translate("Object has non-uniform scale, unwrap will operate on a non-scaled version of the mesh")
        if is_negative:
            return translate("Object has negative scale, unwrap will operate on a non-flipped version of the mesh")
    return ""


def added_extenders(count: int, existing: int, follows: bool) -> str:
    """Return the report of Add Extender: `existing` pairs had one already; `follows` if the map has followed."""
    parts, extenders = [], _count(count, _EXTENDERS)
    if count and follows:
        parts.append(translate("Added {extenders}").format(extenders=extenders))
    elif count:
        sentence = translate("Added {extenders} for the next unwrap; {operator} acts at once")
        parts.append(sentence.format(extenders=extenders, operator=translate(ADJUST_EXTENDER_LABEL)))
    if existing:
        parts.append(translate("Pairs that already have one: {n}").format(n=existing))
    return ". ".join(parts)


def selected_failed(islands: int, faces: int) -> str:
    """Return the report of Select Failed Islands."""
    if faces == 0:
        return translate("No islands failed, selection unchanged")
    of_islands = _count(islands, ("{n} failed island", "{n} failed islands"))
    return translate("Selected {faces} of {islands}").format(faces=_count(faces, _FACES), islands=of_islands)


def selected_defects(defects: Sequence[Defects], flipped: bool, overlapping: bool) -> str:
    """Return the report of Select Flipped and Overlapping, given the defects of each mesh and the chosen kinds."""
    total = sum(int(found.chosen(flipped, overlapping).sum()) for found in defects)
    if total == 0:
        if flipped and overlapping:
            return translate("No flipped or overlapping faces, selection unchanged")
        if flipped:
            return translate("No flipped faces, selection unchanged")
        return translate("No overlapping faces, selection unchanged")
    kinds = (
        ("{n} flipped", sum(int(found.flipped.sum()) for found in defects) if flipped else 0),
        ("{n} overlapping", sum(int(found.overlapping.sum()) for found in defects) if overlapping else 0),
        ("{n} with invalid UVs", sum(int(found.not_finite.sum()) for found in defects)),
    )
    counts = ", ".join(translate(text).format(n=count) for text, count in kinds if count)
    return translate("Selected {faces}: {kinds}").format(faces=_count(total, _FACES), kinds=counts)


def aligned(islands: int) -> str:
    """Return the report of a number of turned islands."""
    forms = ("{n} island turned upright", "{n} islands turned upright")
    return _count(islands, forms) if islands else translate("All islands are upright already")


def constrained(label: str, edges: int) -> str:
    """Return the report of edges that an operator of this label has marked."""
    sentence = translate("{operator}: {edges} marked; unwrap to see it")
    return sentence.format(operator=translate(label), edges=_count(edges, _EDGES))


def hinted(hint: str, edges: int) -> str:
    """Return the report of a hint, by its identifier, for a number of edges."""
    label = next(label for identifier, label, _ in SEAM_HINTS if identifier == hint)
    return translate("{hint}: {edges}").format(hint=translate(label), edges=_count(edges, _EDGES))


def marked(count: int, edges: int, length: str) -> str:
    """Return the report of `count` marked cuts and of `edges` beside them, given their length with its unit."""
    cuts = [_count(count, _CUTS)] if count or not edges else []
    if edges:
        cuts.append(_count(edges, _EDGES))
    return translate("Marked {cuts}, length {length}").format(cuts=" + ".join(cuts), length=length)


def nothing_to_suggest(style: str, is_limited: bool) -> str:
    """Return the report of no suggested seams of a style; `is_limited` if the user limited the length."""
    if style == choices.SEAMS_BY_ANGLE:
        return translate("No seams to suggest: no edge is that sharp")
    if is_limited:
        return translate(
            "No seams to suggest: the islands are good enough, or no cut within the length limit improves them"
        )
    return translate("No seams to suggest: the islands are good enough, or no cut improves them")


def without_suggestion(errors: Sequence[str], names: Sequence[str]) -> str:
    """Return why meshes got no suggestion, given a reason for each mesh, empty if it got one."""
    refused = [": ".join((name, translate(error).rstrip("."))) for name, error in zip(names, errors) if error]
    return translate("No seams suggested for {meshes}").format(meshes="; ".join(refused)) if refused else ""


def preview_by_angle(degrees: float, edges: int, length: str) -> str:
    """Return which edges are shown as seams by an angle, given their length with its unit."""
    sentence = translate("{edges} of {degrees}° or more, length {length}")
    return sentence.format(edges=_count(edges, _EDGES), degrees=format(degrees, ".3g"), length=length)


def islands(count: int, fill: float | None = None) -> str:
    """Return how many islands there will be, and how much of the tile they will fill; None if they are not packed."""
    return ", ".join([_count(count, _ISLANDS), *_filled(fill)])


def found_style(styles: Sequence[str]) -> str:
    """Return which styles the shapes have, by the values of `suggest_cuts`; empty for none."""
    labels = {identifier.lower(): label for identifier, label, _ in SEAM_STYLES}
    names = ", ".join(translate(labels[style]) for style in styles)
    return translate("{style} (found)").format(style=names) if styles else ""


def preview(count: int, total: int, length: str, total_length: str) -> str:
    """Return how many of the suggested cuts are shown, given lengths with their unit."""
    cuts = _count(total, _CUTS)
    if count == total:
        return translate("{cuts}, length {length}").format(cuts=cuts, length=length)
    sentence = translate("{n} of {cuts}, length {length} of {total}")
    return sentence.format(n=count, cuts=cuts, length=length, total=total_length)


PREVIEW_KEYS = "Wheel, +/-, Page keys: Fewer or more   Enter or click on the mesh: Apply   Esc or right click: Cancel"


def expected(before: MapQuality, after: MapQuality) -> str:
    """Return what the shown cuts would bring; short, because the keys follow in the status bar."""
    even = translate("{percent} evenly sized (now {now})")
    parts = [even.format(percent=_percent(after.even), now=_percent(before.even))]
    if not math.isnan(after.mean_qc):
        if math.isnan(before.mean_qc):
            angles = translate("angles off by {mean} on average")
        else:
            angles = translate("angles off by {mean} on average (now {now})")
        parts.append(angles.format(mean=_angles(after.mean_qc), now=_angles(before.mean_qc)))
    return ", ".join(parts)


def _percent(part: float) -> str:
    # Rounded down, so that only the whole is 100 %.
    return translate("{percent} %").format(percent=int(100.0 * part + 1e-9))


def no_module(reason: object) -> str:
    """Return what to do where the compiled module cannot be imported."""
    sentence = translate(
        "The compiled module spectral_conformal cannot be imported; install the Spectral Unwrap package for this "
        "platform and Blender version ({reason})"
    )
    return sentence.format(reason=reason)


def solver(factorization: str, kernel: str) -> str:
    """Return the solver's name; `kernel` is the processor whose kernels OpenBLAS runs, empty without it."""
    if not kernel:
        return factorization
    return translate("{name}, OpenBLAS kernels for {kernel}").format(name=factorization, kernel=kernel)


def with_similar(message: str, others: int) -> str:
    """Return a message that stands for `others`, too, which differ from it only in their numbers."""
    if not others:
        return message
    return translate("{message} (and {n} similar)").format(message=message.rstrip("."), n=others)


def _grouped(messages: Counter[str]) -> str:
    """Join the messages, each with its number if there are several."""
    return "; ".join(
        message.rstrip(".") if len(messages) == 1 else ": ".join((str(count), message.rstrip(".")))
        for message, count in messages.most_common()
    )


def _count(number: int, forms: tuple[str, str], **fields: str) -> str:
    """Return the first of two sentences if `n` is one, else the second, with the `fields` filled in."""
    return translate(forms[0] if number == 1 else forms[1]).format(n=number, **fields)


def counted(number: int, forms: tuple[str, str], **fields: str) -> str:
    """Return the first of two sentences if `n` is one, the second for more, with the `fields`; empty for none."""
    return _count(number, forms, **fields) if number > 0 else ""


def _joined(*parts: str) -> str:
    return ", ".join(filter(None, parts))


def _angles(qc: float) -> str:
    """Return by how many percent angles are off, given the quasi-conformal distortion, 1 where they are kept."""
    percent = percent_of_qc(qc)
    # Such triangles are collapsed; large numbers and powers of ten tell an artist nothing more.
    if percent >= 1e5:
        return translate("beyond measure")
    return translate("{percent} %").format(percent=format(percent, ".1f" if percent < 10.0 else ".0f"))
