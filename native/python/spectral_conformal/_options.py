"""The options of a map: one immutable record; its fields are keywords of every function that makes maps."""

from __future__ import annotations

import difflib
import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypedDict, TypeVar, get_args

import numpy as np

from . import _arguments, _native
from ._seam_style import STYLES, Style

Method = Literal["spectral", "lscm", "fiedler", "area"]
Weights = Literal["uniform", "inverse_area"]
Boundary = Literal["length", "vertex"]
Factorization = Literal["auto", "cholmod", "eigen"]
Polish = Literal["off", "angles", "balanced"]
AUTOMATIC = "automatic"
Vector = tuple[float, float, float]

_CHOICES = {
    "method": get_args(Method),
    "weights": get_args(Weights),
    "boundary": get_args(Boundary),
    "factorization": get_args(Factorization),
    "polish": get_args(Polish),
    "style": STYLES,
}


@dataclass(frozen=True)
class Options:
    """How to make a map. Every field is also a keyword of `parameterize`, `unwrap`, `Solver` and `Unwrapper`.

    Immutable and comparable; `dataclasses.replace` makes a changed copy. A value of the wrong type raises TypeError;
    one out of range, or in conflict with another, raises ValueError.

    Attributes:
        method: "spectral" (Eq. 5), "lscm" (pinned LSCM / DCP, section 2.2), "fiedler" (Eq. 4) or "area" (B = A, section
            3.3). With three or more hard pins, "spectral" switches to "lscm"; "fiedler" and "area" hold no pins.
        weights: of the triangles in the conformal energy: "uniform" (1) or "inverse_area" (1 / area, section 4.1).
        boundary: mass B of a vertex of the outer boundary loop: "length" (half of its two boundary edges) or "vertex"
            (1, as in the paper).
        soft_pins: 0 to 1e4, for "spectral": strength of a soft constraint in B that pulls the pinned vertices toward a
            similar image of their positions, as a fraction of the boundary's total mass. The result is aligned with the
            pins by a similarity. At 1 the effect is slight; at 1000 the map nearly meets the pins. 0: pins are hard.
            Where coordinates are held, n pins at t_k add soft_pins / n |z_k - t_k|^2 each to z^H L z instead.
        hole_rigidity: 0 to 1e4, for "spectral": strength of a soft constraint about the barycenter of each boundary
            loop but the longest (section 4.2), which keeps holes from shrinking to a point. At 1 a hole counts like the
            outer boundary. Without extenders and soft pins, it is lowered until the map has no flipped triangles.
            "automatic" chooses it for each patch by the mean QC, or 0 with another constraint, a `metric` or an
            `area_blend`. The result's `hole_rigidity` is the value used.
        fill_holes: bool, close every boundary loop but the longest with virtual triangles, which keep the holes' shape.
            They contribute to the eigenvalue, but not to any measure of the map.
        area_blend: 0 to 1. 0 preserves angles; toward 1 the map trades them for areas: the patch is unfolded
            conformally, relaxed toward an isometry, and solved again with the metric of that map, blended with the
            identity (section 4.3). Applied on top of `metric` if both are given.
        fold_free: bool, end without flipped triangles and with a turning number of 1 or -1, at some cost in distortion.
            Flipped triangles are unfolded locally. If some remain, the map winds around more than once, or there is no
            map, an embedding (one-to-one by theorem) replaces it and is relaxed without flipping a triangle. Without
            pins, parts that cover each other are moved apart, as a last resort in an embedding whose border does not
            touch itself. Two or more hard pins stay exactly where they are: only local unfolding is possible then.
            `message` says what was done, what it cost, and where pins leave no room: faces still flipped, or parts that
            still cover each other. Triangles without area in 3D cannot flip; of a quad's two splits, the first stays
            unfolded.
        polish: "angles" lowers the mean QC of the "spectral" map by a few steps that reuse the factor (not with soft
            constraints, `metric` or `area_blend`). "balanced" then evens out the sizes by a few more, until half of the
            mean QC gained is spent. "off": neither. True and False stand for "angles" and "off". Three or more hard
            pins stay exactly where they are. The conformal energy weights a triangle by its area in the map, mean QC by
            its area on the surface. No step flips a triangle. `polish_steps` counts them; if there are any,
            `eigenvalue` is the quotient of the map.
        fallbacks: bool, whether "spectral" may return another map if its own fails the checks. The candidates are the
            failed map unfolded (or an embedding, if that leaves no room) and the maps with thin triangles clamped, with
            the other boundary and with the other weights; the one with the lowest mean QC and no flipped triangles
            wins. The result's `fallback` names it. False: such a failure is an error. None: True for `unwrap` and
            `Unwrapper`, which report chart by chart; False for `parameterize` and `Solver`. The embedding of
            `fold_free` does not depend on this option.
        tolerance: 1e-14 to 1e-3, relative residual at which the eigenvalue iteration stops. Above 1e-7, maps with hard
            pins are refined to single precision only.
        factorization: "cholmod", "eigen", or "auto": CHOLMOD if the module was built with it, otherwise Eigen.
    """

    method: Method = "spectral"
    weights: Weights = "uniform"
    boundary: Boundary = "length"
    soft_pins: float = 0.0
    hole_rigidity: float | Literal["automatic"] = 0.0
    fill_holes: bool = False
    area_blend: float = 0.0
    fold_free: bool = False
    polish: Polish | bool = field(default="off", metadata={"without_value": "angles"})
    fallbacks: bool | None = None
    tolerance: float = 1e-8
    factorization: Factorization = "auto"

    def __post_init__(self) -> None:
        """Check every value, and convert numbers to float and flags to bool.

        Raises:
            TypeError: a value is of the wrong type.
            ValueError: a value is out of range or conflicts with another one.
        """
        if isinstance(self.polish, (bool, np.bool_)):
            _set(self, "polish", "angles" if self.polish else "off")
        _check_choices(self)
        for name in ("fill_holes", "fold_free"):
            _set(self, name, _arguments.checked_flag(getattr(self, name), name))
        if self.fallbacks is not None:
            _set(self, "fallbacks", _arguments.checked_flag(self.fallbacks, "fallbacks"))
        for name, low, high in (
            ("soft_pins", 0.0, _arguments.STRENGTH_LIMIT),
            ("hole_rigidity", 0.0, _arguments.STRENGTH_LIMIT),
            ("area_blend", 0.0, 1.0),
            ("tolerance", 1e-14, 1e-3),
        ):
            value = getattr(self, name)
            if name == "hole_rigidity" and isinstance(value, str):
                if value != AUTOMATIC:
                    raise ValueError(f"{name} must lie between 0 and {high:g}, or be {AUTOMATIC!r}, not {value!r}.")
                continue
            _set(self, name, _arguments.checked_between(value, low, high, name))
        for name, needs in (("soft_pins", "soft_pins need"), ("hole_rigidity", "hole_rigidity needs")):
            value = getattr(self, name)
            if value != AUTOMATIC and value > 0.0 and self.method != "spectral":
                raise ValueError(f"{needs} the method 'spectral', not '{self.method}'.")


