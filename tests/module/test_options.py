# SPDX-License-Identifier: GPL-3.0-or-later
"""The options record: the same names, defaults, checks and documentation everywhere."""

import dataclasses
import inspect

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import _options

from tests.module import meshes

TAKE_OPTIONS = {
    "parameterize": sc.parameterize,
    "unwrap": sc.unwrap,
    "Solver": sc.Solver.__init__,
    "Unwrapper": sc.Unwrapper.__init__,
    "Solver.solve": sc.Solver.solve,
    "Unwrapper.solve": sc.Unwrapper.solve,
    "suggest_seams": sc.suggest_seams,
    "suggest_cuts": sc.suggest_cuts,
}
# Options that may vary with a kept factor, or with kept charts.
MAY_VARY = {
    "Solver.solve": {"method", "soft_pins", "hole_rigidity", "fallbacks", "tolerance", "fold_free", "polish"},
    "Unwrapper.solve": {"hole_rigidity", "tolerance"},
}


def record_of(name):
    return sc.SeamOptions if name.startswith("suggest") else sc.Options


def field_names(record):
    return {field.name for field in dataclasses.fields(record)}


@pytest.mark.parametrize(
    ("record", "changes"), [(sc.Options, sc.OptionChanges), (sc.SeamOptions, sc.SeamOptionChanges)]
)
def test_the_keywords_that_type_checkers_know_are_the_fields(record, changes):
    assert changes.__optional_keys__ == field_names(record)
    types = {field.name: field.type for field in dataclasses.fields(record)}
    assert {name: hint.__forward_arg__ for name, hint in changes.__annotations__.items()} == types


@pytest.mark.parametrize("name", TAKE_OPTIONS)
def test_the_keywords_that_type_checkers_know_are_those_that_a_function_takes(name):
    changes = inspect.signature(TAKE_OPTIONS[name]).parameters["changes"]
    assert changes.kind is inspect.Parameter.VAR_KEYWORD
    kind = getattr(sc, changes.annotation[len("Unpack[") : -1], None) or getattr(_options, changes.annotation[7:-1])
    assert kind.__optional_keys__ == MAY_VARY.get(name, field_names(record_of(name)))


@pytest.mark.parametrize("record", [sc.Options, sc.SeamOptions])
def test_every_field_is_documented(record):
    for name in field_names(record):
        assert inspect.cleandoc(record.__doc__).count(f"\n    {name}: ") == 1


@pytest.mark.parametrize(
    ("name", "keyword", "closest"),
    [
        ("parameterize", "weight", "weights"),
        ("parameterize", "foldfree", "fold_free"),
        ("unwrap", "seams", "seam_edges"),
        ("Solver", "fill_hole", "fill_holes"),
        ("Unwrapper", "boundry", "boundary"),
        ("Solver.solve", "tolerence", "tolerance"),
        ("Unwrapper.solve", "rigidity", "hole_rigidity"),
        ("suggest_seams", "maximal_length", "max_length"),
    ],
)
def test_an_unknown_keyword_is_answered_with_the_closest(name, keyword, closest):
    vertices, triangles = meshes.bumpy_disk(60)
    polygons = meshes.polygons(triangles)
    call = {
        "parameterize": lambda given: sc.parameterize(vertices, triangles, **given),
        "unwrap": lambda given: sc.unwrap(vertices, *polygons, **given),
        "Solver": lambda given: sc.Solver(vertices, triangles, **given),
        "Unwrapper": lambda given: sc.Unwrapper(vertices, *polygons, **given),
        "Solver.solve": lambda given: sc.Solver(vertices, triangles).solve(**given),
        "Unwrapper.solve": lambda given: sc.Unwrapper(vertices, *polygons).solve(**given),
        "suggest_seams": lambda given: sc.suggest_seams(vertices, *polygons, **given).seam_edges,
    }[name]
    with pytest.raises(TypeError, match=rf"{name}\(\) has no option '{keyword}'; did you mean '{closest}'\?"):
        call({keyword: 1})


@pytest.mark.parametrize("name", ["Solver", "Unwrapper"])
def test_an_option_that_an_object_fixes_is_named(name):
    fixed = getattr(sc, name)(*meshes.bumpy_disk(60))
    with pytest.raises(TypeError, match=rf"{name}.solve\(\) cannot change 'area_blend'; make a new {name} with it"):
        fixed.solve(area_blend=0.5)


BAD = [
    ({"method": "magic"}, ValueError, "method must be one of 'spectral', 'lscm', 'fiedler', 'area', not 'magic'"),
    ({"method": None}, TypeError, "method must be one of"),
    ({"weights": "magic"}, ValueError, "weights must be one of"),
    ({"boundary": 3}, TypeError, "boundary must be one of"),
    ({"factorization": "magic"}, ValueError, "factorization must be one of"),
    ({"soft_pins": -1.0}, ValueError, "soft_pins must lie between 0 and 10000"),
    ({"soft_pins": 1.0, "method": "lscm"}, ValueError, "soft_pins need the method 'spectral'"),
    ({"hole_rigidity": np.nan}, ValueError, "hole_rigidity must lie between"),
    ({"hole_rigidity": "auto"}, ValueError, "hole_rigidity must lie between 0 and 10000, or be 'automatic'"),
    ({"polish": "yes"}, ValueError, "polish must be one of 'off', 'angles', 'balanced', not 'yes'"),
    ({"polish": 2}, TypeError, "polish must be one of"),
    ({"hole_rigidity": 1.0, "method": "area"}, ValueError, "hole_rigidity needs the method 'spectral'"),
    ({"fill_holes": 1}, TypeError, "fill_holes must be True or False"),
    ({"fold_free": "yes"}, TypeError, "fold_free must be True or False"),
    ({"fallbacks": "no"}, TypeError, "fallbacks must be True or False"),
    ({"area_blend": 1.5}, ValueError, "area_blend must lie between 0 and 1"),
    ({"tolerance": 0}, ValueError, "tolerance must lie between 1e-14 and 0.001"),
    ({"tolerance": "a"}, TypeError, "tolerance must be a number between"),
]


