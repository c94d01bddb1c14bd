"""The settings of a batch, as options of the command line, keys of a settings file, and JSON."""

from __future__ import annotations

import argparse
import dataclasses
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import Any, Literal

from .. import _texture_size as textures
from .._command_line import add_fields
from .._island_packing import ROTATIONS
from .._options import SHARED, Options, SeamOptions
from .._pattern import Pattern
from .._straightening import AUTOMATIC as WHERE_HARD
from ..assets import drawing, welding
from ..assets.unwrapping import MOST_TILES, SEAMS, SHEETS, CutMesh, Cutting, Layout
from ..defaults import MAPS, MARGIN, ROTATION, TEXTURE_SIZE, UNATTENDED_SEAMS

SMART = "smart"
ALL_SEAMS = (*SEAMS, SMART)
PACKINGS = ("shape", "box", "none")
_RECORDS = ("options", "suggestion")
_KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "text"}
AUTOMATIC_UNIT = "auto"
AUTOMATIC_TILES = "auto"
_REBAKES = (textures.FITTING, textures.SAME)


class SettingsError(Exception):
    """A setting is unknown or has an invalid value; the message names both."""


@dataclass(frozen=True)
class BatchSettings:
    """How to cut, unwrap and pack an asset, and which extra files to write.

    Attributes:
        seams: keep: the seams that the file marks or, if it marks none, the island borders of its map. The others add
            to marked seams: suggest: where that lowers the distortion most; sharp: by the angle between faces; merge:
            the island borders of the file's map, without those that the distortion does not need; smart: the island
            borders of Blender's Smart UV Project, which needs Blender.
        sharp_angle: degrees between two faces from which "sharp" makes their edge a seam.
        weld_distance: fraction of the bounding box's diagonal within which vertices on open borders count as one, so
            that islands continue across them; the file's own vertices stay; 0 for none.
        unwrap: solve the islands, or leave them unchanged.
        straighten: share by which the mean distortion of an island may rise so that borders that are nearly straight
            become exactly so, and nearly rectangular islands rectangles; 0 for none. auto: 0.02 on hard surfaces, by
            `style`.
        pack: shape: all islands together by their shapes; box: by their bounding boxes, upright; none: leave them in
            their positions. True means shape, false none.
        rotation: of islands with pack "shape". square: those that are straight for the most part stand upright, in
            quarter turns, the others turn freely; free: all turn to fit densely; upright: all stand upright; quarters:
            by quarter turns alone; none: not at all.
        margin: between packed islands, and between them and the border of the texture, in pixels.
        texture_size: of one side in pixels, or width and height, such as 2048x1024.
        texel_density: pixels per unit of length in the scene, the same for all islands; without unwrap, on average, and
            the sizes of islands keep their ratios. An asset whose islands do not fit then fails. 0 fills the texture,
            at one density for each asset.
        udim: tiles to fill, from 1001 on, with pack "shape". auto: as many as texel_density needs, the least number
            that is found; without unwrap and texel_density, as many as the islands need in their sizes.
        min_size: islands are enlarged until their longer side has as many pixels, with pack "shape"; 0 for none.
        snap: move straight borders of packed islands to the borders of pixels, by at most half a pixel, as lightmaps
            need; with pack "shape".
        keep_overlaps: without unwrap, islands that overlap move as one, whatever their shapes.
        pack_by: what has a texture of its own, and is packed on its own: asset, object or material. Islands then end
            where the material changes.
        rebake: draw the textures that read the map anew, for the new one, except in PLY. auto, also without a
            value: at texture_size, doubled until a texture has as many texels on the surface as before; same: each at
            its own size; or a size, as texture_size; none.
        rebake_colors: also draw vertex colors to a texture where a material has none for them; without rebake as
            rebake auto.
        uv_map: name of the UV map to write, created if missing; by default the map that the format's programs use
            first. For glTF the n of TEXCOORD_n, or any other name for a set that no mesh has.
        usd_over: write a USD layer over the untouched source instead of a whole file.
        picture_size: side of the picture of the layout in pixels, 0 for none.
        checker: render the asset with a checker, which needs Blender.
        svg: write the pattern, the outlines of the islands at 1:1 with the numbers of their seams, as SVG.
        dxf: write the pattern as DXF.
        unit: of the asset's lengths, for its pattern: mm, cm, m, in or ft. auto: that of the file or, in formats
            without units, mm.
        options: how maps are made.
        suggestion: options of the search for seams.
    """

    seams: str = "suggest"
    sharp_angle: float = 30.0
    weld_distance: float = welding.DISTANCES[0]
    unwrap: bool = True
    straighten: str = WHERE_HARD
    pack: str = "shape"
    rotation: str = ROTATION
    margin: float = MARGIN
    texture_size: str = str(TEXTURE_SIZE)
    texel_density: float = 0.0
    udim: str = "1"
    min_size: float = 0.0
    snap: bool = False
    keep_overlaps: bool = False
    pack_by: str = SHEETS[0]
    rebake: str = field(default="none", metadata={"without_value": textures.FITTING})
    rebake_colors: bool = False
    uv_map: str = ""
    usd_over: bool = False
    picture_size: int = 512
    checker: bool = False
    svg: bool = False
    dxf: bool = False
    unit: str = AUTOMATIC_UNIT
    options: Options = MAPS
    suggestion: SeamOptions = UNATTENDED_SEAMS

    def __post_init__(self) -> None:
        """Check every value.

        Raises:
            ValueError: a value has the wrong type or is out of range.
        """
        for name, chosen in (("pack", "shape"), ("rebake", textures.FITTING)):
            if isinstance(getattr(self, name), bool):
                object.__setattr__(self, name, chosen if getattr(self, name) else "none")
        for each in fields(self):
            if each.name in _RECORDS:
                continue
            value, kind = getattr(self, each.name), type(each.default)
            if kind is float and isinstance(value, int) and not isinstance(value, bool):
                value = float(value)
            elif kind is str and isinstance(value, (int, float)) and not isinstance(value, bool):
                value = f"{value:g}" if isinstance(value, float) else str(value)
            if type(value) is not kind:
                raise ValueError(f"{each.name} must be {_KINDS[kind]}, not {value!r}.")
            object.__setattr__(self, each.name, value)
        low, high = welding.DISTANCES
        smallest = min(self.texture)
        for name, holds, what in (
            ("seams", self.seams in ALL_SEAMS, f"one of {', '.join(ALL_SEAMS)}"),
            ("sharp_angle", 0.0 <= self.sharp_angle <= 180.0, "from 0 to 180"),
            ("weld_distance", not self.weld_distance or low <= self.weld_distance <= high,
             f"0, or from {low:g} to {high:g}"),
            ("margin", 0.0 <= self.margin < smallest, "from 0 to less than texture_size"),
            ("texel_density", 0.0 <= self.texel_density < math.inf, "a finite number of at least 0"),
            ("texel_density", not self.texel_density or self.pack != "none", "0 without pack"),
            ("straighten", self.straighten == WHERE_HARD or re.fullmatch(r"\d*\.?\d+(e-?\d+)?", self.straighten),
             f"a finite number of at least 0, or {WHERE_HARD}"),
            ("rotation", self.rotation in ROTATIONS, f"one of {', '.join(ROTATIONS)}"),
            ("pack", self.pack in PACKINGS, f"one of {', '.join(PACKINGS)}"),
            ("udim", self.tiles == AUTOMATIC_TILES or 1 <= self.tiles <= MOST_TILES,
             f"{AUTOMATIC_TILES}, or from 1 to {MOST_TILES}"),
            ("udim", self.tiles != AUTOMATIC_TILES or self.texel_density or not self.unwrap,
             "a number without texel_density"),
            ("udim", self.tiles == 1 or self.pack == "shape", '1 without pack "shape"'),
            ("udim", self.tiles == 1 or (self.rebake == "none" and not self.rebake_colors), "1 with rebake"),
            ("min_size", 0.0 <= self.min_size < smallest, "from 0 to less than texture_size"),
            ("min_size", not self.min_size or self.pack == "shape", '0 without pack "shape"'),
            ("snap", not self.snap or self.pack == "shape", 'false without pack "shape"'),
            ("keep_overlaps", not self.keep_overlaps or (not self.unwrap and self.pack == "shape"),
             'false with unwrap, or without pack "shape"'),
            ("pack_by", self.pack_by in SHEETS, f"one of {', '.join(SHEETS)}"),
            ("pack_by", self.pack_by == SHEETS[0] or self.pack != "none", f"{SHEETS[0]} without pack"),
            ("rebake", self.rebake in (*_REBAKES, "none") or _is_size(self.rebake),
             f"none, {', '.join(_REBAKES)}, or a size such as 2048 or 2048x1024"),
            ("unit", self.unit in (AUTOMATIC_UNIT, *drawing.UNITS), f"{AUTOMATIC_UNIT}, {', '.join(drawing.UNITS)}"),
            ("picture_size", not self.picture_size or 64 <= self.picture_size <= 8192, "0, or from 64 to 8192"),
        ):  # fmt: skip
            if not holds:
                raise ValueError(f"{name} must be {what}, not {getattr(self, name)!r}.")

    @property
    def texture(self) -> tuple[int, int]:
        """Width and height of the texture, in pixels."""
        if not _is_size(self.texture_size):
            raise ValueError(
                f"texture_size must be at least 1, or two such sizes as 2048x1024, not {self.texture_size!r}."
            )
        return _size(self.texture_size)

    @property
    def textures(self) -> textures.TextureSize | None:
        """The size of textures to draw anew; None to leave them."""
        rule = textures.FITTING if self.rebake == "none" and self.rebake_colors else self.rebake
        if rule == "none":
            return None
        if rule in _REBAKES:
            return textures.TextureSize(rule, self.texture, self.rebake_colors)
        return textures.TextureSize("size", _size(rule), self.rebake_colors)

    @property
    def layout(self) -> Layout:
        """How to lay out islands."""
        return Layout(
            self.pack,
            self.margin,
            *self.texture,
            self.texel_density,
            self.tiles,
            self.rotation,
            self.min_size,
            self.snap,
            self.keep_overlaps,
            self.pack_by,
        )

    @property
    def tiles(self) -> int | Literal["auto"]:
        """UDIM tiles to fill; 0 for what is no number."""
        if self.udim == AUTOMATIC_TILES:
            return "auto"
        return int(self.udim) if re.fullmatch(r"\d{1,9}", self.udim) else 0

    @property
    def draws(self) -> tuple[str, ...]:
        """Suffixes of the patterns to write."""
        return tuple(suffix for suffix, wanted in ((".svg", self.svg), (".dxf", self.dxf)) if wanted)

    def drawings(self, pattern: Pattern, meters: float | None) -> dict[str, str]:
        """Return the texts of the files of a pattern, by their suffixes.

        Args:
            pattern: in units of the asset's scene.
            meters: per unit of it, None if the file has no unit.

        Raises:
            ValueError: a library is missing.
        """
        if self.unit != AUTOMATIC_UNIT:
            millimeters = drawing.UNITS[self.unit]
        else:
            millimeters = drawing.UNITS["mm"] if meters is None else drawing.UNITS["m"] * meters
        return {suffix: draw(pattern, millimeters) for suffix, draw in drawing.FORMATS.items() if suffix in self.draws}

    @property
    def cutting(self) -> Cutting:
        """Where to cut meshes; "smart" is up to Blender, and counts as "keep" here."""
        shared = {name: getattr(self.options, name) for name in SHARED}
        options = dataclasses.replace(self.suggestion, **shared)
        seams = "keep" if self.seams == SMART else self.seams
        return Cutting(seams, self.sharp_angle, self.weld_distance, self.pack_by == "material", options)

    @property
    def maps(self) -> Options:
        """How maps are made: those of joined islands as they were when joined, without folds."""
        return dataclasses.replace(self.options, fold_free=True) if self.seams == "merge" else self.options

    def straightening(self, cut_mesh: CutMesh) -> Literal["auto"] | float:
        """Return what `unwrap` takes to straighten borders of a mesh."""
        if self.straighten != WHERE_HARD:
            return float(self.straighten)
        return "auto" if self.style(cut_mesh) == "hard" else 0.0

    def style(self, cut_mesh: CutMesh) -> Literal["hard", "organic"]:
        """Return the style of a mesh: the one asked for, or that of its shape."""
        asked = self.suggestion.style
        return cut_mesh.style if asked == "auto" else asked

    def as_json(self) -> dict[str, Any]:
        """Return the settings by name, in the form that `from_values` accepts."""
        found = {name: getattr(getattr(self, record) if record else self, name) for name, record in NAMES.items()}
        return {name: list(value) if isinstance(value, tuple) else value for name, value in found.items()}