# Fields of `SeamOptions` that describe the maps, as those of `Options` do.
SHARED = ("weights", "boundary", "area_blend", "factorization")


@dataclass(frozen=True)
class SeamOptions:
    """When to stop cutting. Every field is also a keyword of `suggest_seams` and `suggest_cuts`.

    A component needs no more cuts once it meets `scale_limit`, `qc_limit` and `energy_limit`.

    Attributes:
        style: "hard": seams along sharp edges are cheap, and islands, too. "organic": islands cost three times as much,
            turns half as much, and `front` counts twice. "auto": "hard" if at least half of the bending lies on
            creases: of the sum of length times angle squared over all edges, on those sharper than 30 degrees. Not with
            `shortest`.
        max_length: limit on the total length of the proposed seams, in the unit of the vertices; None for no limit. One
            that the seams do not reach changes nothing; where they do, cuts are made one by one, the most urgent first.
            The cuts that topology needs count, but are proposed even beyond the limit.
        scale_limit: at least 1, the factor of the median within which 95 % of a component's area must have its linear
            scale, the root of UV area over 3D area.
        qc_limit: at least 1, limit on a component's mean quasi-conformal distortion.
        energy_limit: at least 4, limit on a component's symmetric Dirichlet energy, the area-weighted mean of
            s^2 + t^2 + 1 / s^2 + 1 / t^2, where s and t are the singular values of a face's map at the median scale.
            4 means no stretching. Large values count as the square of their logarithm. None derives it from the other
            limits: 4 + 0.3 log2(scale_limit)^2 + 2 (qc_limit + 1 / qc_limit - 2), which is 4.05 at their defaults.
        qc_gain: at least 0. If only the mean quasi-conformal distortion exceeds its limit, or no cut lowers the energy
            any more, a cut must lower that mean, over the whole mesh, by at least this per seam length, in units of the
            root of the mesh's area. With a `qc_limit` of 1 this alone decides how far cuts go; at 0 the limit alone
            does.
        front: (3,) direction from the mesh to its viewer, or None. The longer it is, the more seams avoid the viewer's
            sight: an edge whose faces face the viewer counts as 1 + length times as long.
        longest_side: at least 0, in units of the root of the mesh's area: islands with a longer side, such as the teeth
            of a gear, are parted where the seams cost less than what they have beyond it, by its length; inf leaves
            them. At 1.75, a square texture that has room for an island may be filled to a third. Not with `shortest`.
        shortest: bool, propose the shortest seams found that meet the limits: neither the angle at an edge nor turns
            count, and seams are taken back edge by edge until a limit is reached. For a bound on the distortion of maps
            that nobody has to read; it takes about twice as long.
        weights: see `Options`.
        boundary: see `Options`.
        area_blend: see `Options`. Above 0, the maps to measure are blended ones, which need fewer cuts for even sizes.
        factorization: see `Options`.
    """

    style: Style = "auto"
    max_length: float | None = None
    scale_limit: float = 1.25
    qc_limit: float = 1.1
    energy_limit: float | None = None
    qc_gain: float = 0.0
    front: Vector | None = None
    longest_side: float = 1.75
    shortest: bool = False
    weights: Weights = "uniform"
    boundary: Boundary = "length"
    area_blend: float = 0.0
    factorization: Factorization = "auto"

    def __post_init__(self) -> None:
        """Check every value, and convert numbers to float.

        Raises:
            TypeError: a value is of the wrong type.
            ValueError: a value is out of range.
        """
        _check_choices(self)
        _set(self, "shortest", _arguments.checked_flag(self.shortest, "shortest"))
        _set(self, "area_blend", _arguments.checked_between(self.area_blend, 0.0, 1.0, "area_blend"))
        if self.max_length is not None:
            _set(self, "max_length", _arguments.checked_at_least(self.max_length, 0.0, "max_length"))
        for name in ("scale_limit", "qc_limit"):
            _set(self, name, _arguments.checked_at_least(getattr(self, name), 1.0, name))
        _set(self, "longest_side", _arguments.checked_at_least(self.longest_side, 0.0, "longest_side"))
        _set(self, "qc_gain", _arguments.checked_at_least(self.qc_gain, 0.0, "qc_gain"))
        if self.energy_limit is not None:
            _set(self, "energy_limit", _arguments.checked_at_least(self.energy_limit, 4.0, "energy_limit"))
        if self.front is not None:
            _set(self, "front", _arguments.checked_direction(self.front, "front"))

    def with_energy_limit(self) -> SeamOptions:
        """Return a copy whose `energy_limit` follows from the other limits if it is None."""
        if self.energy_limit is not None:
            return self
        return replace(self, energy_limit=_native.energy_at(self.scale_limit, self.qc_limit))


