"""Maps that are kept from one unwrap to the next."""

from __future__ import annotations

from . import _arguments, _native


class KeptMaps:
    """The maps of charts that calls of `unwrap` have found, for later calls to take instead of solving the same again.

    A chart gets its map from here where everything that the map is made of is the same bit by bit: faces, positions,
    seams round it, options, pins, extenders and metric. Results are hence the same with and without; only
    `Chart.reused` and the seconds tell. Those used last are kept. While a call uses this object, calls that other
    threads make meanwhile do without.
    """

    def __init__(self, max_megabytes: int = 256) -> None:
        """Begin with none.

        Args:
            max_megabytes: what is kept at most, in 10^6 bytes; about 16 bytes per vertex.

        Raises:
            ValueError: `max_megabytes` is no whole number from 0 to 2147483647.
        """
        self._native = _native.KeptMaps(1_000_000 * _arguments.checked_count(max_megabytes, "max_megabytes"))

    def __len__(self) -> int:
        """Return how many maps there are, not counting those of a call that has not ended."""
        return self._native.size()

    def clear(self) -> None:
        """Forget all maps; those of a call that has not ended are forgotten, too."""
        self._native.clear()


def native_of(kept: KeptMaps | None) -> _native.KeptMaps | None:
    """Return what the native module knows a `KeptMaps` by."""
    if kept is not None and not isinstance(kept, KeptMaps):
        raise TypeError(f"kept_maps must be a KeptMaps or None, not {type(kept).__name__}.")
    return None if kept is None else kept._native  # noqa: SLF001 - the facade's own
