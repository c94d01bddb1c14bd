# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of the islands that were solved last: what has not changed is not solved again.

A margin that is adjusted, a seam that is marked or a step of the seam preview changes few islands or none.
"""

from typing import Any

from ..core import native
from . import Remembered, of

# Enough for three million triangles.
_MAX_MEGABYTES = 256


class KeptMaps(Remembered):
    """Holds a `spectral_conformal.KeptMaps`."""

    def __init__(self) -> None:
        """Make it, empty."""
        self.maps = native.spectral_conformal().hosts.KeptMaps(_MAX_MEGABYTES)


def of_session() -> Any:  # noqa: ANN401 - of the native module
    """Return the maps that are kept, a `spectral_conformal.hosts.KeptMaps`.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    return of(KeptMaps).maps
