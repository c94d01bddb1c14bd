# SPDX-License-Identifier: GPL-3.0-or-later
"""What a batch does with every asset, as options of the command line, keys of a settings file, and JSON."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any

from ..core import seam_suggestion, texts, welding
from ..core.options import Margin, Options, Settings

SEAMS = ("keep", "suggest", "sharp", "smart")
# Nobody looks at each asset to ask for more cuts, so a mesh gets those that pay until its distortion of angles is not
# seen. Of 23 kinds of generated meshes 12 had more of it than xatlas leaves with the operator's limit, 3 with this one,
# as without any limit, which cuts a good rock into 34 islands instead of 6 (tests/benchmarks/generated_assets.py).
_SUGGESTION = seam_suggestion.Options(qc_limit=1.01, qc_gain=0.001)


class SettingsError(Exception):
    """A setting that is unknown, or a value that it cannot have; the message names both."""


@dataclass(frozen=True)
class BatchSettings:
    """What to do with seams, islands and packing of an asset, and what to write beside it.

    Attributes:
        seams: one of `SEAMS`; all but "keep" add to the seams that are there.
        sharp_angle: in degrees, between the normals of two faces, from which "sharp" makes their edge a seam.
        weld_distance: vertices on open borders that are nearer to each other than this part of the bounding box's
            diagonal count as one while "suggest" and "sharp" make islands; 0 for none.
        unwrap: solve the islands; otherwise they stay as they are.
        pack: pack all islands together; otherwise they stay where they are.
        margin_pixels: space between packed islands, in pixels of a texture of `texture_size`; None for the margin of
            `operator`.
        texture_size: in pixels, of one side.
        uv_map: name of the UV map to write, made where it is missing; empty for the active one.
        usd_over: write a USD layer over the untouched source in place of a whole file.
        picture_size: side of the picture of the layout, in pixels; 0 for none.
        checker: render the asset with a checker.
        operator: what the operator Spectral Unwrap is set to.
        suggestion: what the search for seams is set to.
    """

    seams: str = "suggest"
    sharp_angle: float = 30.0
    weld_distance: float = welding.DISTANCES[0]
    unwrap: bool = True
    pack: bool = True
    margin_pixels: float | None = None
    texture_size: int = 1024
    uv_map: str = ""
    usd_over: bool = False
    picture_size: int = 512
    checker: bool = False
    operator: Settings = field(default_factory=Settings)
    suggestion: seam_suggestion.Options = _SUGGESTION

    def operator_settings(self) -> Settings:
        """Return the operator's settings with what `pack` and `margin_pixels` say of them."""
        margin = self.operator.margin
        if self.margin_pixels is not None:
            # Blender leaves the margin around each of two islands.
            margin = Margin(0.5 * self.margin_pixels / self.texture_size, "FRACTION")
        return dataclasses.replace(self.operator, keep_in_place=not self.pack, margin=margin)

    def seam_options(self) -> seam_suggestion.Options:
        """Return the options of the search, which solves as the operator does."""
        options = self.operator.options
        return dataclasses.replace(self.suggestion, weights=options.weights, boundary=options.boundary)

    def as_json(self) -> dict[str, Any]:
        """Return the settings by name, as `from_values` takes them."""
        return {setting.name: setting.value_in(self) for setting in SETTINGS}


@dataclass(frozen=True)
class Setting:
    """One setting by a name that is unique among all.

    Attributes:
        name: on the command line with dashes for underscores.
        path: names of the attributes that lead to it from `BatchSettings`.
        kind: type of the value.
        default: None where it may be left open.
        choices: the values that it may have; empty for any.
        description: for the help.
    """

    name: str
    path: tuple[str, ...]
    kind: type
    default: Any
    choices: tuple[str, ...] = ()
    description: str = ""

    def value_in(self, settings: BatchSettings) -> Any:  # noqa: ANN401 - of `kind`
        """Return the value in some settings."""
        value: Any = settings
        for name in self.path:
            value = getattr(value, name)
        return list(value) if isinstance(value, tuple) else value

    def checked(self, value: Any) -> Any:  # noqa: ANN401 - of `kind`
        """Return a value of a settings file as it is to be used.

        Raises:
            SettingsError: it is of another type, or none of the choices.
        """
        if self.kind is tuple:
            is_vector = isinstance(value, (list, tuple)) and len(value) == 3 and all(map(_is_number, value))
            if value is not None and not is_vector:
                raise SettingsError(f"{self.name} must be three numbers, not {value!r}.")
            return value and tuple(map(float, value))
        if value is None and self.default is None:
            return None
        if self.kind is float and _is_number(value):
            return float(value)
        if type(value) is not self.kind:
            raise SettingsError(f"{self.name} must be of type {self.kind.__name__}, not {value!r}.")
        if self.choices and value not in self.choices:
            raise SettingsError(f"{self.name} must be one of {', '.join(self.choices)}, not {value!r}.")
        return value


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


