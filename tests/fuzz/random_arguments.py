# SPDX-License-Identifier: GPL-3.0-or-later
"""Random arguments for the functions of spectral_conformal: sensible ones, and changes into garbage."""

from __future__ import annotations

import decimal
import fractions
import inspect

import numpy as np
import spectral_conformal as sc
from spectral_conformal import _options


class Interrupted(Exception):
    """Raised by an object of the caller; the call must pass it on unchanged."""


# Sensible values of a parameter, made by (rng, mesh)


def one_of(*values):
    return lambda rng, mesh: values[rng.integers(len(values))]


def flag(rng, mesh):
    return bool(rng.random() < 0.5)


def power_of_ten(low, high):
    return lambda rng, mesh: float(10 ** rng.uniform(low, high))


def vertex(rng, mesh):
    return int(rng.integers(0, max(1, len(mesh.vertices))))


def position(rng, mesh):
    return tuple((10 ** rng.uniform(-3, 3) * rng.normal(size=2)).tolist())


def pins(rng, mesh):
    return {vertex(rng, mesh): position(rng, mesh) for _ in range(rng.integers(0, 6))}


def extenders(rng, mesh):
    strength = power_of_ten(-3, 4)
    sign = rng.choice([-1.0, 1.0, 1.0])
    forces = [(vertex(rng, mesh), vertex(rng, mesh), sign * strength(rng, mesh)) for _ in range(rng.integers(0, 4))]
    # Some with a half.
    return [(*force, abs(force[2])) for force in forces] if len(forces) == 3 else forces


def tensors(rng, n, size):
    roots = rng.normal(size=(n, size, size)) * 10 ** rng.uniform(-3, 3)
    return np.eye(size) * 10 ** rng.uniform(-3, 3) + roots @ roots.transpose(0, 2, 1)


def plane_metric(rng, mesh):
    return tensors(rng, len(mesh.triangles), 2)


def space_metric(rng, mesh):
    flat = all(len(face) == 3 for face in mesh.faces) and rng.random() < 0.5
    return tensors(rng, len(mesh.faces), 2 if flat else 3)


def seam_edges(rng, mesh):
    edges = mesh.edges
    chosen = edges[rng.random(len(edges)) < 10 ** rng.uniform(-2, 0)]
    return chosen if rng.random() < 0.8 else np.r_[chosen, rng.integers(0, max(1, len(mesh.vertices)), (3, 2))]


def selected_faces(rng, mesh):
    return rng.random(len(mesh.faces)) < rng.uniform(0, 1.2)


def fixed_corners(rng, mesh):
    return rng.random(len(mesh.corners)) < 10 ** rng.uniform(-3, 0.1)


def fixed(rng, mesh):
    flags = rng.random(len(mesh.vertices)) < 10 ** rng.uniform(-3, 0.1)
    return flags if rng.random() < 0.5 else np.flatnonzero(flags)


def corner_uv(rng, mesh):
    by_vertex = rng.normal(size=(len(mesh.vertices), 2))
    if rng.random() < 0.3:
        return rng.normal(size=(len(mesh.corners), 2))
    return by_vertex[mesh.corners]


def uv(rng, mesh):
    flat = np.where(np.isfinite(mesh.vertices[:, :2]), mesh.vertices[:, :2], 0.0)
    return flat if rng.random() < 0.3 else rng.normal(size=(len(mesh.vertices), 2)) * 10 ** rng.uniform(-20, 20)


def progress(rng, mesh):
    calls = iter(range(10**9))
    last = int(rng.integers(0, 40))
    answer = one_of(None, True, False, False, 0, "", "go on", np.zeros(2), Interrupted())(rng, mesh)

    def listen(fraction, phase):
        if next(calls) < last:
            return None
        if isinstance(answer, Exception):
            raise answer
        return answer

    return listen


def constraints(rng, mesh):
    def chains(longest):
        return [
            rng.integers(0, max(len(mesh.vertices), 1), rng.integers(1, longest)).tolist()
            for _ in range(rng.integers(3))
        ]

    pairs = [pair for pair in chains(3) if len(pair) == 2]
    slanted = [(chain, rng.normal()) for chain in chains(6)]
    equations = None
    if rng.random() < 0.3:
        coordinates = rng.integers(0, 2 * max(len(mesh.vertices), 1), (3, 4))
        equations = np.stack([coordinates, rng.choice([-1, 0, 1, 1e-9, 0.3], (3, 4))], axis=2)
    # Corners are at least as many as the vertices of faces, of which these are numbers, too.
    of = "vertices" if rng.random() < 0.5 or len(mesh.corners) < len(mesh.vertices) else "corners"
    return sc.Constraints(chains(6), chains(6), pairs, slanted, equations, of=of)


