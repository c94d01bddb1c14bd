# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on, both commands and the module start with the same numbers: those of `spectral_conformal.defaults`."""

import inspect
from dataclasses import fields

import spectral_conformal as sc
from spectral_conformal.assets import unwrapping
from spectral_conformal.batch.settings import BatchSettings
from spectral_unwrap.core import choices
from spectral_unwrap.core.layout.map_packing import MapPackOptions
from spectral_unwrap.core.seams import suggestion
from spectral_unwrap.core.solve.options import Options, Settings


def test_maps():
    options = Options()
    shared = {each.name for each in fields(options)} & {each.name for each in fields(sc.Options)}
    assert shared == {each.name for each in fields(options)} - {"straighten", "stretch"}
    for name in shared:
        assert getattr(options, name) == getattr(sc.defaults.MAPS, name), name
    assert BatchSettings().options == sc.defaults.MAPS


def test_seams():
    options = suggestion.Options()
    limits = ("scale_limit", "qc_limit", "qc_gain", "max_length", "longest_side")
    for name in (*limits, "style", "weights", "boundary", "area_blend"):
        assert getattr(options, name) == getattr(sc.defaults.SEAMS, name), name
    assert sc.SeamOptions() == sc.defaults.SEAMS == unwrapping.Cutting().options
    assert BatchSettings().suggestion == sc.defaults.UNATTENDED_SEAMS


def test_packing():
    expected = {"margin": 4.0, "texture_size": 1024, "rotation": "square"}
    for function in (sc.pack, sc.Packer):
        parameters = inspect.signature(function).parameters
        assert {name: parameters[name].default for name in expected} == expected
    layouts = [unwrapping.Layout(), BatchSettings().layout]
    assert all((each.margin, each.width, each.height, each.rotation) == (4.0, 1024, 1024, "square") for each in layouts)
    assert (choices.MARGIN, choices.TEXTURE_SIZE, choices.ROTATION.lower()) == tuple(expected.values())
    assert (MapPackOptions().margin, MapPackOptions().side, MapPackOptions().rotation) == tuple(expected.values())
    assert (Settings().margin, Settings().rotation) == (4.0 / 1024, "square")
