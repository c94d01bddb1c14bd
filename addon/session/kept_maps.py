# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of the islands solved last, so that unchanged islands are not solved again.

An adjusted margin, a marked seam or a step of the seam preview changes few islands or none.
"""

from typing import Any

from ..core import native
from . import Remembered, of

# Enough for three million triangles.
_MAX_MEGABYTES = 256


class KeptMaps(Remembered):
    """Holds a `spectral_conformal.KeptMaps`."""

    def __init__(self) -> None:
        """Begin empty."""
        self.maps = native.spectral_conformal().hosts.KeptMaps(_MAX_MEGABYTES)


def of_session() -> Any:  # noqa: ANN401 - of the native module
    """Return the kept maps, a `spectral_conformal.hosts.KeptMaps`.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    return of(KeptMaps).maps