@pytest.mark.parametrize(("values", "kind", "said"), BAD)
def test_bad_values_are_named_alike_everywhere(values, kind, said):
    vertices, triangles = meshes.bumpy_disk(60)
    polygons = meshes.polygons(triangles)
    for call in (
        lambda: sc.Options(**values),
        lambda: sc.parameterize(vertices, triangles, **values),
        lambda: sc.unwrap(vertices, *polygons, **values),
        lambda: sc.Solver(vertices, triangles, **values),
        lambda: sc.Unwrapper(vertices, *polygons, **values),
    ):
        with pytest.raises(kind, match=said):
            call()


def test_options_are_values():
    assert sc.Options(polish=True) == sc.Options(polish="angles")
    assert sc.Options(polish=np.False_) == sc.Options()
    options = sc.Options(weights="inverse_area", tolerance=np.float32(1e-6), fold_free=np.bool_(True))
    same = dataclasses.replace(sc.Options(), weights="inverse_area", tolerance=float(np.float32(1e-6)), fold_free=True)
    assert options == same
    assert hash(options) == hash(same)
    assert (type(options.tolerance), type(options.fold_free)) == (float, bool)
    with pytest.raises(dataclasses.FrozenInstanceError):
        options.weights = "uniform"


def test_options_and_keywords_are_the_same_and_keywords_go_first():
    vertices, triangles = meshes.bumpy_disk(300, 2)
    polygons = meshes.polygons(triangles)
    options = sc.Options(weights="inverse_area", boundary="vertex", hole_rigidity=0.5)
    expected = sc.parameterize(vertices, triangles, weights="inverse_area", boundary="vertex", hole_rigidity=0.5).uv
    assert np.array_equal(sc.parameterize(vertices, triangles, options=options).uv, expected)
    assert np.array_equal(sc.Solver(vertices, triangles, options=options).solve().uv, expected)
    assert np.array_equal(sc.unwrap(vertices, *polygons, options=options).uv, expected[triangles.ravel()])
    unwrapper = sc.Unwrapper(vertices, *polygons, options=options)
    assert np.array_equal(unwrapper.solve().uv, expected[triangles.ravel()])
    other = sc.parameterize(vertices, triangles, options=options, weights="uniform")
    assert np.array_equal(other.uv, sc.parameterize(vertices, triangles, boundary="vertex", hole_rigidity=0.5).uv)
    with pytest.raises(TypeError, match="options must be Options, not SeamOptions"):
        sc.parameterize(vertices, triangles, options=sc.SeamOptions())


def test_a_solve_varies_the_options_of_its_solver_for_itself_only():
    vertices, triangles = meshes.bumpy_disk(300, 2)
    solver = sc.Solver(vertices, triangles, method="lscm")
    assert solver.solve().method == "lscm"
    assert solver.solve(method="fiedler").method == "fiedler"
    assert solver.solve().method == "lscm"
    assert not solver.solve(method="spectral").polish_steps
    polished = solver.solve(method="spectral", polish=True)
    assert polished.polish_steps
    assert np.array_equal(polished.uv, sc.parameterize(vertices, triangles, polish=True).uv)
    rough = meshes.rough_grid(10, 2.0, 6, 0.2)
    apart = sc.Solver(*rough).solve(fold_free=True)
    assert apart.is_embedding
    assert np.array_equal(apart.uv, sc.Solver(*rough, fold_free=True).solve().uv)
    rigid = sc.Unwrapper(vertices, *meshes.polygons(triangles), hole_rigidity=1.0)
    plain = sc.unwrap(vertices, *meshes.polygons(triangles))
    assert meshes.similarity_deviation(rigid.solve().uv, plain.uv) > 1e-4
    assert meshes.similarity_deviation(rigid.solve(hole_rigidity=0.0).uv, plain.uv) < 1e-7


def test_seam_options_and_keywords_are_the_same():
    vertices, quads = meshes.bulge(5, 2.0)
    polygons = meshes.polygons(quads)
    options = sc.SeamOptions(scale_limit=1.2, qc_limit=1.01)
    expected = sc.suggest_seams(vertices, *polygons, scale_limit=1.2, qc_limit=1.01).seam_edges
    assert len(expected)
    assert np.array_equal(sc.suggest_seams(vertices, *polygons, options=options).seam_edges, expected)
    for values, kind, said in (
        ({"shortest": "yes"}, TypeError, "shortest must be"),
        ({"weights": "magic"}, ValueError, "weights must be one of"),
    ):
        with pytest.raises(kind, match=said):
            sc.SeamOptions(**values)