def _is_size(text: str) -> bool:
    return re.fullmatch(r"[1-9]\d{0,6}(x[1-9]\d{0,6})?", text) is not None


def _size(text: str) -> tuple[int, int]:
    """Return width and height."""
    width, _, height = text.partition("x")
    return int(width), int(height or width)


def _names() -> dict[str, str]:
    own = {each.name: "" for each in fields(BatchSettings) if each.name not in _RECORDS}
    maps = {each.name: "options" for each in fields(Options)}
    return {**own, **maps, **{each.name: "suggestion" for each in fields(SeamOptions) if each.name not in SHARED}}


# Every setting, and the record within `BatchSettings` that holds it; "" for `BatchSettings` itself.
NAMES = _names()
# Those of the search for seams alone; the style also says where borders are straightened.
OF_SEAMS = tuple(name for name, record in NAMES.items() if record == "suggestion" and name != "style")
# Those that joining islands takes, too.
OF_MERGING = ("scale_limit", "qc_limit")
# Prefix of the settings' names among parsed arguments.
_SETTING = "setting_"


def add_to(parser: argparse.ArgumentParser, left_out: Iterable[str] = ()) -> None:
    """Add an option for every setting but those left out; `given` returns the chosen ones."""
    group = parser.add_argument_group("settings, in a settings file of the batch with _ for -")
    default = BatchSettings()
    for record in dict.fromkeys(NAMES.values()):
        found = getattr(default, record) if record else default
        own = [name for name, of in NAMES.items() if of == record and name not in left_out]
        add_fields(group, found, {field.name for field in fields(found)} - set(own), _SETTING)
    group.add_argument(
        "--merge-islands", action="store_const", const="merge", default=argparse.SUPPRESS, dest=_SETTING + "seams",
        help="the same as --seams merge",
    )  # fmt: skip
    group.add_argument(
        "--no-pack", action="store_const", const="none", default=argparse.SUPPRESS, dest=_SETTING + "pack",
        help="the same as --pack none",
    )  # fmt: skip


def given(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the settings that a command line names, by name."""
    chosen = vars(arguments).items()
    return {name[len(_SETTING) :]: value for name, value in chosen if name.startswith(_SETTING)}


def from_values(values: dict[str, Any]) -> BatchSettings:
    """Return settings with these values, by the names in `NAMES`, and defaults for the others.

    Raises:
        SettingsError: a name is unknown, or a value is invalid for its setting.
    """
    unknown = sorted(set(values) - set(NAMES))
    if unknown:
        raise SettingsError(f"unknown: {', '.join(unknown)}; the settings are {', '.join(sorted(NAMES))}.")

    def chosen(record: str) -> dict[str, Any]:
        return {name: value for name, value in values.items() if NAMES[name] == record}

    default = BatchSettings()
    try:
        records = {name: dataclasses.replace(getattr(default, name), **chosen(name)) for name in _RECORDS}
        return BatchSettings(**chosen(""), **records)
    except (TypeError, ValueError) as error:
        raise SettingsError(str(error)) from error