# Where the operator's property has another name than the field of its settings.
_TEXTS = {
    "soft_pins": "SOFT_PIN_STRENGTH",
    "use_subsurf": "USE_SUBSURF_DATA",
    "scale_limit": "SIZE_VARIATION",
    "qc_limit": "ANGLE_DISTORTION",
}
_CHOICES = {
    "method": [identifier.lower() for identifier, *_ in texts.METHOD_ITEMS],
    "weights": [identifier.lower() for identifier, *_ in texts.WEIGHTS_ITEMS],
    "boundary": [identifier.lower() for identifier, *_ in texts.BOUNDARY_ITEMS],
    "margin_method": [identifier for identifier, *_ in texts.MARGIN_METHOD_ITEMS],
    "seams": SEAMS,
}
_DESCRIPTIONS = {
    "seams": "keep the seams that there are, or add to them: suggest, by the edges' angle (sharp), or the borders of "
    "the islands of Blender's Smart UV Project (smart)",
    "sharp_angle": "degrees between two faces from which --seams sharp cuts",
    "weld_distance": "part of the mesh's size within which vertices on open borders count as one for --seams suggest "
    "and sharp, so that islands go across; the file's own vertices stay; 0 for none",
    "unwrap": "solve the islands, or leave them as they are",
    "pack": "pack all islands together, or leave them where they are",
    "qc_gain": "what a cut of --seams suggest has to lower the mean quasi-conformal distortion by for each length of "
    "the root of the area, where nothing but that is beyond its limit; 0 for all cuts up to the limit",
    "margin_pixels": "space between packed islands in pixels of the texture",
    "texture_size": "pixels of one side of the texture, for --margin-pixels",
    "uv_map": "name of the UV map to write, made where it is missing; the active one unless given",
    "usd_over": "write a USD layer over the untouched source in place of a whole file",
    "picture_size": "pixels of one side of the picture of the layout, 0 for none",
    "checker": "render the asset with a checker",
    "front": "direction in object space that seams keep away from",
}


def _description(name: str) -> str:
    if name in _DESCRIPTIONS:
        return _DESCRIPTIONS[name]
    properties = getattr(texts, f"{_TEXTS.get(name, name.upper())}_PROPERTY")
    return properties["description"][:1].lower() + properties["description"][1:]


def _settings() -> Iterator[Setting]:
    """Yield every setting, of records that their modules define."""
    # Given by `pack`, or by the operator's options, or a record of settings themselves.
    records: tuple[tuple[tuple[str, ...], Any, set[str]], ...] = (
        ((), BatchSettings(), {"operator", "suggestion"}),
        (("operator", "options"), Options(), set()),
        (("operator",), Settings(), {"options", "margin", "keep_in_place"}),
        (("operator", "margin"), Margin(), set()),
        (("suggestion",), _SUGGESTION, {"weights", "boundary"}),
    )
    names = {"size": "margin", ("margin", "method"): "margin_method"}
    kinds = {"margin_pixels": float, "max_length": float, "front": tuple}
    for path, record, left_out in records:
        for item in fields(record):
            if item.name in left_out:
                continue
            name = names.get((*path[-1:], item.name), names.get(item.name, item.name))
            default = getattr(record, item.name)
            kind = kinds.get(name, type(default))
            choices = tuple(_CHOICES.get(name, ()))
            yield Setting(name, (*path, item.name), kind, default, choices, _description(name))


SETTINGS = tuple(_settings())


def from_values(values: dict[str, Any]) -> BatchSettings:
    """Return the settings that have these values, by the names of `SETTINGS`; the others have their defaults.

    Raises:
        SettingsError: a name is unknown, or a value not one of its setting.
    """
    known = {setting.name: setting for setting in SETTINGS}
    unknown = sorted(set(values) - set(known))
    if unknown:
        raise SettingsError(f"unknown: {', '.join(unknown)}. Known are {', '.join(sorted(known))}.")
    result = BatchSettings()
    for name, value in values.items():
        result = _replaced(result, known[name].path, known[name].checked(value))
    if result.texture_size < 1:
        raise SettingsError(f"texture_size must be at least 1, not {result.texture_size}.")
    low, high = welding.DISTANCES
    if result.weld_distance and not low <= result.weld_distance <= high:
        raise SettingsError(f"weld_distance must be 0, or from {low:g} to {high:g}, not {result.weld_distance}.")
    if result.margin_pixels is not None and not 0.0 <= result.margin_pixels < result.texture_size:
        raise SettingsError(f"margin_pixels must be from 0 to less than texture_size, not {result.margin_pixels}.")
    if result.picture_size and not 64 <= result.picture_size <= 8192:
        raise SettingsError(f"picture_size must be 0, or from 64 to 8192, not {result.picture_size}.")
    return result


def _replaced(record: Any, path: tuple[str, ...], value: object) -> Any:  # noqa: ANN401 - any of the records
    if len(path) > 1:
        value = _replaced(getattr(record, path[0]), path[1:], value)
    return dataclasses.replace(record, **{path[0]: value})