def _check_choices(options: Options | SeamOptions) -> None:
    for name, choices in _CHOICES.items():
        value = getattr(options, name, choices[0])
        if not isinstance(value, str):
            raise TypeError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}.")
        if value not in choices:
            raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}.")


def _set(options: Options | SeamOptions, name: str, value: object) -> None:
    object.__setattr__(options, name, value)  # the record is frozen


# The same fields as keywords, for type checkers and editors: all of them, or those that a function accepts.
# tests/module/test_options.py checks that they match the fields.


class ResolveChanges(TypedDict, total=False):
    """What the solves of one `Unwrapper` may vary."""

    hole_rigidity: float | Literal["automatic"]
    tolerance: float


class SolveChanges(ResolveChanges, total=False):
    """What the solves of one `Solver` may vary."""

    method: Method
    soft_pins: float
    fallbacks: bool | None
    fold_free: bool
    polish: Polish | bool


class OptionChanges(SolveChanges, total=False):
    """All fields of `Options`."""

    weights: Weights
    boundary: Boundary
    fill_holes: bool
    area_blend: float
    factorization: Factorization


class SeamOptionChanges(TypedDict, total=False):
    """All fields of `SeamOptions`."""

    style: Style
    max_length: float | None
    scale_limit: float
    qc_limit: float
    energy_limit: float | None
    qc_gain: float
    front: Vector | None
    longest_side: float
    shortest: bool
    weights: Weights
    boundary: Boundary
    area_blend: float
    factorization: Factorization