class Kept(sc.hosts.KeptMaps):
    """Kept maps, which look the same in the description of a case, whatever their content."""

    def __repr__(self):
        return "KeptMaps()"


PARAMETERS = {
    "vertices": lambda rng, mesh: mesh.vertices,
    "triangles": lambda rng, mesh: mesh.triangles,
    "faces": lambda rng, mesh: mesh.triangles,
    "seam_edges": seam_edges,
    "selected_faces": selected_faces,
    "uv": uv,
    "directions": lambda rng, mesh: rng.normal(size=(len(mesh.triangles), 3) if rng.random() < 0.5 else 3),
    "ratios": lambda rng, mesh: 10 ** rng.uniform(-4, 4, len(mesh.triangles)),
    "amount": lambda rng, mesh: float(rng.random()),
    "method": one_of("spectral", "spectral", "lscm", "fiedler", "area"),
    "weights": one_of("uniform", "inverse_area"),
    "boundary": one_of("length", "vertex"),
    "factorization": one_of("auto", "cholmod", "eigen", "eigen"),
    "pins": pins,
    "fixed": fixed,
    "soft_pins": power_of_ten(-4, 4),
    "extenders": extenders,
    "constraints": constraints,
    "hole_rigidity": lambda rng, mesh: "automatic" if rng.random() < 0.3 else power_of_ten(-4, 4)(rng, mesh),
    "fill_holes": flag,
    "fold_free": flag,
    "fallbacks": flag,
    "polish": one_of("off", "angles", "balanced", True),
    # Without measures there is nothing to check a map by.
    "measure": lambda rng, mesh: True,
    "metric": plane_metric,
    "area_blend": lambda rng, mesh: float(rng.choice([0.0, 1.0, rng.random()])),
    "tolerance": power_of_ten(-14, -3),
    "progress": progress,
    "kept_maps": lambda rng, mesh: Kept(int(rng.integers(0, 3))),
    "max_length": power_of_ten(-2, 2),
    "scale_limit": lambda rng, mesh: 1 + float(10 ** rng.uniform(-2, 1)),
    "qc_limit": lambda rng, mesh: 1 + float(10 ** rng.uniform(-3, 0)),
    "qc_gain": power_of_ten(-4, 0),
    "energy_limit": lambda rng, mesh: 4 + float(10 ** rng.uniform(-3, 1)),
    "front": lambda rng, mesh: tuple(rng.normal(size=3) * 10 ** rng.uniform(-2, 2)),
    "shortest": flag,
    "style": one_of("auto", "hard", "organic"),
    "longest_side": power_of_ten(-2, 2),
    "avoided_edges": seam_edges,
    "preferred_edges": seam_edges,
    "start_edges": seam_edges,
    # Of as many edges as the other draw seldom has: then it is refused, and else used.
    "edge_preference": lambda rng, mesh: rng.uniform(0, 1, int(rng.integers(0, 4))),
    "islands": lambda rng, mesh: rng.integers(-1, 3, len(mesh.offsets) - 1),
    "texture_size": one_of(1, 64, 1024, (256, 100)),
    "margin": power_of_ten(-2, 3),
    "rotation": one_of("free", "square", "upright", "quarters", "none"),
    "keep_turn": lambda rng, mesh: rng.random(int(rng.integers(0, 4))) < 0.5,
    "scale": flag,
    "tiles": one_of([1001], [1002, 1011, 1002], range(1001, 1006)),
    "regions": lambda rng, mesh: np.sort(rng.normal(size=(2, 2, 2)), axis=1).reshape(2, 4),
    "keep_regions": flag,
    "fewest": flag,
    "stacks": one_of("none", "equal", "mirrored"),
    "keep_stacks": flag,
    "keep_overlaps": flag,
    "min_size": power_of_ten(-2, 3),
    "snap": flag,
    "stack_tolerance": lambda rng, mesh: float(rng.random()),
    "seed": one_of(0, 1, 2**31 - 1),
    "steps": one_of(0, 1, 9),
    # None whose result depends on the clock.
    "seconds": one_of(0.0, np.inf),
    "aspect": power_of_ten(-2, 2),
    "vertex_preference": lambda rng, mesh: rng.uniform(-1, 1, len(mesh.vertices)),
}
POLYGON_PARAMETERS = {
    **PARAMETERS,
    "faces": lambda rng, mesh: mesh.offsets,
    "corner_vertices": lambda rng, mesh: mesh.corners,
    "uv": corner_uv,
    "fixed": fixed_corners,
    "metric": space_metric,
    "straighten": one_of(0.0, "auto", 1e-4, 0.3),
}
RELAX_PARAMETERS = {
    **PARAMETERS,
    "faces": lambda rng, mesh: 3 * np.arange(len(mesh.triangles) + 1),
    "corner_vertices": lambda rng, mesh: mesh.triangles.ravel(),
    "uv": lambda rng, mesh: uv(rng, mesh)[mesh.triangles.ravel()],
    "sizes": lambda rng, mesh: float(rng.choice([0.0, 1.0, rng.random()])),
    "fixed": lambda rng, mesh: rng.random(mesh.triangles.size) < rng.uniform(0, 1.2),
    "weights": lambda rng, mesh: 10 ** rng.uniform(-4, 4, len(mesh.triangles)),
    "max_steps": lambda rng, mesh: int(rng.integers(0, 30)),
    "border": one_of("free", "sliding", "held"),
}


