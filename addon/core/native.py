# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the compiled module `spectral_conformal`; the only place that imports it."""

from types import ModuleType


class NativeModuleError(ImportError):
    """The compiled module is missing or does not fit this Blender; the message says what to do."""


def spectral_conformal() -> ModuleType:
    """Return the module `spectral_conformal`.

    The zip for Blender 3.4 to 4.1 carries it inside the add-on; an extension's wheel, or pip, installs it at top level.

    Raises:
        NativeModuleError: neither can be imported.
    """
    reasons = []
    try:
        from .. import spectral_conformal as module

        return module
    except ImportError as error:
        reasons.append(f"inside the add-on: {error}")
    try:
        import spectral_conformal as module

        return module
    except ImportError as error:
        reasons.append(f"as a top-level module: {error}")
    raise NativeModuleError(
        "The compiled module spectral_conformal cannot be imported; install the package of Spectral Unwrap made for "
        f"this platform and this version of Blender ({'; '.join(reasons)})"
    )
