# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the compiled module `spectral_conformal`; the only place that imports it."""

from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType

from .errors import ReadableError
from .words import texts

_TOP_LEVEL = "spectral_conformal"
_BUNDLED = f"{__package__.rpartition('.')[0]}.{_TOP_LEVEL}"


class NativeModuleError(ReadableError, ImportError):
    """The compiled module is missing or does not fit this Blender; the message says what to do."""

    def __str__(self) -> str:
        """Return the message, worded now: a thread may raise this, and Blender translates in the main thread only."""
        return texts.no_module(self.__cause__) if self.__cause__ is not None else super().__str__()


def spectral_conformal(part: str = "") -> ModuleType:
    """Return the module `spectral_conformal`, or a private `part` of it by its name, such as "_measuring".

    The zip for Blender 3.4 to 4.1 carries it inside the add-on; an extension's wheel, or pip, installs it at top level.

    Raises:
        NativeModuleError: it is not installed, or made for another platform or Python.
    """
    try:
        return import_module(f"{_name()}.{part}" if part else _name())
    except ImportError as error:
        raise NativeModuleError from error


def measuring() -> ModuleType:
    """Return the functions that add-on and batch measure with; raises as `spectral_conformal` does."""
    return spectral_conformal("_measuring")


def textures() -> ModuleType:
    """Return the functions that draw the textures of Blender's materials anew; raises as `spectral_conformal` does."""
    return spectral_conformal("_blender_textures")


def limit_threads(threads: int) -> None:
    """Limit the threads that the module uses for this thread; 0 for as many as there are cores.

    Without the module nothing happens: the solve that follows raises.
    """
    try:
        spectral_conformal().limit_threads(threads)
    except NativeModuleError:
        return


@cache
def _name() -> str:
    """Return the name to import the module by; the search for it reaches the disk once."""
    return _BUNDLED if find_spec(_BUNDLED) else _TOP_LEVEL