def parameters_of(function):
    """Names of a function's parameters, and whether each must be given.

    Without `options`, whose fields are parameters, too.
    """
    listed = inspect.signature(function).parameters
    names = {name: p.default is inspect.Parameter.empty for name, p in listed.items()}
    if "mesh" in names:
        # The arrays of `sc.Mesh`, with offsets, not faces by vertices; other tests compare these.
        for_map = "faces" not in names
        names = {"vertices": True, "uv": for_map, **names, "faces": True, "corner_vertices": True}
        del names["mesh"]
    if "changes" in names:
        options = listed["changes"].annotation[len("Unpack[") : -1]
        names.update(dict.fromkeys(sorted(getattr(_options, options).__optional_keys__), False))
    return {name: needed for name, needed in names.items() if name not in ("self", "options", "changes")}


def call(function, arguments):
    """Call a function, with a mesh of its arrays if it takes one."""
    if "mesh" not in inspect.signature(function).parameters:
        return function(**arguments)
    rest = dict(arguments)
    given = {name: rest.pop(name) for name in ("vertices", "faces", "uv", "corner_vertices") if name in rest}
    return function(sc.Mesh(**given), **rest)


def makers_of(function):
    """What makes each of a function's parameters."""
    if function is sc.relax:
        return RELAX_PARAMETERS
    names = parameters_of(function)
    return POLYGON_PARAMETERS if "corner_vertices" in names or "measure" in names else PARAMETERS


def random_arguments(rng, mesh, function):
    """Sensible arguments: the required ones and some of the others."""
    names = parameters_of(function)
    makers = makers_of(function)
    if function is sc.relax:
        # Without it, a small tolerance takes a thousand steps.
        names["max_steps"] = True
    share = rng.uniform(0, 0.5)
    arguments = {name: makers[name](rng, mesh) for name, needed in names.items() if needed or rng.random() < share}
    if "fixed" in arguments and "uv" in names:
        arguments.setdefault("uv", makers["uv"](rng, mesh))
    if rng.random() < 0.85:
        make_compatible(arguments, names)
    return arguments


def make_compatible(arguments, names):
    """Leave out arguments that the method does not take."""
    if "method" not in names:
        return
    if "constraints" in arguments:
        arguments.pop("method", None)
    forces = {"extenders", "hole_rigidity"} & set(arguments)
    if forces or "soft_pins" in arguments:
        arguments["method"] = "spectral"
        if "soft_pins" not in arguments and "hole_rigidity" in arguments:
            for name in ("pins", "fixed"):
                arguments.pop(name, None)  # hard ones hold the map against it
    elif (arguments.get("pins") or "fixed" in arguments) and arguments.get("method") in ("fiedler", "area"):
        arguments["method"] = "lscm"


# The same values in another form: the result must be the same


def big_endian(rng, array):
    return array.astype(array.dtype.newbyteorder(">"))


def read_only(rng, array):
    result = array.copy()
    result.setflags(write=False)
    return result


def every_second(rng, array):
    result = np.zeros((2 * len(array), *array.shape[1:]), array.dtype)
    result[::2] = array
    return result[::2]


def backwards(rng, array):
    return array[::-1].copy()[::-1]


def fortran(rng, array):
    return np.asfortranarray(array)


def unaligned(rng, array):
    raw = np.zeros(array.nbytes + 1, np.uint8)
    result = raw[1:].view(array.dtype).reshape(array.shape)
    result[...] = array
    return result


def nested_lists(rng, array):
    # A list without items has no second dimension.
    return array.tolist() if array.size or array.ndim == 1 else array


def other_width(rng, array):
    if array.dtype.kind != "i":
        return array
    kinds = (np.int16, np.uint16, np.int32, np.uint32, np.uint64) if array.min(initial=0) >= 0 else (np.int16, np.int32)
    wide_enough = [kind for kind in kinds if array.max(initial=0) < 30000]
    return array.astype(wide_enough[rng.integers(len(wide_enough))]) if wide_enough else array


SAME = (big_endian, read_only, every_second, backwards, fortran, unaligned, nested_lists, other_width)


def same_in_another_form(rng, arguments):
    """Change how arrays are stored."""
    for name in array_names(arguments):
        if rng.random() < 0.5:
            arguments[name] = SAME[rng.integers(len(SAME))](rng, arguments[name])