AnyOptions = TypeVar("AnyOptions", Options, SeamOptions)


def changed(
    options: AnyOptions | None,
    default: AnyOptions,
    changes: Mapping[str, Any],
    allowed: Any,  # noqa: ANN401 - a TypedDict is not a type to type checkers
    function: Callable[..., Any],
) -> AnyOptions:
    """Return `options`, or `default` if they are None, with changes.

    Args:
        options: from the caller of `function`.
        default: used if there are none.
        changes: fields by name.
        allowed: the TypedDict of the fields that `function` accepts.
        function: named in the message about an unknown field.

    Raises:
        TypeError: `options` has another type than `default`, or a name is not in `allowed`; the message names the
            closest one, or says that an object fixes this field.
        ValueError: a value cannot be used.
    """
    base = default if options is None else options
    if not isinstance(base, type(default)):
        raise TypeError(f"options must be {type(default).__name__}, not {type(options).__name__}.")
    called = function.__qualname__.replace(".__init__", "")
    for name in changes:
        if name not in allowed.__optional_keys__:
            if hasattr(base, name):
                owner = called.partition(".")[0]
                raise TypeError(f"{called}() cannot change '{name}'; make a new {owner} with it.")
            own = set(inspect.signature(function).parameters) - {"self", "changes"}
            known = sorted(own | allowed.__optional_keys__)
            near = difflib.get_close_matches(name, known, n=1, cutoff=0.0)[0]
            raise TypeError(f"{called}() has no option '{name}'; did you mean '{near}'?")
    return replace(base, **changes) if changes else base


def with_fallbacks(options: Options, default: bool) -> Options:
    """Return the options, with the default for `fallbacks` if it is None."""
    return replace(options, fallbacks=default) if options.fallbacks is None else options


def documented(options: type) -> dict[str, str]:
    """Return the entry of each field in the docstring of a dataclass, with its name and indentation."""
    attributes = inspect.cleandoc(options.__doc__ or "").partition("\nAttributes:\n")[2]
    entries = re.split(r"^(?=    \w+: )", attributes, flags=re.MULTILINE)
    return {entry.split(":")[0].strip(): entry.rstrip() for entry in entries if entry.strip()}
