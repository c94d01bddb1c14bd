"""Maps kept from one call of `unwrap` to the next."""

from __future__ import annotations

from . import _arguments, _native


class KeptMaps:
    """A cache of charts' maps: later calls of `unwrap` reuse a map instead of solving the same problem again.

    A map is reused if all its inputs are identical bit by bit: faces, positions, adjacent seams, options, pins,
    extenders and metric. Results are therefore the same with and without the cache, except for `Chart.reused` and the
    timings. The most recently used maps are kept. While one call uses this object, calls from other threads run without
    it.
    """

    def __init__(self, max_megabytes: int = 256) -> None:
        """Create an empty cache.

        Args:
            max_megabytes: its capacity in 10^6 bytes; a map takes about 16 bytes per vertex.

        Raises:
            ValueError: `max_megabytes` is not a whole number from 0 to 2147483647.
        """
        self._native = _native.KeptMaps(1_000_000 * _arguments.checked_count(max_megabytes, "max_megabytes"))

    def __len__(self) -> int:
        """Return the number of maps, without those of a running call."""
        return self._native.size()

    def clear(self) -> None:
        """Forget all maps, including those of a running call."""
        self._native.clear()


def native_of(kept: KeptMaps | None) -> _native.KeptMaps | None:
    """Return the native object of a `KeptMaps`."""
    if kept is not None and not isinstance(kept, KeptMaps):
        raise TypeError(f"kept_maps must be a KeptMaps or None, not {type(kept).__name__}.")
    return None if kept is None else kept._native  # noqa: SLF001 - the facade's own
