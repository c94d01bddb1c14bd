# SPDX-License-Identifier: GPL-3.0-or-later
"""The one memory of the add-on: made on first use, ended and forgotten by its lifetime, whatever happens."""

import pytest
from spectral_unwrap import session
from spectral_unwrap.session import Lifetime, Remembered

ENDED = []


class OfEditMode(Remembered):
    lifetime = Lifetime.EDIT_MODE

    def end(self):
        ENDED.append(OfEditMode)


class OfFile(Remembered):
    def end(self):
        ENDED.append(OfFile)


class OfAddon(Remembered):
    lifetime = Lifetime.ADDON

    def end(self):
        ENDED.append(OfAddon)


KINDS = (OfEditMode, OfFile, OfAddon)


@pytest.fixture(autouse=True)
def clean():
    yield
    session.forget(Lifetime.ADDON)
    ENDED.clear()


def test_there_is_one_object_of_a_kind():
    assert session.of(OfFile) is session.of(OfFile)
    first = session.of(OfFile)
    session.drop(OfFile)
    assert [OfFile] == ENDED
    assert session.of(OfFile) is not first


@pytest.mark.parametrize("lifetime", Lifetime)
def test_what_is_remembered_no_longer_is_ended_and_forgotten(lifetime):
    before = [session.of(kind) for kind in KINDS]
    session.forget(lifetime)
    assert [kind for kind in reversed(KINDS) if kind.lifetime <= lifetime] == ENDED
    assert [session.of(kind) is each for kind, each in zip(KINDS, before)] == [k.lifetime > lifetime for k in KINDS]


def test_all_ends_though_one_fails():
    class Fails(Remembered):
        def end(self):
            raise ZeroDivisionError

    for kind in (OfFile, Fails, OfEditMode):
        session.of(kind)
    with pytest.raises(ZeroDivisionError):
        session.forget(Lifetime.FILE)
    assert [OfEditMode, OfFile] == ENDED
    session.forget(Lifetime.FILE)


def test_what_an_end_makes_again_is_forgotten_too():
    class MakesAnother(Remembered):
        def end(self):
            session.of(OfEditMode)

    session.of(MakesAnother)
    session.forget(Lifetime.FILE)
    assert [OfEditMode] == ENDED


def test_beginning_takes_the_parts_in_their_order():
    begun = []
    session.follow(lambda: begun.append(1), lambda: begun.append(2))
    session.begin()
    session.follow()
    session.begin()
    assert begun == [1, 2]
