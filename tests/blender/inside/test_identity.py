# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes are recognized, whatever their names and number."""

import importlib

import bpy
import pytest

from tests.blender.inside import scenes

identity = importlib.import_module("spectral_unwrap.session.identity")
session = importlib.import_module("spectral_unwrap.session")


class Keys:
    """A stand-in for Blender's numbers of meshes: counts the queries, and may renew all of them."""

    def __init__(self, monkeypatch):
        self.asked, self._shift, self._of = 0, 0, identity.key
        monkeypatch.setattr(identity, "key", self)

    def __call__(self, mesh):
        self.asked += 1
        return self._of(mesh) + self._shift

    def make_anew(self):
        self._shift += 1 << 60


@pytest.fixture
def keys(monkeypatch):
    return Keys(monkeypatch)


def asked_by_two_unwraps(keys, n_objects):
    """Count how often meshes are recognized in two unwraps of this many objects; the second knows them."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)
    scenes.edit(*(scenes.grid(1, 1, name=f"{k}") for k in range(n_objects)))
    before = keys.asked
    for _ in range(2):
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    return keys.asked - before


def test_meshes_are_told_in_proportion_to_their_number(keys):
    few, many = (asked_by_two_unwraps(keys, n_objects) for n_objects in (5, 40))
    assert few > 0
    assert many <= 8 * few


def test_meshes_made_anew_are_told_by_their_names_in_proportion_to_their_number(keys):
    def asked(n_meshes):
        meshes = [bpy.data.meshes.new(f"{n_meshes}") for _ in range(n_meshes)]
        before = [identity.of(mesh) for mesh in meshes]
        keys.make_anew()
        asked_before = keys.asked
        assert [identity.of(mesh) for mesh in meshes] == before
        counted = keys.asked - asked_before
        bpy.data.batch_remove(meshes)
        session.forget(session.Lifetime.FILE)
        return counted

    few, many = asked(5), asked(40)
    assert many <= 8 * few


def test_names_are_those_of_now():
    first, second, other = (bpy.data.meshes.new(name) for name in ("First", "Second", "Other"))
    told = [identity.of(mesh) for mesh in (first, second)]
    first.name, second.name, first.name = "Third", "First", "Second"
    assert identity.of(other) not in told
    other.name, second.name = "Fourth", "Fifth"
    newer = bpy.data.meshes.new("Second.001")
    newer.name = "First"
    assert identity.of(newer) not in told, "the name was another's, who is still there"
    assert [identity.of(mesh) for mesh in (first, second)] == told


def test_a_mesh_made_anew_has_the_name_that_was_seen_last(keys):
    mesh = bpy.data.meshes.new("Before")
    told = identity.of(mesh)
    mesh.name = "After"
    assert identity.of(mesh) is told
    keys.make_anew()
    other = bpy.data.meshes.new("Before")
    assert identity.of(other) is not told
    assert identity.of(mesh) is told
