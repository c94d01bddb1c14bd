# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of the islands that were solved last, as long as a file is open: what has not changed is not solved again.

A margin that is adjusted, a seam that is marked or a step of the seam preview changes few islands or none.
"""

from typing import Any

from .. import native

# Enough for three million triangles.
_MAX_MEGABYTES = 256

_kept: list[Any] = []


def of_session() -> Any:  # noqa: ANN401 - of the native module
    """Return the maps that are kept, a `spectral_conformal.hosts.KeptMaps`.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if not _kept:
        _kept.append(native.spectral_conformal().hosts.KeptMaps(_MAX_MEGABYTES))
    return _kept[0]


def forget() -> None:
    """Forget all maps."""
    _kept.clear()