def array_names(arguments):
    return [name for name, value in arguments.items() if isinstance(value, np.ndarray)]


# Garbage


class NoArray:
    """Fails on conversion to an array."""

    def __array__(self, *arguments, **options):
        raise Interrupted("no array today")

    def __repr__(self):
        return "NoArray()"


def other_dtype(rng, array):
    kinds = (object, complex, str, bytes, bool, "f2", "f4", np.longdouble, "i1", "u8", ">i4", "M8[s]", "m8[s]", "V8")
    try:
        with np.errstate(all="ignore"):
            return array.astype(kinds[rng.integers(len(kinds))])
    except (TypeError, ValueError):
        return np.empty(array.shape, object)


def structured(rng, array):
    result = np.zeros(array.shape[:1], [("x", "f8"), ("y", "i4")])
    return result if rng.random() < 0.5 else result.reshape(-1, 1).repeat(3, axis=1)


def masked(rng, array):
    return np.ma.masked_array(array, rng.random(array.shape) < 0.3)


def other_shape(rng, array):
    columns = int(rng.integers(0, 5))
    shapes = (
        lambda: array.ravel(),
        lambda: array.T,
        lambda: array[None],
        lambda: array[..., None],
        lambda: array[: len(array) // 2],
        lambda: array[:0],
        lambda: np.r_[array, array],
        lambda: np.zeros((len(array), columns)),
        lambda: np.array(1.5),
        lambda: np.zeros((3,) * 9),
        lambda: np.zeros((0, 3)),
        lambda: np.zeros((3, 0)),
    )
    return shapes[rng.integers(len(shapes))]()


def ragged(rng, array):
    return [row if i % 2 else [*np.atleast_1d(row).tolist(), 1] for i, row in enumerate(array.tolist())]


def wrong_values(rng, array):
    result = array.copy()
    if result.size == 0 or result.dtype.kind not in "fi":
        return result
    if result.dtype.kind == "f":
        values = [np.nan, np.inf, -np.inf, 1e308, -1e308, 5e-324, 1e200]
    else:
        values = [-1, len(array), 2**31 - 1, 2**31, 2**32, 2**63 - 1, -(2**63), -(2**31)]
    result.flat[rng.integers(0, result.size, rng.integers(1, 4))] = values[rng.integers(len(values))]
    return result


def noise(rng, array):
    if array.dtype.kind == "f":
        return np.frombuffer(rng.bytes(array.nbytes), array.dtype).reshape(array.shape)
    if array.dtype.kind == "i":
        return rng.integers(-3, 10 ** rng.integers(1, 10), array.shape)
    return rng.random(array.shape) < 0.5


def far_too_long(rng, array):
    """More rows than an int counts, without the memory for them."""
    if array.size == 0:
        return array
    return np.broadcast_to(array[:1], (int(rng.choice([2**31, 2**33, 2**40])), *array.shape[1:]))


SPOILED = (other_dtype, other_dtype, structured, masked, other_shape, other_shape, ragged, wrong_values, wrong_values)
SPOILED += (noise, far_too_long)

GARBAGE = (
    None, True, 0, -1, 2**31, 2**70, -(2**70), 0.5, -0.0, float("nan"), float("inf"), 1e308, 1j, "", "spectral", b"x",
    "\ud800", "x" * 10000, [], {}, set(), [[1, 2], [3]], [None], {"a": 1}, {0: None}, {0: (1, 2, 3)}, {-1: (0, 0)},
    {0: (np.nan, 0)}, {2**70: (0, 0)}, {0.5: (0, 0)}, [(0, 1)], [(0, 1, np.nan)], [(0, 2**70, 1)], [(0, 1, 10**400)],
    [[]], {0: (10**400, 0)}, object(), np.float32(0.5), np.int8(1), np.bool_(True), np.array(0.5), np.zeros(2),
    np.array("length"), np.array(["length", "vertex"]), decimal.Decimal("0.5"), fractions.Fraction(1, 2), range(3),
    {1: 2}.keys(), memoryview(b"abc"), np.datetime64("2020-01-01"), NoArray(), 10**400, "1e-8", np.ma.masked,
)  # fmt: skip


def spoil(rng, arguments):
    """Make one or two arguments garbage; returns their names."""
    number = min(len(arguments), int(rng.integers(1, 3)))
    names = [str(name) for name in rng.choice(list(arguments), number, replace=False)]
    for name in names:
        value = arguments[name]
        if isinstance(value, np.ndarray) and rng.random() < 0.75:
            arguments[name] = SPOILED[rng.integers(len(SPOILED))](rng, value)
        else:
            arguments[name] = GARBAGE[rng.integers(len(GARBAGE))]
    return names
